"""Runs of the fast path with a given step."""

import time
from importlib.util import find_spec

import numpy as np

from . import excitation, propagator
from .response import Response


def fixed_steps(machine, duration, steps, state, *, every=1, numba=None, start=0.0, adapt=False):
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
    numba : bool, optional
        Use the compiled loop; default: if numba is installed.
    start : float
        [s]
    adapt : bool
        Under a law of contact that is not linear, halve steps also where `gearfe.motion.propagator.Plan.allowed` asks for it.

    Returns
    -------
    Response

    Raises
    ------
    ValueError
        If numba is asked for and not installed.
    RuntimeError
        If the response grows beyond all bounds.
    """
    installed = find_spec("numba") is not None
    if numba and not installed:
        raise ValueError("numba=True, but numba is not installed: pip install gearfe[fast], or leave the choice open")
    compiled = installed if numba is None else numba
    if compiled:
        from .numba_loop import run
    else:
        from .numpy_loop import run
    started, h = time.perf_counter(), duration / steps
    x = machine.G @ machine.rest() if (machine.law["power"] != 1).any() else None
    plan = propagator.plan(machine, h, x, adapt)
    flat = excitation.flatten(machine, start + np.linspace(0.0, duration, 4 * steps + 1))
    breaks = np.unique(np.concatenate([np.empty(0), *(one.breaks for one in machine.loads)]))
    with np.errstate(over="ignore", invalid="ignore"):
        states, stats = run(plan, machine, flat, plan.inverse @ state, steps, every, breaks, start)
    stats |= {"method": "fast", "dt": h, "numba": bool(compiled), "seconds": time.perf_counter() - started}
    stats["dofs"] = len(machine.dofs)
    return Response(machine, start + h * every * np.arange(len(states)), states, plan.basis, stats)
