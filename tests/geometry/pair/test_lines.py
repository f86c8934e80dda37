"""Contact lines: closed forms of their total length, both hands, the spur limit, the groove, and what pits take."""

import math
from dataclasses import replace

import numpy as np
import pytest
from checks import lost_width
from numpy.testing import assert_allclose
from scipy.integrate import quad
from scipy.optimize import brentq

import gearfe as gf
from gearfe.flexibility.energy.closed.slices import stations
from gearfe.geometry.pair.contacts import contacts
from gearfe.geometry.pair.lines import contact_lines, face_bands, lost_length, removed, total_length
from gearfe.geometry.tooth.profile import arc_at

RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
PHASES = np.linspace(0, 1, 4001)[:-1] + 1e-4


def helical(beta=15.0, b=30.0, ring=False, **numbers):
    rack = RACK | {"b": b} | numbers
    if ring:
        wheel = gf.Gear(z=72, r_rim=95.0, rack_tip_radius=0.3, addendum=0.8, beta=math.radians(beta), **rack)
    else:
        wheel = gf.Gear(z=31, r_bore=11.0, beta=math.radians(-beta), **rack)
    return gf.GearPair(gf.Gear(z=21, r_bore=7.0, beta=math.radians(beta), **rack), wheel)


def overlap(pair):
    return pair.gear_1.b * math.tan(abs(pair.gear_1.beta_b)) / pair.p_bt


@pytest.mark.parametrize("ring", [False, True], ids=["gear", "ring"])
@pytest.mark.parametrize(("beta", "b"), [(15.0, 30.0), (-28.0, 11.0), (5.0, 80.0), (35.0, 10.0)])
def test_mean_total_length(beta, b, ring):
    pair = helical(beta, b, ring)
    total = total_length(pair, PHASES)
    assert_allclose(total.mean(), pair.eps_alpha * b / math.cos(pair.gear_1.beta_b), rtol=1e-7)
    assert np.ptp(total) > 1e-3 * total.mean(), "no whole contact ratio here: the length must change"


def test_whole_overlap_ratio_keeps_the_length_constant():
    pair = helical()
    for count in (1, 2):
        wide = helical(b=count * pair.p_bt / math.tan(pair.gear_1.beta_b))
        assert_allclose(overlap(wide), count)
        assert_allclose(total_length(wide, PHASES), pair.eps_alpha * wide.gear_1.b / math.cos(pair.gear_1.beta_b), rtol=1e-12)


def test_whole_transverse_contact_ratio_keeps_the_length_constant():
    deep = {"beta": 10.0, "dedendum": 1.6, "rack_tip_radius": 0.2}
    high = brentq(lambda h: helical(addendum=h, **deep).eps_alpha - 2.0, 1.0, 1.4)
    pair = helical(addendum=high, **deep)
    assert_allclose(total_length(pair, PHASES), 2 * 30.0 / math.cos(pair.gear_1.beta_b), rtol=1e-9)


def test_line_lies_on_both_flanks_and_in_the_face():
    pair = helical(-20.0)
    lines = contact_lines(pair, PHASES[::97])
    for z in (lines.low, lines.high):
        roll_1, roll_2 = (r[lines.high > lines.low] for r in lines.rolls(z))
        assert roll_1.min() > pair.path[0] - 1e-9
        assert roll_1.max() < pair.path[1] + 1e-9
        assert_allclose(roll_1 + roll_2, pair.length, rtol=1e-12)
    rise = (lines.rolls(lines.high)[0] - lines.rolls(lines.low)[0])[lines.high > lines.low]
    # in the plane of action: along the axis high - low, across it the rise of the roll length
    assert_allclose(np.hypot(rise, (lines.high - lines.low)[lines.high > lines.low]), lines.length[lines.high > lines.low])
    assert (rise < 0).all(), "with a negative beta the far end is behind"


def test_a_section_of_a_helical_pair_is_the_spur_pair_at_its_phase():
    pair, z, phase = helical(25.0), 12.3, 0.37
    lines = contact_lines(pair, phase)
    shift = z * math.tan(pair.gear_1.beta_b) / pair.p_bt
    touching = (lines.low <= z) & (z <= lines.high) & (lines.high > lines.low)
    own = contacts(pair, phase + shift, extended=False)
    assert_allclose(lines.rolls(np.full(lines.low.shape, z))[0][touching], own.roll_1[np.isfinite(own.gap)], rtol=1e-12)
    assert touching.sum() in (1, 2)


def test_hands_are_mirror_images():
    right, left = total_length(helical(17.0), PHASES), contact_lines(helical(-17.0), PHASES)
    # the mirror image at the other end's phase
    pair = helical(17.0)
    assert_allclose(total_length(pair, PHASES - overlap(pair)), left.length.sum(axis=(1, 2)), rtol=1e-12)
    assert np.abs(right - left.length.sum(axis=(1, 2))).max() > 0.1


