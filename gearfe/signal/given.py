"""Checks of arguments of signal functions: rows of samples, frequencies, whole numbers."""

from typing import Any

import numpy as np
import scipy

from ..core.checks import is_number
from ..geometry.aliases import Floats
from ..geometry.checks import shown

SMALLEST, LARGEST = 1e-30, 1e30  # limits of the largest absolute value of a record in any unit, so that eighth powers are finite
ROWS = {"average": ": gf.synchronous_average(signal)[0]"}  # remedies by argument
HERTZ = (1e-12, 1e15)  # limits of frequencies [Hz]


def samples(name: str, values: Any) -> Floats:
    """Return samples as an array copy, after a check that they are real and finite.

    ValueError if they are not a row of two or more finite numbers, or the largest is not between `SMALLEST` and `LARGEST`.
    """
    if np.ma.is_masked(values):
        raise ValueError(f"{name} has masked values: give numbers without masked entries")
    try:
        values = np.array(values)
    except ValueError as error:  # The rows have different lengths.
        raise ValueError(f"{name}: give a row of real numbers ({error})") from error
    if values.ndim != 1 or values.size < 2 or values.dtype.kind not in "fiu":
        stated = shown(values.item()) if not values.ndim else f"values of shape {values.shape} and type {values.dtype}"
        raise ValueError(f"{name}: {stated}, but give a row of two or more real numbers{ROWS.get(name, '')}")
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        raise ValueError(
            f"{name}: sample {bad[0]} is {values[bad[0]]}; remove or replace the {bad.size} samples that are not finite"
        )
    values = values.astype(float)
    most = float(np.abs(values).max())
    if most >= LARGEST or 0 < most < SMALLEST:
        raise ValueError(f"{name}: the largest value is {most:g}, not a plausible measured value: scale it to its unit")
    return values


def window_values(window: Any, n: int) -> Floats:
    """Return the `n` values of a window given by its name, or by name and parameters.

    TypeError if it is neither text nor tuple. ValueError if scipy has no such window, or if its values are no window.
    """
    remedy = "but give a name such as 'hann', or a tuple such as ('kaiser', 8.0)"
    if not isinstance(window, (str, tuple)):
        raise TypeError(f"window = {window!r}, {remedy}")
    try:
        with np.errstate(all="ignore"):
            if window == "hann" and n > 1:  # without scipy's windows, which take 0.4 s to load
                return 0.5 - 0.5 * np.cos(2 * np.pi / n * np.arange(n))
            values = np.asarray(scipy.signal.get_window(window, n), float)
        reason = "" if np.isfinite(values).all() and abs(values.mean()) > 1e-9 else "its values are not finite or have no mean"
    except (ValueError, TypeError, ArithmeticError, LookupError, AttributeError) as error:
        reason = str(error)
    if reason:
        raise ValueError(f"window = {str(window)[:60]}, {remedy}: {reason}")
    return values


def oscillation(values: Floats, told: str) -> Floats:
    """Return the values without their mean. Raise ValueError with the text `told` if the values are constant."""
    x = values - values.mean()
    if not np.abs(x).max() > 1e-12 * np.abs(values).max():
        raise ValueError(told)
    return x


def hertz(name: str, value: Any) -> float:
    """Return a frequency [Hz] as a float. Raises ValueError unless it is a number within `HERTZ`."""
    if not (is_number(value) and HERTZ[0] <= value <= HERTZ[1]):
        raise ValueError(f"{name} = {value!r}, but give a positive number of Hz")
    return float(value)


def band_of(band: Any, rate: float, name: str) -> tuple[float, float]:
    """Return the ends (low, high) [Hz] of a band within half the sampling rate. None means the whole range.

    ValueError if `band` is not two numbers with ``0 <= low < high <= rate / 2``.
    """
    if band is None:
        return 0.0, rate / 2
    ends: Any = band if isinstance(band, (tuple, list)) or getattr(band, "ndim", 0) == 1 else ()
    if len(ends) != 2 or not all(map(is_number, ends)) or not 0 <= ends[0] < ends[1] <= rate / 2 * (1 + 1e-12):
        raise ValueError(f"band = {band!r} Hz, but {name} has 0 to {rate / 2:g} Hz: give (low, high) with low < high inside")
    return float(ends[0]), float(ends[1])
