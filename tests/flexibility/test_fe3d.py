"""Three-dimensional FE of one gear: patch test, rigid bodies, plane strain, mirror images, limits, convergence."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.sparse import tril
from scipy.sparse.linalg import splu

import gearfe as gf
from gearfe.flexibility.finite_elements.elasticity import HeldSection
from gearfe.flexibility.finite_elements.fe import flank_load
from gearfe.flexibility.finite_elements.fe3d import Patches, influence, mesh_patches, patch_loads
from gearfe.flexibility.finite_elements.hexahedron import face_shapes, gauss, shapes, slopes_at
from gearfe.flexibility.finite_elements.solid_assembly import assemble
from gearfe.flexibility.finite_elements.solver import factor
from gearfe.geometry.mesh.outline import stations
from gearfe.geometry.mesh.section_mesh import section
from gearfe.geometry.tooth.profile import arc_at

RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
GEAR = gf.Gear(z=12, x=0.3, b=3.0, r_bore=5.0, **RACK)
HELICAL = replace(GEAR, beta=math.radians(20))
RING = gf.Gear(z=26, b=3.0, r_rim=33.0, addendum=0.6, rack_tip_radius=0.2, z_cutter=16, **RACK)
COARSE = {"flank": 0.5, "corner": 0.4, "fillet": 0.5, "root": 0.6, "near": 1.0, "far": 2.0}
W = 0.5


def patches(gear, count=3, axial=1, teeth=(0,)):
    low, high = arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a)
    return Patches(teeth, np.linspace(low + W, high - W, count) + np.array([[-W], [0.0], [W]]), axial)


def mesh_of(gear, found, **options):
    return mesh_patches(gear, found, **{"per_hat": 2, "layer": 1.5, "sizes": COARSE} | options)


@pytest.fixture(scope="module")
def helical():
    found = patches(HELICAL, axial=4, teeth=(0, 1))
    return found, mesh_of(HELICAL, found)


@pytest.fixture(scope="module")
def solved(helical, steel):
    """The influence of those patches."""
    return influence(helical[1], steel, helical[0])


def stiffness(mesh, steel):
    lower = assemble(mesh.points, mesh.cells, steel, np.arange(mesh.points.shape[1]))
    return lower + tril(lower, -1).T


def test_rigid_bodies_and_linear_fields(helical, steel):
    """Patch test: forces inside vanish in a linear field, and the energy is that of its stress, over exact volumes."""
    mesh = helical[1]
    matrix, points = stiffness(mesh, steel), mesh.points
    scale = abs(matrix).max()
    for axis in np.eye(3):
        for moved in (np.tile(axis, (points.shape[1], 1)), np.cross(axis, points.T)):
            assert abs(matrix @ moved.ravel()).max() < 1e-12 * scale * abs(moved).max()
    slope = np.random.default_rng(0).normal(size=(3, 3))
    moved = (slope @ points).T.ravel()
    force = (matrix @ moved).reshape(-1, 3)
    local = [[0, 1, 4, 2], [0, 2, 6, 3], [0, 3, 5, 1], [2, 4, 7, 6], [1, 5, 7, 4], [3, 6, 7, 5]]
    corners = [np.sort(mesh.cells[face], axis=0) for face in local]
    _, where, count = np.unique(np.hstack(corners), axis=1, return_inverse=True, return_counts=True)
    outer = (count[where] == 1).reshape(6, -1)
    whole = [face + [e for e in range(8, 20) if shares(e, face)] for face in local]
    assert all(len(face) == 8 for face in whole)
    skin = np.zeros(points.shape[1], dtype=bool)
    for face, own in zip(whole, outer, strict=True):
        skin[mesh.cells[face][:, own]] = True
    assert 0.2 < (~skin).mean() < 0.9
    assert abs(force[~skin]).max() < 1e-11 * abs(force).max()
    lam, mu = steel.lame("plane strain")
    strain = (slope + slope.T) / 2
    stress = lam * np.trace(strain) * np.eye(3) + 2 * mu * strain
    # the divergence theorem gives the volume from the forces of a uniform pressure
    assert_allclose((force[:, :, None] * points.T[:, None, :]).sum(axis=0) / stress, volume_of(mesh), rtol=1e-10)


def shares(edge, face):
    """Whether a local edge of the hexahedron runs between two corners of a face."""
    ends = [(0, 1), (0, 2), (0, 3), (1, 4), (1, 5), (2, 4), (2, 6), (3, 5), (3, 6), (4, 7), (5, 7), (6, 7)][edge - 8]
    return set(ends) <= set(face)


def volume_of(mesh):
    points, weight = gauss(3)
    return (slopes_at(mesh.points[:, mesh.cells], shapes(points)[1])[1] * weight).sum()


@pytest.mark.parametrize("gear", [HELICAL, replace(HELICAL, beta=-HELICAL.beta), RING, replace(RING, beta=0.2)])
def test_loads_have_unit_resultant_along_minus_the_normal(gear):
    found = patches(gear, axial=1)
    mesh = mesh_of(gear, found)
    load = patch_loads(mesh, found, 0).reshape(-1, 3, 3)
    # axial part and moment about the axis do not change along the width
    assert_allclose(load[:, 2].sum(axis=0), math.sin(gear.beta_b), rtol=1e-9)
    x, y, _ = mesh.points
    moment = (y[:, None] * load[:, 0] - x[:, None] * load[:, 1]).sum(axis=0)
    assert_allclose(moment, -gear.r_b * math.cos(gear.beta_b), rtol=2e-4)
    face = mesh.flank(0).reshape(8, -1)
    small = np.array([-1e-4, 1e-4, 0.0, 0.0])
    corner = np.einsum("kn,dkf->dnf", face_shapes(small, small[::-1]), mesh.points[:, face])
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 3], axis=0)
    normal *= gear.outward / np.linalg.norm(normal, axis=0)
    assert abs(abs(normal[2].mean()) - abs(math.sin(gear.beta_b))) < 1e-3
    assert normal[2].mean() * load[:, 2].sum() <= 0, "the load pushes into the flank"


def test_influence_is_symmetric_and_positive(helical, solved):
    mesh = helical[1]
    size = 2 * 3 * 4
    matrix = solved.matrix.reshape(size, size)
    assert_allclose(matrix, matrix.T, atol=1e-11 * abs(matrix).max())
    assert np.linalg.eigvalsh((matrix + matrix.T) / 2).min() > 0
    assert (solved.matrix[:, :, 0, :, :, 0] > 0).all(), "line loads push each other's patches away, neighbours included"
    assert solved.matrix[0, 1, 0, 1, 1, 0] < solved.matrix[0, 1, 0, 0, 1, 0]
    assert solved.dofs == 3 * (mesh.points.shape[1] - mesh.held.size)


@pytest.mark.slow
def test_influence_is_that_of_another_solver(helical, solved, steel):
    found, mesh = helical
    told = []
    first = influence(mesh, steel, found, tell=told.append)
    assert [own.unknowns for own in told] == [first.dofs]
    matrix = first.matrix.reshape(24, 24)
    assert_allclose(solved.matrix, first.matrix, atol=1e-10 * abs(matrix).max())
    free = np.setdiff1d(np.arange(mesh.points.shape[1]), mesh.held)
    rows = (3 * free[:, None] + np.arange(3)).ravel()
    lower = assemble(mesh.points, mesh.cells, steel, free)
    load = np.hstack([patch_loads(mesh, found, tooth) for tooth in found.teeth])[rows]
    factors = splu((lower + tril(lower, -1).T).tocsc(), "MMD_AT_PLUS_A", 0.0, options={"SymmetricMode": True})
    other = load.T @ factors.solve(load)
    assert_allclose(other, matrix, atol=1e-10 * abs(matrix).max(), err_msg="by SuperLU, of scipy")


def plane_strain(mesh, found, steel):
    """Influence matrix [mm per N/mm] with the end faces kept in their planes."""
    free = np.setdiff1d(np.arange(mesh.points.shape[1]), mesh.held)
    z = mesh.points[2, free]
    kept = np.ones((free.size, 3), dtype=bool)
    kept[:, 2] = (z > 1e-9) & (z < mesh.gear.b - 1e-9)
    kept = np.flatnonzero(kept)
    load = patch_loads(mesh, found, 0)[(3 * free[:, None] + np.arange(3)).ravel()][kept]
    matrix = assemble(mesh.points, mesh.cells, steel, free)[kept][:, kept]
    return load.T @ factor(matrix)(load) * mesh.gear.b


def plane_reference(gear, found, steel, cracks=()):
    """The same from the two-dimensional FE."""
    low, high = arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a)
    roll = stations(gear, 0.05, patches=[(low, high, 0.05)])
    made = section(gear, {0: roll}, fillet_size=0.15, size=0.5, far_size=1.0, cracks=cracks)

    def pressure(arc):
        return np.stack([np.maximum(1 - np.abs(part - top) / W, 0) / W for part, top in zip(arc, found.knots[1], strict=True)])

    load = flank_load(made, 0, pressure, np.zeros(found.knots.shape[1], dtype=int), roll.size - 1)
    return load.T @ HeldSection(made.mesh, steel).solve(load)


@pytest.mark.quick
@pytest.mark.parametrize(
    ("gear", "cracks"),
    [(GEAR, ()), pytest.param(RING, (), marks=pytest.mark.slow), (GEAR, (gf.Crack(level=0.6),))],
    ids=["gear", "ring", "deep crack"],
)
def test_plane_strain_is_the_two_dimensional_fe(gear, cracks, steel):
    found = patches(gear)
    mesh = mesh_patches(gear, found, cracks=cracks, per_hat=2, layer=4.0, refine=1.3, sizes={"near": 0.8, "far": 2.0})
    got = plane_strain(mesh, found, steel)
    want = plane_reference(gear, found, steel, cracks)
    print("plane strain against 2-D", got / want - 1)
    assert_allclose(got, want, rtol=4e-3)


def test_bad_patches_are_refused():
    for change, message in (
        ({"knots": np.array([[-0.4], [0.1], [0.6]])}, "leave the flank"),
        ({"knots": np.array([[1.0], [1.0], [1.5]])}, "three increasing numbers: start, top, end"),
        ({"knots": np.zeros((3, 0))}, "each hat function needs"),
        ({"modes": 0}, "at least one function"),
    ):
        with pytest.raises(ValueError, match=message):
            replace(patches(GEAR), **change).check(GEAR)


@pytest.mark.slow
def test_convergence_order(steel):
    """Three levels, each 1.5 times finer: the line load's flexibility and the first modes approach a limit."""
    found = patches(HELICAL, axial=3)
    values, dofs = [], []
    for refine in (0.8, 1.2, 1.8):
        made = influence(mesh_patches(HELICAL, found, per_hat=2, layer=1.0, refine=refine), steel, found)
        values.append(np.array([made.matrix[0, i, a, 0, i, a] for i in range(3) for a in range(3)]).reshape(3, 3))
        dofs.append(made.dofs)
    first, second = values[1] - values[0], values[2] - values[1]
    order = np.log(first[:, 0] / second[:, 0]) / math.log(1.5)
    print("dofs", dofs, "steps of the line load", first[:, 0] / values[2][:, 0], second[:, 0] / values[2][:, 0], "order", order)
    assert (second[:, 0] > 0).all(), "displacements approach from below"
    assert (np.abs(second) < 0.7 * np.abs(first)).all()
    assert np.abs(second / values[2][:, :1]).max() < 2e-3
