"""`simulate`: the response of a machine, by a reference integrator or by the fast path."""

import functools
import math
import time
import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike

from ...core.record import ranged
from ...core.threads import single
from ...geometry.renamed import warn_renamed
from ..machine.tables import Machine
from .fixed_step import fixed_steps
from .law_range import compared
from .reference import reference
from .response import Response, all_channels
from .run_checks import check_duration, check_initial, check_memory, check_run, initial_state
from .run_differences import deviation
from .step_control import (
    WANTED_OPEN,
    Estimate,
    beginning,
    chosen_step,
    default_step,
    estimate,
    estimate_along,
    is_rough,
    longest_seen,
    unseen,
)
from .thinned import stages, thinned

FINE = 4  # output steps of the reference integrator per `default_step`, before filtering
FINER = 3  # number of times that the step of a whole run is halved if contact is lost
ALLOWED = 2 * WANTED_OPEN  # allowed difference with contact loss, as a part of the range
WHOLE = 1e-3  # allowed difference of a whole run with requested error, as a part of the range
COARSE = 0.1  # estimate of a given step above which a warning is issued, as a part of the range
SLOW = 5.0  # computing time above which a run reports its expected duration [s]
TRIED = 100_000  # steps of a trial run that estimates the time of a run of `MANY` steps
MANY = 100 * TRIED
NUDGE, GROWN = 1e-9, 1e-2  # initial disturbance and its largest permitted growth, relative to the range


F = TypeVar("F", bound=Callable[..., Any])


def _with_former(function: F) -> F:
    """Accept the former arguments `dt` (step and interval of the output [s]) and `every` (each n-th output)."""

    @functools.wraps(function)
    def called(machine, duration, *, dt=None, every=1, **options):
        if dt is not None or every != 1:
            warn_renamed("simulate(dt=, every=)", "simulate(rate=, step=, filtered=)")
            options = {"rate": 1 / (every * (dt or default_step(machine))), "step": dt, "filtered": dt is None} | options
        return function(machine, duration, **options)

    return cast(F, called)


