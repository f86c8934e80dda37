"""Common parts of the closed forms: an itemised tooth flexibility, and Sainsot's gear-body polynomials."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial.legendre import leggauss

from ....geometry.kept import keeping
from ....geometry.tooth.profile import cartesian, fillet, flank, form_point

FOUNDATIONS = ("sainsot", "external", "printed", "none")
RING_H = 1.0  # h of a ring with the foundation of external gears; article S4 defines no h, and a ring has no bore
FLANK_POINTS, FILLET_POINTS = leggauss(24), leggauss(64)

# rows L*, M*, P*, Q*; columns A..F of X = A/theta**2 + B h**2 + C h/theta + D/theta + E h + F
SAINSOT = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)


@dataclass(frozen=True, slots=True)
class Validity:
    """Violated range of validity of a formula: quantity `what`, its `value`, and the permitted range `low` to `high`."""

    what: str
    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Components:
    """Flexibility of one tooth at contact positions, by component. Arrays [mm per N/mm of width].

    `outside` lists the ranges of validity that the gear exceeds (a tuple of `Validity`).
    """

    bending: np.ndarray
    shear: np.ndarray
    axial: np.ndarray
    foundation: np.ndarray
    outside: tuple = ()

    @property
    def total(self):
        """Sum of the four parts [mm per N/mm]."""
        return self.bending + self.shear + self.axial + self.foundation


def sainsot(h, theta):
    """Return the polynomials (L*, M*, P*, Q*) at ``h = r_f / r_bore`` and root half angle `theta` [rad].

    They are fitted for ``1.4 <= h <= 7`` and ``0.01 <= theta <= 0.12``, and invalid elsewhere and for rings.

    References
    ----------
    P. Sainsot, P. Velex, O. Duverger, J. Mech. Des. 126(4) (2004) 748-752, Table 1.
    """
    return SAINSOT @ np.array([1 / theta**2, h**2, h / theta, 1 / theta, h, 1.0])


def body_ratio(gear, foundation):
    """Return ``h = r_f / r_bore`` for Sainsot's polynomials, or `RING_H` for a ring with the foundation "printed".

    Raises
    ------
    ValueError
        For a ring otherwise: the fit is for a disc held at its bore.
    """
    if not gear.internal:
        return gear.r_f / gear.r_bore
    if foundation == "printed":
        return RING_H
    raise ValueError(f"Sainsot's foundation is invalid for a ring (z = {gear.z}): use foundation = 'none', or method = 'fe'")


def sainsot_outside(gear, h, theta):
    """Return the ranges of Sainsot's fit that a gear with `h` and root half angle `theta` [rad] exceeds, as `Validity`."""
    seen = (
        Validity(f"h = r_f / r_bore of z = {gear.z} (Sainsot)", h, 1.4, 7.0),
        Validity(f"theta_f [rad] of z = {gear.z} (Sainsot)", float(theta), 0.01, 0.12),
    )
    return tuple(v for v in seen if not v.low <= v.value <= v.high)


def load_angle(gear, roll):
    """Angle [rad] between the tooth force and the normal of the tooth centre-line, positive towards the root."""
    return np.asarray(roll) / gear.r_b - gear.outward * gear.base_half_angle


@dataclass(frozen=True, slots=True)
class Profile:
    """Gauss points along a piece of the right half of a tooth, for integrals over its height. Arrays ``(..., m)``.

    Half thickness `x` [mm], height `y` over the gear's centre [mm], `slope` dx / dy, and `step`, the weights of dy [mm].
    """

    x: np.ndarray
    y: np.ndarray
    slope: np.ndarray
    step: np.ndarray


def along_flank(gear, roll):
    """Return the involute from its lower end to each of `roll` [mm] ``(n,)``, as a `Profile` of shape ``(n, m)``."""
    points, weights = FLANK_POINTS
    span = (roll - gear.roll_f)[:, None] / 2
    at = gear.roll_f + span * (1 + points)
    angle = load_angle(gear, at)
    x, y = cartesian(*flank(gear, at))
    return Profile(x, y, -np.tan(angle), at / gear.r_b * np.cos(angle) * weights * span)


@keeping(128)
def along_fillet(gear, phi=math.pi / 2):
    """Return the fillet from rack tip angle `phi` [rad] (pi/2 at the root circle) to the involute, as a `Profile` ``(m,)``.

    Its derivatives are those of a Chebyshev interpolant of 48 nodes.
    """
    top = form_point(gear)[0]
    points, weights = FILLET_POINTS
    half = (phi - top) / 2
    at = top + half * (1 + points)
    x, y = cartesian(*fillet(gear, at))
    across, up = (
        Chebyshev.interpolate(lambda t, k=k: cartesian(*fillet(gear, t))[k], 48, domain=[top, phi]).deriv()(at) for k in (0, 1)
    )
    return Profile(x, y, across / up, -up * weights * half)
