"""Spur gears by halves, even and odd along the width, against both together."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.flexibility.energy.ritz import panel3d
from gearfe.flexibility.energy.ritz.elimination import front
from gearfe.flexibility.energy.ritz.solid import SIZES
from gearfe.flexibility.solid import hats
from gearfe.geometry.mesh.sector import sector

GEAR = gf.Gear(z=18, m_n=2.0, alpha_n=math.radians(20), b=14.0, r_bore=9.0)


@pytest.mark.parametrize("degree", [5, 8], ids=["as many even as odd", "one more even"])
@pytest.mark.parametrize("cracks", [(), (gf.Crack(level=0.4),)], ids=["healthy", "cracked"])
def test_halves_give_what_both_give_together(degree, cracks, monkeypatch):
    made = sector(GEAR, cracks, sizes=SIZES, refine=0.8)
    run = (panel3d.SolidModel(GEAR, STEEL, 2, degree), made, hats(GEAR)[:, ::3])
    halves = panel3d.panel3d(*run)
    monkeypatch.setattr(panel3d, "front_by_parity", front)
    whole = panel3d.panel3d(*run)
    assert whole.unknowns == halves.unknowns
    for name in ("stiffness", "push", "own", "open_push", "open_own", "open_open"):
        one, two = getattr(halves, name), getattr(whole, name)
        assert_allclose(one, two, atol=1e-9 * np.abs(two).max(initial=0.0), err_msg=name)


def test_a_crack_over_a_part_of_the_width_is_not_parted(monkeypatch):
    """Its openings are neither even nor odd."""
    asked = []
    monkeypatch.setattr(panel3d, "front_by_parity", lambda *_: asked.append(1))
    crack = gf.Crack(level=0.4, width=(0.0, 5.0))
    made = sector(GEAR, (crack,), sizes=SIZES, refine=0.7)
    panel3d.panel3d(panel3d.SolidModel(GEAR, STEEL, 2, 3), made, hats(GEAR)[:, ::4], parts=(((0.0, 5.0),),))
    assert not asked
