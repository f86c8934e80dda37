"""Pitch sector of a gear with tooth and rim, in a few large curved triangles for high-order methods.

The outline is exact. Every boundary edge stores the deviation of its curve from its chord, by the curve's parameter.
"""

import math
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..aliases import Floats
from ..damage.crack import check_sector, meshed_path
from ..damage.seam import open_seam
from ..tooth.profile import fillet_length
from .mesher import triangulate
from .outline import inside, spaced
from .sector_outline import GROWTH, outline_pieces
from .slotted_sector import ROUND, covered, loops_around, merged, nearest, numbered, slot_pieces
from .triangle import BULGE, ENDS, GAUSS, jacobians

# Edge lengths [m_n]: loaded flank, other flank, tip corner of the loaded flank, form point with a kink, fillet,
# root arc, sides and tip, crack, crack tip
SIZES = {
    "flank": 0.8,
    "back": 0.8,
    "corner": 0.003,
    "kink": 0.03,
    "fillet": 0.5,
    "root": 0.8,
    "side": 0.8,
    "crack": 0.5,
    "crack tip": 0.004,
}
FLAT = 1e-6  # least area relative to the squared longest edge; three points of a straight crack would enclose no area
ON_LINE = 0.05  # Points of a ring lie on the line of a crack within this distance, relative to the ring's radius.
CHECKED = 6  # polynomial order whose quadrature points are used to check the maps


@dataclass(frozen=True, slots=True)
class Sector:
    """A sector from half a pitch before the tooth's centre-line (`left`) to half a pitch after it (`right`).

    Attributes
    ----------
    points : ndarray, shape (2, n)
        Vertices [mm].
    triangles : ndarray, shape (3, m)
        Counter-clockwise.
    bulge : dict of (int, int) to ndarray, shape (2, k)
        By boundary edge: (curve - chord) / (1 - s**2) [mm] at k Gauss points s in (-1, 1).
    left, right : ndarray
        Vertices of the sides from the held edge to the root.
    held : ndarray
        Vertices on the held edge.
    flank, roll : ndarray
        Vertices of the loaded flank from root to tip and their roll lengths [mm]; edges are linear in the roll.
    faces : tuple of ndarray, shape (2, k)
        Vertices of the two faces (left, right) of each crack from mouth to tip, the tip shared.
    solid : int
        Number of triangles of the material, which are the first ones. The others are in slots.
    edge_bulges : ndarray, shape (3, 2, k, m)
        Bulges of the local edges of all triangles, zero inside.
    """

    points: np.ndarray
    triangles: np.ndarray
    bulge: dict
    left: np.ndarray
    right: np.ndarray
    held: np.ndarray
    flank: np.ndarray
    roll: np.ndarray
    faces: tuple
    solid: int
    edge_bulges: np.ndarray = field(init=False)

    def __post_init__(self):
        """Compute the bulges by triangle from those by edge."""
        count, values = self.points.shape[1], np.array(list(self.bulge.values()))
        first, second = np.array(list(self.bulge), dtype=np.int64).T
        keys, values = np.append(first * count + second, second * count + first), np.concatenate([values, values[..., ::-1]])
        order = np.argsort(keys)
        wanted = np.array([self.triangles[a].astype(np.int64) * count + self.triangles[b] for a, b in ENDS])
        at = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), keys.size - 1)]
        found = np.where((keys[at] == wanted)[..., None, None], values[at], 0.0)
        out = np.ascontiguousarray(found.transpose(0, 2, 3, 1))
        out[..., self.solid :] = 0.0  # The shape of slots does not matter.
        object.__setattr__(self, "edge_bulges", out)


