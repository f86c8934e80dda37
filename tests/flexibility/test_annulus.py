"""The gear body as an annulus: Lame, integration of the equations of elasticity, and finite elements under the same loads."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from skfem import MeshTri, MeshTri2
from usual import STEEL

from gearfe.flexibility.energy.closed import annulus
from gearfe.flexibility.finite_elements import fe
from gearfe.flexibility.finite_elements.elasticity import HeldSection, edge_shapes
from gearfe.geometry.tooth.profile import cartesian


def by_integration(n, ratio, material, state):
    """Outer (u, v) per (p, q) of harmonic n by integrating the plane equations of elasticity over the radius, times 2 G / r."""
    lam, mu = material.lame(state)

    def slope(r, y):
        u, v, s, t = y
        stretch = (u + n * v) / r
        du = (s - lam * stretch) / (lam + 2 * mu)
        hoop = lam * du + (lam + 2 * mu) * stretch
        return [du, t / mu + (v + n * u) / r, -(s - hoop + n * t) / r, (n * hoop - 2 * t) / r]

    starts = ([0, 0, 1, 0], [0, 0, 0, 1])
    ends = np.array([solve_ivp(slope, (ratio, 1), y, method="DOP853", rtol=1e-11, atol=1e-14).y[:, -1] for y in starts]).T
    return 2 * mu * ends[:2] @ np.linalg.inv(ends[2:])


@pytest.mark.parametrize("state", ["plane strain", "plane stress"])
@pytest.mark.parametrize("ratio", [0.3, 0.85])
def test_harmonics_solve_the_equations_of_elasticity(state, ratio):
    orders = np.array([0, 1, 2, 3, 9])
    got = annulus.harmonic_flexibility(orders, ratio, STEEL.nu, state)
    for n, one in zip(orders.tolist(), got, strict=True):
        assert_allclose(one, by_integration(n, ratio, STEEL, state), rtol=1e-8, atol=1e-8, err_msg=f"harmonic {n}")


def test_high_harmonics_are_those_of_the_half_plane():
    """A pressure cos(k x) moves a half-plane by 2 / (E' k), however thin the rim: n = k r."""
    n = np.array([500, 3000])
    got = annulus.harmonic_flexibility(n, 0.9, STEEL.nu) / (2 * STEEL.shear_modulus)
    want = 2 / STEEL.plane_modulus("plane strain") / n
    assert_allclose(got[:, 0, 0], want, rtol=5e-3)
    assert_allclose(got[:, 1, 1], want, rtol=5e-3)


@pytest.fixture(scope="module")
def ring_mesh():
    """P2 mesh between two circles, finer where it is loaded; radii 6 and 10."""
    angle = np.unique(np.concatenate([np.linspace(-0.25, 0.7, 150), np.linspace(0.7, 2 * math.pi - 0.25, 60)[:-1]]))
    radius = 10 - 4 * np.linspace(0, 1, 28) ** 1.8
    i, j = np.meshgrid(np.arange(radius.size - 1), np.arange(angle.size), indexing="ij")
    a, b, c, d = ((k * angle.size + m % angle.size).ravel() for k, m in ((i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)))
    points = np.concatenate([cartesian(r, angle) for r in radius], axis=1)
    linear = MeshTri(points, np.hstack([[a, b, c], [b, d, c]]))
    held = linear.facets_satisfying(lambda x: np.hypot(*x) < 6.05, boundaries_only=True)
    linear = linear.with_boundaries({"held": held})
    mesh = MeshTri2.from_mesh(linear).with_boundaries(linear.boundaries)
    nodes, ends = mesh.doflocs.copy(), points[:, linear.facets]
    middle = ends.sum(axis=1)
    nodes[:, linear.nvertices :] = middle / np.hypot(*middle) * np.hypot(*ends).mean(axis=0)
    return replace(mesh, doflocs=nodes), angle


def test_body_equals_finite_elements_under_the_same_tractions(ring_mesh):
    mesh, angle = ring_mesh
    half_angle, pitch = 0.13, 0.33
    at, force = annulus.arc_tractions(10.0, half_angle)
    facet = {tuple(f): k for k, f in enumerate(mesh.facets.T.tolist())}
    load = np.zeros((2 * mesh.doflocs.shape[1], 6))
    for tooth, turn in enumerate((0.0, pitch)):
        edge = np.searchsorted(angle, at + turn) - 1
        shapes, _ = edge_shapes(2 * (at + turn - angle[edge]) / (angle[edge + 1] - angle[edge]) - 1)
        middle = mesh.nvertices + np.array([facet[k, k + 1] for k in edge.tolist()])
        turned = fe.turned(force.transpose(1, 0, 2), turn)
        for node, shape in zip((edge, edge + 1, middle), shapes, strict=True):
            for d in range(2):
                for pattern in range(3):
                    np.add.at(load[:, 3 * tooth + pattern], 2 * node + d, shape * turned[d, pattern])
    want = load.T @ HeldSection(mesh, STEEL).solve(load)
    got = annulus.root_flexibility(6.0, 10.0, half_angle, [0.0, pitch], STEEL)
    scale = np.sqrt(np.outer(np.diag(want), np.diag(want)))
    print(np.round(100 * (got[0] - want[:3, :3]) / scale[:3, :3], 3), np.round(100 * (got[1] - want[3:, :3]) / scale[:3, :3], 3))
    assert_allclose(got[0] / scale[:3, :3], want[:3, :3] / scale[:3, :3], atol=5e-3)
    assert_allclose(got[1] / scale[3:, :3], want[3:, :3] / scale[3:, :3], atol=1e-3)
    assert abs(want[3, 0]) > 0.1 * want[0, 0], "the neighbour is felt"


def test_teeth_of_one_body_are_reciprocal_and_their_energy_positive():
    z, half_angle = 12, 0.2
    each = annulus.root_flexibility(4.0, 10.0, half_angle, 2 * math.pi / z * np.arange(-z + 1, z), STEEL)
    whole = np.block([[each[z - 1 + i - j] for j in range(z)] for i in range(z)])
    assert_allclose(whole, whole.T, atol=1e-14 * np.abs(whole).max())
    assert np.linalg.eigvalsh(whole).min() > 0
    assert_allclose(each[0], each[z], atol=1e-14 * np.abs(whole).max(), err_msg="once round")


def test_harmonics_are_enough():
    few, many = (annulus.root_flexibility(10.0, 20.0, 0.1, [0.0, 0.3], STEEL, turns=n) for n in (annulus.TURNS, 180.0))
    scale = np.sqrt(np.outer(np.diag(many[0]), np.diag(many[0])))
    assert np.abs((few - many) / scale).max() < 3e-4
