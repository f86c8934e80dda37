"""Tables of the scene of a study, reduced to one pair and one damage case."""

from pathlib import Path

from .dotted_keys import PRINTED, Tables
from .load import read_tables, scene_of
from .parts import DAMAGE
from .schema import scene_schema


def tables_near(place: Path, scene: str) -> tuple[str, Tables]:
    """Return name and tables of a scene (file in the folder `place`, or built-in) without statements of its source."""
    near = place / scene
    name, tables = read_tables(near if near.is_file() else scene)
    return name, {kind: table for kind, table in tables.items() if kind not in PRINTED}


def trimmed(tables: Tables, pair: str, case: str | None) -> Tables:
    """Return the tables of one pair in one damage case, because a sweep would check all tables for every case.

    The pair of a gearbox has its force in the gearbox.
    """
    chosen = tables["pair"][pair]
    if is_gearbox(tables):
        whole = {kind: table for kind, table in tables.items() if kind not in (*DAMAGE, *PRINTED)}
        chosen = chosen | {"force_N": scene_of("scene", whole).pair(pair).force}
    gears = {chosen.get("gear_1"), chosen.get("gear_2")}
    out: Tables = {name: tables[name] for name in ("title", "source") if name in tables}
    out |= {"pair": {pair: chosen}, "gear": {name: table for name, table in tables["gear"].items() if name in gears}}
    schema = scene_schema()
    for kind, key in schema["scene"].keys.items():
        if key.of and "gear" in schema[key.of].keys:
            out[kind] = _of_pair(tables.get(kind, [] if key.type == "listed" else {}), gears, pair, case)
    used = {row.get("material") for row in (*out["gear"].values(), *out["shaft"].values())}
    return out | {"material": {name: table for name, table in tables["material"].items() if name in used}}


def _of_pair(rows, gears, pair, case):
    """Return the rows of these gears that belong to the pair or to all pairs, in the case or in all cases."""

    def wanted(row):
        return row.get("gear") in gears and row.get("pair") in (None, pair) and row.get("case", case) == case

    return {name: row for name, row in rows.items() if wanted(row)} if isinstance(rows, dict) else list(filter(wanted, rows))


def is_gearbox(tables: Tables) -> bool:
    """Return whether the pair forces follow from the torque of a gearbox."""
    return bool(tables.get("machine", {}).get("model") == "gearbox")
