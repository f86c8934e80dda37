"""Values of a scene by dotted keys such as ``crack.cracked.level``: valid keys, and assignment in the scene's tables.

A part of a key is the name of a table, the case of a list of damage, or the place of a number in a list.
"""

import copy
from collections.abc import Mapping
from typing import Any, cast

from .parts import DAMAGE
from .schema import LISTS, Key, scene_schema

OUTSIDE = ("pair", "case")  # keys without a dot: the pair and the damage case ("healthy": none)
# Inputs of the healthy gears come first, then damage. Cases that differ in other inputs share solved gears.
BEFORE_LOAD = ("gear", "material")
PRINTED = ("reference", "assumption", "given", "later")  # statements about the source, which do not affect computed values
Tables = dict[str, Any]


def check_key(dotted: str, tables: Tables, options: Mapping[str, Any]) -> None:
    """Raise ValueError unless a key names a value that can be set in a scene's `tables`, or an option of the study."""
    first, _, option = dotted.partition(".")
    if dotted in OUTSIDE:
        return
    if first != "options":
        find_key(dotted, tables)
    elif option not in options:
        raise ValueError(f"{dotted!r}: there is no {option!r}; there is {', '.join(options)}")


def find_key(dotted: str, tables: Tables) -> Key:
    """Return the `Key` of a dotted key. Raises ValueError if it is no single value of a scene's `tables`."""
    schema, parts = scene_schema(), dotted.split(".")
    table, home, inner = schema["scene"], cast(Any, tables), cast(Any, None)
    kinds = _kinds(tables)
    if parts[0] not in kinds:
        raise ValueError(f"{dotted!r}: a key begins with {', '.join(kinds)} or options, or is pair or case")
    for i, part in enumerate(parts):
        names = table.keys if inner is None else inner
        if part not in names:
            raise ValueError(f"{dotted!r}: there is no {part!r}; there is {', '.join(names) or 'nothing'}")
        if inner is not None:
            home, inner = inner[part], None
        elif not (key := table.keys[part]).of:
            _check_number(dotted, key, ".".join(parts[: i + 1]), parts[i + 1 :])
            return key
        else:
            home, table = (home or {}).get(part) or {}, schema[key.of]
            if key.type != "table":
                inner = {row["case"]: row for row in home} if key.type == "listed" else home
    end = "KEY" if inner is None else f"{next(iter(inner), 'NAME')}.KEY"
    raise ValueError(f"{dotted!r} names no single value; write for instance {dotted}.{end}")


def _kinds(tables):
    """Return the names of the tables whose values can be set."""
    known = [name for name, key in scene_schema()["scene"].keys.items() if key.of and name not in PRINTED]
    return [name for name in known if tables.get(name) or "set" in tables]


def _check_number(dotted, key, single, rest):
    """Raise ValueError unless a key ends here, or is followed by a valid index of its list."""
    if rest and not (key.type in LISTS and len(rest) == 1 and rest[0].isdigit()):
        raise ValueError(f"{dotted!r} names no single value; write for instance {single}")


def set_values(tables: Tables, values: Mapping[str, Any]) -> Tables:
    """Return a copy of a scene's `tables` with `values` by key. Keys outside the scene (`OUTSIDE`, options) are ignored.

    A whole number such as 21.0 of a key of whole numbers becomes an integer.
    """
    out = copy.deepcopy(tables)
    for dotted, value in values.items():
        if dotted in OUTSIDE or dotted.startswith("options."):
            continue
        key, homes, rest = _homes(out, dotted)
        if key.type == "integer" and isinstance(value, float) and value.is_integer():
            value = int(value)
        for home in homes:
            home[key.name] = _with_number(home, key.name, int(rest[0]), value) if rest else value
    return out


def _homes(tables, dotted):
    """Return the `Key`, the tables that contain it, and the index of a list, if any."""
    parts, homes, table = dotted.split("."), [tables], scene_schema()["scene"]
    while (key := table.keys[parts.pop(0)]).of:
        table = scene_schema()[key.of]
        if key.type == "listed":
            case = parts.pop(0)
            homes = [row for home in homes for row in home[key.name] if row["case"] == case]
            continue
        for name in (key.name, parts.pop(0)) if key.type == "named" else (key.name,):
            homes = [home.setdefault(name, {}) for home in homes]
    return key, homes, parts


def _with_number(home, name, at, value):
    """Return a list of a table with one number replaced."""
    numbers = list(home.get(name) or [])
    if at >= len(numbers):
        raise ValueError(f"{name} = {numbers!r} in the scene has no number {at}; the first is 0")
    numbers[at] = value
    return numbers


def rank(dotted: str) -> int:
    """Return the sort order of keys, so that neighbouring cases share solutions: 0 gears, 1 damage, 2 the rest."""
    first = dotted.partition(".")[0]
    if first in BEFORE_LOAD or dotted in OUTSIDE:
        return 0
    return 1 if first in DAMAGE else 2