@_with_former
@single
def simulate(
    machine: Machine,
    duration: float,
    *,
    method: str = "fast",
    rate: float | None = None,
    step: float | None = None,
    initial: tuple[ArrayLike, ArrayLike] | None = None,
    start: float = 0.0,
    rtol: float = 1e-8,
    error: bool | None = None,
    filtered: bool = True,
    progress: Callable[[str], object] | None = None,
) -> Response:
    """Simulate the response of a machine.

    `rate` is the output sampling rate, `step` the integration step. Channels pass an anti-aliasing filter before decimation
    (`motion.thinned`): amplitudes below 0.4 of the rate are kept, and content above half of it is removed. The states
    (`Response.q`, `Response.v`) and the channels of `Response.raw` are those of the integrator at the output times. The first
    and the last sample of a channel are not filtered, since the response beyond them is unknown. Over the next 26 samples the
    filter length increases.

    Parameters
    ----------
    machine : Machine
    duration : float
        [s]
    method : str
        ``"fast"``: `motion.propagator`, with fixed steps that are halved about changes of contact. With a nonlinear contact law,
        steps are also halved where flanks come into contact. Or a method of `scipy.integrate.solve_ivp` as the reference
        (``"DOP853"`` with ``rtol=1e-10``), between located changes of contact.
    rate : float, optional
        Samples per second kept [Hz], at the times ``start + i / rate`` up to the duration. Default: one each `default_step`.
    step : float, optional
        Step of the fast path [s], halved only about changes of contact. It is rounded down to divide the output interval (in two
        or more steps, if filtered). Its error is estimated. Default: a step whose error on a short stretch is at most 7e-4 of the
        range (`motion.step_control.chosen_step`). If contact is lost, the whole run is repeated at half the step until both agree
        within 1e-2. If they never agree, a run with a state disturbed by 1e-9 shows the cause. If the disturbance grows as much,
        no integration can follow the motion, and ``stats["chaotic"]`` is true. Otherwise the reference integrator is used, and
        ``stats["switched"]`` is true.
    initial : (ndarray, ndarray), optional
        Displacements and velocities ``(n,)``; default: at rest under the loads at the start (`Machine.rest`).
    start : float
        Time of the first state [s].
    rtol : float
        Relative tolerance of the reference; its atol is a thousandth of that of the largest value at rest.
    error : bool, optional
        Fast path: True repeats the whole run with half the step, until two runs agree within 1e-3 if the step is chosen
        automatically. ``stats["error"]`` is then of the whole run. False disables the estimate for a given step.
    filtered : bool
        If False, channels are those of the integrator at the output times. Filtering needs two steps or more for each output.
    progress : callable, optional
        Function that receives a line before compilation (6 to 20 s on the first run on a computer), and one with the expected
        seconds of a long run.

    Returns
    -------
    Response
        ``stats["error"]`` is the estimated error: the largest difference of displacements and mesh forces to a run of half the
        step (with a nonlinear contact law, a third), relative to their ranges (`motion.step_control.differences`). It is
        evaluated on ``stats["error_seconds"]`` of the run, about the worst damaged tooth or at the highest speed, or on the whole
        run. ``stats["error_acceleration"]`` is that of the accelerations. Without damping the error grows after such a stretch;
        then use ``error=True``. These are integration errors. ``stats["error_phases"]`` is the interpolation error of stiffnesses
        between their phases, relative to their spread, of healthy cycles and of damaged teeth
        (`motion.law_range.between_phases`). If it is larger, solve more phases.
        ``stats["loads"]`` lists the mesh forces outside the loads of their force law or stiffness curve.

    Raises
    ------
    ValueError
        If an input is impossible, or the run would take longer than the limit of `gearfe.core.time_limit`.
    RuntimeError
        If the response grows beyond all bounds, or the reference integrator fails.

    Warns
    -----
    UserWarning
        If the estimate of a given step is above a tenth of the range. If a mesh force is above the loads of its law
        (`gearfe.dynamics.machine.force_law.ForceLaw`). Without `progress`, before the loop is compiled.

    Examples
    --------
    A mesh whose stiffness goes up and down by a tenth, at 0.63 of the natural frequency of 1592 Hz:

    >>> import numpy as np, gearfe as gf
    >>> wave = 1e8 * (1 + 0.1 * np.cos(2 * np.pi * np.arange(64) / 64))  # N/m, over the mesh cycle
    >>> machine = gf.single_mesh(1.0, wave, frequency=1000.0, force=1000.0, zeta=0.05)
    >>> run = gf.simulate(machine, 0.2, rate=20000.0)
    >>> force = run["force mesh"][2000:]  # without the transient
    >>> print(f"{force.min():.0f} to {force.max():.0f} N are carried, {force.mean():.0f} N on average")
    913 to 1052 N are carried, 1000 N on average
    """
    duration, start, rtol = (
        ranged("duration", duration, " s", above=0.0),
        ranged("start", start, " s"),
        ranged("rtol", rtol, above=0.0),
    )
    rate, step = (
        None if value is None else ranged(name, value, unit, above=0.0)
        for name, value, unit in (("rate", rate, " Hz"), ("step", step, " s"))
    )
    check_run(duration, method, rate, step, start)
    if initial is None:
        state = np.concatenate([machine.rest(start), np.zeros(len(machine.dofs))])
    else:
        state = np.concatenate(initial_state(machine, initial))
        check_initial(machine, state)
    if rate is not None:
        count = math.floor(duration * rate * (1 + 1e-12))
        duration = count / rate
    else:
        count = math.ceil(duration / min(default_step(machine), duration) * (1 - 1e-12))
    check_memory(machine, duration, count, filtered)
    if method != "fast":
        return compared(_reference(machine, duration, count, state, method, rtol, start, filtered))
    own = state if initial is not None else None
    from .loop_parts import announced  # This import loads the compiler.

    run = _Runs(machine, duration, count, state, own, start, filtered, progress)
    with announced(progress) as compiled:
        out = run.controlled(error) if step is None else run.given(math.ceil(duration / count / step * (1 - 1e-12)), error)
    seconds = {"seconds": out.stats["seconds"] - compiled.seconds, "compiled": compiled.seconds}
    return compared(replace(out, stats=out.stats | seconds))


def _reference(machine, duration, count, state, method, rtol, start, filtered):
    """Return the response of `reference`, with filtered channels if requested.

    A long run is timed on its first steps before it is begun.
    """
    span = TRIED / 100 * default_step(machine)
    if span < duration / 100:
        started = time.perf_counter()
        reference(machine, span, 1, state, method, rtol, start)
        check_duration(duration, (time.perf_counter() - started) / span)
    if not filtered:
        return reference(machine, duration, count, state, method, rtol, start)
    counts = stages(FINE * math.ceil(duration / count / default_step(machine) * (1 - 1e-9)))
    every = math.prod(counts)
    check_memory(machine, duration, count * every, filtered)
    whole = reference(machine, duration, count * every, state, method, rtol, start)
    return replace(whole.part(slice(None, None, every)), filtered=thinned([all_channels(whole)], counts))


