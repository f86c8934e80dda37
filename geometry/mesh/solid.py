"""Whole gear in twisted 20-node hexahedra: the section of `gearfe.geometry.mesh.quads` extruded along the width.

The transverse section at z = 0 is that of `gearfe.geometry.tooth.profile`; at height z it is rotated clockwise by ``w z``, ``w
= tan(beta) / r``, with the sign of the gear's beta. Nodes, also those in the middle of edges, lie exactly on the helicoid. The
section of a ring is mirrored (`gearfe.GearPair.turn`). Like an external wheel, a ring meshes with a pinion of opposite beta.
"""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from ..damage.crack import check_apart, check_single
from ..damage.crack_form import deepest
from ..damage.front import open_part, whole
from ..tooth.gear import Gear
from ..tooth.profile import turned
from .front import follow
from .outline import spaced
from .quads import QuadSection, jacobian, quad_section

# local nodes of scikit-fem's ElementHexS2, whose vertex 0 is at (1, 1, 1): (corner or middle of the quad, level); the level is
# 0 at the bottom of a layer, 2 at its top and 1 half-way
HEX = (
    *((2, 2), (2, 0), (1, 2), (3, 2), (1, 0), (3, 0), (0, 2), (0, 0)),
    *((2, 1), (5, 2), (6, 2), (5, 0), (6, 0), (1, 1), (4, 2), (3, 1), (7, 2), (4, 0), (7, 0), (0, 1)),
)


@dataclass(frozen=True, slots=True)
class Solid:
    """A gear in 20-node hexahedra, with the node order of scikit-fem's ElementHexS2.

    Attributes
    ----------
    points : ndarray, shape (3, n)
        Nodes [mm].
    cells : ndarray, shape (20, m)
    levels : ndarray, shape (layers + 1,)
        Heights of the element layers [mm].
    section : QuadSection
        Section at z = 0.
    held : ndarray
        Nodes on the bore, or on the outside of a ring.
    faces : dict of str to ndarray, shape (8, k)
        Faces by name: ``held``, ``flank 0`` (of each loaded tooth), ``crack 0 body`` and ``crack 0 tooth`` (facing each
        other, column by column). Corners counter-clockwise in (along the section's edge, z), then the middles of 01, 12, 23, 30.
    fronts : dict of int to Front
        By crack, where its depth changes along the width, the front that the elements follow.
    fillets : dict of int to ndarray, shape (8, k)
        Faces of the fillets below the loaded flanks, as `faces`; of a cracked tooth those above the crack's mouth.
    """

    gear: Gear
    points: np.ndarray
    cells: np.ndarray
    levels: np.ndarray
    section: QuadSection
    held: np.ndarray
    faces: dict
    fronts: dict = field(default_factory=dict)
    fillets: dict = field(default_factory=dict)

    def flank(self, tooth):
        """Faces ``(8, edges, layers)`` of a loaded flank, edges from root to tip."""
        name = f"flank {tooth % self.gear.z}"
        if name not in self.faces:
            raise ValueError(f"no boundary {name!r}; this mesh has {', '.join(self.faces)}")
        return self.faces[name].reshape(8, -1, self.levels.size - 1)


MOST = 5000  # largest number of element layers


def layers(b, size, *, breaks=(), fine=()):
    """Return heights [mm] of element layers over 0..b, about `size` apart, with borders at `breaks` and finer at `fine`."""
    if b > MOST * size:
        raise ValueError(
            f"layers of {size:.3g} mm in a gear of b = {b:g} mm: more than {MOST}; give thicker layers, or a smaller refine"
        )
    ends = np.unique([0.0, b, *(z for z in breaks if 0 < z < b)])
    parts = [spaced(low, high, size, list(fine)) for low, high in zip(ends[:-1], ends[1:], strict=True)]
    return np.concatenate([parts[0][:1], *[part[1:] for part in parts]])


def _levels(gear, layer, refine, cracks, fronts, fine):
    """Return the heights of the layers [mm], including the ends and the fronts of cracks."""
    breaks = [z for crack in cracks for z in crack.width or ()]
    breaks += [z for front in fronts for z in (*front.kinks(), *np.ravel(front.open()))]
    fine = [*fine, *(place for front in fronts for place in front.steep())]
    return layers(gear.b, layer / refine, breaks=breaks, fine=[(a, b, size / refine) for a, b, size in fine])


