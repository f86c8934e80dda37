"""Tooth pairs with missing teeth and chipped tips: removed material, remaining tips and their contact."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..damage.chip import Chip
from ..damage.missing import MissingTooth
from .contacts import Touch, touching
from .gear_pair import GearPair, with_tips


class ToothPairs:
    """Tooth pairs with the tips of their teeth, by their number and the part of the face width.

    Ends of chips divide the face width into parts, numbered from z = 0. Gears of different width lie centred on each other.

    Parameters
    ----------
    pair : GearPair
    broken : (sequence, sequence) of (MissingTooth or Chip)
        Of pinion and wheel, teeth numbered in each gear's own frame.
    """

    def __init__(self, pair: GearPair, broken: Sequence[Sequence[Any]] = ((), ())) -> None:
        self.pair, self.broken = pair, broken
        common = pair.b_w
        self._beyond = [(gear.b - common) / 2 for gear in pair.gears]
        ends = [
            np.subtract(one.width, far) for own, far in zip(broken, self._beyond, strict=True) for one in own if not one.through
        ]
        self._heights = np.unique([0.0, common, *np.clip(np.ravel(ends), 0.0, common)])
        self._made: dict[Any, GearPair | None] = {}

    def parts(self, z: Any) -> NDArray[np.int64]:
        """Return the numbers of the parts of the face width in which heights lie [mm]."""
        return np.searchsorted(self._heights[1:-1], z)

    def broken_at(self, order: int, part: int = 0) -> tuple[MissingTooth | Chip | None, ...]:
        """Return the missing tooth or chip of both teeth of a pair in a part of the face width."""
        gears = zip(self.pair.gears, self.broken, (order, -order), self._beyond, strict=True)
        z = self._heights[part : part + 2].mean()
        return tuple(
            next(
                (
                    one
                    for one in own
                    if (one.tooth - tooth) % gear.z == 0 and (one.through or one.width[0] <= z + far <= one.width[1])
                ),
                None,
            )
            for gear, own, tooth, far in gears
        )

    def __call__(self, order: int, part: int = 0) -> GearPair | None:
        """Return the pair with the tips of both teeth in a part of the face width, or None if a tooth is missing."""
        found = self.broken_at(order, part)
        key = tuple(one and replace(one, tooth=0) for one in found)
        if key not in self._made:
            gears = zip(self.pair.gears, found, strict=True)
            ends = [one.end_roll(gear, "loaded") if isinstance(one, Chip) else None for gear, one in gears]
            whole = self.pair if not any(found) else with_tips(self.pair, ends)
            self._made[key] = None if any(isinstance(one, MissingTooth) for one in found) else whole
        return self._made[key]

    def along(self, order: int, band: tuple[float, float]) -> list[tuple[GearPair | None, float, float]]:
        """Return the different pairs along a band of the face width, each with two depths from the band's first end [mm]."""
        first, last = band
        if self._heights.size == 2:
            return [(self(order), 0.0, abs(last - first))]
        ends = np.unique(np.abs(np.clip(self._heights, min(band), max(band)) - first))
        sense = 1 if last > first else -1
        out: list[tuple[GearPair | None, float, float]] = []
        for low, high in pairwise(ends.tolist()):
            own = self(order, int(self.parts(first + sense * (low + high) / 2)))
            out.append((own, out.pop()[1] if out and out[-1][0] is own else low, high))
        return out


def each_pair(pairs: ToothPairs, order: NDArray, z: NDArray, found_of: Callable[[Any, Any], Touch]) -> Touch:
    """Return the `Touch` of the tooth pairs `order` ``(n,)`` at heights `z` [mm], where broken teeth have their own tips.

    ``found_of(pair, on)`` solves the sections that `on` selects (an index or a mask), with the tips of `pair`.
    """
    part = pairs.parts(z)
    (first, *others) = sorted(set(zip(order.tolist(), part.tolist(), strict=True)))
    found = found_of(pairs(*first), slice(None))
    for own in others:
        if pairs(*own) != pairs(*first):
            on = (order == own[0]) & (part == own[1])
            for values, ours in zip(found, found_of(pairs(*own), on), strict=True):
                values[..., on] = ours
    return found


def touching_each(pairs: ToothPairs, order: NDArray, z: NDArray, nominal: NDArray) -> Touch:
    """Return `touching` of unmodified sections ``(n,)`` of the tooth pairs `order` at heights `z` [mm], with their own tips."""
    return each_pair(pairs, order, z, lambda pair, on: touching(pair, nominal[on]))
