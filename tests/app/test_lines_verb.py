"""``gearfe lines``: frequencies of gearboxes, pairs and planetary scenes, with their origin."""

import math
import re
import time
from dataclasses import replace

import numpy as np
import pytest
from gearboxes import PLANETARY, TWO_STAGE
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.printed_lines import printed_lines
from gearfe.comparison.simulated import responses, simulated_gear
from gearfe.dynamics.machine.lines import gear_lines, scene_lines
from gearfe.figures.train_plot import plot_train
from gearfe.scene.load import read_tables, scene_of


def found(scene):
    return {(line.part, line.name): line.frequency for line in scene_lines(scene)}


def test_lines_of_a_published_train():
    """PHM 2009, page "Apparatus": 32/96, 48/80, ratio 5; ER-10K, 8 balls of 0.3125 on 1.319 in; orders of the input shaft."""
    lines = {key: value / 30.0 for key, value in found(gf.load_scene("phm2009_spur")).items()}
    assert_allclose(lines["shaft output", "shaft frequency"], 1 / 5, rtol=1e-12)
    assert_allclose(lines["shaft idler", "shaft frequency"], 1 / 3, rtol=1e-12)
    assert_allclose([lines["stage first", "mesh frequency"], lines["stage second", "mesh frequency"]], [32, 16], rtol=1e-12)
    ratio = 0.3125 / 1.319
    races = {"BPFO, outer race": 4 * (1 - ratio), "BPFI, inner race": 4 * (1 + ratio), "FTF, cage": (1 - ratio) / 2}
    races["BSF, rotation of a roller"] = (1 - ratio**2) / ratio / 2
    for shaft, turns in {"input": 1.0, "idler": 1 / 3, "output": 1 / 5}.items():
        for name, order in races.items():
            assert_allclose(lines[f"ER10K of shaft {shaft}", name], order * turns, rtol=1e-9, err_msg=name)
    # one tooth of the 48 meets the same one of the 80 every lcm(48, 80) = 240 mesh cycles
    assert_allclose(lines["teeth 48 and 80", "hunting tooth frequency"], 16 / 240, rtol=1e-12)


def test_lines_of_a_wind_turbine_gearbox(tmp_path):
    """NREL GRC: overall ratio 81.491 as printed (NacelleSE, 750 kW); frequencies at 1800 rpm by hand from the tooth numbers."""
    scene = gf.load_scene("nrel_grc")
    lines, rotor = found(scene), 22.088 / 60
    assert_allclose(lines["shaft high", "shaft frequency"] / rotor, 81.491, atol=5e-4)
    ratios = {"low": 1 + 99 / 21, "intermediate": (1 + 99 / 21) * 82 / 23, "high": (1 + 99 / 21) * 82 / 23 * 4}
    for shaft, ratio in ratios.items():
        assert_allclose(lines[f"shaft {shaft}", "shaft frequency"], rotor * ratio, rtol=1e-12)
    meshes = {"planetary": 99 * rotor, "low": 82 * rotor * ratios["low"], "high": 88 * rotor * ratios["intermediate"]}
    for stage, value in meshes.items():
        assert_allclose(lines[f"stage {stage}", "mesh frequency"], value, rtol=1e-12)
    plot_train(scene, tmp_path / "box.png")
    assert (tmp_path / "box.png").stat().st_size > 5000


def test_lines_of_two_planetary_stages_in_a_row():
    """NREL 5 MW: 1 + 56/19, 1 + 93/18 and 95/24, in all 96.354. Rings are at rest."""
    lines, rotor = found(gf.load_scene("nrel_5mw")), 12.1 / 60
    low, mid = rotor * (1 + 56 / 19), rotor * (1 + 56 / 19) * (1 + 93 / 18)
    assert_allclose(lines["shaft high", "shaft frequency"], mid * 95 / 24, rtol=1e-12)
    assert_allclose(lines["shaft high", "shaft frequency"] / rotor, 96.354, atol=5e-4)
    meshes = {"low": 56 * rotor, "mid": 93 * low, "high": 95 * mid}
    assert_allclose([lines[f"stage {stage}", "mesh frequency"] for stage in meshes], list(meshes.values()), rtol=1e-12)
    assert_allclose(lines["stage mid", "planet-pass frequency"], 3 * low, rtol=1e-12)
    assert_allclose(lines["planet_low1", "a tooth meshes with either flank"], 2 * 56 / 17 * rotor, rtol=1e-12)


def test_lines_of_a_planetary_and_parallel_train():
    """Sun 21, planets 31, ring 84 behind 25/50: by the relative motion to the carrier (Willis)."""
    lines, f = found(scene_of("own.toml", PLANETARY)), 1200 / 60
    sun = f * 25 / 50
    carrier = sun * 21 / (21 + 84)
    assert_allclose(lines["shaft out", "shaft frequency"], carrier, rtol=1e-12)
    assert_allclose(lines["stage set", "mesh frequency"], 84 * carrier, rtol=1e-12)
    assert_allclose(lines["stage set", "planet-pass frequency"], 3 * carrier, rtol=1e-12)
    planet = 84 * carrier / 31
    assert_allclose(lines["planet1", "a tooth meshes with either flank"], 2 * planet, rtol=1e-12)
    assert_allclose(lines["sun", "a tooth meshes with the same flank"], 3 * (sun - carrier), rtol=1e-12)
    assert_allclose(lines["bearing of each planet", "BPFI, inner race"], 17 / 2 * planet * (1 + 3 / 22), rtol=1e-12)
    # the pin holds the inner ring: the middle of a roller moves at the mean of 0 and of the bore's speed, by the outer radius
    assert_allclose(lines["bearing of each planet", "FTF, cage"], planet * (22 + 3) / 22 / 2, rtol=1e-12)


