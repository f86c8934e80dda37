"""Stiffness matrix of a body of second-order hexahedra or tetrahedra, assembled by scikit-fem.

The weak form is ``lambda div u div v + 2 mu eps(u) : eps(v)``. The gradients of the shape functions are those of
scikit-fem. Their products are summed element by element, so that no more than a few elements are held at a time.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import bsr_array, csc_array
from skfem import Basis, ElementHexS2, ElementTetP2
from skfem.mesh import MeshHex1, MeshTet1

CHUNK = 500  # elements whose shape functions are computed at a time


@dataclass(repr=False)
class _Hexahedra(MeshHex1):
    elem: type = ElementHexS2
    sort_t: bool = False


@dataclass(repr=False)
class _Tetrahedra(MeshTet1):
    elem: type = ElementTetP2
    sort_t: bool = False
    affine: bool = False


KINDS = {20: (_Hexahedra, 4), 10: (_Tetrahedra, 2)}  # mesh, and the polynomial degree of its exact quadrature


def assemble(points, cells, material, free, *, order=None):
    """Return the lower triangle of the stiffness matrix of the nodes `free`, with x, y, z of each node together [N/mm].

    Parameters
    ----------
    points : ndarray, shape (3, n)
        [mm]
    cells : ndarray, shape (20, m) or (10, m)
        Nodes of hexahedra in the order of `gearfe.geometry.mesh.solid.HEX`, or of tetrahedra: corners, then middles of the edges
        01, 12, 02, 03, 13, 23.
    material : Material
    free : ndarray
        Nodes that can move, ascending.
    order : int, optional
        Polynomial degree that the quadrature is exact for; default: 3 x 3 x 3 points in a hexahedron, 4 in a tetrahedron.

    Returns
    -------
    scipy.sparse.csc_array, shape (3 free.size, 3 free.size)

    Raises
    ------
    RuntimeError
        If an element folds.
    """
    place = np.full(points.shape[1], -1)
    place[free] = np.arange(free.size)
    low, high = np.triu_indices(len(cells))
    pairs = np.sort([place[cells[low]], place[cells[high]]], axis=0)  # nodes of each block: its column, its row
    used = pairs[0] >= 0
    keys, at = np.unique(pairs[0][used] * free.size + pairs[1][used], return_inverse=True)
    block = np.full(used.shape, keys.size)
    block[used] = at
    turned = place[cells[low]] < place[cells[high]]
    blocks = np.zeros((keys.size + 1, 9))  # The last one collects blocks of held nodes.
    lam, mu = material.lame("plane strain")
    for start in range(0, cells.shape[1], CHUNK):
        part = slice(start, start + CHUNK)
        of = _blocks(points, cells[:, part], lam, mu, order)[:, low, high]  # element, pair, component by component
        of = np.where(turned.T[part, :, None, None], of.swapaxes(2, 3), of)
        np.add.at(blocks.reshape(-1), (9 * block.T[part].ravel()[:, None] + np.arange(9)).ravel(), of.ravel())
    return _lower(keys, blocks[:-1].reshape(-1, 3, 3), free.size)


def _blocks(points, cells, lam, mu, order):
    """Return the stiffness matrices of elements, node by node ``(m, k, k, 3, 3)``."""
    kind, usual = KINDS[len(cells)]
    nodes, local = np.unique(cells, return_inverse=True)
    mesh = kind(points[:, nodes], local.reshape(cells.shape))
    basis = Basis(mesh, mesh.elem(), intorder=order or usual)
    if basis.dx.min() <= 0:
        raise RuntimeError("an element folds: refine the mesh, or give more layers to a steep helix")
    slopes = np.array([one[0].grad for one in basis.basis]).transpose(2, 0, 1, 3)  # element, node, axis, point
    m, k, _, count = slopes.shape
    slopes = slopes.reshape(m, 3 * k, count)
    whole = ((slopes * basis.dx[:, None]) @ slopes.swapaxes(1, 2)).reshape(m, k, 3, k, 3).transpose(0, 1, 3, 2, 4)
    out = lam * whole + mu * whole.swapaxes(3, 4)
    out[..., range(3), range(3)] += mu * np.trace(whole, axis1=3, axis2=4)[..., None]
    return out


def _lower(keys, blocks, count):
    """Return the lower triangle from blocks ``(b, 3, 3)`` of node pairs, with ascending keys ``column * count + row``."""
    starts = np.searchsorted(keys, count * np.arange(count + 1))
    # The rows of the transpose are the columns of the matrix.
    upper = bsr_array((blocks.swapaxes(1, 2), keys % count, starts), shape=(3 * count,) * 2).tocsr()
    inner = np.arange(3 * count) % 3  # number of entries of a column above the diagonal, all in the block on it
    kept = upper.indices >= np.repeat(np.arange(3 * count, dtype=upper.indices.dtype), np.diff(upper.indptr))
    starts = upper.indptr - np.append(0, np.cumsum(inner, dtype=upper.indptr.dtype))
    return csc_array((upper.data[kept], upper.indices[kept], starts), shape=upper.shape)
