"""Damage on the page: a list of rows, each with its kind and the keys of this table of a scene."""

import math
import re
import tomllib
from typing import Any

from ..geometry.checks import shown
from ..geometry.pair.gear_pair import GearPair
from ..scene.new import example_numbers
from ..scene.parts import DAMAGE, SIDES
from ..scene.reading import Reading
from ..scene.schema import LISTS, REQUIRED, SPELLED, Key, scene_schema

CASE = "damaged"  # name of the case of damage in scenes of the page
SET = ("case", "pair", "body")  # keys without a field: the page shows one pair in one case
MOST = 20  # rows
LONGEST = 400  # numbers of a list, such as the corners of a crack


def kinds() -> dict[str, list[dict[str, Any]]]:
    """Return the fields of a row of damage by kind, for the browser."""
    return {kind: [_field(kind, key) for key in _keys(kind)] for kind in DAMAGE}


def _keys(kind: str) -> list[Key]:
    return [key for key in scene_schema()[kind].keys.values() if key.name not in SET]


def _field(kind, key):
    """Return the field of a key: its choices or bounds, other keys that it excludes, its value if it is left out."""
    table = scene_schema()[kind]
    others = [name for name in table.one_of if name != key.name] if key.name in table.one_of else []
    choices = SIDES if key.name == "gear" else ("no", "yes") if key.type == "boolean" else key.choices
    listed, unit = _units(key)
    low, high, step = key.usual or (None, None, None)
    unused = key.optional if key.default is None else "" if key.default is REQUIRED else shown(key.default)
    unused = f"by {_label(table.keys[unused])}" if unused in others else unused
    return {
        "key": key.name, "label": _label(key) + listed, "unit": unit,
        "choices": list(choices), "low": low, "high": high, "step": step, "whole": key.type == "integer",
        "list": key.type in LISTS, "truth": key.type == "boolean", "unused": unused, "excludes": others,
        "first": key.default is REQUIRED or key.type == "integer" or bool(key.usual and not (key.other and key.type in LISTS)),
    }  # fmt: skip


def _label(key):
    return re.split("[;:]", key.text)[0]


def _units(key):
    """Return the unit of a key in the label of a list, and after the field of a number."""
    unit = "°" if key.unit == "deg" else SPELLED.get(key.unit, key.unit)
    return (f" [{unit}]" if unit else "", "") if key.type in LISTS else ("", unit)


def first_rows(pair: GearPair, force: float) -> dict[str, dict[str, Any]]:
    """Return a row of each kind with numbers that suit a pair under a force [N]."""
    numbers, out = example_numbers(pair, force), {}
    for kind in DAMAGE:
        one_of = scene_schema()[kind].one_of
        needed = [key for key in _keys(kind) if key.default is REQUIRED or (key.name in one_of and not key.other)]
        out[kind] = {"kind": kind} | {key.name: tomllib.loads(f"v = {key.example.format(**numbers)}")["v"] for key in needed}
    return out


def checked_damage(given: Any) -> list[dict[str, Any]]:
    """Return the rows of damage of a state.

    ValueError if one is no table, has an unknown kind or key, or a value that a scene or the page's solver does not accept.
    """
    if not isinstance(given, list) or len(given) > MOST or not all(isinstance(row, dict) for row in given):
        raise ValueError(f"damage = {shown(given)}: expected a list of at most {MOST} tables")
    for i, row in enumerate(given):
        where, kind = f"damage {i + 1}", row.get("kind")
        if not isinstance(kind, str) or kind not in DAMAGE:
            raise ValueError(f"{where}: kind = {shown(kind)}, but it must be one of {', '.join(DAMAGE)}")
        for name in SET:
            if name in row:
                raise ValueError(f"{where}: {name} = {shown(row[name])}, but the page shows one pair in one case: omit {name}")
        if row.get("gear") not in SIDES:
            raise ValueError(f"{where}: gear = {shown(row.get('gear'))}, but it must be one of {', '.join(SIDES)}")
        table = {name: value for name, value in row.items() if name != "kind"} | {"case": CASE}
        Reading("page", scene_schema()).row(kind, f"{kind}, {where}", table)
        for key in _keys(kind):
            if key.name in row:
                _check_bounds(f"{where}: {key.label} ({key.name})", key, row[key.name])
    return given


def _check_bounds(what, key, value):
    """Raise ValueError for numbers outside the bounds of the page's solver."""
    values = value if isinstance(value, list) else [value]
    low, high, _ = key.usual or (-math.inf, math.inf, 0.0)
    if len(values) > LONGEST:
        raise ValueError(f"{what} has {len(values)} numbers, but this page accepts at most {LONGEST}")
    for one in values:
        if isinstance(one, (int, float)) and not low <= one <= high:
            raise ValueError(
                f"{what} = {shown(value)}, but this page accepts {low:g} to {high:g}: for other values use gearfe in Python"
            )


def rows_of(tables: dict[str, Any], sides: dict[str, str]) -> list[dict[str, Any]]:
    """Return the damage in the tables of one pair in one case of a scene as rows. `sides` has pinion or wheel by gear."""
    return [
        {"kind": kind} | {key: value for key, value in row.items() if key not in SET} | {"gear": sides[row["gear"]]}
        for kind in DAMAGE
        for row in tables.get(kind, ())
    ]


def tables_of_damage(rows: list[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """Return rows of damage as tables of a scene by kind."""
    out: dict[str, list[dict[str, Any]]] = {}
    for row in rows:
        out.setdefault(row["kind"], []).append({"case": CASE} | {key: value for key, value in row.items() if key != "kind"})
    return out


def through(row: dict[str, Any]) -> bool:
    """Whether the damage of a row is the same in every transverse section, so that a section models it."""
    return row["kind"] not in ("pits", "spall") and not {"width_mm", "ends"} & set(row)