def test_the_verb_prints_and_saves_them(tmp_path, capsys):
    start = time.perf_counter()
    assert main(["lines", "phm2009_spur", "-o", str(tmp_path / "lines.csv")]) == 0
    told = capsys.readouterr().out
    assert "32 teeth of input x its rotation" in told
    assert 'ER10K of shaft input,"BPFO, outer race",91.569' in (tmp_path / "lines.csv").read_text(encoding="utf-8")
    print(f"{time.perf_counter() - start:.2f} s")
    text = str(tmp_path / "pair.toml")
    gf.new_scene(text)
    assert main(["lines", text]) == 1
    assert "has no [machine] table" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["nrel_grc", "nrel_5mw", "sdust_planetary"])
def test_printed_rows_of_rigs_are_judged(name, capsys):
    """A row is reproduced if and only if the scene states no reason against it; another printed number is not reproduced.

    A row that sets an assumption is no evidence.
    """
    scene = gf.load_scene(name)
    assert main(["lines", name]) == 0
    told = capsys.readouterr().out
    reasons = [bool(row.reason) for one in scene.references for row in one.rows if row.reason or not row.set_by]
    counts = re.search(r"(\d+) reproduced, (?:\d+ set by an assumption, )?(\d+) not reproduced", told)
    assert [int(count) for count in counts.groups()] == [reasons.count(False), reasons.count(True)]
    first, *others = scene.references
    wrong = replace(first, rows=(replace(first.rows[0], value=1.01 * first.rows[0].value), *first.rows[1:]))
    other = printed_lines(replace(scene, references=(wrong, *others)))
    counts = re.search(r"(\d+) reproduced, (?:\d+ set by an assumption, )?(\d+) not reproduced", other)
    assert [int(count) for count in counts.groups()] == [reasons.count(False) - 1, reasons.count(True) + 1]


def test_the_lines_of_a_gear_are_those_of_its_body():
    """Without a number, of the driven stage, as for damage. Bodies have their own names."""
    gears = {"compound_planetary": ("sun", "sun1", "ring_2"), "planetary_pitting": ("planet", "planet2")}
    lines = [gear_lines(gf.load_scene(scene), gear) for scene, names in gears.items() for gear in names]
    assert [one.body for one in lines] == ["sun2", "sun1", "ring", "planet", "planet2"]
    assert_allclose([one.fault for one in lines], [18.2, 16.8, 7.0, 280 / 31, 280 / 31])
    for scene, gear in (("compound_planetary", "planet"), ("planetary_pitting", "planet9")):
        with pytest.raises(ValueError, match=r"is no single body of the machine of scene .*, which has sun.*: give the freq"):
            gear_lines(gf.load_scene(scene), gear)
    with pytest.raises(ValueError, match="gear 'sum', but there is sun"):
        gear_lines(gf.load_scene("planetary_pitting"), "sum")


@pytest.mark.parametrize("gear", ["planet", "planet3"])
def test_a_simulated_record_is_of_the_damaged_planet(gear):
    left = ("assumption", "given", "reference")
    given = {key: value for key, value in read_tables("planetary_pitting")[1].items() if key not in left}
    given["crack"] = [{"case": "x", "gear": "planet", "body": "planet3", "tooth": 4, "level": 0.4}]
    scene = scene_of("s.toml", given)
    record = simulated_gear(scene, "x", gear, duration=0.5)["simulated x"]
    wanted = responses(scene, "x", duration=0.5)["x"]
    for planet, alike in (("planet1", False), ("planet3", True)):
        own = wanted.signal(f"force sun_{planet}", 1.0).values
        assert (abs(record.values - own).max() < 0.02 * np.ptp(own)) == alike


def test_signals_take_the_frequencies_of_a_gear(tmp_path, capsys):
    """Two seconds of a mesh at 480 Hz whose amplitude dips with the rotation of the gear at 10 Hz."""
    time = np.arange(20_480) / 10_240
    values = (1 + 0.3 * np.cos(2 * np.pi * 10 * time)) * np.sin(2 * np.pi * 480 * time)
    values += 0.01 * np.random.default_rng(1).standard_normal(time.size)
    rows = "\n".join(f"{t:.9f},{v:.9f}" for t, v in zip(time, values, strict=True))
    (tmp_path / "a.csv").write_text(f"time [s],a [m/s^2]\n{rows}\n", encoding="utf-8")
    assert main(["signal", str(tmp_path / "a.csv"), "--scene", "phm2009_spur", "--gear", "idler_out"]) == 0
    told = capsys.readouterr().out
    assert "idler_out of phm2009_spur, 48 teeth: mesh 480 Hz, fault 10 Hz, shaft 10 Hz" in told
    assert "mesh frequency + fault frequency" in told
    assert "3 of 3 lines of 10 times the local median are named" in told
    assert main(["signal", str(tmp_path / "a.csv"), "--gear", "idler_out"]) == 1
    assert "give --scene, too" in capsys.readouterr().err


