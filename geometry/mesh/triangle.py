"""Curved triangle of any polynomial order: nodes, quadrature, and the map with curved edges."""

from types import SimpleNamespace

import numpy as np
from numpy.polynomial import legendre

from ..kept import keeping

BULGE = 8  # points at which the deviation of an edge from its chord is stored
GAUSS = legendre.leggauss(BULGE)  # Gauss points and weights
ENDS = ((0, 1), (1, 2), (2, 0))  # local vertices of the three edges


@keeping(8)
def lobatto(order):
    """Return the `order` + 1 Gauss-Lobatto points on [-1, 1]."""
    # The roots are real, but numpy 2.5 returns a complex type.
    inner = legendre.legroots(legendre.legder([0] * order + [1])).real
    return np.concatenate([[-1.0], inner, [1.0]])


@keeping(64)
def lagrange(order, points):
    """Return values ``(order + 1, n)`` of the Lagrange polynomials of the Gauss-Lobatto points, at points in [-1, 1]."""
    nodes = legendre.legvander(lobatto(order), order)
    return np.linalg.solve(nodes.T, legendre.legvander(np.array(points), order).T)


@keeping(8)
def table(order):
    """Return the data of a triangle that depend on the polynomial order only.

    Nodes are numbered: three vertices, the inner nodes of the edges `ENDS` from first to second vertex, the inside. The result
    is a namespace: number of nodes `count`, their barycentric coordinates `nodes` (3, count), number of inner nodes `inside`;
    quadrature `weight` (q,); at its points `value` (count, q), `slope` (2, count, q) by the reference coordinates, the linear
    map's `corner` (3, q), and the blended bulges `bulge` (3, q, BULGE) and their derivatives `bulge_slope` (2, 3, q, BULGE) by
    the values at `GAUSS`.
    """
    line = (lobatto(order) + 1) / 2
    ends = np.eye(3)
    edges = [np.outer(ends[a], 1 - line[1:-1]) + np.outer(ends[b], line[1:-1]) for a, b in ENDS]
    lattice = [(i, j, order - i - j) for i in range(1, order) for j in range(1, order - i)]
    inside = np.array([line[list(corner)] / line[list(corner)].sum() for corner in lattice]).reshape(-1, 3).T
    nodes = np.hstack([ends, *edges, inside])
    gauss, gauss_weight = legendre.leggauss(order + 2)
    gauss, gauss_weight = (gauss + 1) / 2, gauss_weight / 2
    x = np.outer(1 - gauss, gauss).ravel()
    y = np.repeat(gauss, gauss.size)
    weight = np.outer((1 - gauss) * gauss_weight, gauss_weight).ravel()
    change = np.linalg.inv(_modes(nodes[1], nodes[2], order)[0])
    value, *slope = (change.T @ part.T for part in _modes(x, y, order))
    corner = np.array([1 - x - y, x, y])
    bulge_points = GAUSS[0]
    to_modes = np.linalg.inv(legendre.legvander(bulge_points, BULGE - 1))
    bulge, bulge_slope = [], []
    gradient = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])  # gradients of the barycentric coordinates
    for a, b in ENDS:
        s = corner[b] - corner[a]
        height = legendre.legvander(s, BULGE - 1) @ to_modes
        derivative = legendre.legvander(s, BULGE - 2) @ legendre.legder(np.eye(BULGE)) @ to_modes
        product = 4 * corner[a] * corner[b]
        bulge.append(product[:, None] * height)
        along = [
            4 * (gradient[a, d] * corner[b] + gradient[b, d] * corner[a])[:, None] * height
            + (product * (gradient[b, d] - gradient[a, d]))[:, None] * derivative
            for d in range(2)
        ]
        bulge_slope.append(along)
    return SimpleNamespace(
        count=nodes.shape[1],
        nodes=nodes,
        inside=inside.shape[1],
        weight=weight,
        value=value,
        slope=np.array(slope),
        corner=corner,
        corner_slope=gradient,
        bulge=np.array(bulge),
        bulge_slope=np.array(bulge_slope).transpose(1, 0, 2, 3),
    )


def _modes(x, y, order):
    """Return products of Legendre polynomials up to total degree `order` at points ``(n,)``, and derivatives by x and y."""
    px, py = legendre.legvander(2 * x - 1, order), legendre.legvander(2 * y - 1, order)
    lower = 2 * legendre.legder(np.eye(order + 1)) if order else np.zeros((1, 1))
    dx, dy = (legendre.legvander(2 * v - 1, order - 1) @ lower for v in (x, y))
    pairs = [(i, j) for i in range(order + 1) for j in range(order + 1 - i)]
    i, j = np.array(pairs).T
    return px[:, i] * py[:, j], dx[:, i] * py[:, j], px[:, i] * dy[:, j]


def jacobians(points, triangles, bulges, order):
    """Return derivatives of the curved maps ``(m, 2, 2, q)`` at the quadrature points of `order`.

    `points` are ``(2, n)``, `triangles` ``(3, m)``. `gearfe.geometry.mesh.sector.Sector` describes `bulges` ``(3, 2, BULGE, m)``.
    """
    basis, count = table(order), triangles.shape[1]
    linear = np.einsum("dce,ck->edk", points[:, triangles], basis.corner_slope)[:, :, :, None]
    slope = basis.bulge_slope.transpose(0, 2, 1, 3).reshape(-1, 3 * BULGE)  # columns: coordinate, point
    curved = slope @ bulges.transpose(0, 2, 1, 3).reshape(3 * BULGE, -1)
    return linear + curved.reshape(2, -1, 2, count).transpose(3, 2, 0, 1)
