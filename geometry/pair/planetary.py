"""`PlanetarySet`: sun, planets and ring, with checks of the assembly conditions."""

import math
from dataclasses import dataclass

from ..checks import is_finite, is_whole, shown
from ..tooth.gear import Gear
from ..tooth.involute import inv
from .gear_pair import GearPair, free_centre_distance


@dataclass(frozen=True, slots=True)
class PlanetarySet:
    """Sun, planets and ring on a common centre distance.

    Parameters
    ----------
    sun, planet, ring : Gear
    n_planets : int
    a : float, optional
        Centre distance [mm]; default: that of sun and planet without backlash.

    Raises
    ------
    ValueError
        If the two meshes need different centre distances (the message gives the ring shift that closes the set), or equally
        spaced planets cannot be assembled (``(z_s + z_r) / n_planets`` must be whole), or neighbouring planets touch.
    """

    sun: Gear
    planet: Gear
    ring: Gear
    n_planets: int
    a: float = None  # type: ignore[assignment]  # None stands for the distance without backlash until __post_init__

    def __post_init__(self) -> None:
        """Check centre distances, planet spacing and clearance of neighbouring planets."""
        if not self.ring.internal or self.sun.internal or self.planet.internal:
            raise ValueError("a set needs two external gears and a ring: give r_bore for sun and planet, r_rim for the ring")
        if not is_whole(self.n_planets) or self.n_planets < 1:
            raise ValueError(f"n_planets = {self.n_planets!r}, but a set has a whole number of planets, at least 1")
        if self.a is None:
            object.__setattr__(self, "a", free_centre_distance(self.sun, self.planet))
        if not (is_finite(self.a) and self.a > max(self.ring.r_b - self.planet.r_b, self.sun.r_b + self.planet.r_b)):
            raise ValueError(f"a = {shown(self.a)} mm: the base circles do not allow a mesh at this centre distance; increase a")
        GearPair(self.sun, self.planet, self.a)
        closing = self.closing_shift()
        if abs(closing - self.ring.x) > 2e-3:
            raise ValueError(
                f"z = {self.sun.z}/{self.planet.z}/{self.ring.z} with x_ring = {self.ring.x:g} does not close at "
                f"a = {self.a:.6g} mm: planet and ring mesh there without backlash for x_ring = {closing:.4f} "
                f"(without shifts z_r = z_s + 2 z_p = {self.sun.z + 2 * self.planet.z})"
            )
        if (self.sun.z + self.ring.z) % self.n_planets:
            raise ValueError(
                f"{self.n_planets} planets cannot be spaced equally: (z_s + z_r) / N = ({self.sun.z} + {self.ring.z}) / "
                f"{self.n_planets} is not whole; change N or a tooth number"
            )
        room = 2 * self.a * math.sin(math.pi / self.n_planets) - 2 * self.planet.r_a
        if self.n_planets > 1 and room <= 0:
            raise ValueError(f"{self.n_planets} planets touch each other: their tips overlap by {-room:.4g} mm; use fewer")

    def closing_shift(self) -> float:
        """Return the profile shift of the ring [m_n] with which planet and ring mesh without backlash at `a`."""
        planet, ring = self.planet, self.ring
        alpha_wt = math.acos((ring.r_b - planet.r_b) / self.a)
        return planet.x + (inv(alpha_wt) - inv(planet.alpha_t)) * (ring.z - planet.z) / (2 * math.tan(planet.alpha_n))

    @property
    def sun_planet(self) -> GearPair:
        """Pair of sun and planet at the centre distance of the set."""
        return GearPair(self.sun, self.planet, self.a)

    @property
    def planet_ring(self) -> GearPair:
        """Pair of planet and ring at the centre distance of the set."""
        return GearPair(self.planet, self.ring, self.a)
