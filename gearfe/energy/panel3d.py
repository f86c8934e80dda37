"""A pitch sector of a helical gear as an elastic body: section triangles times polynomials along the width.

In the frame that turns with the helix no coefficient depends on z: with x = R(w z) X, u = R(w z) v(X, Y, z) and R clockwise,

    d/dz at fixed (x, y) = D v = v_z - w T v,    T v = (Y d_X - X d_Y) v - (v_2, -v_1, 0)
    xx = v1_X, yy = v2_Y, zz = (D v)_3, xy = v1_Y + v2_X, xz = (D v)_1 + v3_X, yz = (D v)_2 + v3_Y

so that the stiffness is exactly ``K00 x M + K01 x C + K01' x C' + K11 x Dz`` of three matrices of the plane section and three of
the axial polynomials f: ``M = int f f'``, ``C = int f df'``, ``Dz = int df df'``. One polynomial over the whole width spans the
same space in any basis; the orthonormal Legendre polynomials make M the identity and the loads those of each mode.
"""

import math
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import cholesky, solve_triangular

from geometry.tooth import arc_at, flank_normal, roll_at_arc
from geometry.triangle import BULGE, jacobians, lagrange, table

from .halfspace import modes
from .panel import Panel, _numbering

LEAF = 2  # triangles eliminated together first
CUTS, PARTS = 8, (0.4, 0.45, 0.5, 0.55, 0.6)  # directions in which sets of triangles are divided, and where


