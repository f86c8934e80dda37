"""Tables of damage in a scene: of each its keys, how a row becomes damage, and its commented lines in a new scene."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from ..geometry.damage.crack import Crack
from ..geometry.damage.kinds import Damage
from ..geometry.damage.pit import pit_row
from ..geometry.damage.spall import Spall
from ..geometry.pair.gear_pair import GearPair
from ..geometry.pair.pit_lines import in_both_halves, pit_line
from .strict import NUMBER, NUMBERS, REQUIRED, TEXT, TRUTH, TWO, WHOLE


class Table(NamedTuple):
    """A table ``[[name]]``: its `keys`; ``made(row, pair, which, table of the pair)`` gives its damage; `words` are its lines."""

    keys: dict[str, Any]
    made: Callable[[dict[str, Any], GearPair, int, dict[str, Any]], list[Damage]]
    words: str


PLACE = {"case": (TEXT, REQUIRED), "gear": (TEXT, REQUIRED), "tooth": (WHOLE, 0), "pair": (TEXT, None)}  # of all damage
CRACK = {
    **PLACE,
    "level": (NUMBER, None),
    "length_mm": (NUMBER, None),
    "angle_deg": (NUMBER, 45.0),
    "start": (TEXT, "30deg"),
    "turning": (TRUTH, False),
    "width_mm": (TWO, None),
    "ends": (NUMBERS, [1.0, 1.0]),
    "rounded": (TRUTH, False),
}
CRACK_WORDS = """\
# Cracks. A case may hold several, and pits; tables that name the same case belong together.
#
#        | centre-line      Each starts on the fillet below the loaded flank, and runs down to the centre-line of the tooth at
#     ___|___              angle_deg, the angle between crack and centre-line: 90 runs straight across, 45 is usual, small
#    /   |   \\             angles run down into the rim.
#   /    |    \\
#  /\\    |     \\           start: "30deg" or "60deg", where the fillet's tangent makes this angle with the centre-line;
# /  \\   |      \\                 "root", where the fillet meets the root circle; "middle" of the fillet's arc.
#     \\  |
#      \\ | angle_deg
#
#[[crack]]
#case = "cracked_part"
#gear = "pinion"
#length_mm = {crack:.2f}  # or level = 0.3: at 0.5 it reaches the centre-line
#angle_deg = 60.0
#start = "30deg"
#tooth = 0  # which: tooth 0 is the one whose engagement is looked at
#turning = false  # true, with level: at the centre-line it turns to the opposite fillet, level 1 is a tooth broken off
#width_mm = [0.0, {half:.2f}]  # open from height z to z; left out: over the whole width
#ends = [1.0, 0.0]  # part of its length that is open at both ends of width_mm: [1, 0] runs out; three numbers: a parabola
#rounded = false  # true: the front is parabolic, of three ends elliptic
#pair = "stage"  # only in this pair; left out: in all pairs of the gear
"""
PITS = {
    **PLACE,
    "radius_mm": (NUMBER, REQUIRED),
    "count": (WHOLE, 1),
    "first_mm": (NUMBER, None),
    "last_mm": (NUMBER, None),
    "along": (TEXT, "axis"),
    "middle_mm": (NUMBER, None),
    "pitch_mm": (NUMBER, None),
    "span_mm": (NUMBER, None),
    "mirrored": (TRUTH, False),
    "both_halves": (TRUTH, False),
    "axes_mm": (TWO, REQUIRED),
    "depth_mm": (NUMBER, REQUIRED),
    "angle_deg": (NUMBER, 0.0),
}
PIT_WORDS = """\
# Pits: a row of ellipses.
#[[pits]]
#case = "pitted"
#gear = "pinion"
#radius_mm = {pitch:.3f}  # of the circle their centres lie on; this is the pitch circle
#count = 5
#first_mm = {first:.2f}  # height of the first centre over z = 0
#last_mm = {last:.2f}  # and of the last
# or instead of these two, about the point at radius_mm and height middle_mm = {half:.2f}: with pitch_mm = {apart:.2f} from
# centre to centre, or span_mm from first to last, and along = "axis", "profile" (from root to tip) or "contact_line" (where
# the teeth touch at one moment; mirrored = true: inclined the other way)
#both_halves = false  # true: the mirrored row in the other half of a herringbone gear too
#axes_mm = [{axis:.2f}, {axis:.2f}]  # semi-axes along the profile and along the width
#depth_mm = {depth:.2f}
#angle_deg = 0.0  # of the axes, turned in the flank
#tooth = 0
#pair = "stage"
"""
SPALL = {
    **PLACE,
    "radius_mm": (NUMBER, REQUIRED),
    "z_mm": (NUMBER, REQUIRED),
    "sides_mm": (TWO, REQUIRED),
    "depth_mm": (NUMBER, REQUIRED),
    "corner_mm": (NUMBER, 0.0),
    "both_halves": (TRUTH, False),
}
SPALL_WORDS = """\
# Spalls: rectangles with rounded corners.
#[[spall]]
#case = "spalled"
#gear = "pinion"
#radius_mm = {pitch:.3f}  # of the circle its centre lies on; this is the pitch circle
#z_mm = {half:.2f}  # height of its centre
#sides_mm = [{apart:.2f}, {first:.2f}]  # along the profile and along the width
#depth_mm = {depth:.2f}
#corner_mm = {depth:.2f}  # radius of its corners
#both_halves = false  # true: its mirror image in the other half of a herringbone gear too
#tooth = 0
#pair = "stage"
"""


def crack_of(row, made, which, pair):
    """The crack of a checked row of `CRACK`."""
    numbers = {"level": row["level"], "length": row["length_mm"], "angle": math.radians(row["angle_deg"])}
    same = {key: row[key] for key in ("start", "turning", "tooth", "ends", "rounded")}
    return [Crack(**numbers, **same, width=row["width_mm"])]


def pits_of(row, made, which, pair):
    """Pits of a checked row of `PITS` on the pinion (`which` 0) or the wheel (1) of the pair `made` of a checked table `pair`.

    A row along the axis may be given by the heights of its first and its last pit, and may then lie in both halves of a
    herringbone gear; every row by the height of its middle, with the pitch from one pit to the next or the span of all.
    """
    first, last, middle, pitch, span = (row[f"{key}_mm"] for key in ("first", "last", "middle", "pitch", "span"))
    face = pair["face"] or ("helical" if made.gear_1.beta else "spur")
    numbers = {"radius": row["radius_mm"], "axes": tuple(row["axes_mm"]), "depth": row["depth_mm"], "tooth": row["tooth"]}
    numbers["angle"] = math.radians(row["angle_deg"])
    if (first is None) == (middle is None):
        raise ValueError("a row of pits begins at first_mm or has its middle at middle_mm: give one of them")
    if first is not None:
        if row["along"] != "axis" or pitch is not None or span is not None:
            raise ValueError(
                "first_mm and last_mm are of pits along the axis: for others give middle_mm with pitch_mm or span_mm"
            )
        pits = pit_row(row["count"], first, first if last is None else last, **numbers)
        return pits + (in_both_halves((made.gear_1, made.gear_2)[which], pits, face) if row["both_halves"] else [])
    if last is not None:
        raise ValueError("last_mm goes with first_mm: about middle_mm give pitch_mm or span_mm")
    if row["count"] > 1 and (pitch is None) == (span is None):
        raise ValueError(
            f"{row['count']} pits about middle_mm: give pitch_mm, from one to the next, or span_mm, from first to last"
        )
    pitch = pitch if span is None else span / max(row["count"] - 1, 1)
    options = {"face": face, "groove": pair["groove_mm"], "both": row["both_halves"], "mirrored": row["mirrored"]}
    return pit_line(made, which, row["along"], row["count"], pitch, middle=middle, **options, **numbers)


def spall_of(row, made, which, pair):
    """The spall of a checked row of `SPALL`, and its mirror image in the other half of a herringbone gear if asked for."""
    lengths = {key: row[f"{key}_mm"] for key in ("radius", "z", "sides", "depth", "corner")}
    spalls, face = [Spall(**lengths, tooth=row["tooth"])], pair["face"] or ("helical" if made.gear_1.beta else "spur")
    return spalls + (in_both_halves((made.gear_1, made.gear_2)[which], spalls, face) if row["both_halves"] else [])


TABLES = {
    "crack": Table(CRACK, crack_of, CRACK_WORDS),
    "pits": Table(PITS, pits_of, PIT_WORDS),
    "spall": Table(SPALL, spall_of, SPALL_WORDS),
}
DAMAGE = {name: table.keys for name, table in TABLES.items()}
