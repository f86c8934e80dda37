"""Pits of a scene: the keys of [[pits]], and the rows of pits that they describe."""

import math

from geometry.damage.pit import pit_row
from geometry.pair.pit_lines import in_both_halves, pit_line

from .strict import NUMBER, REQUIRED, TEXT, TRUTH, TWO, WHOLE

PITS = {
    "case": (TEXT, REQUIRED),
    "gear": (TEXT, REQUIRED),
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
    "tooth": (WHOLE, 0),
    "pair": (TEXT, None),
}


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
        found = pit_row(row["count"], first, first if last is None else last, **numbers)
        return found + (in_both_halves((made.gear_1, made.gear_2)[which], found, face) if row["both_halves"] else [])
    if last is not None:
        raise ValueError("last_mm goes with first_mm: about middle_mm give pitch_mm or span_mm")
    if row["count"] > 1 and (pitch is None) == (span is None):
        raise ValueError(
            f"{row['count']} pits about middle_mm: give pitch_mm, from one to the next, or span_mm, from first to last"
        )
    pitch = pitch if span is None else span / max(row["count"] - 1, 1)
    options = {"face": face, "groove": pair["groove_mm"], "both": row["both_halves"], "mirrored": row["mirrored"]}
    return pit_line(made, which, row["along"], row["count"], pitch, middle=middle, **options, **numbers)
