"""Gaps of corners: they solve their own equation, in few steps, and no tooth pair that comes near is left out."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.geometry.pair import approach, contacts
from gearfe.geometry.tooth.profile import cartesian
from gearfe.geometry.tooth.side import place, side

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 10.0, "rack_tip_radius": 0.2}
ONE = gf.Gear(z=20, r_bore=8.0, **RACK)
PAIRS = {
    "external": gf.GearPair(ONE, gf.Gear(z=31, r_bore=12.0, **RACK)),
    "ring": gf.GearPair(ONE, gf.Gear(z=63, r_rim=75.0, addendum=0.8, **RACK)),
}


def far(pair):
    """Tip corners of both gears, so far off the path that their normals do not pass both centres alike: place, abscissa, gear."""
    return [
        (pair.gear_1.roll_a, pair.path[1] + np.array([0.05, 0.2, 0.5]) * pair.p_bt, True),
        (pair.gear_2.roll_a, pair.path[0] - np.array([0.05, 0.2, 0.5]) * pair.p_bt, False),
    ]


@pytest.mark.quick
@pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)
def test_a_gap_is_the_turn_of_both_gears_that_brings_the_corner_onto_the_mates_side(pair):
    """Both gears turned in Cartesian coordinates: the corner's angle about the mate's centre is that of the side there."""
    for roll, nominal, driver in far(pair):
        gap = approach.approach(pair, roll, nominal, driver=driver).gap
        assert (gap > 1e-4).all()
        gears, mirror, push = (pair.gear_1, pair.gear_2), (1, pair.outward), (1, -pair.outward)
        own, other = (0, 1) if driver else (1, 0)
        turns = [t + p * s * gap / 2 / g.r_b for t, p, s, g in zip(pair.turn(nominal), push, (1, -1), gears, strict=True)]
        radius, angle = side(gears[own], roll)
        x, y = cartesian(radius, turns[own] + mirror[own] * angle)
        y = y + (0.0, pair.centre_2)[own] - (0.0, pair.centre_2)[other]
        behind = np.arctan2(x, y) - turns[other] - mirror[other] * place(gears[other], np.hypot(x, y)).angle
        assert_allclose((behind + math.pi) % (2 * math.pi) - math.pi, 0.0, atol=1e-13)


@pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)
def test_steps_double_the_digits(pair, monkeypatch):
    """Newton's steps with the true slope, which the arms give: four leave the last digits."""
    whole = [approach.approach(pair, roll, nominal, driver=driver).gap for roll, nominal, driver in far(pair)]
    monkeypatch.setattr(approach, "STEPS", 4)
    some = [approach.approach(pair, roll, nominal, driver=driver).gap for roll, nominal, driver in far(pair)]
    assert_allclose(some, whole, atol=1e-12)


def test_the_ends_of_the_path_are_contacts_of_flanks():
    """Where a corner is on the path, its gap is nothing but rounding: flanks touch there."""
    pair = PAIRS["external"]
    found = contacts.touching(pair, np.array([pair.path[0], pair.path[1] - 1e-10]))
    assert_allclose(found.corner, 0)
    assert_allclose(found.gap, 0.0, atol=1e-300)
    assert np.isfinite(found.corner_gap).any()


@pytest.mark.parametrize(("more", "count"), [(6, (1, 2)), (8, (1, 1))])
def test_pitches_beyond_the_path_are_those_where_corners_come_near(more, count):
    rack = RACK | {"addendum": 0.6}
    pair = gf.GearPair(gf.Gear(z=30, r_bore=8.0, **rack), gf.Gear(z=30 + more, r_rim=42.0 + more, z_cutter=12, **rack))
    assert contacts.near_pitches(pair) == count
    for sense, start, beyond in ((-1, pair.path[0], count[0]), (1, pair.path[1], count[1])):
        nominal = start + sense * np.linspace(0.02, 5.98, 300) * pair.p_bt
        gaps = [approach.approach(pair, roll, nominal, driver=driver).gap for _, roll, driver in contacts.corners_of(pair)]
        near = np.flatnonzero((np.array(gaps) < 0.02 * 2.0).any(axis=0))  # two hundredths of the module
        assert near.size == 0 or math.ceil(0.02 * (near[-1] + 1)) <= beyond


def test_corners_touch_in_their_own_half_of_the_cycle():
    """Tip of the pinion and form point of the wheel at the end, the others at the start; the swapped pair has it mirrored."""
    rack = RACK | {"rack_tip_radius": 0.1}
    one, two = gf.Gear(z=14, r_bore=4.0, **rack), gf.Gear(z=15, r_bore=4.0, **rack)
    for pair in (gf.GearPair(one, two), gf.GearPair(two, one)):
        found = contacts.contacts(pair, np.arange(8) / 8)
        middle = sum(pair.path) / 2
        for number, gap in enumerate(found.corner_gap, start=1):
            there = np.isfinite(gap)
            assert there.any(), number
            late = found.nominal[there] > middle
            assert late.all() if number in (1, 4) else not late.any()
