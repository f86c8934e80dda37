"""Teeth with holes in tets: matrices, loads, stress, and what the missing material does."""

import math
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from skfem import Basis as FemBasis
from skfem import BilinearForm, ElementTetP2, ElementVector, MeshTet, asm
from skfem.helpers import ddot, eye, sym_grad, trace

import gearfe as gf
from gearfe.flexibility.finite_elements.solid_assembly import assemble
from gearfe.flexibility.finite_elements.tetrahedron import nodal_stress, second_order
from gearfe.geometry.mesh.holes import holed_sector
from gearfe.geometry.tooth.profile import cartesian, fillet_length, flank, root_curve
from gearfe.strength import holed
from gearfe.strength.fields import von_mises, write_vtu
from gearfe.strength.holed import pressed_tooth, root_error, tooth_field
from gearfe.strength.render import FINE, STRIP, _text

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 6.0}
GEAR = gf.Gear(z=18, r_bore=9.0, **RACK)
HELICAL = replace(GEAR, beta=math.radians(25))
PIT = {"z": 3.0, "axes": (0.5, 0.8), "depth": 0.2}
COARSE = {"far": 3.0, "tooth": 1.0, "flank": 0.8, "fillet": 0.6, "tip": 0.3}


def pit(gear, **numbers):
    return gf.Pit(**{"radius": gear.r, **PIT} | numbers)


def test_tets_are_those_of_scikit_fem(steel):
    mesh = MeshTet().refined(1)
    mesh = mesh.translated((0.1, 0.2, 0.3)).scaled((1.0, 1.3, 0.8))
    sides = mesh.p[:, mesh.t[1:]] - mesh.p[:, mesh.t[:1]]
    left = np.linalg.det(sides.transpose(2, 0, 1)) < 0  # ours are right-handed
    nodes, cells, _ = second_order(mesh.p, np.where(left, mesh.t[[1, 0, 2, 3]], mesh.t))
    free = np.arange(nodes.shape[1])
    lower = assemble(nodes, cells, steel, free)
    lam, mu = steel.lame("plane strain")

    @BilinearForm
    def form(u, v, _):
        strain = sym_grad(u)
        return ddot(lam * eye(trace(strain), 3) + 2 * mu * strain, sym_grad(v))

    basis = FemBasis(mesh, ElementVector(ElementTetP2()), intorder=4)
    theirs = asm(form, basis)
    field = np.random.default_rng(1).normal(size=(3, 10))

    def at(x):
        x, y, z = x
        return np.tensordot(field, [1 + 0 * x, x, y, z, x * x, y * y, z * z, x * y, y * z, x * z], axes=1)

    mine = at(nodes).T.ravel()
    other = basis.project(at)
    ours = 2 * mine @ (lower @ mine) - (lower.diagonal() * mine**2).sum()
    assert_allclose(ours, other @ theirs @ other, rtol=1e-9)


def test_stress_of_a_linear_field_is_exact(steel):
    made = holed_sector(HELICAL, [pit(HELICAL)], teeth=1, sizes=COARSE)
    nodes, cells, _ = second_order(made.points, made.cells[:, made.plug < 0])
    slope = np.random.default_rng(0).normal(size=(3, 3))
    lam, mu = steel.lame("plane strain")
    strain = (slope + slope.T) / 2
    want = lam * np.trace(strain) * np.eye(3) + 2 * mu * strain
    found = nodal_stress(nodes, cells, slope @ nodes, steel)[:, np.unique(cells)]
    assert_allclose(found, np.tile(want[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]][:, None], found.shape[1]), rtol=1e-6, atol=1e-3)


@pytest.fixture(scope="module")
def pressed():
    pair = gf.GearPair(HELICAL, replace(HELICAL, z=27))
    damage = {"pinion": [pit(HELICAL), pit(HELICAL, z=1.2), gf.Crack(level=0.3)]}
    run = {"phases": [0.5, 0.9], "sizes": COARSE}
    return pair, pressed_tooth(gf.Case(pair, 1500.0, gf.Material(E=207e3, nu=0.3), damage=damage), **run)


