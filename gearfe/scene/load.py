"""Scenes: strict TOML descriptions of a machine's gears, pairs and loads. Units stand in the key names."""

import math
import os
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any

from ..core.case import Case
from ..core.material import Material
from ..core.supports.shaft import Shaft
from ..core.supports.support import Support
from ..geometry.damage.kinds import Damage
from ..geometry.pair.flanks import Misalignment
from ..geometry.pair.gear_pair import GearPair
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.modified import Flank
from . import assumed, damage_tables, strict
from .damage_tables import DAMAGE
from .flank_table import FLANK, MISALIGNMENT, flanks_of, misalignment_of
from .machine_table import checked_machine
from .references import Reference, read_references
from .set_table import NAMES, SceneSet, checked_set, set_of
from .strict import NUMBER, REQUIRED, TEXT, TEXTS, VALUES, WHOLE, checked, known, placed, sides
from .support_table import SUPPORTS, supports_of
from .toml_file import read_toml

TOP = {"title": (TEXT, REQUIRED), "source": (TEXT, REQUIRED), "later": (TEXTS, [])}
TABLES = {
    "material": {"E_MPa": (NUMBER, REQUIRED), "nu": (NUMBER, REQUIRED)},
    "gear": {
        "z": (WHOLE, REQUIRED),
        "m_n_mm": (NUMBER, REQUIRED),
        "alpha_n_deg": (NUMBER, REQUIRED),
        "b_mm": (NUMBER, REQUIRED),
        "material": (TEXT, REQUIRED),
        "r_bore_mm": (NUMBER, None),
        "r_rim_mm": (NUMBER, None),
        "z_cutter": (WHOLE, 20),
        "beta_deg": (NUMBER, 0.0),
        "x": (NUMBER, 0.0),
        "addendum": (NUMBER, 1.0),
        "dedendum": (NUMBER, 1.25),
        "tip_radius": (NUMBER, 0.38),
    },
    "pair": {
        "gear_1": (TEXT, REQUIRED),
        "gear_2": (TEXT, REQUIRED),
        "force_N": (NUMBER, REQUIRED),
        "a_mm": (NUMBER, None),
        "face": (TEXT, None),
        "groove_mm": (NUMBER, 0.0),
        **MISALIGNMENT,
    },
    "flank": FLANK,
    **SUPPORTS,
}
ASSUMPTION = {"what": (TEXT, REQUIRED), "why": (TEXT, REQUIRED), "depends": (TEXT, ""), "holds": (VALUES, {})}


@dataclass(frozen=True, slots=True)
class ScenePair:
    """A gear pair of a scene with its materials, its force along the line of action [N], and how its teeth run.

    `damage` holds by case what `gearfe.mesh_stiffness` takes as damage; `flanks`, `misalignment`, `supports` are as it has them.
    """

    pair: GearPair
    materials: tuple[Material, Material]
    force: float
    face: str | None = None
    groove: float = 0.0
    damage: dict[str, dict[str, list[Damage]]] = field(default_factory=dict)
    flanks: dict[str, Flank] = field(default_factory=dict)
    misalignment: Misalignment | None = None
    supports: dict[str, Support | Shaft] = field(default_factory=dict)

    def case(self, name: str | None = None) -> Case:
        """The pair as it is solved, in a case of damage; None: healthy. ValueError if there is no such case of this pair."""
        if name is not None and name not in self.damage:
            raise ValueError(f"no case {name!r} of this pair; it has {', '.join(self.damage) or 'none'}")
        given = {own: getattr(self, own) or None for own in ("flanks", "misalignment", "supports", "face")}
        damage = None if name is None else self.damage[name]
        return Case(self.pair, self.force, self.materials, damage=damage, groove=self.groove, **given)


