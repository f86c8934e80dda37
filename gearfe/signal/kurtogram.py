"""Fast kurtogram (J. Antoni): the frequency band with the most impulsive signal."""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from ..core.checks import one_of, whole
from ..geometry.aliases import Floats
from .given import oscillation
from .series import Signal

HALF_TAPS, THIRD_TAPS = 33, 49  # filter taps for halves and thirds of a band; both lose 16 samples at their ends
ANALYTIC_TAPS = 1025  # limit of filter taps (also an eighth of the record), because this number of samples is lost at the ends
WIDER = 1.3  # width of a filter at half amplitude relative to its band; the amplitude at the band edge is 0.96
EMPTY = 1e-14  # A band below this part of the signal power contains only rounding errors.
FEWEST = 128  # least number of samples of a band at the deepest level, including the ends that are omitted


@dataclass(frozen=True, slots=True, eq=False)
class Kurtogram:
    """Kurtosis of the bands of a filter tree, with a row for each band.

    Attributes
    ----------
    level : ndarray, shape (m,)
        0; 1, log2(3) = 1.58; 2, 2.58; ...: a band of level l is ``rate / 2**(l + 1)`` wide.
    centre, bandwidth : ndarray, shape (m,)
        [Hz].
    kurtosis : ndarray, shape (m,)
        Kurtosis minus that of Gaussian noise.
    """

    level: Floats
    centre: Floats
    bandwidth: Floats
    kurtosis: Floats

    @property
    def best(self) -> int:
        """Index of the row with the largest kurtosis."""
        return int(np.argmax(self.kurtosis))

    @property
    def band(self) -> tuple[float, float]:
        """Lower and upper edge [Hz] of the best band, for `gearfe.envelope` and its squared spectrum."""
        centre, width = float(self.centre[self.best]), float(self.bandwidth[self.best])
        return centre - width / 2, centre + width / 2


def fast_kurtogram(signal: Signal, levels: int | None = None, *, filters: str = "sharp") -> Kurtogram:
    """Compute the kurtosis of the complex envelope in the bands of a 1/3-binary tree of quasi-analytic filters.

    Level 0 is the whole signal. Each of the ``2**k`` bands of level k, ``rate / 2**(k + 1)`` wide, is divided into halves
    (level k + 1) and into thirds (level ``k + log2(3)``). Thirds are not divided further and exist only below `levels`. The
    kurtosis of a band c is ``<|c|**4> / <|c|**2>**2 - 2`` (``- 3`` for the real level 0), and 0 for a band 140 dB below the
    signal, which contains rounding errors only. Other levels use positive frequencies only, filtered with 1025 taps (half at 0
    Hz, complete from ``rate / 600``). Antoni's program prints levels truncated after one decimal: its "5.5" is 5.58.

    Filters are Hamming windows of 33 and 49 taps that pass 0.96 at the edges of a band, 0.5 at 1.3 and 0.04 at 1.6 times its half
    width (Antoni: 17 and 25 taps, 0.96, 0.5 at 1.6). A line at an edge is therefore in both bands. Filtered samples near the ends
    are discarded.

    ``filters="antoni"`` repeats the published program of Antoni: his filters for the real signal itself (so that bands at 0 Hz
    and Nyquist's frequency contain both signs of frequency), the mean of each band removed, 16 samples discarded at its start.
    His figures show 0 for a negative kurtosis; here it is kept.

    Parameters
    ----------
    signal : Signal
    levels : int, optional
        Deepest whole level. Default and largest: ``log2(n / 128)``.
    filters : str
        ``sharp`` or ``antoni``.

    Raises
    ------
    ValueError
        If the record is too short for the levels, constant, or the filters are of neither kind.

    References
    ----------
    J. Antoni, Mech. Syst. Signal Process. 21(1) (2007) 108-124.
    """
    x = _oscillation(signal)
    deepest = math.floor(math.log2(x.size / FEWEST)) if x.size >= FEWEST else 0
    levels = deepest if levels is None else whole("levels", levels, 0)
    if not 1 <= levels <= deepest:
        raise ValueError(f"levels = {levels}, but {signal.name} with {x.size} samples allows 1 to {deepest}; record longer")
    one_of("filters", filters, tuple(BANKS))
    start, split, judged = BANKS[filters]
    floor = EMPTY * np.mean(x**2)
    rows, bands = [(0.0, 0.5, 1.0, _excess(x, 3, floor))], [start(x)]
    for level in range(levels):
        halves = [part for band in bands for part in split(band, 2)]
        rows += _rows(level, 2, judged(halves, 2), floor)
        if level < levels - 1:
            rows += _rows(level, 3, judged([part for band in bands for part in split(band, 3)], 3), floor)
        bands = halves
    level, centre, width, kurtosis = np.array(rows).T
    return Kurtogram(level, centre * signal.rate / 2, width * signal.rate / 2, kurtosis)


