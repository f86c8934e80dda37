"""`Case`: a gear pair under a load, with its materials, damage, flanks and supports, checked once."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field, fields, replace
from typing import Any, Self, TypedDict

import numpy as np

from ..geometry.aliases import Floats
from ..geometry.checks import is_finite, shown
from ..geometry.damage.chip import Chip
from ..geometry.damage.crack import Crack
from ..geometry.damage.kinds import Damage, by_side, why_wide
from ..geometry.damage.missing import MissingTooth
from ..geometry.pair.flanks import Misalignment, flank_forms
from ..geometry.pair.gear_pair import GearPair
from ..geometry.pair.lines import FACES
from ..geometry.tooth.flank_form import FlankForm
from ..geometry.tooth.modified import Flank
from .case_parts import SIDES, by_gear, check_load, forces_of, overlap, two_materials
from .frozen import Frozen
from .material import Material
from .supports.held import supports_of
from .supports.shaft import Shaft
from .supports.support import Support


@dataclass(frozen=True, slots=True)
class Case:
    """Gear pair under a load, with its materials, damage, flanks and supports.

    A `Solve` states the method of solution. A case copies the given lists, arrays and dicts and is immutable.
    `dataclasses.replace` returns a changed case. Cases with equal values are equal and have the same hash.

    Parameters
    ----------
    pair : GearPair
    force : float or sequence of float
        Force along the line of action over the whole width [N]. Several loads share one flexibility.
    material : Material or (Material, Material)
        Material of both gears, or of pinion and wheel.
    torque : float or sequence of float, optional
        Instead of `force`: torque on the pinion [N m], ``force = torque / r_b`` with the pinion's base radius.
    damage : dict, optional
        Cracks, pits and spalls by gear: ``{"pinion": [Crack(...), Spall(...)], "wheel": [...]}``.
    flanks : dict, optional
        Modifications and deviations of the loaded flanks: ``{"pinion": Flank(...), "wheel": Flank(...)}``.
    misalignment : Misalignment, optional
        Axes that are not parallel. (Another centre distance than the nominal one is the pair's `a`.)
    supports : dict, optional
        Springs or shafts under the hubs: ``{"pinion": Shaft(...), "wheel": Support(...)}``; default: rigid bores.
    face : {"spur", "helical", "herringbone"}, optional
        Type of teeth. Default: by the helix angle in three dimensions, otherwise ``spur`` (for helical gears the transverse
        section, as a spur gear of the same width).
    groove : float
        Width of a herringbone pair's relief groove [mm], part of b.

    Attributes
    ----------
    forces : tuple of float
        Forces along the line of action [N], also for a given torque.
    materials : (Material, Material)
    cracks, pits : (tuple, tuple)
        Damage of pinion and wheel, teeth numbered in each gear's own frame.
    broken : (tuple, tuple)
        Missing teeth and chipped tips of pinion and wheel in the same numbers.
    forms : (FlankForm, FlankForm) or None
        `flanks` and `misalignment` on the gears; None for involutes.
    held : (Support or Shaft or None, Support or Shaft or None) or None
        Supports of the hubs; None for rigid ones.

    Raises
    ------
    ValueError
        If an input is impossible; the message states which.

    Warns
    -----
    UserWarning
        If a pit removes a whole flank, or straight teeth are called helical.

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    >>> case = gf.Case(pair, 2000.0, gf.Material(E=207e3, nu=0.25), damage={"pinion": [gf.Crack(level=0.3)]})
    >>> curve = gf.solve(case, gf.Solve(phases=8, span="tooth"))
    >>> healthy = gf.solve(case.healthy, gf.Solve(phases=8, span="tooth"))
    >>> print(f"the crack reduces the mesh stiffness by up to {100 * (1 - curve.k / healthy.k).max():.1f} %")
    the crack reduces the mesh stiffness by up to 17.8 %
    """

    pair: GearPair
    force: float | Sequence[float] | Floats | None = None
    material: Material | tuple[Material, Material] | None = field(default=None, compare=False)
    _: KW_ONLY
    torque: float | Sequence[float] | Floats | None = None
    damage: Mapping[str, Sequence[Damage]] | None = None
    flanks: Mapping[str, Flank] | None = None
    misalignment: Misalignment | None = None
    supports: Mapping[str, Support | Shaft] | None = None
    face: str | None = None
    groove: float = 0.0
    forces: tuple[float, ...] = field(init=False, repr=False, compare=False)
    materials: tuple[Material, Material] = field(init=False, repr=False)
    cracks: tuple[tuple[Crack, ...], ...] = field(init=False, repr=False, compare=False)
    pits: tuple[tuple[Any, ...], ...] = field(init=False, repr=False, compare=False)
    broken: tuple[tuple[MissingTooth | Chip, ...], ...] = field(init=False, repr=False, compare=False)
    forms: tuple[FlankForm, FlankForm] | None = field(init=False, repr=False, compare=False)
    held: tuple[Support | Shaft | None, ...] | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check all fields, and convert them to the types that the solvers use."""
        pair = self.pair
        if not isinstance(pair, GearPair):
            raise ValueError(f"pair = {pair!r}, but give a GearPair")
        forces, materials = tuple(forces_of(pair, self.force, self.torque)), two_materials(self.material)
        for value in forces:
            check_load(pair, value, materials)
        if not (is_finite(self.groove) and self.groove >= 0):
            raise ValueError(f"groove = {shown(self.groove)}, but give the width of the relief groove, 0 or more [mm]")
        if self.face is not None and (not isinstance(self.face, str) or self.face not in FACES):
            raise ValueError(f"face = {shown(self.face)}, but it must be one of {', '.join(FACES)}")
        if self.face in FACES[1:] and not pair.gear_1.beta:
            message = f"face = {self.face!r}, but the gears have no helix angle (beta = 0): their teeth are straight"
            warnings.warn(message, stacklevel=4)
        cracks, pits, broken = by_gear(pair, self.damage)
        given: Any = self.force if self.torque is None else self.torque
        made: dict[str, Any] = {"forces": forces, "materials": materials, "cracks": cracks, "pits": pits, "broken": broken}
        made |= {"force": forces if np.ndim(given) else forces[0], "torque": None}
        made |= {"material": self.material if isinstance(self.material, Material) else materials}
        made |= {"forms": flank_forms(pair, self.flanks, self.misalignment)}
        made |= {"held": supports_of(pair, self.supports, list(forces), self.face)}
        made |= {"damage": _stated({name: tuple(own) for (name, _), own in zip(SIDES, by_side(self.damage), strict=True)})}
        made |= {"flanks": _stated(self.flanks), "supports": _stated(self.supports)}
        for name, value in made.items():
            object.__setattr__(self, name, value)

    def as_dict(self) -> dict[str, Any]:
        """Return the given values by name, as arguments of `gearfe.mesh_stiffness`.

        Pair, force, material, face and groove are always included. Other values are included if they differ from the default.
        """
        given = {item.name: (getattr(self, item.name), item.default) for item in GIVEN}
        return {name: value for name, (value, default) in given.items() if name in FIRST or value != default}

    def keys(self) -> Any:
        """Return the names of `as_dict`. The use of a case as a mapping is deprecated."""
        return _as_mapping(self).keys()

    def __getitem__(self, name: str) -> Any:
        return _as_mapping(self)[name]

    def __or__(self, more: Mapping[str, Any]) -> dict[str, Any]:
        return _as_mapping(self) | dict(more)

    @property
    def several(self) -> bool:
        """Whether the case has several loads."""
        return isinstance(self.force, tuple)

    @property
    def healthy(self) -> Self:
        """The same case without damage."""
        return replace(self, damage=None)

    @property
    def damaged(self) -> bool:
        """Whether there is any damage."""
        return any(map(any, (self.cracks, self.pits, self.broken)))

    @property
    def missing(self) -> bool:
        """Whether a tooth is missing."""
        return any(isinstance(one, MissingTooth) for own in self.broken for one in own)

    @property
    def runs(self) -> str:
        """Type of the teeth along the width: `face` if it is given, else derived from the helix angle."""
        return self.face or ("helical" if self.pair.gear_1.beta else "spur")

    @property
    def why_wide(self) -> str:
        """Reason for a three-dimensional model. The result is empty if the transverse section is sufficient."""
        if why := why_wide([one for defects in (*self.cracks, *self.pits) for one in defects]):
            return why
        if self.runs != "spur":
            return "contact lines run across helical teeth"
        if any(form.wide for form in self.forms or ()):
            return "flanks change along the width"
        return "shafts tilt the gears" if any(one.tilts for one in self.held or () if one) else ""

    @property
    def damaged_pairs(self) -> tuple[int, ...]:
        """Return the numbers of the tooth pairs with damage, beginning with that of the first crack or pit."""
        return tuple(
            dict.fromkeys(
                sense * defect.tooth
                for i, (_, sense) in enumerate(SIDES)
                for kind in (self.cracks, self.pits, self.broken)
                for defect in kind[i]
            )
        )

    @property
    def first_tooth(self) -> int | None:
        """Number of the tooth pair with the first crack or pit, or None without damage."""
        return next(iter(self.damaged_pairs), None)

    def overlap(self, face: str | None = None) -> float:
        """Return the overlap ratio of teeth of type `face` (default `runs`), 0 for spur and of one half for herringbone."""
        return overlap(self.pair, face or self.runs, self.groove)


FIRST = ("pair", "force", "material", "face", "groove")
GIVEN = tuple(own for own in fields(Case) if own.init)
NAMES = tuple(own.name for own in GIVEN)


class CaseOptions(TypedDict, total=False):
    """Options of a `Case` other than pair, load and materials, for functions that accept both the case and its arguments.

    `Case` describes them.
    """

    damage: Mapping[str, Sequence[Damage]] | None
    flanks: Mapping[str, Flank] | None
    misalignment: Misalignment | None
    supports: Mapping[str, Support | Shaft] | None
    face: str | None
    groove: float


def _as_mapping(case):
    """Return the arguments of `case` by name, and warn that the use of a case as a mapping is deprecated."""
    text = "a Case will not be a mapping in the next version: use case.as_dict(), or dataclasses.replace(case, ...)"
    warnings.warn(text, DeprecationWarning, stacklevel=3)
    return case.as_dict()


def _stated(given):
    """Return a read-only copy of values by gear without empty entries. The result is None if no entry remains."""
    return Frozen({name: value for name, value in given.items() if value}) if given and any(given.values()) else None


def case_of(pair: GearPair | Case, force: Any = None, material: Any = None, *, torque: Any = None, **given: Any) -> Case:
    """Return the `Case` for arguments such as those of `gearfe.mesh_stiffness`. A case may replace the pair."""
    if not isinstance(pair, Case):
        return Case(pair, force, material, torque=torque, **given)
    if force is not None or torque is not None:
        given |= {"force": force, "torque": torque}
    if material is not None:
        given |= {"material": material}
    return replace(pair, **given) if given else pair
