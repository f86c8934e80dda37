"""The coupled closed form: exact wedge and contact solutions for its parts, finite elements for the whole."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad
from usual import STEEL

import gearfe as gf
from gearfe.flexibility.energy.closed import annulus, coupled
from gearfe.flexibility.energy.closed.beam import along_fillet, along_flank
from gearfe.flexibility.finite_elements import fe
from gearfe.flexibility.hertz import half_plane
from gearfe.geometry.pair.contacts import contacts
from gearfe.geometry.tooth.profile import cartesian, fillet, flank, form_point, root_half_angle, tangent_point

WIDTH = 20.0


def make(z, r_bore, **numbers):
    return gf.Gear(**({"z": z, "m_n": 2.0, "alpha_n": math.radians(20), "b": WIDTH, "r_bore": r_bore} | numbers))


def thin(z, ratio, **numbers):
    gear = make(z, 1.0, **numbers)
    return replace(gear, r_bore=ratio * gear.r_f)


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


def shear_stress(x, half, *section):
    a, b, c = coupled.shear_parts(half, *section)
    return a * (half**2 - x**2) + b + c * x


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
        got = shear_stress(x, half, -math.tan(half_angle), shear, normal, moment)
        errors.append(np.abs(got - tau).max() / np.abs(tau).max())
    rates = np.log2(np.array(errors[1:]) / errors[:-1])
    print(load, errors, rates)
    assert errors[1] < 0.02
    assert_allclose(rates, 2, atol=0.1)


@pytest.mark.parametrize("gear", [make(14, 5.0, x=0.3), make(40, 15.0)], ids=["z14", "z40"])
def test_profile_slopes_are_those_of_the_curve(gear):
    roll = np.array([0.9 * gear.roll_a])
    for part in (along_fillet(gear, tangent_point(gear)), along_flank(gear, roll)):
        x, y, slope, step = (np.atleast_2d(v)[0] for v in (part.x, part.y, part.slope, part.step))
        order = np.argsort(y)
        change = np.diff(x[order])
        assert_allclose(change, np.diff(y[order]) * (slope[order][1:] + slope[order][:-1]) / 2, atol=2e-3 * np.abs(change).max())
        assert (step > 0).all()
    bottom, top = cartesian(*fillet(gear, tangent_point(gear)))[1], cartesian(*flank(gear, roll))[1, 0]
    total = along_fillet(gear, tangent_point(gear)).step.sum() + along_flank(gear, roll).step.sum()
    joint = cartesian(*fillet(gear, form_point(gear)[0]))[1] - cartesian(*flank(gear, gear.roll_f))[1]
    assert_allclose(total, top - bottom - joint, rtol=1e-8)


@pytest.mark.parametrize("state", ["plane strain", "plane stress"])
@pytest.mark.parametrize("gear", [make(14, 5.0, x=0.3), make(40, 15.0)], ids=["z14", "z40"])
def test_beam_is_twice_its_energy(gear, state):
    """Section forces from statics at the load point, slopes by differences, trapezoids over a fine profile."""
    roll = 0.93 * gear.roll_a
    beta = roll / gear.r_b - gear.base_half_angle
    x_f, y_f = cartesian(*flank(gear, roll))
    lower = cartesian(*fillet(gear, np.linspace(tangent_point(gear), form_point(gear)[0], 4001)))
    upper = cartesian(*flank(gear, np.linspace(gear.roll_f, roll, 4001)))
    want = np.zeros(3)
    for half, y in (lower, upper):
        slope = np.gradient(half, y, edge_order=2)
        moment = math.cos(beta) * (y_f - y) - math.sin(beta) * x_f
        points, weights = np.polynomial.legendre.leggauss(6)
        tau = shear_stress(half[:, None] * points, *(v[:, None] for v in (half, slope)), -math.cos(beta),
                                   -math.sin(beta), moment[:, None])  # fmt: skip
        stretch = STEEL.E / (1 - STEEL.nu**2) if state == "plane strain" else STEEL.E
        want += [
            np.trapezoid(moment**2 / (stretch * 2 * half**3 / 3), y),
            np.trapezoid((tau**2 @ weights) * half / STEEL.shear_modulus, y),
            np.trapezoid(math.sin(beta) ** 2 / (stretch * 2 * half), y),
        ]
    assert_allclose(coupled.beam(gear, STEEL, [roll], state=state)[:, 0], want, rtol=1e-5)


def test_root_section_touches_the_fillet_at_30_degrees():
    gear = make(30, 10.0)
    slope = np.interp(cartesian(*fillet(gear, tangent_point(gear)))[1], *(np.ravel(v)[::-1] for v in _fillet_slope(gear)))
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


PAIRS = {
    "19/48": (make(19, 13.0, m_n=3.175), make(48, 30.0, m_n=3.175), gf.Material(E=206.8e3, nu=0.3), 200.0),
    "25/30": (make(25, 10.0), make(30, 12.0), STEEL, 150.0),
    "18/27": (make(18, 9.0, beta=math.radians(16)), make(27, 12.0, beta=math.radians(16)), STEEL, 127.0),
    "21/31": (make(21, 10.0), make(31, 13.0), STEEL, 150.0),
}


def errors(pair, force, material, phases=64):
    """Errors of `textbook` and of `coupled` in single and in double contact, of their mean, and the largest, rows ``(2, 4)``.

    Against finite elements, all without contact beyond the path of contact.
    """
    phase = np.arange(phases) / phases
    single = np.isfinite(contacts(pair, phase, extended=False).gap).sum(axis=1) == 1
    textbook, own, want = (
        gf.mesh_stiffness(pair, force, material, method=method, phases=phase, **more).k
        for method, more in (("textbook", {}), ("coupled", {"extended": False}), ("fe", {"extended": False}))
    )
    zones = single, ~single, slice(None)
    return np.array([[*(k[z].mean() / want[z].mean() - 1 for z in zones), np.abs(k / want - 1).max()] for k in (textbook, own)])


@pytest.mark.slow
@pytest.mark.parametrize("name", PAIRS)
def test_below_three_percent_of_finite_elements(name):
    """At every phase, not only on average; standard racks, solid bodies."""
    one, two, material, line_load = PAIRS[name]
    found = errors(gf.GearPair(one, two), line_load * WIDTH, material)
    print(name, "textbook and coupled [%]", 100 * found)
    *zones, largest = found[1]
    assert np.abs(zones).max() < 0.02
    assert largest < 0.03


LIMITS = {  # gear, and the largest error there: wide roots are hardly beams, and a rim thinner than a tooth is no ring
    "many teeth": (thin(60, 0.5), 0.036),
    "alpha 25": (thin(30, 0.5, alpha_n=math.radians(25), rack_tip_radius=0.3), 0.062),
    "sharp fillet": (thin(30, 0.5, rack_tip_radius=0.2), 0.042),
    "thin rim": (thin(18, 0.85), 0.053),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LIMITS)
def test_beyond_its_range(name):
    """A recorded verdict: this closed form is not within 3 % there, and is wrong by this much."""
    gear, recorded = LIMITS[name]
    largest = errors(gf.GearPair(gear, gear), 150 * WIDTH, STEEL, phases=8)[1, 3]
    assert largest > 0.03
    assert_allclose(largest, recorded, atol=2e-3)


@pytest.mark.parametrize(("ratio", "least", "most"), [(0.4, -0.03, 0.03), (0.9, -0.27, -0.22)])
def test_coupling_to_the_next_tooth(ratio, least, most):
    """Within 3 % of finite elements on thick bodies; in a rim thinner than a tooth a recorded verdict, far too small."""
    gear = thin(20, ratio)
    ours, reference = (made.flexibility(gear, STEEL).far[0, 1] for made in (coupled, fe))
    low, high = gear.roll_f**2 / (2 * gear.r_b), gear.roll_a**2 / (2 * gear.r_b)
    arc = np.linspace(low, high, 7)[1:-1]
    error = ours.ev(arc, arc[::-1]) / reference.ev(arc, arc[::-1]) - 1
    print(ratio, np.round(100 * error, 1))
    assert error.min() > least
    assert error.max() < most


@pytest.mark.parametrize("line_load", [30.0, 500.0])
def test_error_does_not_depend_on_the_load(line_load):
    """Line contact follows the load as in the elastic solution; a textbook contact stiffness cannot."""
    pair = gf.GearPair(PAIRS["21/31"][0], PAIRS["21/31"][1])
    moved = errors(pair, line_load * WIDTH, STEEL, phases=16) - errors(pair, 150 * WIDTH, STEEL, phases=16)
    textbook, own = np.abs(moved[:, 2])
    assert own < 2e-3
    assert textbook > 10 * own


def test_plane_stress_is_plane_strain_of_another_material():
    """Of E / (1 - nu**2) and nu / (1 - nu), in every plane problem: Timoshenko and Goodier, section 17."""
    nu = 0.3
    other = gf.Material(E=STEEL.E / (1 - nu**2), nu=nu / (1 - nu))
    gear, roll = make(25, 10.0), np.linspace(5.0, 12.0, 7)
    assert_allclose(
        coupled.local_remainder(gear, other, roll, state="plane stress"),
        coupled.local_remainder(gear, STEEL, roll, state="plane strain"),
        rtol=1e-12,
    )
