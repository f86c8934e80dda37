"""Angle of a shaft from the pulses of a tachometer or an encoder, or from the shaft speed."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from ..core.checks import is_number, number, whole
from ..geometry.aliases import Floats
from .given import samples
from .series import Signal

# conversion of speed units to revolutions per second
SPEEDS = {"rpm": 1 / 60, "1/min": 1 / 60, "min^-1": 1 / 60, "U/min": 1 / 60, "tr/min": 1 / 60}
FEWEST = 4  # least number of pulses
QUIET = 0.25  # hysteresis relative to the pulse height
MISSED = 1.7  # ratio of an interval to its neighbours that indicates a lost pulse


def pulse_times(tachometer: Signal, *, level: float | None = None, falling: bool = False) -> Floats:
    """Return the times at which a tachometer signal rises (falls) through a level [s], interpolated linearly.

    `with_tachometer` describes `level` and `falling`. ValueError if the signal has no pulses or only few.
    """
    x = -tachometer.values if falling else tachometer.values
    low, high = float(x.min()), float(x.max())
    level = (low + high) / 2 if level is None else number("level", level) * (-1 if falling else 1)
    armed = level - QUIET * (high - low)
    above, below = x > level, x < armed
    state = np.where(above, 1, np.where(below, -1, 0))
    marked = np.flatnonzero(state)
    rises = marked[1:][np.diff(state[marked]) == 2]  # first sample above the threshold after a sample well below it
    if rises.size < FEWEST:
        raise ValueError(
            f"{tachometer.name}: {rises.size} pulses through {-level if falling else level:g} {tachometer.unit}, but an angle "
            f"needs {FEWEST} or more; give their height as level=, or a longer record"
        )
    before = x[rises - 1]
    part = np.clip((level - before) / (x[rises] - before), 0, 1)
    return (rises - 1 + part) / tachometer.rate


def tachometer_angle(
    times: Floats, signal: Signal, pulses: int = 1, *, ratio: float = 1.0, name: str = "tachometer"
) -> tuple[Floats, NDArray[np.intp]]:
    """Return the shaft angle [rad] ``(m,)`` at the samples between the first and last pulse, and the sample numbers.

    The angle is 0 at the first pulse, and ``2 pi ratio / pulses`` larger at each further one. A cubic spline through the times of
    the pulses ``(n,)`` [s] is exact for a speed that changes evenly. `pulses` and `ratio` are those of `with_tachometer`.
    ValueError if a pulse was lost: one interval is about twice as long as the intervals next to it, or longer.

    References
    ----------
    K. R. Fyfe, E. D. S. Munck, Mech. Syst. Signal Process. 11(2) (1997) 187-205.
    """
    whole("pulses", pulses, 1)
    gaps = np.diff(times)
    lost = np.flatnonzero(gaps[1:-1] > MISSED * np.maximum(gaps[:-2], gaps[2:]))
    if lost.size:
        at = times[lost[0] + 1]
        raise ValueError(
            f"{name}: no pulse for {gaps[lost[0] + 1]:.4g} s after {at:.6g} s, between intervals of "
            f"{gaps[lost[0]]:.4g} s: one was lost, or the shaft has a mark missing; give another height as level=, or cut there"
        )
    within = np.flatnonzero((signal.time >= times[0]) & (signal.time <= times[-1]))
    turn = 2 * np.pi * shaft_ratio(ratio) / pulses
    return CubicSpline(times, turn * np.arange(times.size))(signal.time[within]), within


def shaft_ratio(ratio: object) -> float:
    """Return the ratio of the speeds of two shafts as a float. Raises ValueError if it is not positive and finite."""
    if not (is_number(ratio) and 0 < ratio < math.inf):
        raise ValueError(f"ratio = {ratio!r}, but give the speed of the gear's shaft over that of the tachometer's, above 0")
    return float(ratio)


def with_speed_record(signal: Signal, speed: Signal, *, ratio: float = 1.0) -> Signal:
    """Return a signal with the `angle` of a shaft, which is the integral of a speed recorded together with the signal.

    Errors of the speed accumulate, so that the angle drifts; pulses (`with_tachometer`) do not. The speed has one of the units of
    `SPEEDS`. `with_tachometer` describes `ratio`. ValueError if the two differ in rate or length, or the shaft stops or reverses.
    """
    _check_together(signal, speed)
    low = int(np.argmin(speed.values))
    if not speed.values[low] > 0:
        raise ValueError(f"{speed.name}: {speed.values[low]:g} {speed.unit} at sample {low}, but orders need a rotating shaft")
    turns = np.cumsum((speed.values[1:] + speed.values[:-1]) / 2) * SPEEDS[speed.unit] / speed.rate
    return replace(signal, angle=2 * np.pi * shaft_ratio(ratio) * np.append(0.0, turns), shaft_frequency=None)


def with_tachometer(
    signal: Signal,
    tachometer: Signal | ArrayLike,
    pulses: int = 1,
    *,
    ratio: float = 1.0,
    level: float | None = None,
    falling: bool = False,
) -> Signal:
    """Return the part of a signal between the first and last tachometer pulse, with the `angle` of the shaft.

    Use it for order spectra and synchronous averages at variable speed.

    Parameters
    ----------
    signal : Signal
    tachometer : Signal, or array_like of shape (n,)
        A record of the same rate and length, or the times of the pulses [s], 0 at the first sample of `signal`.
    pulses : int
        Pulses per revolution of the tachometer's shaft.
    ratio : float or fractions.Fraction
        Speed of the gear's shaft over that of the tachometer's shaft. Behind a stage of 29 and 95 teeth it is 29/95.
    level : float, optional
        At which a pulse counts, in the tachometer's unit; default: half its height.
    falling : bool
        Count where the tachometer falls instead of rises.

    Raises
    ------
    ValueError
        If the two differ in rate or length; if pulses are missing; if times do not rise or `ratio` is not positive.
    """
    if isinstance(tachometer, Signal):
        _check_together(signal, tachometer)
        times, name = pulse_times(tachometer, level=level, falling=falling), tachometer.name
    else:
        times, name = _times(tachometer), "tachometer"
    angle, within = tachometer_angle(times, signal, pulses, ratio=ratio, name=name)
    if within.size < 2:
        raise ValueError(f"{name}: pulses from {times[0]:g} to {times[-1]:g} s, but {signal.name} lasts {signal.duration:g} s")
    return replace(signal, values=signal.values[within], angle=angle, shaft_frequency=None)


def _times(given):
    times = samples("tachometer", given)
    if times.size < FEWEST or not (np.diff(times) > 0).all():
        raise ValueError(f"{times.size} times of pulses, but an angle needs {FEWEST} or more times [s] that rise")
    return times


def _check_together(signal, other):
    if (signal.rate, signal.values.size) != (other.rate, other.values.size):
        raise ValueError(
            f"{signal.name}: {signal.values.size} samples at {signal.rate:g} Hz, but {other.name} has {other.values.size} at "
            f"{other.rate:g} Hz: give records that were taken together"
        )
