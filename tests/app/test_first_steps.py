"""What new users met: notes, files and lists of the command line that were silent, incomplete or repeated."""

import importlib.metadata
import re
import tomllib
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.losses import percent_with_doubt
from gearfe.figures import stiffness_plots
from gearfe.stiffness.disk import program

RATE, MESH = 12800.0, 460.0


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["new", "my.toml", "--crack", "2", "60"]) == 0
    return tmp_path


def record(name, values):
    rows = np.column_stack([np.arange(values.size) / RATE, values])
    np.savetxt(name, rows, delimiter=",", header="time [s],acc [m/s^2]", comments="", fmt="%.9g")


def test_the_version_needs_no_installation(monkeypatch, capsys):
    def missing(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "version", missing)
    stated = re.search(r"^version: (.+)$", Path(gf.__file__).with_name("CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE)
    assert main(["info", "--cite"]) == 0
    assert f"  version = {{{stated[1]}}}," in capsys.readouterr().out
    assert program()["gearfe"] == gf.__version__ == stated[1]


def test_a_varying_speed_is_noted_with_the_mesh_frequency_alone(folder, capsys):
    """The note has the part of the amplitude that the printed line has."""
    time = np.arange(int(4 * RATE)) / RATE
    turns = np.cumsum(20 * (1 + 0.004 * np.sin(2 * np.pi * 0.7 * time))) / RATE
    noise = 0.1 * np.random.default_rng(1).standard_normal(time.size)
    record("varying.csv", 2 * np.cos(2 * np.pi * 23 * turns) + noise)
    record("constant.csv", (2 + 0.6 * np.cos(2 * np.pi * 20 * time)) * np.cos(2 * np.pi * MESH * time) + noise)
    assert main(["signal", "varying.csv", "--column", "acc", "--mesh", "460", "--fault", "20"]) == 0
    told = capsys.readouterr()
    part = re.search(r"--mesh 460 Hz has (\S+) % of the amplitude within 4.6 Hz, because the speed varies", told.err)
    printed = float(re.search(r"\| mesh frequency +\| +460.00 \| +(\S+) \|", told.out)[1])
    assert_allclose(0.01 * float(part[1]), printed / 2, rtol=0.05)
    for given, note in {"460": False, "463.1": True}.items():
        assert main(["signal", "constant.csv", "--column", "acc", "--mesh", given, "--fault", "20"]) == 0
        assert ("the largest line is at 460 Hz" in capsys.readouterr().err) == note


def test_simulated_records_have_no_note_on_their_speed(folder, capsys):
    assert main(["dynamics", "planetary_pitting", "--case", "severe", "-o", "r.npz"]) == 0
    assert main(["signal", "r.npz", "--column", "force sun_planet1", "--mesh", "280", "--fault", "40"]) == 0
    assert "speed" not in capsys.readouterr().err


def test_a_named_line_lies_between_bins(folder, capsys):
    """One sample more than a second: the bins lie at multiples of 0.99992 Hz."""
    size = int(RATE) + 1
    tone = np.cos(2 * np.pi * 500 * np.arange(size) / RATE)
    record("one.csv", 3 * tone + 0.01 * np.random.default_rng(0).standard_normal(size))
    assert main(["signal", "one.csv", "--column", "acc", "--scene", "phm2009_spur"]) == 0
    assert re.search(r"^\| +500.00 \| +3 \|", capsys.readouterr().out, re.MULTILINE)


def test_a_saved_response_has_the_analysed_channel(folder, capsys):
    run = ["phm2009_spur", "--duration", "0.2", "--channel", "spring bearing idler2 x"]
    assert main(["dynamics", *run, "-o", "r.npz"]) == 0
    assert "spring bearing idler2 x" in [*np.load("r.npz")["names"]]
    saved = gf.read_signal("r.npz", column="spring bearing idler2 x")
    rms = re.search(r"^\| rms \(with the mean\) +\| +(\S+) \|", capsys.readouterr().out, re.MULTILINE)
    assert_allclose(np.sqrt(np.mean(saved.values**2)), float(rms[1]), rtol=1e-3)


def test_pitch_errors_over_a_revolution(folder, capsys):
    pitch = '\n[flank.deviating]\ngear = "pinion"\npitch_um = [' + ", ".join(["0.0"] * 3 + ["20.0"] + ["0.0"] * 17) + "]\n"
    Path("my.toml").write_text(Path("my.toml").read_text() + pitch)
    assert main(["te", "my.toml", "--phases", "16"]) == 0
    assert "give --span revolution" in capsys.readouterr().err
    assert main(["te", "my.toml", "--phases", "16", "--span", "revolution"]) == 0
    told = capsys.readouterr()
    assert "note" not in told.err
    case = gf.load_scene("my.toml").case()
    found = gf.transmission_error(case, phases=16, span="revolution").peak_to_peak[0]
    assert float(re.search(r"\|\s+2000 \|[^|]+\| +(\S+) \|", told.out)[1]) == round(1e6 * found, 3)
    assert main(["te", "my.toml", "--case", "cracked", "--span", "revolution"]) == 1
    assert "leave out --span" in capsys.readouterr().err


def test_an_equal_note_is_printed_once(folder, capsys):
    Path("old.toml").write_text(Path("my.toml").read_text().replace("\nrack_tip_radius", "\ntip_radius"))
    assert main(["check", "old.toml"]) == 0
    assert capsys.readouterr().err.count("key tip_radius is now rack_tip_radius") == 1


def test_the_picture_of_a_damaged_pair_has_the_healthy_curve(folder, monkeypatch):
    drawn = {}
    monkeypatch.setattr(stiffness_plots, "plot_curves", lambda curves, *_: drawn.update(curves))
    assert main(["stiffness", "my.toml", "--case", "cracked", "--phases", "8", "--plot", "k.png"]) == 0
    assert [*drawn] == ["cracked ritz", "healthy ritz"]
    assert (drawn["cracked ritz"].k <= drawn["healthy ritz"].k * (1 + 1e-9)).all()


def test_the_table_of_crack_growth_is_a_path(folder):
    assert main(["crack", "my.toml", "--case", "cracked", "--steps", "2", "-o", "grown.csv"]) == 0
    rows = np.genfromtxt("grown.csv", delimiter=",", names=True, deletechars="")
    lengths = np.hypot(np.diff(rows["x_[mm]"]), np.diff(rows["y_[mm]"]))
    assert_allclose(lengths, np.diff(rows["length_[mm]"]), rtol=1e-6)


def test_the_torque_of_a_new_scene_is_that_of_its_force(folder):
    text = Path("my.toml").read_text()
    swapped = re.sub(r"^force_N = .*$", "", text, flags=re.MULTILINE).replace("# torque_Nm = ", "torque_Nm = ", 1)
    Path("torque.toml").write_text(swapped)
    forces = [gf.load_scene(name).pair().force for name in ("my.toml", "torque.toml")]
    assert_allclose(forces[1], forces[0], rtol=1e-3)


def test_results_are_told_in_words():
    """No arrays in the text of a result."""
    rack = {"m_n": 2.0, "alpha_n": np.radians(20), "b": 20.0}
    case = gf.Case(gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack)), 2000.0, gf.Material())
    how = gf.Solve(phases=4)
    results = [gf.convergence(case, how, refines=(0.7,), orders=(3,)), gf.transmission_error(case, phases=4)]
    results += [gf.grow_crack(case, gf.Crack(length=1.0), steps=1)]
    for result in results:
        assert "array" not in repr(result)
        assert len(repr(result)) < 1000


