"""How long a record must be so that the lines of a fault can be told from those beside them."""

import math

from ..signal.indicators import LOBES


def resolving_seconds(fault, turning=None, carrier=None):
    """Seconds of a record that resolve the lines of a fault, with Hann's window; 0 without a fault.

    ::

    T = max(2 LOBES / s, LOBES / d)

    A line fills `LOBES` bins of 1 / T. The lines of a fault stand s apart, the turns of its gear (without, the fault's own
    frequency): from 2 LOBES / s on half of the bins between them show the noise, which tells what is a line. And from the
    multiples of the turns of gear and carrier that are nearest to it the fault's line stands d away.

    Given is how often the faulty tooth meshes, the turns of its gear against the carrier, and those of the carrier [Hz]. A sun
    tooth of 21/31/84 teeth, 40 Hz: its gear turns at 13.33 Hz, the carrier at 3.33 Hz.

    >>> round(resolving_seconds(40.0, 40 / 3, 10 / 3), 3)
    1.2
    """
    line = fault or turning
    if not line:
        return 0.0
    apart = [_beside(line, comb) for comb in (turning, carrier) if comb]
    return max([2 * LOBES / (turning or line), *(LOBES / distance for distance in apart)])


def too_short(seconds, needed):
    """What to do about a record of `seconds` where `needed` seconds resolve the lines; empty if it is long enough.

    >>> too_short(0.3, 1.2001)
    '0.3 s are too short to part the lines of the fault from those beside them: record 1.21 s or longer'
    """
    if seconds >= needed * (1 - 1e-3):
        return ""
    digit = 10.0 ** (math.floor(math.log10(needed)) - 2)
    longer = math.ceil(needed / digit - 1e-6) * digit
    return f"{seconds:.3g} s are too short to part the lines of the fault from those beside them: record {longer:.3g} s or longer"


def _beside(line, comb):
    """Distance of a line to the nearest multiple of a frequency that is not the line itself."""
    rest = line % comb
    return comb if min(rest, comb - rest) < 1e-6 * comb else min(rest, comb - rest)
