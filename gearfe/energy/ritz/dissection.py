"""Triangles of a section divided into nested halves, in which their unknowns are eliminated."""

import math

import numpy as np

LEAF = 2  # triangles eliminated together first
CUTS, PARTS = 8, (0.4, 0.45, 0.5, 0.55, 0.6)  # directions in which sets of triangles are divided, and where


def dissect(sector):
    """Nested halves of the triangles: ``(triangles, first half, second half)``, the halves empty where few are left."""
    centre = sector.points[:, sector.triangles].mean(axis=1)

    def parted(own):
        if own.size <= LEAF:
            return own, (), ()
        first, second = _halves(sector.triangles, centre, own)
        return own, parted(first), parted(second)

    return parted(np.arange(sector.triangles.shape[1]))


def _halves(triangles, centre, own):
    """Two parts of a set of triangles, on both sides of the straight cut through the fewest vertices."""
    turn = np.arange(CUTS) * math.pi / CUTS
    order = np.argsort(np.array([np.cos(turn), np.sin(turn)]).T @ centre[:, own], axis=1, kind="stable")
    rank = np.empty_like(order)
    np.put_along_axis(rank, order, np.arange(own.size)[None, :], axis=1)
    corners = triangles[:, own].ravel()
    by_vertex = np.argsort(corners, kind="stable")
    starts = np.flatnonzero(np.diff(corners[by_vertex], prepend=-1))
    rank = np.tile(rank, 3)[:, by_vertex]  # (directions, corners), those of a vertex side by side
    first, last = np.minimum.reduceat(rank, starts, axis=1), np.maximum.reduceat(rank, starts, axis=1)
    cuts = np.unique([max(1, round(part * own.size)) for part in PARTS])[:, None]
    shared = ((first[:, None] < cuts) & (last[:, None] >= cuts)).sum(axis=2)
    k, cut = np.unravel_index(shared.argmin(), shared.shape)
    own = own[order[k]]
    return own[: cuts[cut, 0]], own[cuts[cut, 0] :]
