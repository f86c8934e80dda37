"""Conversion between the fields of the live page and scenes that the page can represent completely."""

import math
import tomllib
from typing import Any

from ..geometry.checks import shown
from ..scene.dotted_keys import set_values
from ..scene.load import Scene, scene_of
from ..scene.parts import DAMAGE, SIDES
from ..scene.reading import Reading
from ..scene.schema import REQUIRED, scene_schema
from ..scene.study_tables import trimmed
from .damage import CASE, rows_of, tables_of_damage
from .fields import FIELDS, START, checked_state, key_at

PAIR = "stage"
RUN = {"model", "speed_rpm", "torque_Nm"}  # machine keys that have a field on the page
SPRUNG = ("flank", "support")  # tables of a gear that contain its supports
LEFT = ("gear", "gear_1", "gear_2", "pair", "case", "material")  # keys that refer to tables
CLOSE = 1e-9  # relative tolerance of equal numbers, because torques are computed from forces


class SeveralError(ValueError):
    """Error for a scene with several pairs or cases. `choices` are the cases by pair, ``""`` for healthy gears."""

    def __init__(self, text: str, choices: dict[str, list[str]]):
        super().__init__(text)
        self.choices = choices


def title_of(state: dict[str, Any]) -> str:
    """Return the title of an unnamed scene."""
    return state["title"] or f"Pair {state['z_1']}/{state['z_2']}, module {state['m_n']:g} mm"


def _typed(state):
    """Return the values of the fields that are part of the scene of the state, by dotted key."""
    counted = [field for field in FIELDS if field.places and field.counts(state)]
    return {place: field.typed(state[field.name]) for field in counted for place in field.places}


