"""Tip edges, wear, teeth that differ, eccentric gears, and the hunting period."""

import math

import numpy as np
import pytest
from full_contact import full_contact
from numpy.testing import assert_allclose
from usual import PAIR_24_36 as PAIR
from usual import RACK_3 as RACK
from usual import STEEL

import gearfe as gf
from gearfe.geometry.pair.approach import approach
from gearfe.geometry.pair.flanks import flank_forms
from gearfe.geometry.pair.modified import flank_contacts
from gearfe.geometry.tooth.profile import cartesian, flank, flank_normal

LOAD = 3000.0


def solved(flanks=None, method="ritz", **options):
    return gf.mesh_stiffness(PAIR, LOAD, STEEL, method=method, flanks=flanks, **({"phases": 16} | options))


def both(**edge):
    return {"pinion": gf.Flank(**edge), "wheel": gf.Flank(**edge)}


RING = gf.Gear(z=60, r_rim=110.0, rack_tip_radius=0.3, **RACK)


@pytest.mark.parametrize("gear", [PAIR.gear_1, PAIR.gear_2, RING], ids=["z24", "z36", "ring"])
def test_a_rounding_is_the_arc_that_touches_flank_and_tip_circle(gear):
    size = 0.25
    form = gf.Flank(tip_rounding=size).on(gear)
    roll = form.edge.start + (gear.roll_a - form.edge.start) * np.array([0.0, 0.2, 0.5, 0.8, 0.999, 1.0])
    radius, angle = flank(gear, roll)
    points = cartesian(radius, angle - form.removed(roll) / gear.r_b)
    middle = points[:, 0] - size * flank_normal(gear, roll[0])
    assert_allclose(np.hypot(*(points - middle[:, None])), size, rtol=1e-11)
    assert_allclose(np.hypot(*middle) + gear.outward * size, gear.r_a, rtol=1e-13)
    assert_allclose(form.bend(roll[:1]), 0.0, atol=1e-15)
    assert_allclose(1 / roll[1:] * gear.outward + form.bend(roll[1:]), 1 / size)
    before = form.edge.start - gear.outward * 1e-3
    assert form.removed(before) == 0
    assert form.removed(np.array([gear.roll_a]))[0] > 0.4 * size


def test_a_chamfer_is_a_straight_cut():
    gear, size = PAIR.gear_1, 0.3
    form = gf.Flank(tip_chamfer=size).on(gear)
    roll = form.edge.start + (gear.roll_a - form.edge.start) * np.array([0.0, 0.3, 0.6, 0.9, 1.0])
    radius, angle = flank(gear, roll)
    points = cartesian(radius, angle - form.removed(roll) / gear.r_b)
    assert_allclose(radius[0], gear.r_a - size)
    cut = (points[:, 1:] - points[:, :1]) / np.hypot(*(points[:, 1:] - points[:, :1]))
    assert_allclose(-flank_normal(gear, roll[0]) @ cut, math.sin(math.pi / 4), rtol=1e-9)
    assert_allclose(form.edge.kink, form.removed(roll[0] + 1e-6) / 1e-6, rtol=1e-5)
    assert_allclose(form.bend(roll[0]), 0.0, atol=1e-15)


@pytest.mark.parametrize(("edge", "fits", "crosses"), [("tip_rounding", 0.3, 0.8), ("tip_chamfer", 0.3, 0.6)])
def test_an_edge_beyond_the_centre_line_is_refused(edge, fits, crosses):
    pointed = PAIR.gear_1 if edge == "tip_chamfer" else gf.Gear(z=9, r_bore=4.0, x=0.5, **RACK)
    assert gf.Flank(**{edge: fits}).on(pointed).edge.most > 0
    with pytest.raises(ValueError, match=f"{edge} = {crosses} mm cuts beyond the centre-line of a tooth of z = {pointed.z}"):
        gf.Flank(**{edge: crosses}).on(pointed)


