"""A pitch sector of a helical gear as an elastic body: section triangles times polynomials along the width.

In the frame that turns with the helix no coefficient depends on z: with x = R(w z) X, u = R(w z) v(X, Y, z) and R clockwise,

    d/dz at fixed (x, y) = D v = v_z - w T v,    T v = (Y d_X - X d_Y) v - (v_2, -v_1, 0)
    xx = v1_X, yy = v2_Y, zz = (D v)_3, xy = v1_Y + v2_X, xz = (D v)_1 + v3_X, yz = (D v)_2 + v3_Y

so that the stiffness is exactly ``K00 x M + K01 x C + K01' x C' + K11 x Dz`` of three matrices of the plane section and three of
the axial polynomials f: ``M = int f f'``, ``C = int f df'``, ``Dz = int df df'`` (`axial`). The two nodes that face each other
in a crack open over a part of the width are replaced by their mean and their distance: the mean has the functions of all other
nodes, the distance those of the opening.
"""

import math
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import block_diag, cholesky, solve_triangular
from scipy.linalg.blas import dsyrk

from geometry.tooth import arc_at, flank_normal, roll_at_arc
from geometry.triangle import BULGE, jacobians, lagrange, table

from .axial import axial
from .panel import Panel, _numbering

LEAF = 2  # triangles eliminated together first
CUTS, PARTS = 8, (0.4, 0.45, 0.5, 0.55, 0.6)  # directions in which sets of triangles are divided, and where
CLOSE = 0.5  # how near a crack [m_n] nodes have the functions that its ends along the width need
NEAR_TIP = 0.1  # faces closer to a crack's tip than this part of its length cannot be seen to touch


