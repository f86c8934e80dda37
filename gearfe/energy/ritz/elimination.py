"""Elimination of a sector's unknowns, triangles by nested halves, with a set of functions along the width at every node."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg.blas import dsyrk, dtrsm
from scipy.linalg.lapack import dpotrf

from geometry.mesh.triangle import table

from .axial import Axial
from .bent import BentTriangles, products

LEAF = 2  # triangles eliminated together first
CUTS, PARTS = 8, (0.4, 0.45, 0.5, 0.55, 0.6)  # directions in which sets of triangles are divided, and where


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


@dataclass(frozen=True, slots=True)
class SectorBody:
    """All that the elimination looks up; unknowns are counted in functions along the width.

    Nodes have numbers from 0, then the insides of the triangles; loads have those from `first_load` on, to k.

    Attributes
    ----------
    numbers : ndarray, shape (n, m)
        Nodes of the triangles, inside ones last.
    touch : tuple of ndarray
        Numbers each triangle is coupled to: its nodes, and those that face them in a crack.
    seams : tuple of (ndarray, ndarray)
        Pairs of facing nodes: the first number stands for their mean, the second for their distance.
    owner : ndarray, shape (first_load,)
        The first triangle at each node, which brings its load in.
    load : ndarray, shape (first_load, 3, loads)
        Nodal forces.
    first_load : int
    uses : ndarray, shape (k,)
        How many triangles touch each number.
    stays, there : ndarray of bool, shape (k,)
        What is not eliminated, and what is not held.
    section : ndarray, shape (3, m, 3 n, 3 n)
        ``K00, K01, K11`` of the triangles.
    axial : Axial
        The functions along the width.
    kind : ndarray, shape (k,)
        Which set of `axial` each number has.
    size : ndarray, shape (k,)
        How many unknowns each number stands for.
    bent : BentTriangles or None
        The triangles that move with a crack's front, whose `section` is not used.
    """

    numbers: np.ndarray
    touch: tuple
    seams: tuple
    owner: np.ndarray
    load: np.ndarray
    first_load: int
    uses: np.ndarray
    stays: np.ndarray
    there: np.ndarray
    section: np.ndarray
    axial: Axial
    kind: np.ndarray
    size: np.ndarray
    bent: BentTriangles | None = None


def all_nodes(numbers, count, order):
    """Nodes of the triangles with the insides, numbered from `count` on, and how many nodes there are."""
    triangles, inside = numbers.shape[1], table(order).inside
    every = np.concatenate([numbers, count + np.arange(triangles * inside).reshape(triangles, inside).T])
    return every, count + triangles * inside


def body_of(numbers, load, section, axial, *, sides, held, seams=(), kinds=None, bent=None):
    """`SectorBody` of the triangles.

    Parameters
    ----------
    numbers : ndarray, shape (n, m)
        Of `all_nodes`.
    load : ndarray, shape (count, 3, loads)
        Forces on the nodes that triangles share.
    section : ndarray
    axial : Axial
    sides, held : ndarray
        Nodes that stay, and nodes that do not move.
    seams : sequence of (ndarray, ndarray)
    kinds : ndarray, shape (nodes + loads,), optional
        Default: all have the polynomials over the whole width.
    bent : BentTriangles, optional
    """
    nodes, loads = max(load.shape[0], int(numbers.max()) + 1), load.shape[2]
    owner = np.full(nodes, numbers.shape[1])
    np.minimum.at(owner, numbers.ravel(), np.broadcast_to(np.arange(numbers.shape[1]), numbers.shape).ravel())
    stays, there = np.zeros(nodes + loads, dtype=bool), np.ones(nodes + loads, dtype=bool)
    stays[sides] = stays[nodes:] = True
    there[held] = False
    partner = np.arange(nodes)
    for left, right in seams:
        partner[left], partner[right] = right, left
    touch = tuple(np.union1d(own, partner[own]) for own in numbers.T)
    kind = np.zeros(nodes + loads, dtype=int) if kinds is None else kinds
    each = np.append(np.full(nodes, 3), np.ones(loads, dtype=int))
    return SectorBody(
        numbers=numbers,
        touch=touch,
        seams=tuple(seams),
        owner=owner,
        load=np.concatenate([load, np.zeros((nodes - load.shape[0], 3, loads))]),
        first_load=nodes,
        uses=np.bincount(np.concatenate(touch), minlength=nodes + loads),
        stays=stays,
        there=there,
        section=section,
        axial=axial,
        kind=kind,
        size=each * np.array([own.size for own in axial.sets])[kind],
        bent=bent,
    )


def front(body, tree):
    """What a set of triangles is to the rest: numbers of the nodes and loads still coupled, and the matrix between them.

    Triangles are divided until few are left; what only the set touches is eliminated. The loads are carried along as
    unknowns that stay: at the end their block is minus the displacements under each other. Unknowns of a set are in the order in
    which they go, so that lower triangles add up to lower triangles; those to be eliminated, the coupling and the rest are arrays
    of their own, in which everything happens in place.
    """
    turn = np.full(body.size.size, body.size.size)
    plan = _planned(body, tree, turn, [0])
    ids, lower = _eliminated(body, plan, turn)
    return ids, np.tril(lower) + np.tril(lower, -1).T


def _planned(body, tree, turn, count):
    """Triangles, numbers that go, numbers that stay, and the same of both halves; `turn` is when each number goes."""
    own = tree[0]
    parts = [_planned(body, half, turn, count) for half in tree[1:] if half]
    if parts:
        ids = np.union1d(parts[0][2], parts[1][2])
    else:
        nodes = np.unique(body.numbers[:, own])
        loads = body.load[nodes[np.isin(body.owner[nodes], own)]].any(axis=(0, 1))
        ids = np.unique(np.concatenate([body.touch[k] for k in own.tolist()]))
        ids = np.append(ids, body.first_load + np.flatnonzero(loads))
        ids = ids[body.there[ids]]
    used = np.bincount(np.concatenate([body.touch[k] for k in own.tolist()]), minlength=body.size.size)
    gone = (used[ids] == body.uses[ids]) & ~body.stays[ids]
    turn[ids[gone]] = count[0]
    count[0] += 1
    return own, ids[gone], ids[~gone], parts


def _eliminated(body, plan, turn):
    """Numbers of a set that stay, in the order in which they go, and the lower triangle of the matrix between them."""
    own, gone, rest, parts = plan
    rest = rest[np.lexsort((rest, turn[rest]))]
    ids, first = np.append(gone, rest), int(body.size[gone].sum())
    if parts:
        left = int(body.size[rest].sum())
        blocks = [np.zeros(shape, order="F") for shape in ((first, first), (left, first), (left, left))]
        for part in parts:
            others, matrix = _eliminated(body, part, turn)
            _add(blocks, matrix, places(body, ids, others), first)
    else:
        matrix = leaf(body, own, ids)
        cuts = (slice(first), slice(first)), (slice(first, None), slice(first)), (slice(first, None), slice(first, None))
        blocks = [np.asfortranarray(matrix[cut]) for cut in cuts]
    inside, across, matrix = blocks
    if first:
        lower, failed = dpotrf(inside, lower=1, clean=0, overwrite_a=1)
        if failed:
            raise RuntimeError("the triangles of the section fold or nearly do: change refine a little")
        if rest.size:
            across = dtrsm(1.0, lower, across, side=1, lower=1, trans_a=1, overwrite_b=1)
            matrix = dsyrk(-1.0, across, beta=1.0, c=matrix, lower=1, overwrite_c=1)
    return rest, matrix


def _add(blocks, part, at, first):
    """Add the lower triangle of `part` at the rows and columns `at`, run by run: faster than by index arrays."""
    inside, across, outside = blocks
    cuts = np.flatnonzero((np.diff(at) != 1) | (at[1:] == first)) + 1
    ends = [0, *cuts.tolist(), at.size]
    runs = [(slice(a, b), at[a] >= first, at[a] - first * (at[a] >= first)) for a, b in pairwise(ends) if a < b]
    for k, (source, outer, row) in enumerate(runs):
        rows = slice(row, row + source.stop - source.start)
        for others, beyond, column in runs[: k + 1]:
            target = outside if beyond else across if outer else inside
            target[rows, column : column + others.stop - others.start] += part[source, others]


def places(body, ids, wanted):
    """Places of the unknowns of `wanted` among those of `ids`."""
    start = np.zeros(body.size.size, dtype=int)
    start[ids] = np.cumsum(body.size[ids]) - body.size[ids]
    size = body.size[wanted]
    return np.repeat(start[wanted] - np.cumsum(size) + size, size) + np.arange(size.sum())


def leaf(body, own, ids):
    """Matrix of a few triangles between `ids`: the section's is assembled first, then multiplied by the axial ones."""
    raw = np.unique(body.numbers[:, own])
    nodes, loads = ids[ids < body.first_load], ids[ids >= body.first_load]
    at = 3 * np.searchsorted(raw, body.numbers[:, own])[:, None] + np.arange(3)[:, None]
    plane, factors = products(body.section, body.axial, body.bent, own, at.transpose(2, 0, 1).reshape(own.size, -1))
    here = np.where(np.isin(body.owner[raw], own)[:, None, None], body.load[raw], 0.0)[:, :, loads - body.first_load]
    turn = _seamed(body, raw, nodes)
    here = (turn.T @ here.reshape(raw.size, -1)).reshape(3 * nodes.size, loads.size)
    if np.isin(turn, (0.0, 1.0)).all():
        at = (3 * np.searchsorted(raw, nodes)[:, None] + np.arange(3)).ravel()
        plane = plane[:, at[:, None], at]
    else:
        turn = np.kron(turn, np.eye(3))
        plane = turn.T @ plane @ turn
    return _times(body, plane, factors, here, nodes, loads)


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


def _times(body, plane, factors, here, nodes, loads):
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
            widths = np.ix_(f, g)
            first = np.array([part[both].ravel() for part in plane])
            second = np.array([part[widths].ravel() for part in factors])
            block = (first.T @ second).reshape(at.size, others.size, f.size, g.size).transpose(0, 2, 1, 3)
            _put(out, rows, columns, block.reshape(rows.size, columns.size))
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
