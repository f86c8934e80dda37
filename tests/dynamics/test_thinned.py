"""What a run keeps is filtered before it is thinned: nothing folds, nothing in the passband changes, the ends included."""

import math

import numpy as np
import pytest
from machines import two_masses
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.motion.simulate import simulate
from gearfe.dynamics.motion.thinned import stages, thinned


@pytest.mark.parametrize("every", [2, 7, 40, 1000])
def test_tones_below_pass_and_those_above_do_not(every):
    counts = stages(every)
    t = np.arange(120 * math.prod(counts) + 1) / math.prod(counts)  # in samples kept
    low = np.cos(2 * np.pi * np.outer(t, [0.003, 0.1, 0.31, 0.39]) + 0.4)
    high = np.cos(2 * np.pi * np.outer(t, [0.5, 0.63, 0.97]) + 0.4)
    rows = np.concatenate([low, high], axis=1)
    got = thinned([rows], counts)
    assert len(got) == 121
    assert_allclose(got[:, :4], low[:: math.prod(counts)], atol=5e-4)  # up to the ends
    assert_allclose(got[26:-26, :4], low[:: math.prod(counts)][26:-26], atol=1e-4)
    assert np.abs(got[26:-26, 4:]).max() < 2e-4
    assert_allclose(got[[0, -1]], rows[[0, -1]], rtol=1e-14)
    pieces = [rows[:1], *(rows[i : i + 501] for i in range(1, len(rows), 501))]
    assert_allclose(thinned(pieces, counts), got, rtol=0, atol=1e-13)


def test_numbers_of_steps_are_made_of_filters():
    for every in (*range(1, 300), 997, 5003, 70000):
        counts = stages(every)
        assert every <= math.prod(counts) <= max(2, 1.35 * every)
        assert len(counts) == 1 or min(counts[-1:]) >= 8
        assert max(counts) <= 16


def machine():
    """Mesh of 500 Hz, whose force has many harmonics: the curve falls and rises steeply between one and two pairs."""
    phase = np.arange(64) / 64
    return two_masses(stiffness=1e8 * (1 + 0.3 * np.tanh(5 * np.sin(2 * np.pi * phase))), zeta=0.05)


def test_states_stay_those_of_the_integrator_and_the_motion_goes_on_from_them():
    made, options = machine(), {"rate": 8e3, "step": 1e-5, "error": False}
    whole, raw = simulate(made, 0.02, **options), simulate(made, 0.02, filtered=False, **options)
    assert raw.filtered is None
    scale = np.ptp(raw.q, axis=0)
    assert (np.abs(whole.q - raw.q).max(axis=0) < 1e-6 * scale).all()
    assert_allclose(whole.raw["force m"], raw["force m"], rtol=1e-6)
    assert np.abs(whole["force m"] - raw["force m"]).max() > 1e-3 * np.ptp(raw["force m"])
    assert_allclose(whole["force m"][[0, -1]], whole.raw["force m"][[0, -1]], rtol=1e-12)
    half = simulate(made, 0.01, start=0.01, initial=(whole.q[80], whole.v[80]), **options)
    assert (np.abs(half.q - whole.q[80:]) < 1e-9 + 1e-6 * scale).all()
    part = whole.part(slice(10, 50))
    assert_allclose(part["force m"], whole["force m"][10:50], rtol=0)
    assert_allclose(part["b.x velocity"], whole["b.x velocity"][10:50], rtol=0)


def test_the_reference_is_filtered_alike():
    made = two_masses()
    got, want = (simulate(made, 0.006, rate=4e3, method=method, rtol=1e-6) for method in ("fast", "DOP853"))
    for name in ("force m", "a.x acceleration", "b.x", "stiffness m", "compression m"):
        assert_allclose(got[name], want[name], atol=2e-3 * np.ptp(want[name]), err_msg=name)


def test_contact_that_is_lost_is_in_the_raw_channels():
    made = two_masses(zeta=0.01, stiffness=1e8 * (1 + 0.45 * np.cos(2 * np.pi * np.arange(64) / 64)), backlash=1e-4)
    start = (np.array([6e-5, 0.0]), np.zeros(2))
    got = simulate(made, 0.005, rate=3e4, initial=start)
    assert got.stats["losses"] > 0
    plain = simulate(made, 0.005, rate=3e4, initial=start, filtered=False)
    for kind in ("compression", "force"):
        assert_allclose(got.raw.mesh(kind), plain.mesh(kind), atol=2e-2 * np.ptp(plain.mesh(kind)))
    assert (plain["compression m"] < 0).any()
    assert abs(got.stats["error"] / plain.stats["error"] - 1) < 1


def test_a_response_cut_by_hand_is_refused():
    got = simulate(two_masses(), 0.01, rate=8e3)
    with pytest.raises(ValueError, match="cut it by part"):
        gf.Response(got.machine, got.time[:5], got.states[:5], got.basis, {}, got.filtered)
