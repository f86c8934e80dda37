"""Lines of a spectrum: expected frequencies of a faulty gear, and their amplitudes."""

import math
from collections.abc import Mapping

import numpy as np

from ..core.checks import whole
from .given import hertz
from .spectrum import Spectrum

MOST_LINES = 10_000  # largest number of harmonics, and of sidebands of each
HANN = 1.5  # equivalent noise bandwidth of the Hann window [bins]
LEAST = 5.0  # least amplitude of a line, relative to the noise, that `line_part` evaluates
BINS = 2  # half-width of the search for a line around its expected frequency [bins]


def expected_lines(
    mesh_frequency: float,
    fault_frequency: float | None = None,
    carrier_frequency: float | None = None,
    count: int = 3,
    *,
    harmonics: int = 1,
) -> dict[str, float]:
    """Return the expected frequencies of a faulty gear in a spectrum.

    Where ``f_m`` is a multiple of ``f_fault`` (S0: 280 = 7 x 40 Hz, S4: 480 = 6 x 80 Hz), harmonics of the fault fall on
    sidebands and both names have the same frequency.

    Parameters
    ----------
    mesh_frequency : float
        f_m [Hz]; of a planetary set ``z_ring f_carrier``.
    fault_frequency : float, optional
        f_fault [Hz]: how often the damaged tooth meshes; for one sun tooth ``planets f_m / z_sun``.
    carrier_frequency : float, optional
        f_carrier [Hz].
    count : int
        Number of sidebands on each side, and of harmonics of the fault.
    harmonics : int
        Number of harmonics of the mesh.

    Returns
    -------
    dict of str to float
        ``f_m``, ``2 f_m``, ``f_m - f_fault``, ``f_m + 2 f_fault``, ``f_fault``, ``f_m - f_carrier``, ... [Hz], those above 0.

    Raises
    ------
    ValueError
        If a frequency is no positive number of Hz, `count` is negative, or `harmonics` is below 1.

    Examples
    --------
    S0: sun 1000, carrier 200 rpm, z_sun 21, three planets.

    >>> expected_lines(280.0, 40.0, count=1)
    {'f_m': 280.0, 'f_m - f_fault': 240.0, 'f_m + f_fault': 320.0, 'f_fault': 40.0}
    """
    frequencies = {"f_fault": fault_frequency, "f_carrier": carrier_frequency}
    spacings = {name: value for name, value in frequencies.items() if value is not None}
    for name, value in {"f_m": mesh_frequency, **spacings}.items():
        hertz(name, value)
    whole("count", count, 0, MOST_LINES)
    whole("harmonics", harmonics, 1, MOST_LINES)
    lines = {}
    for n in range(1, harmonics + 1):
        mesh = _times(n, "f_m")
        lines[mesh] = n * mesh_frequency
        for name, spacing in spacings.items():
            for k in range(1, count + 1):
                lines[f"{mesh} - {_times(k, name)}"] = n * mesh_frequency - k * spacing
                lines[f"{mesh} + {_times(k, name)}"] = n * mesh_frequency + k * spacing
    for name, spacing in spacings.items():
        lines |= {_times(k, name): k * spacing for k in range(1, count + 1)}
    return {name: value for name, value in lines.items() if value > 0}


def _times(n, name):
    return name if n == 1 else f"{n} {name}"


