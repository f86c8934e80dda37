"""The step that `simulate` chooses: its error against the reference, and that it says what it knows."""

from dataclasses import replace

import numpy as np
import pytest
from machines import WAVE, difference, stepped, tooth, two_masses
from numpy.testing import assert_allclose
from scipy.linalg import expm

import gearfe as gf
from gearfe.dynamics.machine.springs import Spring
from gearfe.dynamics.machine.tooth_damage import ToothDamage
from gearfe.dynamics.motion import simulate as dynamics
from gearfe.dynamics.motion import step_control
from gearfe.dynamics.motion.fixed_step import fixed_steps
from gearfe.dynamics.motion.propagator import _phi
from gearfe.dynamics.motion.run_differences import differences, seen
from gearfe.dynamics.motion.simulate import simulate
from gearfe.dynamics.motion.step_control import default_step, stretch


def test_contact_loss_within_a_hundredth_of_the_reference():
    machine = two_masses(error=((80e-6, 500.0, 0.3),), backlash=4e-5)
    got = simulate(machine, 0.01)
    want = stepped(machine, 0.01, dt=got.time[1], method="DOP853", rtol=1e-9)
    assert got.stats["losses"] >= 5
    assert_allclose(got.stats["error_seconds"], 0.01)
    assert max(difference(got, want)) < 1e-2
    assert max(difference(got, want)) < 1.5 * got.stats["error"]


def test_it_says_when_the_reference_took_over(monkeypatch):
    monkeypatch.setattr(dynamics, "ALLOWED", 1e-9)
    got = simulate(two_masses(error=((80e-6, 500.0, 0.3),), backlash=4e-5), 0.004)
    assert got.stats["method"] == "DOP853"
    assert "contact is lost" in got.stats["switched"]
    assert 0 < got.stats["error"] < 1e-2


def test_difference_of_known_responses():
    one = stepped(two_masses(), 0.01, dt=1e-4)
    away = np.zeros_like(one.states)
    away[30, 0] = 1.0
    two = replace(one, states=one.states + 1e-3 * np.ptp(one.q, axis=0).max() * away @ np.linalg.inv(one.basis).T)
    moved, pushed = difference(two, one)
    assert_allclose(moved, 1e-3, rtol=1e-6)
    k = one["stiffness m"][30]
    assert_allclose(pushed, k * 1e-3 * np.ptp(one.q, axis=0).max() / np.ptp(one["force m"]), rtol=1e-6)
    assert difference(one, one) == (0.0, 0.0)


def test_stretch_holds_the_damaged_tooth():
    machine = two_masses(teeth=(50, 70), damage=(ToothDamage(0, 20, tooth(WAVE, 0.3, 1.5)),))
    start, length = stretch(machine, 1.0)
    assert start < 20 / 500 < 21.5 / 500 < start + length
    assert stretch(machine, 0.02) == (0.0, 3.5 / 500)


def test_outputs_do_not_depend_on_the_step():
    """Healthy and damaged responses have the same times, so that their indicators can be compared."""
    hurt = two_masses(teeth=(5, 7), damage=(ToothDamage(0, 0, tooth(WAVE, 0.9, 1.5)),))
    times = [simulate(machine, 0.02).time for machine in (two_masses(), hurt)]
    assert_allclose(times[0], times[1], rtol=0)
    assert_allclose(times[0][1], default_step(hurt), rtol=0.01)


def test_phi_functions_against_an_augmented_exponential():
    rng = np.random.default_rng(0)
    for scale in (1e-3, 1.0, 300.0):
        Z = rng.standard_normal((5, 2, 2))
        Z = scale * (Z - np.transpose(Z, (0, 2, 1)) - 0.1 * np.eye(2))  # rotations that decay
        found = _phi(Z)
        for i, z in enumerate(Z):
            big = np.zeros((8, 8))
            big[:2, :2], big[:2, 2:4], big[2:4, 4:6], big[4:6, 6:] = z, np.eye(2), np.eye(2), np.eye(2)
            full = expm(big)
            for j, one in enumerate(found):
                assert_allclose(one[i], full[:2, 2 * j : 2 * j + 2], atol=1e-11)


def test_without_damping_the_whole_run_is_estimated_when_asked():
    """100 cycles; accelerations, too. The stretch of 3.5 cycles says less, and says that it does."""
    machine = two_masses(c=0.0, zeta=0.0, error=((20e-6, 500.0, 0.3),))
    fine = {"rate": 1e4, "step": 1e-6, "error": False}
    want = simulate(machine, 0.2, **fine)
    asked, plain = simulate(machine, 0.2, rate=1e4, error=True), simulate(machine, 0.2, rate=1e4)
    assert plain.stats["error_seconds"] < 0.01
    assert asked.stats["error_seconds"] == 0.2
    for one, share in ((asked, 1.0), (plain, 100 / 3.5)):
        assert max(difference(one, want)) < share * one.stats["error"]
        assert differences(seen(one), seen(want), machine)[2] < share * one.stats["error_acceleration"]
    assert max(difference(asked, want)) < 1e-3
    assert max(difference(plain, want)) > plain.stats["error"]  # what the stretch does not tell


