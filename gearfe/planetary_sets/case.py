"""`PlanetaryCase`: a planetary set with supports, errors, damage and load. Its values are checked once."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, get_args

import numpy as np

from ..core.case_parts import check_load
from ..core.checks import numbers, truth
from ..core.frozen import Frozen
from ..core.material import Material
from ..core.record import ranged, settle
from ..geometry.checks import is_whole
from ..geometry.damage.chip import Chip
from ..geometry.damage.crack import Crack, check_apart, check_through
from ..geometry.damage.kinds import check_broken, why_wide
from ..geometry.damage.missing import MissingTooth
from ..geometry.pair.gear_pair import GearPair
from ..geometry.pair.planetary import PlanetarySet
from ..geometry.renamed import renamed, warn_renamed
from ..geometry.tooth.modified import Flank
from .rim_supports import check_support
from .standing import assembled

KINDS = Crack | MissingTooth | Chip  # types of damage of a section
GEARS = ("sun", "planet", "ring")
LARGEST = 0.1  # limit of position errors [m_n]; larger values are probably given in another unit


def planet_name(index: int) -> str:
    """Return the name of a planet by its index: ``"planet1"`` is the first, as in machines."""
    return f"planet{index + 1}"


@renamed(angles="planet_angles")
def _entries(what, value, kind, single):
    """Check that an entry, or every entry of a list, is of a `kind`."""
    if not single and not isinstance(value, (list, tuple)):
        raise ValueError(f"{what} = {value!r}, but give a list, also for a single entry")
    for entry in (value,) if single else value:
        if not isinstance(entry, kind):
            nouns = " nor a ".join(one.__name__ for one in get_args(kind) or (kind,))
            raise ValueError(
                f"{what}: {entry!r} is no {nouns}; a planetary set is solved in a section, which allows no other type"
            )
    return value if single else tuple(value)


@dataclass(frozen=True, slots=True)
class PlanetaryCase:
    """Planetary set in plane strain under load. The carrier is fixed, the sun drives clockwise, the ring carries the torque.

    Parameters
    ----------
    gears : PlanetarySet
        Spur gears. Its number of planets is ignored if `planet_angles` are given.
    force : float
        Mean over the planets of the force between sun and planet, along the line of action [N]: the sun's torque is `force` times
        the number of planets times the sun's r_b.
    material : Material or (Material, Material, Material)
        Of all gears, or of sun, planets and ring.
    planet_angles : sequence of float, optional
        Planet position angles, clockwise from +y [rad]; default: equally spaced from 0. They must be whole multiples of ``2 pi /
        (z_s + z_r)`` apart.
    ring : "held", RimBed or RimSupports
        Support of the ring's outer edge; ``"held"`` is rigid all around.
    floating : bool
        If True, the sun's axis is free in the plane of the section, which needs three planets. Otherwise it is fixed.
    pin : float
        Radial stiffness of each planet's pin and bearing together, over the whole width [N/mm]; default rigid. Planets turn on
        their pins without friction; the carrier is rigid.
    errors : sequence of (float, float), optional
        Pin position error of each planet [mm]: outwards, and clockwise, the direction in which the sun drives it.
    flanks : dict, optional
        Modifications ``{"sun": Flank(...), "planet": Flank(...), "planet2": Flank(...), "ring": Flank(...)}``. Planets are
        ``"planet1"``, ``"planet2"``, as in machines; ``"planet"`` is every planet without a separate entry. Both flanks of a
        planet have them. A pitch deviation of a planet moves the whole tooth; its sign is that of the flank towards the sun.
        Teeth are counted clockwise: at position 0 tooth 0 of the sun meets tooth 0 of planet 1, see
        `gearfe.planetary_sets.standing`.
    damage : dict, optional
        Lists of cracks through the whole width, missing teeth and chips ``{"sun": [Crack(...)], ...}``, by the same names. The
        loaded side of a planet's tooth is the one that the sun loads. One crack to a side of a tooth. Faces of cracks do not pass
        through each other under all loads of the set together. They slide without friction.

    Raises
    ------
    ValueError
        If the set is impossible; the message states what to change.
    """

    gears: PlanetarySet
    force: float
    material: Any
    planet_angles: Any = None
    ring: Any = "held"
    floating: bool = False
    pin: float = math.inf
    errors: Any = None
    flanks: Any = None
    damage: Any = None
    pairs: tuple[GearPair, GearPair] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Convert all values to a common form. Raise ValueError for an impossible set."""
        if not isinstance(self.gears, PlanetarySet):
            raise ValueError(f"gears = {self.gears!r}, but give a PlanetarySet")
        settle(self, pairs=(self.gears.sun_planet, self.gears.planet_ring))
        if self.gears.sun.beta:
            raise ValueError(
                f"beta = {math.degrees(self.gears.sun.beta):.4g} degrees, but a section models spur gears only: give beta = 0"
            )
        n = self.gears.n_planets
        even = 2 * math.pi / n * np.arange(n)
        settle(
            self, planet_angles=tuple(assembled(self.gears, even if self.planet_angles is None else self.planet_angles).tolist())
        )
        settle(self, force=ranged("force", self.force, " N", above=0.0))
        settle(self, pin=ranged("pin", self.pin, " N/mm", above=0.0, finite=False))
        materials = tuple(self.material) if isinstance(self.material, (tuple, list)) else (self.material,) * 3
        if len(materials) != 3 or not all(isinstance(material, Material) for material in materials):
            raise ValueError(f"material = {self.material!r}, but give one Material or three: of sun, planets and ring")
        settle(self, material=materials)
        for k, pair in enumerate(self.pairs):
            check_load(pair, self.force, materials[k : k + 2])
        check_support(self.ring, self.ring_gear)
        settle(self, floating=truth("floating", self.floating))
        if self.floating and self.planets < 3:
            raise ValueError(f"{self.planets} planets do not hold a floating sun: give floating = False, or at least 3 planets")
        flanks = self._by_gear("flanks", self.flanks, Flank, single=True)
        settle(self, errors=self._errors(), flanks=flanks, damage=self._by_gear("damage", self.damage, KINDS, single=False))
        self._check_faults()

    @property
    def planets(self) -> int:
        """Number of planets."""
        return len(self.planet_angles)

    @property
    def width(self) -> float:
        """Common face width of all gears [mm]."""
        return float(min(gear.b for gear in (self.gears.sun, self.gears.planet, self.gears.ring)))

    @property
    def ring_gear(self) -> Any:
        """Ring gear in mesh, with its trimmed tip if it was trimmed."""
        return self.pairs[1].gear_2

    def _errors(self):
        errors = np.zeros((self.planets, 2)) if self.errors is None else numbers("errors", self.errors, " [mm]")
        if errors.shape != (self.planets, 2) or not np.isfinite(errors).all():
            raise ValueError(
                f"errors of shape {errors.shape}, but give (outwards, clockwise) for each of {self.planets} planets [mm]"
            )
        most = LARGEST * self.gears.sun.m_n
        if np.abs(errors).max() > most:
            raise ValueError(
                f"errors up to {np.abs(errors).max():g} mm, more than a tenth of the module: amounts are in mm (20 um are 0.02)"
            )
        return tuple(map(tuple, errors.tolist()))

    def _by_gear(self, what, given, kind, *, single):
        """Return the given values by gear, including each planet: ``{"sun": ..., "planet1": ..., "ring": ...}``."""
        if given is None:
            return Frozen({})
        if not isinstance(given, Mapping):
            raise ValueError(f"{what} = {given!r}, but give them by gear: {{'sun': ..., 'planet': ..., 'ring': ...}}")
        planets = [planet_name(i) for i in range(self.planets)]
        numbered = [("planet", i) for i in range(len(planets))]
        former = {one: planets[one[1]] for one in given if one in numbered and is_whole(one[1])}
        for old, new in former.items():
            warn_renamed(f"{what} of {old}", repr(new))
        given = {former.get(name, name): value for name, value in given.items()}
        out: dict[Any, Any] = {}
        for name in sorted(given, key=lambda entry: entry != "planet"):
            if not isinstance(name, str) or name not in ("sun", "planet", "ring", *planets):
                raise ValueError(f"{what} of {name!r}, but give 'sun', 'planet', 'ring', or one planet: {', '.join(planets)}")
            value = _entries(f"{what} of {name!r}", given[name], kind, single)
            out |= dict.fromkeys(planets, value) if name == "planet" else {name: value}
        return Frozen(out)

    def _check_faults(self):
        for name, flank in self.flanks.items():
            if flank.wide:
                raise ValueError(
                    f"flanks of {name!r} change along the width, but a planetary set is solved in a section: give equal profiles"
                )
            if flank.eccentricity and name not in ("sun", "ring"):
                raise ValueError(f"eccentricity of {name!r}: give that of a planet as pitch deviations")
            flank.on(self.gear_of(name))
        for name, damage in self.damage.items():
            gear, cracks = self.gear_of(name), [one for one in damage if isinstance(one, Crack)]
            check_through(cracks, "the section of a planetary set")
            check_apart(gear, cracks)
            check_broken(gear, damage)
            if why := why_wide(damage):
                raise ValueError(f"damage of {name!r}: {why}, but a planetary set is solved in a transverse section: omit width")
            flank = self.flanks.get(name)
            if flank and (flank.tip_rounding or flank.tip_chamfer) and any(isinstance(one, Chip) for one in damage):
                raise ValueError(f"chips of rounded or chamfered tips: leave out the tip edges of {name!r}, or its chips")

    def gear_of(self, name: Any) -> Any:
        """Return a gear by name."""
        return {"sun": self.gears.sun, "ring": self.ring_gear}.get(name, self.gears.planet)

    def with_(self, **changed: Any) -> "PlanetaryCase":
        """Return the case with some values replaced. Flanks and damage are replaced as a whole.

        Gears with another number of planets stand equally spaced unless `planet_angles` are given.

        Raises
        ------
        ValueError
            If the number of planets changes, but errors, flanks or damage of planets are not given again.
        """
        gears = changed.get("gears", self.gears)
        if getattr(gears, "n_planets", None) != self.gears.n_planets:
            changed = {"planet_angles": None} | changed
        angles = changed.get("planet_angles", self.planet_angles)
        count = gears.n_planets if angles is None else np.size(angles)
        planets = {name: any(name not in ("sun", "ring") for name in getattr(self, name)) for name in ("flanks", "damage")}
        planets["errors"] = any(map(any, self.errors))
        for name, has in planets.items():
            if count != self.planets and has and name not in changed:
                raise ValueError(f"{count} planets, but the argument {name} is for {self.planets} planets: give {name} again")
        return replace(self, **({"errors": None} if count != self.planets else {}) | changed)