@pytest.mark.parametrize("size", [0.02, 0.1, 0.3])
@pytest.mark.parametrize("phase", [0.96875, 0.99, 0.67])
def test_gaps_of_rounded_tips_are_the_least_over_both_flanks(size, phase):
    """Every point of both flanks, edges included, brought to touch by `approach`: none is nearer than the gap found."""
    forms = flank_forms(PAIR, both(tip_rounding=size))
    found = flank_contacts(PAIR, [phase], flanks=forms)
    for k in np.flatnonzero(found.gap[0] < 0.05).tolist():
        least = []
        for driver, gear, other, form in (
            (True, PAIR.gear_1, PAIR.gear_2, forms[0]),
            (False, PAIR.gear_2, PAIR.gear_1, forms[1]),
        ):
            roll = np.concatenate(
                [np.linspace(gear.roll_f, form.edge.start, 400), np.linspace(form.edge.start, gear.roll_a, 2000)]
            )
            gap, met = approach(
                PAIR,
                roll,
                np.full(roll.size, found.nominal[0, k]),
                driver=driver,
                flanks=forms,
                order=int(found.order[k]),
                start=0.02,
            )[:2]
            on = np.isfinite(gap) & (met >= other.roll_f) & (met <= other.roll_a)
            least.append(gap[on].min(initial=np.inf))
        assert_allclose(found.gap[0, k], min(least), atol=3e-6)  # [mm]; the points are some um apart
    assert (found.gap[0] < 0.05).sum() == 2


def test_a_vanishing_rounding_is_the_sharp_corner():
    """Rows of hats on a rounded tip and at a sharp corner are found in different ways: 0.41 % at most between them.

    Off the path a sharp corner yields across its involute's normal too, which rows on rounded tips leave out (0.3 % without it).
    """
    phase = np.arange(32) / 32
    sharp, tiny, small = (
        solved(phases=phase),
        solved(both(tip_rounding=1e-3), phases=phase),
        solved(both(tip_rounding=0.1), phases=phase),
    )
    assert_allclose(tiny.te, sharp.te, rtol=4.2e-3)
    assert (small.te > sharp.te * (1 - 4e-3)).all()  # what is cut off carries nothing
    inside = (phase > 0.1) & (phase < PAIR.eps_alpha - 1.1)
    assert_allclose(small.te[inside], sharp.te[inside], rtol=1e-3)
    assert np.isfinite(solved(both(tip_chamfer=0.2), phases=phase).te).all()


@pytest.mark.slow
def test_full_contact_on_rounded_tips():
    flanks, phase = both(tip_rounding=0.3), 0.625
    full = full_contact(PAIR, LOAD / 20, phase, (STEEL, STEEL), flanks=flank_forms(PAIR, flanks), per_width=12)
    assert_allclose(solved(flanks, phases=[phase]).te[0], full.approach * 1e-3, rtol=5e-3)


@pytest.mark.slow
def test_rounded_tips_in_three_dimensions():
    """Softer than sharp corners as much as in the section, but for what strips know of an arc's ends."""
    rack = RACK | {"b": 6.0}
    pair = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **rack), gf.Gear(z=36, r_bore=20.0, **rack))
    solid, plane = (
        [gf.mesh_stiffness(pair, 300.0, STEEL, flanks=f, phases=[0.66], **given).te[0] for f in (None, both(tip_rounding=0.3))]
        for given in ({"method": "ritz3d", "order": 2}, {"method": "ritz"})
    )
    assert plane[1] > 1.05 * plane[0]
    assert_allclose(solid[1] / solid[0], plane[1] / plane[0], rtol=0.02)


def test_wear_is_what_is_worn_off():
    rolls, depth = [PAIR.gear_1.roll_f, 12.0, PAIR.gear_1.roll_a], [0.004, 0.0, 0.006]
    worn, table = solved({"pinion": gf.Flank(wear=(rolls, depth))}), solved({"pinion": gf.Flank(table=(rolls, depth))})
    assert_allclose(worn.te, table.te, rtol=1e-12)
    form = gf.Flank(wear=([10.0, 11.0, 12.0], [0.0, 0.005, 0.0]), profile_slope=0.002).on(PAIR.gear_1)
    plain = gf.Flank(profile_slope=0.002).on(PAIR.gear_1)
    at = np.array([9.0, 11.0, 14.0])
    assert_allclose(form.removed(at) - plain.removed(at), [0.0, 0.005, 0.0], atol=1e-15)


def test_teeth_with_forms_of_their_own():
    """Tooth 0 slopes twice as much as the others: alone in contact it is as if all did, and elsewhere as if none."""
    relief = {"profile_slope": 0.01, "profile_crowning": 0.002}
    scales = [2.0] + [1.0] * 23
    at = np.array([PAIR.eps_alpha - 0.75, 5.85])  # one pair in contact: that of tooth 0, and that of another
    found = solved({"pinion": gf.Flank(**relief, tooth_scale=scales)}, phases=at)
    once, twice = (
        solved({"pinion": gf.Flank(**{name: a * amount for name, amount in relief.items()})}, phases=at) for a in (1, 2)
    )
    assert_allclose(found.te, [twice.te[0], once.te[1]], rtol=1e-9)
    assert abs(once.te[0] / twice.te[0] - 1) > 1e-6
    one = solved({"pinion": gf.Flank(**relief, tooth_scale=[1.0] * 24)}, phases=at)
    assert_allclose(one.te, once.te, rtol=1e-12)


