"""Slots in a pitch sector: their outlines in it, and the loops around its material and around the covered areas.

Sectors of one gear are joined at equal nodes. The vertices of all sides therefore include every radius at which a slot meets a
side. The covered area between two such vertices is meshed too, for a soft material.
"""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..aliases import Floats
from ..tooth.slot import Clockwise, Slot

CLEAR = 0.1  # least distance of the end of a slot from the side of a sector that it does not cross [slot widths]
COINCIDENT = 0.02  # Slots meet sides at one radius within this distance [slot widths].
ROUND = 8  # edges of a round end
TURNS = (-2 * math.pi, 0.0, 2 * math.pi)


class Piece(NamedTuple):
    """Part of the outline of a slot in a sector, clockwise around the slot, with the `params` of its vertices in `place`.

    `ends` are the numbers of its first and last vertex in the outline of the sector, or None for a whole outline.
    """

    params: Floats
    place: Callable[[Floats], Floats]
    ends: tuple[int, int] | None


def check_sides(gear, slots):
    """Raise ValueError if the end of a slot nearly touches a side of a sector, so that no triangle fits between both."""
    pitch = 2 * math.pi / gear.z
    for i, slot in enumerate(slots):
        reach = math.asin(slot.width / 2 / slot.radius)
        for end, outermost in ((slot.start, slot.start - reach), (slot.stop, slot.stop + reach)):
            off = slot.radius * abs(outermost % pitch - pitch / 2)
            if off < CLEAR * slot.width:
                raise ValueError(
                    f"slot {i}: its end at {math.degrees(end):.4g} degrees is {off:.2g} mm from the side of a sector of z = "
                    f"{gear.z}, where method = 'ritz' needs {CLEAR * slot.width:.2g} mm: use method = 'fe'"
                )


def relative_slots(slots, turn):
    """Return slots with angles relative to the angle `turn` [rad], rounded so that equal sectors are equal."""
    starts = [round((slot.start - turn + math.pi) % (2 * math.pi) - math.pi, 9) for slot in slots]
    return tuple(Slot(s.radius, s.width, a, a + round(s.stop - s.start, 9)) for a, s in zip(starts, slots, strict=True))


def near_slots(slots, pitch):
    """Return slots with any part between the angles ``-pitch`` and ``pitch``, one for each turn that has one."""
    out = []
    for slot in slots:
        reach = math.asin(slot.width / 2 / slot.radius)
        copies = (Slot(slot.radius, slot.width, slot.start + turn, slot.stop + turn) for turn in TURNS)
        out += [copy for copy in copies if copy.start - reach < pitch and copy.stop + reach > -pitch]
    return tuple(out)


def side_radii(gear, slots):
    """Return ascending radii [mm] at which slots meet the sides of sectors. One stands for those that nearly coincide."""
    found: set[float] = set()
    for tooth in range(gear.z) if slots else ():
        for slot in near_slots(relative_slots(slots, (2 * tooth + 1) * math.pi / gear.z), 0.0):
            shape = Clockwise(slot)
            found |= {round(float(np.hypot(*shape(at))), 9) for at in shape.crossings(0.0) or ()}
    radii = sorted(found)
    least = COINCIDENT * min((slot.width for slot in slots), default=0.0)
    return tuple(radius for before, radius in pairwise([-math.inf, *radii]) if radius - before > least)


def slot_pieces(slots, pitch, size, sides):
    """Return the `Piece` list of slots in a sector between the angles ``-pitch`` and ``pitch``.

    Parameters
    ----------
    slots : sequence of Slot
        Of `near_slots`.
    pitch : float
        Half the angle of the sector [rad].
    size : dict of Slot to (float, int)
        Edge length [mm] on the arcs of each slot, and number of edges of a round end.
    sides : (function, function)
        Of the left and the right side: from a point to the number of the vertex there.
    """
    out = []
    for slot in slots:
        shape = Clockwise(slot)
        whole, (left, right) = float(shape.bounds[-1]), (shape.crossings(angle) for angle in (-pitch, pitch))
        if left and right:
            parts = [(left[0], 0, right[0], 1), (right[1], 1, left[1], 0)]
        elif left:
            parts = [(left[0], 0, left[1], 0)]
        elif right:
            parts = [(right[1], 1, right[0], 1)]
        else:
            out.append(Piece(shape.vertices(0.0, whole, *size[slot]), shape, None))
            continue
        for first, start, last, stop in parts:
            ends = sides[start](shape(np.array(first))), sides[stop](shape(np.array(last)))
            out.append(Piece(shape.vertices(first, last + whole * (last < first), *size[slot]), shape, ends))
    return out


def numbered(parts, count):
    """Return the numbers of the vertices of each `Piece`, new ones from `count` on, and the points ``(2, n)`` of the new ones."""
    chains, points = [], [np.zeros((2, 0))]
    for params, place, ends in parts:
        inner = params[:-1] if ends is None else params[1:-1]
        new = count + np.arange(inner.size)
        chains.append(np.append(new, new[0]) if ends is None else np.array([ends[0], *new, ends[1]]))
        points.append(place(inner))
        count += inner.size
    return chains, np.hstack(points)


def loops_around(count, covered, chains):
    """Return loops of vertex numbers around the parts of the material, and around the areas that slots cover.

    Parameters
    ----------
    count : int
        Number of vertices of the sector's outline.
    covered : set of int
        Vertices of the outline from which an edge begins that lies in a slot.
    chains : list of ndarray
        Vertices of the pieces of slots.
    """
    outline = {k: (k + 1) % count for k in range(count)}
    solid = {k: to for k, to in outline.items() if k not in covered}
    soft = {k: to for k, to in outline.items() if k in covered}
    for chain in chains:
        solid |= dict(zip(chain[1:].tolist(), chain[:-1].tolist(), strict=True))
        if chain[0] != chain[-1]:
            soft |= dict(zip(chain[:-1].tolist(), chain[1:].tolist(), strict=True))
    return _cycles(solid), _cycles(soft)


def _cycles(following):
    out = []
    while following:
        cycle = [min(following)]
        while (to := following.pop(cycle[-1])) != cycle[0]:
            cycle.append(to)
        out.append(np.array(cycle))
    return out


def nearest(loop, numbers, point):
    """Return that of the vertices `numbers` of an outline which is nearest to a point."""
    return int(numbers[np.argmin(np.hypot(*(loop[:, numbers] - point[:, None])))])


def covered(loop, vertices, slots):
    """Return the vertices from which an edge of a side begins that lies in a slot."""
    begins = np.concatenate([vertices[name][:-1] for name in ("left", "right")])
    middles = (loop[:, begins] + loop[:, (begins + 1) % loop.shape[1]]) / 2
    return {int(k) for slot in slots for k in begins[slot.distance(middles) < 0]}


def merged(every, main, body, cycles, others):
    """Join triangulations at their common vertices. Return final numbers of the vertices `every`, points and triangles.

    The vertices of the loops `main` have the first numbers of `body`. The others are the loops `cycles`.
    """
    (points, triangles), final = body, np.full(every.shape[1], -1)
    loops = np.concatenate(main)
    final[loops] = np.arange(loops.size)
    points, triangles = [points], [triangles]
    count = points[0].shape[1]
    for cycle, (more, own) in zip(cycles, others, strict=True):
        number = np.append(final[cycle], np.full(more.shape[1] - cycle.size, -1))
        new = np.flatnonzero(number < 0)
        number[new] = count + np.arange(new.size)
        final[cycle], count = number[: cycle.size], count + new.size
        points.append(more[:, new])
        triangles.append(number[own])
    return final, np.hstack(points), np.hstack(triangles)