def sector(gear, cracks=(), *, broken=None, refine=1.0, sizes=None, cuts=(), slots=(), radii=()):
    """Mesh the `Sector` of a gear with the cracks of its tooth. The tooth may be `broken` (`MissingTooth` or `Chip`).

    `refine` divides the edge lengths; `sizes` [m_n] replace those of `SIZES`. The held edge has vertices at the angles `cuts`
    [rad] from the centre-line, positive towards the loaded side. `slots` are the `near_slots` of the sector and `radii` [mm] the
    `side_radii` of the gear (`gearfe.geometry.mesh.slotted_sector`). ValueError if `refine` is not positive, RuntimeError if no
    valid triangles were found.
    """
    if not (math.isfinite(refine) and refine > 0):
        raise ValueError(f"refine = {refine}, but it divides the edge lengths: give refine > 0, 1 is the default")
    for finer in (1.0, 1.4, 2.0, 2.8):
        made = _attempt((gear, cracks, broken, tuple(cuts), tuple(slots), tuple(radii)), SIZES | (sizes or {}), refine, finer)
        if made is not None:
            return made
    raise RuntimeError(f"z = {gear.z}: no valid coarse triangles for this tooth; use method = 'fe'")


class _Outline(NamedTuple):
    """Outline of a sector with its slots.

    `every` are all vertices ``(2, n)`` [mm]. `vertices` are the numbers along each piece of the outline by name, and `roll` the
    roll lengths of the flank [mm]. `curves` are parameters, points by parameter and numbers of vertices of all curved pieces.
    `main` are the loops around the tooth and around holes near it, `others` those around other material, `areas` those in slots.
    """

    every: Floats
    vertices: dict
    roll: Floats
    curves: list
    main: list
    others: list
    areas: list


def _outlined(described, size, rounded):
    """Return the `_Outline` of a sector with these edge lengths [mm], and `rounded` edges along the round end of a slot."""
    gear, cracks, broken, cuts, slots, radii = described
    pieces = outline_pieces(gear, size, cracks, broken, cuts, radii)
    first = np.cumsum([0, *(params.size - 1 for _, params, _ in pieces)])
    loop = np.hstack([place(params[:-1]) for _, params, place in pieces])
    count = loop.shape[1]
    runs = [np.arange(a, b + 1) % count for a, b in pairwise(first)]
    vertices = {name: run for (name, _, _), run in zip(pieces, runs, strict=True)}
    curves = [(params, place, run) for (_, params, place), run in zip(pieces, runs, strict=True)]
    roll = next((params for name, params, _ in pieces if name == "flank"), np.zeros(0))
    if not slots:
        return _Outline(loop, vertices, roll, curves, [np.arange(count)], [], [])
    sides = [partial(nearest, loop, vertices[name]) for name in ("left", "right")]
    edge = {slot: (min(size["root"], 1.5 * slot.ligament(gear)), rounded) for slot in slots}
    parts = slot_pieces(slots, math.pi / gear.z, edge, sides)
    lines, inner = numbered(parts, count)
    curves += [(params, place, line) for (params, place, _), line in zip(parts, lines, strict=True)]
    around, areas = loops_around(count, covered(loop, vertices, slots), lines)
    tooth = [cycle for cycle in around if vertices["left"][-1] in cycle]
    holes = [cycle for cycle in around if cycle.min() >= count]  # These slots lie inside the sector.
    others = [cycle for cycle in around if cycle.min() < count and cycle is not tooth[0]]
    return _Outline(np.hstack([loop, inner]), vertices, roll, curves, tooth + holes, others, areas)


