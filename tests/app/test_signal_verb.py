"""``gearfe signal`` on files of others: channels listed and chosen, turns by a tachometer, pictures."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.io import savemat

from gearfe.app.cli import main

RATE, Z = 4000.0, 20
TIME = np.arange(int(3 * RATE)) / RATE


@pytest.fixture
def runs(tmp_path):
    """A gear of 20 teeth that speeds up, with a tachometer; in the second record a tooth knocks."""
    turns = 10 * TIME + TIME**2
    for name, knock in (("new", 0.0), ("worn", 4.0)):
        noise = 0.2 * np.random.default_rng(len(name)).standard_normal(TIME.size)
        x = np.cos(2 * np.pi * Z * turns) + knock * np.exp(-((((turns % 1) - 0.5) / 0.004) ** 2)) + noise
        savemat(tmp_path / f"{name}.mat", {"run": {"acc": x, "tacho": 5.0 * (turns % 1 < 0.3), "fs": RATE}})
    return tmp_path


def test_a_gear_with_a_tachometer(runs, capsys):
    line = ["signal", str(runs / "new.mat"), str(runs / "worn.mat"), "--unit", "m/s^2", "--column", "acc", "--tacho", "tacho"]
    pictures = ["--cepstrum", str(runs / "c.png"), "--spectrogram", str(runs / "s.png")]
    assert main([*line, "--teeth", str(Z), *pictures]) == 0
    out = capsys.readouterr().out
    rows = {m[1]: (float(m[2]), float(m[3])) for m in re.finditer(r"^\| (\S+) +\| +([\d.]+) \| +([\d.]+) \|$", out, re.MULTILINE)}
    assert rows["FM4"][1] > 2 * rows["FM4"][0]
    assert rows["NA4"][1] > 2 * rows["NA4"][0]
    assert (runs / "c.png").stat().st_size > 5000
    assert (runs / "s.png").stat().st_size > 5000


def test_the_tachometer_of_another_shaft_serves_with_its_ratio(runs, capsys):
    """As pulses of the mating gear of 40 teeth, which turns half as fast, and by a ratio that is no decimal."""
    line = ["signal", str(runs / "worn.mat"), "--unit", "m/s^2", "--column", "acc", "--tacho", "tacho"]
    for ratio, speeds in (("20/40", [5.15, 7.85, 18.5]), ("2/3", [6.87, 10.47, 24.67]), ("0.5", [5.15, 7.85, 18.5])):
        assert main([*line, "--tacho-ratio", ratio, "--teeth", "40"]) == 0
        shown = re.search(r"shaft: ([\d.]+) to ([\d.]+) Hz, ([\d.]+) revolutions", capsys.readouterr().out)
        assert_allclose([float(one) for one in shown.groups()], speeds, rtol=0.01)


def test_channels_are_listed(runs, capsys):
    assert main(["signal", str(runs / "new.mat"), "--list"]) == 0
    out = capsys.readouterr().out
    assert "run.tacho [no unit]: 12000 samples" in out
    assert "stated: run.fs = 4000.0" in out


def test_the_speed_of_a_shaft_is_told_and_drawn_by_turns(runs, capsys):
    """By pulses, from the first to the last, and by a column of the speed: 10 to 16 turns a second, 39 turns."""

    def told(*line):
        assert main(["signal", *line]) == 0
        out, err = capsys.readouterr()
        shown = re.search(r"shaft: ([\d.]+) to ([\d.]+) Hz, ([\d.]+) revolutions; lines are smeared", out)
        return [float(one) for one in shown.groups()], err

    record = [str(runs / "worn.mat"), "--unit", "m/s^2", "--column", "acc", "--tacho", "tacho"]
    pulses, _ = told(*record, "--orders", str(runs / "o.png"), "--teeth", str(Z))
    assert_allclose(pulses, [10.3, 15.7, 37.0], rtol=0.01)
    assert (runs / "o.png").stat().st_size > 5000
    table = np.transpose([TIME, np.cos(9 * TIME), 60 * (10 + 2 * TIME)])
    np.savetxt(runs / "s.csv", table, delimiter=",", header="time [s],a [g],n [rpm]", comments="")
    speed, said = told(str(runs / "s.csv"), "--tacho", "n", "--teeth", str(Z))
    assert "'n' is in rpm: taken for the shaft's speed" in said
    assert_allclose(speed, [10.05, 15.95, 39.0], rtol=0.01)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--unit", "g"], "2 channels, 'run.acc', 'run.tacho': choose one by --column"),
        (["--unit", "g", "--column", "acc", "--teeth", "20"], "--teeth needs the shaft frequency of that gear"),
        (["--unit", "g", "--column", "acc", "--tacho", "speed"], "no column 'speed'; it has 'run.acc', 'run.tacho'"),
        (["--unit", "g", "--column", "acc", "--header", "a"], "only text tables can be without column names"),
        (["--unit", "g", "--column", "acc", "--mesh", "200", "--fault", "1"], "--fault 1 Hz, but new run.acc has bins of 0.33"),
        (["--column", "acc", "--scale", "0"], "scale = 0.0, but give a finite factor"),
    ],
)
def test_what_cannot_be_is_said(runs, options, message, capsys):
    assert main(["signal", str(runs / "new.mat"), *options]) == 1
    assert message in capsys.readouterr().err


def test_a_table_without_names(runs, capsys):
    np.savetxt(runs / "bare.txt", np.transpose([TIME[:2000], np.cos(900 * TIME[:2000])]), delimiter="\t", fmt="%.6f")
    assert main(["signal", str(runs / "bare.txt"), "--header", "time [s], a [V]", "--scale", "100", "--unit", "m/s^2"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "| peak (from the mean) | 100" in shown
    assert main(["signal", str(runs / "bare.txt"), "--header", "time [s], a [V]"]) == 0, "as it stands in the file"
    peak = re.search(r"\| peak \(from the mean\) +\| +([\d.]+)", capsys.readouterr().out)
    assert float(peak[1]) == pytest.approx(1.0, abs=0.01)
