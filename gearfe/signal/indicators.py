"""Condition indicators of the articles S0 to S4, from the time signal and from sidebands.

All but `rms` are computed without the mean, like the signal of an accelerometer. With the mean force or displacement they would
depend mainly on the load. S0 ... S4 are the articles.
"""

import math

import numpy as np

from ..core.checks import whole
from .given import hertz
from .spectral_lines import find_lines

SOURCES = {
    "rms": "sqrt(mean(x**2)), S4; with the mean",
    "peak": "max|x - mean|, S4 (numerator of its crest factor)",
    "crest factor": "max|x - mean| / sqrt(mean((x - mean)**2)); sine 1.414",
    "crest factor S4": "max|x - mean| / rms as S4 prints it, with the mean in the rms only",
    "kurtosis": "mean((x - mean)**4) / mean((x - mean)**2)**2, S4 (Pearson); Gaussian noise 3, sine 1.5",
    "shape factor": "sqrt(mean(y**2)) / mean|y|, y = x - mean, S0 and S1 (no formula printed); Gaussian noise 1.253, sine 1.111",
    "impulse factor": "max|y| / mean|y|, y = x - mean; sine 1.571",
    "mesh line": "amplitude of f_m, between two bins too (Hann window)",
    "sideband index": "mean amplitude of the first-order sidebands f_m +- f_fault, S4; between two bins too (Hann window)",
    "SC (S0)": "sum(f E) / sum(E) from f_m - f_fault to f_m + f_fault, f frequency, E amplitude squared, S0 [Hz]",
    "SC (S1)": "sum(A f) / sum(f) over the same bins, A amplitude, f distance from the origin, S1 [unit of the signal]",
}
LOBES = 4  # distance between two lines whose Hann window lobes do not overlap [bins]


def of_values(values, name):
    """Compute the indicators of the samples ``(n,)`` of a signal called `name` by the names of `SOURCES` (with formulae).

    The crest factor as printed in S4 contains the mean in the rms value only. It is therefore no measure of shape. S4's
    healthy sun moves from -7.21 to -10.77 um, which makes the factor about 0.2. A fault that changes the mean changes it too.
    """
    y, spread = values - np.mean(values), float(np.std(values))
    if not spread > 1e-12 * np.abs(values).max():
        raise ValueError(f"{name} is constant: it has no indicators")
    rms, peak, modulus = math.sqrt(np.mean(np.square(values))), float(np.abs(y).max()), float(np.abs(y).mean())
    return {
        "rms": rms,
        "peak": peak,
        "crest factor": peak / spread,
        "crest factor S4": peak / rms,
        "kurtosis": float(np.mean((y / spread) ** 4)),
        "shape factor": spread / modulus,
        "impulse factor": peak / modulus,
    }


def sideband_index(found, mesh_frequency, fault_frequency, *, tolerance=None, harmonics=1):
    """Mean amplitude of the first-order sidebands (S4).

    ::

        SI = 1/M sum(|X(k)|), k over n f_m - f_fault and n f_m + f_fault, n = 1 ... harmonics, M = 2 harmonics

    It has the unit of the spectrum. A line between two bins is interpolated (`find_lines` with ``between=True``), so that its
    amplitude does not depend on the record length: with Hann's window within 1 % if lines are 8 bins or more apart. S4 prints
    1.03 to 2.26 without unit and a mesh line of 0.097 um, so these are not amplitudes in um.
    """
    if fault_frequency < LOBES * found.resolution:
        raise ValueError(
            f"fault_frequency = {fault_frequency:g} Hz, but {found.name} has bins of {found.resolution:g} Hz, so that the mesh "
            f"line covers its sidebands; record {LOBES / fault_frequency:.3g} s or longer"
        )
    _below(mesh_frequency, fault_frequency)
    sides = [(n, sign) for n in range(1, whole("harmonics", harmonics, 1, 1000) + 1) for sign in (-1, 0, 1)]
    lines = {(n, sign): n * mesh_frequency + sign * fault_frequency for n, sign in sides}
    placed = find_lines(found, lines, tolerance, between=True)
    amplitudes = [amplitude for (_, sign), (_, amplitude) in placed.items() if sign]
    return float(np.mean(amplitudes))


