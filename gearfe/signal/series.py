"""Signals sampled in time, measured or computed: amplitude and power spectra, envelopes."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.fft import fft, fftfreq, ifft, irfft, rfft, rfftfreq
from scipy.signal import get_window, periodogram, welch


@dataclass(frozen=True, slots=True, eq=False)
class Signal:
    """A quantity sampled at a constant rate.

    Attributes
    ----------
    values : ndarray, shape (n,)
        In `unit`.
    rate : float
        Samples per second [Hz].
    unit : str
        For example ``m/s^2``; stated, never guessed.
    name : str
    angle : ndarray, shape (n,), optional
        Angle of the shaft at every sample [rad], rising.
    shaft_frequency : float, optional
        Turns per second [Hz] of a shaft at constant speed; instead of `angle`.
    """

    values: np.ndarray
    rate: float
    unit: str
    name: str = "signal"
    angle: np.ndarray | None = None
    shaft_frequency: float | None = None

    def __post_init__(self):
        object.__setattr__(self, "values", _samples(self.name, self.values))
        for name in ("rate", "shaft_frequency"):
            value = getattr(self, name)
            if value is not None and not (isinstance(value, int | float | np.integer | np.floating) and 0 < value < math.inf):
                raise ValueError(f"{self.name}: {name} = {value!r}, but give a positive number of Hz")
        if self.rate is None:
            raise ValueError(f"{self.name}: rate = None, but give a positive number of Hz")
        if not isinstance(self.unit, str) or not self.unit.strip():
            raise ValueError(f"{self.name}: unit = {self.unit!r}, but a signal needs one, for example 'm/s^2'")
        if self.angle is None:
            return
        if self.shaft_frequency is not None:
            raise ValueError(f"{self.name}: both angle and shaft_frequency; give one")
        angle = _samples(f"{self.name}: angle", self.angle)
        if angle.shape != self.values.shape:
            raise ValueError(f"{self.name}: {angle.size} angles for {self.values.size} samples")
        falls = np.flatnonzero(~(np.diff(angle) > 0))
        if falls.size:
            i = falls[0]
            raise ValueError(
                f"{self.name}: the angle must rise, but sample {i + 1} has {angle[i + 1]:g} rad after {angle[i]:g}; "
                "an encoder that starts anew every turn needs numpy.unwrap"
            )
        object.__setattr__(self, "angle", angle)

    @property
    def time(self):
        """Time of every sample [s], from 0."""
        return np.arange(self.values.size) / self.rate

    @property
    def duration(self):
        """Samples over rate [s]."""
        return self.values.size / self.rate

    @property
    def shaft_angle(self):
        """Angle of the shaft at every sample [rad]."""
        if self.angle is not None:
            return self.angle
        if self.shaft_frequency is None:
            raise ValueError(f"{self.name} has no shaft: give angle (rad, for every sample) or shaft_frequency (Hz)")
        return 2 * math.pi * self.shaft_frequency * self.time

    def indicators(self, mesh_frequency=None, fault_frequency=None, **options):
        """Condition indicators by name, see `gearfe.signal.indicators.indicators`."""
        from .indicators import indicators

        return indicators(self, mesh_frequency, fault_frequency, **options)


def _samples(name, values):
    values = np.array(values)
    if values.ndim != 1 or values.size < 2 or values.dtype.kind not in "fiu":
        raise ValueError(
            f"{name}: values of shape {values.shape} and type {values.dtype}, but give a row of two or more real numbers"
        )
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        raise ValueError(f"{name}: sample {bad[0]} is {values[bad[0]]}; cut or mend the {bad.size} samples that are not finite")
    values = values.astype(float)
    values.flags.writeable = False
    return values


@dataclass(frozen=True, slots=True, eq=False)
class Spectrum:
    """Values over frequency, or over shaft order.

    Attributes
    ----------
    frequency : ndarray, shape (m,)
        From 0 [Hz], or shaft orders (per turn), as `axis` says.
    values : ndarray, shape (m,)
        In `unit`.
    unit : str
    resolution : float
        Distance of two bins.
    bandwidth : float
        Equivalent noise bandwidth of a bin, 1.5 times `resolution` with a Hann window.
    name, axis : str
        `axis` is ``Hz`` or ``order``.
    """

    frequency: np.ndarray
    values: np.ndarray
    unit: str
    resolution: float
    bandwidth: float
    name: str = "spectrum"
    axis: str = "Hz"

    def within(self, low, high):
        """Frequencies and values of the bins from `low` to `high`, both included."""
        slack = 1e-6 * self.resolution
        rows = (self.frequency >= low - slack) & (self.frequency <= high + slack)
        if not rows.any():
            raise ValueError(
                f"{self.name} has no bin from {low:g} to {high:g} {self.axis}: it reaches from {self.frequency[0]:g} to "
                f"{self.frequency[-1]:g} in steps of {self.resolution:g}; sample faster or longer"
            )
        return self.frequency[rows], self.values[rows]


def spectrum(signal, *, window="hann"):
    """One-sided amplitude spectrum: a sine of amplitude A on a bin gives A there.

    The mean is taken out first and stands at 0 Hz. With ``hann`` a line between two bins is up to 15 % too low (scalloping),
    with ``flattop`` 0.1 %, with ``boxcar`` 36 %; ``boxcar`` keeps the energy,
    ``mean(x**2) = X[0]**2 + sum(X[1:]**2) / 2`` for an odd number of samples.

    Parameters
    ----------
    signal : Signal
    window : str or tuple
        Of `scipy.signal.get_window`.

    Returns
    -------
    Spectrum
        In the unit of the signal; resolution ``rate / n`` [Hz].

    References
    ----------
    G. Heinzel, A. Ruediger, R. Schilling, Spectrum and spectral density estimation by the DFT, AEI (2002).

    Examples
    --------
    >>> t = np.arange(1000) / 1000
    >>> found = spectrum(Signal(2 + 3 * np.sin(2 * np.pi * 50 * t), 1000.0, "N"))
    >>> found.values[[0, 50]].round(6).tolist(), found.resolution, found.bandwidth
    ([2.0, 3.0], 1.0, 1.5)
    """
    return amplitudes(signal.values, signal.rate, window, signal.unit, signal.name, "Hz")


def amplitudes(values, rate, window, unit, name, axis):
    """`Spectrum` of equally spaced values, `rate` of them per second or per turn."""
    n, mean = values.size, values.mean()
    frequency, power = periodogram(values - mean, rate, window=window, detrend=False, scaling="spectrum")
    amplitude = np.sqrt(2 * power)
    if n % 2 == 0:
        amplitude[-1] = math.sqrt(power[-1])  # Nyquist's bin has no twin at negative frequencies
    amplitude[0] = abs(mean)
    return Spectrum(frequency, amplitude, unit, rate / n, rate / n * _noise_bins(window, n), name, axis)


def _noise_bins(window, n):
    w = get_window(window, n)
    return round(float(n * (w @ w) / w.sum() ** 2), 9)


def power_spectral_density(signal, *, resolution=None, window="hann"):
    """One-sided power spectral density by Welch's mean over half-overlapping segments; it integrates to the variance.

    Parameters
    ----------
    signal : Signal
    resolution : float, optional
        Distance of two bins [Hz]; a segment lasts ``1 / resolution``. Default: a sixteenth of the record in one segment.
    window : str or tuple

    Returns
    -------
    Spectrum
        Unit ``(unit)^2/Hz``.

    References
    ----------
    P. D. Welch, IEEE Trans. Audio Electroacoust. 15(2) (1967) 70-73.
    """
    n = signal.values.size
    size = max(n // 16, min(n, 8)) if resolution is None else round(signal.rate / resolution) if resolution > 0 else 0
    if not 2 <= size <= n:
        raise ValueError(
            f"resolution = {resolution} Hz, but a record of {signal.duration:g} s at {signal.rate:g} Hz resolves "
            f"{1 / signal.duration:g} to {signal.rate / 2:g} Hz"
        )
    frequency, power = welch(signal.values, signal.rate, window=window, nperseg=size, detrend="constant")
    step = signal.rate / size
    return Spectrum(frequency, power, f"({signal.unit})^2/Hz", step, step * _noise_bins(window, size), signal.name)


def analytic(signal, band=None):
    """Analytic signal of the oscillation (without the mean), of `band` = (low, high) [Hz] only if given; shape (n,), complex.

    The band is cut between bins of the discrete Fourier transform, as `scipy.signal.envelope` does: exact for a record that
    closes; any other rings at its ends, for about ``1 / (high - low)``.
    """
    low, high = (0.0, signal.rate / 2) if band is None else band
    if not 0 <= low < high <= signal.rate / 2 * (1 + 1e-12):
        raise ValueError(f"band = {band} Hz, but {signal.name} has 0 to {signal.rate / 2:g} Hz: give low < high inside")
    n = signal.values.size
    frequency = fftfreq(n, 1 / signal.rate)
    frequency[frequency < -signal.rate / 2 * (1 - 1e-12)] *= -1  # Nyquist's bin of an even n
    twice = np.where((frequency > 0) & (frequency >= low) & (frequency <= high), 2.0, 0.0)
    if n % 2 == 0:
        twice[n // 2] /= 2
    return ifft(twice * fft(signal.values))


def envelope(signal, band=None):
    """Envelope by Hilbert's transform: modulus of the analytic signal, of `band` = (low, high) [Hz] only if given."""
    return Signal(
        np.abs(analytic(signal, band)),
        signal.rate,
        signal.unit,
        f"envelope of {signal.name}",
        signal.angle,
        signal.shaft_frequency,
    )


