"""Pits: what they may be, the width they take, and where contact lines cross them."""

import math

import numpy as np
import pytest
from checks import lost_width
from numpy.testing import assert_allclose
from scipy.integrate import quad

import gearfe as gf
from gearfe.geometry.damage.hollow import centre_arc, check_hollows, intervals, rolls, takes_all, union_length
from gearfe.geometry.tooth.profile import arc_at

pytestmark = pytest.mark.quick

GEAR = gf.Gear(z=21, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=7.4)
RING = gf.Gear(z=72, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_rim=90.0, rack_tip_radius=0.3)
GOOD = {"radius": 21.0, "z": 10.0, "axes": (0.4, 1.0), "depth": 0.2}


def removed(gear, pit):
    """Flank area [mm**2] the pit takes, as integral of the lost width along the profile."""
    middle, reach = centre_arc(gear, pit), pit.reach[0]
    low, high = max(middle - reach, arc_at(gear, gear.roll_f)), min(middle + reach, arc_at(gear, gear.roll_a))
    return quad(lambda s: float(lost_width(gear, [pit], np.array(s))), low, high, epsrel=1e-10, limit=200)[0]


@pytest.mark.parametrize("gear", [GEAR, RING], ids=["gear", "ring"])
@pytest.mark.parametrize("angle", [0.0, 0.3, -1.2, math.pi / 2])
def test_lost_width_integrates_to_the_ellipse(gear, angle):
    pit = gf.Pit(**GOOD | {"radius": gear.r, "angle": angle})
    assert_allclose(removed(gear, pit), math.pi * 0.4, rtol=1e-8)


def test_a_quarter_turn_swaps_the_axes():
    one, two = gf.Pit(**GOOD | {"angle": math.pi / 2}), gf.Pit(**GOOD | {"axes": (1.0, 0.4)})
    arc = centre_arc(GEAR, one) + np.linspace(-2, 2, 41)
    assert_allclose(lost_width(GEAR, [one], arc), lost_width(GEAR, [two], arc), atol=1e-12)
    assert_allclose(one.reach, (1.0, 0.4), rtol=1e-12)


def test_pits_over_the_tip_and_the_end_face_lose_what_is_not_there():
    at_end = gf.Pit(**GOOD | {"z": 20.0})
    assert_allclose(removed(GEAR, at_end), math.pi * 0.4 / 2, rtol=1e-8)
    at_tip = gf.Pit(**GOOD | {"radius": GEAR.r_a})
    assert_allclose(removed(GEAR, at_tip), math.pi * 0.4 / 2, rtol=1e-8)
    assert_allclose(rolls(GEAR, at_tip)[1], GEAR.roll_a, rtol=1e-12)
    check_hollows(GEAR, [at_end, at_tip])


@pytest.mark.parametrize("seed", range(5))
def test_union_against_a_fine_grid(seed):
    """Overlapping, nested, separate and empty intervals."""
    ends = np.sort(np.random.default_rng(seed).integers(0, 1000, (2, 6, 40)), axis=0)
    ends[1, 0] = ends[0, 0]
    cells = np.arange(1000)[:, None, None]
    want = ((cells >= ends[0]) & (cells < ends[1])).any(axis=1).sum(axis=0)
    assert_allclose(union_length(*ends.astype(float)), want, atol=1e-9)


@pytest.mark.parametrize("gear", [GEAR, RING], ids=["gear", "ring"])
@pytest.mark.parametrize("seed", range(4))
def test_crossing_of_oblique_lines_against_points_along_them(gear, seed):
    rng = np.random.default_rng(seed)
    pit = gf.Pit(radius=gear.r, z=10.0, axes=tuple(rng.uniform(0.4, 3.0, 2)), depth=0.1, angle=rng.uniform(-1.5, 1.5))
    middle = math.sqrt(gear.r**2 - gear.r_b**2)
    roll = middle + rng.uniform(-1.5, 1.5, 2)
    t = (np.arange(200_000) + 0.5) / 200_000
    at, z = arc_at(gear, roll[0] + (roll[1] - roll[0]) * t), 20.0 * t
    low, high = intervals(gear, [pit], at)
    found = pit.crossing(gear, roll, (0.0, 20.0))
    assert_allclose(sum(b - a for a, b in found), ((low < z) & (z < high)).mean(), atol=2e-5)


@pytest.mark.parametrize("lean", [0.0, 1e-12, 1e-8])
def test_crossing_of_upright_lines_is_the_lost_width(lean):
    pit = gf.Pit(**GOOD | {"angle": 0.4})
    roll = rolls(GEAR, pit).mean()
    found = pit.crossing(GEAR, (roll - lean, roll + lean), (0.0, GEAR.b))
    assert_allclose(sum(b - a for a, b in found) * GEAR.b, lost_width(GEAR, [pit], arc_at(GEAR, roll)), rtol=1e-7)
    assert pit.crossing(GEAR, (GEAR.roll_a, GEAR.roll_a), (0.0, GEAR.b)) == []


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"depth": 0.0}, "depth = 0.0"),
        ({"axes": (1.0,)}, "two semi-axes"),
        ({"axes": (1.0, -1.0)}, "positive"),
        ({"axes": (1e200, 1.0)}, r"axes = \(1e\+200, 1.0\) mm, but each semi-axis must lie between 1e-50 and 1e\+50 mm"),
        ({"angle": 30.0}, "radians"),
        ({"tooth": 0.5}, "whole number"),
        ({"side": "left"}, "'loaded' or 'unloaded'"),
    ],
)
def test_contradictory_pits_are_refused(numbers, message):
    with pytest.raises(ValueError, match=message):
        gf.Pit(**GOOD | numbers)


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"radius": 24.0}, "flank of the 21-tooth gear"),
        ({"z": 20.1}, "20 mm wide"),
        ({"depth": 1.5}, "shallower"),
    ],
)
def test_pits_beside_the_flank_are_refused(numbers, message):
    check_hollows(GEAR, [gf.Pit(**GOOD)])
    with pytest.raises(ValueError, match=message):
        check_hollows(GEAR, [gf.Pit(**GOOD | numbers)])


def test_a_pit_larger_than_its_flank_takes_all_of_it():
    for axes, turned, all_of_it in (((10.0, 30.0), 0.0, True), ((30.0, 10.0), 0.0, False), ((30.0, 10.0), math.pi / 2, True),
                                    ((2.0, 30.0), 0.0, False), ((1e40, 1e40), 0.3, True)):  # fmt: skip
        pit = gf.Pit(**GOOD | {"axes": axes, "angle": turned})
        assert takes_all(GEAR, pit) == all_of_it
        left = GEAR.b - lost_width(GEAR, [pit], np.linspace(*sorted(arc_at(GEAR, np.array([GEAR.roll_f, GEAR.roll_a]))), 9))
        assert (left.max() < 1e-9) == all_of_it
