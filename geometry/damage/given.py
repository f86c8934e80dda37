"""Checks of arguments for all types of damage: finite numbers, tooth number, and side of a tooth."""

from typing import Any

from ..checks import is_finite, is_whole, shown


def finite(noun: str, name: str, value: object) -> float:
    """Return the number as a float. Raises ValueError with its `noun` if it is not finite."""
    if not is_finite(value):
        raise ValueError(f"{name} = {shown(value)}, but this value of a {noun} must be a finite number")
    return float(value)


def settle_hollow(hollow: Any, extent: str, about: str, more: str) -> None:
    """Replace the numbers of a hollow by floats and its two lengths `extent`, which are `about` something, by a tuple of floats.

    `more` is a further number of it. ValueError if one is no finite number, or radius or depth is not positive.
    """
    noun, lengths = hollow._nouns[0], getattr(hollow, extent)
    try:
        lengths = tuple(lengths)
    except TypeError:
        lengths = ()
    if len(lengths) != 2 or isinstance(getattr(hollow, extent), str):
        raise ValueError(f"{extent} = {getattr(hollow, extent)!r}, but give two {about} [mm]: along the profile, along the width")
    for name in ("radius", "z", "depth", more):
        object.__setattr__(hollow, name, finite(noun, name, getattr(hollow, name)))
    object.__setattr__(hollow, extent, tuple(finite(noun, extent, value) for value in lengths))
    object.__setattr__(hollow, "tooth", tooth_and_side(hollow.tooth, hollow.side))
    for name, value in (("radius", hollow.radius), ("depth", hollow.depth), (extent, min(getattr(hollow, extent)))):
        if not value > 0:
            raise ValueError(f"{name} = {getattr(hollow, name)}, but it must be positive [mm]")


def tooth_and_side(tooth: object, side: object) -> int:
    """Return the number of a tooth.

    Raises ValueError if it is not a whole number, or the side neither loaded nor unloaded.
    """
    if not is_whole(tooth):
        raise ValueError(f"tooth = {tooth!r}, but it must be a whole number")
    if not isinstance(side, str) or side not in ("loaded", "unloaded"):
        raise ValueError(f"side = {side!r}, but it must be 'loaded' or 'unloaded'")
    return int(tooth)
