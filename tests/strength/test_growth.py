"""Polyline cracks, and their growth: paths do not depend on the step, K_II vanishes along them, life follows from the law."""

import math

import numpy as np
import pytest
from usual import RACK

import gearfe as gf
from gearfe.app.cli import main
from gearfe.geometry.damage.crack import crack_path
from gearfe.geometry.tooth.profile import fillet_length
from gearfe.strength.kink import kinked, turn_angle
from gearfe.strength.tip_response import fe_response, ritz_response
from validation.shared.kept_rows import stored

GEAR = gf.Gear(z=21, r_bore=9.2, **RACK)
STEEL = gf.Material(E=206e3, nu=0.3)
CASE = gf.Case(gf.GearPair(GEAR, gf.Gear(z=31, r_bore=11.4, **RACK)), 2000.0, STEEL)


def random_polyline(seed):
    """A crack of two to four parts of 0.25 modules from the default start."""
    rng = np.random.default_rng(seed)
    x, y = crack_path(GEAR, gf.Crack(length=0.1)).T[0]
    points, heading = [], math.radians(rng.uniform(150, 250))
    for _ in range(rng.integers(2, 5)):
        heading += math.radians(rng.uniform(-25, 25))
        x, y = x + 0.5 * math.cos(heading), y + 0.5 * math.sin(heading)
        points.append((x, y))
    return gf.Crack(path=points)


def polyline(crack, between=0):
    """The crack as a polyline, with corners on its first part."""
    start, *corners = crack_path(GEAR, crack).T
    inside = [start + (corners[0] - start) * k / (between + 1) for k in range(1, between + 1)]
    return gf.Crack(path=[tuple(point) for point in (*inside, *corners)])


@pytest.mark.slow
@pytest.mark.parametrize("crack", [gf.Crack(length=1.5), gf.Crack(level=0.7, turning=True)], ids=["straight", "turning"])
def test_a_polyline_through_the_corners_of_a_crack_is_that_crack(crack):
    one, two = (gf.stress_intensity(GEAR, each, 22.0, 100.0, STEEL) for each in (crack, polyline(crack, 1)))
    assert pytest.approx(one.K_I, rel=2e-3) == two.K_I
    solve = gf.Solve(method="ritz", phases=np.array([0.2, 0.8]), span="tooth")
    k = [gf.solve(gf.Case(CASE.pair, 2000.0, STEEL, damage={"pinion": [each]}), solve).k for each in (crack, polyline(crack))]
    assert k[1] == pytest.approx(k[0], rel=1e-3)


def test_a_scene_has_the_same_polyline(tmp_path):
    """`path_mm` lists x and y of the corners; the crack of the wheel stays with the wheel."""
    scene = gf.new_scene(tmp_path / "mine.toml").read_text()
    scene = scene.replace('gear = "pinion"\nlevel = 0.3', 'gear = "wheel"\npath_mm = [1.0, 28.0, 0.2, 27.6]\n#')
    (tmp_path / "mine.toml").write_text(scene)
    case = gf.load_scene(tmp_path / "mine.toml").case(case="cracked")
    assert [(side, one.path) for side, (one,) in case.damage.items()] == [("wheel", ((1.0, 28.0), (0.2, 27.6)))]
    (tmp_path / "mine.toml").write_text(scene.replace("27.6]", "27.6, 1.0]"))
    with pytest.raises(ValueError, match="corners have two numbers each"):
        gf.load_scene(tmp_path / "mine.toml").case(case="cracked")


