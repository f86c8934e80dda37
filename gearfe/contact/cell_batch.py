"""Contact problems of phases that are solved together, and their common data: equal halves, hub compliances, largest gap."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..geometry.aliases import Floats
from .cell_sharing import SharedLines
from .cells import Cells
from .pieces import gaps


class Carried(NamedTuple):
    """Load distribution of one mesh position under one force: `Cells`, approach [mm] and tangent stiffness [N/mm].

    Approach and stiffness are in the transverse section. `closed` is true if crack faces are in contact. The approach contains
    the deflection of the supports of the hubs. `given` is its mean, weighted with the loads, and `least` its smallest value
    over all cells [mm]. `unsure` is the part of the approach by which contacts at corners may slide. `sliding.off_path`
    describes `off_path`.
    """

    cells: Cells
    approach: float
    tangent: float
    closed: bool
    given: float
    least: float
    unsure: float
    off_path: float


class CellBatch(NamedTuple):
    """Contact problems of some phases, prepared for one force.

    `cells` are the cells of each phase. `solved` are the cells that are solved for: one of two equal halves, if `alike`. `lines`
    are their contact problems. `all` contains their cells in joined arrays, of which a phase has those of its slice in `spans`.
    `radius` are their relative radii of curvature in the normal section [mm]. `yields` is the compliance of the hubs
    (`hubs.given_way`) or None.
    `bodies` is described in `bodies.bodies_of`.
    """

    cells: list
    solved: list
    alike: np.ndarray
    lines: SharedLines
    all: Cells
    spans: list
    radius: Floats
    yields: list
    bodies: list


def hubs_of(held):
    """Return the compliances of both hubs, None for a rigid hub. Integral shafts are already part of the bodies."""
    outside = [None if one and one.integral else one for one in held]
    return [one and one.hub() for one in outside] if any(outside) else None


def furthest_gap(pair):
    """Return the largest gap beyond the path [mm]."""
    return max((float(gap[-1]) for _, gap in gaps(pair) if gap.size), default=0.0)


def same_bodies(one, two):
    """Return True if both halves of a pair have the same bodies."""
    return all(first is second for (first, _), (second, _) in zip(one, two, strict=True))


def alike_halves(cells, first, slack):
    """Return True if the cells of both halves are the same within `slack` [mm]. `first` are those of the first half."""
    half, mirrored = cells.some(first), cells.some(~first)
    if half.z.size != mirrored.z.size:
        return False
    names = ("order", "width", "depth", "nominal", "gap")
    return all(np.allclose(getattr(half, name), getattr(mirrored, name), rtol=0, atol=slack) for name in names)


def together(groups):
    """Return the `Cells` of several phases in one record, and the slice of each phase."""
    names = ("half", "order", "z", "width", "depth", "nominal", "roll_1", "roll_2", "gap", "corner", "floor", "radius")
    whole = Cells(*(np.concatenate([getattr(group, name) for group in groups]) for name in names))
    ends = np.cumsum([0, *(group.z.size for group in groups)]).tolist()
    return whole, [slice(first, last) for first, last in pairwise(ends)]
