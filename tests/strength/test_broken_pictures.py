"""Teeth of wide gears without a tooth beside them, or without their tip: the sector that pictures show."""

import math

import numpy as np
import pytest

import gearfe as gf
from gearfe.geometry.mesh.holes import holed_sector

GEAR = gf.Gear(z=17, m_n=3.0, alpha_n=math.radians(20), b=6.0, beta=math.radians(12), r_bore=10.9)


@pytest.mark.parametrize("angle", [45, 90])
def test_a_sector_has_lost_a_tooth_or_a_tip(angle):
    """The volume is less by that of the cut, by the area of its outline."""
    whole, chipped, gone = (
        holed_sector(GEAR, broken=broken, refine=0.5)
        for broken in ((), (gf.Chip(depth=1.0, angle=math.radians(angle)),), (gf.MissingTooth(tooth=1),))
    )
    for made, tooth, top in ((chipped, 0, GEAR.r_a - 1.0), (gone, 1, GEAR.r_f)):
        x, y, z = made.points
        turned = np.arctan2(x, y) - GEAR.twist_rate * z - 2 * math.pi * tooth / GEAR.z
        beyond = (np.abs(turned) < math.pi / GEAR.z - 1e-9) & (turned > GEAR.half_thickness(GEAR.r_a - 1.0) - 1e-6)
        assert np.hypot(x, y)[beyond].max() < top + 1e-3
        assert made.faces["flank 0"].size
        assert made.points.shape[1] != whole.points.shape[1]


@pytest.mark.slow
def test_pictures_press_the_tooth_that_carries():
    """Of a missing tooth the next one; of a chipped one itself."""
    from gearfe.strength.holed import pressed_tooth

    mate = gf.Gear(z=38, m_n=3.0, alpha_n=math.radians(20), b=6.0, beta=-math.radians(12), r_bore=26.6)
    for broken in (gf.MissingTooth(tooth=3), gf.Chip(depth=1.0, tooth=3)):
        case = gf.Case(gf.GearPair(GEAR, mate), 600.0, gf.Material(E=206e3, nu=0.3), damage={"pinion": [broken]})
        found = pressed_tooth(case, refine=0.5)
        assert found.load[0] > 400
        order = 4 if isinstance(broken, gf.MissingTooth) else 3
        assert found.contact.load[0, found.contact.order == order].sum() > 400