@pytest.mark.parametrize(
    "seed", [12, 25, *(pytest.param(n, marks=pytest.mark.slow) for n in (*range(12), 13, 14, 15, 29, 34, 65))]
)
def test_both_methods_have_the_same_stress_intensity_on_random_polylines(seed):
    """Loads act on three teeth. The difference relative to K under the load on the cracked tooth is that of the frozen page."""
    crack, span, teeth = random_polyline(seed), GEAR.roll_a - GEAR.roll_f, (-1, 0, 1)
    ritz = ritz_response(GEAR, STEEL, crack, teeth, 1.0)
    fe = fe_response(GEAR, STEEL, crack, teeth, 1.0, (GEAR.roll_f + 0.1 * span, GEAR.roll_a))
    roll = np.array([GEAR.roll_f + 0.6 * span])
    found = np.array([[one.under[tooth](roll)[0, -2:] for tooth in teeth] for one in (ritz, fe)])
    off = 100 * np.abs(found[0] - found[1]).max() / np.hypot(*found[1, 1])
    assert off < 1.0
    assert off == pytest.approx(stored("growth_polylines")[str(seed)]["off_percent"], abs=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_both_methods_agree_on_random_polylines(seed):
    """The mesh is not shared; profile, local contact and load sharing are."""
    case = gf.Case(CASE.pair, 2000.0, STEEL, damage={"pinion": [random_polyline(seed)]})
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


@pytest.mark.slow
def test_both_methods_grow_the_same_path():
    """The mesh, the elements and the integral's weights are not shared; the loads and the formula of the integral are."""
    start = gf.Crack(length=0.4, angle=math.radians(20), start="middle")
    ritz, fe = (gf.grow_crack(CASE, start, step=0.3, steps=3, model=gf.CrackModel(method=method)) for method in ("ritz", "fe"))
    assert set(ritz.methods + fe.methods) == {"ritz", "fe"}
    assert np.array(ritz.cracks[-1].path) == pytest.approx(np.array(fe.cracks[-1].path), abs=0.01)
    np.testing.assert_allclose(ritz.K_I, fe.K_I, rtol=0.01)
    assert ritz.K_min == pytest.approx(fe.K_min, abs=0.01 * fe.K_I[0])


def test_a_crack_that_leaves_its_sector_goes_on_by_finite_elements():
    """A crack from the middle of the space lies at the side of its sector."""
    start = gf.Crack(start=-0.1, path=[(2.78, 18.0)])
    with pytest.raises(ValueError, match="leaves the middle 80%"):
        gf.grow_crack(CASE, start, steps=1, model=gf.CrackModel(method="ritz"))
    growth = gf.grow_crack(CASE, start, steps=1, refine=0.7)
    assert growth.methods == ("fe", "fe")
    assert "method: fe" in str(growth)


@pytest.mark.parametrize("degrees", [-60, -30, 45])
def test_an_infinitesimal_kink_has_the_intensity_of_the_series(degrees):
    """K of short kinks, extrapolated to no length in powers of the root of the length, against the series."""
    start, tip = crack_path(GEAR, gf.Crack(length=1.5)).T
    turn = math.radians(degrees)
    kink = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]) @ (tip - start) / 1.5
    long = np.array([0.03, 0.06, 0.1, 0.15, 0.2, 0.3])
    paths, roll = [[tip], *([tip, tip + a * kink] for a in long)], np.array([10.0])
    before, *found = (ritz_response(GEAR, STEEL, gf.Crack(path=path), (0,), 1.5).under[0](roll)[0, -2:] for path in paths)
    none = np.linalg.lstsq(np.vander(np.sqrt(long), 3, increasing=True), np.array(found), rcond=None)[0][0]
    assert none == pytest.approx(np.array(kinked(*before, turn)), abs=0.01 * before[0])


@pytest.mark.slow
@pytest.mark.parametrize(("degrees", "length"), [(-60, 0.1), (-30, 0.1), (-30, 0.5), (45, 0.1), (45, 0.5)])
def test_kinks_by_refinement(degrees, length):
    """Kinks of 0.05 and 0.25 modules: both methods at the default resolution, against finite elements of half the size."""
    start, tip = crack_path(GEAR, gf.Crack(length=1.5)).T
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    crack = gf.Crack(path=[tip, tip + length * np.array([[cos, -sin], [sin, cos]]) @ (tip - start) / 1.5])
    roll, near = np.array([10.0]), (9.7, 10.3)
    fine, coarse = (fe_response(GEAR, STEEL, crack, (0,), refine, near).under[0](roll)[0, -2:] for refine in (2.0, 1.0))
    energy = ritz_response(GEAR, STEEL, crack, (0,), 1.0).under[0](roll)[0, -2:]
    assert np.hypot(*(energy - fine)) < 3e-3 * np.hypot(*fine)
    assert np.hypot(*(coarse - fine)) < 3e-3 * np.hypot(*fine)


def test_the_criteria_have_the_angles_of_pure_shear():
    """Largest tangential stress 70.5, energy 75.6, no shear 77.3 degrees (Amestoy and Leblond 1992, pure mode II)."""
    found = [math.degrees(turn_angle(1e-9, -1.0, criterion)) for criterion in ("tangential", "energy", "shear")]
    assert found == pytest.approx([70.53, 75.6, 77.3], abs=0.4)
    assert math.isnan(turn_angle(-1.0, 0.2, "energy"))


def test_closed_faces_press_only_where_they_touch():
    """Signorini: with the pressures of `in_contact` no face overlaps, and K_I at a tip that is pressed shut vanishes."""
    crack, roll = gf.Crack(length=1.5), np.array([GEAR.roll_f + 0.6 * (GEAR.roll_a - GEAR.roll_f)])
    response = ritz_response(GEAR, STEEL, crack, (-1, 0, 1), 1.0)
    opened, shut = (response.under[0](roll)[0] * sign for sign in (1, -1))
    assert response.in_contact(opened) == pytest.approx(opened[-2:])
    assert shut[-2] < 0
    assert abs(response.in_contact(shut)[0]) < 0.02 * abs(shut[-2])


