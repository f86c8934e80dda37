"""Tables [flank.NAME] of a scene: their keys, how a row becomes a flank, and their commented lines in a new scene."""

import math

from ..geometry.pair.flanks import Misalignment, tilt_of
from ..geometry.tooth.modified import Flank
from .strict import NUMBER, NUMBERS, REQUIRED, TEXT, TWO, placed, sides

RELIEFS = {
    f"{end}_{key}": (NUMBER, default)
    for end in ("tip", "root")
    for key, default in (
        ("relief_um", 0.0),
        ("start_diameter_mm", None),
        ("start_roll_mm", None),
        ("start_angle_deg", None),
        ("start_length_mm", None),
        ("exponent", 1.0),
    )
}
FLANK = {
    "gear": (TEXT, REQUIRED),
    "pair": (TEXT, None),
    **RELIEFS,
    "crowning_um": (NUMBER, 0.0),
    "lead_crowning_um": (NUMBER, 0.0),
    "lead_slope_um": (NUMBER, 0.0),
    "twist_um": (NUMBER, 0.0),
    "end_relief_um": (TWO, [0.0, 0.0]),
    "end_length_mm": (TWO, [0.0, 0.0]),
    "end_exponent": (NUMBER, 2.0),
    "slope_um": (NUMBER, 0.0),
    "table_roll_mm": (NUMBERS, None),
    "table_removed_um": (NUMBERS, None),
    "pitch_um": (NUMBERS, None),
    "wear_roll_mm": (NUMBERS, None),
    "wear_um": (NUMBERS, None),
    "tip_rounding_mm": (NUMBER, 0.0),
    "tip_chamfer_mm": (NUMBER, 0.0),
    "tooth_scale": (NUMBERS, []),
    "eccentricity_um": (NUMBER, 0.0),
    "eccentric_tooth": (NUMBER, 0.0),
}
WORDS = """\
# What the flanks of a gear have less than the involute: um, positive is removed.
#[flank.pinion]
#gear = "pinion"
#pair = "stage"  # left out: in all its pairs
#tip_relief_um = {amount:.1f}  # at the tip, and where it starts, one of four:
#tip_start_length_mm = {length:.3f}  # so far below the tip, as a length of roll (along the line of action)
# tip_start_diameter_mm = {diameter:.3f}
# tip_start_roll_mm = {roll:.3f}  # roll length of the involute there
# tip_start_angle_deg = {angle:.3f}  # roll angle there
#tip_exponent = 1.0  # 1: linear; 2: parabolic
#root_relief_um = {amount:.1f}  # at the form point, and where it starts:
#root_start_length_mm = {length:.3f}  # so far above the form point; or root_start_diameter_mm, root_start_roll_mm,
# root_start_angle_deg
#root_exponent = 1.0
#crowning_um = 0.0  # of the profile: a parabola, so much at tip and form point
#slope_um = 0.0  # of the profile: so much at the tip, nothing at the form point
#lead_crowning_um = 0.0  # along the width: so much at both end faces
#lead_slope_um = 0.0  # along the width: so much at z = b, nothing at z = 0
#twist_um = 0.0  # at (tip, z = b) and (form point, z = 0)
#end_relief_um = [0.0, 0.0]  # at the end faces z = 0 and z = b, over end_length_mm
#end_length_mm = [0.0, 0.0]
#end_exponent = 2.0
#tip_rounding_mm = 0.0  # radius of the edge of the tip; or tip_chamfer_mm, a straight cut
#eccentricity_um = 0.0  # of the teeth off the axis, towards tooth eccentric_tooth
#eccentric_tooth = 0.0
# Measured: table_roll_mm = [...] with table_removed_um = [...]; wear_roll_mm with wear_um; for each tooth pitch_um (how far it
# lies behind its place) and tooth_scale (factor of its profile and lead).
{mate}"""
MATE_WORDS = """\
#[flank.wheel]  # with the same keys
#gear = "wheel"
#tip_relief_um = {amount:.1f}
#tip_start_length_mm = {length:.3f}
"""


