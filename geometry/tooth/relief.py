"""Start of a tip or root relief."""

import math

from .gear import Gear

STARTS = ("diameter", "roll", "angle")  # quantities that define the start of a relief


def relief_start(gear: Gear, end: str, how: str, value: float) -> float:
    """Roll length [mm] at which the relief of the ``tip`` or ``root`` starts, given as one of `STARTS` [mm, mm, rad].

    ValueError if it is not inside the flank.
    """
    square = (value / 2) ** 2 - gear.r_b**2
    roll = {"diameter": math.sqrt(square) if square > 0 else math.nan, "roll": value, "angle": value * gear.r_b}[how]
    least, most = gear.flank_rolls
    if not (least <= roll <= most and abs(roll - (gear.roll_a if end == "tip" else gear.roll_f)) > 1e-6 * gear.m_n):
        limits = {"roll": (least, most, "mm"), "angle": (least / gear.r_b, most / gear.r_b, "rad")}
        radii = math.hypot(least, gear.r_b), math.hypot(most, gear.r_b)
        low, high, unit = (limits | {"diameter": (2 * radii[0], 2 * radii[1], "mm")})[how]
        raise ValueError(
            f"{end}_start_{how} = {value:g} {unit} is not inside the flank of z = {gear.z}, {low:.5g} to {high:.5g} {unit}"
        )
    return roll
