"""Plane elasticity against closed forms: Lame's ring and a uniform stress state."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from skfem import MeshTri, MeshTri2

import gearfe as gf
from gearfe.flexibility.finite_elements.elasticity import HeldSection, edge_nodes, edge_shapes

pytestmark = pytest.mark.quick


def ring(inner, outer, n):
    """Curved second-order ring with boundaries inner and outer."""
    radial, around = 2 * n, 12 * n
    turn = 2 * np.pi * np.arange(around) / around
    radius = np.linspace(inner, outer, radial + 1)
    points = np.array([np.outer(radius, np.cos(turn)).ravel(), np.outer(radius, np.sin(turn)).ravel()])
    i, j = np.meshgrid(np.arange(radial), np.arange(around), indexing="ij")
    a, b = i * around + j, i * around + (j + 1) % around
    triangles = np.hstack([np.array([a, b, b + around]).reshape(3, -1), np.array([a, b + around, a + around]).reshape(3, -1)])
    mesh = MeshTri2.from_mesh(MeshTri(np.ascontiguousarray(points), np.ascontiguousarray(triangles)))
    nodes = mesh.doflocs.copy()
    polar = np.hypot(*nodes[:, mesh.facets]).mean(axis=0)
    middle = nodes[:, mesh.nvertices :]
    nodes[:, mesh.nvertices :] = middle * polar / np.hypot(*middle)
    facet_radius = np.hypot(*nodes[:, mesh.nvertices :])
    bounds = {name: np.flatnonzero(np.isclose(facet_radius, r)) for name, r in (("inner", inner), ("outer", outer))}
    return replace(mesh, doflocs=nodes).with_boundaries(bounds)


def lame(r, inner, outer, pressure, material, state):
    """Radial displacement of a ring held at its inner edge under outer pressure."""
    lam, mu = material.lame(state)
    # u = A r + B / r, u(inner) = 0, sigma_r(outer) = -pressure
    b_of_a = -(inner**2)
    a = -pressure / (2 * (lam + mu) - 2 * mu * b_of_a / outer**2)
    return a * r + a * b_of_a / r


def error(n, material, state):
    mesh = ring(1.0, 2.0, n)
    body = HeldSection(mesh, material, state=state, held="inner")
    facets = mesh.boundaries["outer"]
    nodes = np.vstack([mesh.facets[:, facets], mesh.nvertices + facets])
    t, w = np.polynomial.legendre.leggauss(3)
    shapes, slopes = edge_shapes(t)
    along = np.einsum("dne,np->dep", mesh.doflocs[:, nodes], slopes)
    at = np.einsum("dne,np->dep", mesh.doflocs[:, nodes], shapes)
    force = np.zeros((2 * mesh.doflocs.shape[1], 1))
    nodal = -np.einsum("np,dep,ep,p->nde", shapes, at / np.hypot(*at), np.hypot(*along), w)
    for d in range(2):
        np.add.at(force[:, 0], 2 * nodes + d, nodal[:, d])
    u = body.solve(force)[:, 0].reshape(-1, 2).T
    exact = lame(np.hypot(*mesh.doflocs), 1.0, 2.0, 1.0, material, state)
    found = (u * mesh.doflocs).sum(axis=0) / np.hypot(*mesh.doflocs)
    return np.abs(found - exact).max() / np.abs(exact).max()


@pytest.mark.parametrize(
    ("nu", "state"), [(0.0, "plane strain"), (0.3, "plane strain"), (0.3, "plane stress"), (0.499, "plane strain")]
)
def test_lame_ring_converges(nu, state):
    material = gf.Material(E=1000.0, nu=nu)
    errors = [error(n, material, state) for n in (2, 4)]
    rate = np.log2(errors[0] / errors[1])
    print(f"nu {nu}, {state}: errors {errors}, observed rate {rate:.2f}")
    assert errors[1] < 2e-3 if nu < 0.49 else errors[1] < 2e-2
    assert rate > 2.5


@pytest.mark.parametrize("inset", [0.0, 0.3, 1.0])
def test_stress_inside_of_triangles(inset):
    """Of a quadratic displacement u = (x**2, 0), which two triangles carry exactly: sigma_xx = 2 (lam + 2 mu) x.

    At a corner of one triangle alone it is that of a point `inset` of the way to its middle.
    """
    mesh = MeshTri2.from_mesh(MeshTri(np.array([[0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0]]), np.array([[0, 0], [1, 2], [2, 3]])))
    body = HeldSection(mesh.with_boundaries({"left": lambda x: x[0] < 1e-9}), gf.Material(E=1000.0, nu=0.3), held="left")
    x, y = body.mesh.doflocs
    stress = body.stress(np.column_stack([x**2, 0 * x]).ravel(), inset)
    lam, mu = body.material.lame(body.state)
    place = {(1.0, 0.0): 1.0 + inset * (2 / 3 - 1.0), (0.0, 1.0): inset / 3}  # middles at 2/3 and 1/3
    for corner, at in place.items():
        node = int(np.flatnonzero((x == corner[0]) & (y == corner[1]))[0])
        assert_allclose(stress[:, node], [2 * (lam + 2 * mu) * at, 2 * lam * at, 0.0], atol=1e-9)


def test_edge_nodes_follow_the_chain():
    mesh = ring(1.0, 2.0, 1)
    nodes = edge_nodes(mesh, np.array([0, 1, 2]))
    middles = mesh.doflocs[:, nodes[2]]
    assert_allclose(np.hypot(*middles), 1.0, rtol=1e-12)


@pytest.mark.parametrize("numbers", [{"E": 0.0}, {"E": float("nan")}, {"nu": 0.5}, {"nu": -0.1}])
def test_impossible_materials_are_refused(numbers):
    with pytest.raises(ValueError, match=r"E = |nu = "):
        gf.Material(**numbers)
