"""Gaps of pairs with modified flanks: the envelope against a brute search, and identities."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import PAIR_24_36 as PAIR
from usual import RACK_3 as RACK

import gearfe as gf
from gearfe.geometry.pair.approach import approach, facing
from gearfe.geometry.pair.contacts import contacts
from gearfe.geometry.pair.flanks import flank_forms
from gearfe.geometry.pair.modified import flank_contacts

PHASE = np.arange(24) / 24


def relieved(amount=0.01, length=4.0, exponent=1.0, **more):
    return {
        name: gf.Flank(tip_relief=amount, tip_start_roll=gear.roll_a - gear.outward * length, tip_exponent=exponent, **more)
        for name, gear in (("pinion", PAIR.gear_1), ("wheel", PAIR.gear_2))
    }


def test_the_search_finds_conjugate_contact_again():
    plain, found = (
        contacts(PAIR, PHASE),
        flank_contacts(PAIR, PHASE, flanks=flank_forms(PAIR, {"pinion": gf.Flank(profile_slope=1e-13)})),
    )
    near = plain.gap < 0.2
    assert_allclose(found.gap[near], plain.gap[near], atol=1e-10)
    assert_allclose(found.roll_1[near], plain.roll_1[near], atol=2e-4)
    assert_allclose(found.radius[near], plain.radius[near], rtol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("exponent", [1.0, 2.0])
def test_the_gap_is_the_least_over_the_flank(exponent):
    forms = flank_forms(PAIR, relieved(0.02, exponent=exponent, profile_crowning=0.004))
    found = flank_contacts(PAIR, PHASE[::2], flanks=forms)
    roll = np.linspace(PAIR.path[0] - 0.5, PAIR.gear_1.roll_a, 40001)
    checked = 0
    for i, k in np.argwhere(found.gap < 0.05):
        gap, met = approach(PAIR, roll, np.full(roll.size, found.nominal[i, k]), start=found.gap[i, k], flanks=forms)[:2]
        least = np.nanmin(np.where((met >= PAIR.gear_2.roll_f) & (met <= PAIR.gear_2.roll_a), gap, np.inf))
        # a kink or the wheel's tip corner lies between two places of the brute search, which therefore can only be above
        sharp = exponent == 1 or found.roll_2[i, k] == PAIR.gear_2.roll_a
        assert -1e-9 < least - found.gap[i, k] < (1e-5 if sharp else 1e-8)
        checked += 1
    assert checked > 20


def test_a_uniform_shift_is_a_turn():
    shift = 0.01
    forms = flank_forms(PAIR, {"pinion": gf.Flank(pitch=[shift] * 24)})
    back = shift * PAIR.gear_1.r_b / PAIR.gear_1.r
    found, plain = flank_contacts(PAIR, PHASE, flanks=forms), contacts(PAIR, PHASE - back / 2 / PAIR.p_bt)
    first, other = found.order.searchsorted(0), plain.order.searchsorted(0)
    for k in (-1, 0, 1):
        at, there = found.gap[:, first + k], plain.gap[:, other + k]
        assert_allclose(at[there < 0.5], there[there < 0.5] + back, atol=1e-8)


def test_a_single_tooth_ahead_touches_before_its_place():
    pitch = [0.0] * 24
    pitch[3] = -0.008
    found = flank_contacts(PAIR, np.array([-2.5]), flanks=flank_forms(PAIR, {"pinion": gf.Flank(pitch=pitch)}))
    ahead = -0.008 * PAIR.gear_1.r_b / PAIR.gear_1.r
    assert_allclose(found.gap[0, found.order == 3], ahead, rtol=1e-6)


def test_hollow_flanks_are_refused():
    roll = np.linspace(PAIR.gear_1.roll_f, PAIR.gear_1.roll_a, 40)
    rough = gf.Flank(table=(roll, 0.05 * np.sin(12 * roll) ** 2))
    with pytest.raises(ValueError, match="the modified flanks conform at roll lengths"):
        flank_contacts(PAIR, PHASE, flanks=flank_forms(PAIR, {"pinion": rough}))


@pytest.mark.parametrize("ring", [False, True])
@pytest.mark.parametrize("driver", [True, False])
def test_arms_are_those_of_flanks_that_lean(ring, driver):
    """How fast an approach of both gears closes a point, by differences: half of one gear's part and half of the other's."""
    pair = gf.GearPair(PAIR.gear_1, gf.Gear(z=72, r_rim=125.0, addendum=0.85, rack_tip_radius=0.2, **RACK)) if ring else PAIR
    gears = pair.gear_1, pair.gear_2
    forms = flank_forms(
        pair,
        {
            "pinion": gf.Flank(profile_crowning=0.01, profile_slope=0.02),
            "wheel": gf.Flank(profile_crowning=0.01, profile_slope=-0.02),
        },
    )
    own, mate = forms if driver else forms[::-1]
    gear, sense = gears[not driver], 1 if driver else -1
    roll = gear.roll_f + np.array([0.2, 0.5, 0.8]) * (gear.roll_a - gear.roll_f)
    nominal = roll if driver else pair.outward * (pair.length - roll)
    met = approach(pair, roll, nominal, driver=driver, flanks=forms)
    distances = facing(pair, roll, nominal, driver)

    def left(gap):
        distance, there, *_ = distances(sense * (gap / 2 - own.removed(roll)))
        return distance + own.removed(roll) + mate.removed(there) - gap

    closed = (left(met.gap + 1e-4) - left(met.gap - 1e-4)) / 2e-4
    assert_allclose(closed, -(1 + met.arm / met.met_arm) / 2, rtol=5e-6)  # squares of slopes are left out
    assert np.abs(mate.slope(met.roll)).max() > 2e-3


@pytest.mark.parametrize("edge", ["tip_chamfer", "tip_rounding"])
def test_gaps_are_those_of_exchanged_gears(edge):
    """Edges of the wheel touch before the start of the path as those of the pinion do after its end, steep or round."""
    rack = {"m_n": 6.0, "alpha_n": math.radians(20), "b": 40.0, "beta": math.radians(15)}
    gears, flank = (
        (gf.Gear(z=18, x=0.16, r_bore=16.0, **rack), gf.Gear(z=28, x=-0.15, r_bore=25.0, **rack)),
        gf.Flank(**{edge: 0.5}),
    )
    pair, other, phase = gf.GearPair(*gears), gf.GearPair(*gears[::-1]), np.linspace(0.4, 0.6, 41)
    one = flank_contacts(pair, phase, flanks=flank_forms(pair, {"pinion": flank}))
    two = flank_contacts(other, pair.eps_alpha - phase, flanks=flank_forms(other, {"wheel": flank}))
    first, again = (found.gap[:, found.order.tolist().index(order)] for found, order in ((one, 1), (two, -1)))
    assert 0.02 < first[-1] < 0.5
    assert_allclose(again, first, atol=1e-9)


@pytest.mark.parametrize("side", ["pinion", "wheel"])
def test_the_ridge_of_a_chamfer_is_the_corner_of_a_shorter_tooth(side):
    """Off the path nothing of a chamfer touches but its ridge, where the tip corner of a tooth would be that ends there."""
    rack, chamfer = {"m_n": 3.0, "alpha_n": math.radians(20), "b": 40.0}, 0.3

    def pair(shorter):
        teeth = (("pinion", 25), ("wheel", 40))
        return gf.GearPair(
            *(gf.Gear(z=z, x=0.1, r_bore=10.0, addendum=1 - shorter * (name == side), **rack) for name, z in teeth)
        )

    whole, cut = pair(0.0), pair(chamfer / rack["m_n"])
    forms = flank_forms(whole, {side: gf.Flank(tip_chamfer=chamfer)})
    place = np.linspace(cut.path[0] - 1.5, cut.path[1] + 1.5, 61)
    found = flank_contacts(whole, (place - whole.path[0]) / whole.p_bt, flanks=forms)
    corner = contacts(cut, (place - cut.path[0]) / cut.p_bt)
    ridge, tip = (own.gap[:, own.order.tolist().index(0)] for own in (found, corner))
    assert (tip > 1e-6).sum() >= 10
    assert_allclose(ridge, tip, atol=1e-6)