def panel3d(gear, sector, material, knots, width, *, order, degree, plane=False, parts=(), tree=None):
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
    parts : tuple
        Where the cracks of the sector are open, see `axial.axial`; default over the whole width.
    tree : tuple, optional
        Of `dissect`.

    Returns
    -------
    Panel
        Unknowns are node by node, polar components (radial, tangential, axial), modes innermost; loads hat by hat, modes
        innermost. Its `own` is the full displacement with the sides held, nothing taken out. Faces of cracks are pushed apart
        at the points of `axial.Axial`, pair of nodes by pair; the opening is that in the section.
    """
    numbers, count, chain = _numbering(sector, order)
    tilt = 0.0 if plane else gear.beta_b
    load = _hats(gear, sector, chain, count, knots, order, tilt)
    sides = np.concatenate([chain(side)[1:] for side in (sector.left, sector.right)])
    parts = parts or (None,) * len(sector.faces)
    along = axial(width, degree, parts, gear.m_n)
    apart, owner = (np.zeros((count, 3, 0)), []) if plane else _apart(sector, chain, count)
    seams = [chain(face)[:-1] for i, pair in enumerate(sector.faces) if parts[i] for face in pair]
    seams = list(zip(seams[::2], seams[1::2], strict=True))
    body = _body(numbers, order, np.concatenate([load, apart], axis=2), sides, chain(sector.held), seams)
    body.section = _section(sector, order, material, 0.0 if plane else math.tan(gear.beta) / gear.r)
    body.axial = along
    kind = np.zeros(body.size.size, dtype=int)  # which functions along the width
    for i, (_, right) in zip([i for i, own in enumerate(parts) if own], seams, strict=True):
        kind[_near(gear, sector, body, sector.faces[i])] = 3 + 3 * i
        kind[right] = 1 + 3 * i
    kind[sides] = 0
    kind[body.first_load + knots.shape[1] :] = [2 + 3 * i for i in owner]
    body.kind = kind
    body.size = body.size * np.array([own.size for own in along.sets])[kind]
    ids, matrix = _front(body, dissect(sector) if tree is None else tree)
    at = _places(body, ids, np.concatenate([sides, np.arange(body.first_load, body.size.size)]))
    matrix = matrix[np.ix_(at, at)]
    border = 3 * sides.size * (degree + 1)
    angle = np.repeat([-math.pi / gear.z, math.pi / gear.z], sides.size // 2)
    edge = _polar(angle, _polar(angle, matrix[:border, :border]).T)
    push = _polar(angle, matrix[:border, border:])
    own = -(matrix[border:, border:] + matrix[border:, border:].T) / 2
    n = knots.shape[1] * (degree + 1)
    points = block_diag(*(along.at[i] for i in owner)) if owner else np.zeros((0, 0))
    return Panel(
        stiffness=(edge + edge.T) / 2,
        push=push[:, :n],
        own=own[:n, :n],
        open_push=push[:, n:] @ points.T,
        open_own=points @ own[n:, :n],
        open_open=points @ own[n:, n:] @ points.T,
        unknowns=3 * count * (degree + 1),
    )


def _apart(sector, chain, count):
    """Forces ``(count, 3, k)`` that push facing nodes of the cracks apart, and the crack of each; those next to tips left out."""
    columns, owner = [], []
    for i, (left, right) in enumerate(sector.faces):
        places = sector.points[:, left]
        ahead = np.diff(places, axis=1)
        lengths = np.hypot(*ahead)
        normal = np.array([-ahead[1], ahead[0]]) / lengths
        pairs = np.array([chain(left), chain(right)])[:, :-1]
        each = pairs.shape[1] // lengths.size
        to_tip = np.cumsum(lengths[::-1])[::-1]
        for k in range(pairs.shape[1]):
            if to_tip[k // each] > NEAR_TIP * lengths.sum():
                force = np.zeros((count, 3))
                force[pairs[0, k], :2], force[pairs[1, k], :2] = normal[:, k // each], -normal[:, k // each]
                columns.append(force)
                owner.append(i)
    return (np.stack(columns, axis=2) if columns else np.zeros((count, 3, 0))), owner


def _near(gear, sector, body, face):
    """Numbers of the nodes of triangles with a vertex closer than `CLOSE` to a crack."""
    line = sector.points[:, face[0]]
    part = np.arange(8) / 8
    line = (line[:, :-1, None] + np.diff(line, axis=1)[..., None] * part).reshape(2, -1)
    away = np.hypot(*(sector.points[:, :, None] - line[:, None, :])).min(axis=1)
    close = (away < CLOSE * gear.m_n)[sector.triangles].any(axis=0)
    return np.unique(body.numbers[:, close])


def dissect(sector):
    """Nested halves of the triangles: ``(triangles, first half, second half)``, the halves empty where few are left."""
    centre = sector.points[:, sector.triangles].mean(axis=1)

    def parted(own):
        if own.size <= LEAF:
            return own, (), ()
        one, two = _halves(sector.triangles, centre, own)
        return own, parted(one), parted(two)

    return parted(np.arange(sector.triangles.shape[1]))


def _halves(triangles, centre, own):
    """Two parts of a set of triangles, on both sides of the straight cut through the fewest vertices."""
    fewest, halves = np.inf, None
    cuts = np.unique([max(1, round(part * own.size)) for part in PARTS])
    for turn in np.arange(CUTS) * math.pi / CUTS:
        order = own[np.argsort(np.array([math.cos(turn), math.sin(turn)]) @ centre[:, own], kind="stable")]
        found, place = np.unique(triangles[:, order], return_inverse=True)
        rank = np.broadcast_to(np.arange(own.size), (3, own.size)).ravel()
        first, last = np.full(found.size, own.size), np.zeros(found.size, dtype=int)
        np.minimum.at(first, place.ravel(), rank)
        np.maximum.at(last, place.ravel(), rank)
        shared = ((first < cuts[:, None]) & (last >= cuts[:, None])).sum(axis=1)
        best = int(shared.argmin())
        if shared[best] < fewest:
            fewest, halves = shared[best], (order[: cuts[best]], order[cuts[best] :])
    return halves


def _polar(angle, matrix):
    """Rows of side nodes at `angle`, from Cartesian to radial, tangential and axial components."""
    sin, cos = np.sin(angle)[:, None], np.cos(angle)[:, None]
    x, y, z = matrix.reshape(angle.size, 3, -1).transpose(1, 0, 2)
    return np.stack([sin * x + cos * y, cos * x - sin * y, z], axis=1).reshape(matrix.shape)


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


def _body(numbers, order, load, sides, held, seams):
    """All that the elimination looks up.

    It numbers the nodes from 0, then the insides of the triangles, and the loads from `first_load`; `size` is in modes. `touch`
    are the numbers a triangle is coupled to; in `seams`, pairs of facing nodes, the first number stands for their mean and the
    second for their distance.
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
    partner = np.arange(first_load)
    for left, right in seams:
        partner[left], partner[right] = right, left
    touch = [np.union1d(own, partner[own]) for own in every.T]
    return SimpleNamespace(
        numbers=every,
        touch=touch,
        seams=seams,
        owner=owner,
        load=np.concatenate([load, np.zeros((first_load - count, 3, n))]),
        first_load=first_load,
        size=np.append(np.full(first_load, 3), np.ones(n, dtype=int)),
        uses=np.bincount(np.concatenate(touch), minlength=first_load + n),
        stays=stays,
        there=there,
    )