def tables_of(state: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of the scene of a checked state, for `gearfe.scene.load.scene_of`."""
    gears = {side: {"material": side} for side in SIDES}
    pair = {"gear_1": "pinion", "gear_2": "wheel"}
    tables = {"title": title_of(state), "source": state["source"], "material": {}, "gear": gears, "pair": {PAIR: pair}}
    tables = set_values(tables, _typed(state))
    wheel, ring = tables["gear"]["wheel"], state["wheel"] == "ring"
    wheel["beta_deg"] = (state["beta"] if ring else -state["beta"]) + 0.0
    if ring:
        wheel["r_rim_mm"] = wheel.pop("r_bore_mm")
    for kind in SPRUNG:
        if kind in tables:
            tables[kind] = {side: {"gear": side} | row for side, row in tables[kind].items()}
    if run := tables.pop("machine", {}):
        torque = state["drive"] or state["force"] * scene_of("page", tables).gears["pinion"].r_b * 1e-3
        tables["machine"] = {"model": "helical_pair"} | run | {"torque_Nm": torque}
    return tables | tables_of_damage(state["damage"]) | ({"assumption": state["assumption"]} if state["assumption"] else {})


def read(name: str, text: str, pair: str | None = None, case: str | None = None) -> tuple[dict[str, Any], list[str]]:
    """Return the state of the page for a scene's text (TOML), and a list of the parts that the chosen pair leaves out.

    `name` is that of the file, for messages. `pair` and `case` choose a pair and a case of damage (``""``: healthy). Without
    them, the scene must be one pair in one case. ValueError if it is no scene, or contains anything without a field on the page:
    nothing is dropped silently.
    """
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{name}: not readable as TOML: {error}") from error
    scene = scene_of(name, tables)
    if pair is None and case is None:
        _check_single(name, scene, tables)
    chosen = scene.pair(pair)
    pair = pair or next(iter(scene.pairs))
    case = next(iter(chosen.damage), "") if case is None else case
    chosen.case(case or None)
    rest = _rest(scene, tables, pair, case)
    stated, starts, rows = _values(name, tables, pair, case)
    state = _fields(tables, stated, rows, chosen.force * chosen.pair.gear_1.r_b * 1e-3)
    state["assumption"] = [*state["assumption"], *_assumptions(tables.get("assumption", []), starts)]
    page = tables_of(checked_state(state))
    notes = [note for note in _differences(name, stated, _values(name, page, PAIR, CASE)[0]) if note]
    if scene_of("page", page).pair().damage.get(CASE) != chosen.damage.get(case):
        raise ValueError(
            f"{name}: in pair {pair!r} damage of case {case!r} is on a flank that is not loaded, or on several bodies of a "
            "machine, but the page has the loaded flanks of one pair only; compute this scene by gearfe compare"
        )
    return state, [*(f"not taken from {name}: {one}" for one in rest), *notes]


def _check_single(name, scene, tables):
    if rest := "; ".join(_rest(scene, tables, None, None)):
        choices = {one: ["", *own.damage] for one, own in scene.pairs.items()}
        text = f"{name}: the page shows one pair in one case, and here is more: {rest}; choose a pair and case"
        raise SeveralError(text, choices)


def _assumptions(entries, starts):
    """Yield the assumptions that concern the chosen pair, with the page's keys, and all assumptions without values."""
    for entry in entries:
        values = entry.get("holds", {})
        held = {new + key.removeprefix(old): value for key, value in values.items() for old, new in starts if key.startswith(old)}
        if held or not values:
            yield entry | ({"holds": held} if held else {})


def _differences(name, stated, page):
    """Yield a note if the hand of the helix differs. Raise ValueError for any other value that differs from the page."""
    for place in sorted({**stated, **page}, key=lambda place: stated.get(place) is None):
        given, ours = (one.get(place, key_at(place).default) for one in (stated, page))
        if place == "gear.wheel.beta_deg" and given and _same(given, -ours):
            yield f"the hand of the wheel's helix, given as {given:g}°, is written as {ours:g}°"
        elif not _same(given, ours):
            here = "nothing" if ours is REQUIRED else shown(ours)
            raise ValueError(f"{name}: {place} = {shown(given)}, but the page has {here} there: it "
                             "has no field for this value; compute this scene by gearfe compare")  # fmt: skip


def _rest(scene: Scene, tables: dict[str, Any], pair: str | None, case: str | None) -> list[str]:
    """Return a description of the contents of a scene that are not part of the chosen pair and case."""
    used = {row[key] for row in tables["pair"].values() for key in ("gear_1", "gear_2")}
    parts = {
        "pairs": [other for other in scene.pairs if other != pair and len(scene.pairs) > 1],
        "cases": [name for name in scene.cases if name != case and (case is not None or len(scene.cases) > 1)],
        "machine": [scene.machine["model"]] if scene.machine and not _runs(tables) else [],
        "the planetary set": [] if scene.set is None else [""],
        "bodies of damaged teeth": list(
            dict.fromkeys(row["body"] for kind in DAMAGE for row in tables.get(kind, ()) if "body" in row and row["case"] == case)
        ),
        "gears in no pair": [gear for gear in scene.gears if gear not in used],
    }
    printed = {"reference": "[[reference]]", "given": "given", "later": "later"}
    out = [f"{noun} {', '.join(left)}".rstrip() for noun, left in parts.items() if left]
    return out + [text for key, text in printed.items() if tables.get(key)]


def _runs(tables):
    """Return True if a scene has a machine that the page can show."""
    return tables.get("machine", {}).get("model") == "helical_pair" and set(tables["machine"]) <= RUN


def _values(
    name: str, tables: dict[str, Any], pair: str, case: str | None
) -> tuple[dict[str, Any], list[tuple[str, str]], list[dict[str, Any]]]:
    """Return the values of one pair in one case by the page's dotted keys, (old, new) prefixes of the keys, rows of damage."""
    given = trimmed(tables, pair, case) | ({"machine": tables["machine"]} if _runs(tables) else {})
    rows = Reading(name, scene_schema()).row("scene", "top level", given)
    sides = {rows["pair"][pair][key]: side for key, side in zip(("gear_1", "gear_2"), SIDES, strict=True)}
    if rows["shaft"]:
        raise ValueError(f"{name}: [shaft.{next(iter(rows['shaft']))}] holds a gear of this pair; the page has springs only")
    heads = [(f"pair.{pair}.", f"pair.{PAIR}.", rows["pair"][pair])]
    for gear, side in sides.items():
        material = rows["gear"][gear]["material"]
        heads.append((f"gear.{gear}.", f"gear.{side}.", rows["gear"][gear]))
        heads.append((f"material.{material}.", f"material.{side}.", rows["material"][material]))
    heads += [(f"{kind}.{key}.", f"{kind}.{sides[row['gear']]}.", row) for kind in SPRUNG for key, row in rows[kind].items()]
    heads += [(f"{kind}.{case}.", f"{kind}.{CASE}.", {}) for kind in DAMAGE]
    heads += [("machine.", "machine.", {key: rows["machine"][key] for key in tables["machine"]})] if rows["machine"] else []
    kept = {new + key: value for _, new, row in heads for key, value in row.items() if key not in LEFT}
    return kept, [(old, new) for old, new, _ in heads], rows_of(given, sides)


def _same(one, other):
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    numbers = all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in (one, other))
    return math.isclose(one, other, rel_tol=CLOSE) if numbers else one == other


def _fields(tables, values, damage, torque):
    """Return the page fields from values by dotted key. `read` finds values without a field by comparison."""
    out = START | {"source": tables["source"], "damage": damage}
    bore = {"gear.wheel.r_bore_mm": values["gear.wheel.r_bore_mm"] or values["gear.wheel.r_rim_mm"]}
    for field in FIELDS:
        if field.by:
            given = (choice for choice, place in field.by.items() if values.get(place) is not None)
            out[field.name] = next(given, field.choices[0])
        elif field.places:
            place, _, at = field.places[0].partition("_mm.")
            value = (values | bore).get(f"{place}_mm" if at else place)
            out[field.name] = field.from_typed(value[int(at)] if at and value else value)
    out["drive"] = 0.0 if not out["speed"] or _same(out["drive"], torque) else out["drive"]
    out["title"] = "" if tables["title"] == title_of(checked_state(out)) else tables["title"]
    return out
