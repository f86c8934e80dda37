"""Plane elasticity on a second-order triangle mesh: assemble, factor once, solve many, recover stress."""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, coo_matrix, csc_matrix, spmatrix
from scipy.sparse.linalg import splu
from skfem import Basis, ElementTriP2, MeshTri2
from skfem.quadrature import get_quadrature

from ...core.material import Material
from ..condense import condense
from ..plane_elements import bent_stiffness, stiffness

GAUSS_3 = (np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)]), np.array([5.0, 8.0, 5.0]) / 9)
STRAIGHT = 1e-12  # edges whose middle is closer to that of their chord, by the size of the mesh
LEAF = 24  # triangles that `Body.between` assembles at a time, at least; at most twice as many


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
        self.mesh, self.material, self.state, self.order = mesh, material, state, order
        self.nodes = np.vstack([mesh.t[:3], mesh.nvertices + mesh.t2f])  # (6, triangles): vertices, then edges 01, 12, 02
        fixed = np.concatenate([mesh.facets[:, mesh.boundaries[held]].ravel(), mesh.nvertices + mesh.boundaries[held]])
        free = np.ones(2 * mesh.doflocs.shape[1], dtype=bool)
        free[2 * fixed] = free[2 * fixed + 1] = False
        self.free, self.held = np.flatnonzero(free), np.flatnonzero(~free)
        self._factor: Any = None

    @cached_property
    def basis(self) -> Basis:
        """Shape functions at the quadrature points."""
        return Basis(self.mesh, ElementTriP2(), intorder=self.order)

    def local(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Stiffness matrices of the triangles ``(m, 12, 12)`` [N/mm per mm of width] and their unknowns ``(m, 12)``."""
        shapes = ElementTriP2()
        points, weight = get_quadrature(shapes, self.order)
        slope = np.array([shapes.lbasis(points, i)[1] for i in range(6)]).transpose(1, 0, 2)
        lame = self.material.lame(self.state)
        place = self.mesh.doflocs[:, self.nodes]
        corners, middles = place[:, :3], place[:, 3:]
        local = stiffness(slope, weight, (corners[:, 1:] - corners[:, :1]).transpose(2, 0, 1), *lame)
        away = np.abs(middles - (corners[:, [0, 1, 0]] + corners[:, [1, 2, 2]]) / 2).max(axis=(0, 1))
        bent = np.flatnonzero(away > STRAIGHT * np.ptp(self.mesh.doflocs))
        local[bent] = bent_stiffness(slope, weight, np.einsum("dim,eiq->mdeq", place[:, :, bent], slope, optimize=True), *lame)
        return local, (2 * self.nodes.T[:, :, None] + np.arange(2)).reshape(-1, 12)

    def stiffness(self) -> csc_matrix:
        """Stiffness matrix (sparse, 2 nodes square) [N/mm per mm of width].

        The weak form is ``lambda div u div v + 2 mu eps(u) : eps(v)``.
        """
        local, dofs = self.local()
        size = 2 * self.mesh.doflocs.shape[1]
        i = np.repeat(dofs, 12, axis=1).ravel()
        j = np.tile(dofs, (1, 12)).ravel()
        return coo_matrix((local.ravel(), (i, j)), shape=(size, size)).tocsc()

    def between(self, load: spmatrix) -> NDArray[np.float64]:
        """Displacements of the columns of `load` (sparse, ``(2 nodes, n)``) under each other: ``load' K^-1 load`` ``(n, n)``.

        Three times as fast as `solve`, since no displacement is computed.
        """
        local, dofs = self.local()
        corners = self.mesh.doflocs[:, self.mesh.t[:3]].mean(axis=1)
        radius = np.hypot(*corners)
        around = np.array([np.arctan2(*corners) * radius.mean(), radius])  # a cut of a ring is short in these coordinates
        return -condense(local, dofs, around, coo_array(load), np.arange(0), self.held, leaf=LEAF)

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