def _attempt(described, sizes, refine, finer):
    """Return a sector with edges (except on its sides) divided by `finer`, or None if it folds."""
    gear, cracks = described[:2]
    size = {name: length * gear.m_n / refine / (1.0 if name == "side" else finer) for name, length in sizes.items()}
    size["fillet"] = min(size["fillet"], fillet_length(gear) / 2 / finer)
    outline = _outlined(described, size, round(ROUND * finer))
    every, vertices, cycles = outline.every, outline.vertices, [*outline.others, *outline.areas]
    loops = [every[:, cycle] for cycle in outline.main]
    chains, free = _chains(gear, size, cracks, loops)
    if chains and not _within(loops, np.hstack([line for _, line in chains] + [free])):
        return None  # A chord of the outline cuts the crack off, and gmsh would not terminate.
    bodies = [_filled(loops, chains, free.T), *(_filled([every[:, cycle]]) for cycle in cycles)]
    if any(body is None for body in bodies):
        return None
    points, triangles, faces, doubles = _opened(*bodies[0], chains, sum(cycle.size for cycle in outline.main))
    final, points, triangles = merged(every, outline.main, (points, triangles), cycles, bodies[1:])
    left, right = (_apart(final[side], triangles, doubles) for side in (vertices["left"], vertices["right"][::-1]))
    made = Sector(
        points, triangles, _bulges(outline.curves, final, doubles), left, right, final[vertices["held"]],
        final[vertices.get("flank", np.zeros(0, dtype=int))[::-1]], outline.roll[::-1], tuple(faces),
        sum(body[1].shape[1] for body in bodies[: 1 + len(outline.others)]),
    )  # fmt: skip
    bulges = made.edge_bulges
    bent = bulges.any(axis=(0, 1, 2))  # The other triangles are straight, so checking their corners is sufficient.
    (xx, xy), (yx, yy) = jacobians(points, triangles[:, bent], bulges[..., bent], CHECKED).transpose(1, 2, 0, 3)
    return made if (xx * yy - xy * yx).min() > 0 else None


def _within(loops, points):
    """Return whether points lie inside the first loop and outside of the others."""
    return inside(loops[0], points).all() and not any(inside(hole, points).any() for hole in loops[1:])


def _filled(loops, chains=(), free=()):
    """Return points and triangles, counter-clockwise, between loops, or None if a triangle is flat."""
    points, triangles = triangulate(loops, chains, False, free)
    twice = _twice_areas(points, triangles)
    if twice.sum() < 0:
        triangles, twice = triangles[[0, 2, 1]], -twice
    longest = np.hypot(*(points[:, triangles] - points[:, triangles[[1, 2, 0]]])).max(axis=0)
    return None if (twice <= 2 * FLAT * longest**2).any() else (points, triangles)


def _apart(side, triangles, doubles):
    """Return a side that ends at the crack face on this side, if its corner is a crack mouth."""
    before, corner = side[-2:]
    if corner in doubles and not ((triangles == before).any(axis=0) & (triangles == corner).any(axis=0)).any():
        return np.append(side[:-1], doubles[int(corner)])
    return side


def _twice_areas(points, triangles):
    """Twice the areas of triangles, negative if their corners run clockwise."""
    corner, second, third = points[:, triangles].transpose(1, 0, 2)
    (x, y), (u, v) = second - corner, third - corner
    return x * v - y * u


def _opened(points, triangles, chains, at):
    """Double the crack nodes: points, triangles, node pairs of each crack, and the second node of each mouth by its first."""
    faces, doubles = [], {}
    for i, (start, line) in enumerate(chains):
        if i % 2 == 0:  # Odd chains only guide the mesh ahead of the crack tip.
            chain = np.append(start, at + np.arange(line.shape[1]))
            points, triangles, double = open_seam(points, triangles, chain)
            faces.append(np.array([chain, double]))
            doubles[start] = int(double[0])
        at += line.shape[1]
    return points, triangles, faces, doubles