@pytest.mark.slow
def test_the_load_is_that_of_the_contact(pressed):
    """Its axial part and moment are those of a force at right angles to the flank; the reactions balance it."""
    pair, made = pressed
    nodes, _, number = second_order(made.sector.points, made.sector.cells)
    lines = holed._lines(pair, made.contact.cells[0], 0, 0, 0)
    force = holed._pressure(made.sector, nodes, number, lines, holed.SPREAD * HELICAL.m_n).reshape(-1, 3).T
    total = sum(part[3].sum() for found in lines.values() for part in found)
    assert_allclose(total * math.cos(HELICAL.beta_b), 1500.0, rtol=1e-6)
    assert_allclose(force[2].sum(), total * math.sin(HELICAL.beta_b), rtol=1e-9)
    moment = (nodes[1] * force[0] - nodes[0] * force[1]).sum()
    assert_allclose(moment, -total * HELICAL.r_b * math.cos(HELICAL.beta_b), rtol=2e-3)
    assert made.load[0] == pytest.approx(sum(part[3].sum() for part in lines[0]))


@pytest.mark.slow
@pytest.mark.parametrize("end", [0.0, HELICAL.b])
def test_a_line_shorter_than_the_triangles_presses_at_the_nearest(end):
    """At a corner of the flank of any tooth: a force of its size, at right angles to the flank, less than a triangle away."""
    sector = holed_sector(HELICAL, [pit(HELICAL)], teeth=3, sizes=COARSE)
    nodes, _, number = second_order(sector.points, sector.cells)
    short, roll = np.array([abs(end - 1e-4)]), np.array([HELICAL.roll_a - 1e-3])
    line = [(short, np.array([2e-4]), roll, np.array([20.0]))]
    force = holed._pressure(sector, nodes, number, {1: line}, 1e-6).reshape(-1, 3).T
    assert_allclose(np.linalg.norm(force.sum(axis=1)), 20.0, rtol=1e-9)
    assert_allclose(force[2].sum(), 20.0 * math.sin(HELICAL.beta_b), rtol=1e-9)
    radius, angle = flank(HELICAL, roll)
    place = np.array([*cartesian(radius, angle + 2 * math.pi / HELICAL.z + HELICAL.twist_rate * short), short])
    size = np.linalg.norm(nodes[:, np.abs(force).max(axis=0) > 0] - place, axis=0).max()
    centre = nodes @ (force[2] / force[2].sum())  # all of it has one direction
    assert np.linalg.norm(centre - place[:, 0]) < size / holed.PARTS


def test_a_line_far_from_all_triangles_is_refused():
    sector = holed_sector(HELICAL, [pit(HELICAL)], teeth=3, sizes=COARSE)
    nodes, _, number = second_order(sector.points, sector.cells)
    line = [(np.array([-3.0]), np.array([2e-4]), np.array([HELICAL.roll_a - 1e-3]), np.array([20.0]))]
    with pytest.raises(RuntimeError, match="too coarse to carry the load of a contact line"):
        holed._pressure(sector, nodes, number, {1: line}, 1e-6)


def test_holes_and_cracks_weaken(pressed):
    field = tooth_field(pressed[1])
    assert field.opening > 0
    assert np.isfinite(field.mises).all()
    assert field.root > 0


def test_vtu_reads_back(pressed, tmp_path):
    import meshio

    field = tooth_field(pressed[1], 1)
    write_vtu(tmp_path / "tooth.vtu", [field])
    found = meshio.read(tmp_path / "tooth.vtu")
    assert_allclose(found.points, field.points.T)
    assert np.array_equal(found.cells_dict["tetra10"], field.cells.T)
    assert_allclose(found.point_data["displacement [mm]"], field.moved.T)
    assert_allclose(found.point_data["stress [MPa]"], field.stress.T)
    assert_allclose(found.point_data["von Mises stress [MPa]"], field.mises)


def test_damage_of_two_gears_is_refused():
    pair = gf.GearPair(GEAR, replace(GEAR, z=27))
    with pytest.raises(ValueError, match="one tooth of one gear"):
        pressed_tooth(gf.Case(pair, 1000.0, gf.Material(), damage={"pinion": [pit(GEAR)], "wheel": [gf.Crack(level=0.2)]}))


def test_the_second_half_is_drawn_in_the_mirror():
    """A pit there, turned the other way, is that of the first half."""
    pair = gf.GearPair(*(replace(gear, b=12.0) for gear in (HELICAL, replace(HELICAL, z=27))))
    one, two = (holed._own(pair, 0, "herringbone", 2.0, (pit(HELICAL, z=z, angle=a),)) for z, a in ((2.0, 0.5), (10.0, -0.5)))
    assert (one[1], two[1]) == (0, 1)
    assert two[0] == one[0]
    assert two[2] == one[2]
    mirrored = pit(HELICAL, z=2.0, angle=0.5), pit(HELICAL, z=10.0, angle=-0.5)
    assert holed._own(pair, 0, "herringbone", 2.0, mirrored) == one
    for other in ({"z": 9.0}, {"angle": 0.5}, {"radius": HELICAL.r + 0.1}):
        with pytest.raises(ValueError, match="both halves"):
            holed._own(pair, 0, "herringbone", 2.0, (mirrored[0], replace(mirrored[1], **other)))


