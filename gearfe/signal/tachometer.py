"""The angle of a shaft from the pulses of a tachometer or an encoder, or from its speed."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ..core.checks import whole
from .series import Signal

SPEEDS = {"rpm": 1 / 60, "1/min": 1 / 60, "min^-1": 1 / 60, "U/min": 1 / 60, "tr/min": 1 / 60}  # turns per second, by unit
FEWEST = 4  # pulses
QUIET = 0.25  # of the height of the pulses: how far below the level a signal must fall before it can rise again
MISSED = 1.7  # an interval this many times those before and after it hides a lost pulse


def pulse_times(tachometer: Signal, *, level: float | None = None, falling: bool = False) -> NDArray[np.float64]:
    """Times at which a tachometer's signal rises (falls) through a level [s], between samples by a straight line.

    `level` and `falling` are as of `with_tachometer`. ValueError if the signal has no pulses or only few.
    """
    x = -tachometer.values if falling else tachometer.values
    low, high = float(x.min()), float(x.max())
    level = (low + high) / 2 if level is None else (-level if falling else level)
    armed = level - QUIET * (high - low)
    above, below = x > level, x < armed
    state = np.where(above, 1, np.where(below, -1, 0))
    marked = np.flatnonzero(state)
    rises = marked[1:][np.diff(state[marked]) == 2]  # first sample above since the last one well below
    if rises.size < FEWEST:
        raise ValueError(
            f"{tachometer.name}: {rises.size} pulses through {-level if falling else level:g} {tachometer.unit}, but an angle "
            f"needs {FEWEST} or more; give their height as level=, or a longer record"
        )
    before = x[rises - 1]
    part = np.clip((level - before) / (x[rises] - before), 0, 1)
    return (rises - 1 + part) / tachometer.rate


def tachometer_angle(
    tachometer: Signal, pulses: int = 1, *, level: float | None = None, falling: bool = False
) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Angle of the shaft [rad] ``(m,)`` at the samples between the first and last pulse, 0 at the first; and their numbers.

    Each pulse is ``2 pi / pulses`` further; through their times a cubic spline is laid, exact for a speed that changes evenly. A
    pulse that lies between two samples is placed by a straight line between them, to a small part of a sample. `pulses`, `level`
    and `falling` are as of `with_tachometer`. ValueError if there are too few pulses, or one was lost: an interval of about two
    or more beside ordinary ones.

    References
    ----------
    K. R. Fyfe, E. D. S. Munck, Mech. Syst. Signal Process. 11(2) (1997) 187-205.
    """
    whole("pulses", pulses, 1)
    times = pulse_times(tachometer, level=level, falling=falling)
    gaps = np.diff(times)
    lost = np.flatnonzero(gaps[1:-1] > MISSED * np.maximum(gaps[:-2], gaps[2:]))
    if lost.size:
        at = times[lost[0] + 1]
        raise ValueError(
            f"{tachometer.name}: no pulse for {gaps[lost[0] + 1]:.4g} s after {at:.6g} s, between intervals of "
            f"{gaps[lost[0]]:.4g} s: one was lost, or the shaft has a mark missing; give another height as level=, or cut there"
        )
    samples = np.flatnonzero((tachometer.time >= times[0]) & (tachometer.time <= times[-1]))
    angle = CubicSpline(times, 2 * np.pi / pulses * np.arange(times.size))(samples / tachometer.rate)
    return angle, samples


def with_speed_record(signal: Signal, speed: Signal) -> Signal:
    """A signal with the `angle` of a shaft whose speed was recorded with it: the integral of the speed, from 0.

    Errors of the speed add up, so that the angle drifts against the shaft; pulses (`with_tachometer`) do not. The speed is in one
    of the units of `SPEEDS`. ValueError if the two differ in rate or length, or the shaft stands still or turns back.
    """
    _check_together(signal, speed)
    low = int(np.argmin(speed.values))
    if not speed.values[low] > 0:
        raise ValueError(
            f"{speed.name}: {speed.values[low]:g} {speed.unit} at sample {low}, but orders need a shaft that turns on"
        )
    turns = np.cumsum((speed.values[1:] + speed.values[:-1]) / 2) * SPEEDS[speed.unit] / speed.rate
    return replace(signal, angle=2 * np.pi * np.append(0.0, turns), shaft_frequency=None)


def with_tachometer(
    signal: Signal, tachometer: Signal, pulses: int = 1, *, level: float | None = None, falling: bool = False
) -> Signal:
    """The part of a signal between the first and the last pulse of a tachometer, with the `angle` of the shaft.

    For order spectra and synchronous averages of a machine whose speed changes.

    Parameters
    ----------
    signal, tachometer : Signal
        Of one rate and length.
    pulses : int
        In a turn of the shaft.
    level : float, optional
        At which a pulse counts, in the tachometer's unit; default: half its height.
    falling : bool
        Count where the tachometer falls instead of rises.

    Raises
    ------
    ValueError
        If the two differ in rate or length; if pulses are missing.
    """
    _check_together(signal, tachometer)
    angle, samples = tachometer_angle(tachometer, pulses, level=level, falling=falling)
    return replace(signal, values=signal.values[samples], angle=angle, shaft_frequency=None)


def _check_together(signal, other):
    if (signal.rate, signal.values.size) != (other.rate, other.values.size):
        raise ValueError(
            f"{signal.name}: {signal.values.size} samples at {signal.rate:g} Hz, but {other.name} has {other.values.size} at "
            f"{other.rate:g} Hz: give records that were taken together"
        )
