"""Study: a scene, its variables, and the requested results. The format is a strict TOML file or an equal dictionary.

::

    title = "cracks under load"
    scene = "my.toml"                     # or the name of a built-in scene
    kind = "stiffness"                    # or "transmission error", "growth", "set", "vibration"
    pair = "stage"                        # default: the scene's first
    case = "cracked"                      # default: healthy
    seed = 1

    [options]                             # of the kind, see `gearfe.runs.sweeps.kinds`
    phases = 64

    [vary]                                # every combination of these, by dotted key of the scene
    "crack.cracked.level" = [0.1, 0.2, 0.3]
    "pair.stage.force_N" = { from = 500, to = 4000, count = 8, spacing = "log" }

    [[along]]                             # lists that go together, one more axis
    "gear.pinion.r_bore_mm" = [8.0, 10.0]
    "gear.wheel.r_bore_mm" = [12.0, 15.0]

    [sample]                              # drawn once: every draw meets every combination
    method = "sobol"                      # or "random", "latin", "saltelli" (for Sobol indices)
    count = 256
    [sample.of]
    "gear.pinion.x" = { normal = [0.0, 0.01], within = [-0.03, 0.03] }
    "material.steel.E_MPa" = { uniform = [200e3, 212e3] }
    [[sample.correlated]]
    between = ["gear.pinion.x", "material.steel.E_MPa"]
    value = 0.3

Tables ``[[crack]]``, ``[[pits]]`` and ``[flank.NAME]`` in it are added to the scene's. ``also = ["KEY", ...]`` in a value's table
gives other keys the same value.
"""

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...geometry.aliases import StrPath
from ...scene.dotted_keys import check_key
from ...scene.load import scene_of
from ...scene.parts import DAMAGE
from ...scene.reading import check_listed, check_named, check_no_scene, checked
from ...scene.study_tables import is_gearbox, tables_near, trimmed
from ...scene.toml_file import given_tables
from . import samples
from .axes import MOST, RUNS, axes, checked_sample
from .kinds import KINDS

ADDED = (*DAMAGE, "flank")


@dataclass(frozen=True, slots=True)
class Study:
    """Checked definition of a parameter study."""

    title: str
    kind: str
    pair: str
    case: str  # damage case, or "healthy"
    name: str  # name of the scene's file
    tables: dict[str, Any]  # tables of the scene and of the study
    options: dict[str, Any]  # options of the type of study with defaults
    axes: tuple[dict[str, list], ...]  # axes of the grid: by key, lists of equal length
    sample: dict[str, Any]  # table ``[sample]``; empty: none
    seed: int  # seed of the sample
    block: int  # cases per shard
    keys: tuple[str, ...] = ()  # all varied keys

    def content(self) -> dict[str, Any]:
        """All values that determine the results, as JSON. Two studies are equal if these values are equal."""
        names = ("kind", "pair", "case", "tables", "options", "axes", "sample", "seed", "block")
        return json.loads(json.dumps({name: getattr(self, name) for name in names}, default=str))


def read_study(study: StrPath | Mapping[str, Any]) -> Study:
    """Check a study, a TOML file or a dictionary of the same structure.

    Raises
    ------
    ValueError
        Naming file, table and key if anything is unknown, missing, of the wrong type or contradicts the rest.
    """
    return _study(*given_tables(study, "study"))


def _study(file, place, data):
    for kind in DAMAGE:
        check_listed(file, kind, data.get(kind, []))
    check_named(file, "flank", data.get("flank", {}))
    check_no_scene(file, "study", data)
    top = checked(RUNS, "study", file, "top level", data)
    kind = KINDS[top["kind"]]
    name, tables = _scene(file, place, top["scene"], {name: top[name] for name in ADDED if top[name]})
    pair = top["pair"] or next(iter(tables["pair"]))
    options = checked(RUNS, kind.options, file, "options", top["options"])
    grid = tuple(axes(file, top["vary"], top["along"]))
    sample = checked_sample(file, top["sample"])
    if (cases := count_of(grid, sample)) > MOST:
        raise ValueError(f"{file}: {cases} cases, but a study has at most {MOST:.0e}: vary fewer values, or split the study")
    keys = inputs_of(grid, sample)
    for key in keys:
        try:
            check_key(key, tables, options)
        except ValueError as error:
            raise ValueError(f"{file}: {error}") from error
        if keys.count(key) > 1:
            raise ValueError(f"{file}: {key!r} varies twice; leave one out")
    _check_names(file, tables, pair if "pair" not in keys else None, top["case"] if "case" not in keys else None)
    copied = {entry: top[entry] for entry in ("title", "kind", "case", "seed")}
    return Study(
        **copied, pair=pair, name=name, tables=tables, options=options, axes=grid, sample=sample, keys=keys,
        block=top["block"] or kind.block,
    )  # fmt: skip


