"""The coupled closed form: exact wedge, ring and contact solutions for its parts, finite elements for the whole."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad, solve_ivp
from skfem import MeshTri, MeshTri2

import gearfe as gf
from gearfe import fe
from gearfe.elasticity import Body, edge_shapes
from gearfe.energy import annulus, coupled
from gearfe.energy.beam import along_fillet, along_flank
from gearfe.energy.ladder import ladder
from gearfe.hertz import half_plane
from geometry.tooth import cartesian, fillet, flank, form_point, root_half_angle

STEEL = gf.Material(E=207e3, nu=0.3)
WIDTH = 20.0


def make(z, r_bore, **numbers):
    return gf.Gear(**({"z": z, "m_n": 2.0, "alpha_n": math.radians(20), "b": WIDTH, "r_bore": r_bore} | numbers))


def thin(z, ratio, **numbers):
    gear = make(z, 1.0, **numbers)
    return replace(gear, r_bore=ratio * gear.r_f)


# ------------------------------------------------------------------------------------------------ beam


def wedge_stress(load, half_angle, x, depth):
    """Exact (sigma_y, tau_xy) of a wedge with its apex up, loaded there; at `depth` below it.

    Timoshenko and Goodier, Theory of Elasticity, section 38 (forces) and Carothers 1912 (moment), to an arbitrary factor.
    """
    r, phi = np.hypot(x, depth), np.arctan2(x, depth)
    radial, shear = {
        "across": (np.sin(phi) / r, 0.0),
        "along": (np.cos(phi) / r, 0.0),
        "moment": (-2 * np.sin(2 * phi) / r**2, (np.cos(2 * phi) - np.cos(2 * half_angle)) / r**2),
    }[load]
    e_r, e_t = np.array([np.sin(phi), -np.cos(phi)]), np.array([np.cos(phi), np.sin(phi)])
    return radial * e_r[1] ** 2 + 2 * shear * e_r[1] * e_t[1], radial * e_r[0] * e_r[1] + shear * (
        e_r[0] * e_t[1] + e_t[0] * e_r[1]
    )


@pytest.mark.parametrize("load", ["across", "along", "moment"])
def test_shear_of_a_taper_is_that_of_the_exact_wedge(load):
    """Section forces from the exact stresses; the rest is of the order of the angle squared, so it falls fourfold."""
    depth, errors = 3.0, []
    for half_angle in (0.05, 0.1, 0.2):
        half = depth * math.tan(half_angle)
        points, weights = np.polynomial.legendre.leggauss(40)
        x = half * points
        sigma, tau = wedge_stress(load, half_angle, x, depth)
        shear, normal, moment = (half * weights @ v for v in (tau, sigma, x * sigma))
        got = coupled.shear_stress(x, half, -math.tan(half_angle), shear, normal, moment)
        errors.append(np.abs(got - tau).max() / np.abs(tau).max())
    rates = np.log2(np.array(errors[1:]) / errors[:-1])
    print(load, errors, rates)
    assert errors[1] < 0.02
    assert_allclose(rates, 2, atol=0.1)


def test_shear_without_taper_is_the_parabola():
    x = np.linspace(-1.3, 1.3, 9)
    assert_allclose(coupled.shear_stress(x, 1.3, 0.0, 2.0, 5.0, 7.0), 3 * 2 / (4 * 1.3) * (1 - (x / 1.3) ** 2), atol=1e-14)


def test_square_of_the_shear_is_its_integral():
    section = (1.2, -0.4, -0.9, -0.3, 1.7)
    want = quad(lambda x: coupled.shear_stress(x, *section) ** 2, -1.2, 1.2)[0]
    assert_allclose(coupled.shear_square(*section), want, rtol=1e-12)
    total = quad(lambda x: coupled.shear_stress(x, *section), -1.2, 1.2)[0]
    assert_allclose(total, -0.9, rtol=1e-12, err_msg="shear force")


@pytest.mark.parametrize("gear", [make(14, 5.0, x=0.3), make(40, 15.0)], ids=["z14", "z40"])
def test_profile_slopes_are_those_of_the_curve(gear):
    roll = np.array([0.9 * gear.roll_a])
    for part in (along_fillet(gear, coupled.root_section(gear)[0]), along_flank(gear, roll)):
        x, y, slope, step = (np.atleast_2d(v)[0] for v in (part.x, part.y, part.slope, part.step))
        order = np.argsort(y)
        change = np.diff(x[order])
        assert_allclose(change, np.diff(y[order]) * (slope[order][1:] + slope[order][:-1]) / 2, atol=2e-3 * np.abs(change).max())
        assert (step > 0).all()
    bottom, top = coupled.root_section(gear)[2], cartesian(*flank(gear, roll))[1, 0]
    total = along_fillet(gear, coupled.root_section(gear)[0]).step.sum() + along_flank(gear, roll).step.sum()
    joint = cartesian(*fillet(gear, form_point(gear)[0]))[1] - cartesian(*flank(gear, gear.roll_f))[1]
    assert_allclose(total, top - bottom - joint, rtol=1e-8)


def test_root_section_touches_the_fillet_at_30_degrees():
    gear = make(30, 10.0)
    slope = np.interp(coupled.root_section(gear)[2], *(np.ravel(v)[::-1] for v in _fillet_slope(gear)))
    assert_allclose(math.degrees(math.atan(-slope)), 30, atol=0.05)


def _fillet_slope(gear):
    part = along_fillet(gear)
    order = np.argsort(-part.y)
    return part.y[order], part.slope[order]


def test_section_forces_balance_the_tooth_force():
    """About the gear's centre a unit load on an involute has the moment r_b, wherever it is and wherever it is cut."""
    gear = make(25, 8.0)
    roll = np.linspace(gear.roll_f, gear.roll_a, 7)
    for height in (gear.r_f, 0.9 * gear.r_f):
        shear, normal, moment = coupled.section_loads(gear, roll, height)
        assert_allclose(np.hypot(shear, normal), 1, rtol=1e-12)
        assert_allclose(moment - height * shear, gear.r_b, rtol=1e-12)
    angle, force = annulus.arc_tractions(gear.r_f, root_half_angle(gear))
    across, up = np.einsum("an,adm->dnm", coupled.body_loads(gear, roll), force)
    turning = gear.r_f * (np.sin(angle) * up - np.cos(angle) * across).sum(axis=1)
    assert_allclose(turning, gear.r_b, rtol=1e-12, err_msg="tractions on the root circle")