def panel3d(gear, sector, material, knots, width, *, order, degree, plane=False):
    """Reduce a sector to its two helicoidal sides.

    Parameters
    ----------
    gear : Gear
        Its helix angle turns the section clockwise by ``tan(beta) / r`` per height z (negative: the other way).
    sector : geometry.sector.Sector
    material : Material
    knots : ndarray, shape (3, n)
        Start, top and end of hats of unit area along the arc of the loaded flank [mm]: unit loads per width along the inward
        normal of the helicoid, times each axial mode of `halfspace.modes`.
    width : float
        [mm]; both end faces are free.
    order, degree : int
        Of the polynomials in the section and along the width.
    plane : bool
        The transverse section as if it were a spur gear's: with degree 0 and width 1 it is in plane strain.

    Returns
    -------
    Panel
        Unknowns are node by node, polar components (radial, tangential, axial), modes innermost; loads hat by hat, modes
        innermost. Its `own` is the full displacement with the sides held, nothing taken out.
    """
    numbers, count, chain = _numbering(sector, order)
    tilt = 0.0 if plane else gear.beta_b
    load = _hats(gear, sector, chain, count, knots, order, tilt)
    sides = np.concatenate([chain(side)[1:] for side in (sector.left, sector.right)])
    body = _body(sector, numbers, order, load, sides, chain(sector.held))
    body.section = _section(sector, order, material, 0.0 if plane else math.tan(gear.beta) / gear.r)
    body.axial = _axial(width, degree)
    body.size[:] *= degree + 1
    ids, matrix = _front(body, np.arange(numbers.shape[1]))
    at = _places(body, ids, np.concatenate([sides, np.arange(body.first_load, body.size.size)]))
    matrix = matrix[np.ix_(at, at)]
    border = 3 * sides.size * (degree + 1)
    angle = np.repeat([-math.pi / gear.z, math.pi / gear.z], sides.size // 2)
    edge = _polar(angle, _polar(angle, matrix[:border, :border]).T)
    push = _polar(angle, matrix[:border, border:])
    own = -matrix[border:, border:]
    empty = np.zeros((border, 0)), np.zeros((0, own.shape[0])), np.zeros((0, 0))
    return Panel((edge + edge.T) / 2, push, (own + own.T) / 2, *empty, 3 * count * (degree + 1))


def _polar(angle, matrix):
    """Rows of side nodes at `angle`, from Cartesian to radial, tangential and axial components."""
    sin, cos = np.sin(angle)[:, None], np.cos(angle)[:, None]
    x, y, z = matrix.reshape(angle.size, 3, -1).transpose(1, 0, 2)
    return np.stack([sin * x + cos * y, cos * x - sin * y, z], axis=1).reshape(matrix.shape)


def _axial(width, degree):
    """``M, C, Dz`` of the modes over the width."""
    gauss, weight = legendre.leggauss(degree + 1)
    value = modes((1 + gauss) / 2 * width, width, degree)
    scale = np.sqrt((2 * np.arange(degree + 1) + 1) / width) * 2 / width
    slope = legendre.legvander(gauss, degree)[:, :degree] @ legendre.legder(np.eye(degree + 1)) if degree else 0 * value
    slope = slope * scale
    weight = (weight * width / 2)[:, None]
    return np.eye(degree + 1), value.T @ (weight * slope), slope.T @ (weight * slope)


def _section(sector, order, material, twist):
    """``K00, K01, K11`` of all triangles ``(3, m, 3 nodes, 3 nodes)``."""
    basis = table(order)
    bulges = sector.edge_bulges()
    (xx, xy), (yx, yy) = jacobians(sector.points, sector.triangles, bulges, order).transpose(1, 2, 0, 3)
    area = xx * yy - xy * yx
    first, second = basis.slope
    dx = (yy / area)[:, None] * first - (yx / area)[:, None] * second
    dy = (xx / area)[:, None] * second - (xy / area)[:, None] * first
    place = np.einsum("cq,dcm->dmq", basis.corner, sector.points[:, sector.triangles])
    x, y = place + np.einsum("kqg,kdgm->dmq", basis.bulge, bulges, optimize=True)
    around = y[:, None] * dx - x[:, None] * dy
    value = np.broadcast_to(basis.value, dx.shape)
    flat, along = (np.zeros((6, 3, *dx.shape)) for _ in range(2))  # strains xx, yy, zz, xy, xz, yz of v and of v_z
    flat[0, 0] = flat[3, 1] = flat[4, 2] = dx
    flat[1, 1] = flat[3, 0] = flat[5, 2] = dy
    flat[2, 2] = flat[4, 0] = flat[5, 1] = -twist * around
    flat[4, 1], flat[5, 0] = twist * value, -twist * value
    along[2, 2] = along[4, 0] = along[5, 1] = value
    stiffness = np.zeros((6, 6))
    stiffness[:3, :3] = material.lame("plane strain")[0]
    stiffness += material.shear_modulus * np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    weight = np.sqrt(area * basis.weight)[:, None]
    flat, along = ((part * weight).transpose(2, 3, 1, 0, 4).reshape(area.shape[0], 3 * basis.count, -1) for part in (flat, along))
    flat_stress, along_stress = (
        np.einsum("ij,mnjq->mniq", stiffness, part.reshape(*part.shape[:2], 6, -1), optimize=True).reshape(part.shape)
        for part in (flat, along)
    )
    flat, along = flat.transpose(0, 2, 1), along.transpose(0, 2, 1)
    return np.array([flat_stress @ flat, flat_stress @ along, along_stress @ along])


def _hats(gear, sector, chain, count, knots, order, tilt):
    """Nodal forces ``(count, 3, n)`` of the hats, in the section at z = 0 (they turn with it); `tilt` is beta_b.

    The inward normal of the helicoid is ``(-cos(beta_b) n, sin(beta_b))``, n the section's outward normal with moment r_b:
    it is at right angles to the profile's tangent and to the trace ``(w Y, -w X, 1)``.
    """
    gauss, weight = legendre.leggauss(BULGE)
    arcs = arc_at(gear, sector.roll)
    out = np.zeros((count, 3, knots.shape[1]))
    for i, (start, top, stop) in enumerate(knots.T):
        for k in range(arcs.size - 1):
            ends = np.unique(np.clip([start, top, stop], arcs[k], arcs[k + 1]))
            nodes = chain(sector.flank[k : k + 2])
            for a, b in zip(ends[:-1], ends[1:], strict=True):
                arc = (a + b) / 2 + (b - a) / 2 * gauss
                roll = roll_at_arc(gear, arc)
                place = 2 * (roll - sector.roll[k]) / (sector.roll[k + 1] - sector.roll[k]) - 1
                height = 2 / (stop - start) * np.minimum((arc - start) / (top - start), (stop - arc) / (stop - top))
                normal = np.vstack([-math.cos(tilt) * flank_normal(gear, roll), np.full(arc.size, math.sin(tilt))])
                shapes = lagrange(order, tuple(place.tolist()))
                out[nodes, :, i] += (shapes * (weight * (b - a) / 2 * height)) @ normal.T
    return out


def _body(sector, numbers, order, load, sides, held):
    """All that the elimination looks up.

    It numbers the nodes from 0, then the insides of the triangles, and the loads from `first_load`; `size` is in modes.
    """
    count, _, n = load.shape
    triangles = numbers.shape[1]
    inside = table(order).inside
    first_load = count + triangles * inside
    every = np.concatenate([numbers, count + np.arange(triangles * inside).reshape(triangles, inside).T])
    owner = np.full(first_load, triangles)
    np.minimum.at(owner, every.ravel(), np.broadcast_to(np.arange(triangles), every.shape).ravel())
    stays, there = np.zeros(first_load + n, dtype=bool), np.ones(first_load + n, dtype=bool)
    stays[sides] = stays[first_load:] = True
    there[held] = False
    return SimpleNamespace(
        numbers=every,
        centre=sector.points[:, sector.triangles].mean(axis=1),
        owner=owner,
        load=np.concatenate([load, np.zeros((first_load - count, 3, n))]),
        first_load=first_load,
        size=np.append(np.full(first_load, 3), np.ones(n, dtype=int)),
        uses=np.bincount(every.ravel(), minlength=first_load + n),
        stays=stays,
        there=there,
    )


def _front(body, own):
    """What a set of triangles is to the rest: numbers of the nodes and loads still coupled, and the matrix between them.

    Triangles are divided until few are left; what only the set touches is eliminated. The loads are carried along as
    unknowns that stay: at the end their block is minus the displacements under each other.
    """
    parts = ()
    if own.size <= LEAF:
        ids = np.unique(body.numbers[:, own])
        loads = body.load[ids[np.isin(body.owner[ids], own)]].any(axis=(0, 1))
        ids = np.append(ids, body.first_load + np.flatnonzero(loads))
    else:
        parts = [_front(body, half) for half in _halves(body, own)]
        ids = np.union1d(parts[0][0], parts[1][0])
    ids = ids[body.there[ids]]
    used = np.bincount(body.numbers[:, own].ravel(), minlength=body.size.size)
    gone = (used[ids] == body.uses[ids]) & ~body.stays[ids]
    ids = np.append(ids[gone], ids[~gone])
    matrix = np.zeros((body.size[ids].sum(),) * 2) if parts else _leaf(body, own, ids)
    for others, part in parts:
        _add(matrix, part, _places(body, ids, others))
    first = body.size[ids[: gone.sum()]].sum()
    if first:
        lower = cholesky(matrix[:first, :first], lower=True, check_finite=False)
        across = solve_triangular(lower, matrix[:first, first:], lower=True, check_finite=False)
        matrix = matrix[first:, first:]
        matrix -= across.T @ across
    return ids[gone.sum() :], matrix


def _add(matrix, part, at):
    """Add `part` to the rows and columns `at` of `matrix`, run by run: faster than by index arrays."""
    ends = [0, *(np.flatnonzero(np.diff(at) != 1) + 1).tolist(), at.size]
    runs = [(slice(a, b), slice(at[a], at[b - 1] + 1)) for a, b in pairwise(ends)]
    for source, rows in runs:
        for across, columns in runs:
            matrix[rows, columns] += part[source, across]


def _halves(body, own):
    """Two parts of a set of triangles, on both sides of the straight cut through the fewest nodes."""
    fewest, halves = np.inf, None
    for turn in np.arange(CUTS) * math.pi / CUTS:
        order = own[np.argsort(np.array([math.cos(turn), math.sin(turn)]) @ body.centre[:, own], kind="stable")]
        for part in PARTS:
            here = max(1, round(part * own.size))
            cut = np.intersect1d(body.numbers[:, order[:here]], body.numbers[:, order[here:]]).size
            if cut < fewest:
                fewest, halves = cut, (order[:here], order[here:])
    return halves


def _places(body, ids, wanted):
    """Places of the unknowns of `wanted` among those of `ids`."""
    start = np.zeros(body.size.size, dtype=int)
    start[ids] = np.cumsum(body.size[ids]) - body.size[ids]
    size = body.size[wanted]
    return np.repeat(start[wanted] - np.cumsum(size) + size, size) + np.arange(size.sum())


def _leaf(body, own, ids):
    """Matrix of a few triangles between `ids`: the section's is assembled first, then multiplied by the axial ones."""
    nodes, loads = ids[ids < body.first_load], ids[ids >= body.first_load] - body.first_load
    index = np.full(body.first_load, -1)
    index[nodes] = np.arange(nodes.size)
    plane = np.zeros((3, 3 * nodes.size, 3 * nodes.size))
    for triangle in own:
        at = (3 * index[body.numbers[:, triangle]][:, None] + np.arange(3)).ravel()
        used = np.flatnonzero(at >= 0)
        plane[(slice(None), *np.ix_(at[used], at[used]))] += body.section[:, triangle][(slice(None), *np.ix_(used, used))]
    one, slope, both = body.axial
    first = 3 * nodes.size * one.shape[0]
    out = np.zeros((first + loads.size * one.shape[0],) * 2)
    mixed = np.kron(plane[1], slope)
    out[:first, :first] = np.kron(plane[0], one) + mixed + mixed.T + np.kron(plane[2], both)
    here = np.where(np.isin(body.owner[nodes], own)[:, None, None], body.load[nodes], 0.0)[:, :, loads]
    out[:first, first:] = np.kron(here.reshape(3 * nodes.size, loads.size), one)
    out[first:, :first] = out[:first, first:].T
    return out
