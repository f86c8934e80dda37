"""Checks of the arguments of `simulate` before any computation."""

import numpy as np

from ...core.checks import numbers
from ...core.memory import free_memory
from ...core.time_limit import check_time
from .reference import SOLVERS

DEEPEST, FASTEST = 1.0, 1e3  # limits of compression [m] and compression rate [m/s], beyond any gear
LONGEST, LATEST = 1e11, 1e9  # largest number of steps, latest start [s]


def check_initial(machine, state):
    """Raise ValueError for initial states in which flanks overlap by a tooth height, or move faster than any gear."""
    n = len(machine.dofs)
    deep, fast = (float(np.abs(machine.G @ part).max(initial=0.0)) for part in (state[:n], state[n:]))
    if deep > DEEPEST or fast > FASTEST:
        raise ValueError(
            f"initial: the flanks of a mesh would be {deep:.3g} m inside or apart from each other and move at "
            f"{fast:.3g} m/s, but give less "
            f"than {DEEPEST:g} m and {FASTEST:g} m/s: displacements in m and rad, velocities in m/s and rad/s"
        )


def initial_state(machine, initial):
    """Return displacements and velocities ``(n,)`` each.

    Raises ValueError unless they are finite numbers, one per degree of freedom.
    """
    parts = [numbers("initial", part, "") for part in initial] if isinstance(initial, (list, tuple, np.ndarray)) else []
    if [part.shape for part in parts] != 2 * [(len(machine.dofs),)] or not np.isfinite(parts).all():
        raise ValueError(f"initial: give displacements and velocities, {len(machine.dofs)} finite numbers each")
    return parts


def output_memory(machine, count, filtered):
    """Return the memory of `count` outputs [bytes], filtered or not; a factor of 2 is for a copy."""
    return 8.0 * count * (4 * len(machine.dofs) + (6 * (len(machine.dofs) + len(machine.meshes)) if filtered else 0))


def check_memory(machine, duration, count, filtered):
    """Raise ValueError if the outputs do not fit into memory, before they are computed."""
    memory, free = output_memory(machine, count, filtered), free_memory()
    if memory > free:
        raise ValueError(
            f"duration = {duration:g} s: {count:.3g} outputs, every {duration / count:.3g} s, need about {memory / 1e9:.3g} GB, "
            f"but {free / 1e9:.3g} GB are free: give a shorter duration, or a lower rate"
        )


def check_run(duration, method="fast", rate=None, step=None, start=0.0):
    """Raise ValueError if arguments of `simulate` are out of range or contradict each other."""
    if method != "fast" and method not in SOLVERS:
        raise ValueError(f"method = {method!r}, but it must be 'fast' or one of {', '.join(SOLVERS)}")
    if step is not None and not step <= duration:
        raise ValueError(f"step = {step} s, but it must be positive and no longer than the duration")
    if rate is not None and not duration * rate * (1 + 1e-12) >= 1:
        raise ValueError(f"rate = {rate} Hz, but give a positive number that keeps one sample or more in {duration:g} s")
    shortest = min(value for value in (step, duration, rate and 1 / rate) if value)
    if duration / shortest > LONGEST:
        raise ValueError(
            f"duration = {duration:g} s in steps of {shortest:.3g} s: {duration / shortest:.3g} of them, but at most "
            f"{LONGEST:.0e} are computed: give a shorter duration, or a longer step"
        )
    if abs(start) > LATEST:
        raise ValueError(
            f"start = {start:g} s, but give a time within {LATEST:g} s, because phases at later times are lost by rounding"
        )


def check_duration(duration, cost):
    """Return the seconds of a run at a `cost` for each second of motion.

    Raises ValueError if they are above the limit.
    """
    what = f"duration = {duration:g} s, {cost:.2g} s for each second of motion"
    check_time(what, cost * duration, "give a shorter duration, or a longer step=")
    return cost * duration
