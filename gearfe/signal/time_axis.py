"""Sampling rate from a column of times. Equal steps are recognised in times with few digits, and gaps are detected."""

import warnings
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from ..geometry.aliases import Floats

UNEVEN = 0.1  # tolerance of uneven time steps, relative to a step; a lost sample exceeds it
DECIMALS, DIGITS = range(-3, 13), range(3, 10)  # numbers of decimals and of significant digits that printed times may have
CLOSE = 1e-2  # tolerance for binary numbers and the fit, relative to the rounding unit
BLURRED = 1e-3  # Times rounded more coarsely, relative to the record, determine no sampling rate.


def step_of(path: Any, time: Floats, rate: float | None = None) -> float:
    """Return the step [s] of times that increase in equal steps.

    If printed times deviate by more than a tenth of a step because of few digits, a line is fitted that deviates nowhere by more
    than half of the last printed digit. A known `rate` [Hz] fixes its step. There is no such
    line if a sample is lost, unless it is lost so near the ends that rounding hides it. ValueError if the times fall, have a gap,
    are rounded too much to determine a rate, or one is not finite. Warns of rounded times, with the rate assumed.
    """
    bad = np.flatnonzero(~np.isfinite(time))
    if bad.size:
        raise ValueError(f"{path}: time {bad[0]} is {time[bad[0]]}; give finite times")
    step = float(time[-1] - time[0]) / (time.size - 1)
    off = np.abs(time - np.linspace(time[0], time[-1], time.size))
    if step > 0 and off.max() <= UNEVEN * step:
        return step
    printed = rounding(time)
    coarse, i = float(printed.max()), int(np.argmax(off)) if step > 0 else time.size - 1
    problem = f"{path}: times must rise in equal steps, but sample {i} at {time[i]:.9g} s does not fit a step of {step:.6g} s: "
    if not step > 0 or coarse < UNEVEN * step or (np.diff(time) < 0).any():
        gap = _gap(time)
        raise ValueError(f"{path}: {gap}" if gap else f"{problem}a gap, or a varying rate; resample first")
    if rate is None and coarse > BLURRED * (time[-1] - time[0]):
        raise ValueError(f"{problem}they are rounded to {coarse:g} s; print them with more digits, or give rate= too")
    fitted, miss = _fitted(time, step if rate is None else 1 / rate, printed / 2, known=rate is not None)
    if miss > 1 + CLOSE:
        other_rate = "" if rate is None else f", or another rate than {rate:g} Hz"
        raise ValueError(
            f"{problem}more than their rounding to {coarse:g} s: a gap, or a varying rate{other_rate}; resample first"
        )
    warnings.warn(
        f"{path}: times are rounded to {coarse:g} s; all of them fit {1 / fitted:.6g} Hz, which is assumed (a sample lost near "
        "an end would not be seen)",
        stacklevel=6,
    )
    return fitted


def _gap(time):
    """Return advice on a gap in times that rise evenly elsewhere. The result is empty without a gap."""
    steps = np.diff(time)
    usual = float(np.median(steps))
    leaps = np.flatnonzero(steps > 1.5 * usual)
    if not (usual > 0 and 0 < leaps.size < steps.size / 10 and np.ptp(np.delete(steps, leaps)) < UNEVEN * usual):
        return ""
    worst = int(leaps[np.argmax(steps[leaps])])
    lost = round(steps[worst] / usual) - 1
    widest = f", the widest of {leaps.size} gaps" if leaps.size > 1 else ""
    between = f"between {time[worst]:.9g} and {time[worst + 1]:.9g} s"
    return f"{lost} samples are missing {between}{widest}; cut the file there, or fill the gap"


def rounding(time: Floats) -> Floats:
    """Return the last printed digit of each time [s], the coarser of decimals and significant digits (0: not rounded)."""
    fixed = next((10.0**-k for k in DECIMALS if _multiples(time, 10.0**-k)), 0.0)
    size = np.abs(time)
    power = np.floor(np.log10(np.where(size > 0, size, 1.0)) + 1e-12)
    last = next((place for k in DIGITS if _multiples(time, place := 10.0 ** (power - k + 1))), np.zeros(time.size))
    return np.maximum(fixed, np.where(size > 0, last, 0.0))


def _multiples(time, unit):
    count = time / unit
    return bool((np.abs(count - np.round(count)) < 1e-4).all())


def _fitted(time, step, half, *, known):
    """Return the step of a line, and the distance of the times from it over the largest `half` (above 1: no such line).

    A line of slope s passes all times within `half` if ``max(y - half) <= min(y + half)`` of the remainder ``y = time - s i``.
    The difference of both sides is convex in s; its minimum is searched unless the step is `known`.
    """
    place, wide = np.arange(time.size), 2 * float(half.max())

    def excess(more):
        left = time - time[0] - (step + more * wide / time.size) * place
        return float((left - half).max() - (left + half).min())

    more = 0.0 if known else float(minimize_scalar(excess, bounds=(-2, 2), method="bounded", options={"xatol": 1e-9}).x)
    return step + more * wide / time.size, 1 + excess(more) / wide