@dataclass(frozen=True, slots=True)
class Scene:
    """A machine: `gears` and `pairs` by name, what had to be assumed, and what `machine.of_scene` needs to run it.

    `references` are what its sources print, `gearfe.scene.references.Reference`; none in a copy whose given values were changed.
    `changed` says which values are no longer those of the original (see `gearfe.scene.assumed`).
    """

    name: str
    title: str
    source: str
    gears: dict[str, Gear]
    pairs: dict[str, ScenePair]
    assumptions: tuple[dict[str, Any], ...]
    later: tuple[str, ...]
    machine: dict[str, Any] = field(default_factory=dict)
    references: tuple[Reference, ...] = ()
    changed: tuple[str, ...] = ()
    set: SceneSet | None = None  # a whole planetary set, `gearfe.planetary_sets.of_scene.build_set` gives its case

    def pair(self, name: str | None = None) -> ScenePair:
        """The pair called `name`; the first one if None. ValueError if there is no such pair."""
        if name is None:
            return next(iter(self.pairs.values()))
        if name not in self.pairs:
            raise ValueError(f"scene {self.name} has no pair {name!r}; it has {', '.join(self.pairs)}")
        return self.pairs[name]

    def case(self, pair: str | None = None, case: str | None = None) -> Case:
        """`Case` of a pair by name (None: the first), in a case of damage (None: healthy), as `gearfe.solve` takes it.

        ValueError if there is no such pair or case.
        """
        return self.pair(pair).case(case)


def scene_names() -> list[str]:
    """Names of the built-in scenes."""
    return sorted(
        f.name.removesuffix(".toml") for f in resources.files("gearfe.scene.scenes").iterdir() if f.name.endswith(".toml")
    )


def load_scene(name_or_path: str | os.PathLike[str]) -> Scene:
    """Read a built-in scene by name, or a scene file by path.

    Raises
    ------
    ValueError
        Naming file, table and key if anything is unknown, missing, or of the wrong type, or if a gear or pair cannot be.
    """
    return scene_of(*read_tables(name_or_path))


def read_tables(name_or_path: str | os.PathLike[str]) -> tuple[str, dict[str, Any]]:
    """Name and unchecked tables of a scene's file, as `scene_of` takes them."""
    if isinstance(name_or_path, str) and name_or_path in scene_names():
        file = resources.files("gearfe.scene.scenes") / f"{name_or_path}.toml"
    else:
        file = Path(name_or_path)
        if not file.is_file():
            raise ValueError(f"no scene {str(name_or_path)!r}: built in are {', '.join(scene_names())}; or give a .toml file")
    return file.name, read_toml(file)


def scene_of(file: str, data: dict[str, Any]) -> Scene:
    """Scene of the tables that a file of that name holds; the messages of its errors begin with the name."""
    data = dict(data)
    tables = {name: data.pop(name, {}) for name in TABLES}
    told, given = data.pop("assumption", []), data.pop("given", {})
    damage = {kind: data.pop(kind, []) for kind in DAMAGE}
    run = checked_machine(file, data.pop("machine")) if "machine" in data else {}
    printed = data.pop("reference", [])
    whole = checked_set(file, {name: data.pop(name) for name in NAMES if name in data})
    top = checked(file, "top level", data, TOP, extra=(*TABLES, *DAMAGE, *NAMES, "machine", "assumption", "given", "reference"))
    for kind, named in tables.items():
        strict.named_tables(file, kind, named)
        if not named and kind in ("gear", "pair", "material"):
            raise ValueError(f"{file}: no table [{kind}.NAME]; a scene needs at least one")
    for kind, listed in {**damage, "assumption": told, "reference": printed}.items():
        strict.listed_tables(file, kind, listed)
    if not isinstance(given, dict):
        raise ValueError(f'{file}: [given] is a table of values by dotted key, such as "gear.sun.z" = 21')
    rows = {
        kind: {name: checked(file, f"{kind}.{name}", table, TABLES[kind]) for name, table in tables[kind].items()}
        for kind in TABLES
    }
    materials = {
        n: placed(file, f"material.{n}", lambda r=r: Material(E=r["E_MPa"], nu=r["nu"])) for n, r in rows["material"].items()
    }
    gears = {n: placed(file, f"gear.{n}", lambda r=r: _gear(r)) for n, r in rows["gear"].items()}
    for name, row in rows["gear"].items():
        known(file, f"gear.{name}", "material", row["material"], materials, "material")
    pairs = {name: _pair(file, name, rows, damage, gears, materials) for name in rows["pair"]}
    notes = [checked(file, f"assumption {i + 1}", note, ASSUMPTION) for i, note in enumerate(told)]
    cases = {kind: _by_case(checked(file, kind, table, DAMAGE[kind]) for table in listed) for kind, listed in damage.items()}
    kept, changed, own = assumed.split(file, notes, given, rows | cases | {"machine": run} | whole)
    title, source = top["title"], top["source"]
    if own:
        title, source = f"{title}, changed", f"own scene; changed from: {source}"
    references = () if own else read_references(file, printed, pairs)
    made = set_of(file, whole, pairs, rows["pair"])
    return Scene(
        file.removesuffix(".toml"), title, source, gears, pairs, kept, tuple(top["later"]), run, references, changed, made
    )


