"""Step control of the fast integrator, based on the difference between runs with two step lengths.

The error of a step depends on the mesh cycles, the excited modes, the slope of the stiffness curves and the damaged tooth. No
single frequency determines it. A short segment of the motion is therefore computed with a step and with half of it, and the
step is changed until both agree.
"""

import math
from typing import NamedTuple

import numpy as np

from ...stiffness.curve import StiffnessCurve
from .fixed_step import fixed_steps
from .propagator import default_step, is_bent, plan
from .run_differences import differences, seen

WANTED, WANTED_OPEN = 7e-4, 5e-3  # largest error relative to the range: meshes closed, contact lost
CYCLES = 3.5  # length of a repeated segment [cycles of the slowest mesh]
SPREAD = 4  # segments repeated to estimate the error of a run with nonlinear contact; a shorter run is repeated completely
HALVINGS = 6
MOST_STEPS = 1e9  # largest number of steps in a segment
# ratio of the error to the difference from a run with half the step: for fourth order, and if step positions matter
SMOOTH, ROUGH = 1.2, 2.0
SEEN = 3e-3  # allowed interpolation error of load functions between steps, relative to their spread
SAMPLES = 1000  # samples per segment at which two runs are compared
PROBES = 50_000  # number of random instants at which load functions are checked


def unseen(machine, start, duration, h):
    """Return the largest deviation of loads given as functions from linear interpolation in steps `h` [s], over their spread.

    A run evaluates them at quarters of its steps and interpolates linearly. The deviation is evaluated at random times over the
    whole run, not on a stretch, so that a burst or a tone far above the meshes is detected.
    """
    functions = [applied for applied in machine.loads if callable(applied.value)]
    if not functions:
        return 0.0
    t = start + duration * np.random.default_rng(0).random(PROBES)
    part, whole = np.modf((t - start) / (h / 4))
    low = start + h / 4 * whole
    worst = 0.0
    for load in functions:
        value, left, right = load(t), load(low), load(low + h / 4)
        spread = float(np.std(value))
        off = float(np.sqrt(np.mean((left + part * (right - left) - value) ** 2)))
        worst = max(worst, off / spread if spread else 0.0)
    return worst


def longest_seen(machine, start, duration):
    """Longest step that resolves the loads within `SEEN` [s], between `default_step` over ``2**12`` and `default_step`."""
    h = default_step(machine)
    for _ in range(12):
        if unseen(machine, start, duration, h) <= SEEN:
            break
        h /= 2
    return h


def stretch(machine, duration, begin=0.0):
    """Start and length [s] of the stretch of a run, from time `begin` on, over which the error is estimated.

    It lasts `CYCLES` mesh cycles, which contain the engagement of the worst damaged tooth. At variable speed it is where the
    speed is largest.
    """
    rates = [abs(m.frequency) for m in machine.meshes if m.frequency]
    if not rates:
        return begin, min(duration, 1000 * default_step(machine))
    length = min(duration, CYCLES / (min(rates) * machine.fastest))
    if machine.speed is not None:
        times = begin + np.linspace(0.0, duration - length, 1000)
        return float(times[np.argmax(np.diff(machine.turned([times, times + length]), axis=0))]), length
    worst, start = 0.0, begin
    for mesh in machine.meshes:
        for (_, _, change), times in zip(mesh.changes, mesh.entries(begin + duration) if mesh.frequency else (), strict=False):
            depth, times = np.abs(change.cells[:, 0]).max() / mesh.cycle.mean, times[times >= begin]
            if times.size and depth > worst:
                worst, before = depth, 0.5 if mesh.frequency > 0 else CYCLES - 0.5
                start = times[0] - before / abs(mesh.frequency)
    return max(begin, min(start, begin + duration - length)), length


def wanted(lost):
    """Return the permitted error of a step relative to the range, which depends on loss of contact."""
    return WANTED_OPEN if lost else WANTED


def beginning(machine, duration, initial=None, begin=0.0):
    """Return time and state ``(2n,)`` at the start of the `stretch` of a run, and its length [s]. The default state is rest."""
    start, length = stretch(machine, duration, begin)
    if initial is None:
        initial = np.concatenate([machine.rest(start), np.zeros(len(machine.dofs))])
    return (start, initial), length


def chosen_step(machine, duration, initial=None, *, begin=0.0, adapt=False, watch=None, longest=math.inf):
    """Step of the fast integrator, at most `default_step`, with an error on a `stretch` of at most `WANTED` of the range.

    If contact is lost on the stretch, the limit is `WANTED_OPEN`.

    Parameters
    ----------
    machine : Machine
    duration : float
        Of the whole run [s].
    initial : ndarray, shape (2n,), optional
        State from which the stretch starts; default: at rest.
    begin : float
        Time at which the run starts [s].
    adapt : bool
        Of `gearfe.dynamics.motion.fixed_step.fixed_steps`: the step is then the longest.
    watch : callable, optional
        Gets the seconds that a simulated second takes at each step tried; may raise.
    longest : float
        Step to begin with [s], if it is shorter than `default_step`.

    Returns
    -------
    dt : float
        [s]
    assessed : Estimate
        Of that step.
    """

    def error(h):
        try:
            assessed = estimate(machine, h, length, [place], adapt=adapt, tried=True)
        except RuntimeError:
            if h < 0.9 * low:
                raise
            return Estimate(math.inf, False, length, 0.0, math.inf)
        if watch is not None:
            watch(assessed.cost)
        return assessed

    place, length = beginning(machine, duration, initial, begin)
    h = min(default_step(machine), length, longest)
    low = h / 2**HALVINGS
    if length > MOST_STEPS * h:
        raise ValueError(
            f"the machine vibrates so fast that a step of {h:.2g} s is needed, and {length:.3g} s have {length / h:.2g} steps, "
            f"more than {MOST_STEPS:.0e}: check its masses and stiffnesses"
        )
    assessed = error(h)
    while assessed.error > wanted(assessed.lost) and h > low:
        h *= max(0.25, min(0.8, 0.9 * (WANTED / assessed.error) ** 0.25)) if not assessed.lost else 0.5
        assessed = error(h)
    return h, assessed


