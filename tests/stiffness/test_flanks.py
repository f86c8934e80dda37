"""Stiffness and transmission error of modified flanks."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import PAIR_24_36 as PAIR
from usual import RACK_3 as RACK
from usual import STEEL

import gearfe as gf
from gearfe.geometry.pair.contacts import contacts
from gearfe.geometry.pair.flanks import flank_forms
from gearfe.geometry.pair.modified import flank_contacts

LOAD = 3000.0  # N, 150 N/mm


def relieved(amount, length, exponent=1.0, pair=PAIR, **more):
    return {
        name: gf.Flank(tip_relief=amount, tip_start_roll=gear.roll_a - gear.outward * length, tip_exponent=exponent, **more)
        for name, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2))
    }


def solved(flanks, force=LOAD, method="ritz", pair=PAIR, **options):
    return gf.mesh_stiffness(pair, force, STEEL, method=method, flanks=flanks, **options)


@pytest.mark.parametrize("method", ["ritz", "coupled", "textbook", "herringbone_article"])
def test_no_modification_is_an_involute(method):
    plain = solved(None, method=method)
    assert_allclose(solved({"pinion": gf.Flank(), "wheel": gf.Flank()}, method=method).k, plain.k, rtol=0)
    tiny = solved({"pinion": gf.Flank(profile_slope=1e-12)}, method=method)
    assert_allclose(tiny.k, plain.k, rtol=1e-6)
    assert_allclose(tiny.te, plain.te, rtol=1e-6)


def test_a_uniform_shift_changes_the_unloaded_error_only():
    shift = 0.012
    flanks = {"pinion": gf.Flank(pitch=[shift] * 24), "wheel": gf.Flank(pitch=[shift] * 36)}
    found, plain = solved(flanks), solved(None)
    assert_allclose(found.k, plain.k, rtol=1e-6)
    assert_allclose(found.unloaded, 2e-3 * shift * math.cos(RACK["alpha_n"]), rtol=1e-6)
    assert_allclose(found.te - found.unloaded, plain.te, rtol=1e-6)


@pytest.mark.parametrize("exponent", [1.0, 2.0])
def test_mirrored_gears_mirror(exponent):
    gear = gf.Gear(z=25, r_bore=15.0, **RACK)
    pair = gf.GearPair(gear, gear)
    phase = np.linspace(0.03, 0.97, 12)
    one, other = (solved(relieved(0.02, 4.0, exponent, pair), pair=pair, phases=p) for p in (phase, (pair.eps_alpha - phase) % 1))
    assert_allclose(one.te, other.te, rtol=2e-3)


def test_a_relief_can_flatten_the_error_at_one_load():
    """Munro, Gregory, Harris: linear reliefs that make up for the deflection between one and two pairs."""
    found = gf.transmission_error(PAIR, [2000.0, LOAD, 4000.0], STEEL, flanks=relieved(0.010, 4.7))
    plain = gf.transmission_error(PAIR, [LOAD], STEEL)
    print(f"peak-to-peak {1e6 * plain.peak_to_peak[0]:.2f} um of involutes; {np.round(1e6 * found.peak_to_peak, 2)} um relieved")
    assert found.peak_to_peak[1] < 0.15 * plain.peak_to_peak[0]
    assert (found.peak_to_peak[[0, 2]] > 2 * found.peak_to_peak[1]).all()
    # what is left: most of it is slow, not at corners
    assert found.harmonics(1)[1, 0] < 0.15 * plain.harmonics(1)[0, 0]


def test_a_tooth_ahead_takes_load_from_its_neighbours():
    pitch = [0.0] * 24
    pitch[0] = -0.010
    phase = np.arange(-1, 2, 1 / 16)
    found, plain = (solved(flanks, phases=phase) for flanks in ({"pinion": gf.Flank(pitch=pitch)}, None))
    column, other = found.order.tolist().index(0), plain.order.tolist().index(0)
    both = (plain.share[:, other] > 0.2) & (plain.share[:, other] < 0.8)
    assert (found.share[both, column] > plain.share[both, other]).all()
    assert found.unloaded.min() < -5e-6


@pytest.mark.quick
def test_pose_of_one_gear_is_the_mean_pose_elsewhere():
    flanks = relieved(0.02, 4.0)
    one = solved(flanks, phases=[0.3, 0.8], pose="pinion")
    mean = solved(flanks, phases=one.phase + one.te * 1e3 / 2 / PAIR.p_bt)
    assert_allclose(one.te, mean.te, rtol=1e-5)
    rest = solved(flanks, phases=one.phase + one.unloaded * 1e3 / 2 / PAIR.p_bt)
    assert_allclose(one.unloaded, rest.unloaded, atol=1e-12)
    assert_allclose(one.k, LOAD / (one.te - one.unloaded))


def test_a_revolution_is_its_cycles_one_after_the_other():
    flanks = {"pinion": gf.Flank(pitch=gf.random_pitch(PAIR.gear_1, 6, seed=1))}
    found = solved(flanks, span="revolution", phases=4)
    some = solved(flanks, phases=found.phase[20:28])
    assert found.phase.size == 24 * 4
    assert_allclose(found.te[20:28], some.te, rtol=1e-9)
    own = np.flatnonzero(np.isin(found.order, some.order))
    assert_allclose(found.force[20:28][:, own], some.force, atol=1e-6)
    assert_allclose(found.force.sum(axis=1), LOAD)
    assert np.ptp(found.unloaded) > 5e-6
    with pytest.raises(ValueError, match="give the number of phases per mesh cycle"):
        solved(flanks, span="revolution", phases=[0.1, 0.2])


def test_harmonics_need_whole_cycles():
    found = gf.transmission_error(PAIR, [LOAD], STEEL, phases=np.linspace(0, 1, 16))
    with pytest.raises(ValueError, match="give equidistant phases over whole cycles"):
        found.harmonics()
    one, two = (gf.transmission_error(PAIR, [LOAD], STEEL, phases=p) for p in (32, np.arange(64) / 32))
    assert_allclose(one.harmonics(), two.harmonics(), rtol=1e-9)
    turn = 2 * np.pi * two.phase
    made = replace(two, te=(1e-6 * (9 + 3 * np.cos(turn + 0.4) + 0.5 * np.sin(3 * turn)))[None, :])
    assert_allclose(made.harmonics(), [[3e-6, 0, 0.5e-6, 0]], atol=1e-18)


def seeded_section(seed):
    """Spur pair with flanks modified along their profiles, the same along the width: pair, flanks, force."""
    rng = np.random.default_rng(seed)
    m = float(rng.choice([1.5, 2.0, 3.0]))
    rack = {"m_n": m, "alpha_n": math.radians(20), "b": 10.0 * m}
    pair = gf.GearPair(*(gf.Gear(z=int(z), r_bore=0.25 * z * m, **rack) for z in rng.integers(20, 50, 2)))
    flanks = {}
    for name, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2)):
        length = (gear.roll_a - gear.roll_f) * rng.uniform(0.15, 0.45)
        exponent = float(rng.choice([1, 1.5, 2]))
        flanks[name] = gf.Flank(
            tip_relief=m * rng.uniform(0.001, 0.012), tip_start_roll=gear.roll_a - length, tip_exponent=exponent,
            profile_crowning=m * rng.uniform(0, 0.002), profile_slope=m * rng.uniform(-0.001, 0.002),
        )  # fmt: skip
    return pair, flanks, 10.0 * m * m * rng.uniform(20, 100)


def against_fe(seed):
    """Largest difference of `ritz` and `fe` in the transmission error over the mean deflection, 24 phases."""
    pair, flanks, force = seeded_section(seed)
    ritz, fe = (gf.mesh_stiffness(pair, force, STEEL, method=name, flanks=flanks, phases=24) for name in ("ritz", "fe"))
    return float(np.abs(ritz.te - fe.te).max() / fe.deflection.mean())


@pytest.mark.slow
def test_ritz_and_fe_agree_on_random_modified_pairs():
    """Those of the page `flanks` that are furthest apart."""
    for seed in (101, 107, 108, 132, 134, 142, 193):
        difference = against_fe(seed)
        print(f"seed {seed}: transmission error {100 * difference:.3f} % of the deflection")
        assert difference < 0.001


def test_a_plain_sum_carries_what_closes_its_gaps():
    """Two springs by hand: the pair on the relief carries only what its gap leaves."""
    flanks = relieved(0.006, 5.0)
    phase = [0.1]
    plain, found = (solved(given, method="textbook", phases=phase) for given in (None, flanks))
    springs = plain.force[0] / plain.te[0]  # the law of its contact is linear
    gap = np.array([flank_contacts(PAIR, phase, flanks=_forms(flanks)).gap[0, k] for k in np.flatnonzero(_on_path(phase))]) * 1e-3
    te = (LOAD + springs @ gap) / springs.sum()
    assert (te > gap).all()
    assert_allclose(found.te[0], te, rtol=5e-3)  # the touching points have moved a little
    light = solved(flanks, force=60.0, method="textbook", phases=phase)
    assert light.force.shape[1] == 1
    assert_allclose(light.te[0], 60.0 / springs[np.argmin(gap)] + gap.min(), rtol=5e-3)


def _forms(flanks):
    return flank_forms(PAIR, flanks)


def _on_path(phase):
    return np.isfinite(contacts(PAIR, phase, extended=False).gap[0])