@pytest.mark.slow
def test_a_single_load_is_the_highest_and_a_free_arc_of_the_bore_weakens_a_rim():
    rim = gf.Gear(z=21, r_bore=17.0, **RACK)
    case = gf.Case(gf.GearPair(rim, CASE.pair.gear_2), 2000.0, STEEL)
    start, quarter = gf.Crack(length=0.4), math.radians(45)
    one = {"loading": "single", "method": "fe"}
    around, arcs = (
        gf.grow_crack(case, start, steps=1, refine=0.7, model=gf.CrackModel(**one, held=held))
        for held in (None, [(quarter, 2 * math.pi - quarter)])
    )
    assert arcs.K_I[0] > 1.05 * around.K_I[0]
    assert (around.K_min == 0).all()
    whole = gf.grow_crack(case, start, steps=1, refine=0.7, model=gf.CrackModel(**one, held=[(1.0, 1.0 + 2 * math.pi)]))
    np.testing.assert_allclose(whole.K_I, around.K_I, rtol=1e-9)


def test_a_bore_held_on_arcs():
    """The whole circle as an arc is the held bore. Arcs that end inside sectors turn with the tooth that is loaded."""
    rim = gf.Gear(z=21, r_bore=17.0, **RACK)
    crack, roll, pitch = gf.Crack(length=0.8), np.array([0.7 * rim.roll_a]), 2 * math.pi / 21
    around, circle, arc = (
        ritz_response(rim, STEEL, crack, (-1, 0, 1), 1.0, held) for held in (None, ((1.0, 1.0 + 2 * math.pi),), ((0.9, 5.2),))
    )
    for tooth in (-1, 0, 1):
        np.testing.assert_allclose(circle.under[tooth](roll), around.under[tooth](roll), rtol=1e-5, atol=1e-7)
    finite = fe_response(rim, STEEL, crack, (-1, 0, 1), 2.0, (roll[0] - 0.5, roll[0] + 0.5), ((0.9, 5.2),))
    size = abs(arc.under[1](roll)[0, -2])
    assert size > 20 * abs(around.under[1](roll)[0, -2])
    for tooth in (-1, 0, 1):  # `fe` rounds the arc to its edges
        assert arc.under[tooth](roll)[0, -2:] == pytest.approx(finite.under[tooth](roll)[0, -2:], abs=0.03 * size)
    with pytest.raises(ValueError, match="no part of the held circle lies there"):
        ritz_response(rim, STEEL, crack, (0,), 1.0, ((0.5 * pitch, 0.52 * pitch),))


@pytest.mark.parametrize(("options", "message"), [
    ({"method": "abaqus"}, "method"), ({"loading": "all"}, "loading"), ({"criterion": "none"}, "criterion"),
    ({"held": [(1.0, 0.5)]}, "each arc must end after its start"), ({"held": []}, "each arc"),
])  # fmt: skip
def test_impossible_models_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        gf.CrackModel(**options)


@pytest.mark.slow
@pytest.mark.parametrize(("backup", "part", "outcome"), [
    (3.3, 0.9, "tooth lost"), (3.3, 0.1, "tooth lost"), (1.0, 0.5, "tooth lost"), (0.5, 0.9, "tooth lost"),
    (0.5, 0.1, "rim cut"), (0.3, 0.9, "rim cut"), (0.3, 0.1, "rim cut"),
])  # fmt: skip
def test_thin_rims_break_as_in_the_tests_of_nasa(backup, part, outcome):
    """D. G. Lewicki, R. Ballarini, NASA TM-107229 (1996): tooth at backup ratios 3.3 and 1.0, rim at 0.3, either at 0.5.

    The support is not printed. The bore is free over 90 degrees under the tooth.
    """
    rack = {"m_n": 3.175, "alpha_n": math.radians(20), "b": 6.35}
    depth, root = 2.25 * 3.175, (14 - 1.25) * 3.175
    rim = gf.Gear(z=28, r_bore=root - backup * depth, **rack)
    case = gf.Case(gf.GearPair(rim, gf.Gear(z=28, r_bore=15.0, **rack)), 1500.0, STEEL)
    model = gf.CrackModel(held=[(math.radians(45), math.radians(315))])
    start = gf.Crack(length=0.26, start=part * fillet_length(rim))
    assert gf.grow_crack(case, start, step=0.5, model=model).outcome == outcome


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
    ({"path": [(1.0, 17.0)], "level": 0.3}, "give one of them"), ({"path": [(1.0, 17.0)], "turning": True}, "by its level"),
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


def test_the_verb_prints_the_life_with_its_interval_and_draws_the_growth(tmp_path, capsys):
    scene, moving = str(gf.new_scene(tmp_path / "mine.toml")), tmp_path / "grown.gif"
    main(
        ["crack", scene, "--case", "cracked", "--steps", "2", "--paris", "1e-13", "3", "--scatter", "4", "--animate", str(moving)]
    )
    lines = capsys.readouterr().out.splitlines()
    life, low, high = (float(lines[0].split()[k]) for k in (0, 2, 4))
    assert (low, high) == pytest.approx((life / 4, 4 * life), rel=2e-3)
    assert lines[1].startswith("unfinished: 2 steps")
    assert moving.read_bytes()[:6] == b"GIF89a"
    assert main(["crack", scene, "--case", "cracked", "--steps", "2", "--animate", str(tmp_path / "grown.png")]) != 0
    assert "no animation file" in capsys.readouterr().err
