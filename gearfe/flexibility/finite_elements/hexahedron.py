"""The 20-node serendipity hexahedron: shape functions and stiffness of many at once, in numpy."""

import numpy as np
from scipy.sparse import bsr_matrix, csc_matrix
from skfem import ElementHexS2

from ...geometry.kept import keeping
from ...geometry.mesh.solid import HEX

CHUNK = 1000  # elements computed at a time
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

    Of `nodes` ``(3, 20, m)`` [mm] and the slopes `reference` ``(20, 3, q)`` on the unit cube, from `shapes`.
    """
    jacobian = np.einsum("dkm,kcq->mqdc", nodes, reference, optimize=True)
    size = np.linalg.det(jacobian)
    if size.min() <= 0:
        raise RuntimeError("a hexahedron folds: refine the mesh, or give more layers to a steep helix")
    return np.einsum("kcq,mqcd->mkdq", reference, np.linalg.inv(jacobian), optimize=True), size


def element_stiffness(nodes, lam, mu):
    """Stiffness matrices ``(m, 20, 3, 20, 3)`` [N/mm]: ``lam div u div v + 2 mu eps(u) : eps(v)``, 3 x 3 x 3 Gauss points.

    Of `nodes` ``(3, 20, m)`` [mm], with Lame's constants [MPa].
    """
    points, weight = gauss(3)
    slopes, size = slopes_at(nodes, shapes(points)[1])
    return stiffness_of(slopes, size * weight, lam, mu)


def stiffness_of(slopes, volume, lam, mu):
    """Stiffness matrices ``(m, k, 3, k, 3)`` [N/mm] of elements with k nodes.

    `slopes` ``(m, k, 3, q)`` are those of the shape functions at Gauss points [1/mm], `volume` ``(m, q)`` is what each point
    stands for [mm**3].
    """
    count, nodes = slopes.shape[:2]
    rows = slopes.reshape(count, 3 * nodes, -1)
    product = ((rows * volume[:, None, :]) @ rows.transpose(0, 2, 1)).reshape(count, nodes, 3, nodes, 3)
    local = lam * product + mu * product.transpose(0, 1, 4, 3, 2)
    trace = mu * np.trace(product, axis1=2, axis2=4)
    for d in range(3):
        local[:, :, d, :, d] += trace
    return local


def assemble(points, cells, material, free, element=element_stiffness):
    """Lower triangle of the stiffness matrix of the nodes `free`, every node's x, y, z together [N/mm].

    Parameters
    ----------
    points : ndarray, shape (3, n)
        [mm]
    cells : ndarray, shape (20, m)
    material : Material
    free : ndarray
        Nodes that can move, ascending.
    element : callable
        From nodes ``(3, k, m)`` and Lame constants to stiffness matrices, for elements of k nodes.

    Returns
    -------
    scipy.sparse.csc_matrix, shape (3 free.size, 3 free.size)
    """
    lam, mu = material.lame("plane strain")
    number = np.full(points.shape[1], -1, dtype=np.int64)
    number[free] = np.arange(free.size)
    keys, blocks = [], []
    for start in range(0, cells.shape[1], CHUNK):
        part = cells[:, start : start + CHUNK]
        local = element(points[:, part], lam, mu).transpose(0, 1, 3, 2, 4)
        place = number[part].T
        row, column = np.broadcast_arrays(place[:, :, None], place[:, None, :])
        lower = (row >= column) & (column >= 0)
        key, block = _summed(row[lower] * free.size + column[lower], local[lower].reshape(-1, 9))
        keys.append(key)
        blocks.append(block)
    key, block = _summed(np.concatenate(keys), np.concatenate(blocks))
    row, column = np.divmod(key, free.size)
    start = np.searchsorted(row, np.arange(free.size + 1))
    size = 3 * free.size
    whole = csc_matrix(bsr_matrix((block.reshape(-1, 3, 3), column, start), shape=(size, size)))
    above = whole.indices < np.repeat(np.arange(size), np.diff(whole.indptr))  # of the blocks on the diagonal
    whole.data[above] = 0.0
    whole.eliminate_zeros()
    return whole


def _summed(key, block):
    """Blocks ``(n, 9)`` of equal key added up, in the order of the keys."""
    order = np.argsort(key, kind="stable")
    key = key[order]
    first = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
    return key[first], np.add.reduceat(block[order], first, axis=0)
