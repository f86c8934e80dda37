"""Elimination of the unknowns of a sector by nested halves, with a set of functions along the width at every node."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ....geometry.mesh.triangle import table
from ...condense import without
from .bent import BentTriangles
from .leaf import leaf


@dataclass(frozen=True, slots=True)
class SectorBody:
    """Data of the elimination. Unknowns are functions along the width.

    Nodes have numbers from 0, then the insides of the triangles; loads have those from `first_load` on, to k.

    Attributes
    ----------
    numbers : ndarray, shape (n, m)
        Nodes of the triangles, inside ones last.
    touch : tuple of ndarray
        Numbers coupled to each triangle: its nodes, and the nodes that face them across a crack.
    seams : tuple of (ndarray, ndarray)
        Pairs of facing nodes: the first number stands for their mean, the second for their distance.
    owner : ndarray, shape (first_load,)
        First triangle at each node. The load of the node is assembled with it.
    load : ndarray, shape (first_load, 3, loads)
        Nodal forces.
    first_load : int
    uses : ndarray, shape (k,)
        Number of triangles that contain each number.
    stays, there : ndarray of bool, shape (k,)
        Masks of the numbers that are not eliminated, and of those that are not held.
    section : ndarray, shape (3, m, 3 n, 3 n)
        ``K00, K01, K11`` of the triangles, zero for triangles that move with a crack front.
    factors : dict of (int, int) to ndarray, shape (4, f, g)
        ``M, C, C', Dz`` between two sets of functions along the width.
    kind : ndarray, shape (k,)
        Set of functions along the width of each number.
    size : ndarray, shape (k,)
        Number of unknowns of each number.
    bent : BentTriangles or None
        The triangles that move with a crack's front.
    parted : bool
        Whether components in the section and axial ones have different functions, see `parity`: then ``K00, K01, K01', K11``
        come in two parts each, and as many factors.
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
    factors: dict
    kind: np.ndarray
    size: np.ndarray
    bent: BentTriangles | None = None
    parted: bool = False


def all_nodes(numbers, count, order):
    """Return the nodes of the triangles with inner nodes, numbered from `count` on, and the total number of nodes."""
    triangles, inside = numbers.shape[1], table(order).inside
    every = np.concatenate([numbers, count + np.arange(triangles * inside).reshape(triangles, inside).T])
    return every, count + triangles * inside


class LoadedSection(NamedTuple):
    """Section of a sector with its loads.

    `numbers` (n, m) are the nodes of the triangles from `all_nodes`, `stiffness` (3, m, 3 n, 3 n) their ``K00, K01, K11``. `load`
    (count, 3, loads) are forces on the nodes shared by triangles. `sides` are the nodes of both sides, left ones first, which
    are kept. `held` are the fixed nodes, `chain` is the result of `panel.numbering`.
    """

    numbers: np.ndarray
    stiffness: np.ndarray
    load: np.ndarray
    sides: np.ndarray
    held: np.ndarray
    chain: Any = None


def body_of(section, axial, *, seams=(), kinds=None, bent=None):
    """Return the `SectorBody` of a `LoadedSection` and the functions along its width.

    `SectorBody` describes `seams` and `bent`. `kinds` is its `kind`; by default all nodes have the polynomials over the width.
    """
    numbers, load = section.numbers, section.load
    nodes, loads = max(load.shape[0], int(numbers.max()) + 1), load.shape[2]
    owner = np.full(nodes, numbers.shape[1])
    np.minimum.at(owner, numbers.ravel(), np.broadcast_to(np.arange(numbers.shape[1]), numbers.shape).ravel())
    stays, there = np.zeros(nodes + loads, dtype=bool), np.ones(nodes + loads, dtype=bool)
    stays[section.sides] = stays[nodes:] = True
    there[section.held] = False
    partner = np.arange(nodes)
    for left, right in seams:
        partner[left], partner[right] = right, left
    touch = tuple(np.union1d(members, partner[members]) for members in numbers.T)
    kind = np.zeros(nodes + loads, dtype=int) if kinds is None else kinds
    used = np.unique(kind).tolist()
    components = np.append(np.full(nodes, 3), np.ones(loads, dtype=int))
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
        section=section.stiffness,
        factors={(a, b): _factors(axial, axial.sets[a], axial.sets[b]) for a in used for b in used},
        kind=kind,
        size=components * np.array([members.size for members in axial.sets])[kind],
        bent=bent,
    )


