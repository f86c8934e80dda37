"""Curved sector as an elastic body of polynomial triangles: stiffness, line loads on its flank, reduction to its sides.

The singular field of each load (`flamant`) is subtracted. The remaining field is smooth, so that a few triangles represent it.
With u_s the singular field in the loaded sector and P u_s its values on the sector's two sides and held edge::

    u = u_s + U - P u_s,    K (U - P u_s) = -int N' (sigma_s n) ds

over the whole boundary of the sector, crack faces included.
"""

import math
from dataclasses import dataclass
from numbers import Integral

import numpy as np
from scipy.sparse import coo_array

from ....core.material import Material
from ....geometry.kept import keeping
from ....geometry.mesh.triangle import BULGE, ENDS, GAUSS, jacobians, lagrange, lobatto, table
from ....geometry.tooth.gear import Gear
from ....geometry.tooth.profile import arc_at, cartesian, flank, flank_normal
from ... import flamant
from ...condense import condense
from ...plane_elements import bent_stiffness, stiffness
from .tip import face_columns, load_columns, tip_columns, tip_of

STRAIGHT = 1e-12  # Edges with a smaller deviation from their chord, relative to the sector size, are straight.
SOFT = 1e-9  # modulus of the material in slots, relative to that of the gear
CORNER = 1e6  # stiffness of the springs that hold a corner, in moduli
GROUP = 10  # least number of triangles eliminated together; at most twice as many


@dataclass(frozen=True, slots=True)
class Panel:
    """Sector reduced to its two sides. Its m unknowns are polar components from held edge to root, left side first.

    `stiffness` is (m, m). For n loads on the flank, `push` (m, n) are their forces on the sides, and `own` (n, n) is the
    displacement at load i under load j with the sides held, without the logarithm of the half-plane. For k facing pairs of
    crack nodes, `open_push` (m, k) are the forces on the sides, `open_own` (k, n) is the opening under the loads, and
    `open_open` (k, k) is that under unit forces that push the pairs apart. With `intensity` of `panel`, the rows of K_I and K_II
    follow those of the pairs. The block between K_I and K_II themselves has no meaning.
    """

    stiffness: np.ndarray
    push: np.ndarray
    own: np.ndarray
    open_push: np.ndarray
    open_own: np.ndarray
    open_open: np.ndarray
    unknowns: int


def panel_of(edge, push, between, n, unknowns):
    """Return the `Panel` of the stiffness of its sides, the forces on them, and the displacements of n loads, then of cracks."""
    parts = push[:, :n], between[:n, :n], push[:, n:], between[n:, :n], between[n:, n:]
    return Panel((edge + edge.T) / 2, *parts, unknowns)


@dataclass(frozen=True, slots=True)
class SectionModel:
    """Model of the section of a gear with held bore or rim.

    `order` is that of the polynomials, 2 to 8; `refine` divides the edge lengths of the triangles, and the hat functions at
    corners.
    """

    gear: Gear
    material: Material
    state: str = "plane strain"
    order: int = 4
    refine: float = 1.0


def check_order(order):
    """Raise ValueError for a polynomial order that the triangles do not support."""
    if isinstance(order, bool) or not isinstance(order, Integral) or not 2 <= order <= 8:
        raise ValueError(f"order = {order!r}, but it is the polynomial order: a whole number from 2 to 8")


