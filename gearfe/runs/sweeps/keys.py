"""Any value of a scene by its dotted key, ``crack.cracked.level``: which there are, and how one is set in the scene's tables."""

import copy

from ...scene import machine_table, set_table
from ...scene.load import DAMAGE, TABLES, read_tables

OUTSIDE = ("pair", "case")  # keys by themselves: which pair, which case of damage ("healthy": none)
BEFORE_LOAD = ("gear", "material")  # what the healthy gears depend on; then damage; the rest shares the gears


def tables_near(place, scene):
    """Name and tables of a scene, a file in the folder `place` or a built-in one, without what its sources print."""
    near = place / scene
    name, tables = read_tables(near if near.is_file() else scene)
    return name, {kind: table for kind, table in tables.items() if kind not in ("reference", "assumption", "given", "later")}


def check_key(key, tables, options):
    """Raise ValueError unless `key` names a value that can be set in a scene's `tables`, or an option of the kind of study."""
    if key in OUTSIDE:
        return
    parts = key.split(".")
    known = _known(parts, tables, options)
    if len(parts) != len(known) + 1 and not (len(parts) == len(known) + 2 and parts[-1].isdigit()):
        raise ValueError(
            f"{key!r} names no single value; write for instance {'.'.join(n[0] if n else 'NAME' for n in known)}.KEY"
        )
    for part, names in zip(parts[1:], known, strict=False):
        if part not in names:
            raise ValueError(f"{key!r}: there is no {part!r}; there is {', '.join(names) or 'nothing'}")


def _known(parts, tables, options):
    """Names that can stand behind the first part of a key, place by place."""
    first = parts[0]
    if first == "options":
        return [list(options)]
    if first in TABLES:
        return [list(tables.get(first, {})), list(TABLES[first])]
    if first in DAMAGE:
        return [list(dict.fromkeys(row["case"] for row in tables.get(first, []))), list(DAMAGE[first])]
    if first == "machine" and "machine" in tables:
        if parts[1:2] == ["impact"]:
            return [["impact"], list(machine_table.IMPACT)]
        if parts[1:2] == ["bodies"]:
            return [["bodies"], list(tables["machine"].get("bodies", {})), list(machine_table.BODY)]
        return [[*machine_table.MACHINE, "impact", "bodies"]]
    if first in set_table.NAMES and "set" in tables:
        return _known_of_set(first, tables)
    kinds = [name for name in (*TABLES, *DAMAGE, "machine", *set_table.NAMES) if tables.get(name)]
    raise ValueError(f"{'.'.join(parts)!r}: a key begins with {', '.join(kinds)} or options, or is pair or case")


def _known_of_set(first, tables):
    if first == "set":
        return [list(set_table.SET)]
    if first == "ring":
        return [["support"], list(set_table.SUPPORT)]
    return [list(tables.get("pin", {})), list(set_table.PIN)]


def placed(tables, values):
    """Copy of a scene's `tables` with `values` by key; keys of other things (`OUTSIDE`, options) are left aside."""
    out = copy.deepcopy(tables)
    for key, value in values.items():
        parts = key.split(".")
        if key in OUTSIDE or parts[0] == "options":
            continue
        if parts[0] in DAMAGE:
            homes = [row for row in out[parts[0]] if row["case"] == parts[1]]
            parts = parts[2:]
        else:
            deep = 2 if parts[0] in TABLES else len(parts) - 1 - parts[-1].isdigit()
            home = out
            for part in parts[:deep]:
                home = home.setdefault(part, {})
            homes, parts = [home], parts[deep:]
        for home in homes:
            _set(home, parts, value)
    return out


def _set(home, parts, value):
    """Set a value of a table, or the n-th number of a list in it."""
    if len(parts) == 1:
        home[parts[0]] = value
        return
    key, at = parts[0], int(parts[1])
    numbers = list(home.get(key) or [])
    if at >= len(numbers):
        raise ValueError(f"{key} = {numbers!r} in the scene has no number {at}; the first is 0")
    numbers[at] = value
    home[key] = numbers


def trimmed(tables, pair, case):
    """Tables that one pair in one case of damage needs: the rest would be checked for every case of a sweep, for nothing."""
    chosen = tables["pair"][pair]
    gears = {chosen.get(name) for name in ("gear_1", "gear_2")}
    out = {name: tables[name] for name in ("title", "source") if name in tables}
    out["pair"] = {pair: chosen}
    out["gear"] = {name: table for name, table in tables["gear"].items() if name in gears}
    used = {table.get("material") for table in out["gear"].values()}
    out["material"] = {name: table for name, table in tables["material"].items() if name in used}
    out["flank"] = {
        name: table
        for name, table in tables.get("flank", {}).items()
        if table.get("gear") in gears and table.get("pair") in (None, pair)
    }
    for kind in DAMAGE:
        of_case = [table for table in tables.get(kind, []) if table.get("case") == case]
        out[kind] = [table for table in of_case if table.get("gear") in gears and table.get("pair") in (None, pair)]
    return out


def rank(key):
    """Order in which keys are sorted so that cases beside each other share what was solved: 0 gears, 1 damage, 2 the rest."""
    first = key.partition(".")[0]
    if first in BEFORE_LOAD or key in OUTSIDE:
        return 0
    return 1 if first in DAMAGE else 2