CHANGES = [  # what is changed in the tables of two stages, and what is said of it
    ({"pair": {"slow": {"force_N": 3.0}}}, r"\[pair.slow\] force_N or torque_Nm: the gearbox gives \d.* N; leave both out"),
    ({"pair": {"slow": {"gear_1": "d", "gear_2": "c"}}}, r"\[pair.slow\]: gear_1 must drive, but power flows from 'c' to 'd'"),
    ({"shaft": {"two": {"gears": ["b", "a"]}}}, r"\[shaft.two\] gears: 'a' is on \[shaft.one\] already"),
    ({"shaft": {"two": {"gears_at_mm": [60.0, 60.0]}}}, r"give each gear a different position"),
    ({"shaft": {"two": {"gears_at_mm": [60.0, 190.0]}}},
     r"gears_at_mm = 190, but by lengths_mm the shaft reaches from 0 to 180 mm"),
    ({"shaft": {"two": {"bearings": ["x", "x"]}}}, r"\[shaft.two\] bearings = 'x': no such bearing"),
    ({"motor": {"shaft": "four"}}, r"\[motor\] shaft = 'four': no such shaft"),
    ({"load": {"brake": {"torque_Nm": 3.0}}}, r"0 loads without torque_Nm"),
    ({"load": {"pump": {"shaft": "two", "torque_Nm": 500.0}}}, r"\[load.brake\]: no torque remains for it"),
    ({"coupling": {"x": {"shaft_1": "one", "shaft_2": "three", "torsion_Nm_per_mrad": 1.0}}}, r"closes a loop of shafts"),
    ({"machine": {"model": "helical_pair"}}, r"\[motor\]: this belongs to a gearbox"),
    ({"gear": {"c": {"beta_deg": 12.0}}}, r"beta_deg of 'c' and 'd' are 12 and 12, but an external pair has opposite hands"),
]  # fmt: skip


def merged(tables, change):
    return {**tables, **{key: merged(tables.get(key, {}), one) if isinstance(one, dict) else one for key, one in change.items()}}


@pytest.mark.parametrize(("change", "message"), CHANGES, ids=[message[:25] for _, message in CHANGES])
def test_what_is_said_of_an_impossible_train(change, message):
    with pytest.raises(ValueError, match=f"own.toml.*{message}"):
        scene_of("own.toml", merged(TWO_STAGE, change))


def test_hands_of_helix_add_or_subtract_the_thrusts():
    """By hand: F_a = T / r tan(beta) of each gear; the wheel b and the pinion c of one hand push apart, of two hands add."""
    from gearfe.scene.train import thrusts_of

    sums = {}
    for hand in (-12.0, 12.0):
        scene = scene_of("own.toml", merged(TWO_STAGE, {"gear": {"c": {"beta_deg": hand}, "d": {"beta_deg": -hand}}}))
        pushes, torque = thrusts_of(scene.train, scene.gears), 30.0 * 61 / 23
        radii = [61 * 2e-3 / math.cos(math.radians(15)) / 2, 19 * 2.5e-3 / math.cos(math.radians(12)) / 2]
        sizes = [torque / radii[0] * math.tan(math.radians(15)), torque / radii[1] * math.tan(math.radians(12))]
        assert_allclose([abs(pushes["b"]), abs(pushes["c"])], sizes, rtol=1e-12)
        sums[hand] = abs(pushes["b"] + pushes["c"])
    assert_allclose([sums[-12.0], sums[12.0]], [abs(sizes[1] - sizes[0]), sum(sizes)], rtol=1e-9)


@pytest.mark.parametrize(("ratio", "advised"), [((), "give --tacho-ratio 0.33333"), (("--tacho-ratio", "1/3"), "")])
def test_a_tachometer_on_another_shaft_is_told(tmp_path, capsys, ratio, advised):
    """PHM 2009: pulses of the input shaft at 30 Hz, where the 48-tooth gear of the idler turns at 10 Hz."""
    time = np.arange(20_480) / 10_240
    columns = time, np.sin(2 * np.pi * 480 * time), 5.0 * (time * 30 % 1 < 0.2)
    rows = "\n".join(f"{t:.9f},{v:.9f},{p:.1f}" for t, v, p in zip(*columns, strict=True))
    (tmp_path / "a.csv").write_text(f"time [s],a [m/s^2],pulses [V]\n{rows}\n", encoding="utf-8")
    options = ["--column", "a", "--scene", "phm2009_spur", "--gear", "idler_out", "--tacho", "pulses", *ratio]
    assert main(["signal", str(tmp_path / "a.csv"), *options]) == 0
    told = "".join(capsys.readouterr())
    assert (advised in told) if advised else ("the tachometer gives" not in told)
