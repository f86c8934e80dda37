"""Contacts of missing teeth and chipped tips."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..geometry.damage.chip import Chip
from ..geometry.damage.missing import MissingTooth
from ..geometry.pair.contacts import Touch, touching
from ..geometry.pair.gear_pair import GearPair, with_tips


def with_broken(points, pair, flexibility, extended):
    """Contacts of a pair with missing teeth and chipped tips, and ends of the path ``(2, pairs)`` [mm].

    A missing tooth has an infinite gap. The flank of a chipped one ends at its corner. ValueError if no pair is left at a phase.
    """
    path = np.tile(np.array(pair.path)[:, None], points.order.size)
    points = _chipped(points, pair, flexibility, extended, path)
    gone = np.zeros(points.order.size, dtype=bool)
    for gear, own, teeth in zip((pair.gear_1, pair.gear_2), flexibility, (points.order, -points.order), strict=True):
        gone |= np.isin(teeth % gear.z, [tooth % gear.z for tooth in getattr(own, "missing", ())])
    if not gone.any():
        return points, path
    gap = np.where(gone, np.inf, points.gap)
    if not np.isfinite(gap).any(axis=1).all():
        raise ValueError(
            "at some phases no teeth but a missing one are near each other: leave contact off the path on (extended = True), or "
            "take a pair with a larger contact ratio"
        )
    return replace(points, gap=gap, corner_gap=np.where(gone, np.inf, points.corner_gap)), path


def broken_at(pair: GearPair, broken: Sequence[Any], order: int) -> tuple[MissingTooth | Chip | None, ...]:
    """What has broken off of both teeth of a tooth pair."""
    gears = zip((pair.gear_1, pair.gear_2), broken, (order, -order), strict=True)
    return tuple(next((one for one in own if (one.tooth - tooth) % gear.z == 0), None) for gear, own, tooth in gears)


def pair_at(pair: GearPair, broken: Sequence[Any], order: int) -> GearPair | None:
    """The pair with the tips of the teeth of a tooth pair; None if one of them is missing."""
    found = broken_at(pair, broken, order)
    if any(isinstance(one, MissingTooth) for one in found):
        return None
    gears = zip((pair.gear_1, pair.gear_2), found, strict=True)
    return with_tips(pair, [one and one.end_roll(gear, "loaded") for gear, one in gears]) if any(found) else pair


def touching_each(pair_of: Callable[[int], GearPair], order: NDArray, nominal: NDArray) -> Touch:
    """`touching` of sections ``(n,)`` of the tooth pairs `order`, each with its own tips."""
    numbers = np.unique(order).tolist()
    found = touching(pair_of(numbers[0]), nominal)
    for number in numbers[1:]:
        if pair_of(number) != pair_of(numbers[0]):
            on = order == number
            for values, own in zip(found, touching(pair_of(number), nominal[on]), strict=True):
                values[..., on] = own
    return found


def _chipped(points, pair, flexibility, extended, path):
    """Contacts in which flanks end at the corners of chips; the ends of their path are put into `path`."""
    cut = [getattr(own, "tips", {}) for own in flexibility]
    if not any(cut):
        return points
    found = {name: getattr(points, name).copy() for name in Touch._fields}
    for k, order in enumerate(points.order.tolist()):
        ends = [tips.get(tooth % own.gear.z) for tips, own, tooth in zip(cut, flexibility, (order, -order), strict=True)]
        if any(ends):
            short = with_tips(pair, [end and end[0] for end in ends])
            path[:, k] = short.path
            for name, values in touching(short, points.nominal[:, k], extended=extended)._asdict().items():
                found[name][..., k] = values
    return replace(points, **found)
