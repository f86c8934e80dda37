"""The step that `simulate` chooses on the machines of all scenes, beside DOP853 between located changes of contact."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from stages import article, compound, helical, spur, stage

from gearfe.dynamics.motion.simulate import simulate
from validation.shared.kept_rows import stored

RATES = (2e3, 5e3, 1e4, 2.5e4, 5e4)  # of the output [Hz]; the last holds all others


def stiff(made):
    """The machine with all its springs 100 times stiffer, at the same damping ratios."""
    return replace(made, springs=tuple(replace(s, k=100 * s.k, c=10 * s.c) for s in made.springs))


def shaken(made, amplitude=40e-6):
    """The machine with play and errors that open every mesh."""
    meshes = [
        replace(m, backlash=1e-4, zeta=0.05, error=((amplitude, 5 * m.frequency, 1.3 * i),)) for i, m in enumerate(made.meshes)
    ]
    return replace(made, meshes=tuple(meshes))


def machines():
    """(name, callable that makes the machine, duration [s] of about three mesh cycles) of all four scenes."""
    kinds = (("planetary_pitting", spur, 0.008), ("compound_planetary", compound, 0.008))
    kinds += (("helical_pitting", helical, 0.004), ("herringbone", stage, 0.005))
    for name, made, duration in kinds:
        for case in (False, True):
            yield f"{name}, {'damaged' if case else 'healthy'}", partial(made, case), duration
    for name, made, duration in kinds:
        yield f"{name}, damaged, springs 100 times stiffer", lambda made=made: stiff(made(True)), duration / 2
    for name, made, duration in (kinds[0], kinds[1], kinds[3]):
        for case in (False, True):
            yield (
                f"{name}, {'damaged' if case else 'healthy'}, contact loss",
                lambda made=made, case=case: shaken(made(case)),
                duration / 2,
            )
    yield "planetary_pitting, impact law, healthy", lambda: article(None), 0.004
    yield "planetary_pitting, impact law, friction, pulses", article, 0.004


MACHINES = {name: (build, duration) for name, build, duration in machines()}


def errors(made, duration):
    """Steps [us], estimates, errors and losses of contact of a machine at all rates, one list of five each."""
    want = exact(made, duration)
    row = {name: [] for name in ("step", "estimate", "displacement", "force", "losses")}
    for rate in RATES:
        got, every = simulate(made, duration, rate=rate, filtered=False), round(RATES[-1] / rate)
        thin = replace(want, time=want.time[::every], states=want.states[::every])
        cells = 1e6 * got.stats.get("dt", math.nan), got.stats["error"], _moved(got, thin, want), _error(got, thin, want)
        for name, value in zip(row, (*cells, got.stats.get("losses", 0)), strict=True):
            row[name].append(float(f"{value:.3g}"))
    return row


def exact(made, duration):
    """Response by DOP853 (rtol 1e-10) between located changes of contact, at the highest rate."""
    return simulate(made, duration, rate=RATES[-1], method="DOP853", rtol=1e-10, filtered=False)


def _error(got, want, whole=None):
    """Largest error of a mesh force over its range in `whole`, if not in `want`."""
    ranges = np.ptp((whole or want).mesh(), axis=0)
    return float((np.abs(got.mesh() - want.mesh()).max(axis=0) / ranges).max())


def _moved(got, want, whole=None):
    """Largest error of a displacement over the largest range of its kind in `whole`, if not in `want`."""
    away, size = np.abs(got.q - want.q).max(axis=0), np.ptp((whole or want).q, axis=0)
    turns = np.array([name.endswith(("theta", "tilt_x", "tilt_y")) for name in want.machine.dofs])
    return float(max(away[kind].max() / size[kind].max() for kind in (turns, ~turns)))


@pytest.mark.slow
@pytest.mark.parametrize("name", MACHINES)
def test_errors_are_small_and_within_their_estimates(name):
    """The page `dynamics` has these rows: errors of 1e-3, with contact loss 1e-2, and estimates above them."""
    build, duration = MACHINES[name]
    row = errors(build(), duration)
    larger = np.maximum(row["displacement"], row["force"])
    assert (larger <= row["estimate"]).all()
    assert larger.max() < (1e-2 if any(row["losses"]) else 1e-3)
    assert_allclose(row["step"], stored("dynamics_steps")[name]["step"], rtol=0.01)


def test_a_step_and_an_estimate_on_file_are_those_of_the_code():
    row = stored("dynamics_steps")["herringbone, damaged"]
    got = simulate(stage(True), 0.005, rate=RATES[0])
    assert_allclose([1e6 * got.stats["dt"], got.stats["error"]], [row["step"][0], row["estimate"][0]], rtol=0.01)
