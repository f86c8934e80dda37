"""A whole gear in twisted 20-node hexahedra: the section of `geometry.mesh.quads`, extruded along the width.

The transverse section at z = 0 is that of `geometry.tooth.profile`; at height z it is turned clockwise by ``w z``,
``w = tan(beta) / r``, with the sign of the gear's beta. Nodes, also those in the middle of edges, lie exactly on the helicoid. A
ring's own section is seen in the mirror (`gearfe.GearPair.turn`): like an external wheel, it meshes with a pinion of the
opposite beta.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..damage.crack import open_part
from ..tooth.gear import Gear
from .outline import spaced
from .quads import QuadSection, quad_section

# local nodes of scikit-fem's ElementHexS2, whose vertex 0 is at (1, 1, 1): (corner or middle of the quad, level); the level is
# 0 at the bottom of a layer, 2 at its top and 1 half-way
HEX = (
    *((2, 2), (2, 0), (1, 2), (3, 2), (1, 0), (3, 0), (0, 2), (0, 0)),
    *((2, 1), (5, 2), (6, 2), (5, 0), (6, 0), (1, 1), (4, 2), (3, 1), (7, 2), (4, 0), (7, 0), (0, 1)),
)


@dataclass(frozen=True, slots=True)
class Solid:
    """A gear in 20-node hexahedra, ordered as scikit-fem's ElementHexS2.

    Attributes
    ----------
    points : ndarray, shape (3, n)
        Nodes [mm].
    cells : ndarray, shape (20, m)
    levels : ndarray, shape (layers + 1,)
        Heights of the element layers [mm].
    section : QuadSection
        At z = 0.
    held : ndarray
        Nodes on the bore, or on the outside of a ring.
    faces : dict of str to ndarray, shape (8, k)
        Faces by name: ``held``, ``flank 0`` (of each loaded tooth), ``crack 0 body`` and ``crack 0 tooth`` (facing each
        other, column by column). Corners counter-clockwise in (along the section's edge, z), then the middles of 01, 12, 23, 30.
    """

    gear: Gear
    points: np.ndarray
    cells: np.ndarray
    levels: np.ndarray
    section: QuadSection
    held: np.ndarray
    faces: dict

    def flank(self, tooth):
        """Faces ``(8, edges, layers)`` of a loaded flank, edges from root to tip."""
        name = f"flank {tooth % self.gear.z}"
        if name not in self.faces:
            raise ValueError(f"no boundary {name!r}; this mesh has {', '.join(self.faces)}")
        return self.faces[name].reshape(8, -1, self.levels.size - 1)


def layers(b, size, *, breaks=(), fine=()):
    """Heights [mm] of element layers about `size` apart over 0..b, with borders at `breaks` and finer at `fine`.

    `fine` as of `geometry.mesh.outline.spaced`: (first, last, size) [mm].
    """
    ends = np.unique([0.0, b, *(z for z in breaks if 0 < z < b)])
    parts = [spaced(low, high, size, list(fine)) for low, high in zip(ends[:-1], ends[1:], strict=True)]
    return np.concatenate([parts[0][:1], *[part[1:] for part in parts]])


def solid(gear, *, layer, loaded=(0,), cracks=(), patches=(), refine=1.0, sizes=None, fine=()):
    """Mesh a whole gear, all teeth and the true rim.

    The front of a crack that changes along the width follows the element faces: a sloping one is a staircase of layers and
    crack edges.

    Parameters
    ----------
    gear : Gear
    layer : float
        Height of the element layers [mm].
    loaded, cracks, patches, sizes
        As of `geometry.mesh.quads.quad_section`.
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
    section = quad_section(gear, loaded=loaded, cracks=cracks, patches=patches, refine=refine, sizes=sizes)
    breaks = [z for crack in cracks for z in crack.width or ()]
    levels = layers(gear.b, layer / refine, breaks=breaks, fine=[(a, b, size / refine) for a, b, size in fine])
    made = extrude(section, levels, gear.twist_rate)
    for number, cut in enumerate(section.cuts):
        made = _open(made, cut, number + 1, cracks)
    return made


def extrude(section, levels, rate):
    """Twisted hexahedra over a section, without its cracks.

    Parameters
    ----------
    section : QuadSection
    levels : ndarray
        Heights [mm].
    rate : float
        Clockwise turn [rad/mm].

    Returns
    -------
    Solid
    """
    count, corners, tall = section.points.shape[1], section.corners, levels.size
    middle = (levels[1:] + levels[:-1]) / 2
    points = np.hstack([_turned(section.points, levels, rate), _turned(section.points[:, :corners], middle, rate)])

    def number(nodes, layer, level):
        return tall * count + layer * corners + nodes if level == 1 else (layer + level // 2) * count + nodes

    layer = np.arange(tall - 1)[:, None]
    cells = np.array([number(section.quads[node], layer, level).ravel() for node, level in HEX])

    def walls(edges):
        """Faces above edges ``(3, n)``: ``(8, n, layers)``."""
        a, m, b = edges[:, :, None]
        parts = ((a, 0), (b, 0), (b, 2), (a, 2), (m, 0), (b, 1), (m, 2), (a, 1))
        return np.array([number(nodes, layer.T, level) for nodes, level in parts])

    faces = {"held": walls(section.held)} | {f"flank {k}": walls(edges) for k, edges in section.flank.items()}
    for k, cut in enumerate(section.cuts):
        faces[f"cut {k}"] = walls(cut.edges)
    held = np.unique(faces["held"])
    return Solid(section.gear, points, cells, levels, section, held, {name: f.reshape(8, -1) for name, f in faces.items()})


def _turned(points, heights, rate):
    """Section points ``(2, n)`` at all heights: ``(3, heights * n)``, height by height."""
    cos, sin = np.cos(rate * heights)[:, None], np.sin(rate * heights)[:, None]
    x, y = points
    z = np.broadcast_to(heights[:, None], (heights.size, x.size))
    return np.array([cos * x + sin * y, cos * y - sin * x, z]).reshape(3, -1)


def _open(made, cut, part, cracks):
    """Double the nodes of the open faces of one parting line; the cells of the tooth above get the new ones."""
    faces = dict(made.faces)
    walls = faces.pop(f"cut {part - 1}")
    height = (made.levels[1:] + made.levels[:-1]) / 2
    opened = np.zeros((cut.crack.size, height.size), dtype=bool)
    for number in set(cut.crack.tolist()) - {-1}:
        own = cut.crack == number
        length = cut.depth[own].max()
        reach = open_part(cracks[number], made.gear.b, height)
        opened |= own[:, None] & (cut.depth[:, None] <= length * reach * (1 + 1e-9))
    opened = opened.ravel()
    if not opened.any():
        raise ValueError("the crack is narrower or shallower than the mesh: give smaller layers or a larger refine")
    free = np.setdiff1d(walls[:, opened], walls[:, ~opened])
    double = np.arange(made.points.shape[1])
    double[free] = made.points.shape[1] + np.arange(free.size)
    above = np.tile(made.section.part == part, made.levels.size - 1)
    cells = made.cells.copy()
    cells[:, above] = double[cells[:, above]]
    for number in set(cut.crack.tolist()) - {-1}:
        own = walls[:, opened & np.repeat(cut.crack == number, height.size)]
        if own.size:
            faces |= {f"crack {number} body": own, f"crack {number} tooth": double[own]}
    return replace(made, points=np.hstack([made.points, made.points[:, free]]), cells=cells, faces=faces)