def _front(body, tree):
    """What a set of triangles is to the rest: numbers of the nodes and loads still coupled, and the matrix between them.

    Triangles are divided until few are left; what only the set touches is eliminated. The loads are carried along as
    unknowns that stay: at the end their block is minus the displacements under each other.
    """
    parts, own = (), tree[0]
    if not tree[1]:
        nodes = np.unique(body.numbers[:, own])
        loads = body.load[nodes[np.isin(body.owner[nodes], own)]].any(axis=(0, 1))
        ids = np.unique(np.concatenate([body.touch[k] for k in own.tolist()]))
        ids = np.append(ids, body.first_load + np.flatnonzero(loads))
    else:
        parts = [_front(body, half) for half in tree[1:]]
        ids = np.union1d(parts[0][0], parts[1][0])
    ids = ids[body.there[ids]]
    used = np.bincount(np.concatenate([body.touch[k] for k in own.tolist()]), minlength=body.size.size)
    gone = (used[ids] == body.uses[ids]) & ~body.stays[ids]
    ids = np.append(ids[gone], ids[~gone])
    matrix = np.zeros((body.size[ids].sum(),) * 2) if parts else _leaf(body, own, ids)
    for others, part in parts:
        _add(matrix, part, _places(body, ids, others))
    first = body.size[ids[: gone.sum()]].sum()
    if first:
        lower = cholesky(matrix[:first, :first], lower=True, check_finite=False)
        across = solve_triangular(lower, matrix[:first, first:], lower=True, check_finite=False)
        matrix = matrix[first:, first:] - _square(across)
    return ids[gone.sum() :], matrix


def _square(across):
    """``across' across``, half of it computed."""
    upper = dsyrk(1.0, across, trans=1)
    out = upper + upper.T
    out[np.diag_indices_from(out)] /= 2
    return out


def _add(matrix, part, at):
    """Add `part` to the rows and columns `at` of `matrix`, run by run: faster than by index arrays."""
    ends = [0, *(np.flatnonzero(np.diff(at) != 1) + 1).tolist(), at.size]
    runs = [(slice(a, b), slice(at[a], at[b - 1] + 1)) for a, b in pairwise(ends)]
    for source, rows in runs:
        for across, columns in runs:
            matrix[rows, columns] += part[source, across]


