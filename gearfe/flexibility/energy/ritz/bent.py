"""Cracks whose depth changes along the width: the triangles of the section move with the crack front.

The coordinates move with the front (`geometry.mesh.front`): ``X = xi + (f(z) - 1) shift(xi)``, with f the crack depth relative to
its largest value. In them the front is straight. The section's matrices then depend on the height, but only through f and
its slope f'; with ``g = shift . grad v`` the slope along the width is ``D v = v_z - f' g - w T v``. Hence

    K = sum over k of  A_k(f) x int f'^k p p',   B_k(f) x int f'^k p dp' (and transposed),   C(f) x int dp dp'

The matrices A, B, C are smooth in log f. They are computed at a few depths and interpolated by polynomials.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from ....geometry.mesh.front import follow
from ....geometry.mesh.triangle import jacobians

DEPTHS = 7  # depths of the section matrices; their number increases if the depth falls below a quarter
CHECKED = 6  # polynomial order whose quadrature points are used to check the triangles


def bent(gear, sector, number, crack):
    """Return the shift ``(2, n)`` [mm] of sector vertices that follows the crack of this number, and the crack `Front`.

    Raises
    ------
    RuntimeError
        If the triangles cannot follow the front.
    """

    def folds(points):
        return np.linalg.det(jacobians(points, sector.triangles, bulges, CHECKED).transpose(0, 3, 1, 2)).min() <= 0

    bulges, outline = sector.edge_bulges, np.unique(np.array(list(sector.bulge)))
    line = np.array(sector.faces[number])
    return follow(gear, crack, gear.b, sector.points, sector.triangles, fixed=outline, line=line, folds=folds)


@dataclass(frozen=True, slots=True)
class BentTriangles:
    """Matrices of the triangles that move with a front, as sums of products of a section and a width matrix.

    Attributes
    ----------
    index : ndarray, shape (m,)
        Index of each triangle of the section among the moved ones, -1 for a triangle that does not move.
    even, mixed : ndarray, shape (t, moved, 3 n, 3 n)
        Symmetric terms, and terms to which the transposed is added.
    along, along_mixed : ndarray, shape (t, k, k)
        Their factors: integrals of functions along the width.
    sets : tuple of ndarray
        `sets` of `Axial`.
    """

    index: np.ndarray
    even: np.ndarray
    mixed: np.ndarray
    along: np.ndarray
    along_mixed: np.ndarray
    sets: tuple


def bent_triangles(sector, shift, front, along, section):
    """`BentTriangles` of a sector.

    `shift` and `front` are of `bent`, `along` is an `Axial`; ``section(triangles, points, shift)`` gives A_0, A_1, A_2, B_0, B_1,
    C of the triangles ``(6, m, 3 n, 3 n)``.
    """
    moved = np.flatnonzero((np.abs(shift) > 0).any(axis=0)[sector.triangles].any(axis=0))
    index = np.full(sector.triangles.shape[1], -1)
    index[moved] = np.arange(moved.size)
    depth, slope = front.depth(along.z)
    low, high = math.log(depth.min()), math.log(depth.max())
    count = math.ceil(DEPTHS * max((high - low) / math.log(4), 1)) if high - low > 1e-9 else 1
    nodes = chebyshev.chebpts1(count)
    at = np.clip((2 * np.log(depth) - low - high) / max(high - low, 1e-9), -1, 1)
    carry = chebyshev.chebvander(at, count - 1) @ np.linalg.inv(chebyshev.chebvander(nodes, count - 1))
    parts = [
        section(moved, sector.points + (math.exp((low + high) / 2 + (high - low) / 2 * x) - 1) * shift, shift) for x in nodes
    ]
    parts = np.array(parts).transpose(1, 0, 2, 3, 4)
    value, rise = along.value, along.rise

    def integrals(power, one, two):
        weight = (along.weight * slope**power)[:, None] * carry
        return np.array([one.T @ (column[:, None] * two) for column in weight.T])

    even = [integrals(0, value, value), integrals(1, value, value), integrals(2, value, value), integrals(0, rise, rise)]
    mixed = [integrals(0, value, rise), integrals(1, value, rise)]
    return BentTriangles(
        index=index,
        even=np.concatenate(parts[[0, 1, 2, 5]]),
        mixed=np.concatenate(parts[[3, 4]]),
        along=np.concatenate(even),
        along_mixed=np.concatenate(mixed),
        sets=along.sets,
    )


def moved_products(bent, own, at, size):
    """Return terms ``(t, 3 size, 3 size)`` that moving triangles add, times `moved_factors`, to the matrix of a few triangles.

    The nodes of the triangles `own` ``(k,)`` have the positions `at` ``(k, n)`` among `size`. t is 0 if none of them moves.
    """
    moved = np.flatnonzero(bent.index[own] >= 0)
    if not moved.size:
        return np.zeros((0, 3 * size, 3 * size))
    rows = (3 * at[moved][:, :, None] + np.arange(3)).reshape(moved.size, -1)
    even, mixed = (_added(part[:, bent.index[own[moved]]], rows, 3 * size) for part in (bent.even, bent.mixed))
    return np.concatenate([even, mixed, mixed.mT])


def moved_factors(bent, one, other):
    """Factors ``(t, f, g)`` of `moved_products`: integrals of the sets `one` and `other` of functions along the width."""
    rows, columns = bent.sets[one][:, None], bent.sets[other]
    mixed, turned = bent.along_mixed[:, rows, columns], bent.along_mixed[:, columns[:, None], rows[:, 0]]
    return np.concatenate([bent.along[:, rows, columns], mixed, turned.mT])


def _added(parts, at, size):
    """Add the matrices ``(t, k, n, n)`` of k triangles at their positions ``(k, n)``. The result is ``(t, size, size)``."""
    out = np.zeros((parts.shape[0], size, size))
    for matrices, place in zip(parts.transpose(1, 0, 2, 3), at, strict=True):
        out[(slice(None), *np.ix_(place, place))] += matrices
    return out