@pytest.mark.slow
def test_root_stress_in_the_middle_of_a_wide_tooth_is_that_of_plane_strain(steel):
    """The mean over the middle third of the width, in ten pieces of the fillet: the nodal peaks of so coarse tets scatter."""
    pair = gf.GearPair(replace(GEAR, b=16.0), replace(GEAR, b=16.0, z=27))
    made = pressed_tooth(gf.Case(pair, 2000.0, steel), phases=[0.75], sizes={"fillet": 0.2, "flank": 0.4})
    assert made.load[0] == pytest.approx(2000.0), "one pair carries"
    field = tooth_field(made)
    arcs = np.linspace(0.0, fillet_length(pair.gear_1), 400)
    curve = cartesian(*root_curve(pair.gear_1, arcs))
    away = np.hypot(*(field.points[:2, :, None] - curve[:, None, :]))
    on = (away.min(axis=1) < 0.02) & (np.abs(field.points[2] - 8.0) < 2.5)
    tensor = field.stress[:, on][[[0, 3, 5], [3, 1, 4], [5, 4, 2]]].transpose(2, 0, 1)
    piece = away[on].argmin(axis=1) // 40
    means = [np.linalg.eigvalsh(tensor)[piece == k, 2].mean() for k in range(10)]
    radius = math.hypot(pair.gear_1.r_b, float(made.contact.cells[0].roll_1.mean()))
    assert_allclose(max(means), gf.root_stress(pair.gear_1, radius, 125.0, steel), rtol=0.04)


def test_the_estimate_of_the_root_stress_vanishes_where_stress_is_linear(steel):
    """Second-order tets have linear stress exactly; under a cubic displacement they differ where they meet."""
    mesh = MeshTet().refined(1)
    left = np.linalg.det((mesh.p[:, mesh.t[1:]] - mesh.p[:, mesh.t[:1]]).transpose(2, 0, 1)) < 0
    cells = np.where(left, mesh.t[[1, 0, 2, 3]], mesh.t)
    nodes, ten, _ = second_order(mesh.p, cells)
    middle, errors = np.argmin(np.linalg.norm(nodes - [[0.5], [0.5], [0.0]], axis=0)), []
    askew = nodes[0] + 0.7 * nodes[1] - 0.4 * nodes[2]
    for bent in (askew**2, askew**3):
        moved = 1e-3 * np.array([bent, nodes[1] * nodes[2], nodes[0]])
        stress = nodal_stress(nodes, ten, moved, steel)
        faces = SimpleNamespace(faces={"fillets 0": middle})
        pressed = SimpleNamespace(sector=faces, nodes=nodes, cells=ten, moved=moved[None], stress=stress[None])
        errors.append(root_error(pressed, steel) / von_mises(stress).max())
    assert errors[0] < 1e-10 < 1e-3 < errors[1]


@pytest.mark.slow
def test_the_estimate_of_the_root_stress_covers_a_finer_mesh():
    case = gf.load_scene("helical_pitting").pair().case("severe")
    coarse, fine = (pressed_tooth(case, refine=refine, sizes=FINE, strip=STRIP) for refine in (1.0, 1.6))
    apart = abs(tooth_field(fine).root - tooth_field(coarse).root)
    assert 0 < apart < root_error(coarse, case.materials[0]) < 0.2 * tooth_field(coarse).root


@pytest.mark.parametrize("tooth", [0, 12])
def test_the_printed_phase_gives_the_same_cells_and_so_the_same_mesh(steel, tooth):
    """Another digit of the phase meshes the tooth anew, which changed the root stress by 2 %."""
    case = gf.Case(gf.GearPair(HELICAL, replace(HELICAL, z=27)), 1500.0, steel)
    found = holed.contact_of(case, None, tooth)
    printed = _text("", {"phase": float(found.phase[0]), "load": 1.0, "where": "", "enlarged": 0})
    again = holed.contact_of(case, [float(re.search(r"phase (-?[\d.]+)", printed)[1])], tooth)
    assert again.phase[0] == found.phase[0]
    for name in ("order", "z", "roll_1", "roll_2", "load"):
        assert np.array_equal(getattr(found.cells[0], name), getattr(again.cells[0], name)), name
