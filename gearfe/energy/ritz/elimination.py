"""Elimination of a sector's unknowns, triangles by nested halves, with a set of functions along the width at every node."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.linalg.blas import dsyrk

from geometry.mesh.triangle import table

from .axial import Axial

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


def all_nodes(numbers, count, order):
    """Nodes of the triangles with the insides, numbered from `count` on, and how many nodes there are."""
    triangles, inside = numbers.shape[1], table(order).inside
    every = np.concatenate([numbers, count + np.arange(triangles * inside).reshape(triangles, inside).T])
    return every, count + triangles * inside


def body_of(numbers, load, section, axial, *, sides, held, seams=(), kinds=None):
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
    )


def front(body, tree):
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
        parts = [front(body, half) for half in tree[1:]]
        ids = np.union1d(parts[0][0], parts[1][0])
    ids = ids[body.there[ids]]
    used = np.bincount(np.concatenate([body.touch[k] for k in own.tolist()]), minlength=body.size.size)
    gone = (used[ids] == body.uses[ids]) & ~body.stays[ids]
    ids = np.append(ids[gone], ids[~gone])
    matrix = np.zeros((body.size[ids].sum(),) * 2) if parts else leaf(body, own, ids)
    for others, part in parts:
        _add(matrix, part, places(body, ids, others))
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
