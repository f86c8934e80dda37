"""The state of the page is a scene: written from the fields, read back from a scene that the page can show whole."""

import math
import tomllib
from collections.abc import Iterator
from typing import Any

from ..scene.dotted_keys import set_values, trimmed
from ..scene.load import Scene, scene_of
from ..scene.parts import DAMAGE
from ..scene.schema import NAMES, REQUIRED, Reading, scene_schema, shown
from .fields import FIELDS, SIDES, START, checked_state, key_at

CASE, PAIR = "damaged", "stage"
RUN = {"model", "speed_rpm", "torque_Nm"}  # keys of a machine that the page has
CLOSE = 1e-9  # numbers are the same within it: a torque is computed from a force


class SeveralError(ValueError):
    """A scene is more than one pair in one case; `choices` are its cases by pair, ``""`` being healthy."""

    def __init__(self, text: str, choices: dict[str, list[str]]):
        super().__init__(text)
        self.choices = choices


def title_of(state: dict[str, Any]) -> str:
    """What the scene is called if nobody has given it a name."""
    return state["title"] or f"Pair {state['z_1']}/{state['z_2']}, module {state['m_n']:g} mm"


def tables_of(state: dict[str, Any]) -> dict[str, Any]:
    """Tables of the scene that a checked state stands for, as `gearfe.scene.load.scene_of` takes them."""
    gears = {side: {"material": side} for side in SIDES}
    pair = {"gear_1": "pinion", "gear_2": "wheel"}
    tables = {"title": title_of(state), "source": state["source"], "material": {}, "gear": gears, "pair": {PAIR: pair}}
    lists = {"crack": {"width_mm": [0.0, 0.0]} if state["part"] == "a part" else {}, "pits": {"axes_mm": [0.0, 0.0]}}
    tables |= {kind: [{"case": CASE, **row}] for kind, row in lists.items() if state[kind] not in ("none", "no")}
    counted = [field for field in FIELDS if field.places and field.counts(state)]
    tables = set_values(tables, {place: field.typed(state[field.name]) for field in counted for place in field.places})
    wheel, ring = tables["gear"]["wheel"], state["wheel"] == "ring"
    wheel["beta_deg"] = (state["beta"] if ring else -state["beta"]) + 0.0
    if ring:
        wheel["r_rim_mm"] = wheel.pop("r_bore_mm")
    for kind in ("flank", "support"):
        if kind in tables:
            tables[kind] = {side: {"gear": side} | row for side, row in tables[kind].items()}
    if run := tables.pop("machine", {}):
        torque = state["drive"] or state["force"] * scene_of("page", tables).gears["pinion"].r_b * 1e-3
        tables["machine"] = {"model": "helical_pair"} | run | {"torque_Nm": torque}
    return tables | ({"assumption": state["assumption"]} if state["assumption"] else {})


def read(name: str, text: str, pair: str | None = None, case: str | None = None) -> tuple[dict[str, Any], list[str]]:
    """State of the page for a scene's text (TOML), and in words what of the scene was left behind because a pair was chosen.

    `name` is that of the file, for messages; `pair` and `case` say which pair of the scene, in which case of damage (``""``:
    healthy). Without, the scene must be one pair in one case. ValueError if it is no scene, or says something that the page
    has no field for: nothing is dropped in silence.
    """
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{name}: not readable as TOML: {error}") from error
    scene = scene_of(name, tables)
    if pair is None and case is None:
        rest = _rest(scene, tables, None, None)
        if rest:
            further = "; ".join(rest)
            choices = {one: ["", *own.damage] for one, own in scene.pairs.items()}
            raise SeveralError(
                f"{name}: the page shows one pair in one case, and here is more: {further}; choose a pair and case", choices
            )
    chosen = scene.pair(pair)
    pair = pair or next(iter(scene.pairs))
    case = next(iter(chosen.damage), "") if case is None else case
    chosen.case(case or None)
    rest = _rest(scene, tables, pair, case)
    own, notes = _renamed(name, tables, pair, case), []
    state = _fields(name, own, chosen.force * chosen.pair.gear_1.r_b * 1e-3)
    stated, page = _values(name, own), _values(name, tables_of(state))
    for place in sorted({**stated, **page}, key=lambda place: stated.get(place) is None):
        given, ours = (one.get(place, key_at(place).default) for one in (stated, page))
        if place == "gear.wheel.beta_deg" and given and _same(given, -ours):
            notes.append(f"the hand of the wheel's helix, given as {given:g}°, is written as {ours:g}°")
        elif not _same(given, ours) and not (REQUIRED in (given, ours) and key_at(place).type in NAMES):
            here = "nothing" if ours is REQUIRED else shown(ours)
            raise ValueError(f"{name}: {place.replace(f'.{CASE}', '')} = {shown(given)}, but the page has {here} there: no "
                             "field of it holds this; nothing is dropped, so compute this scene by gearfe compare")  # fmt: skip
    return checked_state(state), [*(f"not taken from {name}: {one}" for one in rest), *notes]


