"""Blind deconvolution (MED, MCKD) to reveal smeared fault pulses, by the filter that makes a signal most impulsive."""

from dataclasses import replace

import numpy as np
from scipy.linalg import LinAlgError, solve_toeplitz
from scipy.signal import correlate, lfilter

from ..core.checks import whole
from ..geometry.aliases import Floats
from .given import hertz
from .series import Signal

RIDGE = 1e-9  # relative power added to the signal, which keeps the normal equations regular at frequencies without power


def deconvolve(
    signal: Signal, frequency: float | None = None, *, length: int = 100, shifts: int = 1, iterations: int = 30
) -> tuple[Signal, Floats]:
    """Filter a signal so that it is most impulsive: minimum entropy (MED) or correlated kurtosis (MCKD) deconvolution.

    Without a `frequency` the filter is the one whose output y has the largest kurtosis (minimum entropy deconvolution),
    ``sum(y**4) / sum(y**2)**2``, which emphasises any pulses, also a single one. With the frequency of a fault it is the one with
    the largest correlated kurtosis::

        CK = sum_n (y[n] y[n - T] ... y[n - M T])**2 / sum_n (y[n]**2)**(M + 1),   T = rate / frequency, M = shifts

    which emphasises pulses at the interval T. Both filters are found by fixed-point iteration from a difference filter. The best
    iterate is used.

    Parameters
    ----------
    signal : Signal
        Filtered to its rate, without its mesh lines (`gearfe.residual_signal`) if these are strong.
    frequency : float, optional
        Of the fault [Hz]; its period is rounded to whole samples: resample a signal of few samples a period by angle first.
    length : int
        Taps of the filter.
    shifts : int
        Periods M over which pulses are correlated, 1 to 5.
    iterations : int

    Returns
    -------
    deconvolved : Signal
        Without the mean, its power that of the signal; delayed by some samples of the filter.
    filter : ndarray, shape (length,)

    Raises
    ------
    ValueError
        If the record is shorter than the filter and the shifts need, or constant.

    References
    ----------
    - R. A. Wiggins, Geoexploration 16 (1978) 21-35; H. Endo, R. B. Randall, Mech. Syst. Signal Process. 21(2) (2007) 906-919.
    - G. L. McDonald, Q. Zhao, M. J. Zuo, Mech. Syst. Signal Process. 33 (2012) 237-255, eqs. 15-23.
    """
    x, length = signal.values - signal.values.mean(), whole("length", length, 2)
    apart = [0]
    if frequency is not None:
        hertz("frequency", frequency)
        period = round(signal.rate / frequency)
        apart = [m * period for m in range(whole("shifts", shifts, 1) + 1)]
        if period < 2:
            raise ValueError(
                f"frequency = {frequency} Hz, but {signal.name} at {signal.rate:g} Hz has fewer than two samples per period"
            )
    if x.size < 2 * (length + apart[-1]):
        raise ValueError(
            f"{signal.name} has {x.size} samples, but a filter of {length} taps over {apart[-1]} samples needs twice as many: "
            "record longer, or take fewer taps or shifts"
        )
    power = correlate(x, x, method="fft")[x.size - 1 : x.size - 1 + length]
    if not power[0] > 0:
        raise ValueError(f"{signal.name} is constant: it has no pulses")
    power[0] *= 1 + RIDGE
    taps, best, kept = np.zeros(length), -np.inf, np.zeros(length)
    taps[length // 2 - 1 : length // 2 + 1] = 1.0, -1.0
    for _ in range(whole("iterations", iterations, 1)):
        y = lfilter(taps, 1.0, x)
        size, slope = _impulsive(y, apart)
        if not size > best * (1 + 1e-6):
            break
        best, kept = size, taps
        right = correlate(slope, x, method="fft")[x.size - 1 : x.size - 1 + length]
        try:
            taps = solve_toeplitz(power, right)
        except LinAlgError as error:
            raise ValueError(f"{signal.name}: no filter of {length} taps; take fewer taps") from error
        taps = taps / np.linalg.norm(taps)
    y = lfilter(kept, 1.0, x)
    scale = np.std(signal.values) / np.std(y)
    return replace(signal, values=scale * y, name=f"{signal.name}, deconvolved"), scale * kept


def _impulsive(y, apart):
    """Return kurtosis of y, or correlated kurtosis over shifts `apart` [samples], and the gradient up to a factor."""
    if len(apart) == 1:
        return float((y**4).sum() / (y**2).sum() ** 2), y**3
    late = np.array([np.concatenate([np.zeros(m), y[: y.size - m]]) for m in apart])
    product = late.prod(axis=0)
    slope = np.zeros_like(y)
    for i, m in enumerate(apart):
        partial = product * np.delete(late, i, axis=0).prod(axis=0)
        slope += np.concatenate([partial[m:], np.zeros(m)])
    return float((product**2).sum() / (y**2).sum() ** len(apart)), slope
