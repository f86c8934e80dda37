"""What every kind of damage is given: finite numbers, the number of a tooth, a side of it."""

from typing import Any

from ..checks import is_finite, is_whole


def finite(noun: str, name: str, value: object) -> float:
    """A finite number; ValueError naming the `noun` it is of if it is none."""
    if not is_finite(value):
        raise ValueError(f"{name} = {value!r}, but a {noun} needs a finite number here")
    return float(value)


def tooth_and_side(tooth: object, side: object) -> int:
    """The number of a tooth; ValueError if it is none, or the side is none."""
    if not is_whole(tooth):
        raise ValueError(f"tooth = {tooth!r}, but it is a whole number")
    if side not in ("loaded", "unloaded"):
        raise ValueError(f"side = {side!r}, but it must be 'loaded' or 'unloaded'")
    return int(tooth)


def check_hollow(hollow: Any, names: tuple[str, ...], extents: str, told: str) -> None:
    """Bring the numbers of a hollow into one form: `names`, its tooth, and two `extents`, which are `told` in words.

    Raises
    ------
    ValueError
        If one is no finite number, or radius or depth is not positive.
    """
    given, noun = getattr(hollow, extents), hollow.nouns[0]
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        raise ValueError(f"{extents} = {given!r}, but give two {told} [mm]: along the profile, along the width")
    for name in names:
        object.__setattr__(hollow, name, finite(noun, name, getattr(hollow, name)))
    object.__setattr__(hollow, extents, tuple(finite(noun, extents, value) for value in given))
    object.__setattr__(hollow, "tooth", tooth_and_side(hollow.tooth, hollow.side))
    for name in ("radius", "depth"):
        if not getattr(hollow, name) > 0:
            raise ValueError(f"{name} = {getattr(hollow, name)}, but it must be positive [mm]")
