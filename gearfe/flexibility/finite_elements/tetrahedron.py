"""Straight-sided second-order tet: nodes in the middle of edges, and stress at the nodes."""

import math

import numpy as np

from ...core.material import Material

INNER, OUTER = (5 + 3 * math.sqrt(5)) / 20, (5 - math.sqrt(5)) / 20  # Gauss points, exact for quadratic polynomials
EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))  # edges of a tet with a node in their middle, in VTK's order


def second_order(points, cells):
    """Return nodes in the middle of the straight edges of tets.

    Returns
    -------
    nodes : ndarray, shape (3, n)
    cells : ndarray, shape (10, m)
    number : callable
        Middle nodes between vertices a and b (arrays).
    """
    count = points.shape[1]

    def key(a, b):
        return np.minimum(a, b) * count + np.maximum(a, b)

    keys = np.array([key(cells[a], cells[b]) for a, b in EDGES])
    edges, place = np.unique(keys, return_inverse=True)
    first, second = np.divmod(edges, count)
    nodes = np.hstack([points, (points[:, first] + points[:, second]) / 2])
    return nodes, np.vstack([cells, count + place.reshape(keys.shape)]), lambda a, b: count + np.searchsorted(edges, key(a, b))


def nodes_of(faces, number):
    """Return the nodes on faces ``(3, k)``. `number` of `second_order` gives those in the middle of edges."""
    a, b, c = faces
    return np.unique(np.concatenate([a, b, c, number(a, b), number(b, c), number(a, c)]))


def tet_slopes(nodes, corner):
    """Slopes of the shape functions ``(m, 10, 3, q)`` at barycentric places ``(4, q)``, and volumes ``(m,)``."""
    sides = (nodes[:, 1:4] - nodes[:, :1]).transpose(2, 1, 0)  # (m, vertex, xyz)
    inverse = np.linalg.inv(sides)
    slope = np.concatenate([-inverse.sum(axis=2, keepdims=True), inverse], axis=2).mT  # (m, 4, xyz)
    ends = slope[:, :, :, None] * (4 * corner - 1)[None, :, None, :]
    a, b = np.array(EDGES).T
    middle = 4 * (slope[:, a, :, None] * corner[b][None, :, None] + slope[:, b, :, None] * corner[a][None, :, None])
    return np.concatenate([ends, middle], axis=1), np.linalg.det(sides) / 6


def nodal_stress(nodes, cells, moved, material: Material):
    """Nodal stress ``(6, n)`` [MPa] (xx, yy, zz, xy, yz, xz) from displacements ``(3, n)``, or nan at nodes without a cell."""
    lam, mu = material.lame("plane strain")
    corner = np.vstack([np.eye(4), [[0.5 * (k in edge) for k in range(4)] for edge in EDGES]]).T
    total, weight = np.zeros((nodes.shape[1], 6)), np.zeros(nodes.shape[1])
    for start in range(0, cells.shape[1], 20_000):
        part = cells[:, start : start + 20_000]
        slopes, size = tet_slopes(nodes[:, part], corner)
        slope = np.einsum("ikm,mkjq->mqij", moved[:, part], slopes, optimize=True)
        strain = (slope + slope.transpose(0, 1, 3, 2)) / 2
        stress = 2 * mu * strain + lam * np.trace(strain, axis1=2, axis2=3)[:, :, None, None] * np.eye(3)
        six = stress[:, :, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]] * size[:, None, None]
        for d in range(6):
            total[:, d] += np.bincount(part.T.ravel(), six[:, :, d].ravel(), minlength=total.shape[0])
        weight += np.bincount(part.T.ravel(), np.repeat(size, 10), minlength=weight.size)
    with np.errstate(invalid="ignore"):
        return (total / weight[:, None]).T
