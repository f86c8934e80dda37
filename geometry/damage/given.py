"""What every kind of damage is given: finite numbers, the number of a tooth, a side of it."""

import math
from numbers import Integral, Real


def finite(noun: str, name: str, value: object) -> float:
    """A finite number; ValueError naming the `noun` it is of if it is none."""
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
        raise ValueError(f"{name} = {value!r}, but a {noun} needs a finite number here")
    return float(value)


def tooth_and_side(tooth: object, side: object) -> int:
    """The number of a tooth; ValueError if it is none, or the side is none."""
    if isinstance(tooth, bool) or not isinstance(tooth, Integral):
        raise ValueError(f"tooth = {tooth!r}, but it is a whole number")
    if side not in ("loaded", "unloaded"):
        raise ValueError(f"side = {side!r}, but it must be 'loaded' or 'unloaded'")
    return int(tooth)
