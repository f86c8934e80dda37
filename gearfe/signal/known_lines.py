"""Amplitudes of spectral lines with exactly known frequency, and of the noise around them."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..geometry.aliases import Floats
from .series import Signal

NOISE = (5, 60)  # distances from a line between which the noise is measured [line widths, 1 / duration]


def line_amplitudes(signal: Signal, frequency: Floats, window: Callable[[int], Floats] = np.hanning) -> NDArray[np.complex128]:
    """Complex amplitudes ``(n,)`` of lines of known frequency [Hz] under a window."""
    weight = window(signal.values.size)
    turns = np.exp(-2j * math.pi * np.outer(frequency, signal.time))
    return np.asarray(2 * (turns @ (weight * (signal.values - signal.values.mean()))) / weight.sum())


def noise_amplitudes(record: Signal, frequency: Floats) -> Floats:
    """Return the standard deviation ``(n,)`` of line amplitudes by noise, from the median amplitude near each line."""
    apart = np.arange(*NOISE) / record.duration
    around = np.add.outer(frequency, [*-apart, *apart])
    return np.median(fine_amplitudes(record, around), axis=1) / math.sqrt(2 * math.log(2))


def fine_amplitudes(record: Signal, frequency: Floats) -> Floats:
    """Return amplitudes under a Hann window at the nearest bins of a spectrum with bins a quarter of the line width apart."""
    window, size = np.hanning(record.values.size), 4 * record.values.size
    spectrum = np.abs(np.fft.rfft(window * (record.values - record.values.mean()), size)) * 2 / window.sum()
    return spectrum[np.clip(np.rint(np.abs(frequency) * size / record.rate).astype(int), 0, spectrum.size - 1)]
