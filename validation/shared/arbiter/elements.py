"""Curved second-order triangles in plane strain: stiffness, and deformation by many loads."""

import math

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

BATCH = 128  # right-hand sides per solve
# Seven-point quadrature rule of degree 5 on the reference triangle: points and weights.
_A, _B = (6 - math.sqrt(15)) / 21, (6 + math.sqrt(15)) / 21
PLACES = np.array([[1 / 3, 1 / 3], [_A, _A], [1 - 2 * _A, _A], [_A, 1 - 2 * _A], [_B, _B], [1 - 2 * _B, _B], [_B, 1 - 2 * _B]])
WEIGHTS = np.array([0.1125] + [(155 - math.sqrt(15)) / 2400] * 3 + [(155 + math.sqrt(15)) / 2400] * 3)


def gradients(u, v):
    """Gradients ``(n, 6, 2)`` of the quadratic shape functions: corners, then the middles of edges 01, 12, 02."""
    w = 1 - u - v
    du = [1 - 4 * w, 4 * u - 1, 0 * u, 4 * (w - u), 4 * v, -4 * v]
    dv = [1 - 4 * w, 0 * u, 4 * v - 1, -4 * u, 4 * u, 4 * (w - v)]
    return np.stack([np.stack(du, -1), np.stack(dv, -1)], -1)


def stiffness(nodes, triangles, young, nu):
    """Plane-strain stiffness matrix (CSC) of 6-node triangles. Degrees of freedom are x and y of node after node."""
    lame, shear = young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu))
    local = gradients(PLACES[:, 0], PLACES[:, 1])
    jacobian = np.einsum("qia,bie->eqab", local, nodes[:, triangles], optimize=True)
    area = jacobian[..., 0, 0] * jacobian[..., 1, 1] - jacobian[..., 0, 1] * jacobian[..., 1, 0]
    if area.min() <= 0:
        raise RuntimeError("a triangle of the arbiter's mesh is folded: refine it")
    inverse = np.empty_like(jacobian)
    inverse[..., 0, 0], inverse[..., 1, 1] = jacobian[..., 1, 1] / area, jacobian[..., 0, 0] / area
    inverse[..., 0, 1], inverse[..., 1, 0] = -jacobian[..., 0, 1] / area, -jacobian[..., 1, 0] / area
    slope = np.einsum("eqba,qia->eqib", inverse, local, optimize=True).reshape(*area.shape, 12)
    weighted = slope * (area * WEIGHTS)[..., None]
    products = np.matmul(slope.transpose(0, 2, 1), weighted).reshape(-1, 6, 2, 6, 2)
    trace = np.einsum("eiaja->eij", products)
    cells = lame * products + shear * products.transpose(0, 1, 4, 3, 2)
    for axis in (0, 1):
        cells[:, :, axis, :, axis] += shear * trace
    dofs = (2 * triangles.T[:, :, None] + np.arange(2)).reshape(-1, 12)
    rows, columns = np.repeat(dofs, 12, axis=1), np.tile(dofs, (1, 12))
    size = 2 * nodes.shape[1]
    return coo_matrix((cells.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsc()


def solver(matrix, held):
    """Return a function that solves ``matrix u = load`` with fixed nodes `held`, for many loads ``(dofs, n)``."""
    free = np.ones(matrix.shape[0], dtype=bool)
    free[2 * held], free[2 * held + 1] = False, False
    free = np.flatnonzero(free)
    factor = splu(
        matrix[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )

    def solve(loads):
        out = np.zeros(loads.shape)
        for first in range(0, loads.shape[1], BATCH):
            out[free, first : first + BATCH] = factor.solve(np.ascontiguousarray(loads[free, first : first + BATCH]))
        return out

    return solve
