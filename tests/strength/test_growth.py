"""Polyline cracks, and their growth: paths do not depend on the step, K_II vanishes along them, life follows from the law."""

import math

import numpy as np
import pytest

import gearfe as gf
from gearfe.geometry.damage.crack import crack_path

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
GEAR = gf.Gear(z=21, r_bore=9.2, **RACK)
STEEL = gf.Material(E=206e3, nu=0.3)
CASE = gf.Case(gf.GearPair(GEAR, gf.Gear(z=31, r_bore=11.4, **RACK)), 2000.0, STEEL)


def polyline(crack, between=0):
    """The crack as a polyline, with corners on its first part."""
    start, *corners = crack_path(GEAR, crack).T
    inside = [start + (corners[0] - start) * k / (between + 1) for k in range(1, between + 1)]
    return gf.Crack(path=[tuple(point) for point in (*inside, *corners)])


@pytest.mark.parametrize("crack", [gf.Crack(length=1.5), gf.Crack(level=0.7, turning=True)], ids=["straight", "turning"])
def test_a_polyline_through_the_corners_of_a_crack_is_that_crack(crack):
    one, two = (gf.stress_intensity(GEAR, each, 22.0, 100.0, STEEL) for each in (crack, polyline(crack, 1)))
    assert pytest.approx(one.K_I, rel=2e-3) == two.K_I
    solve = gf.Solve(method="ritz", phases=np.array([0.2, 0.8]), span="tooth")
    k = [gf.solve(gf.Case(CASE.pair, 2000.0, STEEL, damage={"pinion": [each]}), solve).k for each in (crack, polyline(crack))]
    assert k[1] == pytest.approx(k[0], rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_both_methods_agree_on_random_polylines(seed):
    """The mesh is not shared; profile, local contact and load sharing are."""
    rng = np.random.default_rng(seed)
    x, y = crack_path(GEAR, gf.Crack(length=0.1)).T[0]
    points, heading = [], math.radians(rng.uniform(150, 250))
    for _ in range(rng.integers(2, 5)):
        heading += math.radians(rng.uniform(-25, 25))
        x, y = x + 0.5 * math.cos(heading), y + 0.5 * math.sin(heading)
        points.append((x, y))
    case = gf.Case(CASE.pair, 2000.0, STEEL, damage={"pinion": [gf.Crack(path=points)]})
    ritz, fe = (
        gf.solve(case, gf.Solve(method=method, phases=np.array([0.3, 1.0]), span="tooth", error=True))
        for method in ("ritz", "fe")
    )
    assert (np.abs(ritz.k - fe.k) <= ritz.error + fe.error).all()


def test_a_crack_turns_until_the_shear_vanishes_and_has_the_cycles_of_its_law():
    law = gf.ParisLaw(C=1e-13, m=3.0)
    growth = gf.grow_crack(CASE, gf.Crack(length=0.4, angle=math.radians(20)), step=0.2, steps=4, law=law, refine=0.7)
    assert growth.outcome == "unfinished"
    assert np.diff(growth.length) == pytest.approx(0.2)
    assert abs(growth.K_II[0]) > 0.2 * growth.K_I[0]
    assert np.abs(growth.K_II[2:] / growth.K_I[2:]).max() < 0.1
    swing = [growth.K_I[0], growth.K_I[1]]
    between = 0.2 / (law.C * np.array(swing) ** law.m)
    assert min(between) < growth.cycles[1] < max(between)
    assert (growth.K_min <= 0).all()


@pytest.mark.slow
def test_path_and_life_do_not_depend_on_the_step():
    law = gf.ParisLaw(C=1e-13, m=3.0, threshold=60.0)
    start = gf.Crack(length=0.3, angle=math.radians(60))
    coarse, fine = (gf.grow_crack(CASE, start, step=step, law=law) for step in (0.25, 0.125))
    assert coarse.outcome == fine.outcome == "tooth lost"
    assert coarse.cycles[-1] == pytest.approx(fine.cycles[-1], rel=1e-2)
    line = np.array(fine.cracks[-1].path)
    for point in coarse.cracks[-1].path[:-2]:
        assert np.hypot(*(line - point).T).min() < 0.08  # corners lie 0.125 mm apart
        assert abs(np.interp(-point[0], -line[:, 0], line[:, 1]) - point[1]) < 0.03


def test_a_threshold_arrests_and_toughness_ends():
    start = gf.Crack(length=0.4)
    assert gf.grow_crack(CASE, start, law=gf.ParisLaw(1e-13, 3.0, threshold=1e4, K_Ic=1e5), refine=0.7).outcome == "arrested"
    assert gf.grow_crack(CASE, start, law=gf.ParisLaw(1e-13, 3.0, K_Ic=10.0), refine=0.7).outcome == "fracture"


def test_the_wheel_and_the_unloaded_side_are_their_own():
    """A crack of the wheel grows under the load of the wheel; a crack on the unloaded side is pressed shut."""
    wheel = gf.grow_crack(CASE, gf.Crack(length=0.4), "wheel", steps=1, refine=0.7)
    pinion = gf.grow_crack(CASE, gf.Crack(length=0.4), steps=1, refine=0.7)
    assert wheel.K_I[0] != pytest.approx(pinion.K_I[0], rel=1e-3)
    shut = gf.grow_crack(CASE, gf.Crack(length=0.4, side="unloaded"), steps=1, refine=0.7)
    assert shut.K_min[0] < -0.5 * pinion.K_I[0]


@pytest.mark.parametrize(("change", "message"), [
    ({"path": []}, "give one or more corners"), ({"path": [(1.0, math.nan)]}, "finite numbers"), ({"path": 5}, "give corners"),
    ({"path": [(1.0, 17.0)], "level": 0.3}, "give one of them"), ({"path": [(1.0, 17.0)], "turning": True}, "given by its level"),
    ({"length": 1.0, "start": math.inf}, "or an arc in mm"),
])  # fmt: skip
def test_impossible_paths_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        gf.Crack(**change)


@pytest.mark.parametrize(("path", "message"), [
    ([(1.0, 9.0)], "reaches the held edge"), ([(5.0, 18.0)], "leaves the body"), ([(2.5, 30.0)], "leaves the body|reaches"),
])  # fmt: skip
def test_paths_that_leave_the_body_are_refused_by_their_gear(path, message):
    with pytest.raises(ValueError, match=message):
        gf.stress_intensity(GEAR, gf.Crack(path=path), 22.0, 100.0, STEEL)


def test_a_start_off_the_root_is_refused():
    with pytest.raises(ValueError, match=r"start = 9.0 mm, but the root of z = 21 goes from"):
        gf.stress_intensity(GEAR, gf.Crack(length=1.0, start=9.0), 22.0, 100.0, STEEL)