def test_every_verb_is_on_the_page_of_commands():
    verbs = tomllib.loads(resources.files("gearfe.app.cli").joinpath("verbs.toml").read_text(encoding="utf-8"))["verbs"]
    page = Path(gf.__file__).with_name("docs").joinpath("commands.md").read_text(encoding="utf-8")
    assert {verb for verb in verbs if f"| `gearfe {verb}" not in page} == set()


def test_the_title_of_a_plot_names_the_damage(monkeypatch):
    rack = {"m_n": 2.0, "alpha_n": np.radians(20), "b": 20.0}
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    damage = {"pinion": [gf.Crack(level=0.3)], "wheel": [gf.MissingTooth(3), gf.MissingTooth(8), gf.Crack(level=0.1)]}
    curve = gf.mesh_stiffness(pair, 2000.0, gf.Material(), damage=damage, phases=[0.5], refine=0.5)
    title = "z = 21 / 31, crack of the pinion, crack and 2 missing teeth of the wheel, 2000 N on 20 mm"
    assert stiffness_plots.told(curve) == title


def test_a_loss_of_nothing_has_no_sign():
    assert percent_with_doubt(-1e-6, 0.001) == "0.0 ± 0.1 %"
    assert percent_with_doubt(-1e-6, np.nan) == "0.0 %"


def test_compare_defines_its_zones_once(folder, capsys):
    assert main(["compare", "my.toml", "--case", "cracked", "--phases", "8"]) == 0
    assert capsys.readouterr().out.count("zones, mean and max are over") == 1


def test_times_without_unit_that_contradict_the_rate_are_told(folder, capsys):
    np.savetxt(
        "t.csv", np.column_stack([np.arange(100) / RATE, np.arange(100) % 7]), delimiter=",", header="t, a [g]", comments=""
    )
    assert main(["signal", "t.csv", "--rate", "12800", "--column", "a"]) == 0
    capsys.readouterr()
    assert main(["signal", "t.csv", "--rate", "10000", "--column", "a"]) == 1
    assert "column 't' has no unit, and its step of 7.8125e-05 is that of rate = 10000 Hz in none of" in capsys.readouterr().err
