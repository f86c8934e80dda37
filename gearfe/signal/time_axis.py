"""The rate of a column of times: equal steps, also where they are printed with few digits; gaps are told from rounding."""

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

UNEVEN = 0.1  # part of a step by which clocks may wander; a lost sample is more
DECIMALS, DIGITS = range(-3, 13), range(3, 10)  # of printed times
CLOSE = 1e-2  # part of a rounding: tolerance for binary numbers and the linear program
ROUNDS = 60  # of the fit, each of which adds the time it misses most
BLURRED = 1e-3  # part of the whole record: times rounded more coarsely determine no rate


def step_of(path: Any, time: NDArray[np.float64], rate: float | None = None) -> float:
    """Step [s] of times that rise in equal steps.

    Times that are off by more than a tenth of a step because they were printed with few digits are fitted by a line that is
    nowhere further from them than half of the last digit printed; with a known `rate` [Hz] its step is given. There is no such
    line if a sample is lost, unless it is lost so near the ends that rounding hides it. ValueError if the times fall, have a gap,
    are rounded too much to determine a rate, or one is not finite. Warns of rounded times, with the rate assumed.
    """
    bad = np.flatnonzero(~np.isfinite(time))
    if bad.size:
        raise ValueError(f"{path}: time {bad[0]} is {time[bad[0]]}")
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
    fitted, miss = _fitted(time, step, printed / 2) if rate is None else (1 / rate, _missed(time, 1 / rate, printed / 2))
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
    """Advice on a gap in times that rise evenly elsewhere; empty if there is none."""
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


def rounding(time: NDArray[np.float64]) -> NDArray[np.float64]:
    """Last printed digit of each time [s], by decimals or by significant digits, whichever is coarser; 0 if not rounded."""
    fixed = next((10.0**-k for k in DECIMALS if _multiples(time, 10.0**-k)), 0.0)
    size = np.abs(time)
    power = np.floor(np.log10(np.where(size > 0, size, 1.0)) + 1e-12)
    last = next((place for k in DIGITS if _multiples(time, place := 10.0 ** (power - k + 1))), np.zeros(time.size))
    return np.maximum(fixed, np.where(size > 0, last, 0.0))


def _multiples(time, unit):
    count = time / unit
    return bool((np.abs(count - np.round(count)) < 1e-4).all())


def _missed(time, step, half):
    """How far the times are from the nearest line of a known step, over `half`: more than 1 if none passes within it."""
    y = time - time[0] - step * np.arange(time.size)
    low, high = float((y - half).max()), float((y + half).min())
    return 1.0 if low <= high else 1 + (low - high) / (2 * float(half.max()))


def _fitted(time, step, half):
    """Step of the line that is nearest to the times, its distances taken over `half`, and the largest of them.

    A linear program over a few times, to which the one that its line misses most is added until none is missed by more.
    """
    unit, x = half.max(), np.linspace(0.0, 1.0, time.size)
    y, h = (time - time[0] - step * np.arange(time.size)) / unit, np.maximum(half / unit, 1e-9)
    chosen = [0, time.size // 2, time.size - 1]
    miss = slope = 0.0
    for _ in range(ROUNDS):
        near = h[chosen]
        rows, right = np.column_stack([1 / near, x[chosen] / near]), y[chosen] / near
        sides = np.vstack([np.column_stack([sign * rows, -np.ones(near.size)]) for sign in (1, -1)])
        solved = linprog([0, 0, 1], sides, np.concatenate([right, -right]), bounds=[(None, None), (None, None), (0, None)])
        place, slope, least = solved.x
        away = np.abs(y - place - slope * x) / h
        miss = float(away.max())
        if miss <= max(least, 1.0) + CLOSE / 2 or least > 1 + CLOSE:
            break
        chosen.append(int(np.argmax(away)))
    return step + slope * unit / (time.size - 1), miss
