"""Stiffness matrix of a body of second-order hexahedra or tetrahedra, assembled by scikit-fem.

The weak form is ``lambda div u div v + 2 mu eps(u) : eps(v)``. Its blocks are combined from six scalar forms, which scikit-fem
assembles about twenty times as fast as the form of the vector field.
"""

from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np
from scipy.sparse import coo_array, csc_array
from skfem import Basis, BilinearForm, ElementHexS2, ElementTetP2, asm
from skfem.mesh import MeshHex1, MeshTet1

CHUNK = 1000  # elements whose shape functions are computed at a time


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


def _form(a, b):
    return BilinearForm(lambda u, v, _: v.grad[a] * u.grad[b])


FORMS = {(a, b): _form(a, b) for b, a in combinations_with_replacement(range(3), 2)}  # integrals of d_a v d_b u with b <= a


def assemble(points, cells, material, free, *, order=None):
    """Lower triangle of the stiffness matrix of the nodes `free`, every node's x, y, z together [N/mm].

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
    kind, usual = KINDS[len(cells)]
    mesh, gradients = kind(points, cells), {}
    at = np.empty(points.shape[1], dtype=np.int64)
    parts = np.array_split(np.arange(cells.shape[1]), -(-cells.shape[1] // CHUNK))
    bases = [Basis(mesh, mesh.elem(), intorder=order or usual, elements=part) for part in parts]
    if min(basis.dx.min() for basis in bases) <= 0:
        raise RuntimeError("an element folds: refine the mesh, or give more layers to a steep helix")
    at[cells] = bases[0].dofs.element_dofs
    for axes, form in FORMS.items():
        gradients[axes] = asm(form, bases)[at[free]][:, at[free]]
    return _lower(gradients, *material.lame("plane strain"))


def _lower(gradients, lam, mu):
    """Lower triangle of the matrix of all components, from the matrices of `FORMS` of the scalar field."""
    trace = mu * sum(gradients[a, a] for a in range(3))
    found = []
    for (a, b), matrix in gradients.items():
        block = coo_array((lam + mu) * matrix + trace if a == b else lam * matrix + mu * matrix.T)
        row, column = (3 * nodes.astype(np.int64) for nodes in block.coords)
        found += [(block.data, row + a, column + b)] + ([(block.data, column + b, row + a)] if a != b else [])
    found = [[part[row >= column] for part in (data, row, column)] for data, row, column in found]
    data, row, column = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return csc_array(coo_array((data, (row, column)), shape=(3 * trace.shape[0],) * 2))
