"""A curved sector as an elastic body of polynomial triangles: stiffness, line loads on its flank, and its reduction to its sides.

The singular field of each load (`flamant`) is taken out, so that what is left is smooth and a few triangles carry it. With
u_s that field in the loaded sector and P u_s its values on the sector's two sides::

    u = u_s + U - P u_s,    K U = -int N' (sigma_s n) ds + K P u_s

over the whole boundary of the sector, crack faces included.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.linalg import LinAlgError, cholesky, solve_triangular
from scipy.sparse import coo_matrix

from geometry.mesh.triangle import BULGE, ENDS, jacobians, lagrange, lobatto, table
from geometry.tooth.profile import arc_at, cartesian, flank, flank_normal

from ...flexibility import flamant

GROUP = 20  # triangles eliminated together


@dataclass(frozen=True, slots=True)
class Panel:
    """A sector reduced to its two sides (polar components, from the held edge to the root, left side first; m unknowns).

    `stiffness` (m, m); for n loads on the flank `push` (m, n) their forces on the sides, `own` (n, n) the displacement at load
    i with the sides held under load j, the half-plane's logarithm taken out; for k facing pairs of crack nodes `open_push`
    (m, k), `open_own` (k, n) their opening under the loads and `open_open` (k, k) under unit forces that push them apart.
    """

    stiffness: np.ndarray
    push: np.ndarray
    own: np.ndarray
    open_push: np.ndarray
    open_own: np.ndarray
    open_open: np.ndarray
    unknowns: int


def panel(gear, sector, material, roll, *, order, state="plane strain"):
    """Reduce a sector to its sides.

    Parameters
    ----------
    gear : Gear
    sector : geometry.mesh.sector.Sector
    material : Material
    roll : ndarray, shape (n,)
        Roll lengths of unit line loads on the loaded flank [mm]; none for a sector that only supports others.
    order : int
        Polynomial order of the displacements.
    state : {"plane strain", "plane stress"}

    Returns
    -------
    Panel
    """
    modulus = material.plane_modulus(state)
    ratio = material.nu / (1 - material.nu) if state == "plane strain" else material.nu
    numbers, count, chain = numbering(sector, order)
    stiffness = _assemble(sector, numbers, count, order, modulus, ratio)
    sides = np.concatenate([chain(side)[1:] for side in (sector.left, sector.right)])
    inner = np.setdiff1d(np.arange(count), np.concatenate([sides, chain(sector.held)]))
    turn = _polar(gear, sides.size // 2)
    inside, border = (2 * nodes[:, None] + np.arange(2) for nodes in (inner, sides))
    inside, border = inside.ravel(), border.ravel()
    support = stiffness[inside][:, border] @ turn
    edge = turn.T @ stiffness[border][:, border] @ turn
    apart = _apart(sector, chain, count)
    load, read, extra = _loads(gear, sector, chain, numbers, count, roll, order, modulus, ratio)
    if roll.size:
        where, inward, tip_side = _frames(gear, roll)
        pinned = flamant.displacement(_matched(gear, sector, order), where, inward, tip_side, modulus, ratio)
        matched = (2 * np.concatenate([sides, chain(sector.held)])[:, None] + np.arange(2)).ravel()
        load += stiffness[:, matched] @ pinned.transpose(2, 0, 1).reshape(matched.size, -1)
    forces = np.hstack([load, apart.toarray()])
    m, n, k = border.size, roll.size, apart.shape[1]
    group = np.repeat(_groups(sector, numbers, count)[inner], 2)
    between = _between(stiffness[inside][:, inside], np.hstack([support, forces[inside], read[:, inside].T]), group)
    push = turn.T @ forces[border] - between[:m, m : m + n + k]
    total = edge - between[:m, :m]
    loads, faces, reads = slice(m, m + n), slice(m + n, m + n + k), slice(m + n + k, None)
    own = between[reads, loads] + extra
    return Panel(
        (total + total.T) / 2, push[:, :n], own, push[:, n:], between[faces, loads], between[faces, faces], inside.size
    )  # fmt: skip


def numbering(sector, order):
    """Node numbers of the triangles without their insides, their count, and the nodes along a chain of vertices."""
    triangles = sector.triangles
    ends = np.array([triangles[[a, b]] for a, b in ENDS])  # (3, 2, m)
    low, high = ends.min(axis=1), ends.max(axis=1)
    vertices = sector.points.shape[1]
    keys, edge = np.unique((low.astype(np.int64) * vertices + high).ravel(), return_inverse=True)
    edge = edge.reshape(low.shape)
    steps = np.arange(order - 1)
    forward = np.where((ends[:, 0] < ends[:, 1])[..., None], steps, steps[::-1])
    inner = vertices + edge[..., None] * (order - 1) + forward  # (3, m, order - 1)
    numbers = np.concatenate([triangles, inner.transpose(0, 2, 1).reshape(-1, triangles.shape[1])])

    def chain(corners):
        a, b = np.asarray(corners[:-1], dtype=np.int64), np.asarray(corners[1:], dtype=np.int64)
        at = np.searchsorted(keys, np.minimum(a, b) * vertices + np.maximum(a, b))
        middle = vertices + at[:, None] * (order - 1) + np.where((a < b)[:, None], steps, steps[::-1])
        return np.append(np.column_stack([a, middle]).ravel(), corners[-1])

    return numbers, vertices + keys.size * (order - 1), chain


def _assemble(sector, numbers, count, order, modulus, ratio):
    """Stiffness matrix with the insides of the triangles eliminated (csr)."""
    basis = table(order)
    jacobian = jacobians(sector.points, sector.triangles, sector.edge_bulges(), order)
    (xx, xy), (yx, yy) = jacobian.transpose(1, 2, 0, 3)
    area = xx * yy - xy * yx
    first, second = basis.slope
    dx = (yy / area)[:, None] * first - (yx / area)[:, None] * second
    dy = (xx / area)[:, None] * second - (xy / area)[:, None] * first
    weight = (area * basis.weight)[:, None]
    a, b, c = modulus / (1 - ratio**2) * np.array([1.0, ratio, (1 - ratio) / 2])
    n = basis.count
    local = np.empty((area.shape[0], n, 2, n, 2))
    wx, wy = (weight * dx), (weight * dy)
    gxx, gyy, gxy = wx @ dx.transpose(0, 2, 1), wy @ dy.transpose(0, 2, 1), wx @ dy.transpose(0, 2, 1)
    local[:, :, 0, :, 0] = a * gxx + c * gyy
    local[:, :, 1, :, 1] = a * gyy + c * gxx
    local[:, :, 0, :, 1] = b * gxy + c * gxy.transpose(0, 2, 1)
    local[:, :, 1, :, 0] = local[:, :, 0, :, 1].transpose(0, 2, 1)
    local = local.reshape(-1, 2 * n, 2 * n)
    kept = 2 * (n - basis.inside)
    if basis.inside:
        side = local[:, :kept, kept:]
        local = local[:, :kept, :kept] - side @ np.linalg.solve(local[:, kept:, kept:], side.transpose(0, 2, 1))
    rows = (2 * numbers[:, None, :] + np.arange(2)[:, None]).reshape(kept, -1).T
    shape = (rows.shape[0], kept, kept)
    i, j = np.broadcast_to(rows[:, :, None], shape), np.broadcast_to(rows[:, None, :], shape)
    return coo_matrix((local.ravel(), (i.ravel(), j.ravel())), shape=(2 * count, 2 * count)).tocsr()


def _between(matrix, columns, group):
    """``columns' matrix**-1 columns`` of a positive definite sparse `matrix`, by Cholesky: groups first, then what joins them.

    Only the forward substitution is needed. `group` ``(n,)`` is a number from 0 for unknowns that are coupled only to their own
    group and to those of number -1.
    """
    order = np.argsort(np.where(group < 0, group.max() + 1, group), kind="stable")
    ends = np.append(np.searchsorted(group[order][: (group >= 0).sum()], np.arange(group.max() + 2)), group.size)
    matrix, columns = matrix[order][:, order].tocsr(), columns[order]
    first = ends[-2]
    joint, load = matrix[first:, first:].toarray(), columns[first:]
    out = np.zeros((columns.shape[1],) * 2)
    for start, stop in zip(ends[:-2], ends[1:-1], strict=True):
        try:
            lower = cholesky(matrix[start:stop, start:stop].toarray(), lower=True, check_finite=False)
        except LinAlgError as error:
            raise RuntimeError("the triangles of the section fold or nearly do: change refine a little") from error
        across = matrix[start:stop, first:]
        touched = np.unique(across.indices)
        seen = np.flatnonzero(columns[start:stop].any(axis=0))
        right = np.hstack([across[:, touched].toarray(), columns[start:stop, seen]])
        right = solve_triangular(lower, right, lower=True, check_finite=False)
        product = right.T @ right
        n = touched.size
        joint[np.ix_(touched, touched)] -= product[:n, :n]
        load[np.ix_(touched, seen)] -= product[:n, n:]
        out[np.ix_(seen, seen)] += product[n:, n:]
    right = solve_triangular(cholesky(joint, lower=True, check_finite=False), load, lower=True, check_finite=False)
    return out + right.T @ right


def _groups(sector, numbers, count):
    """Group of each node for `_between`: triangles halved again and again by place, -1 where groups meet."""
    centre = sector.points[:, sector.triangles].mean(axis=1)
    group = np.zeros(centre.shape[1], dtype=int)
    for level in range(max(1, round(math.log2(group.size / GROUP)))):
        for k in range(2**level):
            own = np.flatnonzero(group == k)
            axis = np.argmax(np.ptp(centre[:, own], axis=1))
            group[own[np.argsort(centre[axis, own])[own.size // 2 :]]] += 2**level
    low, high = np.full(count, group.size), np.full(count, -1)
    every = np.broadcast_to(group, numbers.shape).ravel()
    np.minimum.at(low, numbers.ravel(), every)
    np.maximum.at(high, numbers.ravel(), every)
    return np.where(low == high, low, -1)


def _polar(gear, nodes):
    """Rotation from radial and tangential to Cartesian components of the side nodes."""
    angle = math.pi / gear.z
    blocks = [np.array([[math.sin(a), math.cos(a)], [math.cos(a), -math.sin(a)]]) for a in (-angle, angle)]
    out = np.zeros((4 * nodes, 4 * nodes))
    for k in range(2 * nodes):
        out[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = blocks[k // nodes]
    return out


def _frames(gear, roll):
    """Places ``(2, n)`` of loads on the flank, their directions into it, and the tangents towards the tip."""
    radius, angle = flank(gear, roll)
    inward = -flank_normal(gear, roll)
    return np.array([radius * np.sin(angle), radius * np.cos(angle)]), inward, gear.outward * np.array([inward[1], -inward[0]])


def _matched(gear, sector, order):
    """Places ``(2, n)`` of the nodes of both sides, the held corner left out, and of the held edge."""
    line = (lobatto(order) + 1) / 2
    out = []
    for side in (sector.left, sector.right):
        a, b = sector.points[:, side[:-1], None], sector.points[:, side[1:], None]
        out.append((a * (1 - line[1:]) + b * line[1:]).reshape(2, -1))
    angle = np.arctan2(*sector.points[:, sector.held])
    places = np.append((angle[:-1, None] + np.diff(angle)[:, None] * line[:-1]).ravel(), angle[-1])
    return np.hstack([*out, cartesian(gear.held, places)])


def _apart(sector, chain, count):
    """Columns of unit forces that push the facing nodes of the cracks apart, tips left out."""
    rows, columns, values, k = [], [], [], 0
    for left, right in sector.faces:
        ahead = np.diff(sector.points[:, left], axis=1)
        normal = np.array([-ahead[1], ahead[0]]) / np.hypot(*ahead)
        pairs = np.array([chain(left), chain(right)])[:, :-1]
        normal = np.repeat(normal, pairs.shape[1] // normal.shape[1], axis=1)
        for sign, nodes in ((1, pairs[0]), (-1, pairs[1])):
            rows.append((2 * nodes + np.arange(2)[:, None]).ravel())
            columns.append(np.tile(k + np.arange(nodes.size), 2))
            values.append(sign * normal.ravel())
        k += pairs.shape[1]
    if not rows:
        return coo_matrix((2 * count, 0)).tocsr()
    return coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(2 * count, k)).tocsr()


def _loads(gear, sector, chain, numbers, count, roll, order, modulus, ratio):
    """Nodal forces ``(2 count, n)`` of the singular fields' tractions, rows that read the flank, and what those fields add."""
    n = roll.size
    if n == 0:
        return np.zeros((2 * count, 0)), np.zeros((0, 2 * count)), np.zeros((0, 0))
    where, inward, tip_side = _frames(gear, roll)
    gauss, weight = leggauss(BULGE)
    shapes = lagrange(order, tuple(gauss))
    start, stop, bulge = _boundary(sector)
    ends = sector.points[:, start], sector.points[:, stop]
    points = (ends[0][..., None] * (1 - gauss) + ends[1][..., None] * (1 + gauss)) / 2 + (1 - gauss**2) * bulge
    nodal = np.linalg.solve(np.vander(gauss, increasing=True), np.moveaxis(bulge, -1, 0).reshape(BULGE, -1)).reshape(BULGE, 2, -1)
    powers = np.arange(BULGE)
    slope = (1 - gauss**2)[:, None] * np.where(powers > 0, powers * gauss[:, None] ** np.maximum(powers - 1, 0), 0.0)
    slope = slope - 2 * gauss[:, None] * gauss[:, None] ** powers
    along = (ends[1] - ends[0])[..., None] / 2 + np.einsum("gk,kde->deg", slope, nodal)
    outward = np.array([along[1], -along[0]]) * weight  # times the length element; triangles run counter-clockwise
    spread = flamant.traction(points.reshape(2, -1), outward.reshape(2, -1), where, inward, tip_side)
    spread = spread.reshape(2, n, start.size, gauss.size)
    force = -np.einsum("pg,dneg->epdn", shapes, spread)
    nodes = np.array([chain([a, b]) for a, b in zip(start.tolist(), stop.tolist(), strict=True)])
    load = np.zeros((count, 2, n))
    np.add.at(load, nodes, force)
    read = np.zeros((n, count, 2))
    edge = np.clip(np.searchsorted(sector.roll * gear.outward, roll * gear.outward) - 1, 0, sector.roll.size - 2)
    low, high = sector.roll[edge], sector.roll[edge + 1]
    values = lagrange(order, tuple((2 * (roll - low) / (high - low) - 1).tolist()))
    for i in range(n):
        at = chain(sector.flank[edge[i] : edge[i] + 2])
        read[i, at] = values[:, i, None] * inward[:, i]
    near = np.where(np.eye(n, dtype=bool), 1.0, 0.0)
    arc = arc_at(gear, roll)
    apart = np.abs(arc[:, None] - arc) + near
    shifted = where[:, None, :] + near * inward[:, None, :]  # keep the logarithm finite on the diagonal, which is zero
    field = np.empty((n, n))
    for j in range(n):
        one = slice(j, j + 1)
        moved = flamant.displacement(shifted[:, j], where[:, one], inward[:, one], tip_side[:, one], modulus, ratio)[:, 0]
        field[:, j] = np.einsum("dn,dn->n", moved, inward)
    field = np.where(near > 0, 0.0, field + 2 / (math.pi * modulus) * np.log(apart))
    return load.reshape(2 * count, n), read.reshape(n, 2 * count), field


def _boundary(sector):
    """Boundary edges as vertices ``(e,)``, ``(e,)`` with the material on the left, and their bulges ``(2, e, BULGE)``."""
    pairs = np.concatenate([sector.triangles[[a, b]].T for a, b in ENDS])
    known = {tuple(pair) for pair in pairs.tolist()}
    edges = [(a, b) for a, b in pairs.tolist() if (b, a) not in known]
    flat = np.zeros((2, BULGE))
    bulges = [sector.bulge[a, b] if (a, b) in sector.bulge else sector.bulge.get((b, a), flat)[:, ::-1] for a, b in edges]
    start, stop = np.array(edges).T
    return start, stop, np.array(bulges).transpose(1, 0, 2)
