"""Direction in which a crack grows, from K_I and K_II."""

import math

import numpy as np
import scipy
from numpy.polynomial import polynomial

CRITERIA = ("tangential", "energy", "shear")
_P = math.pi**2
# Coefficients as functions of m, the kink angle over pi: M. Amestoy, J. B. Leblond, Int. J. Solids Struct. 29 (1992) 465-501.
_F11 = [1, 0, -3 * _P / 8, 0, _P - 5 * _P**2 / 128, 0, _P / 9 - 11 * _P**2 / 72 + 119 * _P**3 / 15360, 0, 5.0779, 0, -2.88312]
_F12 = [0, -1.5, 0, 10 / 3 + _P / 16, 0, -2 - 133 * _P / 180 + 59 * _P**2 / 1280, 0, 12.313906 / math.pi, 0, -7.32433 / math.pi]
_F21 = [0, 0.5, 0, -4 / 3 - _P / 48, 0, -2 / 3 + 13 * _P / 30 - 59 * _P**2 / 3840, 0, -6.176023 / math.pi, 0, 4.44112 / math.pi]
_F22 = [
    1, 0, -4 - 3 * _P / 8, 0, 8 / 3 + 29 * _P / 18 - 5 * _P**2 / 128, 0,
    -32 / 15 - 4 * _P / 9 - 1159 * _P**2 / 7200 + 119 * _P**3 / 15360, 0, 10.58254, 0, -4.78511,
]  # fmt: skip
MOST = 0.43  # largest kink angle over pi


def kinked(k_1: float, k_2: float, angle: float) -> tuple[float, float]:
    """Return K_I and K_II at the tip of an infinitesimal kink at `angle` [rad], positive to the left in crack direction.

    The series end after the tenth power of ``angle / pi``; the next terms are below 2e-4 for the angles here.

    References
    ----------
    M. Amestoy, J. B. Leblond, Int. J. Solids Struct. 29 (1992) 465-501.
    """
    m = angle / math.pi
    one, two, three, four = (float(polynomial.polyval(m, factors)) for factors in (_F11, _F12, _F21, _F22))
    return one * k_1 + math.pi * two * k_2, math.pi * three * k_1 + four * k_2


def turn_angle(k_1: float, k_2: float, criterion: str = "tangential") -> float:
    """Angle [rad] by which a crack turns, positive to the left seen along it, or nan if K_I is not positive.

    Parameters
    ----------
    k_1, k_2 : float
        Stress intensity; any unit.
    criterion : {"tangential", "energy", "shear"}
        Largest tangential stress; largest energy release rate of an infinitesimal kink; no K_II at its tip.
    """
    if k_1 <= 0:
        return math.nan
    if criterion == "tangential" or k_2 == 0:
        return growth_angle(k_1, k_2)
    low, high = (-MOST * math.pi, 0.0) if k_2 > 0 else (0.0, MOST * math.pi)
    if criterion == "shear":
        ends = [kinked(k_1, k_2, angle)[1] for angle in (low, high)]
        if ends[0] * ends[1] < 0:
            return scipy.optimize.brentq(lambda angle: kinked(k_1, k_2, angle)[1], low, high)
        return low if abs(ends[0]) < abs(ends[1]) else high

    def away(angle):
        return -np.hypot(*kinked(k_1, k_2, angle))

    found = scipy.optimize.minimize_scalar(away, bounds=(low, high), method="bounded")
    return float(found.x)


def growth_angle(k_1, k_2):
    """Angle of largest tangential stress [rad]: ``k_1 sin(t) + k_2 (3 cos(t) - 1) = 0``.

    >>> round(math.degrees(growth_angle(0.0001, 1.0)), 1)
    -70.5
    """
    if k_1 <= 0:
        return math.nan
    if k_2 == 0:
        return 0.0
    return 2 * math.atan((k_1 - math.copysign(math.sqrt(k_1**2 + 8 * k_2**2), k_1)) / (4 * k_2))
