"""Plane elasticity on a second-order triangle mesh: assemble, factor once, solve many, recover stress."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csc_matrix, spmatrix
from scipy.sparse.linalg import splu
from skfem import Basis, ElementTriP2, MeshTri2

from ..material import Material

GAUSS_3 = (np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)]), np.array([5.0, 8.0, 5.0]) / 9)


class Body:
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
        self.mesh, self.material, self.state = mesh, material, state
        self.basis = Basis(mesh, ElementTriP2(), intorder=order)
        self.nodes = _node_of_dof(self.basis)
        fixed = np.concatenate([mesh.facets[:, mesh.boundaries[held]].ravel(), mesh.nvertices + mesh.boundaries[held]])
        free = np.ones(2 * mesh.doflocs.shape[1], dtype=bool)
        free[2 * fixed] = free[2 * fixed + 1] = False
        self.free = np.flatnonzero(free)
        self._factor: Any = None

    def stiffness(self) -> csc_matrix:
        """Stiffness matrix (sparse, 2 nodes square) [N/mm per mm of width].

        The weak form is ``lambda div u div v + 2 mu eps(u) : eps(v)``; the triangle matrices are one batched product of
        the shape gradients with themselves.
        """
        lam, mu = self.material.lame(self.state)
        grads = np.array([self.basis.basis[i][0].grad for i in range(6)])  # shape function, direction, triangle, point
        n_tri, n_pt = grads.shape[2:]
        rows = np.ascontiguousarray(grads.transpose(2, 0, 1, 3)).reshape(n_tri, 12, n_pt)
        product = (rows * self.basis.dx[:, None, :]) @ rows.transpose(0, 2, 1)
        product = product.reshape(n_tri, 6, 2, 6, 2)  # int d_a N_i d_b N_j
        trace = product[:, :, 0, :, 0] + product[:, :, 1, :, 1]
        local = lam * product + mu * product.transpose(0, 1, 4, 3, 2)
        local[:, :, 0, :, 0] += mu * trace
        local[:, :, 1, :, 1] += mu * trace
        dofs = (2 * self.nodes.T[:, :, None] + np.arange(2)).reshape(n_tri, 12)
        size = 2 * self.mesh.doflocs.shape[1]
        i = np.repeat(dofs, 12, axis=1).ravel()
        j = np.tile(dofs, (1, 12)).ravel()
        return coo_matrix((local.reshape(n_tri, 144).ravel(), (i, j)), shape=(size, size)).tocsc()

    def solve(self, load: NDArray[np.float64] | spmatrix) -> NDArray[np.float64]:
        """Displacements for the columns of `load` (dense or sparse, ``(2 nodes, n)``) [N/mm]."""
        if self._factor is None:
            free = self.stiffness()[self.free][:, self.free]
            self._factor = splu(
                csc_matrix(free), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
        dense = load.toarray() if hasattr(load, "toarray") else np.asarray(load)
        out = np.zeros(dense.shape)
        out[self.free] = self._factor.solve(np.ascontiguousarray(dense[self.free]))
        if not np.isfinite(out).all():
            raise RuntimeError("the FE solve gave no finite displacement: the body is not held, or nu is too close to 0.5")
        return out

    def stress(self, displacement: NDArray[np.float64], inset: float = 0.0) -> NDArray[np.float64]:
        """Stress at the nodes ``(3, nodes)`` [MPa]: xx, yy, xy, averaged over the triangles that share a node.

        It is taken by the part `inset` of the way to the middle of each triangle: at a crack's tip it is infinite.
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


def _node_of_dof(basis):
    """Node number of each local shape function ``(6, triangles)``: vertices, then edges."""
    mesh = basis.mesh
    return np.vstack([mesh.t[:3], mesh.nvertices + mesh.t2f])


def edge_nodes(mesh, vertices):
    """Nodes ``(3, n - 1)`` of the edges along a chain of `vertices`: start, end, middle."""
    lookup = {(a, b): i for i, (a, b) in enumerate(mesh.facets.T.tolist())}
    middle = [lookup[min(a, b), max(a, b)] for a, b in zip(vertices[:-1].tolist(), vertices[1:].tolist(), strict=True)]
    return np.array([vertices[:-1], vertices[1:], mesh.nvertices + np.array(middle)])


def edge_shapes(t):
    """P2 shape functions and slopes on an edge, ``(3, points)`` each, at ``-1 <= t <= 1``: start, end, middle."""
    t = np.asarray(t, dtype=float)
    return np.array([t * (t - 1) / 2, t * (t + 1) / 2, 1 - t**2]), np.array([t - 0.5, t + 0.5, -2 * t])