def find_lines(
    found: Spectrum, lines: Mapping[str, float], tolerance: float | None = None, *, between: bool = False
) -> dict[str, tuple[float, float]]:
    """Find the largest bin near each expected line. A bin that is nearer to another line (at least a bin away) is ignored.

    Parameters
    ----------
    found : Spectrum
    lines : dict of str to float
        See `expected_lines`.
    tolerance : float, optional
        How far from the expected frequency a line may be [Hz]; default two bins. A measured speed wanders: S1 finds 39.8 for
        40 Hz.
    between : bool
        Place a line between two bins and correct its amplitude, see `between_bins`: with Hann's window, the default of
        `gearfe.spectrum`; with any other it changes nothing.

    Returns
    -------
    dict of str to (float, float)
        Frequency and amplitude of the largest bin within the tolerance; of a line between two bins the window's scalloping is
        left in (`gearfe.spectrum`: up to 15 % too low with Hann's) unless `between` is asked for.

    Raises
    ------
    ValueError
        If a line lies outside the spectrum or the tolerance holds no bin.
    """
    tolerance = BINS * found.resolution if tolerance is None else tolerance
    out = {}
    for name, expected in lines.items():
        if expected > found.frequency[-1] + 1e-6 * found.resolution:
            raise ValueError(
                f"line {name} at {expected:g} lies above {found.name}, which ends at {found.frequency[-1]:g} {found.axis}"
            )
        others = [other for other in lines.values() if abs(other - expected) > found.resolution]
        low = max((other for other in others if other < expected), default=-math.inf)
        high = min((other for other in others if other > expected), default=math.inf)
        span = max(expected - tolerance, (low + expected) / 2), min(expected + tolerance, (expected + high) / 2)
        frequency, values = found.within(*span)
        top = int(np.argmax(values))
        out[name] = float(frequency[top]), float(values[top])
        if between:
            out[name] = between_bins(found, int(np.searchsorted(found.frequency, frequency[top] - 0.5 * found.resolution)))
    return out


def line_part(found: Spectrum, expected: float, reach: float) -> tuple[float, float, float]:
    """Compare a line at its expected frequency with all amplitude around it, which a varying or different speed spreads.

    ::

        part = A / sqrt(sum(X**2 - s**2) / 1.5)

    A is the amplitude of the largest bin at most 2 bins from the expected frequency (`between_bins`), the sum runs over the bins
    at most `reach` away, s is the RMS of the noise there, and 1.5 the bandwidth of Hann's window [bins].

    Parameters
    ----------
    found : Spectrum
        Of amplitudes, with Hann's window.
    expected, reach : float
        [Hz]

    Returns
    -------
    part : float
        1 for a line at the expected frequency, less for one that is spread or elsewhere; nan if no line exceeds the noise.
    largest : float
        Frequency of the largest line in reach [Hz].
    sharp : float
        The same part for this line: 1 for a constant speed.
    """
    frequency, values = found.within(expected - reach, expected + reach)
    beside = np.concatenate([found.within(expected + a * reach, expected + b * reach)[1] for a, b in ((-3, -1), (1, 3))])
    noise = float(np.quantile(beside, 0.25)) ** 2 / math.log(4 / 3)  # Amplitudes of noise have Rayleigh's distribution.
    whole = math.sqrt(max(float((values**2 - noise).sum()) / HANN, 0.0))
    top = int(np.argmax(values))
    if values[top] ** 2 < LEAST**2 * noise or whole == 0:
        return math.nan, expected, math.nan
    first = int(np.searchsorted(found.frequency, frequency[0] - 0.5 * found.resolution))
    near = np.flatnonzero(np.abs(frequency - expected) <= BINS * found.resolution)
    own = int(near[np.argmax(values[near])])
    largest, size = between_bins(found, first + top)
    return between_bins(found, first + own)[1] / whole, largest, size / whole


def between_bins(found: Spectrum, top: int) -> tuple[float, float]:
    """Return frequency and amplitude of a line from its largest bin `top` and the larger neighbour of this bin.

    ::

        r = X[top +- 1] / X[top],  d = (2 r - 1) / (r + 1),  A = X[top] pi d (1 - d**2) / sin(pi d)

    d is the distance of the line from `top` in bins. It is exact for a lone line with Hann's window, apart from its image at
    negative frequencies. Other lines should be 4 bins away or more. Bins that are no local maximum, and spectra with other
    windows, are not changed.

    References
    ----------
    T. Grandke, IEEE Trans. Instrum. Meas. 32(2) (1983) 350-355.
    """
    frequency, values = float(found.frequency[top]), float(found.values[top])
    hann = abs(found.bandwidth - HANN * found.resolution) < 0.01 * found.resolution
    if not hann or not 1 < top < found.values.size - 1:
        return frequency, values
    side = 1 if found.values[top + 1] >= found.values[top - 1] else -1
    ratio = float(found.values[top + side] / values) if values > 0 else 0.0
    d = (2 * ratio - 1) / (ratio + 1)
    if not 0 < d <= 0.5 + 1e-9:
        return frequency, values
    return frequency + side * d * found.resolution, values * math.pi * d * (1 - d**2) / math.sin(math.pi * d)
