"""Root stress along the width: limits of thin and wide spur gears, mirrored hands, bad input."""

import math

import pytest
from usual import STEEL

import gearfe as gf
from gearfe.flexibility.finite_elements.line_load import contact_line

RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
RADIUS, LOAD, HALF = 14.0, 100.0, 0.3  # mm, N/mm, mm


def gear_of(b, degrees=0.0):
    return gf.Gear(z=13, x=0.3, r_bore=8.0, b=b, beta=math.radians(degrees), **RACK)


def solved(b, degrees=0.0, refine=0.7):
    return gf.root_stress_along_width(gear_of(b, degrees), RADIUS, LOAD, STEEL, half_width=HALF, refine=refine)


@pytest.mark.parametrize("degrees", [-25.0, 0.0, 15.0])
def test_the_load_stands_where_the_turned_section_has_the_line_of_action(degrees):
    """At a height the section is turned by twist_rate z, and each turn moves a contact by r_b times as much."""
    gear = gear_of(8.0, degrees)
    roll = contact_line(gear, RADIUS)
    assert math.hypot(roll(4.0), gear.r_b) == pytest.approx(RADIUS, rel=1e-12)
    assert roll(8.0) - roll(0.0) == pytest.approx(gear.r_b * gear.twist_rate * 8.0, abs=1e-12)


@pytest.mark.slow
def test_a_thin_gear_is_in_plane_stress():
    plane = gf.root_stress(gear_of(0.4), RADIUS, LOAD, STEEL, half_width=HALF, state="plane stress")
    found = solved(0.4)
    print(f"b/m 0.2: largest {100 * (found.largest / plane - 1):+.2f} % of plane stress")
    assert abs(found.largest / plane - 1) < 0.01
    assert abs(found.height / 0.4 - 0.5) < 0.2
