"""Spectrogram (spectrum over time) and cepstrum (families of sidebands, and echoes)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.fft import irfft, rfft
from scipy.signal import ShortTimeFFT

from ..core.checks import whole
from ..geometry.aliases import Floats
from .given import oscillation, window_values
from .series import Signal
from .spectrum import Spectrum

FLOOR = 1e-12  # Smaller amplitudes, relative to the largest, count as zero in logarithms.


@dataclass(frozen=True, slots=True, eq=False)
class Spectrogram:
    """Amplitudes over frequency and time.

    Attributes
    ----------
    frequency : ndarray, shape (m,)
        [Hz].
    time : ndarray, shape (k,)
        Middle of each frame [s].
    values : ndarray, shape (m, k)
        Amplitudes: a lasting sine of amplitude A on a bin gives A, in `unit`.
    unit, name : str
    """

    frequency: Floats
    time: Floats
    values: Floats
    unit: str
    name: str = "spectrogram"


def spectrogram(signal: Signal, size: int | None = None, *, window: str | tuple[Any, ...] = "hann") -> Spectrogram:
    """Compute the amplitude spectra of overlapping frames (short-time Fourier transform, 75 % overlap).

    Parameters
    ----------
    signal : Signal
        Its mean is taken out.
    size : int, optional
        Samples in a frame: bins are ``rate / size`` apart, and what is shorter than a frame is smeared. Default: a power of two
        near the square root of 8 times the number of samples, which resolves both alike.
    window : str or tuple
        A window of `scipy.signal.get_window`.

    Returns
    -------
    Spectrogram
        Of whole frames only.

    Raises
    ------
    ValueError
        If `size` is no whole number from 8 to half of the samples, or scipy has no such window.
    """
    n = signal.values.size
    size = 2 ** round(np.log2(8 * n) / 2) if size is None else whole("size", size, 1)
    if not 8 <= size <= n // 2:
        raise ValueError(f"size = {size} samples, but {signal.name} has {n}: give 8 to {n // 2}")
    transform = ShortTimeFFT(window_values(window, size), size // 4, signal.rate, fft_mode="onesided2X", scale_to="magnitude")
    inside = {"p0": transform.lower_border_end[1], "p1": transform.upper_border_begin(n)[1]}
    values = np.abs(transform.stft(signal.values - signal.values.mean(), **inside))
    return Spectrogram(transform.f, transform.t(n, **inside), values, signal.unit, f"spectrogram of {signal.name}")


def cepstrum(signal: Signal) -> Spectrum:
    """Compute the real cepstrum: the inverse Fourier transform of the logarithm of the amplitudes.

    ::

        c(t) = IFFT(log|FFT(x)|)

    A family of sidebands at distances f has a peak at the quefrency ``1 / f`` and smaller ones at its multiples. So has an echo
    after the time ``1 / f``. An echo of part a adds ``a / 2`` there, ``-a**2 / 4`` at twice that. Mesh lines become peaks at
    tooth periods, modulations at shaft periods.

    Parameters
    ----------
    signal : Signal
        Signal, whose mean is removed. Amplitudes below 1e-12 of the largest are raised to that.

    Returns
    -------
    Spectrum
        Cepstrum over quefrency [s], from 0 to half the duration; without unit ("1"), like a logarithm.

    References
    ----------
    B. P. Bogert, M. J. R. Healy, J. W. Tukey, Proc. Symp. Time Series Analysis (1963) 209-243; R. B. Randall, Mech. Syst. Signal
    Process. 97 (2017) 3-19.
    """
    x = oscillation(signal.values, f"{signal.name} is constant: it has no cepstrum")
    amplitude = np.abs(rfft(x))
    values = irfft(np.log(np.maximum(amplitude, FLOOR * amplitude.max())), x.size)[: x.size // 2 + 1]
    step = 1 / signal.rate
    return Spectrum(np.arange(values.size) * step, values, "1", step, step, f"cepstrum of {signal.name}", "s")
