import math

import pytest

import gearfe as gf
from gearfe.cli import main

OPTIONS = ({}, {"ring": True, "teeth": (31, 84)}, {"helix_deg": 15.0}, {"module": 4.5, "teeth": (19, 19)})


@pytest.mark.parametrize("options", OPTIONS)
def test_written_scene_is_the_pair_asked_for(options, tmp_path):
    scene = gf.load_scene(gf.new_scene(tmp_path / "my.toml", **options))
    pair = scene.pair().pair
    assert (pair.gear_1.z, pair.gear_2.z) == options.get("teeth", (21, 31))
    assert pair.gear_1.m_n == options.get("module", 2.0)
    assert pair.gear_2.internal is options.get("ring", False)
    assert math.degrees(pair.gear_1.beta) == pytest.approx(options.get("helix_deg", 0.0))
    assert len(scene.assumptions) == 1
    curve = gf.mesh_stiffness(**scene.pair().case("cracked"), phases=2)
    assert (curve.k > 0).all()


def test_its_assumption_goes_with_the_value(tmp_path):
    path = gf.new_scene(tmp_path / "my.toml")
    path.write_text(path.read_text().replace("r_bore_mm = 9.2", "r_bore_mm = 10.0", 1))
    assert gf.load_scene(path).assumptions == ()


def test_an_existing_file_and_other_suffixes_are_refused(tmp_path):
    gf.new_scene(tmp_path / "my.toml")
    with pytest.raises(ValueError, match="not overwritten"):
        gf.new_scene(tmp_path / "my.toml")
    with pytest.raises(ValueError, match=r"\.toml"):
        gf.new_scene(tmp_path / "my.yaml")


def test_written_scene_runs_on_the_command_line(tmp_path, capsys):
    path = str(tmp_path / "my.toml")
    assert main(["new", path, "--teeth", "17", "23", "--width", "8"]) == 0
    assert main(["stiffness", path, "--phases", "4"]) == 0
    assert main(["compare", path, "--case", "cracked", "--phases", "4"]) == 0
    assert "z = 17" in (tmp_path / "my.toml").read_text()
    assert "| single " in capsys.readouterr().out
