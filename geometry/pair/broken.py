"""Tooth pairs with missing teeth and chipped tips: lost material, remaining tips and their contact."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..damage.chip import Chip
from ..damage.missing import MissingTooth
from .contacts import Touch, touching
from .gear_pair import GearPair, with_tips


def broken_at(pair: GearPair, broken: Sequence[Any], order: int) -> tuple[MissingTooth | Chip | None, ...]:
    """Return the missing teeth or chips of both teeth of a tooth pair."""
    gears = zip((pair.gear_1, pair.gear_2), broken, (order, -order), strict=True)
    return tuple(next((one for one in own if (one.tooth - tooth) % gear.z == 0), None) for gear, own, tooth in gears)


def pair_at(pair: GearPair, broken: Sequence[Any], order: int) -> GearPair | None:
    """Return the pair with the tips of the teeth of a tooth pair, or None if one of them is missing."""
    found = broken_at(pair, broken, order)
    if any(isinstance(one, MissingTooth) for one in found):
        return None
    gears = zip((pair.gear_1, pair.gear_2), found, strict=True)
    ends = [one.end_roll(gear, "loaded") if isinstance(one, Chip) else None for gear, one in gears]
    return with_tips(pair, ends) if any(found) else pair


def each_pair(pair_of: Callable[[int], GearPair], order: NDArray, found_of: Callable[[GearPair, Any], Touch]) -> Touch:
    """Return the `Touch` of sections ``(n,)`` of the tooth pairs `order`, each with its own tips.

    ``found_of(pair, on)`` solves the sections `on`, an index or a mask, with the tips of `pair`.
    """
    numbers = np.unique(order).tolist()
    found = found_of(pair_of(numbers[0]), slice(None))
    for number in numbers[1:]:
        if pair_of(number) != pair_of(numbers[0]):
            on = order == number
            for values, own in zip(found, found_of(pair_of(number), on), strict=True):
                values[..., on] = own
    return found


def touching_each(pair_of: Callable[[int], GearPair], order: NDArray, nominal: NDArray) -> Touch:
    """`touching` of unmodified sections ``(n,)`` of the tooth pairs `order`, each with its own tips."""
    return each_pair(pair_of, order, lambda pair, on: touching(pair, nominal[on]))
