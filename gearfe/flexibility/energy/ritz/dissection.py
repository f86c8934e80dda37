"""Nested halves of the triangles of a section, in whose order unknowns are eliminated."""

import math

import numpy as np

from ....geometry.mesh.triangle import ENDS

LEAF = 2  # number of triangles that are eliminated together in the first step
CUTS = 8  # number of directions in which sets of triangles are divided
ON_EDGE, INSIDE = 2, 1  # inner nodes of cubic triangles: per edge, per triangle


def dissect(sector):
    """Return nested halves of the triangles: ``(triangles, first half, second half)``. Small sets have empty halves.

    Every set is divided where the least work is expected. Nodes shared by both parts are eliminated with the set: ``g**3 / 3 +
    g**2 r + g r**2`` products if g nodes are eliminated and r stay. The i inner nodes of a part cost at least ``i b**2``, with b
    nodes that the part shares with others. Both sides of the sector stay.
    """
    triangles, vertices = sector.triangles, sector.points.shape[1]
    ends = np.sort(np.array([triangles[list(pair)] for pair in ENDS]), axis=1)
    keys, edges = np.unique((ends[:, 0] * vertices + ends[:, 1]).ravel(), return_inverse=True)
    members = np.concatenate([triangles, vertices + edges.reshape(3, -1)])  # vertices and edges of each triangle
    nodes = np.concatenate([np.ones(vertices), np.full(keys.size, float(ON_EDGE))])
    users = np.bincount(members.ravel())
    corners = np.concatenate([sector.left, sector.right])
    users[corners] += 1
    users[vertices + np.flatnonzero(np.isin(keys // vertices, corners) & np.isin(keys % vertices, corners))] += 1
    turn = np.arange(CUTS) * math.pi / CUTS
    along = np.array([np.cos(turn), np.sin(turn)]).T @ sector.points[:, triangles].mean(axis=1)

    def parted(own):
        if own.size <= LEAF:
            return own, (), ()
        ranked, cut = _cut(members[:, own], nodes, users, along[:, own])
        return own, parted(own[ranked[:cut]]), parted(own[ranked[cut:]])

    return parted(np.arange(triangles.shape[1]))


def _cut(members, nodes, users, along):
    """Find the cut of a set of triangles with the least work. Return their order across the cut, and the cut position."""
    count = along.shape[1]
    order = np.argsort(along, axis=1, kind="stable")
    rank = np.empty_like(order)
    np.put_along_axis(rank, order, np.arange(count)[None, :], axis=1)
    flat = members.ravel()
    by_member = np.argsort(flat, kind="stable")
    starts = np.flatnonzero(np.diff(flat[by_member], prepend=-1))
    ids, uses = flat[by_member][starts], np.diff(starts, append=flat.size)
    rank = np.tile(rank, members.shape[0])[:, by_member]  # (directions, members), those of a vertex or an edge side by side
    first, last = np.minimum.reduceat(rank, starts, axis=1), np.maximum.reduceat(rank, starts, axis=1)
    shared = uses < users[ids]
    inner, outer = nodes[ids] * ~shared, nodes[ids] * shared

    def before(place, weight):
        """Sum `weight` over the nodes whose `place` is among the first triangles, by direction and number of triangles."""
        at = (np.arange(CUTS)[:, None] * count + place).ravel()
        return np.bincount(at, np.tile(weight, CUTS), CUTS * count).reshape(CUTS, count).cumsum(axis=1)[:, :-1]

    begun, done = before(first, inner), before(last, inner)
    gone, stay = begun - done, outer.sum()
    border = before(first, outer) + gone, stay - before(last, outer) + gone
    inside = INSIDE * np.arange(1, count)
    within = done + inside, inner.sum() - begun + inside[::-1]
    work = gone**3 / 3 + gone**2 * stay + gone * stay**2 + within[0] * border[0] ** 2 + within[1] * border[1] ** 2
    k, cut = np.unravel_index(work.argmin(), work.shape)
    return order[k], cut + 1
