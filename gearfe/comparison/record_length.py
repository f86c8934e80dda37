"""Record length that resolves the sidebands of a fault."""

import math

from ..signal.indicators import LOBES


def resolving_seconds(fault, turning=None, carrier=None):
    """Return the seconds of a record that resolve the lines of a fault, with Hann's window, or 0 without a fault.

    ::

    T = max(2 LOBES / s, LOBES / d)

    A line fills `LOBES` bins of 1 / T. The lines of a fault are s apart, the shaft frequency of its gear (without it, the fault
    frequency). From 2 LOBES / s on, half of the bins between them contain noise, from which lines are distinguished. The line of
    the fault is at a distance d from the nearest multiples of the shaft frequencies of gear and carrier.

    The arguments are the fault frequency, the shaft frequency of the gear relative to the carrier, and that of the carrier [Hz].
    A sun tooth of 21/31/84 teeth, 40 Hz: its gear rotates at 13.33 Hz, the carrier at 3.33 Hz.

    >>> round(resolving_seconds(40.0, 40 / 3, 10 / 3), 3)
    1.2
    """
    line = fault or turning
    if not line:
        return 0.0
    apart = [_beside(line, comb) for comb in (turning, carrier) if comb]
    return max([2 * LOBES / (turning or line), *(LOBES / distance for distance in apart)])


def too_short(seconds, needed):
    """Return the remedy for a record that is shorter than the `needed` seconds that resolve the fault lines.

    The result is empty if it is long enough.

    >>> too_short(0.3, 1.2001)
    '0.3 s cannot resolve the fault sidebands: record at least 1.21 s'
    """
    if seconds >= needed * (1 - 1e-3):
        return ""
    digit = 10.0 ** (math.floor(math.log10(needed)) - 2)
    longer = math.ceil(needed / digit - 1e-6) * digit
    return f"{seconds:.3g} s cannot resolve the fault sidebands: record at least {longer:.3g} s"


def _beside(line, comb):
    """Return the distance of a line to the nearest other multiple of a frequency."""
    rest = line % comb
    return comb if min(rest, comb - rest) < 1e-6 * comb else min(rest, comb - rest)
