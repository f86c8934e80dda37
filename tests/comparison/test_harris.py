"""Harris's map beside plain involutes, on the command line."""

import pytest

import gearfe as gf
from gearfe.app.cli import main


def rows(text):
    """Numbers of the lines of the table, those of the load first."""
    lines = [line.strip("|").replace("|", " ").split() for line in text.splitlines() if line.startswith("|")]
    return [[float(word) for word in line] for line in lines if line[0][0].isdigit()]


def test_relief_is_told_beside_plain_involutes(tmp_path, capsys):
    bent = gf.new_scene(tmp_path / "bent.toml", tip_relief_um=10.0, tip_length_mm=2.6)
    plain = gf.new_scene(tmp_path / "plain.toml")
    run = ["--phases", "16", "--forces", "1000", "2000", "--plot", str(tmp_path / "map.png")]
    assert main(["te", str(bent), *run]) == 0
    with_relief = rows(capsys.readouterr().out)
    assert main(["te", str(plain), *run]) == 0
    without = rows(capsys.readouterr().out)
    assert [row[3] for row in with_relief] == [row[2] for row in without]
    assert with_relief[1][2] < 0.3 * with_relief[1][3]  # 2000 N is what this relief is for
    r_b = gf.load_scene(plain).pair().pair.gear_1.r_b
    assert with_relief[0][1] == pytest.approx(1e-3 * 1000.0 * r_b, abs=0.01)
    assert main(["te", str(bent), "--phases", "16", "--torques", str(2.0 * r_b)]) == 0
    assert rows(capsys.readouterr().out)[0][2:] == with_relief[1][2:]


def test_loads_are_given_once(tmp_path, capsys):
    assert main(["te", "planetary_pitting", "--forces", "1000", "--torques", "20"]) == 1
    assert "give one of them" in capsys.readouterr().err
