import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import RACK

import gearfe as gf
from gearfe.geometry.pair.contacts import contacts
from gearfe.geometry.tooth.profile import cartesian, flank
from validation.shared import reference

pytestmark = pytest.mark.quick


def gear(z, **numbers):
    return gf.Gear(z=z, **(RACK | {"r_bore": 0.5 * z} | numbers))


@pytest.mark.parametrize("row", reference.load()["root_stress"]["rows"])
def test_contact_ratio_of_independent_cases(row):
    rack = {"m_n": 1.0, "alpha_n": math.radians(20), "b": 1.0, "r_bore": 1.0}
    one = gf.Gear(z=row["z"], x=row["x"], rack_tip_radius=row["rack_tip_radius"], **rack)
    assert_allclose(gf.GearPair(one, gf.Gear(z=43, **rack)).eps_alpha, row["eps_alpha"], rtol=1e-11)


def test_contact_ratios_of_the_articles():
    helical = {"m_n": 2.0, "alpha_n": math.radians(20), "beta": math.radians(16), "b": 30.0}
    s4 = gf.GearPair(gf.Gear(z=18, r_bore=9.0, **helical), gf.Gear(z=27, r_bore=12.0, **helical))
    assert_allclose([s4.a, s4.eps_alpha], [46.8135, 1.5018], rtol=1e-4, err_msg="S4 sun-planet")
    helical = {"m_n": 2.1, "alpha_n": math.radians(17.5), "beta": math.radians(29), "b": 16.9}
    s3 = gf.GearPair(gf.Gear(z=17, r_bore=9.0, **helical), gf.Gear(z=60, r_bore=30.0, **helical))
    assert_allclose([s3.a, s3.eps_alpha], [92.440, 1.4741], rtol=1e-4, err_msg="S3")


def test_standard_and_shifted_gears_share_a_base_pitch():
    assert gear(21).p_bt == gear(21, x=0.4).p_bt == pytest.approx(math.pi * 2 * math.cos(math.radians(20)))


@pytest.mark.parametrize(("x_1", "x_2", "more"), [(0.0, 0.0, 0.0), (0.3, 0.2, 0.0), (0.4, -0.4, 0.0), (0.0, 0.0, 0.3)])
def test_flanks_touch_on_the_line_of_action_with_the_computed_backlash(x_1, x_2, more):
    """Independent of the kinematics in `pair`: both outlines in mesh, measured at the contact point."""
    one, two = gear(21, x=x_1), gear(31, x=x_2)
    pair = gf.GearPair(one, two, gf.GearPair(one, two).a + more)
    place = sum(pair.path) / 2
    turn_1, turn_2 = pair.turn(place)
    roll_1, roll_2 = pair.curvature_radii((place - pair.path[0]) / pair.p_bt)
    r_1, a_1 = flank(one, roll_1)
    r_2, a_2 = flank(two, roll_2)
    touch_1, touch_2 = cartesian(r_1, turn_1 + a_1), cartesian(r_2, turn_2 + a_2) + np.array([0, pair.a])
    assert_allclose(touch_1, touch_2, atol=1e-10)
    # play: turn the wheel the other way until its other flank touches the pinion's next tooth
    at = pair.alpha_wt
    gap_1 = 2 * math.pi / one.z - 2 * flank(one, one.r_b * math.tan(at))[1]
    tooth_2 = 2 * flank(two, two.r_b * math.tan(at))[1]
    assert_allclose(pair.backlash, (pair.pitch_radius_1 * gap_1 - pair.pitch_radius_2 * tooth_2) * math.cos(at), atol=1e-10)
    assert (pair.backlash > 0.1) == (more > 0)


def test_pairs_far_away_do_not_touch_whatever_phases_are_asked_with_them(pair):
    phase = np.arange(-48, 96) / 16
    found = contacts(pair, phase)
    touching = np.isfinite(found.gap)
    far = (found.nominal < pair.path[0] - pair.p_bt) | (found.nominal > pair.path[1] + pair.p_bt)
    assert (found.gap[touching & far] > 0.05 * pair.p_bt).all()
    alone = np.array([np.sort(contacts(pair, [p]).gap[0])[:3] for p in phase])
    assert_allclose(np.sort(found.gap, axis=1)[:, :3], alone, atol=1e-12)


def test_nothing_touches_outside_when_not_extended(pair):
    found = contacts(pair, np.linspace(0, 0.99, 50), extended=False)
    counts = np.isfinite(found.gap).sum(axis=1)
    assert set(counts) == {1, 2}
    assert_allclose(counts.mean(), pair.eps_alpha, atol=0.03)


def test_pitch_point(pair):
    assert pair.pitch_radius_1 == pytest.approx(21.0)
    radii = pair.curvature_radii(pair.pitch_phase)
    assert_allclose(radii, [21 * math.sin(math.radians(20)), 31 * math.sin(math.radians(20))], rtol=1e-12)


@pytest.mark.parametrize(
    ("two", "a", "message"),
    [
        ({"m_n": 2.5}, None, "module m_n of gear_1 is 2 mm and that of gear_2 2.5 mm"),
        ({"alpha_n": math.radians(18)}, None, "alpha_n"),
        ({"beta": 0.1}, None, "helix angle"),
        ({}, 51.9, "overlap by"),
        ({}, 48.0, "too small"),
        ({}, 54.2, "contact ratio"),
        ({}, math.nan, "finite length"),
        ({"x": -4.0}, None, "undercut|base circle|cannot touch|bore"),
    ],
)
def test_impossible_pairs_are_refused(two, a, message):
    with pytest.raises(ValueError, match=message):
        gf.GearPair(gear(21), gear(31, **two), a)


def test_long_addendum_interferes_with_the_mates_fillet():
    long = {"addendum": 1.35, "dedendum": 1.4, "rack_tip_radius": 0.45}
    with pytest.warns(UserWarning, match="capped"), pytest.raises(ValueError, match=r"interference|reaches the root circle"):
        gf.GearPair(gear(30), gear(150, **long))
