"""Loads mirrored in free end faces: their integrals, and narrow spur gears against plane strain and plane stress."""

import math

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.flexibility.end_faces import edge_factor, mirrored_patches
from gearfe.flexibility.halfspace import half_space, hat_distance, modes, pair_kernel
from gearfe.flexibility.hertz import half_plane

RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
PHASES = [0.05, 0.2, 0.5, 0.8]


def squared(width, count, power):
    """Gauss points and weights over 0..width, dense near 0."""
    at, weight = leggauss(count)
    u = (1 + at) / 2
    return width * u**power, width * weight / 2 * power * u ** (power - 1)


def test_mirrored_patches_are_their_integral():
    knots, width, stretch = np.array([[0.0, 0.3, 0.7], [0.5, 1.0, 1.1], [1.2, 1.6, 1.9]]).T, 5.0, 1.1
    z, weight = squared(width, 60, 3)
    q = (z[:, None] + z).ravel()
    distance = hat_distance(knots, np.zeros((3, 3, q.size)), stretch * q).reshape(3, 3, z.size, z.size)
    want = 0.0
    for turned in (z, width - z):
        carried = modes(turned, width, 3) * weight[:, None]
        want = want + np.einsum("ijzy,za,yb->iajb", distance, carried, carried, optimize=True)
    assert_allclose(mirrored_patches(knots, width, 3, stretch), want, rtol=1e-6, atol=1e-7)


def test_a_cell_and_an_image_are_their_integral():
    edge, x = np.array([0.0, 0.1, 0.4, 1.0]), 0.02
    low, high = edge[:-1], edge[1:]
    i, j = (part.ravel() for part in np.indices((3, 3)))
    got = pair_kernel((low, high), i, j, np.full(3, x), (-high, -low))
    at, weight = squared(1.0, 40, 2)
    for one, two, value in zip(i, j, got, strict=True):
        q = (low[one] + at * (high - low)[one])[:, None] + low[two] + at * (high - low)[two]
        assert value == pytest.approx((weight[:, None] * weight / np.hypot(q, x)).sum(), rel=1e-4)


@pytest.mark.parametrize("nu", [0.0, 0.25, 0.45])
def test_a_line_load_is_in_plane_stress_on_the_end_face(nu):
    """Over half a line the mean of 1 / R gives the logarithm once, over a whole line twice: itself and its image make that up."""
    material = gf.Material(E=207e3, nu=nu)
    assert_allclose(2 * half_space(material), half_plane(material, "plane strain"), rtol=1e-12)
    assert_allclose(half_space(material) * (1 + edge_factor(material)), half_plane(material, "plane stress"), rtol=1e-12)


def test_without_poissons_ratio_a_spur_gear_is_its_section_however_narrow():
    """No strain of the section asks for strain along the width: all three dimensions do is to be there."""
    soft, b = gf.Material(E=207e3, nu=0.0), 1.0
    assert edge_factor(soft) == 1.0
    pair = gf.GearPair(gf.Gear(z=18, r_bore=9.0, b=b, **RACK), gf.Gear(z=27, r_bore=14.0, b=b, **RACK))
    wide = gf.mesh_stiffness(pair, 100 * b, soft, method="ritz3d", phases=PHASES)
    plane = gf.mesh_stiffness(pair, 100 * b, soft, method="ritz", phases=PHASES)
    print("off", wide.k / plane.k - 1)
    assert_allclose(wide.k, plane.k, rtol=5e-4)


def test_a_narrow_spur_gear_is_nearly_in_plane_stress(steel):
    """Nearer than twice the contact's width a section is still held along the width: k is a little above plane stress."""
    b = 0.4
    pair = gf.GearPair(gf.Gear(z=18, r_bore=9.0, b=b, **RACK), gf.Gear(z=27, r_bore=14.0, b=b, **RACK))
    wide = gf.mesh_stiffness(pair, 100 * b, steel, method="ritz3d", phases=PHASES)
    stress = gf.mesh_stiffness(pair, 100 * b, steel, method="ritz", state="plane stress", phases=PHASES)
    print("over plane stress", wide.k / stress.k - 1)
    assert (wide.k > stress.k).all()
    assert_allclose(wide.k, stress.k, rtol=0.012)
