"""The state of the page is a scene: written from the fields, read back from a scene that the page can show whole."""

import json
import math
import tomllib
from collections.abc import Iterator
from typing import Any

from ..scene.load import DAMAGE, TABLES, Scene, scene_of
from ..scene.machine_table import checked_machine
from ..scene.strict import checked, shown
from .fields import FIELDS, SIDES, SPELLED, START, checked_state

CASE, PAIR = "damaged", "stage"
ENDS = ("tip", "root")  # of a flank that may be relieved
FLANK = {f"{end}_relief": f"{end}_relief_um" for end in ENDS} | {  # a gear without any has no table
    "crowning": "crowning_um", "lead": "lead_crowning_um", "tip_rounding": "tip_rounding_mm", "tip_chamfer": "tip_chamfer_mm",
}  # fmt: skip
SUPPORT = {
    "radial": "radial_N_per_um",
    "tilt": "tilt_Nm_per_mrad",
    "torsion": "torsion_Nm_per_mrad",
}  # one that is rigid has no key
CRACK = {"crack_angle": "angle_deg", "crack_start": "start", "crack_gear": "gear"}
PITS = {
    "pit_gear": "gear", "pit_radius": "radius_mm", "pit_count": "count", "pit_first": "first_mm", "pit_last": "last_mm",
    "pit_depth": "depth_mm",
}  # fmt: skip
FACE = "by the helix angle"
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
    out: dict[str, Any] = {"title": title_of(state), "source": state["source"], "material": {}, "gear": {}, "pair": {PAIR: {}}}
    for field in FIELDS:
        for place in field.places:
            kind, name, key = place.split(".")
            out[kind].setdefault(name, {})[key] = state[field.name]
    ring = state["wheel"] == "ring"
    for i, side in SPELLED.items():
        held = "r_rim_mm" if ring and side == "wheel" else "r_bore_mm"
        out["gear"][side] |= {held: state[f"held_{i}"], "material": side}
    out["gear"]["wheel"]["beta_deg"] = (state["beta"] if ring else -state["beta"]) + 0.0
    out["pair"][PAIR] |= {"gear_1": "pinion", "gear_2": "wheel"}
    out["pair"][PAIR] |= {"a_mm": state["a"]} if state["a"] else {}
    face = ("helical" if state["beta"] else None) if state["face"] == FACE else state["face"]
    out["pair"][PAIR] |= {"face": face} if face else {}
    flanks = {side: _flank(state, i, side) for i, side in SPELLED.items()}
    out |= {"flank": modified} if (modified := {side: table for side, table in flanks.items() if table}) else {}
    soft = {side: {key: value for name, key in SUPPORT.items() if (value := state[f"{name}_{i}"])} for i, side in SPELLED.items()}
    soft = {side: {"gear": side} | springs for side, springs in soft.items() if springs}
    out |= {"support": soft} if soft else {}
    if state["crack"] != "none":
        size = {"length_mm": state["crack_length"]} if state["crack"] == "length" else {"level": state["crack_level"]}
        turning = {"turning": True} if state["turning"] == "yes" and state["crack"] == "level" else {}
        part: dict[str, Any] = {"width_mm": [state["part_first"], state["part_last"]]} if state["part"] == "a part" else {}
        part |= {"rounded": True} if part and state["part_rounded"] == "rounded" else {}
        out["crack"] = [{"case": CASE} | {key: state[name] for name, key in CRACK.items()} | size | turning | part]
    if state["pits"] == "yes":
        axes = {"axes_mm": [state["pit_along"], state["pit_across"]]}
        out["pits"] = [{"case": CASE} | {key: state[name] for name, key in PITS.items()} | axes]
    if state["speed"]:
        torque = state["drive"] or state["force"] * scene_of("page", out).gears["pinion"].r_b * 1e-3
        out["machine"] = {"model": "helical_pair", "speed_rpm": state["speed"], "torque_Nm": torque}
    return out | ({"assumption": state["assumption"]} if state["assumption"] else {})


