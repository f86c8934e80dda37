import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.simulated import simulated_gear


@pytest.fixture
def files(tmp_path):
    rng, angle = np.random.default_rng(0), 2 * np.pi * 20 * np.arange(20480) / 10240
    for name, impulse in (("a", 0.0), ("b", 1.0)):
        x = np.cos(23 * angle) + 0.2 * rng.standard_normal(angle.size)
        x += impulse * np.exp(-(((np.mod(angle, 2 * np.pi) - 3.8) / 0.04) ** 2)) * np.cos(90 * angle)
        np.savetxt(tmp_path / f"{name}.csv", x, header="rate = 10240 Hz\nacc [g]")
    return tmp_path


@pytest.mark.slow
def test_the_workbench_writes_pictures_tables_and_a_page(files, capsys):
    folder = files / "bench"
    command = ["signal", str(files / "a.csv"), str(files / "b.csv"), "--shaft", "20", "--teeth", "23", "-o", str(folder)]
    assert main(command) == 0
    printed = capsys.readouterr().out
    assert "tooth fault of the 23-tooth gear: likely" in printed
    page = (folder / "page.html").read_text(encoding="utf-8")
    assert "Tooth fault of the 23-tooth gear: likely" in page
    assert page.count("data:image/png;base64,") == 6
    for name in ("spectrum", "envelope", "kurtogram_1", "kurtogram_2", "orders", "average"):
        assert (folder / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    angle, average, _ = np.loadtxt(folder / "average_b_acc.csv", delimiter=",", skiprows=1).T
    want, _ = gf.synchronous_average(gf.read_signal(files / "b.csv", shaft_frequency=20.0))
    assert_allclose(average, want, rtol=1e-12)
    assert_allclose(angle[1], 360 / want.size)


def test_a_folder_gives_a_trend(files, capsys):
    assert main(["signal", str(files), "--shaft", "20", "--teeth", "23", "-o", str(files / "trend")]) == 0
    assert "| a acc" in capsys.readouterr().out
    assert (files / "trend" / "trend.csv").read_text().splitlines()[0] == "record,rms,kurtosis,FM4,NA4,energy ratio"
    (files / "empty").mkdir()
    assert main(["signal", str(files / "empty")]) == 1
    assert "no records; give a folder with" in capsys.readouterr().err


def test_parts_of_records_and_an_estimated_speed(files, capsys):
    assert main(["signal", str(files / "b.csv"), "--start", "0.5", "--stop", "1.5"]) == 0
    assert "10240 samples at 10240 Hz, 1 s" in capsys.readouterr().out
    time = np.arange(81920) / 10240
    angle = 2 * np.pi * (20 * time + 0.2 * np.sin(0.8 * time))
    x = np.cos(23 * angle) + 0.5 * np.cos(46 * angle) + 0.2 * np.random.default_rng(1).standard_normal(time.size)
    np.savetxt(files / "c.csv", x, header="rate = 10240 Hz\nacc [g]")
    assert main(["signal", str(files / "c.csv"), "--teeth", "23", "--speeds", "19", "21.5"]) == 0
    printed = capsys.readouterr()
    assert "shaft: 19.8" in printed.out
    assert "the average keeps" not in printed.err
    assert main(["signal", str(files / "b.csv"), "--speeds", "19", "21"]) == 1
    assert "give --teeth" in capsys.readouterr().err


@pytest.mark.slow
def test_a_simulated_machine_stands_beside_the_record(tmp_path, capsys):
    """Its frequencies, teeth and indicators are those of the wheel, which is not the default gear."""
    rng, angle = np.random.default_rng(0), 2 * np.pi * 8.0 * np.arange(40960) / 10240
    x = np.cos(31 * angle) + 0.2 * rng.standard_normal(angle.size)
    x += np.exp(-(((np.mod(angle, 2 * np.pi) - 3.8) / 0.04) ** 2)) * np.cos(124 * angle)
    np.savetxt(tmp_path / "b.csv", x, header="rate = 10240 Hz\nacc [g]")
    scene = gf.new_scene(tmp_path / "own.toml", teeth=(21, 31), crack=(2.0, 60.0))
    text = scene.read_text().replace('case = "cracked"\ngear = "pinion"', 'case = "cracked"\ngear = "wheel"')
    scene.write_text(f'{text}\n[machine]\nmodel = "helical_pair"\nspeed_rpm = {60 * 8.0 * 31 / 21}\ntorque_Nm = 50.0\n')
    folder = tmp_path / "bench"
    named = ["--scene", str(scene), "--gear", "wheel", "--case", "cracked", "-o", str(folder)]
    assert main(["signal", str(tmp_path / "b.csv"), *named]) == 0
    printed = capsys.readouterr().out
    assert "31 teeth: mesh 248 Hz, fault 8 Hz, shaft 8 Hz" in printed
    simulated = simulated_gear(gf.load_scene(scene), "cracked", "wheel")
    row = next(line for line in printed.split("simulated mesh force")[1].splitlines() if line.startswith("| FM4"))
    table = gf.gear_indicator_table(simulated, 31)
    assert_allclose([float(one) for one in row.split("|")[2:4]], [of["FM4"] for of in table.values()], rtol=1e-3)
    verdicts = [line for line in printed.splitlines() if "tooth fault of the 31-tooth gear" in line]
    assert [line.startswith("simulated mesh force: ") for line in verdicts] == [False, True]
    assert "31-tooth gear: likely" in verdicts[1]
    assert (folder / "simulated_average_simulated_cracked.csv").exists()
    lines = (folder / "lines.csv").read_text(encoding="utf-8").splitlines()
    assert f"of {len(lines) - 1} lines of 10 times the local median are named" in printed
    assert "simulated mesh force: tooth fault" in (folder / "page.html").read_text(encoding="utf-8")
