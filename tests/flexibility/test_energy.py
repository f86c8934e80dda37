"""The closed forms against independent quadrature of the same integrals."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

import gearfe as gf
from gearfe.flexibility.energy.closed import herringbone_article, textbook
from gearfe.flexibility.energy.closed.beam import SAINSOT, sainsot
from gearfe.geometry.tooth.profile import cartesian, fillet, flank, form_point

pytestmark = pytest.mark.quick

STEEL = gf.Material(E=207e3, nu=0.3)


def make(z, **numbers):
    return gf.Gear(**({"z": z, "m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0, "r_bore": 0.4 * z} | numbers))


@pytest.mark.parametrize(
    "gear", [make(12), make(21), make(62), make(30, x=0.5), make(25, rack_tip_radius=0.0)], ids=lambda g: f"z{g.z}"
)
def test_beam_integrals_equal_independent_quadrature(gear):
    """Half thickness against height, by quad on the profile itself with numerical slopes."""
    roll = gear.roll_f + 0.6 * (gear.roll_a - gear.roll_f)
    radius, angle = flank(gear, roll)
    x_f, y_f = radius * math.sin(angle), radius * math.cos(angle)
    beta = roll / gear.r_b - gear.base_half_angle

    def along(profile, low, high, integrand):
        def f(t):
            h = 1e-5 * (high - low)
            x, y = profile(t)
            far = [profile(t + k * h)[1] for k in (-2, -1, 1, 2)]
            return integrand(x, y) * (far[0] - 8 * far[1] + 8 * far[2] - far[3]) / (12 * h)

        return quad(f, low, high, epsabs=0, epsrel=1e-11, limit=400)[0]

    def both(integrand):
        lower = along(lambda p: cartesian(*fillet(gear, p)), math.pi / 2, form_point(gear)[0], integrand)
        return lower + along(lambda s: cartesian(*flank(gear, s)), gear.roll_f, roll, integrand)

    got = textbook.components(gear, STEEL, roll)
    bending = both(lambda x, y: (math.cos(beta) * (y_f - y) - x_f * math.sin(beta)) ** 2 / (STEEL.E * 2 * x**3 / 3))
    area = both(lambda x, y: 1 / (2 * x))
    assert_allclose(got.bending, bending, rtol=1e-8)
    assert_allclose(got.shear, 1.2 * math.cos(beta) ** 2 * area / STEEL.shear_modulus, rtol=1e-8)
    assert_allclose(got.axial, math.sin(beta) ** 2 * area / STEEL.E, rtol=1e-8)


def test_sainsot_at_a_hand_computed_point():
    h, theta = 2.0, 0.1
    want = [a / theta**2 + b * h**2 + c * h / theta + d / theta + e * h + f for a, b, c, d, e, f in SAINSOT]
    assert_allclose(sainsot(h, theta), want, rtol=1e-14)
    assert_allclose(want[0], -5.574e-3 - 7.9944e-3 - 4.603e-3 + 0.047702 + 0.0542 + 6.8045, rtol=1e-12)


@pytest.mark.parametrize("z", [18, 60])
def test_published_beam_equals_quadrature_of_its_own_profile(z):
    """Involute from the larger of base and root circle; below the base circle a prism of constant thickness."""
    gear = make(z)
    roll = gear.roll_f + 0.5 * (gear.roll_a - gear.roll_f)
    radius, angle = flank(gear, roll)
    x_f, y_f = radius * math.sin(angle), radius * math.cos(angle)
    beta = roll / gear.r_b - gear.base_half_angle
    low = math.sqrt(max(gear.r_f**2 - gear.r_b**2, 0.0))

    def bending(x, y):
        return (math.cos(beta) * (y_f - y) - x_f * math.sin(beta)) ** 2 * 3 / (2 * STEEL.E * x**3)

    def on_flank(s):
        r, a = flank(gear, s)
        slope = s / gear.r_b * math.cos(s / gear.r_b - gear.base_half_angle)
        return bending(r * math.sin(a), r * math.cos(a)) * slope

    want = quad(on_flank, low, roll, epsrel=1e-11)[0]
    if gear.r_f < gear.r_b:
        x = gear.r_b * math.sin(gear.base_half_angle)
        bottom = math.sqrt(gear.r_f**2 - x**2)
        want += quad(lambda y: bending(x, y), bottom, gear.r_b * math.cos(gear.base_half_angle), epsrel=1e-11)[0]
    assert_allclose(herringbone_article.components(gear, STEEL, roll).bending, want, rtol=1e-8)


def test_published_contact_is_1_57_times_the_textbooks():
    from gearfe.flexibility.hertz import linear_hertz

    assert_allclose(herringbone_article.contact((STEEL, STEEL)) / linear_hertz((STEEL, STEEL)), math.pi / 2, rtol=1e-12)


def test_unknown_lever_is_refused():
    with pytest.raises(ValueError, match="crossing"):
        textbook.components(make(21), STEEL, np.array([8.0]), lever="middle")
