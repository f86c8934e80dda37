"""Transfer path from a force to an accelerometer: second-order modes, or a measured frequency response function."""

from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ...core.checks import numbers
from ...geometry.checks import shown
from ...signal.series import Signal


def through_modes(force: Signal, modes: Sequence[tuple[float, float, float]]) -> Signal:
    """Return the acceleration that a force excites in a set of second-order modes.

    ::

        a(t) = sum over modes of x'',   x'' + 2 zeta (2 pi f) x' + (2 pi f)**2 x = F(t) / mass

    The motion starts from rest under the first force. It is exact for forces that are linear between samples.

    Parameters
    ----------
    force : Signal
        Such as ``response.signal("spring bearing out1 x")`` [N].
    modes : sequence of (float, float, float)
        Natural frequency [Hz], damping ratio and modal mass [kg].

    Returns
    -------
    Signal
        [m/s^2]

    Raises
    ------
    ValueError
        If a frequency is not below half of the rate, a damping ratio is not from 0 to below 1, or a mass is not positive.
    """
    values = np.sum([_answer(force.values, force.rate, *mode) for mode in modes], axis=0)
    return Signal(values, force.rate, "m/s^2", force.name)


def through_frf(force: Signal, frequency: ArrayLike, response: ArrayLike, unit: str = "m/s^2") -> Signal:
    """Return the response to a force by a measured frequency response function, for a periodic record.

    Parameters
    ----------
    force : Signal
        Its mean is left out.
    frequency : array_like, shape (n,)
        Rising [Hz].
    response : array_like, shape (n,)
        Complex, `unit` per N; interpolated in real and imaginary part. What lies outside of the measured band is left out.
    unit : str
        Unit of the result, default m/s^2.

    Returns
    -------
    Signal
        In `unit`, without mean.

    Raises
    ------
    ValueError
        If the frequencies do not rise, or there are not as many values.
    """
    at = numbers("frequency", frequency, " [Hz]")
    try:
        values = np.asarray(response).astype(complex)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"response = {shown(response)}, but give numbers, real or complex") from error
    if at.ndim != 1 or at.shape != values.shape or at.size < 2 or not (np.diff(at) > 0).all() or at[0] < 0:
        raise ValueError(f"frequency response of shapes {at.shape} and {values.shape}: give as many values as rising frequencies")
    lines = np.fft.rfftfreq(force.values.size, 1 / force.rate)
    path = interpolated(lines, at, values)
    spectrum = np.fft.rfft(force.values - force.values.mean())
    return Signal(np.fft.irfft(path * spectrum, force.values.size), force.rate, unit, force.name)


def interpolated(frequency, at, values):
    """Response at `frequency`, interpolated linearly in both parts from `values` at rising frequencies `at`, 0 outside."""
    return np.interp(frequency, at, values.real, 0.0, 0.0) + 1j * np.interp(frequency, at, values.imag, 0.0, 0.0)


def gain_of_modes(frequency, modes):
    """Complex gain of the `modes` of `through_modes` at frequencies [Hz], 1 without modes."""
    ratios = ((frequency / f, zeta, mass) for f, zeta, mass in modes)
    gains = [-(r**2) / (1 - r**2 + 2j * zeta * r) / mass for r, zeta, mass in ratios]
    return np.sum(gains, axis=0) if gains else np.ones(frequency.size)


def _answer(force, rate, frequency, zeta, mass):
    """Return the acceleration of an oscillator under a force, starting from rest under the first value."""
    if not (0 < frequency < rate / 2 and 0 <= zeta < 1 and mass > 0):
        raise ValueError(
            f"mode ({frequency} Hz, {zeta}, {mass} kg): the frequency must lie between 0 and {rate / 2:g} Hz, half the rate, the "
            "damping ratio from 0 to below 1, and the mass above 0"
        )
    omega = 2 * np.pi * frequency
    inner = np.array([[0.0, 1.0], [-(omega**2), -2 * zeta * omega]])
    discrete = scipy.signal.cont2discrete(
        (inner, np.array([[0.0], [1 / mass]]), inner[1:], np.array([[1 / mass]])), 1 / rate, method="foh"
    )
    above, below = scipy.signal.ss2tf(*discrete[:4])
    return scipy.signal.lfilter(above[0], below, force - force[0])
