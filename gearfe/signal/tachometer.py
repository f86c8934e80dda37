"""From the pulses of a tachometer to the angle of its shaft."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from .series import Signal

HYSTERESIS = 0.2  # of the height of a pulse: what the signal must fall below the level before it can rise above it again


def tachometer_angle(tachometer: Signal, pulses: int = 1, *, level: float | None = None) -> NDArray[np.float64]:
    """Angle of a shaft at every sample of its tachometer [rad], for `Signal.angle`.

    A pulse is counted where the signal rises above `level`, having been well below it (a fifth of its height), at the time
    found by a straight line between two samples. Between pulses the angle is a cubic spline of the time; before the first and
    after the last one it goes on at the speed found there. A slope of a pulse that lasts less than a sample is known to half a
    sample: the angle to ``2 pi turns/s / (2 rate)``.

    Parameters
    ----------
    tachometer : Signal
        Pulses, or any signal that passes a level once per mark of the shaft, recorded with what is to be analysed.
    pulses : int
        Marks per turn.
    level : float, optional
        In the unit of the signal; default: half way between its 1st and 99th percentile.

    Returns
    -------
    ndarray, shape (n,)
        Rising, 0 at the first pulse.

    Raises
    ------
    ValueError
        If there are fewer than four pulses.

    References
    ----------
    K. R. Fyfe, E. D. S. Munck, Analysis of computed order tracking, Mech. Syst. Signal Process. 11(2) (1997) 187-205.
    """
    if isinstance(pulses, bool) or pulses != int(pulses) or pulses < 1:
        raise ValueError(f"pulses = {pulses!r}, but give a whole number of marks per turn")
    values, (low, high) = tachometer.values, np.percentile(tachometer.values, (1, 99))
    level = (low + high) / 2 if level is None else level
    times = _rises(values, level, HYSTERESIS * (high - low)) / tachometer.rate
    if times.size < 4:
        raise ValueError(
            f"{tachometer.name}: {times.size} pulses above {level:.4g} {tachometer.unit} in {tachometer.duration:.4g} s, but "
            "four are needed: give another level, or a longer record"
        )
    turn = 2 * math.pi * np.arange(times.size) / pulses
    spline, at = make_interp_spline(times, turn, k=3, bc_type="natural"), tachometer.time
    speed, inside = spline.derivative(), np.clip(at, times[0], times[-1])
    angle = spline(inside) + (at - inside) * speed(inside)
    if not (np.diff(angle) > 0).all():
        raise ValueError(f"{tachometer.name}: its pulses come so unevenly that the shaft would turn back; look for missing ones")
    return angle


def _rises(values, level, fall):
    """Samples, with their parts, at which `values` rise through `level` after they were below ``level - fall``."""
    up = np.flatnonzero((values[:-1] < level) & (values[1:] >= level))
    below = np.concatenate([[0], np.cumsum(values < level - fall)])
    armed = np.diff(below[up + 1], prepend=0) > 0  # was low since the rise before
    up = up[armed]
    return up + (level - values[up]) / (values[up + 1] - values[up])
