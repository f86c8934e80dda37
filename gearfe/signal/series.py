"""`Signal`: a measured or computed quantity sampled in time, with methods for decimation and integration."""

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np
import scipy

from ..core.checks import whole
from ..geometry.aliases import Floats
from .given import hertz, samples
from .indicators import both_given, of_lines, of_values
from .spectrum import amplitudes


@dataclass(frozen=True, slots=True, eq=False)
class Signal:
    """A quantity sampled at a constant rate.

    Attributes
    ----------
    values : ndarray, shape (n,)
        Samples, in `unit`.
    rate : float
        Samples per second [Hz].
    unit : str
        Unit, for example ``m/s^2``.
    name : str
    angle : ndarray, shape (n,), optional
        Angle of the shaft at every sample [rad], rising.
    shaft_frequency : float, optional
        Shaft frequency [Hz] at constant speed, instead of `angle`.
    """

    values: Floats
    rate: float
    unit: str
    name: str = "signal"
    angle: Floats | None = None
    shaft_frequency: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise ValueError(f"name = {self.name!r}, but give a text")
        values = samples(self.name, self.values)
        values.flags.writeable = False
        object.__setattr__(self, "values", values)
        for name in ("rate", "shaft_frequency"):
            if name == "rate" or self.shaft_frequency is not None:
                object.__setattr__(self, name, hertz(f"{self.name}: {name}", getattr(self, name)))
        if not isinstance(self.unit, str) or not self.unit.strip():
            raise ValueError(f"{self.name}: unit = {self.unit!r}, but a signal needs one, for example 'm/s^2'")
        if self.angle is None:
            return
        if self.shaft_frequency is not None:
            raise ValueError(f"{self.name}: both angle and shaft_frequency; give one")
        angle = samples(f"{self.name}: angle", self.angle)
        angle.flags.writeable = False
        if angle.shape != self.values.shape:
            raise ValueError(f"{self.name}: {angle.size} angles for {self.values.size} samples")
        falls = np.flatnonzero(~(np.diff(angle) > 0))
        if falls.size:
            i = falls[0]
            raise ValueError(
                f"{self.name}: the angle must rise, but sample {i + 1} has {angle[i + 1]:g} rad after {angle[i]:g}; "
                "an encoder that restarts every revolution needs numpy.unwrap"
            )
        object.__setattr__(self, "angle", angle)

    @property
    def time(self) -> Floats:
        """Time of every sample [s], from 0."""
        return np.arange(self.values.size) / self.rate

    @property
    def duration(self) -> float:
        """Samples over rate [s]."""
        return self.values.size / self.rate

    @property
    def shaft_angle(self) -> Floats:
        """Angle of the shaft at every sample [rad]."""
        if self.angle is not None:
            return self.angle
        if self.shaft_frequency is None:
            raise ValueError(f"{self.name} has no shaft: give angle (rad, for every sample) or shaft_frequency (Hz)")
        return 2 * math.pi * self.shaft_frequency * self.time

    def part(self, start: int, stop: int) -> "Signal":
        """Return the samples from number `start` to before `stop`, with their angles."""
        return self[start:stop]

    def __getitem__(self, inside: slice) -> "Signal":
        """Return a slice of samples, such as ``signal[1000:5000]``, with its angles.

        Raises TypeError for anything else.
        """
        if not isinstance(inside, slice) or inside.step not in (None, 1):
            raise TypeError(f"signal[{inside}]: give a slice of samples without a step, signal[start:stop]")
        return replace(self, values=self.values[inside], angle=None if self.angle is None else self.angle[inside])

    def between(self, start: float = 0.0, stop: float = math.inf) -> "Signal":
        """Return the samples from `start` to before `stop` [s]. Raises ValueError if the record has no samples there."""
        first, last = (math.ceil(min(max(at, 0.0), self.duration) * self.rate - 1e-6) for at in (start, stop))
        if not 0 <= start < stop or last - first < 2:
            raise ValueError(f"start = {start:g} s, stop = {stop:g} s, but {self.name} has 0 to {self.duration:g} s")
        return self[first:last]

    def indicators(
        self,
        mesh_frequency: float | None = None,
        fault_frequency: float | None = None,
        *,
        window: str | tuple[Any, ...] = "hann",
        tolerance: float | None = None,
        harmonics: int = 1,
    ) -> dict[str, float]:
        """Compute condition indicators by the names of `gearfe.signal.indicators.SOURCES`, which states their formulae.

        Parameters
        ----------
        mesh_frequency, fault_frequency : float, optional
            [Hz]; without them only the indicators of the time signal, which should be without its transient.
        window, tolerance, harmonics
            See `gearfe.spectrum`, `gearfe.find_lines`, `gearfe.signal.indicators.sideband_index`.

        Returns
        -------
        dict of str to float
        """
        out = of_values(self.values, self.name)
        if not both_given(mesh_frequency, fault_frequency):
            return out
        lines = amplitudes(self.values, self.rate, window, self.unit, self.name, "Hz")
        return out | of_lines(lines, mesh_frequency, fault_frequency, tolerance=tolerance, harmonics=harmonics)