def _rest(scene: Scene, tables: dict[str, Any], pair: str | None, case: str | None) -> list[str]:
    """What a scene says beside its pair (of several the chosen one) and case, in words."""
    others = [other for other in scene.pairs if other != pair] if len(scene.pairs) > 1 else []
    names = dict.fromkeys(hurt for scene_pair in scene.pairs.values() for hurt in scene_pair.damage)
    cases = [name for name in names if name != case] if case is not None or len(names) > 1 else []
    out = [f"{noun} {', '.join(left)}" for noun, left in (("pairs", others), ("cases", cases)) if left]
    out += [f"machine {scene.machine['model']}"] if scene.machine and not _runs(tables) else []
    out += ["the planetary set"] if scene.set is not None else []
    used = {row[key] for row in tables["pair"].values() for key in ("gear_1", "gear_2")}
    spare = [gear for gear in scene.gears if gear not in used]
    out += [f"gears in no pair {', '.join(spare)}"] if spare else []
    return out + [f"[[{key}]]" if key == "reference" else f"{key}" for key in ("reference", "given", "later") if tables.get(key)]


def _runs(tables):
    """Whether a scene has a machine that the page can show."""
    return tables.get("machine", {}).get("model") == "helical_pair" and set(tables["machine"]) <= RUN


def _renamed(name, tables, pair, case):
    """The scene of one pair in one case with the names that the page gives."""
    row = tables["pair"][pair]
    sides = {row["gear_1"]: "pinion", row["gear_2"]: "wheel"}
    names = {"gear": sides, "pair": {pair: PAIR}, "material": {}}
    given, out = trimmed(tables, pair, case), {"title": tables["title"], "source": tables["source"]}
    if given["shaft"]:
        raise ValueError(f"{name}: [shaft.{next(iter(given['shaft']))}] holds a gear of this pair; the page has springs only")
    for kind in ("gear", "pair", "flank", "support", *DAMAGE):
        rows = given[kind] if kind in DAMAGE else given[kind].values()
        renamed = [_with_names(scene_schema()[kind], one, names) for one in rows]
        if kind in DAMAGE:
            if len(renamed) > 1:
                raise ValueError(f"{name}: {len(renamed)} tables [[{kind}]] in one case; the page has fields for one")
            out[kind] = [one | {"case": CASE} for one in renamed]
        else:
            own = [names[kind][key] for key in given[kind]] if kind in names else [one["gear"] for one in renamed]
            out[kind] = dict(zip(own, renamed, strict=True))
    of_gear = {side: tables["gear"][gear]["material"] for gear, side in sides.items()}
    out["material"] = {side: given["material"][material] for side, material in of_gear.items()}
    for side in out["gear"]:
        out["gear"][side]["material"] = side
    if _runs(tables):
        out["machine"] = tables["machine"]
    starts = {f"{kind}.{old}.": f"{kind}.{new}." for kind, new_names in names.items() for old, new in new_names.items()}
    starts |= {f"material.{material}.": f"material.{side}." for side, material in of_gear.items()}
    for entry in tables.get("assumption", []):
        held = {new + key.removeprefix(old): value for key, value in entry.get("holds", {}).items()
                for old, new in starts.items() if key.startswith(old)}  # fmt: skip
        if held or not entry.get("holds"):
            out.setdefault("assumption", []).append(entry | ({"holds": held} if held else {}))
    return out


def _with_names(table, row, names):
    """Row of a table with the names that the page gives; a `pair` that the row is restricted to is left out."""
    keys = {key: table.keys[key].type for key in row if key in table.keys}
    return {
        key: names[keys[key]].get(value, value) if keys[key] in names else value for key, value in row.items() if key != "pair"
    }


def _values(name: str, tables: dict[str, Any]) -> dict[str, Any]:
    """Values of the scene by dotted key, with defaults of all tables that are there."""
    rows = Reading(name, scene_schema()).row("scene", "top level", tables)
    rows |= {kind: {row["case"]: row for row in rows[kind]} for kind in DAMAGE}
    for row in rows["pits"].values():
        row["last_mm"] = row["first_mm"] if row["last_mm"] is None else row["last_mm"]
    rows["machine"] = {key: value for key, value in (rows["machine"] or {}).items() if key not in ("impact", "bodies")}
    return dict(_flat({kind: rows[kind] for kind in ("material", "gear", "pair", "flank", "support", "machine", *DAMAGE)}))


def _flat(table: dict[str, Any], head: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        place = f"{head}.{key}" if head else key
        if isinstance(value, dict):
            yield from _flat(value, place)
        else:
            yield place, value


def _same(one, other):
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    numbers = all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in (one, other))
    return math.isclose(one, other, rel_tol=CLOSE) if numbers else one == other


def _fields(name, tables, torque):
    """Values of the fields from renamed tables; what no field holds is left out, and found when `read` compares."""
    out, values = dict(START), _values(name, tables)
    if values.get("gear.wheel.r_bore_mm") is None:
        values["gear.wheel.r_bore_mm"] = values["gear.wheel.r_rim_mm"]
    for field in FIELDS:
        if field.by:
            out[field.name] = next(
                (choice for choice, place in field.by.items() if values.get(place) is not None), field.choices[0]
            )
        elif field.places:
            place, _, at = field.places[0].partition("_mm.")
            value = values.get(f"{place}_mm" if at else place)
            out[field.name] = field.from_typed(value[int(at)] if at and value else value)
    out["drive"] = 0.0 if not out["speed"] or _same(out["drive"], torque) else out["drive"]
    out |= {"source": tables["source"], "title": "", "assumption": tables.get("assumption", [])}
    checked_state(out)
    out["title"] = "" if tables["title"] == title_of(out) else tables["title"]
    return out
