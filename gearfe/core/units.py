"""Display unit of stiffness: N/um in all tables and pictures. Data and files are in SI units and state the unit."""

import math

NEWTON_PER_UM = 1e6  # one N/um in N/m


def in_newton_per_um(k: float, digits: int = 4) -> str:
    """Return the stiffness `k` [N/m] as text in N/um with this number of significant digits.

    Examples
    --------
    >>> in_newton_per_um(2.58123e8), in_newton_per_um(1.367541e9, 5), in_newton_per_um(3.0e6)
    ('258.1', '1367.5', '3.000')
    """
    return significant(k / NEWTON_PER_UM, digits)


def significant(value: float, digits: int = 4) -> str:
    """Return a number with this number of significant digits, without an exponent where that is readable."""
    if not math.isfinite(value) or not 1e-3 <= abs(value) < 1e7:
        return f"{value:.{digits}g}"
    return f"{value:.{max(0, digits - 1 - math.floor(math.log10(abs(value))))}f}"
