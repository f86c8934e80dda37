"""`simulate`: the response of a machine, by a reference integrator or by the fast path."""

import math
import time
from dataclasses import replace
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp

from ..elements.solver import free_memory
from ..machine.tables import Machine
from . import excitation
from .fixed_step import fixed_steps
from .response import Response, acceleration
from .step_control import WANTED_OPEN, chosen_step, default_step, difference

SOLVERS = ("RK45", "RK23", "DOP853", "Radau", "BDF", "LSODA")
FINER = 3  # times the step of a whole run is halved where contact is lost
DEEPEST, FASTEST = 1.0, 1e3  # of flanks along a line of action [m], [m/s]: no tooth is so high, no gear so fast
ALLOWED = 2 * WANTED_OPEN  # of the range, with contact loss


def simulate(
    machine: Machine,
    duration: float,
    *,
    method: str = "fast",
    dt: float | None = None,
    initial: tuple[ArrayLike, ArrayLike] | None = None,
    every: int = 1,
    rtol: float = 1e-8,
    error: bool = False,
    numba: bool | None = None,
) -> Response:
    """Response of a machine from time 0.

    Parameters
    ----------
    machine : Machine
    duration : float
        [s]
    method : str
        ``"fast"``: `gearfe.motion.exponential`, fixed steps that are halved about changes of contact. Or a method of
        `scipy.integrate.solve_ivp`, the reference (``"DOP853"`` with ``rtol=1e-10``).
    dt : float, optional
        Step of the fast path, and interval of the output [s]; rounded down to divide `duration`. Default: a step whose error on
        a short stretch is at most 7e-4 of the range (`gearfe.motion.step_control.chosen_step`); where contact is lost the whole
        run is repeated at half the step until both agree within 1e-2, and if they never do the reference takes over, which
        ``stats["switched"]`` says.
    initial : (ndarray, ndarray), optional
        Displacements and velocities ``(n,)``; default: at rest under the loads of time 0 (`Machine.rest`).
    every : int
        Keep every n-th output. Without `dt` the outputs counted are `default_step` apart, whatever the step.
    rtol : float
        Of the reference; its atol is a thousandth of that of the largest value at rest.
    error : bool
        Fast path: integrate once more with half the step; ``stats["error"]`` is then of the whole run.
    numba : bool, optional
        Fast path: use the compiled loop; default: if numba is installed.

    Returns
    -------
    Response
        Its ``stats["error"]`` estimates the error: the largest difference of displacements and mesh forces to a run of half the
        step, over their ranges (`gearfe.motion.step_control.difference`), on the first ``stats["error_seconds"]`` of a run about
        the worst damaged tooth, or of the whole run. A given `dt` without ``error=True`` has none.

    Raises
    ------
    ValueError
        If an input is impossible.
    RuntimeError
        If the response grows beyond all bounds, or the reference gives up.
    """
    _check(machine, duration, method, dt, every)
    if initial is None:
        state = np.concatenate([machine.rest(), np.zeros(len(machine.dofs))])
    else:
        state = np.concatenate([np.asarray(part, dtype=float) for part in initial])
    if state.shape != (2 * len(machine.dofs),) or not np.isfinite(state).all():
        raise ValueError(f"initial: give displacements and velocities, {len(machine.dofs)} finite numbers each")
    if initial is not None:
        _check_initial(machine, state)
    if method != "fast":
        return _reference(machine, duration, _outputs(machine, duration, dt, every), state, method, rtol)
    if dt is None:
        return _controlled(machine, duration, state, initial is not None, every, error, numba)
    steps = every * _outputs(machine, duration, dt, every)
    out = fixed_steps(machine, duration, steps, state, every=every, numba=numba)
    if not error:
        return out
    finer = fixed_steps(machine, duration, 2 * steps, state, every=2 * every, numba=numba)
    stats = {"error": max(difference(out, finer)), "seconds": out.stats["seconds"] + finer.stats["seconds"]}
    return replace(out, stats=out.stats | stats | {"error_seconds": float(duration)})


