"""Runs of the fast path with a given step."""

import math
import time
from functools import partial

import numpy as np

from . import excitation, propagator
from .response import Response
from .thinned import thinned

PIECE = 4096  # steps of a run whose channels are in memory at once
PART = 512  # samples kept that are worked on at once: what a processor has near at hand


def fixed_steps(machine, duration, steps, state, *, every=1, start=0.0, adapt=False, counts=()):
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

    counts : tuple of int
        Of `gearfe.motion.thinned.stages`, their product `every`; none: channels are not filtered.

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
    run = partial(run, plan, machine, flat, breaks=breaks)
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
    """States kept, statistics, and channels filtered, piece by piece: of the whole run only what is kept stays in memory."""
    kept, total, every = [], {"steps": 0, "rejected": 0, "losses": 0}, math.prod(counts)
    m, errors = len(machine.meshes), bool(flat.error_mesh.size)
    width = excitation.changing(machine, flat)[0].size + m + (m if errors else 0)

    def pieces():
        now = z
        for first in range(0, steps, PIECE):
            count = min(PIECE, steps - first)
            acting = np.empty((count + 1, width))
            states, stats = run(now, count, 1, start=start + plan.h * first, acting=acting)
            now, new = states[-1], slice(1 if first else 0, None)
            for name in total:
                total[name] += stats[name]
            kept.append(states[new][-(first + new.start) % every :: every].copy())
            yield np.concatenate([states[new], acting[new]], axis=1)

    told = thinned(pieces(), counts)
    return np.concatenate(kept), total, _channels(machine, flat, plan, told)


def _channels(machine, flat, plan, told):
    """`Response.filtered` from filtered states and what acts (`gearfe.motion.loop.run`): all the rest is a linear part of them.

    So fewer numbers are filtered than there are channels, and only those that the loop computes in any case.
    """
    n, m = len(machine.dofs), len(machine.meshes)
    kept, still = excitation.changing(machine, flat)
    ends = np.cumsum([2 * n, kept.size, m])
    K, C, _, _ = machine.linear(machine.working())
    out = np.empty((len(told), 3 * n + 3 * m))
    for first in range(0, len(out), PART):
        part = slice(first, first + PART)
        states, acting, k, e = np.split(told[part], ends, axis=1)
        forces = np.tile(still, (len(states), 1))
        forces[:, kept] = acting
        q, v = states @ plan.basis[:n].T, states @ plan.basis[n:].T
        x, rate = q @ machine.G.T, v @ machine.G.T
        a = (forces @ plan.rows - q @ K.T - v @ C.T) / machine.mass
        force = forces[:, :m] + plan.k * x + plan.c * rate
        np.concatenate([states, a, x - e if e.size else x, k, force], axis=1, out=out[part])
    return out