def panel(model, sector, roll, tilt=0.0, *, intensity=False, fixed=None):
    """Return the `Panel` of a `gearfe.geometry.mesh.sector.Sector` of a `SectionModel`.

    Parameters
    ----------
    roll : ndarray, shape (n,)
        Roll lengths of unit line loads on the loaded flank [mm]; none for a sector that only supports others.
    tilt : float or ndarray, shape (n,)
        By what angle the loads lean from the flank's normal towards the outside of the gear [rad]; small.
    intensity : bool
        Whether K_I and K_II at the tip of the only crack are two more openings [MPa sqrt(mm) per N/mm].
    fixed : ndarray of bool, optional
        Which edges along ``sector.held`` are held; the corners there are then unknowns of the sides, held by stiff springs.
        Default: all, and the corners are no unknowns.
    """
    gear, material, state, order = model.gear, model.material, model.state, model.order
    modulus = material.plane_modulus(state)
    ratio = material.nu / (1 - material.nu) if state == "plane strain" else material.nu
    numbers, count, chain = numbering(sector, order)
    first, on = (1, True) if fixed is None else (0, _held_nodes(fixed, order))
    sides = np.concatenate([chain(side)[first:] for side in (sector.left, sector.right)])
    edge = unknowns_of(np.append(sides, chain(sector.held) if fixed is None else chain(sector.held)[1:-1][on[1:-1]]))
    bulges = sector.edge_bulges
    parts, extra = _loads(gear, sector, bulges, chain, roll, order, (modulus, ratio), tilt)
    m, n = 2 * sides.size, roll.size
    parts.append(_apart(sector, chain, 2 * n))
    if intensity:
        tip, after = tip_of(sector), int(parts[-1][1].max()) + 1
        at, column, force = tip_columns(sector, tip, numbers, order, material, state)
        parts.append((at, after + column, force))
    rows, columns, values = (np.concatenate([part[k] for part in parts]) for k in range(3))
    k = int(columns.max(initial=2 * n - 1)) + 1 - 2 * n
    load = coo_array((values, (rows, columns)), shape=(2 * count, 2 * n + k))
    local = _local(sector, bulges, order, modulus, ratio)
    centre = sector.points[:, sector.triangles].mean(axis=1)
    total = condense(local, unknowns_of(numbers.T).reshape(local.shape[:2]), centre, load, edge, leaf=GROUP)
    loads, reads, faces = (edge.size + np.arange(first, stop) for first, stop in ((0, n), (n, 2 * n), (2 * n, 2 * n + k)))
    if n:
        where, inward, tip_side = _frames(gear, roll, tilt)
        pinned = flamant.displacement(_matched(gear, sector, order, on), where, inward, tip_side, modulus, ratio)
        total[:, loads] += total[:, : edge.size] @ pinned.transpose(2, 0, 1).reshape(edge.size, n)
    if intensity:
        total[np.ix_(faces[-2:], loads)] -= load_columns(sector, tip, *_frames(gear, roll, tilt))
        total[np.ix_(faces[-2:], faces[:-2])] -= face_columns(sector, tip, order)
    if fixed is not None:
        for corner, node in ((on[-1], 0), (on[0], sides.size // 2)):  # the held edge runs from the right side to the left one
            total[[2 * node, 2 * node + 1], [2 * node, 2 * node + 1]] += corner * CORNER * modulus
    turn = _polar(gear, sides.size // 2)
    push = turn.T @ total[:m, edge.size :]
    return Panel(
        stiffness=turn.T @ total[:m, :m] @ turn,
        push=push[:, :n],
        own=extra - total[np.ix_(reads, loads)],
        open_push=push[:, 2 * n :],
        open_own=-total[np.ix_(faces, loads)],
        open_open=-total[np.ix_(faces, faces)],
        unknowns=2 * count - edge.size,
    )


def unknowns_of(nodes):
    """Return the two unknowns of each node in order."""
    return (2 * nodes[..., None] + np.arange(2)).reshape(*nodes.shape[:-1], -1)


def numbering(sector, order):
    """Return the nodes of the triangles without inner nodes, their count, and a function for nodes along vertices."""
    triangles = sector.triangles
    ends = np.array([triangles[[a, b]] for a, b in ENDS])  # (3, 2, m)
    low, high = ends.min(axis=1), ends.max(axis=1)
    vertices = sector.points.shape[1]
    keys, edge = np.unique((low.astype(np.int64) * vertices + high).ravel(), return_inverse=True)
    edge = edge.reshape(low.shape)
    steps = np.arange(order - 1)
    forward = np.where((ends[:, 0] < ends[:, 1])[..., None], steps, steps[::-1])
    inner = vertices + edge[..., None] * (order - 1) + forward  # (3, m, order - 1)
    numbers = np.concatenate([triangles, inner.mT.reshape(-1, triangles.shape[1])])

    def chain(corners):
        """Return the nodes along a chain of vertices, or along many: nodes of the edges between the rows of `corners`."""
        corners = np.asarray(corners, dtype=np.int64)
        a, b = corners[:-1], corners[1:]
        at = np.searchsorted(keys, np.minimum(a, b) * vertices + np.maximum(a, b))
        middle = vertices + at[..., None] * (order - 1) + np.where((a < b)[..., None], steps, steps[::-1])
        nodes = np.moveaxis(np.concatenate([a[..., None], middle], axis=-1), -1, 1)
        return np.concatenate([nodes.reshape(-1, *corners.shape[1:]), corners[-1:]])

    return numbers, vertices + keys.size * (order - 1), chain


def _local(sector, bulges, order, modulus, ratio):
    """Return the stiffness matrices of the triangles with their inner nodes eliminated."""
    basis, corners = table(order), sector.points[:, sector.triangles]
    lam, mu = modulus * ratio / (1 - ratio**2), modulus / (2 * (1 + ratio))
    local = stiffness(basis.slope, basis.weight, np.einsum("dcm,ce->mde", corners, basis.corner_slope), lam, mu)
    bent = np.flatnonzero(np.abs(bulges).max(axis=(0, 1, 2)) > STRAIGHT * np.ptp(sector.points))
    jacobian = jacobians(sector.points, sector.triangles[:, bent], bulges[..., bent], order)
    local[bent] = bent_stiffness(basis.slope, basis.weight, jacobian, lam, mu)
    local[sector.solid :] *= SOFT
    kept = 2 * (basis.count - basis.inside)
    if not basis.inside:
        return local
    inside = np.linalg.inv(local[:, kept:, kept:])  # For few unknowns an inverse is faster than a solve.
    return local[:, :kept, :kept] - local[:, :kept, kept:] @ (inside @ local[:, kept:, :kept])


def _polar(gear, nodes):
    """Return the rotation from radial and tangential to Cartesian components at the side nodes."""
    angle = np.repeat([-math.pi / gear.z, math.pi / gear.z], nodes)
    x = 2 * np.arange(2 * nodes)
    out = np.zeros((4 * nodes, 4 * nodes))
    out[x, x], out[x + 1, x + 1] = np.sin(angle), -np.sin(angle)
    out[x, x + 1] = out[x + 1, x] = np.cos(angle)
    return out


def _frames(gear, roll, tilt=0.0):
    """Return load points ``(2, n)`` on the flank, load directions, and tangents towards the tip, both tilted."""
    radius, angle = flank(gear, roll)
    normal = -flank_normal(gear, roll)
    inward = np.cos(tilt) * normal + np.sin(tilt) * np.array([normal[1], -normal[0]])
    return np.array([radius * np.sin(angle), radius * np.cos(angle)]), inward, gear.outward * np.array([inward[1], -inward[0]])


def _held_nodes(fixed, order):
    """Return a mask of the nodes along the held edge. True marks nodes on edges that are fixed."""
    on = np.append(np.repeat(fixed, order), False)
    on[1:] |= np.repeat(fixed, order)
    return on


def _matched(gear, sector, order, on):
    """Return the positions ``(2, n)`` of the nodes on both sides and on the held edge.

    `on` is the result of `_held_nodes`, or True where the whole edge is held.
    """
    line, first = (lobatto(order) + 1) / 2, int(on is True)
    out = []
    for side in (sector.left, sector.right):
        a, b = sector.points[:, side[:-1], None], sector.points[:, side[1:], None]
        corner = sector.points[:, side[: 1 - first]]
        out += [corner, (a * (1 - line[1:]) + b * line[1:]).reshape(2, -1)]
    angle = np.arctan2(*sector.points[:, sector.held])
    places = np.append((angle[:-1, None] + np.diff(angle)[:, None] * line[:-1]).ravel(), angle[-1])
    return np.hstack([*out, cartesian(gear.held, places if on is True else places[1:-1][on[1:-1]])])


def _apart(sector, chain, first):
    """Return unit forces that push apart facing nodes of cracks (tips excluded), as unknowns, columns from `first` on, forces."""
    out, at = [np.zeros((3, 0))], first
    for left, right in sector.faces:
        ahead = np.diff(sector.points[:, left], axis=1)
        normal = np.array([-ahead[1], ahead[0]]) / np.hypot(*ahead)
        pairs = np.array([chain(left), chain(right)])[:, :-1]
        normal = np.repeat(normal, pairs.shape[1] // normal.shape[1], axis=1)
        columns, force = np.repeat(at + np.arange(pairs.shape[1]), 2), normal.T.ravel()
        out += [np.array([unknowns_of(pairs[0]), columns, force]), np.array([unknowns_of(pairs[1]), columns, -force])]
        at += pairs.shape[1]
    rows, columns, forces = np.hstack(out)
    return rows.astype(np.int64), columns.astype(np.int64), forces


def _loads(gear, sector, bulges, chain, roll, order, elastic, tilt):
    """Return tractions of the singular fields as forces, rows for flank displacements, and the fields at the loads ``(n, n)``.

    Forces and rows are given as unknowns, columns (loads 0 to n, then rows) and values.
    """
    n = roll.size
    if n == 0:
        return [], np.zeros((0, 0))
    where, inward, tip_side = _frames(gear, roll, tilt)
    gauss, weight = GAUSS
    start, stop, bulge = _boundary(sector, bulges)
    ends = sector.points[:, start], sector.points[:, stop]
    points = (ends[0][..., None] * (1 - gauss) + ends[1][..., None] * (1 + gauss)) / 2 + (1 - gauss**2) * bulge
    along = (ends[1] - ends[0])[..., None] / 2 + bulge @ _bulge_slope().T
    # Multiplied by the length element. Triangles are numbered counter-clockwise.
    outward = np.array([along[1], -along[0]]) * weight
    spread = flamant.traction(points.reshape(2, -1), outward.reshape(2, -1), where, inward, tip_side)
    force = -spread.reshape(2, n, start.size, gauss.size) @ lagrange(order, tuple(gauss)).T  # (2, n, edges, nodes)
    nodes = chain(np.array([start, stop])).T
    rows, columns = (np.broadcast_to(indices, force.shape).ravel() for indices in _places(nodes, np.arange(n)[:, None, None]))
    edge = np.clip(np.searchsorted(sector.roll * gear.outward, roll * gear.outward) - 1, 0, sector.roll.size - 2)
    low, high = sector.roll[edge], sector.roll[edge + 1]
    values = lagrange(order, tuple((2 * (roll - low) / (high - low) - 1).tolist()))
    at = chain(np.array([sector.flank[edge], sector.flank[edge + 1]]))
    read = values * inward[:, None]  # (2, nodes, n)
    read_rows, read_columns = (np.broadcast_to(indices, read.shape).ravel() for indices in _places(at, n + np.arange(n)))
    arc = arc_at(gear, roll)
    with np.errstate(divide="ignore", invalid="ignore"):  # The term of a load at its own place is set to zero.
        moved = flamant.displacement(where, where, inward, tip_side, *elastic)
        field = np.einsum("dji,di->ij", moved, inward) + 2 / (math.pi * elastic[0]) * np.log(np.abs(arc[:, None] - arc))
    field[~np.isfinite(field)] = 0.0  # Loads at one point with different directions are not coupled.
    leans = (1 + elastic[1]) / (math.pi * elastic[0]) * np.sin(tilt) ** 2  # The surface is not normal to the load.
    np.fill_diagonal(field, leans)
    return [(rows, columns, force.ravel()), (read_rows, read_columns, read.ravel())], field


def _places(nodes, columns):
    """Return the unknowns ``(2, ...)`` of nodes, and their columns."""
    return 2 * nodes + np.arange(2).reshape(2, *(1,) * max(np.ndim(nodes), np.ndim(columns))), columns


@keeping(1)
def _bulge_slope():
    """Matrix from the bulge at the points of an edge to the derivative of ``(1 - s**2) bulge`` there."""
    gauss, powers = GAUSS[0][:, None], np.arange(BULGE)
    slope = (1 - gauss**2) * (powers * gauss ** np.maximum(powers - 1, 0)) - 2 * gauss * gauss**powers
    return slope @ np.linalg.inv(np.vander(GAUSS[0], increasing=True))


def _boundary(sector, bulges):
    """Return boundary edges by start and end vertex ``(e,)`` (material on the left), and bulges ``(2, e, BULGE)``."""
    triangles, bulges = sector.triangles[:, : sector.solid], bulges[..., : sector.solid]
    a, b = np.array([triangles[list(ends)] for ends in ENDS]).transpose(1, 0, 2).reshape(2, -1).astype(np.int64)
    count = sector.points.shape[1]
    edge, back = a * count + b, np.sort(b * count + a)
    outer = back.take(np.searchsorted(back, edge), mode="clip") != edge
    bulges = np.moveaxis(bulges, (1, 2), (0, 1)).reshape(2, BULGE, -1)
    return a[outer], b[outer], bulges[..., outer].mT
