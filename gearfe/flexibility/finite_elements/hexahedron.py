"""The 20-node serendipity hexahedron: shape functions and slopes, for many elements at once."""

import numpy as np
from skfem import ElementHexS2

from ...geometry.kept import keeping
from ...geometry.mesh.solid import HEX

# nodes of C3D20 as (corner or middle of the quad, level), see `gearfe.geometry.mesh.solid.HEX`
ORDER = (
    *((k, 0) for k in range(4)),
    *((k, 2) for k in range(4)),
    *((k + 4, 0) for k in range(4)),
    *((k + 4, 2) for k in range(4)),
    *((k, 1) for k in range(4)),
)
TWENTY = np.array([HEX.index(place) for place in ORDER])


@keeping(4)
def gauss(order):
    """Points ``(3, order**3)`` and weights of a Gauss rule on the unit cube."""
    at, weight = np.polynomial.legendre.leggauss(order)
    points = np.array([v.ravel() for v in np.meshgrid(at, at, at, indexing="ij")])
    return (points + 1) / 2, np.einsum("i,j,k->ijk", weight, weight, weight).ravel() / 8


def shapes(points):
    """Shape functions ``(20, n)`` and slopes ``(20, 3, n)`` at points ``(3, n)`` of the unit cube."""
    element = ElementHexS2()
    values, slopes = zip(*[element.lbasis(np.asarray(points, dtype=float), i) for i in range(20)], strict=True)
    return np.array(values), np.array(slopes)


def face_shapes(x, y):
    """Shape functions ``(8, n)`` of a face at -1 <= x, y <= 1: corners counter-clockwise, middles of 01, 12, 23, 30."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    out = [(1 + a * x) * (1 + b * y) * (a * x + b * y - 1) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    out += [(1 - x * x) * (1 - y) / 2, (1 + x) * (1 - y * y) / 2, (1 - x * x) * (1 + y) / 2, (1 - x) * (1 - y * y) / 2]
    return np.array(out)


def slopes_at(nodes, reference):
    """Slopes of the shape functions in space ``(m, 20, 3, q)`` and Jacobian determinants ``(m, q)``.

    The arguments are `nodes` ``(3, 20, m)`` [mm] and the slopes `reference` ``(20, 3, q)`` on the unit cube, from `shapes`.
    """
    jacobian = np.einsum("dkm,kcq->mqdc", nodes, reference, optimize=True)
    size = np.linalg.det(jacobian)
    if size.min() <= 0:
        raise RuntimeError("a hexahedron folds: refine the mesh, or give more layers to a steep helix")
    return np.einsum("kcq,mqcd->mkdq", reference, np.linalg.inv(jacobian), optimize=True), size