# ------------------------------------------------------------------------------------------------ body


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


def test_harmonic_zero_is_lames_ring_and_a_turned_ring():
    inner, outer = 6.0, 10.0
    radial, around = np.diag(outer / (2 * STEEL.shear_modulus) * annulus.harmonic_flexibility([0], inner / outer, STEEL.nu)[0])
    # Lame: u = A r + B / r with u(inner) = 0 and sigma_r(outer) = 1
    lam, mu = STEEL.lame("plane strain")
    a, b = np.linalg.solve([[inner, 1 / inner], [2 * (lam + mu), -2 * mu / outer**2]], [0.0, 1.0])
    assert_allclose(radial, a * outer + b / outer, rtol=1e-12)
    torque = 2 * math.pi * outer**2  # of a unit shear stress
    twist = torque / (4 * math.pi * mu) * (1 / inner**2 - 1 / outer**2)
    assert_allclose(around, twist * outer, rtol=1e-12)


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
    want = load.T @ Body(mesh, STEEL).solve(load)
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


# ------------------------------------------------------------------------------------------------ contact and gear


def test_local_part_is_the_strain_under_an_elliptic_pressure():
    """Johnson's stresses on the axis (eqs. 4.46) integrated down to the centre-line, with what the line contact adds."""
    gear, a = make(25, 8.0), 0.003
    for roll in (gear.roll_f + 1.0, gear.roll_a):
        beta = roll / gear.r_b - gear.base_half_angle
        depth = cartesian(*flank(gear, roll))[0] / math.cos(beta)
        peak = 2 / (math.pi * a)

        def strain(z, peak=peak):
            root = math.hypot(a, z)
            across = -peak / a * ((a**2 + 2 * z**2) / root - 2 * z)
            return (1 - STEEL.nu**2) / STEEL.E * (peak * a / root + STEEL.nu / (1 - STEEL.nu) * across)

        want = quad(strain, 0, 20 * a, epsrel=1e-10)[0] + quad(strain, 20 * a, depth, epsrel=1e-10, limit=200)[0]
        added = half_plane(STEEL) * (math.log(2 / a) + 0.5)
        assert_allclose(coupled.local_remainder(gear, STEEL, roll) + added, want, rtol=1e-5)