def flanks_of(file, rows, name, pairs, gears):
    """Flanks of the pair `name` as `gearfe.mesh_stiffness` takes them, from the checked rows of a scene's [flank.NAME] tables.

    A flank of a gear is in all its pairs, or only in its `pair`: a planet meets the sun with one flank, the ring with the other.
    """
    out = {}
    for key, row in rows.items():
        where = f"flank.{key}"
        stands = sides(file, where, row, name, pairs, gears)
        flank = placed(file, where, lambda r=row: _flank(r, gears[r["gear"]]))
        for side in stands:
            if side in out:
                raise ValueError(
                    f"{file} [{where}]: gear {row['gear']!r} has a flank in pair {name!r} already; give each its pair"
                )
            placed(file, where, lambda flank=flank, gear=gears[row["gear"]]: flank.on(gear))
            out[side] = flank
    return out


MISALIGNMENT = {
    "F_beta_um": (NUMBER, 0.0),
    "f_sigma_beta_um": (NUMBER, 0.0),
    "f_sigma_delta_um": (NUMBER, 0.0),
    "bearing_span_mm": (NUMBER, None),
}


def misalignment_of(file, where, pair, row):
    """`Misalignment` of a scene's `pair`, from the checked keys of its table; None if it has none."""
    amounts = {name: row[f"{name}_um"] * 1e-3 for name in ("F_beta", "f_sigma_beta", "f_sigma_delta")}
    if not any(amounts.values()):
        return None
    misalignment = placed(file, where, lambda: Misalignment(**amounts, length=row["bearing_span_mm"]))
    placed(file, where, lambda: tilt_of(pair, misalignment))
    return misalignment


def _flank(row, gear):
    fields = {name: row[f"{name}_um"] * 1e-3 for name in ("crowning", "slope", "lead_crowning", "lead_slope", "twist")}
    fields |= {"end_relief": tuple(value * 1e-3 for value in row["end_relief_um"]), "end_exponent": row["end_exponent"]}
    fields["end_length"] = tuple(row["end_length_mm"])
    for end in ("tip", "root"):
        fields |= {f"{end}_relief": row[f"{end}_relief_um"] * 1e-3, f"{end}_exponent": row[f"{end}_exponent"]}
        fields |= {f"{end}_start_{how}": row[f"{end}_start_{how}_mm"] for how in ("diameter", "roll")}
        length = row[f"{end}_start_length_mm"]
        if length is not None:
            if row[f"{end}_start_roll_mm"] is not None:
                raise ValueError(f"{end}_start_length_mm and {end}_start_roll_mm: give one start")
            whole = abs(gear.roll_a - gear.roll_f)
            if not 0 < length < whole:
                raise ValueError(
                    f"{end}_start_length_mm = {length}, but the flank is {whole:.4g} mm of roll long: give a part of it"
                )
            down = gear.outward * length
            fields[f"{end}_start_roll"] = gear.roll_a - down if end == "tip" else gear.roll_f + down
        angle = row[f"{end}_start_angle_deg"]
        fields[f"{end}_start_angle"] = None if angle is None else math.radians(angle)
    for name, roll, amount in (("table", "table_roll_mm", "table_removed_um"), ("wear", "wear_roll_mm", "wear_um")):
        if (row[roll] is None) != (row[amount] is None):
            raise ValueError(f"give {roll} and {amount} together")
        if row[roll] is not None:
            fields[name] = row[roll], [value * 1e-3 for value in row[amount]]
    fields |= {f"tip_{edge}": row[f"tip_{edge}_mm"] for edge in ("rounding", "chamfer")}
    fields |= {"tooth_scale": row["tooth_scale"], "eccentricity": row["eccentricity_um"] * 1e-3}
    fields["eccentric_tooth"] = row["eccentric_tooth"]
    if row["pitch_um"] is not None:
        fields["pitch"] = [value * 1e-3 for value in row["pitch_um"]]
    return Flank(**fields)