def sideband_centroid_s0(found, mesh_frequency, fault_frequency):
    """Centroid of the spectrum around the mesh frequency, S0's definition of SC [Hz].

    ::

        SC = sum(f(n) E(n)) / sum(E(n)), f(n) from f_m - f_fault to f_m + f_fault

    f is frequency, E energy, here the square of the amplitude. A mean of frequencies with positive weights lies between the
    smallest and the largest: for S0's machine in 240 ... 320 Hz. Its printed 349.8 and 352.9 are impossible, and 312.7 would
    need 82 % of the energy above f_m. Symmetric sidebands of any size give f_m, so it does not measure severity.
    """
    frequency, amplitude = _around(found, mesh_frequency, fault_frequency)
    energy = amplitude**2
    if not energy.sum() > 0:
        raise ValueError(f"{found.name} is zero around {mesh_frequency:g} Hz: no centroid")
    return float(frequency @ energy / energy.sum())


def sideband_centroid_s1(found, mesh_frequency, fault_frequency):
    """Mean amplitude around the mesh frequency, S1's definition of SC, in the unit of the spectrum.

    ::

        SC = sum(f(n) E(n)) / sum(E(n)), over the same bins

    but f is the amplitude and E the distance of the bin from the origin of the spectrum, here its frequency. It increases with
    the sidebands of faults and equally with those of impact loads. Doubling the duration halves it, because the number of bins
    between the lines doubles. Compare signals of equal length, rate and window. The fault sidebands are at the ends of the sum,
    so that with a Hann window half of their outer bins is excluded. The same holds for S0's form.
    """
    frequency, amplitude = _around(found, mesh_frequency, fault_frequency)
    return float(amplitude @ frequency / frequency.sum())


def _below(mesh_frequency, fault_frequency):
    if not 0 < fault_frequency < mesh_frequency:
        raise ValueError(
            f"fault_frequency = {fault_frequency} Hz, but sidebands need one between 0 and f_m = {mesh_frequency} Hz: "
            "the frequency at which the damaged tooth is in mesh, not the mesh frequency"
        )


def _around(found, mesh_frequency, fault_frequency):
    _below(mesh_frequency, fault_frequency)
    if mesh_frequency + fault_frequency > found.frequency[-1] * (1 + 1e-9):
        raise ValueError(
            f"{found.name} ends at {found.frequency[-1]:g} Hz, below f_m + f_fault = {mesh_frequency + fault_frequency:g} Hz"
        )
    frequency, amplitude = found.within(mesh_frequency - fault_frequency, mesh_frequency + fault_frequency)
    if frequency.size < 9:
        raise ValueError(f"{found.name} has {frequency.size} bins around f_m, {found.resolution:g} Hz apart: record longer")
    return frequency, amplitude


def both_given(mesh_frequency, fault_frequency):
    """Return whether both frequencies [Hz] are given. Raises ValueError if only one is given, or one is not positive."""
    if (mesh_frequency is None) != (fault_frequency is None):
        raise ValueError(f"mesh_frequency = {mesh_frequency}, fault_frequency = {fault_frequency}: give both, or neither")
    for name, value in {"mesh_frequency": mesh_frequency, "fault_frequency": fault_frequency}.items():
        if value is not None:
            hertz(name, value)
    return mesh_frequency is not None


def of_lines(found, mesh_frequency, fault_frequency, *, tolerance=None, harmonics=1):
    """Compute the indicators of the lines of a `Spectrum` of amplitudes, see `find_lines` and `sideband_index`."""
    at = mesh_frequency, fault_frequency
    return {
        "mesh line": find_lines(found, {"f_m": mesh_frequency}, tolerance, between=True)["f_m"][1],
        "sideband index": sideband_index(found, *at, tolerance=tolerance, harmonics=harmonics),
        "SC (S0)": sideband_centroid_s0(found, *at),
        "SC (S1)": sideband_centroid_s1(found, *at),
    }