def _chains(gear, size, cracks, loops):
    """Return for each crack its rim vertex and path, followed by the tip and a guiding line ahead of the tip.

    Also returns points ``(2, n)`` around tips and kinks, in rings as wide as the edges there.
    """
    loop, part = np.hstack(loops), np.arange(10) / 10
    out, around, at = [], [np.zeros((2, 0))], loop.shape[1]
    following = np.hstack([np.roll(one, -1, axis=1) for one in loops])
    rim = (loop[..., None] + (following - loop)[..., None] * part).reshape(2, -1)
    for crack in cracks:
        corners = meshed_path(gear, crack)
        if crack.path is not None:
            check_sector(gear, crack)
        start = int(np.argmin(np.hypot(*(loop - corners[:, :1]))))
        legs = np.hypot(*np.diff(corners, axis=1))
        ends = np.concatenate([[0.0], np.cumsum(legs)])
        tip_size, largest = min(size["crack tip"], legs[-1] / 20), min(size["crack"], ends[-1] / 2)
        fine = [(ends[-1], ends[-1], tip_size)] + [(end, end, 5 * tip_size) for end in ends[1:-1]]
        places = np.concatenate(
            [spaced(a, b, largest, fine, 1, 1.5 * GROWTH)[1:] for a, b in zip(ends[:-1], ends[1:], strict=True)]
        )
        line = np.array([np.interp(places, ends, row) for row in corners])
        reach = min(size["crack"], 0.4 * np.hypot(*(rim - corners[:, -1:])).min())
        ahead = (corners[:, -1] - corners[:, -2]) / legs[-1]
        further = spaced(0.0, reach, reach, [(0.0, 0.0, tip_size)], 1, 1.5 * GROWTH)[1:]
        on_line = corners[:, -1:] + ahead[:, None] * further
        out += [(start, line), (at + line.shape[1] - 1, on_line)]
        at += line.shape[1] + further.size
        taken = np.hstack([rim, line, on_line])
        lines = np.column_stack([corners[:, :-1], corners[:, -1]]), np.column_stack([corners[:, 1:], on_line[:, -1]])
        around.append(_rings(corners[:, -1], further, taken, lines))
        for k in range(1, corners.shape[1] - 1):
            radii = places[places > ends[k] + 1e-9] - ends[k]
            around.append(_rings(corners[:, k], radii[radii <= min(size["crack"], 0.4 * min(legs[k - 1 : k + 1]))], taken, lines))
    return out, np.hstack(around)


def _rings(centre, radii, taken, lines):
    """Return six points on each ring around `centre`, except those closer than half the radius to existing points.

    Points on `lines` (starts ``(2, n)``, ends) are omitted as well, because they would create triangles of zero area.
    """
    angle = np.arange(6) * math.pi / 3
    points = centre[:, None, None] + radii[:, None] * np.array([np.sin(angle), np.cos(angle)])[:, None, :]
    away = np.hypot(*(points[..., None] - taken[:, None, None, :])).min(axis=-1)
    start, along = lines[0][:, None, None, :], (lines[1] - lines[0])[:, None, None, :]
    arm = points[..., None] - start
    part = np.clip((arm * along).sum(axis=0) / (along**2).sum(axis=0), 0.0, 1.0)
    beside = np.hypot(*(arm - part * along)).min(axis=-1)
    return points[:, (away > 0.55 * radii[:, None]) & (beside > ON_LINE * radii[:, None])]


def _bulges(curves, final, doubles):
    """Return the deviation of curved edges from their chords by node pair. Both nodes of a crack mouth are included.

    `curves` are parameters of vertices, points by parameter, and first numbers of the vertices, whose last ones are in `final`.
    """
    gauss, out = GAUSS[0], {}
    for params, place, line in curves:
        inner = (params[1:] + params[:-1])[:, None] / 2 + np.diff(params)[:, None] / 2 * gauss
        curve = place(inner.ravel()).reshape(2, -1, BULGE)
        ends = place(params)[..., None]
        chord = (ends[:, :-1] * (1 - gauss) + ends[:, 1:] * (1 + gauss)) / 2
        away = ((curve - chord) / (1 - gauss**2)).transpose(1, 0, 2)
        out |= dict(zip(zip(final[line[:-1]].tolist(), final[line[1:]].tolist(), strict=True), away, strict=True))
    for a, b in [edge for edge in out if doubles and not doubles.keys().isdisjoint(edge)]:
        out |= {(p, q): out[a, b] for p in {a, doubles.get(a, a)} for q in {b, doubles.get(b, b)}}
    return out