def solid(gear, *, layer, loaded=(0,), cracks=(), broken=(), patches=(), refine=1.0, sizes=None, fine=()):
    """Mesh a whole gear with all teeth and the true rim.

    The elements follow the front of a straight crack whose depth changes along the width (`geometry.mesh.front`). The front of
    a crack with a bend is stepped along element faces.

    Parameters
    ----------
    gear : Gear
    layer : float
        Height of the element layers [mm].
    loaded, cracks, broken, patches, sizes
        See `gearfe.geometry.mesh.quads.quad_section`.
    refine : float
        Divides all edge lengths, along the width too.
    fine : sequence of (float, float, float)
        Where the layers are finer: from, to, height [mm].

    Returns
    -------
    Solid
    """
    if not (math.isfinite(layer) and layer > 0):
        raise ValueError(f"layer = {layer} mm, but it must be positive")
    check_apart(gear, cracks)
    check_single(gear, cracks)
    shapes = [crack if crack.bends else whole(crack) for crack in cracks]
    options = {"broken": broken, "patches": patches, "refine": refine, "sizes": sizes}
    section = quad_section(gear, loaded=loaded, cracks=shapes, **options)
    moves = {k: follow_front(section, k, crack) for k, crack in enumerate(cracks) if not (crack.even or crack.bends)}
    fronts = {k: front for k, (_, front) in moves.items()}
    levels = _levels(gear, layer, refine, cracks, fronts.values(), fine)
    made = extrude(section, levels, gear.twist_rate, moves.values())
    made = replace(made, fronts=fronts)
    for number, cut in enumerate(section.cuts):
        made = _open(made, cut, number + 1, cracks)
    return made


def follow_front(section, number, crack):
    """Return the shift ``(2, n)`` [mm] of a section's nodes that follows the front of its crack, and the `Front`."""
    quads, corners = section.quads, section.corners
    ends = np.array([quads[:4], np.roll(quads[:4], -1, axis=0)]).reshape(2, -1)
    middle = quads[4:].ravel()
    once = np.bincount(middle, minlength=section.points.shape[1])[middle] == 1
    lines = [
        (k, cut.edges[:, cut.crack == k], cut.depth[cut.crack == k])
        for cut in section.cuts
        for k in set(cut.crack.tolist()) - {-1}
    ]
    others = [edges[[0, 2]].ravel() for k, edges, _ in lines if k != number]
    (line,) = [_chain(section, edges[[0, 2]], depth) for k, edges, depth in lines if k == number]
    # the four triangles at the corners of each quad
    triangles = np.hstack([quads[list(at)] for at in ((0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 2, 3))])
    arm = section.points[:, ends[1]] - section.points[:, ends[0]]
    place = ((section.points[:, middle] - section.points[:, ends[0]]) * arm).sum(axis=0) / (arm**2).sum(axis=0)

    def every(moved):
        out = np.zeros(section.points.shape)
        out[:, :corners] = moved
        out[:, middle] = (1 - place) * moved[:, ends[0]] + place * moved[:, ends[1]]
        return out

    def folds(points):
        return jacobian(replace(section, points=section.points + every(points - section.points[:, :corners]))).min() <= 0

    fixed = np.concatenate([ends[:, once].ravel(), *others])
    shift, front = follow(section.gear, crack, section.gear.b, section.points[:, :corners], triangles, fixed, line, folds)
    return every(shift), front


def _chain(section, ends, depth):
    """Return the vertices of a crack from mouth to tip."""
    ends = ends[:, np.argsort(depth)]
    near = ends if ends.shape[1] < 2 or ends[1, 0] in ends[:, 1] else ends[::-1]
    return np.append(near[0], near[1, -1])


