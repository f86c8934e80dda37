"""`Member`: a body of a planetary stage with its springs, and the member of a gear, modelled as a ring."""

import math
from dataclasses import dataclass

from ...core.record import ranged, settle_numbers
from ...geometry.tooth.gear import Gear

LIGHTEST, HEAVIEST = 1.0, 1e5  # limits of the density [kg/m3], which include all solids


@dataclass(frozen=True, slots=True)
class Member:
    """Central member or planet of a stage: mass, inertia, and springs to the ground (for a planet to the carrier).

    Attributes
    ----------
    mass, inertia : float
        Mass [kg] and moment of inertia [kg m2].
    bearing : float
        Stiffness of its bearing in x and in y [N/m].
    torsion : float
        Torsional stiffness to the ground [N m/rad].
    r_b : float
        Base radius [m]. For a carrier: the radius of the planet axes.
    """

    mass: float
    inertia: float
    bearing: float
    r_b: float
    torsion: float = 0.0

    def __post_init__(self) -> None:
        """Raise ValueError unless mass, inertia and radius are positive and stiffnesses are not negative. All must be finite."""
        settle_numbers(self, "member", "mass inertia r_b", above=0.0)
        settle_numbers(self, "member", "bearing torsion", least=0.0)


def gear_member(gear: Gear, density: float, bearing: float, *, width: float | None = None) -> Member:
    """`Member` of a gear as a ring from its bore (or rim) to its reference circle.

    Parameters
    ----------
    gear : Gear
    density : float
        [kg/m3]
    bearing : float
        Stiffness of its bearing in x and in y [N/m]; 0: none.
    width : float, optional
        [mm]; default: the width of the gear.

    Returns
    -------
    Member
        Mass [kg], moment of inertia about its own axis [kg m2] and base radius [m]; without torsional stiffness.

    Raises
    ------
    ValueError
        If `density` or `width` is not positive, or `bearing` is negative.
    """
    low, high = sorted((gear.held, gear.z * gear.m_n / (2 * math.cos(gear.beta))))
    if not LIGHTEST <= ranged("density", density, " kg/m3", above=0.0) <= HEAVIEST:
        raise ValueError(f"density = {density:g} kg/m3, but give {LIGHTEST:g} to {HEAVIEST:g}: steel has 7850")
    width = ranged("width", gear.b if width is None else width, " mm", above=0.0)
    mass = density * math.pi * (high**2 - low**2) * width * 1e-9
    return Member(mass, mass * (low**2 + high**2) / 2 * 1e-6, bearing, 1e-3 * gear.r_b)
