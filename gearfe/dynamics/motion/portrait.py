"""Motion in the phase plane: portrait and Poincare section."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from ...geometry.aliases import Floats
from ...signal.series import Signal


def phase_portrait(signal: Signal, velocity: Signal | None = None) -> tuple[Floats, Floats]:
    """Displacement and velocity at every sample, for a plot of one over the other.

    Parameters
    ----------
    signal : Signal
        Displacement.
    velocity : Signal, optional
        Simulated velocity. Default: derivative of the spline of degree 5 through the displacement. The relative error of its
        amplitude at frequency f is below ``6 (f / (rate - f))**5``: 1e-4 at a tenth of the rate.

    Returns
    -------
    x, v : ndarray, shape (n,)
        In the unit of the signal, and in that unit per second.
    """
    x, v = _splines(signal, velocity)
    return x(signal.time), v(signal.time)


def poincare_section(signal: Signal, frequency: float, velocity: Signal | None = None, *, start: float = 0.0) -> NDArray:
    """Points of the phase portrait, one per period. They coincide if the motion has that period.

    Parameters
    ----------
    signal : Signal
        Displacement.
    frequency : float
        Of the excitation [Hz], for example of the mesh; a fault that repeats n mesh periods later gives n points.
    velocity : Signal, optional
        See `phase_portrait`.
    start : float
        Time of the first point [s]; leave out the transient.

    Returns
    -------
    ndarray, shape (points, 2)
        Displacement and velocity, interpolated between samples; in the unit of the signal, and in that unit per second.

    Raises
    ------
    ValueError
        If `frequency` is not between 0 and half of the rate, `start` lies outside the record, the record has fewer than 6
        samples, or `velocity` differs from it in rate or length.

    References
    ----------
    F. C. Moon, Chaotic and Fractal Dynamics, Wiley (1992).
    """
    if not 0 < frequency < signal.rate / 2:
        raise ValueError(f"frequency = {frequency} Hz, but {signal.name} has 0 to {signal.rate / 2:g} Hz")
    last = (signal.values.size - 1) / signal.rate
    if not 0 <= start <= last:
        raise ValueError(f"start = {start} s, but {signal.name} lasts from 0 to {last:g} s")
    time = np.minimum(start + np.arange(math.floor((last - start) * frequency + 1e-9) + 1) / frequency, last)
    return np.transpose([part(time) for part in _splines(signal, velocity)])


def _splines(signal, velocity):
    if signal.values.size < 6:
        raise ValueError(f"{signal.name} has {signal.values.size} samples, but its spline needs at least 6")
    x = make_interp_spline(signal.time, signal.values, k=5)
    if velocity is None:
        return x, x.derivative()
    if velocity.rate != signal.rate or velocity.values.size != signal.values.size:
        raise ValueError(
            f"{velocity.name} has {velocity.values.size} samples at {velocity.rate:g} Hz, {signal.name} {signal.values.size} "
            f"at {signal.rate:g} Hz: both must come from one record"
        )
    return x, make_interp_spline(signal.time, velocity.values, k=5)