class _Runs:
    """Runs of the fast integrator with the same output times: `count` intervals of one or more steps each."""

    def __init__(self, machine, duration, count, state, own, start, filtered, progress):
        self.machine, self.duration, self.count, self.state = machine, duration, count, state
        self.own, self.start, self.filtered = own, start, filtered
        self.tell = progress or (lambda line: None)

    def _watch(self, cost):
        """Report the estimated time of the whole run. Reject a run that takes hours."""
        seconds = check_duration(self.duration, cost)
        if seconds > SLOW:
            self.tell(f"{self.duration:.3g} s of motion at this step: about {seconds:.2g} s")

    def steps(self, every):
        """Return the number of steps per output: `every`, or slightly more if channels are filtered."""
        return math.prod(stages(every)) if self.filtered else every

    def __call__(self, every, state=None, adapt=False):
        """Integrate with ``steps(every)`` steps per output interval, and return the response."""
        state = self.state if state is None else state
        counts, every = stages(every) if self.filtered else (), self.steps(every)
        options = {"every": every, "start": self.start, "adapt": adapt, "counts": counts}
        return fixed_steps(self.machine, self.duration, every * self.count, state, **options)

    def given(self, every, error):
        """Integrate with the step that the caller chose. Estimate its error, unless `error` is False."""
        started, every = time.perf_counter(), self.steps(every)
        if every * self.count > MANY:
            span = self.duration * TRIED / (every * self.count)
            tried = fixed_steps(self.machine, span, TRIED, self.state, every=TRIED, start=self.start)
            self._watch(tried.stats["seconds"] / span)
        out = self(every)
        if error is False:
            return out
        length = float(self.duration)
        if error:
            moved, shaken = deviation(out, self(2 * every))
            found = Estimate(moved, False, length, 0.0, shaken)
        else:
            try:
                place, span = beginning(self.machine, self.duration, self.own, self.start)
                found = estimate(self.machine, out.stats["dt"], span, [place])
            except RuntimeError:  # A part of the run may be unstable with another step although the run itself is stable.
                found = Estimate(math.inf, False, length, 0.0, math.inf)
        doubt = max(found.error, unseen(self.machine, self.start, self.duration, out.stats["dt"]))
        if not doubt <= COARSE:
            warnings.warn(
                f"a step of {out.stats['dt']:.3g} s is too long for this machine: its error is about {100 * doubt:.2g} % of the "
                "range of the motion; omit the step, and state the output rate by rate=",
                stacklevel=3,
            )
        stats = {"error": doubt, "error_acceleration": found.acceleration, "error_seconds": found.length}
        return replace(out, stats=out.stats | stats | {"seconds": time.perf_counter() - started})

    def controlled(self, error):
        """Run at the chosen step. With contact loss, refine until two whole runs agree, or use the reference integrator."""
        started = time.perf_counter()

        def told(one, **more):
            return replace(one, stats=one.stats | more | {"seconds": time.perf_counter() - started})

        longest = longest_seen(self.machine, self.start, self.duration)
        options = {"begin": self.start, "adapt": True, "watch": self._watch, "longest": longest}
        dt, found = chosen_step(self.machine, self.duration, self.own, **options)
        every = self.steps(math.ceil(self.duration / self.count / dt * (1 - 1e-9)))
        out = self(every, adapt=True)
        if not (out.stats["losses"] or error):
            if is_rough(self.machine):
                found = estimate_along(out, found)
            return told(out, error=found.error, error_acceleration=found.acceleration, error_seconds=found.length)
        length = float(self.duration)
        for _ in range(FINER):
            every *= 2
            finer = self(every, adapt=True)
            (doubt, shaken), out = deviation(out, finer), finer
            if doubt <= (ALLOWED if out.stats["losses"] else WHOLE):
                break
        if doubt <= ALLOWED or not out.stats["losses"]:
            return told(out, error=doubt, error_acceleration=shaken, error_seconds=length)
        h = out.stats["dt"]
        why = f"contact is lost and two runs of the fast path, with steps of {2 * h:.3g} s and half of it, differ by {doubt:.2g}"
        rest = np.concatenate([self.machine.rest(self.start), np.zeros(len(self.machine.dofs))])
        grown, _ = deviation(self(every, self.state + NUDGE * (self.state + rest), adapt=True), out)
        if grown > GROWN:
            why += f" of the range, and two whose start differs by {NUDGE:g} by {grown:.2g}: no integration can follow the motion"
            why += " for so long; trust its averages and spectra, or shorten the run"
            return told(out, chaotic=why, error=doubt, error_seconds=length)
        start = self.start
        want = _reference(self.machine, self.duration, self.count, self.state, "DOP853", 1e-10, start, self.filtered)
        return told(want, switched=f"{why} of the range", error=deviation(out, want)[0], error_seconds=length)
