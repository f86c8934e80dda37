"""`simulate`: the response of a machine, by a reference integrator or by the fast path."""

import math
import time
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
from scipy.integrate import solve_ivp

from . import excitation, propagator
from .machine import Machine, natural_frequencies
from .response import Response, acceleration

SOLVERS = ("RK45", "RK23", "DOP853", "Radau", "BDF", "LSODA")
STEPS = 80  # per mesh cycle, by default
SHARE = 0.35  # of the period of the stiffest mesh


def simulate(
    machine,
    duration,
    *,
    method="fast",
    dt=None,
    initial=None,
    every=1,
    rtol=1e-8,
    error=False,
    numba=None,
):
    """Response of a machine from time 0.

    Parameters
    ----------
    machine : Machine
    duration : float
        [s]
    method : str
        ``"fast"``: `gearfe.exponential`, fixed steps that are halved about changes of contact. Or a method of
        `scipy.integrate.solve_ivp`, the reference (``"DOP853"`` with ``rtol=1e-10``).
    dt : float, optional
        Step of the fast path, and interval of the output [s]; rounded down to divide `duration`. Default: `default_step`.
    initial : (ndarray, ndarray), optional
        Displacements and velocities ``(n,)``; default: at rest under the loads of time 0 (`Machine.rest`).
    every : int
        Keep one output in so many.
    rtol : float
        Of the reference; its atol is a thousandth of that of the largest value at rest.
    error : bool
        Fast path: integrate once more with half the step; ``stats["error"]`` is then the largest difference of a displacement
        over its range, which bounds the error of the first run from above as long as halving helps.
    numba : bool, optional
        Fast path: use the compiled loop; default: if numba is installed.

    Returns
    -------
    Response

    Raises
    ------
    ValueError
        If an input is impossible.
    RuntimeError
        If the response grows beyond all bounds, or the reference gives up.
    """
    _check(machine, duration, method, dt, every)
    if dt is None:
        dt = min(default_step(machine), duration)
    steps = every * math.ceil(duration / dt / every * (1 - 1e-12))
    if initial is None:
        initial = machine.rest(), np.zeros(len(machine.dofs))
    state = np.concatenate([np.asarray(part, dtype=float) for part in initial])
    if state.shape != (2 * len(machine.dofs),) or not np.isfinite(state).all():
        raise ValueError(f"initial: give displacements and velocities, {len(machine.dofs)} finite numbers each")
    if method != "fast":
        return _reference(machine, duration, steps // every, state, method, rtol)
    out = _fast(machine, duration, steps, state, every, numba)
    if not error:
        return out
    finer = _fast(machine, duration, 2 * steps, state, 2 * every, numba)
    size = np.ptp(finer.q, axis=0)
    away = np.abs(out.q - finer.q).max(axis=0)
    stats = out.stats | {"error": float((away / np.where(size > 1e-9 * size.max(), size, np.inf)).max())}
    return replace(out, stats=stats | {"seconds": out.stats["seconds"] + finer.stats["seconds"]})


def default_step(machine):
    """Step that resolves mesh cycles (`STEPS` per cycle) and what the meshes excite (`SHARE` of a period) [s].

    A mesh excites its bodies up to about ``sqrt(k sum(row**2 / m))``; supports, however stiff, are in the exact linear part.
    """
    highest = max((abs(m.frequency) for m in machine.meshes), default=0.0)
    x = machine.G @ machine.rest() if (machine.law["power"] != 1).any() else None
    own = machine.linear(x)[2] * (machine.G**2 / machine.mass).sum(axis=1)
    top = math.sqrt(own.max()) / (2 * math.pi) if own.size else natural_frequencies(machine)[0][-1]
    return 1 / max(STEPS * highest, top / SHARE)


def _check(machine, duration, method, dt, every):
    if not isinstance(machine, Machine):
        raise ValueError(f"machine = {type(machine).__name__}, but give a Machine (see gearfe.models)")
    if not (math.isfinite(duration) and duration > 0):
        raise ValueError(f"duration = {duration} s, but it must be positive")
    if method != "fast" and method not in SOLVERS:
        raise ValueError(f"method = {method!r}, but it must be 'fast' or one of {', '.join(SOLVERS)}")
    if dt is not None and not (math.isfinite(dt) and 0 < dt <= duration):
        raise ValueError(f"dt = {dt} s, but it must be positive and no longer than the duration")
    if isinstance(every, bool) or every != int(every) or every < 1:
        raise ValueError(f"every = {every!r}, but give a whole number >= 1")


def _fast(machine, duration, steps, state, every, numba):
    started = time.perf_counter()
    h, n = duration / steps, len(machine.dofs)
    x = machine.G @ machine.rest() if (machine.law["power"] != 1).any() else None
    plan = propagator.plan(machine, h, x)
    flat = excitation.flatten(machine, np.linspace(0.0, duration, 4 * steps + 1))
    breaks = np.unique(np.concatenate([np.empty(0), *(one.breaks for one in machine.loads)]))
    installed = find_spec("numba") is not None
    if numba and not installed:
        raise ValueError("numba=True, but numba is not installed: pip install gearfe[fast], or leave the choice open")
    compiled = installed if numba is None else numba
    if compiled:
        from .compiled import run
    else:
        from .exponential import run
    with np.errstate(over="ignore", invalid="ignore"):
        states, stats = run(plan, machine, flat, plan.inverse @ state, steps, every, breaks)
    stats |= {"method": "fast", "dt": h, "numba": bool(compiled), "seconds": time.perf_counter() - started, "dofs": n}
    return Response(machine, h * every * np.arange(len(states)), states, plan.basis, stats)


def _reference(machine, duration, count, state, method, rtol):
    started = time.perf_counter()
    n = len(machine.dofs)
    at = np.linspace(0.0, duration, count + 1)
    flat = excitation.flatten(machine, np.linspace(0.0, duration, 20 * count + 1))
    highest = max((abs(m.frequency) for m in machine.meshes), default=0.0)
    unit = max(2 * math.pi * highest, 1.0)  # velocities of the size of the displacements
    scale = np.concatenate([np.sqrt(machine.mass) * unit, np.sqrt(machine.mass)])
    rest = machine.rest()
    size = np.abs(scale * np.concatenate([rest, 0 * rest])).max() or np.abs(scale * state).max() or 1.0

    def rate(t, y):
        u = y / scale
        return scale * np.concatenate([u[n:], acceleration(machine, flat, np.asarray(t), u[:n], u[n:])])

    edges = np.unique(np.concatenate([[0.0, duration], *(one.breaks for one in machine.loads)]))
    edges = edges[(edges >= 0) & (edges <= duration)]
    y, states, calls = scale * state, [state[None]], 0
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        inside = at[(at > low) & (at <= high)]
        done = solve_ivp(
            rate,
            (low, high),
            y,
            method,
            t_eval=np.union1d(inside, [high]),
            rtol=rtol,
            atol=1e-3 * rtol * size,
            max_step=1 / (8 * highest) if highest else np.inf,
        )
        if not done.success or not np.isfinite(done.y).all():
            raise RuntimeError(f"{method} gave up at t = {done.t[-1] if done.t.size else low:.4g} s: {done.message}")
        y, calls = done.y[:, -1], calls + done.nfev
        states.append((done.y[:, : inside.size] / scale[:, None]).T)
    stats = {"method": method, "rtol": rtol, "calls": calls, "seconds": time.perf_counter() - started, "dofs": n}
    return Response(machine, at, np.concatenate(states), np.eye(2 * n), stats)
