"""`ScenePair`: a gear pair of a scene, with its load, flanks, supports and damage by case."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..core.case import Case
from ..core.material import Material
from ..core.supports.shaft import Shaft
from ..core.supports.support import Support
from ..geometry.damage.kinds import Damage
from ..geometry.pair.flanks import Misalignment
from ..geometry.pair.gear_pair import GearPair
from ..geometry.tooth.modified import Flank
from . import parts


@dataclass(frozen=True, slots=True)
class ScenePair:
    """Gear pair of a scene with its materials, its force along the line of action [N], and its type of teeth.

    `owned` holds the damage of all bodies by case, side and `gearfe.scene.parts.Owner`. If a body has separate flanks,
    `owned_flanks` holds all flanks by side and body (None: every other body). `gearfe.mesh_stiffness` describes `flanks` (of the
    first body that is named), `misalignment` and `supports`.
    """

    pair: GearPair
    materials: tuple[Material, Material]
    force: float
    face: str | None = None
    groove: float = 0.0
    flanks: dict[str, Flank] = field(default_factory=dict)
    misalignment: Misalignment | None = None
    supports: dict[str, Support | Shaft] = field(default_factory=dict)
    owned: dict[str, dict[str, parts.Owned]] = field(default_factory=dict)
    owned_flanks: dict[str, dict[str | None, Flank]] = field(default_factory=dict)

    def flanks_at(self, bodies: Mapping[str, str | None]) -> dict[str, Flank]:
        """Return the flanks of the body on each side."""
        if not self.owned_flanks:
            return self.flanks
        found = {side: self.owned_flanks.get(side, {}) for side in parts.SIDES}
        chosen = {side: own.get(bodies.get(side), own.get(None)) for side, own in found.items()}
        return {side: flank for side, flank in chosen.items() if flank is not None}

    @property
    def damage(self) -> dict[str, dict[str, list[Damage]]]:
        """Return the damage by case and side as an argument of `gearfe.mesh_stiffness`, of one body on each side."""
        return {case: parts.of_one_body(by_side) for case, by_side in self.owned.items()}

    def case(self, name: str | None = None) -> Case:
        """Return the pair as a `Case` with a case of damage, or healthy if None. Raises ValueError for an unknown case."""
        if name is not None and name not in self.damage:
            raise ValueError(f"no case {name!r} of this pair; it has {', '.join(self.damage) or 'none'}")
        given = {own: getattr(self, own) or None for own in ("flanks", "misalignment", "supports", "face")}
        damage = None if name is None else self.damage[name]
        return Case(self.pair, self.force, self.materials, damage=damage, groove=self.groove, **given)
