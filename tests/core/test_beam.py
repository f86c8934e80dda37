"""Shafts against the formulas of textbooks, shear left out or added by hand."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.core.supports.beam import ShaftPiece

pytestmark = pytest.mark.quick

L, D = 100.0, 12.0
EI = 207e3 * math.pi * D**4 / 64


def shaft(gear, bearings=(0.0, L), segments=((L, D),), **more):
    return gf.Shaft(segments=segments, bearings=bearings, gear=gear, material=STEEL, **more)


def shear(section, material=STEEL):
    return 1 / (section.shear_factor(material.nu) * material.shear_modulus * section.area)


@pytest.mark.parametrize("a", [20.0, 50.0, 70.0])
def test_between_bearings(a):
    """Roark, Formulas for Stress and Strain, Table 8.1 case 1e; shear of both reactions adds a b / L."""
    b, found = L - a, shaft(a).support()
    bend, slip = a**2 * b**2 / (3 * EI * L), a * b / L * shear(ShaftPiece(L, D))
    assert_allclose(1 / found.radial, bend + slip, rtol=1e-10)
    assert_allclose(found.coupling, a * b * (b - a) / (3 * EI * L), rtol=1e-9, atol=1e-18)
    assert_allclose(1 / found.tilt, (a**3 + b**3) / (3 * EI * L**2) + shear(ShaftPiece(L, D)) / L, rtol=1e-10)


def test_overhung():
    """A gear outside of both bearings: span s, overhang c; F c**2 (s + c) / (3 E I)."""
    span, c = 60.0, 40.0
    found, slip = shaft(L, (0.0, span)).support(), shear(ShaftPiece(L, D))
    assert_allclose(1 / found.radial, c**2 * (span + c) / (3 * EI) + (c + c**2 / span) * slip, rtol=1e-10)
    assert_allclose(found.coupling, c * (2 * span + 3 * c) / (6 * EI) + c / span * slip, rtol=1e-10)
    assert found.coupling > 0  # the free end, z = b, gives way more
    left = gf.Shaft(segments=[(L, D)], bearings=(40.0, L), gear=0.0, material=STEEL).support()
    assert_allclose([left.radial, left.tilt, left.coupling], [found.radial, found.tilt, -found.coupling], rtol=1e-10)


def test_steps_and_bores_are_cut_anywhere():
    one = shaft(37.0, segments=[(L, D, 4.0)], torque=100.0)
    cut = shaft(37.0, segments=[(12.0, D, 4.0), (25.0, D, 4.0), (63.0, D, 4.0)], torque=100.0)
    for name in ("radial", "tilt", "torsion", "coupling"):
        assert_allclose(getattr(cut.support(), name), getattr(one.support(), name), rtol=1e-9)
    polar = math.pi / 32 * (D**4 - 4.0**4)
    assert_allclose(1 / one.support().torsion, 63.0 / (STEEL.shear_modulus * polar), rtol=1e-12)


def test_a_stepped_shaft_by_castigliano():
    """Energy of bending and shear integrated piece by piece, of a force at the gear."""
    segments, at = [(30.0, 10.0), (40.0, 16.0), (30.0, 12.0)], 45.0
    x, w = np.polynomial.legendre.leggauss(6)
    energy = 0.0
    for low, high, d in ((0, 30, 10.0), (30, 45, 16.0), (45, 70, 16.0), (70, 100, 12.0)):
        place, part = (low + high) / 2 + (high - low) / 2 * x, (high - low) / 2 * w
        moment = np.where(place < at, place * (L - at) / L, (L - place) * at / L)
        push = (L - at) / L if high <= at else at / L
        energy += part @ moment**2 / (207e3 * math.pi * d**4 / 64) + (high - low) * push**2 * shear(ShaftPiece(1.0, d))
    assert_allclose(1 / shaft(at, segments=segments).support().radial, energy, rtol=1e-10)


def test_bearings_are_springs_in_series():
    soft = shaft(30.0, bearing_stiffness=(2e4, 5e4)).support()
    rigid = shaft(30.0).support()
    assert_allclose(1 / soft.radial - 1 / rigid.radial, 0.7**2 / 2e4 + 0.3**2 / 5e4, rtol=1e-9)
    assert_allclose(soft.coupling - rigid.coupling, -0.7 / L / 2e4 + 0.3 / L / 5e4, rtol=1e-9)
    assert_allclose(1 / soft.tilt - 1 / rigid.tilt, (1 / 2e4 + 1 / 5e4) / L**2, rtol=1e-9)


def test_shear_factors_of_cowper():
    assert ShaftPiece(1.0, 2.0).shear_factor(0.3) == pytest.approx(0.8864, abs=1e-4)  # his table, circle
    assert ShaftPiece(1.0, 2.0, 2.0 - 1e-9).shear_factor(0.3) == pytest.approx(2 * 1.3 / (4 + 3 * 0.3), rel=1e-6)  # thin tube


@pytest.mark.parametrize("bore", [0.2, 0.5, 0.8])
def test_shear_of_tubes_without_contraction(bore):
    """With nu = 0 the stress is a gradient, of V / I cos(t) f(r), f = A r + B / r - r**3 / 8 with f' = 0 at both edges.

    Its energy is that of the mean stress over the shear factor.
    """
    a, b = 1.0, bore
    big, small = 3 / 8 * (a**2 + b**2), 3 / 8 * a**2 * b**2
    energy = math.pi * (big * (a**4 - b**4) / 4 + small * (a**2 - b**2) / 2 - (a**6 - b**6) / 48)  # of (V / I)**2
    tube = ShaftPiece(1.0, 2 * a, 2 * b)
    assert tube.shear_factor(0.0) == pytest.approx(tube.second_moment**2 / (tube.area * energy), rel=1e-12)


def test_a_shaft_seen_from_its_other_end():
    """The same springs, tilted the other way; each part of it where it was, counted from the other end; twice is once."""
    one = shaft(30.0, (10.0, 90.0), ((40.0, 10.0), (60.0, 14.0, 4.0)), torque=95.0, bearing_stiffness=2e5)
    other = one.turned()
    springs, mirrored = one.support(), other.support()
    for name in ("radial", "tilt", "torsion"):
        assert_allclose(getattr(mirrored, name), getattr(springs, name), rtol=1e-9)
    assert_allclose(mirrored.coupling, -springs.coupling, rtol=1e-9)
    assert abs(springs.coupling) * math.sqrt(springs.radial * springs.tilt) > 0.05
    assert (other.gear, other.torque, sorted(other.bearings)) == (70.0, 5.0, [10.0, 90.0])
    assert other.turned() == one


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"segments": []}, "give its parts"),
        ({"segments": [(100.0, 12.0, 12.0)]}, "part 1 is .* bore smaller than its diameter"),
        ({"segments": [(50.0, 12.0), (50.0, 1e5)]}, "no shaft is 100 times thicker"),
        ({"segments": [(100.0,)]}, "give .length, diameter. or"),
        ({"bearings": (0.0, 120.0)}, "bearings = 120.0, but the shaft reaches from 0 to 100 mm"),
        ({"bearings": (30.0, 30.0)}, "both bearings at 30 mm"),
        ({"bearings": 30.0}, "give two positions"),
        ({"gear": -1.0}, "gear = -1.0, but the shaft"),
        ({"torque": math.nan}, "torque = nan"),
        ({"bearing_stiffness": (1e5, 0.0)}, "give two stiffnesses .* > 0"),
        ({"material": 207e3}, "give a Material"),
    ],
)
def test_impossible_shafts_are_refused(given, message):
    usual = {"segments": [(L, D)], "bearings": (0.0, L), "gear": 50.0, "material": STEEL}
    with pytest.raises(ValueError, match=message):
        gf.Shaft(**(usual | given))