def _flank(state, i, side):
    out = {key: state[f"{name}_{i}"] for name, key in FLANK.items() if state[f"{name}_{i}"]}
    for end in ENDS:
        if f"{end}_relief_um" in out:
            out |= {f"{end}_start_length_mm": state[f"{end}_length_{i}"], f"{end}_exponent": state[f"{end}_exponent_{i}"]}
    return {"gear": side} | out if out else {}


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
    own, notes = _renamed(name, tables, pair, case)
    state = _fields(name, own, chosen.force * chosen.pair.gear_1.r_b * 1e-3)
    stated, page = dict(_flat(_filled(name, own))), dict(_flat(_filled(name, tables_of(state))))
    for place in [*stated, *page]:
        if place == "gear.wheel.beta_deg" and stated[place] and _same(stated[place], -page[place]):
            notes.append(f"the hand of the wheel's helix, given as {stated[place]:g}°, is written as {page[place]:g}°")
        elif not _same(stated.get(place), page.get(place)):
            raise ValueError(f"{name}: {place} = {shown(stated.get(place))}, but the page has {shown(page.get(place))} there: no "
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
    """The scene of one pair in one case with the names that the page gives, and what was changed in it, in words."""
    row, notes = dict(tables["pair"][pair]), []
    sides = {row["gear_1"]: "pinion", row["gear_2"]: "wheel"}
    gears = {side: dict(tables["gear"][gear]) for gear, side in sides.items()}
    materials = {side: dict(tables["material"][gear["material"]]) for side, gear in gears.items()}
    names = {f"gear.{gear}.": f"gear.{side}." for gear, side in sides.items()} | {f"pair.{pair}.": f"pair.{PAIR}."}
    out = {"title": tables["title"], "source": tables["source"], "material": materials, "gear": gears}
    out["pair"] = {PAIR: row | {"gear_1": "pinion", "gear_2": "wheel"}}
    for gear, side in sides.items():
        names |= {f"material.{tables['gear'][gear]['material']}.": f"material.{side}."}
        gears[side]["material"] = side
    for kind in ("flank", "support", "shaft"):
        for key, entry in tables.get(kind, {}).items():
            if entry["gear"] in sides and entry.get("pair") in (None, pair):
                if kind == "shaft":
                    raise ValueError(
                        f"{name}: [shaft.{key}] holds a gear of this pair; the page has supports by their stiffness only"
                    )
                table = {k: v for k, v in entry.items() if k != "pair"}
                out.setdefault(kind, {})[sides[entry["gear"]]] = table | {"gear": sides[entry["gear"]]}
    for kind in DAMAGE:
        for entry in tables.get(kind, []):
            if entry["case"] == case and entry["gear"] in sides and entry.get("pair") in (None, pair):
                table = {k: v for k, v in entry.items() if k != "pair"}
                out.setdefault(kind, []).append(table | {"case": CASE, "gear": sides[entry["gear"]]})
    for kind, entries in ((kind, out.get(kind, [])) for kind in DAMAGE):
        if len(entries) > 1:
            raise ValueError(f"{name}: {len(entries)} tables [[{kind}]] in one case; the page has fields for one")
    if _runs(tables):
        out["machine"] = tables["machine"]
    for entry in tables.get("assumption", []):
        held = {new + key.removeprefix(old): value for key, value in entry.get("holds", {}).items()
                for old, new in names.items() if key.startswith(old)}  # fmt: skip
        if held or not entry.get("holds"):
            out.setdefault("assumption", []).append(entry | ({"holds": held} if held else {}))
    return out, notes


def _filled(name, tables):
    """Tables with the defaults of their keys filled in; tables that may be left out are there too, with their defaults."""
    out = {"title": tables["title"], "source": tables["source"]}
    wanted = [("material", side) for side in SIDES] + [("gear", side) for side in SIDES] + [("pair", PAIR)]
    for kind, key in wanted + [(kind, side) for kind in ("flank", "support") for side in SIDES]:
        row = tables.get(kind, {}).get(key, {"gear": key})
        out[f"{kind}.{key}"] = checked(name, f"{kind}.{key}", row, TABLES[kind])
    if not out[f"pair.{PAIR}"]["face"] and out["gear.pinion"]["beta_deg"]:
        out[f"pair.{PAIR}"]["face"] = "helical"
    for kind, keys in DAMAGE.items():
        for entry in tables.get(kind, []):
            row = checked(name, kind, entry, keys)
            if kind == "pits":  # of a row about its middle something else is left that no field holds
                first = row["first_mm"] or 0.0
                row |= {"first_mm": first, "last_mm": first if row["last_mm"] is None else row["last_mm"]}
            out[kind] = row
    if "machine" in tables:
        out["machine"] = checked_machine(name, tables["machine"])
    out["assumption"] = [{"why": "", "depends": "", "holds": {}} | entry for entry in tables.get("assumption", [])]
    return out


def _flat(table, head="") -> Iterator[tuple[str, Any]]:
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
    out, filled = dict(START) | {"crack": "none"}, _filled(name, tables)
    for field in FIELDS:
        if field.places:
            place, key = field.places[0].rsplit(".", 1)
            out[field.name] = filled[place][key]
    for i, side in SPELLED.items():
        gear, flank = filled[f"gear.{side}"], filled[f"flank.{side}"]
        out[f"held_{i}"] = gear["r_rim_mm"] if gear["r_bore_mm"] is None else gear["r_bore_mm"]
        out |= {f"{field}_{i}": flank[key] for field, key in FLANK.items()}
        out |= {f"{field}_{i}": filled[f"support.{side}"][key] or 0.0 for field, key in SUPPORT.items()}
        for end in ENDS:
            out[f"{end}_exponent_{i}"] = flank[f"{end}_exponent"]
            if flank[f"{end}_start_length_mm"] is not None:
                out[f"{end}_length_{i}"] = flank[f"{end}_start_length_mm"]
    pair = filled[f"pair.{PAIR}"]
    out |= {"wheel": "ring" if filled["gear.wheel"]["r_rim_mm"] is not None else "external", "a": pair["a_mm"] or 0.0}
    out["face"] = FACE if pair["face"] == ("helical" if filled["gear.pinion"]["beta_deg"] else None) else pair["face"]
    if "crack" in filled:
        row = filled["crack"]
        out |= {field: row[key] for field, key in CRACK.items()}
        out |= {"crack": "length", "crack_length": row["length_mm"]} if row["level"] is None else {
            "crack": "level", "crack_level": row["level"], "turning": "yes" if row["turning"] else "no"}  # fmt: skip
        if row["width_mm"] is not None:
            rounded = "rounded" if row["rounded"] else "straight"
            out |= {"part": "a part", "part_first": row["width_mm"][0], "part_last": row["width_mm"][1], "part_rounded": rounded}
    if "pits" in filled:
        row = filled["pits"]
        out |= {field: row[key] for field, key in PITS.items()} | {"pits": "yes"}
        out |= {"pit_along": row["axes_mm"][0], "pit_across": row["axes_mm"][1]}
    if "machine" in filled:
        drive = filled["machine"]["torque_Nm"]
        out |= {"speed": filled["machine"]["speed_rpm"], "drive": 0.0 if _same(drive, torque) else drive}
    for field in (numeric for numeric in FIELDS if numeric.whole or not numeric.choices):
        value = out[field.name]
        out[field.name] = float(value) if isinstance(value, int) and not field.whole else value
    title = tables["title"]
    out |= {"source": tables["source"], "title": "", "assumption": tables.get("assumption", [])}
    checked_state(out)
    out["title"] = "" if title == title_of(out) else title
    return out
