"""Checks of arguments of all types of damage: finite numbers, the number of a tooth, a side of it."""

import math
from numbers import Integral, Real


def finite(noun: str, name: str, value: object) -> float:
    """Return the number as a float; ValueError with its `noun` if it is not finite."""
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
        raise ValueError(f"{name} = {value!r}, but a {noun} needs a finite number here")
    return float(value)


def tooth_and_side(tooth: object, side: object) -> int:
    """Return the number of a tooth; ValueError if it is not a whole number, or the side neither loaded nor unloaded."""
    if isinstance(tooth, bool) or not isinstance(tooth, Integral):
        raise ValueError(f"tooth = {tooth!r}, but it is a whole number")
    if side not in ("loaded", "unloaded"):
        raise ValueError(f"side = {side!r}, but it must be 'loaded' or 'unloaded'")
    return int(tooth)
