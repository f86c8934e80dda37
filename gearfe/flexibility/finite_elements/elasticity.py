"""Plane elasticity on a second-order triangle mesh: assemble, factor once, solve many, recover stress."""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bmat, coo_array, coo_matrix, csc_matrix, spmatrix
from skfem import Basis, BilinearForm, ElementTriP2, MeshTri2, asm

from ...core.material import Material
from ...geometry.aliases import Floats
from .solver import factor

GAUSS_3 = (np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)]), np.array([5.0, 8.0, 5.0]) / 9)
LEAF = 24  # least number of triangles that `gearfe.flexibility.condense` joins in a first step; at most twice as many


@BilinearForm
def _dx_dx(u, v, _):
    return v.grad[0] * u.grad[0]


@BilinearForm
def _dy_dy(u, v, _):
    return v.grad[1] * u.grad[1]


@BilinearForm
def _dx_dy(u, v, _):
    return v.grad[0] * u.grad[1]


class HeldSection:
    """A section held at its boundary ``held``, factored once.

    Displacements are arrays ``(2 * nodes, n)`` [mm per N/mm of width], interleaved x, y by node of the P2 mesh; nodes
    are numbered as in ``mesh.doflocs``.

    Parameters
    ----------
    mesh : skfem.MeshTri2
    material : Material
    state : {"plane strain", "plane stress"}
    held : str
        Name of the clamped boundary.
    order : int
        Polynomial degree the quadrature is exact for; 2 is enough for straight triangles.
    """

    def __init__(
        self, mesh: MeshTri2, material: Material, *, state: str = "plane strain", held: str = "held", order: int = 4
    ) -> None:
        if held not in (mesh.boundaries or {}):
            raise ValueError(f"no boundary {held!r}; this mesh has {', '.join(mesh.boundaries or {})}")
        self.mesh, self.material, self.state, self.order = mesh, material, state, order
        self.nodes = np.vstack([mesh.t[:3], mesh.nvertices + mesh.t2f])  # (6, triangles): vertices, then edges 01, 12, 02
        fixed = np.concatenate([mesh.facets[:, mesh.boundaries[held]].ravel(), mesh.nvertices + mesh.boundaries[held]])
        free = np.ones(2 * mesh.doflocs.shape[1], dtype=bool)
        free[2 * fixed] = free[2 * fixed + 1] = False
        self.free, self.held = np.flatnonzero(free), np.flatnonzero(~free)

    @cached_property
    def _factor(self) -> Any:
        return factor(self.stiffness()[self.free][:, self.free], node=2)

    @cached_property
    def basis(self) -> Basis:
        """Shape functions at the quadrature points."""
        return Basis(self.mesh, ElementTriP2(), intorder=self.order)

    def stiffness(self) -> csc_matrix:
        """Stiffness matrix (sparse, 2 nodes square) [N/mm per mm of width].

        The weak form is ``lambda div u div v + 2 mu eps(u) : eps(v)``. Its blocks are combined from three scalar forms, which
        scikit-fem assembles several times as fast as the form of the vector field.
        """
        lam, mu = self.material.lame(self.state)
        xx, yy, xy = (asm(form, self.basis) for form in (_dx_dx, _dy_dy, _dx_dy))
        shear = mu * xy
        blocks = [[(lam + 2 * mu) * xx + mu * yy, lam * xy + shear.T], [None, (lam + 2 * mu) * yy + mu * xx]]
        blocks[1][0] = blocks[0][1].T
        by_component = coo_array(bmat(blocks))
        nodes = self.mesh.doflocs.shape[1]
        row, column = (2 * (place % nodes) + place // nodes for place in by_component.coords)
        return coo_matrix((by_component.data, (row, column)), shape=by_component.shape).tocsc()

    def local(self) -> tuple[Floats, NDArray[np.int64]]:
        """Stiffness matrices of the triangles ``(m, 12, 12)`` [N/mm per mm of width] and their unknowns ``(m, 12)``."""
        lam, mu = self.material.lame(self.state)
        xx, yy, xy = (form.elemental(self.basis).tolocal().mT for form in (_dx_dx, _dy_dy, _dx_dy))
        yx = xy.mT
        rows = [[(lam + 2 * mu) * xx + mu * yy, lam * xy + mu * yx], [lam * yx + mu * xy, (lam + 2 * mu) * yy + mu * xx]]
        local = np.array(rows).transpose(2, 3, 0, 4, 1).reshape(-1, 12, 12)
        return local, (2 * self.nodes.T[:, :, None] + np.arange(2)).reshape(-1, 12)

    def between(self, load: spmatrix) -> Floats:
        """Displacements ``(n, n)`` between the columns of `load` (sparse, ``(2 nodes, n)``): ``load' K^-1 load``.

        Only the forward substitution is computed: the product of ``L^-1 load`` with itself, where ``K = L L'``.
        """
        return self._factor.gram(load.tocsr()[self.free])

    def solve(self, load: Floats | spmatrix) -> Floats:
        """Displacements for the columns of `load` (dense or sparse, ``(2 nodes, n)``) [N/mm]."""
        dense = load.toarray() if hasattr(load, "toarray") else np.asarray(load)
        out = np.zeros(dense.shape)
        out[self.free] = self._factor(dense[self.free])
        if not np.isfinite(out).all():
            raise RuntimeError("the FE solve gave no finite displacement: the body is not held, or nu is too close to 0.5")
        return out

    def stress(self, displacement: Floats, inset: float = 0.0) -> Floats:
        """Stress at the nodes ``(3, nodes)`` [MPa]: xx, yy, xy, averaged over the triangles that share a node.

        The stress is evaluated at a point `inset` of the way to the middle of each triangle, because it is infinite at a crack
        tip.
        """
        lam, mu = self.material.lame(self.state)
        corners = np.array([[0, 1, 0, 0.5, 0.5, 0], [0, 0, 1, 0, 0.5, 0.5]])
        corners = (1 - inset) * corners + inset / 3
        sampled = Basis(self.mesh, ElementTriP2(), quadrature=(corners, np.full(6, 1 / 12)))
        u = displacement.reshape(-1, 2)[self.nodes]  # local node, triangle, component
        grads = np.array([sampled.basis[i][0].grad for i in range(6)])
        strain = np.einsum("ntc,ndtp->cdtp", u, grads)
        mean = lam * (strain[0, 0] + strain[1, 1])
        parts = np.array([mean + 2 * mu * strain[0, 0], mean + 2 * mu * strain[1, 1], mu * (strain[0, 1] + strain[1, 0])])
        count = np.bincount(self.nodes.ravel(), minlength=self.mesh.doflocs.shape[1])
        # local order of the sample points is vertices, then edges 01, 12, 02: the same as that of the nodes
        flat = self.nodes.T.ravel()
        return np.array([np.bincount(flat, part.ravel(), minlength=count.size) for part in parts]) / count


def edge_nodes(mesh, vertices):
    """Nodes ``(3, n - 1)`` of the edges along a chain of `vertices`: start, end, middle."""
    low, high = np.sort([vertices[:-1], vertices[1:]], axis=0)
    keys = mesh.facets[0].astype(np.int64) * mesh.nvertices + mesh.facets[1]
    order = np.argsort(keys)
    middle = order[np.searchsorted(keys, low.astype(np.int64) * mesh.nvertices + high, sorter=order)]
    return np.array([vertices[:-1], vertices[1:], mesh.nvertices + middle])


def edge_shapes(t):
    """P2 shape functions and slopes on an edge, ``(3, points)`` each, at ``-1 <= t <= 1``: start, end, middle."""
    t = np.asarray(t, dtype=float)
    return np.array([t * (t - 1) / 2, t * (t + 1) / 2, 1 - t**2]), np.array([t - 0.5, t + 0.5, -2 * t])
