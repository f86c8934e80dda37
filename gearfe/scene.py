"""Scenes: strict TOML descriptions of a machine's gears, pairs and loads. Units stand in the key names."""

import math
import tomllib
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path

from geometry.damage import Crack
from geometry.gear import Gear
from geometry.pair import GearPair
from geometry.pit import pit_row

from .material import Material

REQUIRED = object()
NUMBER, TEXT, WHOLE, TEXTS = "a number", "a text", "a whole number", "a list of texts"
TWO, TRUTH = "two numbers", "true or false"
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
    },
}
DAMAGE = {
    "crack": {
        "case": (TEXT, REQUIRED),
        "gear": (TEXT, REQUIRED),
        "level": (NUMBER, None),
        "length_mm": (NUMBER, None),
        "angle_deg": (NUMBER, 45.0),
        "start": (TEXT, "30deg"),
        "turning": (TRUTH, False),
        "tooth": (WHOLE, 0),
        "width_mm": (TWO, None),
        "ends": (TWO, [1.0, 1.0]),
    },
    "pits": {
        "case": (TEXT, REQUIRED),
        "gear": (TEXT, REQUIRED),
        "radius_mm": (NUMBER, REQUIRED),
        "count": (WHOLE, 1),
        "first_mm": (NUMBER, REQUIRED),
        "last_mm": (NUMBER, None),
        "axes_mm": (TWO, REQUIRED),
        "depth_mm": (NUMBER, REQUIRED),
        "angle_deg": (NUMBER, 0.0),
        "tooth": (WHOLE, 0),
    },
}
MACHINE = {
    "model": (TEXT, REQUIRED),
    "speed_rpm": (NUMBER, REQUIRED),
    "torque_Nm": (NUMBER, REQUIRED),
    "n_planets": (WHOLE, 3),
}
ASSUMPTION = {"what": (TEXT, REQUIRED), "why": (TEXT, REQUIRED)}


@dataclass(frozen=True, slots=True)
class ScenePair:
    """A gear pair of a scene with its materials, its force along the line of action [N], and how its teeth run.

    `damage` holds by case what `gearfe.mesh_stiffness` takes as damage.
    """

    pair: GearPair
    materials: tuple
    force: float
    face: str | None = None
    groove: float = 0.0
    damage: dict = field(default_factory=dict)

    def case(self, name=None):
        """Keyword arguments of `gearfe.mesh_stiffness` for a case of damage; None: healthy.

        Raises
        ------
        ValueError
            If there is no such case of this pair.
        """
        if name is not None and name not in self.damage:
            raise ValueError(f"no case {name!r} of this pair; it has {', '.join(self.damage) or 'none'}")
        out = {"pair": self.pair, "force": self.force, "material": self.materials, "face": self.face, "groove": self.groove}
        return out if name is None else out | {"damage": self.damage[name]}


@dataclass(frozen=True, slots=True)
class Scene:
    """A machine: `gears` and `pairs` by name, what had to be assumed, and what `gearfe.scene_machine` needs to run it."""

    name: str
    title: str
    source: str
    gears: dict
    pairs: dict
    assumptions: tuple
    later: tuple
    machine: dict = field(default_factory=dict)

    def pair(self, name=None):
        """The pair called `name`; the first one if None.

        Raises
        ------
        ValueError
            If there is no such pair.
        """
        if name is None:
            return next(iter(self.pairs.values()))
        if name not in self.pairs:
            raise ValueError(f"scene {self.name} has no pair {name!r}; it has {', '.join(self.pairs)}")
        return self.pairs[name]


def scene_names():
    """Names of the built-in scenes."""
    return sorted(f.name.removesuffix(".toml") for f in resources.files("gearfe.scenes").iterdir() if f.name.endswith(".toml"))


def load_scene(name_or_path):
    """Read a built-in scene by name, or a scene file by path.

    Raises
    ------
    ValueError
        Naming file, table and key if anything is unknown, missing, or of the wrong type, or if a gear or pair cannot be.
    """
    if isinstance(name_or_path, str) and name_or_path in scene_names():
        file = resources.files("gearfe.scenes") / f"{name_or_path}.toml"
    else:
        file = Path(name_or_path)
        if not file.is_file():
            raise ValueError(f"no scene {str(name_or_path)!r}: built in are {', '.join(scene_names())}; or give a .toml file")
    try:
        data = tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ValueError(f"{file.name}: not readable as TOML: {error}") from error
    return _scene(file.name, data)