def _check_initial(machine, state):
    """Refuse initial states in which flanks lie in each other by more than teeth are high, or move as fast as no gear does."""
    n = len(machine.dofs)
    deep, fast = (float(np.abs(machine.G @ part).max(initial=0.0)) for part in (state[:n], state[n:]))
    if deep > DEEPEST or fast > FASTEST:
        raise ValueError(
            f"initial: the flanks of a mesh would be {deep:.3g} m in or off each other and move at {fast:.3g} m/s, but give less "
            f"than {DEEPEST:g} m and {FASTEST:g} m/s: displacements in m and rad, velocities in m/s and rad/s"
        )


def _controlled(machine, duration, state, given, every, error, numba):
    """Run at the chosen step; where contact is lost, until two whole runs agree, or by the reference."""
    started = time.perf_counter()
    dt, doubt, length = chosen_step(machine, duration, state if given else None, numba)
    outputs = _outputs(machine, duration, None, every)
    every = math.ceil(duration / outputs / dt * (1 - 1e-9))
    steps = every * outputs
    out = fixed_steps(machine, duration, steps, state, every=every, numba=numba)
    if not (out.stats["losses"] or error):
        stats = {"error": doubt, "error_seconds": length, "seconds": time.perf_counter() - started}
        return replace(out, stats=out.stats | stats)
    for _ in range(FINER):
        steps, every = 2 * steps, 2 * every
        finer = fixed_steps(machine, duration, steps, state, every=every, numba=numba)
        doubt = max(difference(out, finer))
        out = finer
        if doubt <= ALLOWED or not out.stats["losses"]:
            stats = {"error": doubt, "error_seconds": float(duration), "seconds": time.perf_counter() - started}
            return replace(out, stats=out.stats | stats)
    why = f"contact is lost and two runs of the fast path, with steps of {2 * duration / steps:.3g} s and half of it, differ by"
    want = _reference(machine, duration, len(out.time) - 1, state, "DOP853", 1e-8)
    stats = {"switched": f"{why} {doubt:.2g} of the range", "error": max(difference(out, want)), "error_seconds": float(duration)}
    return replace(want, stats=want.stats | stats | {"seconds": time.perf_counter() - started})


def _outputs(machine, duration, dt, every):
    """Number of intervals between outputs."""
    dt = min(default_step(machine), duration) if dt is None else dt
    count = math.ceil(duration / dt / every * (1 - 1e-12))
    memory, free = 32.0 * count * len(machine.dofs), free_memory()  # states, and a copy
    if memory > free:
        raise ValueError(
            f"duration = {duration:g} s: {count:.3g} outputs, every {dt * every:.3g} s, need about {memory / 1e9:.3g} GB, but "
            f"{free / 1e9:.3g} GB are free: give a shorter duration, or a larger every"
        )
    return count


def _check(machine, duration, method, dt, every):
    if not isinstance(machine, Machine):
        raise ValueError(
            f"machine = {type(machine).__name__}, but give a Machine: gf.build_machine of a scene, gf.planetary, gf.gear_pair..."
        )
    if isinstance(duration, bool) or not isinstance(duration, Real):
        raise ValueError(f"duration = {duration!r}, but give a number of seconds")
    if not (math.isfinite(duration) and duration > 0):
        raise ValueError(f"duration = {duration} s, but it must be positive")
    if method != "fast" and method not in SOLVERS:
        raise ValueError(f"method = {method!r}, but it must be 'fast' or one of {', '.join(SOLVERS)}")
    if dt is not None and not (math.isfinite(dt) and 0 < dt <= duration):
        raise ValueError(f"dt = {dt} s, but it must be positive and no longer than the duration")
    if isinstance(every, bool) or every != int(every) or every < 1:
        raise ValueError(f"every = {every!r}, but give a whole number >= 1")


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
