"""Reduction of many elements to few unknowns, against dense algebra."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.sparse import coo_array
from skfem import BilinearForm, ElementTriP2, ElementVector, MeshTri, MeshTri2
from skfem.helpers import ddot, div, sym_grad
from usual import STEEL

from gearfe.flexibility.condense import condense
from gearfe.flexibility.finite_elements.elasticity import HeldSection

pytestmark = pytest.mark.quick


def body_of(seed):
    """A rough sheet of bent triangles held at its left edge."""
    rng = np.random.default_rng(seed)
    mesh = MeshTri2.from_mesh(MeshTri.init_tensor(np.linspace(0.0, 2.0, 9), np.linspace(0.0, 1.0, 6)))
    nodes = mesh.doflocs + rng.uniform(-0.02, 0.02, mesh.doflocs.shape)
    mesh = MeshTri2(nodes, mesh.t).with_boundaries({"held": lambda x: x[0] < 0.05})
    return HeldSection(mesh, STEEL), rng


@pytest.mark.parametrize("leaf", [2, 7, 1000])
@pytest.mark.parametrize("seed", [0, 1])
def test_the_reduced_body_is_that_of_dense_algebra(leaf, seed):
    body, rng = body_of(seed)
    local, dofs = body.local()
    n = 2 * body.mesh.doflocs.shape[1]
    stays = rng.permutation(body.free)[:11]
    load = np.zeros((n, 3))
    load[rng.permutation(n)[:40]] = rng.normal(size=(40, 3))
    load[body.held[:2]] = 5.0  # carried by what is held: no effect
    centre = body.mesh.doflocs[:, body.mesh.t[:3]].mean(axis=1)
    got = condense(local, dofs, centre, coo_array(load), stays, body.held, leaf=leaf)
    goes = np.setdiff1d(body.free, stays)
    whole = body.stiffness().toarray()
    ahead = np.hstack([whole[np.ix_(goes, stays)], load[goes]])
    want = -ahead.T @ np.linalg.solve(whole[np.ix_(goes, goes)], ahead)
    want[:11, :11] += whole[np.ix_(stays, stays)]
    want[:11, 11:] += load[stays]
    want[11:, :11] += load[stays].T
    assert_allclose(got, want, rtol=0, atol=1e-11 * np.abs(want).max())


@pytest.mark.parametrize("state", ["plane strain", "plane stress"])
def test_the_stiffness_of_straight_and_bent_triangles_is_that_of_the_weak_form(state):
    body, _ = body_of(3)
    straight = np.arange(body.mesh.nvertices, body.mesh.doflocs.shape[1])[::2]
    nodes = body.mesh.doflocs.copy()
    facets = body.mesh.facets[:, straight - body.mesh.nvertices]
    nodes[:, straight] = nodes[:, facets].mean(axis=1)
    body = HeldSection(MeshTri2(nodes, body.mesh.t).with_boundaries({"held": lambda x: x[0] < 0.05}), STEEL, state=state)
    lam, mu = STEEL.lame(state)
    form = BilinearForm(lambda u, v, _: lam * div(u) * div(v) + 2 * mu * ddot(sym_grad(u), sym_grad(v)))
    basis = body.basis.with_element(ElementVector(ElementTriP2()))
    there = np.empty(basis.N, dtype=int)
    for d in range(2):
        there[basis.nodal_dofs[d]] = 2 * np.arange(body.mesh.nvertices) + d
        there[basis.facet_dofs[d]] = 2 * (body.mesh.nvertices + np.arange(body.mesh.nfacets)) + d
    want = form.assemble(basis).toarray()
    assert_allclose(body.stiffness().toarray()[np.ix_(there, there)], want, rtol=0, atol=1e-10 * np.abs(want).max())


def test_a_body_that_nothing_holds_is_refused():
    body, _ = body_of(7)
    local, dofs = body.local()
    load = coo_array((2 * body.mesh.doflocs.shape[1], 1))
    with pytest.raises(RuntimeError, match="are unsupported"):
        condense(-local, dofs, np.zeros((2, dofs.shape[0])), load, np.arange(0), leaf=8)
