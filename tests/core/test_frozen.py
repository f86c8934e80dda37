"""A `Case`, a `Solve` and a `PlanetaryCase` do not change with what they were given, are equal and have a hash."""

import copy
import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.flexibility.energy.ritz.plane import flexibility as ritz_flexibility

pytestmark = pytest.mark.quick


def inputs(pair):
    """Everything mutable that a case takes, in fresh objects."""
    low, high = sorted((pair.gear_1.roll_f, pair.gear_1.roll_a))
    flank = gf.Flank(table=np.array([[low - 1, high + 1], [0.0, 0.01]]), pitch=np.linspace(0, 0.01, pair.gear_1.z))
    return {
        "pair": pair,
        "force": [1000.0, 2000.0],
        "material": [STEEL, STEEL],
        "damage": {"pinion": [gf.Crack(level=0.3, ends=[1.0, 1.0])], "wheel": []},
        "flanks": {"pinion": flank, "wheel": None},
        "misalignment": gf.Misalignment(F_beta_x=0.002),
        "supports": {"wheel": gf.Shaft([[100.0, 22.0]], [0.0, 100.0], 50.0, STEEL, bearing_stiffness=[1e6, 1e6])},
    }


def test_a_case_does_not_change_with_what_it_was_given(pair):
    given = {"pinion": gf.Flank(profile_crowning=0.002)}
    forces = [1000.0, 2000.0]
    case = gf.Case(pair, forces, STEEL, flanks=given)
    text, k = repr(case), gf.solve(case, gf.Solve(phases=4))[1].k
    given["pinion"], forces[1] = gf.Flank(profile_crowning=0.02), 9000.0
    assert repr(case) == text
    assert_allclose(gf.solve(replace(case), gf.Solve(phases=4))[1].k, k, rtol=1e-12)
    array = np.array([1000.0, 2000.0])
    case = gf.Case(pair, array, STEEL)
    array[0] = 1.0
    assert case.force == case.forces == (1000.0, 2000.0)
    with pytest.raises(TypeError):
        case.flanks["pinion"] = None
    damage = {"pinion": [gf.Crack(level=0.2)]}
    case = gf.Case(pair, 1000.0, STEEL, damage=damage)
    damage["pinion"].append(gf.Crack(level=0.2, tooth=3))
    assert len(case.damage["pinion"]) == len(case.cracks[0]) == 1


def test_cases_that_state_the_same_are_equal(pair):
    one, two = gf.Case(**inputs(pair)), gf.Case(**inputs(pair))
    assert one == two
    assert hash(one) == hash(two)
    for name, value in {"force": 1000.0, "damage": None, "flanks": None, "misalignment": None, "supports": None}.items():
        assert replace(one, **{name: value}) != one
    assert gf.Case(pair, 100.0, STEEL, damage={"pinion": []}, flanks={}) == gf.Case(pair, 100.0, (STEEL, STEEL))
    torque = 1e-3 * 100.0 * pair.gear_1.r_b
    assert gf.Case(pair, torque=torque, material=STEEL).force == pytest.approx(100.0)
    for again in (pickle.loads(pickle.dumps(one)), copy.deepcopy(one), gf.Case(**one.as_dict())):
        assert again == one
        assert hash(again) == hash(one)


def test_a_solve_does_not_change_either():
    phases, variants = np.array([0.1, 0.6]), {"root": [1.0, 2.0]}
    one, same = (gf.Solve(method="textbook", phases=phases.copy(), variants=copy.deepcopy(variants)) for _ in range(2))
    how = gf.Solve(method="textbook", phases=phases, variants=variants)
    phases[0], variants["root"][0] = 0.3, 9.0
    assert how == one == same
    assert hash(how) == hash(one)
    assert how.phases == (0.1, 0.6)
    assert pickle.loads(pickle.dumps(how)) == how
    own = gf.OwnFlexibility(ritz_flexibility(gf.Gear(z=21, m_n=2.0, alpha_n=0.35, b=20.0, r_bore=7.4), STEEL))
    assert hash(gf.Solve(own)) == hash(gf.Solve(own))
    assert gf.Solve(own) == gf.Solve(own) != gf.Solve()


def test_planetary_cases():
    rack = {"m_n": 2.0, "alpha_n": 0.35, "b": 20.0}
    sun, planet = gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack)
    gears = gf.PlanetarySet(sun, planet, gf.Gear(z=83, r_rim=95.0, rack_tip_radius=0.2, addendum=0.9, **rack), 1)
    given = {"damage": {"sun": [gf.Crack(level=0.2)]}, "flanks": {"planet": gf.Flank(profile_crowning=0.002)}}
    errors, angles = np.zeros((3, 2)), [2 * math.pi * k / 104 for k in (0, 35, 69)]
    one, two = (
        gf.PlanetaryCase(
            gears,
            1000.0,
            [STEEL] * 3,
            planet_angles=[2 * math.pi * k / 104 for k in (0, 35, 69)],
            errors=errors,
            **copy.deepcopy(given),
        )
        for _ in range(2)
    )
    assert one == two
    assert hash(one) == hash(two)
    errors[0, 0] = 0.01
    given["damage"]["sun"].append(gf.Crack(level=0.2, tooth=1))
    assert one == two != gf.PlanetaryCase(gears, 1000.0, STEEL, planet_angles=angles, errors=errors, **given)


def test_masked_values_are_refused(pair):
    hole = np.ma.array([1000.0, 2000.0], mask=[False, True])
    with pytest.raises(ValueError, match="force has masked values"):
        gf.Case(pair, hole, STEEL)
    with pytest.raises(ValueError, match="phases"):
        gf.mesh_stiffness(pair, 1000.0, STEEL, phases=np.ma.array([0.1, 0.2], mask=[True, False]))
    with pytest.raises(ValueError, match="pitch needs"):
        gf.Flank(pitch=np.ma.array(np.zeros(21), mask=np.arange(21) == 4))
    grid = np.ma.array(np.zeros((2, 2)), mask=np.eye(2, dtype=bool))
    with pytest.raises(ValueError, match="topography has holes"):
        gf.Flank(topography=([0.0, 30.0], [0.0, 20.0], grid))
    assert gf.Case(pair, np.ma.array([1000.0, 2000.0]), STEEL).force == (1000.0, 2000.0)


def test_a_case_as_a_mapping_is_deprecated(pair):
    case = gf.Case(pair, 1000.0, STEEL)
    for use in (lambda: dict(**case), lambda: case | {"face": None}):
        with pytest.warns(DeprecationWarning, match="case.as_dict"):
            assert use()["force"] == 1000.0
    with pytest.warns(DeprecationWarning, match="case.as_dict"):
        assert case["pair"] == pair
    assert list(case.as_dict()) == ["pair", "force", "material", "face", "groove"]