def test_flexibility_is_what_its_parts_are():
    gear = make(25, 8.0)
    got = coupled.flexibility(gear, STEEL, neighbours=2)
    roll = np.linspace(1.1 * gear.roll_f, 0.98 * gear.roll_a, 9)
    want = coupled.components(gear, STEEL, roll).total + coupled.local_remainder(gear, STEEL, roll)
    assert_allclose(got.matrix(roll[:, None], [0])[:, 0, 0], want, rtol=1e-4)
    first, second = roll[1:3]
    forces = [coupled.body_loads(gear, r)[:, 0] for r in (first, second)]
    want = forces[1] @ coupled.body(gear, STEEL, "plane strain", 2)[2] @ forces[0]
    assert_allclose(got.matrix(np.array([first, second]), [5, 7])[0, 1], want, rtol=1e-4)
    assert_allclose(got.matrix(np.array([second, first]), [7, 5])[0, 1], want, rtol=1e-4)


def test_ring_is_refused():
    ring = gf.Gear(z=72, m_n=2.0, alpha_n=math.radians(20), b=WIDTH, r_rim=90.0, addendum=0.7, tip_radius=0.25)
    with pytest.raises(ValueError, match="no ring"):
        coupled.flexibility(ring, STEEL)


def test_textbook_rung_is_the_textbook():
    pair = gf.GearPair(make(21, 10.0), make(31, 13.0))
    rungs = ladder(pair, 150 * WIDTH, STEEL, phases=8)
    assert [r.name for r in rungs] == ["textbook", "line contact", "plane strain", "tapered beam", "annulus", "coupled", "fe"]
    assert_allclose(rungs[0].k, gf.mesh_stiffness(pair, 150 * WIDTH, STEEL, method="textbook", phases=8).k, rtol=1e-12)
    assert_allclose(rungs[4].single, rungs[5].single, rtol=1e-9, err_msg="one tooth has no neighbour to feel")
    assert rungs[5].double < 0.9 * rungs[4].double


PAIRS = {
    "19/48": (make(19, 13.0, m_n=3.175), make(48, 30.0, m_n=3.175), gf.Material(E=206.8e3, nu=0.3), 200.0),
    "25/30": (make(25, 10.0), make(30, 12.0), STEEL, 150.0),
    "18/27": (make(18, 9.0, beta=math.radians(16)), make(27, 12.0, beta=math.radians(16)), STEEL, 127.0),
    "21/31": (make(21, 10.0), make(31, 13.0), STEEL, 150.0),
}


@pytest.mark.parametrize("name", PAIRS)
def test_below_three_percent_of_finite_elements(name):
    """At every phase, not only in the mean; standard racks, solid bodies."""
    one, two, material, line_load = PAIRS[name]
    *rungs, reference = ladder(gf.GearPair(one, two), line_load * WIDTH, material)
    for rung in rungs:
        print(name, f"{rung.name:14s}", *(f"{100 * e:+7.2f} %" for e in rung.error(reference)))
    *zones, largest = rungs[-1].error(reference)
    assert np.abs(zones).max() < 0.02
    assert largest < 0.03
