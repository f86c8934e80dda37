"""Amplitude spectrum, power spectral density, squared envelope spectrum, analytic signal and envelope."""

from dataclasses import replace
from typing import Any

import numpy as np
import scipy

from ..core.checks import is_number
from .given import band_of, window_values
from .series import Signal
from .spectrum import Spectrum, amplitudes, noise_bins


def spectrum(signal: Signal, *, window: str | tuple[Any, ...] = "hann") -> Spectrum:
    """Compute the one-sided amplitude spectrum. A sine of amplitude A on a bin has the value A there.

    The mean is subtracted first and is the value at 0 Hz. With ``hann`` a line between two bins is up to 15 % too low
    (scalloping), with ``flattop`` 0.1 %, with ``boxcar`` 36 %; ``boxcar`` keeps the energy, ``mean(x**2) = X[0]**2 +
    sum(X[1:]**2) / 2`` for an odd number of samples.

    Parameters
    ----------
    signal : Signal
    window : str or tuple
        A window of `scipy.signal.get_window`.

    Returns
    -------
    Spectrum
        In the unit of the signal; resolution ``rate / n`` [Hz].

    Raises
    ------
    ValueError
        If scipy has no such window.

    References
    ----------
    G. Heinzel, A. Ruediger, R. Schilling, Spectrum and spectral density estimation by the DFT, AEI (2002).

    Examples
    --------
    >>> from gearfe.signal.series import Signal
    >>> t = np.arange(1000) / 1000
    >>> sine = spectrum(Signal(2 + 3 * np.sin(2 * np.pi * 50 * t), 1000.0, "N"))
    >>> sine.values[[0, 50]].round(6).tolist(), sine.resolution, sine.bandwidth
    ([2.0, 3.0], 1.0, 1.5)
    """
    return amplitudes(signal.values, signal.rate, window, signal.unit, signal.name, "Hz")


def power_spectral_density(
    signal: Signal, *, resolution: float | None = None, window: str | tuple[Any, ...] = "hann"
) -> Spectrum:
    """Compute the one-sided power spectral density (PSD) by Welch's mean over half-overlapping segments.

    Its unit is ``(unit)^2/Hz``.

    Parameters
    ----------
    signal : Signal
    resolution : float, optional
        Distance of two bins [Hz]; a segment lasts ``1 / resolution``. Default: a sixteenth of the record in one segment.
    window : str or tuple
        A window of `scipy.signal.get_window`.

    Returns
    -------
    Spectrum
        Over frequency from 0 to half of the rate [Hz].

    Raises
    ------
    ValueError
        If `resolution` is not positive, finer than ``1 / duration``, or so coarse that a segment has fewer than 2 samples; if
        scipy has no such window.

    References
    ----------
    P. D. Welch, IEEE Trans. Audio Electroacoust. 15(2) (1967) 70-73.
    """
    n = signal.values.size
    size = (
        max(n // 16, min(n, 8))
        if resolution is None
        else round(signal.rate / resolution)
        if is_number(resolution) and resolution > signal.rate / (2 * n)
        else 0
    )
    if not 2 <= size <= n:
        raise ValueError(
            f"resolution = {resolution} Hz, but a record of {signal.duration:g} s at {signal.rate:g} Hz resolves "
            f"{1 / signal.duration:g} to {signal.rate / 2:g} Hz"
        )
    w = window_values(window, size)
    frequency, power = scipy.signal.welch(signal.values, signal.rate, window=w, nperseg=size, detrend="constant")
    step = signal.rate / size
    return Spectrum(frequency, power, f"({signal.unit})^2/Hz", step, step * noise_bins(w), signal.name)


def analytic(signal, band=None):
    """Compute the analytic signal (complex, shape (n,)) without mean, optionally restricted to `band` = (low, high) [Hz].

    The band is cut between bins of the discrete Fourier transform, as in `scipy.signal.envelope`. This is exact for a periodic
    record. Other records have transients at both ends, which last about ``1 / (high - low)``.
    """
    low, high = band_of(band, signal.rate, signal.name)
    n = signal.values.size
    frequency = np.fft.fftfreq(n, 1 / signal.rate)
    frequency[frequency < -signal.rate / 2 * (1 - 1e-12)] *= -1  # The Nyquist bin of an even n has a negative frequency.
    twice = np.where((frequency > 0) & (frequency >= low) & (frequency <= high), 2.0, 0.0)
    if n % 2 == 0:
        twice[n // 2] /= 2
    return np.fft.ifft(twice * np.fft.fft(signal.values))


def envelope(signal: Signal, band: tuple[float, float] | None = None) -> Signal:
    """Compute the envelope (modulus of the analytic signal), optionally restricted to `band` = (low, high) [Hz].

    Parameters
    ----------
    signal : Signal
        Its mean is taken out.
    band : (float, float), optional
        Ends of the band [Hz]; default: from 0 to half of the rate.

    Returns
    -------
    Signal
        In the unit of `signal`, at its rate and of its length, with its shaft. A band that holds no bin gives 0.

    Raises
    ------
    ValueError
        If `band` is not two numbers with ``0 <= low < high <= rate / 2``.
    """
    return replace(signal, values=np.abs(analytic(signal, band)), name=f"envelope of {signal.name}")


def squared_envelope_spectrum(signal: Signal, band: tuple[float, float] | None = None) -> Spectrum:
    """Compute the amplitude spectrum of the squared envelope, unit ``(unit)^2``. A suitable band is that of the kurtogram.

    ``(1 + m cos(2 pi f t))`` times a carrier of amplitude A gives ``2 m A**2`` at f and ``m**2 A**2 / 2`` at 2 f.

    Parameters
    ----------
    signal : Signal
        Its mean is taken out.
    band : (float, float), optional
        Ends of the band [Hz]; default: from 0 to half of the rate.

    Returns
    -------
    Spectrum
        By Hann's window, over frequency from 0 to half of the rate; resolution ``rate / n`` [Hz].

    Raises
    ------
    ValueError
        If `band` is not two numbers with ``0 <= low < high <= rate / 2``.

    References
    ----------
    R. B. Randall, J. Antoni, Mech. Syst. Signal Process. 25(2) (2011) 485-520.
    """
    squared = np.abs(analytic(signal, band)) ** 2
    return amplitudes(squared, signal.rate, "hann", f"({signal.unit})^2", f"squared envelope of {signal.name}", "Hz")
