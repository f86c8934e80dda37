"""Root stress beside ISO 6336-3, method B: a standard that rounds up, so that it bounds rather than proves."""

import math

import pytest
from usual import STEEL

import gearfe as gf


@pytest.mark.parametrize(("z", "x"), [(17, 0.0), (17, 0.5), (25, 0.2), (60, 0.0)])
def test_the_standard_is_above_by_a_little(z, x):
    """By 0.8 to 12.5 %, most at the sharp fillet of the shifted pinion."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 5.0}
    pair = gf.GearPair(gf.Gear(z=z, x=x, r_bore=0.4 * z, **rack), gf.Gear(z=43, r_bore=10.0, **rack))
    norm = gf.iso_root_stress(pair, 1000.0)
    found = gf.root_stress(pair.gear_1, norm.radius, 200.0, STEEL)
    print(f"z {z}, x {x}: ISO 6336-3 {norm.stress:.1f}, root stress {found:.1f} MPa, {norm.stress / found - 1:+.1%}")
    assert 0.0 < norm.stress / found - 1 < 0.13


def test_the_wheel_has_its_own_stress_and_other_pairs_are_refused():
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 5.0}
    wheel, ring = gf.Gear(z=43, r_bore=10.0, **rack), gf.Gear(z=63, r_rim=80.0, addendum=0.8, rack_tip_radius=0.2, **rack)
    pinion = gf.Gear(z=21, r_bore=5.0, **rack)
    pair, turned = gf.GearPair(pinion, wheel), gf.GearPair(wheel, pinion)
    assert gf.iso_root_stress(pair, 1000.0, "wheel") == gf.iso_root_stress(turned, 1000.0)
    with pytest.raises(ValueError, match="this is a ring pair"):
        gf.iso_root_stress(gf.GearPair(pinion, ring), 1000.0)
