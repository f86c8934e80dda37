"""Involute function and its inverse. Roll length is the parameter of every flank in this package.

The roll length ``rho = sqrt(R**2 - r_b**2)`` of a flank point is the length of the base tangent to it, hence its
radius of curvature; the arc of the flank from the base circle is ``rho**2 / (2 r_b)`` (ISO 21771:2007, 5.1).
"""

import numpy as np


def inv(alpha):
    """Involute function ``tan(alpha) - alpha`` (ISO 21771:2007, eq. 21).

    >>> round(float(inv(np.radians(20.0))), 6)
    0.014904
    """
    return np.tan(alpha) - alpha


def inverse_inv(value):
    """Pressure angle [rad] whose involute function is `value` > 0, by Newton's method.

    >>> round(float(np.degrees(inverse_inv(inv(np.radians(22.5))))), 10)
    22.5
    """
    if not value > 0:
        raise ValueError(f"inv(alpha) = {value:.6g}, but it must be positive: the gears cannot touch at this centre distance")
    alpha = np.arctan(np.cbrt(3 * value) + value)
    for _ in range(50):
        step = (inv(alpha) - value) / np.tan(alpha) ** 2
        alpha = alpha - step
        if abs(step) < 1e-15:
            break
    return float(alpha)