def test_the_step_sees_a_load_far_above_the_meshes():
    """At 100 kHz, and only for the last hundredth of the run, where no stretch looks."""
    load = lambda t: 1000.0 + 500.0 * np.sin(2e5 * np.pi * t) * (np.asarray(t) > 0.0198)  # noqa: E731
    machine = two_masses(load=load)
    got = simulate(machine, 0.02, rate=5e4)
    assert got.stats["dt"] < 1.5e-6
    want = simulate(machine, 0.02, rate=5e4, step=1e-7, error=False)
    assert max(difference(got, want)) < 1e-3
    with pytest.warns(UserWarning, match="too long for this machine"):
        assert simulate(machine, 0.02, rate=5e4, step=1e-5).stats["error"] > 0.1


def ramped(frequency=300.0, damping=2e3, **mesh):
    """A mass under the impact law whose coefficient doubles and halves within a sixty-fourth of a cycle, as pairs come and go."""
    steep = 5e9 * np.where(np.arange(256) < 128, 2.0, 1.0)
    law = {"power": 1.5, "push": True, "depth": 1e-4, "damping": damping, "backlash": 1e-3}
    return gf.single_mesh(0.5, steep, frequency, force=1500.0, **law, **mesh)


def test_steep_ramps_are_followed_by_shorter_steps():
    machine = ramped()
    got = simulate(machine, 0.02, rate=2e4)
    want = simulate(machine, 0.02, rate=2e4, step=5e-7, error=False)
    assert max(difference(got, want)) < got.stats["error"] < 1e-3
    assert got.stats["rejected"] > 0
    assert got.stats["steps"] > round(0.02 / got.stats["dt"])  # some are parts
    fixed = simulate(machine, 0.02, rate=2e4, step=got.stats["dt"], error=False)
    assert max(difference(fixed, want)) > max(difference(got, want))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "mesh", "losses"),
    [
        ("as usual", {}, 0),
        ("hardly damped", {"frequency": 700.0, "damping": 200.0}, 0),
        ("remembers longer than it runs", {"frequency": 1100.0, "damping": 50.0}, 0),
        ("losing contact", {"error": ((60e-6, 1130.0, 0.0),)}, 33),
    ],
)
def test_estimates_under_impacts_cover_at_five_rates(name, mesh, losses):
    """Told on 3.5 cycles alone they were up to 4 times short; the finer run was held against DOP853 by hand."""
    machine = ramped(**mesh)
    want = simulate(machine, 0.03, rate=1e5, step=2.5e-7, error=False)
    for rate in (2e3, 5e3, 1e4, 2e4, 5e4):
        got = simulate(machine, 0.03, rate=rate)
        true = max(difference(got, want.part(slice(None, None, round(1e5 / rate)))))
        assert true < got.stats["error"] < 6e-3, (name, rate)
        assert got.stats["losses"] == losses


def test_impacts_are_located_as_the_reference_locates_them():
    """33 losses of contact in 30 ms: a third of them, against DOP853 between its own located changes."""
    machine = ramped(error=((60e-6, 1130.0, 0.0),))
    got = simulate(machine, 0.01, rate=2e4)
    want = simulate(machine, 0.01, rate=2e4, method="DOP853", rtol=1e-9)
    assert got.stats["losses"] == want.stats["losses"] > 8
    assert max(difference(got, want)) < 5e-4


def test_a_run_of_hours_is_refused_before_it_starts(monkeypatch):
    """Seconds of the runs that it is told from are set: on a busy machine the longer can take less, and the run starts."""

    def timed(*given, every=1, **more):
        run = fixed_steps(*given, every=every, **more)
        return replace(run, stats=run.stats | {"seconds": 1e-3 * every})

    monkeypatch.setattr(step_control, "fixed_steps", timed)
    with pytest.raises(ValueError, match=r"hours of computing.*give a shorter duration, or a longer step="):
        simulate(two_masses(), 1e9, rate=1e-7)


def test_a_stretch_lies_within_a_run_that_begins_later():
    """The damaged tooth is in mesh at 0 s and again at 0.046 s."""
    machine = two_masses(teeth=(23, 40), damage=(ToothDamage(0, 0, tooth(WAVE, 0.3, 1.5)),))
    assert_allclose(stretch(machine, 0.1, 0.03), (0.045, 0.007))
    assert_allclose(stretch(machine, 0.01, 0.03), (0.03, 0.007))


def test_a_machine_without_meshes_and_loads_vibrates_freely():
    machine = gf.Machine(("disc.x",), np.array([2.0]), (Spring("bearing", np.array([1.0]), 8e4),), (), ())
    got = simulate(machine, 0.1, rate=1e4, initial=(np.array([1e-3]), np.zeros(1)), filtered=False)
    assert_allclose(got["disc.x"], 1e-3 * np.cos(200 * got.time), atol=1e-12)


def test_a_vibration_too_fast_for_any_step_is_refused():
    light = gf.single_mesh(mass=1e-300, stiffness=1e8, frequency=500.0, force=1000.0)
    with pytest.raises(ValueError, match="check its masses and stiffnesses"):
        gf.simulate(light, 0.01, rate=1000.0)
