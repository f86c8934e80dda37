"""Checks of arguments for all types of damage: finite numbers, tooth number, and side of a tooth."""

from ..checks import is_finite, is_whole, shown


def finite(noun: str, name: str, value: object) -> float:
    """Return the number as a float. Raises ValueError with its `noun` if it is not finite."""
    if not is_finite(value):
        raise ValueError(f"{name} = {shown(value)}, but this value of a {noun} must be a finite number")
    return float(value)


def tooth_and_side(tooth: object, side: object) -> int:
    """Return the number of a tooth.

    Raises ValueError if it is not a whole number, or the side neither loaded nor unloaded.
    """
    if not is_whole(tooth):
        raise ValueError(f"tooth = {tooth!r}, but it must be a whole number")
    if not isinstance(side, str) or side not in ("loaded", "unloaded"):
        raise ValueError(f"side = {side!r}, but it must be 'loaded' or 'unloaded'")
    return int(tooth)