class Estimate(NamedTuple):
    """Error and cost of a step, from two runs over a stretch, with this step and with half of it.

    Attributes
    ----------
    error : float
        Larger of the `differences` of displacements and mesh forces, times `SMOOTH` or `ROUGH`.
    lost : bool
        Whether contact is lost there.
    length : float
        Length of the segment [s].
    cost : float
        Wall time for a simulated second at this step [s], from the additional time of the run with half the step.
    acceleration : float
        Error of the accelerations, by the same rule.
    """

    error: float
    lost: bool
    length: float
    cost: float
    acceleration: float


def is_rough(machine):
    """Return True if the error depends on the positions of steps, as for a nonlinear law or a force law."""
    return is_bent(machine) or any(mesh.secants for mesh in machine.meshes)


def is_kinked(machine):
    """Return True if a mesh has a `StiffnessCurve`, which has kinks where pairs enter and leave. Steps pass over them."""
    curves = (curve for mesh in machine.meshes for curve in (mesh.stiffness, *(hurt.curve for hurt in mesh.damage)))
    return any(isinstance(curve, StiffnessCurve) for curve in curves)


def estimate(machine, h, length, places, *, adapt=False, tried=False):
    """Largest `Estimate` of the step `h` over stretches of `length` seconds, which start at the times and states in `places`.

    With local halving of steps, or with kinks, the error also depends on where the steps happen to lie, and a shorter step can be
    worse. Two runs, with the step and with half of it, are then both compared with a third run with a third of the step. A step
    that is `tried` needs no third run if the difference of the first two is already too large.
    """
    count, x = length / h * (1 - 1e-12), machine.working()
    rough = (adapt and is_rough(machine)) or is_kinked(machine)
    every = max(1, int(count / SAMPLES))
    steps = every * math.ceil(count / every)
    plans = {c: plan(machine, length / (c * steps), x, adapt) for c in ((1, 2, 3) if rough else (1, 2))}

    def run(c, start, state):
        return fixed_steps(machine, length, c * steps, state, every=c * every, start=start, adapt=adapt, plan=plans[c])

    def apart(told):
        found = np.max([differences(each, told[-1], machine) for each in told[:-1]], axis=0)
        return (ROUGH if rough else SMOOTH) * np.array([max(found[:2]), found[2]])

    worst, lost, cost = np.zeros(2), False, 0.0
    for place in places:
        runs = [run(c, *place) for c in (1, 2)]
        told, opened = [seen(each) for each in runs], runs[1].stats["losses"] > 0
        if rough and not (tried and apart(told)[0] > wanted(opened)):
            told.append(seen(run(3, *place)))
        worst, lost = np.maximum(worst, apart(told)), lost or opened
        one, two = (each.stats["seconds"] for each in runs)
        if one >= two:  # the first run includes compilation or waiting time
            one = run(1, *place).stats["seconds"]
        cost = max(cost, two - one, two / 4)  # about half of `two`, with a lower limit because of timing noise
    return Estimate(float(worst[0]), lost, length * len(places), cost / length, float(worst[1]))


def estimate_along(response, found):
    """Return the `Estimate` of a run under laws for which `is_rough`, from its own states.

    The error depends on the positions of steps at the entry of pairs, so that one stretch is not sufficient. A run as short as
    `SPREAD` stretches is repeated completely. For a longer one, `SPREAD` stretches distributed over it are repeated, each from
    the state of the run there. These do not contain earlier errors. Errors of consecutive stretches add like independent ones,
    until the least damped vibration has decayed.

    Parameters
    ----------
    response : Response
        Result of `gearfe.dynamics.motion.fixed_step.fixed_steps`, ``adapt=True``.
    found : Estimate
        Of its step on one stretch.
    """
    machine, time, h, length = response.machine, response.time, response.stats["dt"], found.length
    begin, duration, grown, index = float(time[0]), float(time[-1] - time[0]), 1.0, [0]
    if duration > SPREAD * length:
        index = np.searchsorted(time, begin + np.linspace(0.0, duration - length, SPREAD) * (1 - 1e-12)) - 1
        index = np.unique(np.maximum(index, 0))
        values = np.linalg.eigvals(plan(machine, h, machine.working()).levels[0][0])
        # part of a squared error that remains after one segment
        left = np.abs(values[values.imag > 0]).max(initial=0.0) ** (2 * length / h)
        grown = math.sqrt(sum(left**i for i in range(math.ceil(duration / length))))
    else:
        length = duration
    state = np.concatenate([response.q, response.v], axis=1)
    along = estimate(machine, h, length, [(float(time[i]), state[i]) for i in index], adapt=True)
    error, acceleration = (max(getattr(along, key), getattr(found, key)) * grown for key in ("error", "acceleration"))
    return Estimate(error, found.lost or along.lost, along.length, found.cost, acceleration)
