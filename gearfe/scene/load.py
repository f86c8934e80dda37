"""Scenes: strict TOML descriptions of gears, pairs, loads and machines. Key names contain the units."""

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from html import escape
from pathlib import Path
from typing import Any

from ..core.case import Case, check_load
from ..core.file_readers import check_path
from ..core.material import Material
from ..core.record import check_named
from ..core.table import Column, Table
from ..geometry.aliases import StrPath
from ..geometry.damage.kinds import Damage
from ..geometry.pair.gear_pair import GearPair
from ..geometry.tooth.gear import Gear
from . import assumed, parts
from .dotted_keys import find_key, set_values
from .reading import Reading, located
from .references import Reference, read_references
from .scene_pair import ScenePair
from .schema import arguments, scene_schema
from .sensor_file import with_frf
from .set_table import SceneSet, set_of
from .toml_file import read_toml
from .train import Train
from .train_tables import train_of

SCENES = Path(__file__).with_name("scenes")  # folder of the built-in scenes


@dataclass(frozen=True, slots=True)
class Scene:
    """Machine: `gears` and `pairs` by name, assumptions, and the inputs of its dynamic model.

    `references` are printed values of its sources, `gearfe.scene.references.Reference`; none in a copy with changed values.
    `changed` lists the values that differ from the original (see `gearfe.scene.assumed`).
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
    set: SceneSet | None = None  # a whole planetary set, converted by `gearfe.planetary_sets.of_scene.build_set`
    train: Train | None = None  # gearbox shafts with their speeds and torques
    sensors: dict[str, dict[str, Any]] = field(default_factory=dict)  # checked rows by name

    def __post_init__(self) -> None:
        """Raise ValueError if speeds, torques, forces or gears are inconsistent with the values that follow from the file."""
        if self.train is not None:
            motor, machine = self.train.ends["motor"]["shaft"], self.machine
            given = [machine["speed_rpm"] * math.pi / 30, machine["torque_Nm"], *(one.force for one in self.pairs.values())]
            forces = [self.train.forces.get(name) for name in self.pairs]
            self._check("speed, torque or force", given, [self.train.speeds[motor], self.train.torques["motor"], *forces])
        if self.set is not None:
            outer, inner = (self.pair(name).pair for name in self.set.pairs)
            one, two = self.set.gears.sun_planet, self.set.gears.planet_ring
            self._check("gear of the set", [outer.gear_1, outer.gear_2, inner.gear_2], [one.gear_1, one.gear_2, two.gear_2])

    def _check(self, what, given, derived):
        for one, other in zip(given, derived, strict=True):
            if one != other and not (isinstance(other, (int, float)) and math.isclose(one, other, rel_tol=1e-9)):
                raise ValueError(
                    f"scene {self.name}: a {what} was replaced, but other values were computed from the former one: give it with "
                    "load_scene(..., values={...})"
                )

    def __repr__(self) -> str:
        """Name, title, pairs and cases in one line."""
        return (
            f"<Scene {self.name}: {self.title}; pairs {', '.join(self.pairs)}; cases {', '.join(sorted(self.cases)) or 'none'}>"
        )

    def _repr_html_(self) -> str:
        """Title and a table of the pairs, which notebooks display."""
        columns = ["pair", "teeth", Column("module", "mm"), Column("width", "mm"), Column("force", "N"), "cases of damage"]
        rows = [
            [name, f"{one.gear_1.z} / {one.gear_2.z}", one.gear_1.m_n, one.b_w, chosen.force,
             ", ".join(chosen.damage)] for name, chosen in self.pairs.items() for one in (chosen.pair,)
        ]  # fmt: skip
        return f"<p>{escape(self.title)}</p>{Table(columns, rows).html()}"

    def pair(self, name: str | None = None) -> ScenePair:
        """Return the pair called `name`, or the first one if None. Raises ValueError if there is no such pair."""
        if name is None:
            return next(iter(self.pairs.values()))
        if name not in self.pairs:
            raise ValueError(f"scene {self.name} has no pair {name!r}; it has {', '.join(self.pairs)}")
        return self.pairs[name]

    def with_damage(self, case: str, damage: Mapping[str, Mapping[str, Sequence[Damage]]]) -> "Scene":
        """Return a copy of the scene with a case of damage by pair and side.

        The case has no other damage. ValueError if a pair or side is unknown.
        """
        for name, by_side in damage.items():
            self.pair(name)
            for side in by_side:
                check_named("side", side, parts.SIDES)
        pairs = {}
        for name, pair in self.pairs.items():
            given = damage.get(name, {}).items()
            owned: dict[str, parts.Owned] = {side: {parts.Owner(None, name, side): list(found)} for side, found in given if found}
            others = {other: found for other, found in pair.owned.items() if other != case}
            pairs[name] = replace(pair, owned=others | ({case: owned} if owned else {}))
        return replace(self, pairs=pairs)

    def case(self, pair: str | None = None, case: str | None = None) -> Case:
        """Return the `Case` of a pair (None: first pair) in a damage case (None: healthy), for `gearfe.solve`.

        ValueError if there is no such pair or case.
        """
        chosen = self.pair(pair)
        found = chosen.case(case)
        for side, own in chosen.owned_flanks.items():
            if len(own) > 1:
                shown, *rest = sorted(own, key=lambda body: body is None)
                names = ", ".join(body or "the other bodies" for body in rest)
                warnings.warn(
                    f"the {side} has the flanks of {shown}, and not those of {names}: a pair has one body on each side; the "
                    "machine and the set have all of them",
                    stacklevel=2,
                )
        if case and (left := parts.other_bodies(chosen.owned[case])):
            warnings.warn(
                f"case {case!r} also damages {', '.join(left)}: a pair has one body on each side; the machine has all of them",
                stacklevel=2,
            )
        return found

    @property
    def cases(self) -> tuple[str, ...]:
        """Names of the cases of damage of all pairs."""
        return tuple(dict.fromkeys(name for pair in self.pairs.values() for name in pair.damage))

    def check_case(self, case: str | None) -> None:
        """Raise ValueError if no pair has the case of damage `case`. None (healthy) is always valid."""
        if case is not None and case not in self.cases:
            raise ValueError(f"scene {self.name} has no case {case!r}; it has {', '.join(sorted(self.cases)) or 'none'}")


def scene_names() -> list[str]:
    """Names of the built-in scenes."""
    return sorted(file.stem for file in SCENES.glob("*.toml"))


def load_scene(name_or_path: StrPath, values: Mapping[str, Any] | None = None) -> Scene:
    """Read a built-in scene by name, or a scene file by path.

    Parameters
    ----------
    name_or_path : str or path
    values : dict, optional
        Other values by dotted key, such as ``{"gear.pinion.r_bore_mm": 8.0, "machine.speed_rpm": 1200}``.

    Raises
    ------
    ValueError
        With file, table and key, if anything is unknown, missing or of the wrong type, or if a gear or pair is impossible.
    """
    file, tables = read_tables(name_or_path)
    for key in values or {}:
        find_key(key, tables)
    return scene_of(file, set_values(tables, values) if values else tables)


def _no_scene(name):
    """Return the error message for a scene that does not exist."""
    if name.endswith(".toml"):
        kind = "not a file" if Path(name).exists() else "no such file"
        return f"{name}: {kind}; give the path of a .toml file, or a built-in scene: {', '.join(scene_names())}"
    near = get_close_matches(name, scene_names(), 1)
    nearest = f" (nearest: {near[0]})" if near else ""
    return f"no scene {name!r}{nearest}: built in are {', '.join(scene_names())}; or give a .toml file"


def read_tables(name_or_path: StrPath) -> tuple[str, dict[str, Any]]:
    """Return name and unchecked tables of a scene file, as input of `scene_of`."""
    if isinstance(name_or_path, str) and name_or_path in scene_names():
        file = SCENES / f"{name_or_path}.toml"
    else:
        check_path("scene", name_or_path)
        file = Path(name_or_path)
        if not file.is_file():
            raise ValueError(_no_scene(str(name_or_path)))
    return file.name, with_frf(file, read_toml(file))


def scene_of(file: str, data: dict[str, Any]) -> Scene:
    """Build the scene from the tables of a file. Error messages begin with the name of the file."""
    reading = Reading(file, scene_schema())
    rows = reading.row("scene", "top level", data)
    reading.check_references(rows)
    materials: dict[str, Material] = {}
    gears: dict[str, Gear] = {}
    makers: tuple[tuple[str, Any, dict[str, Any]], ...] = (("material", Material, materials), ("gear", _gear, gears))
    for kind, make, out in makers:
        for name, row in rows[kind].items():
            with located(file, f"{kind}.{name}", row):
                out[name] = make(**arguments(kind, row))
    train = train_of(file, rows, gears, materials)
    pairs = {name: _pair(file, name, rows, gears, materials, train.forces if train else {}) for name in rows["pair"]}
    made = set_of(file, rows, pairs)
    for name in (name for name, row in rows["sensor"].items() if row["frf"] is not None):
        raise ValueError(
            f"{file} [sensor.{name}] frf: this file is read with a scene file only; give frf_Hz, frf_real and frf_imag"
        )
    run = dict(rows["machine"] or {})
    if run:
        run["bodies"] = {name: (float(body["mass_kg"]), float(body["inertia_kgm2"])) for name, body in run["bodies"].items()}
    cases = parts.cases_of(file, rows)
    kept, changed, own = assumed.split(file, rows["assumption"], rows["given"], rows | cases)
    title, source = rows["title"], rows["source"]
    if own:
        title, source = f"{title}, changed", f"own scene; changed from: {source}"
    return Scene(
        file.removesuffix(".toml"), title, source, gears, pairs, kept, tuple(rows["later"]),
        machine=run, references=() if own else read_references(file, rows["reference"]), changed=changed, set=made, train=train,
        sensors=rows["sensor"],
    )  # fmt: skip


def _gear(x_E: float | None = None, **given: Any) -> Gear:
    """Build a gear from its row. A generating profile shift determines its tooth thickness allowance."""
    gear = Gear(**given)
    if x_E is None:
        return gear
    return replace(gear, E_sn=gear.outward * (x_E - gear.x) * 2 * gear.m_n * math.tan(gear.alpha_n))


def _pair(file, name, rows, gears, materials, forces):
    """Return the `ScenePair` of the checked tables of a scene. `forces` are those of the pairs of a gearbox [N]."""
    row = rows["pair"][name]
    names = row["gear_1"], row["gear_2"]
    torque = row["torque_Nm"]
    force = row["force_N"] or (1e3 * torque / gears[names[0]].r_b if torque else forces.get(name))
    if force is None:
        raise ValueError(f"{file} [pair.{name}]: missing key 'force_N' or 'torque_Nm'; expected a number in N or N m")
    used = materials[rows["gear"][names[0]]["material"]], materials[rows["gear"][names[1]]["material"]]
    with located(file, f"pair.{name}", row):
        for key in ("m_n_mm", "alpha_n_deg", "beta_deg"):
            one, two = (rows["gear"][gear][key] for gear in names)
            if not math.isclose(abs(one), abs(two), rel_tol=1e-9, abs_tol=1e-9):
                raise ValueError(f"{key} = {one:g} of {names[0]!r} and {two:g} of {names[1]!r}, but gears in mesh need the same")
        made = GearPair(*(gears[gear] for gear in names), row["a_mm"])
        if row["backlash_um"] is not None:
            made = parts.with_backlash(made, 1e-3 * row["backlash_um"])
        check_load(made, force, used)
        misalignment = parts.misalignment_of(made, row)
    owned = parts.damage_of(file, rows, name, made)
    flanks = parts.flanks_of(file, rows, name, gears)
    return ScenePair(
        made,
        materials=used,
        force=float(force),
        face=row["face"],
        groove=float(row["groove_mm"]),
        owned=owned,
        flanks={side: next((one for body, one in own.items() if body), own.get(None)) for side, own in flanks.items()},
        owned_flanks=flanks if any(any(own) for own in flanks.values()) else {},
        misalignment=misalignment,
        supports=parts.supports_of(file, rows, name, materials),
    )
