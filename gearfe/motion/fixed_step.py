"""Runs of the fast path with a given step."""

import time

import numpy as np

from . import excitation, propagator
from .response import Response


def fixed_steps(machine, duration, steps, state, *, every=1, start=0.0, adapt=False):
    """Response of a machine over `steps` equal steps.

    Parameters
    ----------
    machine : Machine
    duration : float
        [s]
    steps : int
    state : ndarray, shape (2n,)
        Displacements and velocities at time `start`.
    every : int
        Keep every n-th state.
    start : float
        [s]
    adapt : bool
        Under a law of contact that is not linear, halve steps also where `gearfe.motion.propagator.Plan.allowed` asks for it.

    Returns
    -------
    Response

    Raises
    ------
    RuntimeError
        If the response grows beyond all bounds.
    """
    from .loop import run  # loads numba

    started, h = time.perf_counter(), duration / steps
    x = machine.working()
    plan = propagator.plan(machine, h, x, adapt)
    flat = excitation.flatten(machine, start + np.linspace(0.0, duration, 4 * steps + 1))
    breaks = np.unique(np.concatenate([np.empty(0), *(one.breaks for one in machine.loads)]))
    with np.errstate(over="ignore", invalid="ignore"):
        states, stats = run(plan, machine, flat, plan.inverse @ state, steps, every, breaks, start)
    stats |= {"method": "fast", "dt": h, "seconds": time.perf_counter() - started}
    stats["dofs"] = len(machine.dofs)
    return Response(machine, start + h * every * np.arange(len(states)), states, plan.basis, stats)