def _pair(file, name, rows, damage, gears, materials):
    """`ScenePair` of the checked tables of a scene."""
    row, where = rows["pair"][name], f"pair.{name}"
    for key in ("gear_1", "gear_2"):
        known(file, where, key, row[key], gears, "gear")
    made = placed(file, where, lambda: GearPair(gears[row["gear_1"]], gears[row["gear_2"]], row["a_mm"]))
    if not row["force_N"] > 0:
        raise ValueError(f"{file} [{where}] force_N = {row['force_N']}: a mesh is pressed together; give force_N > 0")
    return ScenePair(
        made,
        materials=tuple(materials[rows["gear"][row[key]]["material"]] for key in ("gear_1", "gear_2")),
        force=float(row["force_N"]),
        face=row["face"],
        groove=float(row["groove_mm"]),
        damage=_cases(file, damage, gears, name, rows["pair"], made),
        flanks=flanks_of(file, rows["flank"], name, rows["pair"], gears),
        misalignment=misalignment_of(file, where, made, row),
        supports=supports_of(file, rows, name, rows["pair"], materials),
    )


def _by_case(tables):
    """Damage tables by case."""
    out = {}
    for table in tables:
        out.setdefault(table["case"], []).append(table)
    return out


def _cases(file, damage, gears, name, pairs, made):
    """Damage of the pair `name` by case, from the scene's tables of damage.

    Damage of a gear is in all its pairs, or only in its `pair`: a planet meets the sun with one flank, the ring with the other.
    """
    out = {}
    for kind, tables in damage.items():
        for i, table in enumerate(tables):
            where = f"{kind} {i + 1}"
            row = checked(file, where, table, DAMAGE[kind])
            for side in sides(file, where, row, name, pairs, gears):
                which, make = ("pinion", "wheel").index(side), damage_tables.TABLES[kind].made
                found = placed(file, where, lambda r=row, n=which, make=make: make(r, made, n, pairs[name]))
                out.setdefault(row["case"], {}).setdefault(side, []).extend(found)
    return out


def _gear(row):
    if (row["r_bore_mm"] is None) == (row["r_rim_mm"] is None):
        raise ValueError("give r_bore_mm (an external gear) or r_rim_mm (a ring), one of them, a number in mm")
    plain = {key: row[key] for key in ("z", "x", "addendum", "dedendum", "tip_radius", "z_cutter")}
    lengths = {key: row[f"{key}_mm"] for key in ("m_n", "b", "r_bore", "r_rim")}
    angles = {key: math.radians(row[f"{key}_deg"]) for key in ("alpha_n", "beta")}
    return Gear(**plain, **lengths, **angles)
