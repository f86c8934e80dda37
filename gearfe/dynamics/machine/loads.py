"""`Load`: external load of a machine, constant or as a function of time."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.checks import numbers, whole
from ...core.memory import check_memory
from ...core.record import ranged, settle, settle_numbers, settle_row
from ...geometry.aliases import Floats

RISE = 0.1  # part of the width of a pulse in which it rises, and in which it falls
# Value of a load: a number, times with values, or a function of an array of times.
History = float | tuple[ArrayLike, ArrayLike] | Callable[[Floats], ArrayLike]
BYTES = 200.0  # memory of a pulse in `pulses` [bytes]


@dataclass(frozen=True, slots=True)
class Load:
    """A load along a row: a number, a piecewise linear history ``(times, values)``, or a function of an array of times.

    Outside its times a history is constant. Two equal times are a jump. A function must be smooth.

    Parameters
    ----------
    name : str
    row : ndarray, shape (n,)
        The load acts on the n degrees of freedom of a machine as ``row`` times its value (`Layout.unit`, `Layout.point`).
    value : float, (ndarray, ndarray) or callable
        Along its row: a force [N] on displacements, a torque [N m] on rotations. Times are in s.

    Raises
    ------
    ValueError
        If a number or a history is not finite, if a history is empty or has not as many times as values, or if its times fall. A
        function is looked at when the load is called: if it gives a value that is not finite.
    """

    name: str
    row: Floats
    value: History

    def __post_init__(self) -> None:
        """Raise ValueError if a value is not finite, or if the times of a history decrease."""
        settle_row(self, "load")
        if np.ndim(self.value) if isinstance(self.value, np.ndarray) else isinstance(self.value, (tuple, list)):
            settle(self, value=rising(f"load {self.name}", *self.value, strict=False))  # type: ignore[misc]
        elif not callable(self.value):
            settle_numbers(self, f"load {self.name}", "value")

    def __call__(self, t: ArrayLike) -> Floats:
        """Value at times `t`."""
        value: Any = self.value
        if isinstance(value, tuple):
            return np.asarray(np.interp(np.asarray(t, dtype=float), *value))
        values = np.broadcast_to(np.asarray(value(t) if callable(value) else value, dtype=float), np.shape(t))
        if not np.isfinite(values).all():
            raise ValueError(f"load {self.name}: its function gives a value that is not finite (nan or inf)")
        return values

    @property
    def breaks(self) -> Floats:
        """Times at which the slope or the value of the history jumps [s]."""
        return np.unique(self.value[0]) if isinstance(self.value, tuple) else np.empty(0)

    @property
    def changes(self) -> bool:
        """Whether the load changes with time."""
        return callable(self.value) or self.breaks.size > 1


def rising(what: str, *columns: Any, strict: bool) -> tuple[NDArray, NDArray]:
    """Return checked times [s] and values of a load or speed history.

    Raises ValueError unless they are finite, equal in number, and the times rise.

    With `strict` False two times may be equal.
    """
    if len(columns) != 2:
        raise ValueError(f"{what}: give times and values, two rows of numbers")
    times, values = (numbers(what, column, "") for column in columns)
    if times.ndim != 1 or times.shape != values.shape or not times.size:
        raise ValueError(f"{what}: give as many times as values, got shapes {times.shape} and {values.shape}")
    if not (np.isfinite(times).all() and np.isfinite(values).all()):
        raise ValueError(f"{what}: a time or a value is not finite (nan or inf)")
    wrong = np.diff(times) <= 0 if strict else np.diff(times) < 0
    if wrong.any():
        at = int(np.argmax(wrong)) + 1
        raise ValueError(f"{what}: time {times[at]:g} s follows {times[at - 1]:g} s; sort the history by time")
    return times, values


def pulses(base: float, peak: float, period: float, width: float, count: int, *, start: float = 0.0) -> tuple[Floats, Floats]:
    """History of a load that rises from `base` to `peak` for `width` seconds, every `period` seconds, `count` times.

    Each edge of a pulse lasts the part `RISE` of its width. The result is a value for `Load`.

    Parameters
    ----------
    base, peak : float
        Values between the pulses and on top of them, in the unit of the load: [N] or, of a torque, [N m].
    period, width : float
        From the start of a pulse to that of the next, and from the start of a pulse to its end [s].
    count : int
        Number of pulses.
    start : float
        Start of the first pulse [s].

    Returns
    -------
    times, values : ndarray, shape (4 count,)
        Corners of the pulses: times [s], and values in the unit of the load.

    Raises
    ------
    ValueError
        Unless all numbers are finite, ``0 < width < period``, and `count` is a whole number >= 1 that memory holds.
    """
    count = whole("count", count, 1)
    for name, value in {"base": base, "peak": peak, "period": period, "width": width, "start": start}.items():
        ranged(name, value)
    if not 0 < width < period:
        raise ValueError(f"width = {width} s, but pulses need 0 < width < period")
    check_memory(f"count = {count}", BYTES * count, "give fewer pulses")
    first = start + period * np.arange(count)[:, None]
    times = first + width * np.array([0.0, RISE, 1 - RISE, 1.0])
    return times.ravel(), np.tile([base, peak, peak, base], count).astype(float)