def extrude(section, levels, rate, moves=()):
    """Extrude a section to twisted hexahedra (`Solid`). Its cracks stay closed.

    `levels` are heights [mm], `rate` is the clockwise turn [rad/mm], `moves` (ndarray, Front) are those of `follow_front`.
    """
    count, corners, tall = section.points.shape[1], section.corners, levels.size
    middle = (levels[1:] + levels[:-1]) / 2
    whole = [_moved(section.points, heights, moves) for heights in (levels, middle)]
    points = np.hstack([_turned(whole[0], levels, rate), _turned(whole[1][:, :, :corners], middle, rate)])

    def number(nodes, layer, level):
        return tall * count + layer * corners + nodes if level == 1 else (layer + level // 2) * count + nodes

    layer = np.arange(tall - 1)[:, None]
    cells = np.array([number(section.quads[node], layer, level).ravel() for node, level in HEX])

    def walls(edges):
        """Return the faces ``(8, n, layers)`` above edges ``(3, n)``."""
        a, m, b = edges[:, :, None]
        parts = ((a, 0), (b, 0), (b, 2), (a, 2), (m, 0), (b, 1), (m, 2), (a, 1))
        return np.array([number(nodes, layer.T, level) for nodes, level in parts])

    faces = {"held": walls(section.held)} | {f"flank {k}": walls(edges) for k, edges in section.flank.items()}
    for k, cut in enumerate(section.cuts):
        faces[f"cut {k}"] = walls(cut.edges)
    held = np.unique(faces["held"])
    faces = {name: wall.reshape(8, -1) for name, wall in faces.items()}
    fillets = {k: walls(edges).reshape(8, -1) for k, edges in section.fillet.items()}
    return Solid(section.gear, points, cells, levels, section, held, faces, fillets=fillets)


def _moved(points, heights, moves):
    """Return section points at all heights ``(2, heights, n)``."""
    out = np.repeat(points[:, None, :], heights.size, axis=1)
    for shift, front in moves:
        out = out + (front.depth(heights)[0] - 1)[:, None] * shift[:, None, :]
    return out


def _turned(points, heights, rate):
    """Rotate section points ``(2, heights, n)`` with their heights to ``(3, heights * n)``, height by height."""
    z = np.broadcast_to(heights[:, None], points[0].shape)
    return turned((*points, z), rate * heights[:, None]).reshape(3, -1)


def _open(made, cut, part, cracks):
    """Double the nodes on the open faces of one parting line. Cells of the tooth above get the new nodes."""
    faces = dict(made.faces)
    walls = faces.pop(f"cut {part - 1}")
    height = (made.levels[1:] + made.levels[:-1]) / 2
    opened = np.zeros((cut.crack.size, height.size), dtype=bool)
    for number in set(cut.crack.tolist()) - {-1}:
        of_crack = cut.crack == number
        length = cut.depth[of_crack].max()
        if number in made.fronts:
            reach = sum((height > low) & (height < high) for low, high in made.fronts[number].open())
        else:
            crack = cracks[number]
            reach = open_part(crack, made.gear.b, height) / (1.0 if crack.bends else deepest(crack))
        opened |= of_crack[:, None] & (cut.depth[:, None] <= length * reach * (1 + 1e-9))
    opened = opened.ravel()
    if not opened.any():
        raise ValueError("the crack is narrower or shallower than an element: give thinner layers or a larger refine")
    free = np.setdiff1d(walls[:, opened], walls[:, ~opened])
    double = np.arange(made.points.shape[1])
    double[free] = made.points.shape[1] + np.arange(free.size)
    above = np.tile(made.section.part == part, made.levels.size - 1)
    cells = made.cells.copy()
    cells[:, above] = double[cells[:, above]]
    for number in set(cut.crack.tolist()) - {-1}:
        of_crack = walls[:, opened & np.repeat(cut.crack == number, height.size)]
        if of_crack.size:
            faces |= {f"crack {number} body": of_crack, f"crack {number} tooth": double[of_crack]}
    above = {cracks[number].tooth % made.section.gear.z for number in set(cut.crack.tolist()) - {-1}}
    fillets = {k: double[fillet] if k in above else fillet for k, fillet in made.fillets.items()}
    points = np.hstack([made.points, made.points[:, free]])
    return replace(made, points=points, cells=cells, faces=faces, fillets=fillets)