def _scene(file, place, scene, added):
    """Return name and tables of the scene, combined with those of the study and checked."""
    name, tables = tables_near(place, scene)
    for kind, extra in added.items():
        tables[kind] = tables.get(kind, {}) | extra if kind == "flank" else tables.get(kind, []) + extra
    scene_of(f"{name} with {file}" if added else name, tables)
    return name, tables


def _check_names(file, tables, pair, case):
    if pair is not None and pair not in tables["pair"]:
        raise ValueError(f"{file} pair = {pair!r}: no such pair; there is {', '.join(tables['pair'])}")
    cases = {row["case"] for kind in DAMAGE for row in tables.get(kind, [])}
    if case not in (None, "healthy", *cases):
        raise ValueError(f"{file} case = {case!r}: no such case; there is healthy, {', '.join(sorted(cases))}")


def inputs_of(grid: Iterable[Mapping[str, Any]], sample: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the keys that vary in a grid and a sample, including keys that copy the values of another key."""
    drawn = [key for name, spec in sample.get("of", {}).items() for key in (name, *spec.get("also", []))]
    return (*(key for axis in grid for key in axis), *drawn)


def count_of(grid: Iterable[Mapping[str, Any]], sample: Mapping[str, Any]) -> int:
    """Return the number of cases: each draw of the sample meets each combination of the grid."""
    combinations = math.prod(len(next(iter(axis.values()))) for axis in grid)
    draws = sample.get("count", 1) * (len(sample["of"]) + 2 if sample.get("method") == "saltelli" else 1)
    return int(combinations * draws)


def values(study: Study) -> tuple[dict[str, list], np.ndarray, np.ndarray]:
    """Return the values of all n cases of a study by key, and the numbers ``(n,)`` of their combination and of their draw.

    Each draw of the sample is combined with each combination of the grid.
    """
    drawn = _drawn(study)
    sizes, count = [len(next(iter(axis.values()))) for axis in study.axes], len(next(iter(drawn.values()), [0]))
    total = math.prod(sizes)
    point, draw = np.indices((total, count)).reshape(2, -1)
    places = np.unravel_index(point, sizes) if sizes else ()
    columns = {key: [one[i] for i in at] for axis, at in zip(study.axes, places, strict=True) for key, one in axis.items()}
    return columns | {key: one * total for key, one in drawn.items()}, point, draw


def _drawn(study):
    """Return the values of the sample by key. The result is empty without a sample."""
    sample = study.sample
    if not sample:
        return {}
    points = samples.cube(sample["method"], sample["count"], len(sample["of"]), study.seed)
    if sample["correlated"]:
        pairs = [(*one["between"], one["value"]) for one in sample["correlated"]]
        points = samples.correlated(points, list(sample["of"]), pairs)
    out = {}
    for (key, spec), column in zip(sample["of"].items(), points.T, strict=True):
        out |= dict.fromkeys((key, *spec.get("also", [])), samples.quantiles(spec, column))
    return out


def of_case(study: Study, case: Mapping[str, Any]) -> tuple[str, str, dict[str, Any]]:
    """Return pair, damage case and options of one case of a study from its values by key."""
    options = {key.partition(".")[2]: value for key, value in case.items() if key.startswith("options.")}
    if options:
        given = {name: value for name, value in (study.options | options).items() if value is not None}
        options = checked(RUNS, KINDS[study.kind].options, "options", "of this case", given)
    return case.get("pair", study.pair), case.get("case", study.case), options or study.options


def slim(study: Study) -> Study:
    """Return the study with the tables that its cases need, for other processes.

    A pair of a gearbox needs all of them.
    """
    if KINDS[study.kind].whole or {"pair", "case"} & set(study.keys) or is_gearbox(study.tables):
        return replace(study, axes=(), sample={})
    return replace(study, axes=(), sample={}, tables=trimmed(study.tables, study.pair, study.case))