def decimate(signal: Signal, rate: float) -> Signal:
    """Return the signal at a lower rate, after an anti-aliasing filter.

    A linear-phase filter without delay (`scipy.signal.resample_poly`, Kaiser's window): half of the amplitude remains at half the
    new rate, and the attenuation is 53 dB from 1.16 times that frequency on. Near the ends, over ten new samples, the record is
    extrapolated by lines.

    Parameters
    ----------
    signal : Signal
    rate : float
        [Hz]; a ratio of small whole numbers to that of the signal.

    Raises
    ------
    ValueError
        If the rate is higher than that of the signal, or no such ratio.
    """
    hertz("rate", rate)
    ratio = Fraction(rate / signal.rate).limit_denominator(1000) if 0 < rate <= signal.rate else Fraction(0)
    if not ratio or abs(ratio * signal.rate / rate - 1) > 1e-9:
        raise ValueError(
            f"rate = {rate} Hz, but {signal.name} has {signal.rate:g} Hz: give a smaller rate that is p / q of it with whole p "
            f"and q, for example {signal.rate / 2:g} Hz"
        )
    values = scipy.signal.resample_poly(signal.values, ratio.numerator, ratio.denominator, window=("kaiser", 5.0), padtype="line")
    angle = None if signal.angle is None else np.interp(np.arange(values.size) / rate, signal.time, signal.angle)
    return Signal(values, rate, signal.unit, signal.name, angle, signal.shaft_frequency)


def integrate(signal: Signal, times: int, above: float, unit: str) -> Signal:
    """Integral over time of the content above a frequency, such as displacement from acceleration (article S4).

    The discrete Fourier transform is divided by ``(2 pi i f)**times``. A record that is not periodic has errors at its ends.

    Parameters
    ----------
    signal : Signal
    times : int
        1: velocity from acceleration, 2: displacement.
    above : float
        What lies below [Hz] is taken out, with the mean: noise there would grow without bound.
    unit : str
        Unit of the result, for example ``m`` for ``m/s^2`` integrated twice.

    Returns
    -------
    Signal
        In `unit`, at the rate and of the length of `signal`, with its shaft.

    Raises
    ------
    ValueError
        If `times` is no whole number from 1 on, `above` is not between 0 and half of the rate, or `unit` is an empty text.
    """
    whole("times", times, 1)
    hertz("above", above)
    if not 0 < above < signal.rate / 2:
        raise ValueError(f"above = {above} Hz, but give a frequency between 0 and {signal.rate / 2:g} Hz")
    frequency = np.fft.rfftfreq(signal.values.size, 1 / signal.rate)
    weight = np.zeros(frequency.size, dtype=complex)
    kept = frequency >= above
    weight[kept] = (2j * math.pi * frequency[kept]) ** -times
    values = np.fft.irfft(weight * np.fft.rfft(signal.values), signal.values.size)
    return Signal(values, signal.rate, unit, f"integral of {signal.name}", signal.angle, signal.shaft_frequency)
