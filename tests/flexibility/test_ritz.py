"""The energy model `ritz`: its pieces against closed forms, the whole against refined finite elements on random pairs."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.flexibility import flamant
from gearfe.flexibility.energy.ritz import join, panel
from gearfe.flexibility.energy.ritz import plane as ritz
from gearfe.geometry.mesh.sector import sector
from gearfe.geometry.mesh.triangle import jacobians, table
from gearfe.geometry.pair.interference import outline

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 1.0}
GEAR = gf.Gear(z=18, r_bore=9.0, **RACK)
RING = gf.Gear(z=72, r_rim=90.0, rack_tip_radius=0.3, **RACK)


def test_flamant_is_in_equilibrium_and_elastic():
    place, inward, tip_side = np.zeros((2, 1)), np.array([[0.6], [-0.8]]), np.array([[0.8], [0.6]])
    angle = np.linspace(-math.pi / 2, math.pi / 2, 2001)
    rays = inward * np.cos(angle) + tip_side * np.sin(angle)
    pull = flamant.traction(2.5 * rays, rays, place, inward, tip_side)[:, 0]
    assert_allclose(np.trapezoid(pull * 2.5, angle, axis=1), -inward[:, 0], rtol=1e-6, err_msg="carries a unit load")
    modulus, nu, h = 200.0, 0.4, 1e-5
    at = np.array([[0.7], [-0.3]])

    def moved(dx, dy):
        return flamant.displacement(at + np.array([[dx], [dy]]), place, inward, tip_side, modulus, nu)[:, 0, 0]

    strain = np.array([moved(h, 0) - moved(-h, 0), moved(0, h) - moved(0, -h)]) / (2 * h)
    xx, yy, xy = strain[0, 0], strain[1, 1], (strain[0, 1] + strain[1, 0]) / 2
    stress = modulus / (1 - nu**2) * np.array([xx + nu * yy, yy + nu * xx, (1 - nu) * xy])
    for normal in np.eye(2):
        want = flamant.traction(at, normal[:, None], place, inward, tip_side)[:, 0, 0]
        got = np.array([[stress[0], stress[2]], [stress[2], stress[1]]]) @ normal
        assert_allclose(got, want, rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize("side", [-1, 1])
def test_flamant_moves_the_surface_by_the_logarithm(side):
    place, inward, tip_side = np.zeros((2, 1)), np.array([[0.0], [-1.0]]), np.array([[1.0], [0.0]])
    got = flamant.displacement(side * np.array([[2.0], [0.0]]), place, inward, tip_side, 100.0, 0.4)[:, 0, 0] @ inward[:, 0]
    assert_allclose(got, -2 / (math.pi * 100.0) * math.log(2.0), rtol=1e-12)


@pytest.mark.parametrize("gear", [GEAR, RING, gf.Gear(z=12, x=-0.1, r_bore=4.0, **RACK)], ids=["18", "ring", "undercut"])
@pytest.mark.parametrize("cracks", [(), (gf.Crack(level=0.4),), (gf.Crack(level=0.7, turning=True),)], ids=str)
def test_area_of_the_sector_is_that_of_the_profile(gear, cracks):
    made = sector(gear, cracks)
    area = np.linalg.det(jacobians(made.points, made.triangles, made.edge_bulges, 6).transpose(0, 3, 1, 2))
    radius, angle = outline(gear, 4000)
    radius = np.concatenate([[gear.r_a], radius, [gear.r_f]])
    angle = np.concatenate([[0.0], angle, [math.pi / gear.z]])
    between = np.diff(angle) * (radius[1:] ** 2 + radius[:-1] ** 2) / 2  # twice the area inside half the outline
    want = abs(between.sum() - gear.held**2 * math.pi / gear.z)
    assert_allclose((area * table(6).weight).sum(), want, rtol=1e-6)


def test_sectors_join_to_the_whole_gear():
    """Doubling against sectors joined one by one, and all teeth explicit."""
    one = ritz.loaded_sector(panel.SectionModel(GEAR, STEEL, order=3), ())
    row = one.stiffness
    for count in range(2, 8):
        row = join.side_by_side(row, one.stiffness, one.stiffness.shape[0] // 2)
        got = join.repeated(one.stiffness, count)
        assert_allclose(np.tril(got), np.tril(row), atol=1e-9 * np.abs(row).max())
        assert_allclose(got, got.T)
    few, _ = join.join(GEAR, {0: one, 1: one}, one)
    every, _ = join.join(GEAR, dict.fromkeys(range(GEAR.z), one), one)
    apart, _ = join.join(GEAR, {0: one, 5: one, 9: one}, one)
    for key in few:
        assert_allclose(few[key], every[key], atol=1e-9 * np.abs(every[key]).max())
    assert_allclose(apart[0, 5], every[0, 5], atol=1e-9 * np.abs(every[0, 1]).max())
    assert_allclose(every[0, 17].T, every[0, 1], atol=1e-9 * np.abs(every[0, 1]).max(), err_msg="round the gear")


def test_order_converges():
    fine = ritz.flexibility(GEAR, STEEL, order=8)
    arc = np.linspace(fine.limits[0] + 0.1, fine.limits[1] - 0.1, 30)
    want = fine.near[0](arc)
    errors = [np.abs(ritz.flexibility(GEAR, STEEL, order=p).near[0](arc) / want - 1).max() for p in (2, 3, 4, 5)]
    print("errors by order 2...5:", errors)
    assert errors[0] > 3 * errors[1] > 3 * errors[2]
    assert errors[2] < 1.5e-3


@pytest.mark.parametrize(
    "body", [{"r_bore": 12.0}, {"r_rim": 52.0, "rack_tip_radius": 0.2, "addendum": 0.8}], ids=["gear", "ring"]
)
def test_loads_point_into_the_tooth_and_their_tangents_to_its_tip(body):
    """Where the field of a load has its jump is told by the tangent: it must be the side where there is no material."""
    gear = gf.Gear(z=40, m_n=2.0, alpha_n=math.radians(20), b=20.0, **body)
    roll = np.linspace(gear.roll_f, gear.roll_a, 5)
    place, inward, to_tip = panel._frames(gear, roll)
    ahead, _, _ = panel._frames(gear, roll + 1e-6 * (gear.roll_a - gear.roll_f))
    along = (ahead - place) / np.linalg.norm(ahead - place, axis=0)
    assert_allclose(to_tip, along, atol=1e-5)
    assert (inward[0] < 0).all(), "the loaded flank of tooth 0 is at x > 0"
