"""One side of a tooth as one curve: fillet and flank agree with the outline's own formulas, and where they meet in an edge."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.geometry.tooth import profile
from gearfe.geometry.tooth.side import form_corner, on_fillet, place, side

RACK = {"m_n": 2.5, "alpha_n": math.radians(20), "b": 10.0, "rack_tip_radius": 0.3}
GEARS = [
    gf.Gear(z=13, r_bore=8.0, **RACK),
    gf.Gear(z=30, x=0.3, r_bore=20.0, **RACK),
    gf.Gear(z=25, beta=0.4, r_bore=20.0, **RACK),
    gf.Gear(z=72, r_rim=105.0, **RACK),
]


@pytest.mark.parametrize("gear", GEARS, ids=lambda gear: f"z{gear.z}")
def test_places_lie_on_the_outline(gear):
    phi = np.linspace(profile.form_point(gear)[0], math.pi / 2, 37)[1:-1]
    rolls = np.linspace(gear.roll_f, gear.roll_a, 21)
    for radius, angle in (profile.fillet(gear, phi), profile.flank(gear, rolls)):
        found = place(gear, radius)
        assert_allclose(found.angle, angle, atol=1e-9)
        again = side(gear, found.roll)
        assert_allclose(again[0], radius, atol=1e-4)
        assert_allclose(again[1] * radius, angle * radius, atol=2e-5)


@pytest.mark.parametrize("gear", GEARS, ids=lambda gear: f"z{gear.z}")
def test_normals_are_at_right_angles_to_the_outline(gear):
    radius = np.linspace(gear.r_f, gear.r_a, 43)[3:-1]
    radius = radius[np.abs(radius - gear.r_form) > 1e-2]
    step = 1e-5
    ahead, behind = (profile.cartesian(radius + h, place(gear, radius + h).angle) for h in (step, -step))
    along = (ahead - behind) / np.hypot(*(ahead - behind))
    found = place(gear, radius)
    x, y = profile.cartesian(radius, found.angle)
    arm = np.abs(x * along[0] + y * along[1])  # what the tangent runs along the radius is what the normal passes the centre by
    assert_allclose(np.abs(found.arm), arm, rtol=1e-5)
    assert_allclose(np.hypot(found.arm, found.lean), radius, rtol=1e-9)


def test_arcs_go_on_into_the_fillet():
    for gear in GEARS:
        top, whole = profile.arc_at(gear, gear.roll_f), profile.fillet_length(gear)
        rolls = profile.roll_at_arc(gear, top - whole * np.linspace(0.05, 0.95, 200))
        assert on_fillet(gear, rolls).all()
        points = profile.cartesian(*side(gear, rolls))
        assert_allclose(np.hypot(*np.diff(points, axis=1)).sum(), 0.9 * whole, rtol=1e-3)


def test_undercut_leaves_an_edge_and_a_free_rack_does_not():
    assert [form_corner(gear) for gear in GEARS] == [True, False, False, False]


def test_beyond_tip_and_root_there_is_nothing():
    gear = GEARS[0]
    found = place(gear, np.array([gear.r_f - 0.1, gear.r_a + 0.1]))
    assert np.isnan(found.angle).all()


@pytest.mark.parametrize("gear", GEARS, ids=lambda gear: f"z{gear.z}")
def test_the_tip_and_the_root_are_reached_in_spite_of_last_digits(gear):
    for end, out in ((gear.r_a, gear.outward), (gear.r_f, -gear.outward)):
        assert np.isfinite(place(gear, end * (1 + out * 4e-16 * np.arange(4))).angle).all()
        assert np.isnan(place(gear, end + out * 1e-6 * gear.m_n).angle)


def test_a_slight_undercut_leaves_an_edge_too():
    """The least profile shift without undercut of this tool is between the two."""
    found = [form_corner(gf.Gear(z=13, x=x, r_bore=8.0, **RACK)) for x in (0.15, 0.3)]
    assert found == [True, False]
