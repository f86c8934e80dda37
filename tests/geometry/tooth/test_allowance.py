"""Tooth thickness allowance: thinner teeth, the backlash that they have, and what stays as it is."""

import math
from dataclasses import replace

import numpy as np
import pytest

import gearfe as gf
from gearfe.geometry.tooth.profile import flank


def _pair(E_sn=(0.0, 0.0), beta=0.0, ring=False):
    rack = {"m_n": 3.0, "alpha_n": math.radians(20), "b": 20.0, "rack_tip_radius": 0.3}
    one = gf.Gear(z=21, x=0.2, r_bore=10.0, beta=beta, E_sn=E_sn[0], **rack)
    held = {"r_rim": 115.0, "addendum": 0.8} if ring else {"r_bore": 15.0}
    two = gf.Gear(z=63 if ring else 34, x=0.3, beta=-beta, E_sn=E_sn[1], **held, **rack)
    return gf.GearPair(one, two)


@pytest.mark.parametrize("ring", [False, True])
@pytest.mark.parametrize("beta", [0.0, 0.3])
def test_backlash_is_the_sum_of_both_allowances_where_the_teeth_are_pressed_together(ring, beta):
    """Along the line of action: the transverse thickness at the pitch circle, times the cosine of the working angle."""
    plain, thin = _pair(beta=beta, ring=ring), _pair((-0.08, -0.05), beta, ring)
    assert thin.a == plain.a
    assert abs(plain.backlash) < 1e-12
    at_reference = [0.08 / math.cos(beta), 0.05 / math.cos(beta)]  # transverse
    angles = [s / (2 * gear.r) for s, gear in zip(at_reference, (thin.gear_1, thin.gear_2), strict=True)]
    expected = 2 * (angles[0] * thin.gear_1.r_b + angles[1] * thin.gear_2.r_b)
    assert math.isclose(thin.backlash, expected, rel_tol=1e-12)
    assert thin.gear_1.r_a == plain.gear_1.r_a
    assert thin.gear_2.r_a == plain.gear_2.r_a


def test_the_flank_lies_half_of_the_allowance_inside():
    plain, thin = _pair().gear_1, _pair((-0.08, 0.0)).gear_1
    roll = np.linspace(max(plain.roll_f, thin.roll_f), plain.roll_a, 5)
    turned = flank(plain, roll)[1] - flank(thin, roll)[1]
    assert np.allclose(np.abs(turned), 0.04 / plain.r, rtol=1e-9)


def test_a_gear_cut_with_the_generating_shift_is_the_same_gear():
    thin = _pair((-0.08, -0.05))
    typed = [
        replace(gear, x=gear.x_E, addendum=gear.addendum + gear.x - gear.x_E, E_sn=0.0) for gear in (thin.gear_1, thin.gear_2)
    ]
    solve, steel = gf.Solve(method="ritz", phases=8), gf.Material(E=206e3, nu=0.3)
    curves = [gf.solve(gf.Case(pair, 2000.0, steel), solve).k for pair in (thin, gf.GearPair(*typed, a=thin.a))]
    assert np.allclose(*curves, rtol=1e-12)
    assert curves[0].mean() < 0.99 * gf.solve(gf.Case(_pair(), 2000.0, steel), solve).k.mean()


def test_teeth_that_are_too_thick_are_refused():
    with pytest.raises(ValueError, match=r"overlap by 0\.04511 mm along the line of action"):
        _pair((0.048, 0.0))
