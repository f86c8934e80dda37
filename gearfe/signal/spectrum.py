"""`Spectrum`: values over frequency or shaft order, and the amplitude spectrum of samples."""

from dataclasses import dataclass

import numpy as np

from ..geometry.aliases import Floats
from .given import window_values


@dataclass(frozen=True, slots=True, eq=False)
class Spectrum:
    """Values over frequency, or over shaft order.

    Attributes
    ----------
    frequency : ndarray, shape (m,)
        Frequencies from 0 on [Hz], or shaft orders (per revolution), or quefrencies [s], as stated by `axis`.
    values : ndarray, shape (m,)
        Values at these frequencies, in `unit`.
    unit : str
    resolution : float
        Distance of two bins.
    bandwidth : float
        Equivalent noise bandwidth of a bin, 1.5 times `resolution` with a Hann window.
    name, axis : str
        `axis` is ``Hz``, ``order``, or ``s`` for a cepstrum.
    """

    frequency: Floats
    values: Floats
    unit: str
    resolution: float
    bandwidth: float
    name: str = "spectrum"
    axis: str = "Hz"

    def within(self, low: float, high: float) -> tuple[Floats, Floats]:
        """Return frequencies and values of the bins from `low` to `high`, both included."""
        slack = 1e-6 * self.resolution
        rows = (self.frequency >= low - slack) & (self.frequency <= high + slack)
        if not rows.any():
            raise ValueError(
                f"{self.name} has no bin from {low:g} to {high:g} {self.axis}: it reaches from {self.frequency[0]:g} to "
                f"{self.frequency[-1]:g} in steps of {self.resolution:g}; sample faster or longer"
            )
        return self.frequency[rows], self.values[rows]


def amplitudes(values, rate, window, unit, name, axis):
    """Return the `Spectrum` of equally spaced values, `rate` of them per second or per revolution."""
    n, mean = values.size, values.mean()
    w = window_values(window, n)
    amplitude = 2 / abs(w.sum()) * np.abs(np.fft.rfft((values - mean) * w))
    if n % 2 == 0:
        amplitude[-1] /= 2  # The Nyquist bin has no counterpart at negative frequencies.
    amplitude[0] = abs(mean)
    return Spectrum(np.fft.rfftfreq(n, 1 / rate), amplitude, unit, rate / n, rate / n * noise_bins(w), name, axis)


def noise_bins(w):
    """Return the equivalent noise bandwidth of a window, in bins."""
    return round(float(w.size * (w @ w) / w.sum() ** 2), 9)