def squared_envelope_spectrum(signal, band=None, *, window="hann"):
    """Amplitude spectrum of the squared envelope, best of the band the kurtogram finds; unit ``(unit)^2``.

    ``(1 + m cos(2 pi f t))`` times a carrier of amplitude A gives ``2 m A**2`` at f and ``m**2 A**2 / 2`` at 2 f.

    References
    ----------
    R. B. Randall, J. Antoni, Mech. Syst. Signal Process. 25(2) (2011) 485-520.
    """
    squared = np.abs(analytic(signal, band)) ** 2
    return amplitudes(squared, signal.rate, window, f"({signal.unit})^2", f"squared envelope of {signal.name}", "Hz")


def integrate(signal, times, above, unit):
    """Integral over time, of the part above a frequency: displacement from acceleration, as S4 measures it.

    Divides the discrete Fourier transform by ``(2 pi i f)**times``; a record that does not close drifts at its ends.

    Parameters
    ----------
    signal : Signal
    times : int
        1: velocity from acceleration, 2: displacement.
    above : float
        What lies below [Hz] is taken out, with the mean: noise there would grow without bound.
    unit : str
        Of the result; for ``m/s^2`` integrated twice ``m``.

    Returns
    -------
    Signal
    """
    if times < 1 or not 0 < above < signal.rate / 2:
        raise ValueError(f"times = {times}, above = {above} Hz: give times >= 1 and above between 0 and {signal.rate / 2:g} Hz")
    frequency = rfftfreq(signal.values.size, 1 / signal.rate)
    weight = np.zeros(frequency.size, dtype=complex)
    kept = frequency >= above
    weight[kept] = (2j * math.pi * frequency[kept]) ** -times
    values = irfft(weight * rfft(signal.values), signal.values.size)
    return Signal(values, signal.rate, unit, f"integral of {signal.name}", signal.angle, signal.shaft_frequency)