def _scene(file, data):
    tables = {name: data.pop(name, {}) for name in (*TABLES, "assumption")}
    damage = {kind: data.pop(kind, []) for kind in DAMAGE}
    run = _table(file, "machine", data.pop("machine"), MACHINE) if "machine" in data else {}
    top = _table(file, "top level", data, TOP, extra=(*TABLES, *DAMAGE, "machine", "assumption"))
    for name in ("gear", "pair", "material"):
        if not isinstance(tables[name], dict) or not tables[name]:
            raise ValueError(f"{file}: no table [{name}.NAME]; a scene needs at least one")
    if not isinstance(tables["assumption"], list):
        raise ValueError(f"{file}: assumptions are written as [[assumption]] tables")
    rows = {
        kind: {name: _table(file, f"{kind}.{name}", table, TABLES[kind]) for name, table in tables[kind].items()}
        for kind in TABLES
    }
    materials = {
        n: _made(file, f"material.{n}", lambda r=r: Material(E=r["E_MPa"], nu=r["nu"])) for n, r in rows["material"].items()
    }
    gears = {n: _made(file, f"gear.{n}", lambda r=r: _gear(r)) for n, r in rows["gear"].items()}
    for name, row in rows["gear"].items():
        _known(file, f"gear.{name}", "material", row["material"], materials, "material")
    pairs = {}
    for name, row in rows["pair"].items():
        where = f"pair.{name}"
        for key in ("gear_1", "gear_2"):
            _known(file, where, key, row[key], gears, "gear")
        made = _made(file, where, lambda r=row: GearPair(gears[r["gear_1"]], gears[r["gear_2"]], r["a_mm"]))
        used = tuple(materials[rows["gear"][row[key]]["material"]] for key in ("gear_1", "gear_2"))
        if not row["force_N"] > 0:
            raise ValueError(f"{file} [{where}] force_N = {row['force_N']}: a mesh is pressed together; give force_N > 0")
        found = _cases(file, damage, gears, row)
        pairs[name] = ScenePair(made, used, float(row["force_N"]), row["face"], float(row["groove_mm"]), found)
    notes = tuple(_table(file, f"assumption {i + 1}", a, ASSUMPTION) for i, a in enumerate(tables["assumption"]))
    return Scene(file.removesuffix(".toml"), top["title"], top["source"], gears, pairs, notes, tuple(top["later"]), run)


def _cases(file, damage, gears, pair):
    """Damage of a pair by case, from the scene's [[crack]] and [[pits]] tables."""
    out = {}
    for kind, tables in damage.items():
        if not isinstance(tables, list):
            raise ValueError(f"{file}: damage is written as [[{kind}]] tables")
        for i, table in enumerate(tables):
            where = f"{kind} {i + 1}"
            row = _table(file, where, table, DAMAGE[kind])
            _known(file, where, "gear", row["gear"], gears, "gear")
            made = _made(file, where, lambda r=row, k=kind: _crack(r) if k == "crack" else _pits(r))
            for side, key in (("pinion", "gear_1"), ("wheel", "gear_2")):
                if pair[key] == row["gear"]:
                    out.setdefault(row["case"], {}).setdefault(side, []).extend(made)
    return out


def _crack(row):
    numbers = {"level": row["level"], "length": row["length_mm"], "angle": math.radians(row["angle_deg"])}
    return [Crack(**numbers, width=row["width_mm"], **{key: row[key] for key in ("start", "turning", "tooth", "ends")})]


def _pits(row):
    numbers = {"radius": row["radius_mm"], "axes": tuple(row["axes_mm"]), "depth": row["depth_mm"], "tooth": row["tooth"]}
    last = row["first_mm"] if row["last_mm"] is None else row["last_mm"]
    return list(pit_row(row["count"], row["first_mm"], last, angle=math.radians(row["angle_deg"]), **numbers))


def _gear(row):
    if (row["r_bore_mm"] is None) == (row["r_rim_mm"] is None):
        raise ValueError("give r_bore_mm (an external gear) or r_rim_mm (a ring), one of them, a number in mm")
    plain = {key: row[key] for key in ("z", "x", "addendum", "dedendum", "tip_radius", "z_cutter")}
    lengths = {key: row[f"{key}_mm"] for key in ("m_n", "b", "r_bore", "r_rim")}
    angles = {key: math.radians(row[f"{key}_deg"]) for key in ("alpha_n", "beta")}
    return Gear(**plain, **lengths, **angles)


def _table(file, where, table, keys, extra=()):
    """Check one table against its keys and fill in defaults."""
    if not isinstance(table, dict):
        raise ValueError(f"{file} [{where}]: expected a table, got {table!r}")
    out = {}
    for key in table:
        if key not in keys:
            raise ValueError(f"{file} [{where}]: unknown key {key!r}; expected {', '.join((*keys, *extra))}")
    for key, (kind, default) in keys.items():
        if key not in table:
            if default is REQUIRED:
                raise ValueError(f"{file} [{where}]: missing key {key!r}; expected {kind}{_unit(key)}")
            out[key] = default
            continue
        if not _fits(table[key], kind):
            raise ValueError(f"{file} [{where}] {key} = {table[key]!r}: expected {kind}{_unit(key)}")
        out[key] = table[key]
    return out


def _unit(key):
    units = {"mm": "mm", "deg": "degrees", "N": "N", "MPa": "MPa"}
    end = key.rpartition("_")[2]
    return f" in {units[end]}" if end in units and "_" in key else ""


def _fits(value, kind):
    if kind == TEXT:
        return isinstance(value, str)
    if kind == TRUTH:
        return isinstance(value, bool)
    if kind == TWO:
        return isinstance(value, list) and len(value) == 2 and all(_fits(v, NUMBER) for v in value)
    if kind == TEXTS:
        return isinstance(value, list) and all(isinstance(v, str) for v in value)
    if isinstance(value, bool):
        return False
    if kind == WHOLE:
        return isinstance(value, int)
    return isinstance(value, (int, float)) and math.isfinite(value)


def _known(file, where, key, name, known, kind):
    if name not in known:
        raise ValueError(f"{file} [{where}] {key} = {name!r}: no such {kind}; there is {', '.join(known)}")


def _made(file, where, make):
    try:
        return make()
    except ValueError as error:
        raise ValueError(f"{file} [{where}]: {error}") from error