@pytest.mark.parametrize("side", ["pinion", "wheel"])
def test_an_eccentric_gear_swings_once_a_turn(side):
    """Unloaded, a gear whose centre lies e off its axis leads and lags by e, as a sine of its own turn, without steps."""
    e, gear = 0.004, PAIR.gear_1 if side == "pinion" else PAIR.gear_2
    phase = np.arange(0, gear.z, 0.5)
    found = solved({side: gf.Flank(eccentricity=e, eccentric_tooth=3.0)}, phases=phase)
    swing = np.fft.rfft(found.unloaded * 1e3) / phase.size * 2
    assert_allclose(abs(swing[1]), e, rtol=1e-2)
    assert_allclose(abs(swing[2:]).max(), 0.0, atol=1e-2 * e)
    away = np.abs(np.diff(found.unloaded, append=found.unloaded[0])).max() * 1e3
    assert away < 1.05 * e * 2 * math.pi / gear.z / 2  # half a cycle further


def test_eccentric_gears_and_their_cumulative_pitch():
    """At the reference circle a flank lies as far back as its tooth's pitch deviation of ``-e sin`` says."""
    e, gear = 0.01, PAIR.gear_1
    form = flank_forms(PAIR, {"pinion": gf.Flank(eccentricity=e)})[0]
    roll = math.sqrt(gear.r**2 - gear.r_b**2)
    back = form.of(np.arange(gear.z)).removed(np.full(gear.z, roll))
    turn = gear.half_thickness(gear.r) + 2 * math.pi * np.arange(gear.z) / gear.z - gear.alpha_t
    assert_allclose(back, e * np.sin(turn), atol=1e-12)


@pytest.mark.slow
def test_a_hunting_period_meets_all_pairs_once():
    small = gf.GearPair(gf.Gear(z=12, x=0.3, r_bore=8.0, **RACK), gf.Gear(z=18, r_bore=15.0, **RACK))
    flanks = {
        "pinion": gf.Flank(pitch=gf.random_pitch(small.gear_1, 6, seed=1)),
        "wheel": gf.Flank(pitch=gf.random_pitch(small.gear_2, 6, seed=2)),
    }
    found = gf.mesh_stiffness(small, LOAD, STEEL, method="ritz", flanks=flanks, span="hunting", phases=2)
    assert found.phase.size == 36 * 2
    some = gf.mesh_stiffness(small, LOAD, STEEL, method="ritz", flanks=flanks, phases=found.phase[50:54])
    assert_allclose(found.te[50:54], some.te, rtol=1e-9)
    own = np.flatnonzero(np.isin(found.order, some.order))
    assert_allclose(found.force[50:54][:, own], some.force, atol=1e-6)


def test_a_huge_hunting_period_is_refused_with_its_number():
    pair = gf.GearPair(gf.Gear(z=53, r_bore=15.0, **RACK), gf.Gear(z=107, r_bore=20.0, **RACK))
    with pytest.raises(ValueError, match=r"has 5671 mesh cycles .the least common multiple .* give span = 'revolution'"):
        gf.mesh_stiffness(pair, LOAD, STEEL, span="hunting", phases=16)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"tip_rounding": 0.1, "tip_chamfer": 0.1}, "a tip has one edge, give one"),
        ({"tip_rounding": 2.0}, "tip_rounding = 2 mm, but give one between 0 and 0.9 mm"),
        ({"tip_chamfer": -0.1}, "tip_chamfer = -0.1 mm, but give one between"),
        ({"wear": ([1.0, 2.0], [0.0, -0.01])}, "wear removes material"),
        ({"wear": ([2.0, 1.0], [0.0, 0.01])}, "the roll lengths rising"),
        ({"wear": ([2.0, 20.0], [0.0, 1.0])}, "wear: the flank of z = 24 deviates by 0\\.967 mm"),
        ({"tooth_scale": [1.0, 2.0]}, r"tooth_scale = \(1\.0, 2\.0\): 2 values, but z = 24"),
        ({"eccentricity": 1.0}, "eccentricity = 1 mm: the flank of z = 24 deviates by 1 mm"),
        ({"profile_slope": 0.2, "tooth_scale": [2.0] * 24}, "profile_slope = 0.2 mm: the flank of z = 24 deviates by 0.4 mm"),
    ],
)
def test_impossible_ones_are_refused(given, message):
    with pytest.raises(ValueError, match=message):
        solved({"pinion": gf.Flank(**given)})
