"""Expected times and memory of curves: limits that reject, announcements, and the sentence of ``gearfe check``."""

import re
from dataclasses import replace

import pytest

import gearfe as gf
from gearfe.app.cli import main
from gearfe.scene.load import scene_names
from gearfe.stiffness.cost import curve_cost


@pytest.fixture(name="case")
def _case(pair, steel):
    return gf.Case(pair, force=2000.0, material=steel)


@pytest.mark.parametrize("method", ["ritz", "ritz3d", "fe"])
def test_cost_rises_with_resolution_width_and_damage(case, method):
    at = [curve_cost(case, gf.Solve(refine=refine), method) for refine in (0.5, 1.0, 8.0, 50.0)]
    assert [one.seconds for one in at] == sorted({one.seconds for one in at})
    assert curve_cost(case, gf.Solve(error=True), method).seconds > at[1].seconds
    if method != "fe":  # The time of a section of finite elements depends on the number of teeth alone.
        hurt = curve_cost(gf.Case(case.pair, 2000.0, case.material, damage={"pinion": [gf.Crack(level=0.3)]}), gf.Solve(), method)
        assert hurt.seconds > at[1].seconds


@pytest.mark.parametrize("method", ["ritz", "ritz3d"])
def test_a_curve_above_the_limit_of_time_is_rejected_before_it_is_solved(case, method, monkeypatch):
    monkeypatch.setenv("GEARFE_MAX_HOURS", "1e-3")
    with pytest.raises(ValueError, match=rf"refine = 50: a curve by {method}: about .* hours .*: give a smaller"):
        gf.solve(case, gf.Solve(method, refine=50.0, cache=False))


def test_a_curve_above_the_free_memory_is_rejected(case, monkeypatch):
    monkeypatch.setattr("gearfe.core.memory.free_memory", lambda: 1e9)
    with pytest.raises(ValueError, match=r"refine = 64: a curve by ritz3d needs about 10.2 GB, but 1 GB are free"):
        gf.solve(case, gf.Solve("ritz3d", refine=64.0, cache=False))


def test_growth_above_the_limit_of_time_is_rejected_before_it_is_solved(case, monkeypatch):
    monkeypatch.setenv("GEARFE_MAX_HOURS", "1e-2")
    with pytest.raises(
        ValueError, match=r"refine = 50: 60 steps of growth: about .* hours .*: give a smaller refine, or fewer steps"
    ):
        gf.grow_crack(case, gf.Crack(level=0.2), refine=50.0)


@pytest.mark.parametrize("work", [gf.tooth_flexibility, gf.root_stress, gf.stress_intensity])
def test_a_section_above_the_free_memory_is_rejected_before_it_is_meshed(work, case, monkeypatch):
    monkeypatch.setattr("gearfe.core.memory.free_memory", lambda: 1e10)
    more = {} if work is gf.tooth_flexibility else {"line_load": 100.0}
    more |= {"crack": gf.Crack(level=0.3)} if work is gf.stress_intensity else {}
    with pytest.raises(ValueError, match=r"refine = 50: a section with one loaded tooth needs about 42\.5 GB"):
        work(gear=case.pair.gear_1, radius=21.0, material=case.material, refine=50.0, **more)


STEEL, LINE = gf.Material(), {"radius": 21.0, "line_load": 100.0, "material": gf.Material()}
WHOLE = {  # whole gears in hexahedra, by the function that meshes them
    "write_line_inp": lambda case, file, **how: gf.write_line_inp(file, case.pair.gear_1, **LINE, **how),
    "export_mesh": lambda case, file, **how: gf.export_mesh(file, case.pair.gear_1, **how),
    "write_contact_inp": lambda case, file, **how: gf.write_contact_inp(file, replace(case, face="spur"), 0.5, 0.01, **how),
    "root_stress_along_width": lambda case, file, **how: gf.root_stress_along_width(case.pair.gear_1, **LINE, **how),
    "stress_intensity_along_front": lambda case, file, **how: gf.stress_intensity_along_front(
        case.pair.gear_1, gf.Crack(level=0.3), **LINE, **how
    ),
}


@pytest.mark.parametrize("name", WHOLE)
def test_a_whole_gear_in_hexahedra_is_rejected_or_announced_before_it_is_meshed(name, case, tmp_path, monkeypatch):
    monkeypatch.setattr("gearfe.geometry.mesh.solid.quad_section", lambda *_, **__: pytest.fail("meshed"))
    file = tmp_path / ("mesh.msh" if name == "export_mesh" else "deck.inp")
    monkeypatch.setenv("GEARFE_MAX_HOURS", "1e9")
    with pytest.raises((ValueError, RuntimeError), match=r"needs? about .* GB.*a smaller refine"):
        WHOLE[name](case, file, refine=50.0)
    monkeypatch.setattr("gearfe.core.cost.SLOW", 0.0)
    with (
        pytest.warns(UserWarning, match=r"refine = 1: a mesh of .* nodes takes about .* s and"),
        pytest.raises(pytest.fail.Exception),
    ):
        WHOLE[name](case, file, refine=1.0)


def test_a_slow_curve_is_announced_with_its_time_and_memory(case, monkeypatch):
    monkeypatch.setattr("gearfe.core.cost.SLOW", 0.01)
    how = {"method": "ritz", "phases": [0.5], "cache": False}
    with pytest.warns(UserWarning, match=r"refine = 1: a curve by ritz takes about 0\.0\d+ s and 0\.0\d+ GB"):
        gf.solve(case, gf.Solve(**how))
    told = []
    gf.solve(case, gf.Solve(tell=told.append, **how))
    assert len(told) == 1


@pytest.mark.parametrize("name", scene_names())
def test_check_states_the_time_of_the_verbs_that_a_scene_has(name, capsys):
    main(["check", name])
    scene, line = gf.load_scene(name), capsys.readouterr().out.splitlines()[-1]
    stated = dict(re.findall(r"(\w+) ([\d.e+]+) s and", line.partition("options: ")[2]))
    memory = [float(one) for one in re.findall(r"s and ([\d.e+-]+) GB", line)]
    assert len(memory) == len(stated)
    assert all(0.05 < one < 2 for one in memory)
    assert list(stated) == ["stiffness", "compare", *["dynamics"] * bool(scene.machine), *["planetary"] * bool(scene.set)]
    assert all(0.5 < float(seconds) < 600 for seconds in stated.values())