def test_small_helix_angle_is_spur():
    spur, nearly = (total_length(helical(beta), np.array([0.1, 0.4, 0.8])) for beta in (0.0, 1e-7))
    number = np.isfinite(contacts(helical(0.0), [0.1, 0.4, 0.8], extended=False).gap).sum(axis=1)
    assert_allclose(spur, 30.0 * number, rtol=1e-12)
    assert_allclose(nearly, spur, rtol=1e-6)
    assert_allclose(total_length(helical(1e-300), np.array([0.1, 0.4, 0.8])), spur, rtol=1e-12)


@pytest.mark.parametrize("groove", [0.0, 6.0])
def test_herringbone_is_two_halves(groove):
    pair = helical(24.0)
    half = helical(24.0, b=(30.0 - groove) / 2)
    total = total_length(pair, PHASES, face="herringbone", groove=groove)
    assert_allclose(total, 2 * total_length(half, PHASES), rtol=1e-12)
    assert_allclose(total.mean(), pair.eps_alpha * (30.0 - groove) / math.cos(pair.gear_1.beta_b), rtol=1e-7)
    lines = contact_lines(pair, PHASES[::500], face="herringbone", groove=groove)
    assert_allclose(lines.low[..., 0] + lines.high[..., 1], 30.0, rtol=1e-12, err_msg="mirrored about the middle of the face")
    assert lines.low[..., 1].min() >= 15.0 + groove / 2


def test_agrees_with_the_slices_of_the_closed_forms():
    """They let the end z = 0 touch first: the hand of a negative beta."""
    pair = helical(-15.0)
    for face in ("helical", "herringbone"):
        pits = ([gf.Pit(radius=21.5, z=9.0, axes=(0.8, 1.2), depth=0.1)], [])
        case = gf.Case(pair, 1.0, gf.Material(), face=face, damage={"pinion": pits[0]})
        found = stations(case, PHASES[::400], lost="slices")
        slices = np.bincount(found.phase, found.weight, minlength=10) * 30.0 / math.cos(pair.gear_1.beta_b)
        assert_allclose(total_length(pair, PHASES[::400], face=face, pits=pits), slices, rtol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("beta", [0.0, 0.01, 15.0, -35.0])
def test_a_pit_takes_its_area_out_of_the_passing_lines(beta):
    """Integrated over the phases, the lost length is the area of the pit in the (roll, z) plane, over cos(beta_b)."""
    pair = helical(beta)
    gear = pair.gear_1
    pit = gf.Pit(radius=pair.pitch_radius_1, z=14.0, axes=(0.7, 1.6), depth=0.1, angle=0.4)
    phase = np.linspace(-3, 4, 7001)
    lines = contact_lines(pair, phase)
    lost = lost_length(lines, ([pit], []))
    at = lambda roll: float(lost_width(gear, [pit], np.array(arc_at(gear, roll))))  # noqa: E731
    area = quad(at, *pair.path, limit=400, epsrel=1e-9)[0]
    assert_allclose(lost.sum() * 7 / 7000 * pair.p_bt, area / math.cos(gear.beta_b), rtol=2e-4)
    assert set(lines.order[removed(lines, ([pit], [])).column]) == {0}


def test_pits_of_the_wheel_overlapping_and_unloaded():
    pair = helical(12.0)
    pit = gf.Pit(radius=pair.pitch_radius_2, z=10.0, axes=(1.0, 1.0), depth=0.1, tooth=1)
    lines = contact_lines(pair, PHASES[::40] + 1)
    once = lost_length(lines, ([], [pit]))
    assert once.max() > 1.5
    assert set(lines.order[removed(lines, ([], [pit])).column]) == {-1}, "pair k is made by the wheel's tooth -k"
    assert_allclose(lost_length(lines, ([], [pit, pit])), once, rtol=1e-12)
    assert removed(lines, ([], [replace(pit, side="unloaded")])).low.size == 0
    narrow = gf.GearPair(replace(pair.gear_1, b=10.0), pair.gear_2)
    moved = contact_lines(narrow, PHASES[::40] + 1)
    found = removed(moved, ([], [pit]))
    assert found.high.max() <= 1.0 + 1e-9, "the wheel's z = 10 is the end of the narrower pinion's face"
    assert found.low.min() >= 0
    assert found.low.size


def test_a_pit_over_the_whole_line_leaves_nothing():
    pair = helical(20.0, b=8.0)
    pit = gf.Pit(radius=pair.pitch_radius_1, z=4.0, axes=(60.0, 60.0), depth=0.1)
    lines = contact_lines(pair, PHASES[::100])
    own = lines.order == 0
    assert_allclose(lost_length(lines, ([pit], []))[:, own], lines.length[:, own], rtol=1e-9)


def test_bad_faces_are_refused():
    pair = helical()
    for numbers, message in (
        ({"face": "worm"}, "must be one of"),
        ({"face": "spur"}, "have a helix angle"),
        ({"groove": 2.0}, "only face = 'herringbone'"),
        ({"face": "herringbone", "groove": 30.0}, "between 0 and the face width"),
    ):
        with pytest.raises(ValueError, match=message):
            face_bands(pair, **numbers)
