import math

import pytest
from numpy.testing import assert_allclose

import gearfe as gf

GEAR = gf.Gear(z=25, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=10.0)


def test_root_stress_is_linear_in_load_and_independent_of_stiffness(steel):
    one = gf.root_stress(GEAR, 25.0, 100.0, steel)
    assert_allclose(gf.root_stress(GEAR, 25.0, 200.0, gf.Material(E=1e4, nu=0.3)), 2 * one, rtol=1e-9)
    assert gf.root_stress(GEAR, 26.0, 100.0, steel) > one, "a higher load bends more"


def test_surface_and_centreline_are_different_measures(steel):
    assert gf.tooth_flexibility(GEAR, 25.0, steel) > 0
    assert gf.tooth_flexibility(GEAR, 26.5, steel, at="surface") > gf.tooth_flexibility(GEAR, 25.0, steel, at="surface")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda m: gf.root_stress(GEAR, 30.0, 100.0, m), "not on the involute flank"),
        (lambda m: gf.root_stress(GEAR, 25.0, 0.0, m), "line_load = 0.0"),
        (lambda m: gf.root_stress(GEAR, 25.0, 100.0, m, half_width=0.0), "half_width"),
        (lambda m: gf.tooth_flexibility(GEAR, 25.0, m, at="tip"), "centreline"),
        (lambda m: gf.tooth_flexibility(GEAR, math.nan, m), "radius = nan, but it needs a number"),
    ],
)
def test_bad_input(call, message, steel):
    with pytest.raises(ValueError, match=message):
        call(steel)