def _positive(x):
    """Return the part of x at positive frequencies by a long filter. A Fourier transform would distort the ends."""
    taps = min(ANALYTIC_TAPS, x.size // 8) // 2 * 2 + 1
    return scipy.signal.fftconvolve(x, 2 * scipy.signal.firwin(taps, 0.5) * np.exp(0.5j * np.pi * np.arange(taps)), mode="valid")


def _rows(level, parts, bands, floor):
    """Return level, centre, width (in Nyquist frequencies) and kurtosis of `bands`, which are `level` divided into `parts`."""
    width = 1 / len(bands)
    return [(level + math.log2(parts), (i + 0.5) * width, width, _excess(band, 2, floor)) for i, band in enumerate(bands)]


def _split(x, parts):
    """Return bands of equal width from low to high, each shifted to 0 ... 1/2 of its sampling rate."""
    taps = {2: HALF_TAPS, 3: THIRD_TAPS}[parts]
    low_pass = scipy.signal.firwin(taps, WIDER * 0.5 / parts)
    k = np.arange(taps)
    out = []
    for i in range(parts):
        centre = (i + 0.5) / (2 * parts)  # centre frequency [cycles per sample]
        part = scipy.signal.upfirdn(low_pass * np.exp(2j * np.pi * centre * k), x, down=parts)
        part = part[(taps - 1) // parts : (x.size - 1) // parts + 1]
        out.append(part * (-1.0) ** np.arange(part.size) if i % 2 else part)
    return out


def _split_antoni(x, parts):
    """Split by the filters of Antoni's program, whose high-pass filter has one tap less."""
    taps, cut = {2: (17, 0.4), 3: (25, 0.8 / 3)}[parts]
    k = np.arange(taps)
    low_pass = scipy.signal.firwin(taps, cut)
    first = low_pass * np.exp(2j * np.pi * k / (4 * parts))
    if parts == 3:
        return [scipy.signal.upfirdn(first * np.exp(2j * np.pi * i * k / 6), x, down=1)[2 : x.size : 3] for i in range(3)]
    high = first[-2::-1] * (-1.0) ** k[1:]
    low, upper = (scipy.signal.upfirdn(kernel, x, down=1)[1 : x.size : 2] for kernel in (first, high))
    return [low, upper * (-1.0) ** (1 + np.arange(upper.size))]


def _judged_antoni(bands, parts):
    """Return the bands without the first filtered samples and without their mean."""
    cut = [x[15 if parts == 2 and i % 2 else 16 :] for i, x in enumerate(bands)]
    return [x - x.mean() for x in cut]


BANKS = {  # by type of filter: signal to split, splitting function, function applied before the kurtosis
    "sharp": (_positive, _split, lambda bands, _: bands),
    "antoni": (lambda x: x, _split_antoni, _judged_antoni),
}


def _excess(x, gaussian, floor):
    power = np.abs(x) ** 2
    mean = power.mean()
    return float((power**2).mean() / mean**2 - gaussian) if mean > floor else 0.0


def _oscillation(signal):
    """Return values without mean, scaled to a maximum of 1."""
    x = oscillation(signal.values, f"{signal.name} is constant: it has no kurtosis")
    return x / np.abs(x).max()
