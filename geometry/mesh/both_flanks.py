"""The section of a whole gear whose teeth may be loaded on either flank, with vertices on the held circle where wanted."""

import math
from dataclasses import dataclass

import numpy as np
from skfem import MeshTri2

from ..tooth.gear import Gear
from .outline import _doubled, half, held_circle, spaced, stations
from .section_mesh import fill

GROWTH = 0.3  # of the edge length of the held circle per length, away from its marks


@dataclass(frozen=True, slots=True)
class BothFlanks:
    """A meshed gear: `mesh` [mm] with boundaries ``rim`` and ``held`` as of `Section`.

    `flank` holds the vertices from root to tip of the flanks asked for, by tooth and side (0 right, 1 left).
    """

    gear: Gear
    mesh: MeshTri2
    flank: dict


def both_flanks(gear, rolls, *, fillet_size, size, far_size, marks=(), mark_size=0.0, held_size=math.inf):
    """Mesh the whole section of `gear`.

    Parameters
    ----------
    gear : Gear
    rolls : dict of (int, int) to ndarray
        Roll lengths of flank vertices from root to tip [mm], by tooth and side.
    fillet_size, size, far_size : float
        Edge lengths of the loaded teeth's fillets, of the teeth beside them and of all others [mm].
    marks : sequence of float
        Angles on the held circle where there is to be a vertex [rad], with edges of `mark_size` there and of at most `held_size`
        elsewhere [mm].

    Returns
    -------
    BothFlanks
    """
    coarse, far = (half(gear, stations(gear, s), s, s) for s in (size, far_size))
    loaded = {tooth for tooth, _ in rolls}
    beside = {(tooth + k) % gear.z for tooth in loaded for k in (-1, 1)}
    radii, angles, flanks, count = [], [], {}, 0
    for tooth in range(gear.z):
        turn, after = 2 * math.pi * tooth / gear.z, (tooth + 1) % gear.z
        right, left = (
            half(gear, rolls.get(one, stations(gear, size)), fillet_size, size)
            if one[0] in loaded
            else (coarse if one[0] in beside else far)
            for one in ((tooth, 0), (after, 1))
        )
        radii += [right.radius, [gear.r_f], left.radius[:0:-1]]
        angles += [turn + right.angle, [turn + math.pi / gear.z], turn + 2 * math.pi / gear.z - left.angle[:0:-1]]
        flanks[tooth, 0] = (count + right.flank)[::-1]
        count += (right.radius.size + left.radius.size) // 2
        flanks[after, 1] = (count - left.flank)[::-1]
    flanks = {key: flanks[key] % count for key in rolls}
    radius, angle = np.concatenate(radii), np.concatenate(angles)
    held = _marked(gear, marks, mark_size, held_size) if len(marks) else held_circle(gear)
    mesh, _ = fill(np.array([radius * np.sin(angle), radius * np.cos(angle)]), held, ring=gear.internal)
    return BothFlanks(gear, mesh, flanks)


def _marked(gear, marks, fine, longest):
    """The held circle with vertices at `marks`, finer next to them; vertices at even places, edge middles at odd."""
    at, out = np.unique(np.asarray(marks) % (2 * math.pi)), []
    size = min(0.35 * abs(gear.r_f - gear.held), 2 * math.pi * gear.held / 16, longest)
    for first, last in zip(at, np.append(at[1:], at[0] + 2 * math.pi), strict=True):
        length = (last - first) * gear.held
        place = spaced(0.0, length, min(size, length / 2), [(0.0, 0.0, fine), (length, length, fine)], 1, GROWTH) / gear.held
        out.append(first + _doubled(place)[:-1])
    angle = np.concatenate(out)
    return gear.held * np.array([np.sin(angle), np.cos(angle)])
