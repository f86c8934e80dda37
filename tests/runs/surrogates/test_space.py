"""Ranges of a surrogate: what is refused, and what a point of them stands for."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.runs.surrogates.space import space_of

pytestmark = pytest.mark.quick


def test_a_point_is_gears_force_and_crack(pair):
    space = space_of(pair, {"force": (500.0, 4000.0), "z_1": (20, 24), "x_1": (-0.1, 0.3), "bore_1": 0.5, "level": (0.1, 0.6)})
    case = space.case({"force": 800.0, "z_1": 23.0, "x_1": 0.2, "level": 0.25}, gf.Material())
    made = case.pair
    assert (made.gear_1.z, made.gear_1.x, case.force) == (23, 0.2, 800.0)
    assert_allclose(made.gear_1.r_bore, 0.5 * made.gear_1.r_f)
    assert_allclose(made.backlash, 0.0, atol=1e-9)
    assert case.damage == {"pinion": (gf.Crack(level=0.25),)}


def test_ends_of_the_ranges_are_scaled_to_one(pair):
    space = space_of(pair, {"force": (500.0, 4500.0), "z_2": (30, 33)})
    assert_allclose(space.scaled([[500.0, 30.0], [1500.0, 33.0], [4500.0, 31.5]]), [[-1, -1], [0, 1], [1, 0]], atol=1e-12)
    drawn = [space.at(np.array([u, u])) for u in np.linspace(0, 1, 9)]
    assert {point["z_2"] for point in drawn} == {30.0, 31.0, 32.0, 33.0}
    assert_allclose(drawn[4]["force"], math.sqrt(500 * 4500))


@pytest.mark.parametrize(
    ("inputs", "said"),
    [
        ({"force": (500.0, 4000.0), "colour": 1.0}, "'colour' is unknown"),
        ({"level": (0.1, 0.5)}, "no 'force'"),
        ({"force": 2000.0}, "nothing varies"),
        ({"force": (4000.0, 500.0)}, "the upper end must be larger"),
        ({"force": (0.0, 500.0)}, "forces > 0"),
        ({"force": "much"}, "give a range"),
        ({"force": (500.0, 4000.0), "z_1": (20.5, 22)}, "whole numbers"),
        ({"force": (500.0, 4000.0), "angle": (0.5, 0.9)}, "no 'level'"),
        ([("force", 1.0)], "give a dict"),
    ],
)
def test_impossible_ranges_are_refused(pair, inputs, said):
    with pytest.raises(ValueError, match=said):
        space_of(pair, inputs)


def test_pairs_without_a_section_of_their_own_are_refused():
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    helical = gf.GearPair(gf.Gear(z=21, r_bore=7.4, beta=0.2, **rack), gf.Gear(z=31, r_bore=11.4, beta=-0.2, **rack))
    with pytest.raises(ValueError, match="helical"):
        space_of(helical, {"force": (500.0, 4000.0)})
    wide = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack), 52.1)
    with pytest.raises(ValueError, match="centre distance"):
        space_of(wide, {"force": (500.0, 4000.0), "x_1": (0.0, 0.2)})
    assert space_of(wide, {"force": (500.0, 4000.0)}).case({"force": 900.0}, gf.Material()).pair.a == 52.1
