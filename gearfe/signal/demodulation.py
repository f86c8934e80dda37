"""Envelope analysis: the band with the most impulsive signal, and the spectrum of its squared envelope."""

from dataclasses import dataclass

import numpy as np

from .given import hertz
from .kurtogram import Kurtogram, fast_kurtogram
from .series import Signal
from .spectra import squared_envelope_spectrum
from .spectral_lines import find_lines
from .spectrum import Spectrum

COUNT = 3  # number of harmonics of the fault frequency that are looked for


@dataclass(frozen=True, slots=True, eq=False)
class Demodulated:
    """Results of the kurtogram and of the squared envelope spectrum of a signal.

    `lines` has by name ``k f_fault`` the frequency [Hz] and amplitude. `background` is the median amplitude of the squared
    envelope's spectrum from half the fault frequency to past the last line [its unit].
    """

    kurtogram: Kurtogram
    spectrum: Spectrum
    lines: dict[str, tuple[float, float]]
    background: float

    def text(self) -> str:
        """Best band and lines, as one paragraph."""
        low, high = self.kurtogram.band
        top = self.kurtogram.kurtosis[self.kurtogram.best]
        over = self.background > 0
        lines = ", ".join(
            f"{name} {f:.2f} Hz {a / self.background:.3g} x" if over else f"{name} {f:.2f} Hz {a:.3g} {self.spectrum.unit}"
            for name, (f, a) in self.lines.items()
        )
        heading = "squared envelope there" + (", over its median" if over else " (zero between the lines)")
        return f"kurtogram: {low:.0f} to {high:.0f} Hz, kurtosis {top:.3g}; {heading}: {lines}"


def demodulate(signal: Signal, fault_frequency: float, *, band: tuple[float, float] | None = None) -> Demodulated:
    """Compute the squared envelope spectrum in the best band of the fast kurtogram, and the fault lines in it.

    Parameters
    ----------
    signal : Signal
    fault_frequency : float
        [Hz]
    band : (float, float), optional
        Band to use instead of the best one [Hz].

    Returns
    -------
    Demodulated
        The kurtogram, down to the level whose bands still pass `COUNT` harmonics of the fault. The spectrum of the squared
        envelope over frequency [Hz], and the lines found in it.

    Raises
    ------
    ValueError
        If ``(COUNT + 1) fault_frequency`` is not between 0 and a quarter of the rate; if the record is constant or has fewer than
        256 samples; if `band` is not ``0 <= low < high <= rate / 2``; if the record is so short that no bin lies near a line.

    References
    ----------
    J. Antoni, Mech. Syst. Signal Process. 21(1) (2007) 108-124; the way article S2 treats its measured signals.
    """
    if not (COUNT + 1) * hertz("fault_frequency", fault_frequency) < signal.rate / 4:
        raise ValueError(
            f"fault_frequency = {fault_frequency} Hz with {COUNT} harmonics, but {signal.name} at {signal.rate:g} Hz shows up to "
            f"{signal.rate / 4:g} Hz in its envelope: give a positive frequency below"
        )
    deepest = int(np.log2(signal.values.size / 128)) if signal.values.size >= 256 else 1
    levels = max(1, min(deepest, int(np.log2(signal.rate / 2 / ((COUNT + 1) * fault_frequency)))))
    kurtogram = fast_kurtogram(signal, levels)
    spectrum = squared_envelope_spectrum(signal, kurtogram.band if band is None else band)
    names = {("" if k == 1 else f"{k} ") + "f_fault": k * fault_frequency for k in range(1, COUNT + 1)}
    _, around = spectrum.within(0.5 * fault_frequency, (COUNT + 0.5) * fault_frequency)
    return Demodulated(kurtogram, spectrum, find_lines(spectrum, names), float(np.median(around)))