def _places(body, ids, wanted):
    """Places of the unknowns of `wanted` among those of `ids`."""
    start = np.zeros(body.size.size, dtype=int)
    start[ids] = np.cumsum(body.size[ids]) - body.size[ids]
    size = body.size[wanted]
    return np.repeat(start[wanted] - np.cumsum(size) + size, size) + np.arange(size.sum())


def _leaf(body, own, ids):
    """Matrix of a few triangles between `ids`: the section's is assembled first, then multiplied by the axial ones."""
    raw = np.unique(body.numbers[:, own])
    nodes, loads = ids[ids < body.first_load], ids[ids >= body.first_load]
    index = np.full(body.first_load, -1)
    index[raw] = np.arange(raw.size)
    plane = np.zeros((3, 3 * raw.size, 3 * raw.size))
    for triangle in own:
        at = (3 * index[body.numbers[:, triangle]][:, None] + np.arange(3)).ravel()
        plane[(slice(None), *np.ix_(at, at))] += body.section[:, triangle]
    here = np.where(np.isin(body.owner[raw], own)[:, None, None], body.load[raw], 0.0)[:, :, loads - body.first_load]
    turn = _seamed(body, raw, nodes)
    here = (turn.T @ here.reshape(raw.size, -1)).reshape(3 * nodes.size, loads.size)
    if np.isin(turn, (0.0, 1.0)).all():
        at = (3 * np.searchsorted(raw, nodes)[:, None] + np.arange(3)).ravel()
        plane = plane[:, at[:, None], at]
    else:
        turn = np.kron(turn, np.eye(3))
        plane = turn.T @ plane @ turn
    return _times(body, plane, here, nodes, loads)


def _seamed(body, raw, nodes):
    """Matrix ``(raw, nodes)`` from means and distances of facing nodes to the nodes themselves; others are themselves."""
    out = (raw[:, None] == nodes).astype(float)
    for left, right in body.seams:
        mean, apart = (nodes == pair[:, None] for pair in (left, right))
        for k in np.flatnonzero(mean.any(axis=1)):
            for side, sign in ((left[k], 0.5), (right[k], -0.5)):
                row = raw == side
                if row.any():
                    out[row] = mean[k] + sign * apart[k]
    return out


def _times(body, plane, here, nodes, loads):
    """The section's matrices and loads multiplied by those of the functions along the width, set by set."""
    along, ids = body.axial, np.append(nodes, loads)
    start = np.cumsum(body.size[ids]) - body.size[ids]
    out = np.zeros((body.size[ids].sum(),) * 2)
    kinds = np.unique(body.kind[nodes]).tolist()
    groups = {}
    for kind in kinds:
        own = np.flatnonzero(body.kind[nodes] == kind)
        size = along.sets[kind].size
        rows = (start[own][:, None] + np.arange(3 * size)).ravel()
        groups[kind] = along.sets[kind], (3 * own[:, None] + np.arange(3)).ravel(), rows
    for f, at, rows in groups.values():
        for g, others, columns in groups.values():
            both = np.ix_(at, others)
            block = np.kron(plane[0][both], along.mass[np.ix_(f, g)]) + np.kron(plane[2][both], along.slope[np.ix_(f, g)])
            block += np.kron(plane[1][both], along.mixed[np.ix_(f, g)])
            block += np.kron(plane[1].T[both], along.mixed.T[np.ix_(f, g)])
            _put(out, rows, columns, block)
        for k, load in enumerate(loads.tolist()):
            pushed = along.sets[body.kind[load]]
            first = start[nodes.size + k]
            block = np.kron(here[at, k][:, None], along.mass[np.ix_(f, pushed)])
            out[rows, first : first + pushed.size] = block
            out[first : first + pushed.size, rows] = block.T
    return out


def _put(out, rows, columns, block):
    """Write a block, at once if it is the top left of `out`."""
    if rows[-1] == rows.size - 1 and columns[-1] == columns.size - 1:
        out[: rows.size, : columns.size] = block
    else:
        out[np.ix_(rows, columns)] = block
