"""Flank modifications of a REXS model as a row of a scene's ``[flank]``."""

import math
from typing import Any

from .rexs_file import Component
from .rexs_gear import GearReader, outward, pitch_radius

EXPONENTS = {"linear": 1.0, "parabolic": 2.0, "circular": 2.0, None: 1.0}
UM = 1e3  # um per mm


def flank_row(reader: GearReader, gear: Component, row: dict[str, Any], name: str, loaded: str | None) -> dict[str, Any]:
    """Return the row of ``[flank]`` of a gear, which is empty if its flanks are involutes.

    The row is that of the loaded flank, ``left`` or ``right``. If that is unknown, it is the modified flank, with an assumption.
    """
    rows = {side: _one(reader, flank, gear, row, name) for side, flank in reader.flanks(gear).items()}
    if not any(rows.values()):
        return {}
    if len(rows) == 2 and rows["left"] == rows["right"]:
        return rows["left"] | {"both_sides": True}
    chosen = loaded if loaded in rows else max(rows, key=lambda side: len(rows[side]))
    if loaded not in rows:
        reader.assume(
            f"gear {name}: the {chosen} flank is loaded", "its flanks differ, and the file does not state which is loaded"
        )
    return rows[chosen]


def _one(reader, flank, gear, row, name):
    out: dict[str, Any] = {}
    chamfer = flank.number("tooth_tip_chamfer", "mm")
    if chamfer:
        out["tip_chamfer_mm"] = chamfer
    for one in reader.model.related("reference", "origin", flank.id, "referenced"):
        if one.type in READERS:
            READERS[one.type](reader, one, out, gear, row, name)
    return out


def _add(out, key, value):
    if value:
        out[key] = out.get(key, 0.0) + value


def _relief(end):
    def read(reader, one, out, gear, row, name):
        depth, shape = one.number(f"{end}_relief_depth", "mm"), one.value("shape_of_relief")
        if shape not in EXPONENTS:
            reader.assume(f"gear {name}: no {end} relief", f"gearfe has no relief of the shape {shape!r}")
            return
        if shape == "circular":
            reader.assume(f"gear {name}: parabolic {end} relief", "gearfe has no circular relief; both meet at start and tip")
        diameter = one.number(f"{end}_relief_datum_diameter", "mm")
        length = one.number(f"{end}_relief_datum_length", "mm")
        if not depth or (diameter is None and length is None):
            return
        start = {f"{end}_start_diameter_mm": diameter} if diameter is not None else {f"{end}_start_length_mm": length}
        at = one.number(f"{end}_relief_evaluation_reference", "mm")
        depth *= _extended(gear, row, diameter, at, EXPONENTS[shape]) if end == "tip" else 1.0
        out |= {f"{end}_relief_um": UM * depth, f"{end}_exponent": EXPONENTS[shape]} | start

    return read


def _extended(gear, row, start, at, exponent):
    """Return the ratio of the amount at the tip to the amount stated at the diameter `at`."""
    r = pitch_radius(row)
    tip = 2 * (r + (outward(gear) * row["addendum"] + row["x"]) * row["m_n_mm"])
    slope = math.tan(math.radians(row["alpha_n_deg"])) / math.cos(math.radians(row["beta_deg"]))
    base = 2 * r * math.cos(math.atan(slope))
    if at is None or start is None or abs(at - tip) < 1e-3 or min(at, start, tip) < base:
        return 1.0
    roll = [math.sqrt(d**2 - base**2) for d in (start, at, tip)]
    return abs((roll[2] - roll[0]) / (roll[1] - roll[0])) ** exponent if roll[1] != roll[0] else 1.0


def _profile_crowning(reader, one, out, gear, row, name):
    tip, root = (one.number(f"profile_crowning_at_{end}", "mm") or 0.0 for end in ("tip", "root"))
    _add(out, "profile_crowning_um", UM * root)
    _add(out, "profile_slope_um", UM * (tip - root))


def _profile_slope(reader, one, out, gear, row, name):
    value = one.number("profile_slope", "mm")
    if value is None and isinstance(listed := one.value("profile_slope", "mm"), list) and listed:
        value = float(listed[0])
    if value:
        reader.assume(f"gear {name}: profile slope removes material at the tip", "positive sign; REXS does not state the rule")
        _add(out, "profile_slope_um", UM * value)


def _ends(gear):
    """Return the indices of the datum face and of the other face, 0 for z = 0 and 1 for z = b."""
    return (1, 0) if gear.value("datum_face_orientation") == "positive" else (0, 1)


def _helix_crowning(reader, one, out, gear, row, name):
    amounts = [0.0, 0.0]
    for place, face in zip(_ends(gear), ("datum_face", "non_datum_face"), strict=True):
        amount = one.number(f"helix_crowning_amount_{face}", "mm") or 0.0
        at = one.number(f"coordinate_where_helix_crowning_is_specified_{face}", "mm")
        amounts[place] = amount * ((row["b_mm"] / 2 / at) ** 2 if at else 1.0)
    _add(out, "helix_crowning_um", UM * amounts[0])
    _add(out, "helix_slope_um", UM * (amounts[1] - amounts[0]))


def _helix_slope(reader, one, out, gear, row, name):
    value = one.number("helix_slope", "mm")
    if value:
        reader.assume(f"gear {name}: helix slope removes material at z = b", "positive sign; REXS does not state the rule")
        _add(out, "helix_slope_um", UM * value)


def _end_relief(face):
    def read(reader, one, out, gear, row, name):
        depth, length = one.number(f"end_relief_depth_{face}", "mm"), one.number(f"end_relief_length_{face}", "mm")
        if not depth or not length:
            return
        place = _ends(gear)[0 if face == "datum_face" else 1]
        for key, value in (("end_relief_um", UM * depth), ("end_length_mm", length)):
            out.setdefault(key, [0.0, 0.0])[place] = value
        out["end_exponent"] = EXPONENTS.get(one.value("shape_of_relief"), 2.0)

    return read


READERS = {
    "tip_relief": _relief("tip"), "root_relief": _relief("root"), "profile_crowning": _profile_crowning,
    "profile_slope": _profile_slope, "helix_crowning": _helix_crowning, "helix_slope": _helix_slope,
    "end_relief_datum_face": _end_relief("datum_face"), "end_relief_non_datum_face": _end_relief("non_datum_face"),
}  # fmt: skip