def _factors(axial, one, other):
    return np.array([part[np.ix_(one, other)] for part in (axial.mass, axial.mixed, axial.mixed.T, axial.slope)])


def front(body, tree):
    """Return the front of a set of triangles: numbers of the coupled nodes and loads, and the matrix between them.

    The triangles are divided into nested sets until few are left. Nodes that belong to one set only are eliminated with it.
    Loads are unknowns that stay. At the end their block is minus the displacements of the loads under each other. The unknowns
    of a set are in the order of elimination, so that lower triangles can be added. Eliminated unknowns, coupling and remainder
    are separate arrays, which are changed in place. The arrays of a set are allocated after those of its halves. All sets
    share the memory, except for the remainders.
    """
    return carried_out(body, *planned(body, tree))


def planned(body, tree):
    """Return the numbers that are eliminated with each set of triangles, in order of elimination."""
    turn = np.full(body.size.size, body.size.size)
    return _planned(body, tree, turn, [0]), turn


def carried_out(body, plan, turn):
    """Compute `front` by the plan of `planned`."""
    ids, lower = _eliminated(body, plan, turn, np.empty(_room(body, plan)))
    return ids, np.tril(lower) + np.tril(lower, -1).T


def _room(body, plan):
    """Return the largest sizes of the eliminated part of any set, and of its coupling."""
    _, gone, rest, parts = plan
    first, left = int(body.size[gone].sum()), int(body.size[rest].sum())
    return max(first**2 + first * left, *(_room(body, part) for part in parts), 0)


def _planned(body, tree, turn, count):
    """Return triangles, numbers to eliminate, numbers that stay, and the plans of both halves.

    `turn` is the step in which each number is eliminated. The larger half comes first, which needs less memory.
    """
    triangles, halves = tree[0], sorted(filter(None, tree[1:]), key=lambda half: -half[0].size)
    parts = [_planned(body, half, turn, count) for half in halves]
    if parts:
        ids = np.union1d(parts[0][2], parts[1][2])
    else:
        nodes = np.unique(body.numbers[:, triangles])
        loads = body.load[nodes[np.isin(body.owner[nodes], triangles)]].any(axis=(0, 1))
        ids = np.unique(np.concatenate([body.touch[k] for k in triangles.tolist()]))
        ids = np.append(ids, body.first_load + np.flatnonzero(loads))
        ids = ids[body.there[ids]]
    used = np.bincount(np.concatenate([body.touch[k] for k in triangles.tolist()]), minlength=body.size.size)
    gone = (used[ids] == body.uses[ids]) & ~body.stays[ids]
    turn[ids[gone]] = count[0]
    count[0] += 1
    return triangles, ids[gone], ids[~gone], parts


def _eliminated(body, plan, turn, room):
    """Eliminate unknowns of a set. Return the remaining ones in order of elimination, and the lower triangle of their matrix.

    The eliminated part and its coupling are written into `room`, which is free again afterwards.
    """
    triangles, gone, rest, parts = plan
    gone, rest = (
        numbers[np.lexsort((numbers, body.kind[numbers], numbers >= body.first_load, turn[numbers]))] for numbers in (gone, rest)
    )
    first, left = int(body.size[gone].sum()), int(body.size[rest].sum())
    halves = [_eliminated(body, part, turn, room) for part in parts]
    inside = room[: first**2].reshape((first, first), order="F")
    across = room[first**2 : first * (first + left)].reshape((left, first), order="F")
    matrix = np.zeros((left, left), order="F")
    inside[:], across[:] = 0.0, 0.0
    if parts:
        ids = np.append(gone, rest)
        while halves:
            part_ids, part = halves.pop()
            _add((inside, across, matrix), part, places(body, ids, part_ids), first)
            del part
    else:
        leaf(body, triangles, gone, rest, (inside, across, matrix))
    return rest, without(inside, across, matrix) if first else matrix


def _add(blocks, part, at, first):
    """Add the lower triangle of `part` at the rows and columns `at`, by slices of consecutive numbers (fast)."""
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
    """Return the positions of the unknowns `wanted` in `ids`."""
    start, size = starts(body, ids), body.size[wanted]
    return np.repeat(start[wanted] - np.cumsum(size) + size, size) + np.arange(size.sum())


def starts(body, ids):
    """Return the position of the first unknown of each number among those of `ids`, 0 for other numbers."""
    out = np.zeros(body.size.size, dtype=int)
    out[ids] = np.cumsum(body.size[ids]) - body.size[ids]
    return out
