"""Flanks modified along the width, and axes askew, in three dimensions: identities and pure geometry."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import RACK_15 as RACK
from usual import STEEL, pair_24_30

import gearfe as gf
from gearfe.geometry.pair.flanks import tilt_of
from validation.shared.solid_pair import solid_contact

PHASES = [0.07, 0.33, 0.86]


PAIR = pair_24_30(1, 12)


def solved(flanks=None, force=2000.0, pair=PAIR, phases=PHASES, **options):
    return gf.mesh_stiffness(pair, force, STEEL, phases=phases, flanks=flanks, **({"method": "ritz3d", "order": 2} | options))


def test_a_uniform_shift_changes_the_unloaded_error_only():
    shift = 0.012
    found, plain = solved({"pinion": gf.Flank(pitch=[shift] * 24), "wheel": gf.Flank(pitch=[shift] * 30)}), solved()
    assert_allclose(found.k, plain.k, rtol=1e-5)
    assert_allclose(found.unloaded, 2e-3 * shift * PAIR.gear_1.r_b / PAIR.gear_1.r, rtol=1e-6)


def test_mirrored_gears_mirror():
    askew, other = (solved(pair=pair_24_30(hand, 12), misalignment=gf.Misalignment(F_beta_x=hand * 0.015)) for hand in (1, -1))
    assert_allclose(askew.te, other.te, rtol=1e-6)
    assert_allclose(askew.pressure, other.pressure, rtol=1e-5)
    flat = solved(misalignment=gf.Misalignment(F_beta_x=-0.015))
    assert np.abs(flat.te / askew.te - 1).max() > 0.01  # the sign matters


def test_misalignment_is_a_helix_slope_of_either_gear():
    slopes = [{name: gf.Flank(helix_slope=0.01)} for name in ("pinion", "wheel")]
    askew = solved(misalignment=gf.Misalignment(F_beta_x=0.01))
    for one in slopes:  # half the slope in the middle is a shift of one gear, a turn by phase
        assert_allclose(solved(one).deflection, askew.deflection, rtol=2e-3)
        assert_allclose(solved(one).unloaded - askew.unloaded, 5e-6, rtol=1e-3)


def test_misalignment_of_axes_is_what_is_left_in_the_plane_of_action():
    out_of_plane, in_plane = (gf.Misalignment(**{name: 0.02, "length": 60.0}) for name in ("f_sigma_beta", "f_sigma_delta"))
    assert tilt_of(PAIR, out_of_plane) == pytest.approx(0.02 / 60 * math.cos(PAIR.alpha_wt))
    assert tilt_of(PAIR, in_plane) == pytest.approx(0.02 / 60 * math.sin(PAIR.alpha_wt))
    assert tilt_of(PAIR, gf.Misalignment(F_beta_x=0.015)) == pytest.approx(0.001)


@pytest.mark.slow
def test_the_unloaded_error_is_that_of_pure_geometry():
    """Profile crowning C and a helix slope S: the least of ``C p**2 + S z / b`` over the lines of contact, by hand."""
    crowning, slope = 0.002, 0.0006
    flank = gf.Flank(profile_crowning=crowning, helix_slope=slope)
    phase = np.arange(12) / 12
    found = solved({"pinion": flank}, force=0.1, phases=phase)
    gear, steep = PAIR.gear_1, math.tan(abs(PAIR.gear_1.beta_b))
    middle, span = (gear.roll_a + gear.roll_f) / 2, gear.roll_a - gear.roll_f
    start, end = PAIR.path
    best = np.full(phase.size, np.inf)
    for order in range(-2, 4):
        roll = start + (phase + order) * PAIR.p_bt  # at z = 0, falling with z
        low, high = np.clip((roll - end) / steep, 0, gear.b), np.clip((roll - start) / steep, 0, gear.b)
        flat = middle + slope * span**2 / (8 * crowning * steep * gear.b)  # where the sum is least along a line
        z = np.clip((roll - flat) / steep, low, high)
        gap = crowning * (2 * (roll - steep * z - middle) / span) ** 2 + slope * z / gear.b
        best = np.where(high > low, np.minimum(best, gap), best)
    away = np.abs(found.unloaded * 1e3 - best).max() / np.ptp(best)
    print(f"unloaded {1e3 * np.ptp(best):.3f} um peak-to-peak, {100 * away:.2f} % off; loaded {1e6 * np.ptp(found.te):.3f} um")
    assert away < 0.01  # second order: ten times larger amounts bend the contact 6 % off
    assert_allclose(np.ptp(found.te), np.ptp(best) * 1e-3, rtol=0.03)  # 0.1 N adds little


def test_crowning_carries_in_the_middle_and_misalignment_at_an_end():

    spur = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **RACK), gf.Gear(z=30, r_bore=18.0, **RACK))
    centre = []
    for flanks, askew in (({"pinion": gf.Flank(helix_crowning=0.02)}, 0.0), ({}, 0.02), ({}, -0.02)):
        found = solid_contact(
            spur, 1500.0, STEEL, [0.75], flanks=flanks, misalignment=gf.Misalignment(F_beta_x=askew), face="spur", order=2
        )
        cells = found.cells[0]
        centre.append(cells.load @ cells.z / cells.load.sum())
        line = cells.load / cells.width
        middle, ends = line[np.abs(cells.z - 7.5) < 1].mean(), line[[0, -1]].mean()
        assert askew or middle > 2 * ends
    assert_allclose(centre[0], 7.5, atol=0.01)
    assert_allclose(centre[1] + centre[2], 15.0, atol=0.01)
    assert centre[1] < 6.5  # positive: open at z = b


def test_topography_is_what_it_tabulates():
    """A grid that holds crowning and helix slope gives what they give."""
    gear = PAIR.gear_1
    rolls, heights = np.linspace(gear.roll_f, gear.roll_a, 7), np.linspace(0, gear.b, 9)
    shape = gf.Flank(helix_crowning=0.012, helix_slope=0.004, twist=0.003, profile_crowning=0.005)
    form = shape.on(gear).at(heights)
    grid = form.removed(rolls[None, :]).T
    found, expected = solved({"pinion": gf.Flank(topography=(rolls, heights, grid))}), solved({"pinion": shape})
    assert_allclose(found.te, expected.te, rtol=1e-6)


def test_poses_and_auto_take_them():
    flanks = {"pinion": gf.Flank(helix_crowning=0.01), "wheel": gf.Flank(tip_relief=0.01, tip_start_roll=PAIR.gear_2.roll_a - 4)}
    turned = solved(flanks, phases=PHASES[:1], pose="pinion")
    mean = solved(flanks, phases=turned.phase + turned.te * 1e3 / 2 / PAIR.p_bt)
    assert_allclose(turned.te, mean.te, rtol=1e-4)
    assert gf.mesh_stiffness(PAIR, 2000.0, STEEL, phases=[0.5], flanks=flanks, order=2).meta["method"] == "ritz3d"


def test_a_herringbone_pair_takes_misalignment():
    double = replace(PAIR, gear_1=replace(PAIR.gear_1, b=30.0), gear_2=replace(PAIR.gear_2, b=30.0))
    run = {"pair": double, "face": "herringbone", "phases": [0.3], "force": 4000.0}
    plain, askew = (solved(misalignment=one, **run) for one in (None, gf.Misalignment(F_beta_x=0.01)))
    assert askew.k[0] < 0.97 * plain.k[0]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"end_relief": 0.01}, "give a length > 0"),
        ({"end_relief": 0.01, "end_length": 20.0}, "is 15 mm wide"),
        ({"end_relief": (0.01, 0.02, 0.03), "end_length": 2.0}, "give one finite number, or two"),
        ({"helix_crowning": 10.0}, "a tenth of the module, 0.3 mm, is the limit"),
        ({"topography": ([1, 2], [0, 15], [[0, 0], [0, math.nan]])}, "holes"),
        ({"topography": ([1, 2], [0, 15], [[0, 0, 0], [0, 0, 0]])}, "a row for each roll length"),
        ({"topography": ([1, 2], [0, 15], [[0, 0], [0, 0]])}, "roll length does not cover the flank"),
        ({"topography": ([0, 20], [0, 10], [[0, 0], [0, 0]])}, "height does not cover the flank"),
    ],
)
def test_impossible_flanks_are_refused(given, message):
    with pytest.raises(ValueError, match=message):
        solved({"pinion": gf.Flank(**given)})


@pytest.mark.parametrize("hand", [1, -1])
def test_plain_sums_of_helical_pairs_close_the_gaps_of_their_slices(hand):
    """Where all slices touch, a linear gap takes nothing of the stiffness; under a light load most of it is gone."""
    pair = pair_24_30(hand, 12)
    options = {"method": "textbook", "face": "helical", "order": None, "phases": np.arange(8) / 8, "pair": pair}
    plain, askew = (solved(misalignment=one, force=9000.0, **options) for one in (None, gf.Misalignment(F_beta_x=hand * 0.004)))
    assert_allclose(askew.k_tangent, plain.k_tangent, rtol=2e-3)
    assert_allclose(askew.te, plain.te, atol=0.7e-6)
    assert (np.abs(askew.te - plain.te) > 1e-9).any()
    light = solved(misalignment=gf.Misalignment(F_beta_x=hand * 0.02), force=100.0, **options)
    assert (light.k < 0.6 * plain.k).all()
    mirror = solved(
        misalignment=gf.Misalignment(F_beta_x=-hand * 0.02), force=100.0, **(options | {"pair": pair_24_30(-hand, 12)})
    )
    assert_allclose(light.k, mirror.k, rtol=1e-9)


def test_a_section_says_that_it_knows_no_width():
    for options in ({"flanks": {"pinion": gf.Flank(twist=0.01)}}, {"misalignment": gf.Misalignment(F_beta_x=0.01)}):
        with pytest.raises(ValueError, match=r"is two-dimensional: use method = 'ritz3d', 'fe3d' or"):
            gf.mesh_stiffness(PAIR, 2000.0, STEEL, method="ritz", **options)
    with pytest.raises(ValueError, match=r"um per mm of width"):
        solved(misalignment=gf.Misalignment(F_beta_x=20.0))
    with pytest.raises(ValueError, match="give length, the span of the bearings"):
        gf.Misalignment(f_sigma_beta=0.01)
    with pytest.raises(ValueError, match="give a Misalignment"):
        solved(misalignment=0.01)


@pytest.mark.slow
def test_the_pattern_marks_edge_contact(tmp_path):
    found = gf.contact_pattern(PAIR, 2000.0, STEEL, misalignment=gf.Misalignment(F_beta_x=0.02), phases=4)
    assert {z for cells in found.cells for z, _ in cells.at_ends(PAIR)} == {0.0}
    figure = gf.plot_contact(PAIR, found, None, tmp_path / "pattern.png")
    assert any("end face" in text.get_text() for text in figure.legends[0].get_texts())
    crowned = {"pinion": gf.Flank(helix_crowning=0.03)}
    relief = {"wheel": gf.Flank(tip_relief=0.03, tip_start_roll=PAIR.gear_2.roll_a - 4, tip_exponent=2)}
    soft = gf.contact_pattern(PAIR, 500.0, STEEL, flanks=crowned | relief, phases=[0.4])
    assert not soft.cells[0].at_ends(PAIR)


@pytest.mark.slow
def test_kinks_in_three_dimensions_are_those_of_the_section():
    """Even loads along the width: contact on the ridge where a linear relief starts closes as in the plane, which resolves it."""
    rack = {"m_n": 3.0, "alpha_n": math.radians(20), "b": 100.0}
    pair = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **rack), gf.Gear(z=36, r_bore=20.0, **rack))
    flanks = {
        name: gf.Flank(tip_relief=0.03, tip_start_roll=gear.roll_a - 4.0, tip_exponent=1)
        for name, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2))
    }
    for force, phase in ((4000.0, 0.21875), (15000.0, 0.4375)):  # 3 to 6 % apart without the kinks
        plane = gf.mesh_stiffness(pair, force, STEEL, method="ritz", phases=[phase], flanks=flanks)
        run = {"face": "spur", "axial": 0, "step": 20.0, "flanks": flanks}
        solid = solid_contact(pair, force, STEEL, plane.phase, **run)
        assert_allclose(1e-3 * solid.approach, plane.te, rtol=0, atol=0.003 * plane.deflection.mean())
