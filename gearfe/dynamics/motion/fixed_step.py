"""Runs of the fast integrator with a given step."""

import math
import time
from functools import partial

import numpy as np

from . import excitation, propagator
from .response import Response
from .thinned import thinned_pieces

PIECE = 4096  # number of steps whose channels are in memory at once


def fixed_steps(machine, duration, steps, state, *, every=1, start=0.0, adapt=False, counts=(), plan=None):
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
        Under a law of contact that is not linear, also halve steps where `motion.propagator.RunMatrices.allowed` requires it.
    counts : tuple of int
        Of `gearfe.dynamics.motion.thinned.stages`, their product `every`; none: channels are not filtered.
    plan : Plan, optional
        Of these steps, if it is known.

    Returns
    -------
    Response

    Raises
    ------
    RuntimeError
        If the response grows beyond all bounds.
    """
    from .loop import run  # This import loads the compiler.

    started, h = time.perf_counter(), duration / steps
    plan = plan or propagator.plan(machine, h, machine.working(), adapt)
    looks = 4 * steps + 1 if any(callable(load.value) for load in machine.loads) else 1
    flat = excitation.flatten(machine, start + np.linspace(0.0, duration, looks))
    run = partial(run, plan, machine, flat)
    z = plan.inverse @ state
    with np.errstate(over="ignore", invalid="ignore"):
        if counts:
            states, stats, filtered = _filtered(run, machine, flat, plan, z, steps, start, counts)
        else:
            states, stats = run(z, steps, every, start=start)
            filtered = None
    stats |= {"method": "fast", "dt": h, "seconds": time.perf_counter() - started}
    stats["dofs"] = len(machine.dofs)
    return Response(machine, start + h * every * np.arange(len(states)), states, plan.basis, stats, filtered)


def _filtered(run, machine, flat, plan, z, steps, start, counts):
    """Return kept states, statistics and filtered channels. They are computed in pieces to save memory."""
    total, every, n, m = {"steps": 0, "rejected": 0, "losses": 0}, math.prod(counts), len(machine.dofs), len(machine.meshes)
    kept, channels = np.empty((1 + steps // every, 2 * n)), np.empty((1 + steps // every, 3 * n + 3 * m))
    width = excitation.changing(machine, flat)[0].size + (2 * m if flat.error.size or flat.shift.size else m)

    def pieces():
        state = z
        for first in range(0, steps, PIECE):
            count = min(PIECE, steps - first)
            acting = np.empty((count + 1, width))
            states, stats = run(state, count, 1, start=start + plan.h * first, acting=acting)
            state, new = states[-1].copy(), slice(1 if first else 0, None)
            for name in total:
                total[name] += stats[name]
            sampled = states[-first % every :: every]
            at = -(-first // every)
            kept[at : at + len(sampled)] = sampled
            yield np.concatenate([states[new], acting[new]], axis=1)

    done, whole = 0, _channels(machine, flat, plan)
    for piece in thinned_pieces(pieces(), counts):
        channels[done : done + len(piece)] = whole(piece)
        done += len(piece)
    return kept, total, channels


def _channels(machine, flat, plan):
    """Return the function that computes `Response.filtered` from filtered states and excitations (`gearfe.dynamics.motion.loop`).

    All channels are linear functions of these, so that fewer signals are filtered than there are channels.
    """
    n, m = len(machine.dofs), len(machine.meshes)
    kept, still = excitation.changing(machine, flat)
    ends = np.cumsum([2 * n, kept.size, m])
    K, C, _, _ = machine.linear(machine.working())

    def whole(told):
        states, acting, k, e = np.split(told, ends, axis=1)
        forces = np.tile(still, (len(states), 1))
        forces[:, kept] = acting
        q, v = states @ plan.basis[:n].T, states @ plan.basis[n:].T
        x, rate = q @ machine.G.T, v @ machine.G.T
        a = (forces @ plan.rows - q @ K.T - v @ C.T) / machine.mass
        force = forces[:, :m] + plan.k * x + plan.c * rate
        return np.concatenate([states, a, x - e if e.size else x, k, force], axis=1)

    return whole
