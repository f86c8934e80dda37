"""Messages on what users often give wrong: their own key or option with its value, the range or the remedy, the nearest name."""

import re

import numpy as np
import pytest
from planetary_sets.sets import case as set_case
from usual import RACK

import gearfe as gf
from gearfe.app.cli import main

PAIR = gf.GearPair(*[gf.Gear(z, r_bore=9.2, **RACK) for z in (21, 31)])
SIGNAL = gf.Signal(np.sin(np.arange(2048.0)), 2048.0, "m/s^2", shaft_frequency=10.0)
KEYS = [  # what stands in the scene, what a user writes instead, and words of the message
    ("b_mm = 20.0", "b_m = 0.02", "[gear.pinion]: unknown key 'b_m' (nearest: 'b_mm')"),
    ("r_bore_mm = 9.2", "r_bore_mm = 30", "[gear.pinion]: r_bore_mm = 30, but the bore must lie inside the root circle"),
    ('gear_2 = "wheel"', 'gear_2 = "whel"', "[pair.stage] gear_2 = 'whel': no such gear; there is pinion, wheel"),
]
LINES = [  # of a command, with words of the message; S is a scene
    ("stifness S", "unknown choice 'stifness' (nearest: stiffness)"),
    ("stiffness S --cases x", "unknown argument '--cases' (nearest: --case)"),
    ("stiffness S --phases ten", "argument --phases: 'ten', but give a whole number"),
    ("stiffness S --phases 0", "--phases = 0, but give"),
    ("stiffness S --refine 0.01", "--refine = 0.01, but give 0.2 to 64"),
    ("te S --forces -5", "--forces = -5.0 N, but the load must press the flanks together"),
    ("stiffness none.toml", "none.toml: no such file; give the path of a .toml file, or a built-in scene"),
    ("stiffness planetary_piting", "no scene 'planetary_piting' (nearest: planetary_pitting)"),
    ("sweep S -o runs", "is a scene, but give a study"),
    ("new b.toml --torque 1e9", "--torque = 1e+09 N m: b.toml [pair.stage]: force_N = "),
    ("import S", "unknown choice"),
]
CALLS = [
    (lambda: gf.simulate(SIGNAL, 1.0), r"machine = Signal.*, but give a Machine: gf\.build_machine\(scene\)"),
    (lambda: gf.build_machine("S.toml"), r"scene = 'S.toml', but give a Scene: gf\.load_scene\(name\)"),
    (lambda: gf.gear_indicators(SIGNAL, 20), r"average: .*, but give a row .*: gf\.synchronous_average\(signal\)"),
    (lambda: gf.Gear(z="21", r_bore=9.2, **RACK), "z = '21', but give a whole number"),
    (lambda: gf.Flank(tip_relief=0.02), "tip_relief = 0.02 mm with no start: give one of tip_start_diameter"),
    (lambda: gf.bearing_lines(10, 8, 50, 30), "roller = 50.0, but 8 rollers fit .* only below 11.48"),
    (lambda: gf.planetary_stiffness(set_case(), 10**7), "10000000 positions of a set: about 14 hours .*GEARFE_MAX_HOURS"),
    (lambda: gf.planetary_stiffness(set_case(), 1, refine=64), "refine = 64: one position of a set: .*give a smaller refine"),
    (lambda: gf.decimate(SIGNAL, 5000), "rate = 5000 Hz, but .* has 2048 Hz: .*for example 1024 Hz"),
    (
        lambda: gf.mesh_stiffness(PAIR, 2000.0, gf.Material(), damage=gf.Crack(level=0.3)),
        r"damage = Crack.*give a dict by gear: {'pinion'",
    ),
    (lambda: gf.GearPair(gf.Gear(21, r_bore=9.2, **RACK), 5), r"gear_2 = 5, but give a Gear: Gear\(z"),
]


@pytest.fixture
def scene(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    gf.new_scene("S.toml")
    return tmp_path / "S.toml"


@pytest.mark.parametrize(("written", "instead", "said"), KEYS)
def test_of_a_key_of_a_scene(scene, capsys, written, instead, said):
    scene.write_text(scene.read_text().replace(written, instead, 1))
    assert main(["check", "S.toml"]) == 1
    assert f"S.toml {said}" in capsys.readouterr().err


@pytest.mark.parametrize(("line", "said"), LINES)
@pytest.mark.usefixtures("scene")
def test_of_a_command_line(capsys, line, said):
    try:
        code = main(re.sub(r"\bS\b", "S.toml", line).split())
    except SystemExit as error:
        code = error.code
    assert code in (1, 2)
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(("call", "said"), CALLS)
def test_of_a_call(call, said):
    with pytest.raises(ValueError, match=said):
        call()


def test_of_an_argument():
    gear = gf.Gear(21, r_bore=9.2, **RACK)
    with pytest.raises(TypeError, match=r"no argument 'methd'; nearest: 'method'"):
        gf.mesh_stiffness(gf.GearPair(gear, gear), 2000.0, gf.Material(), methd="fe")
