import math
import re

import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import main
from gearfe.scene.schema import scene_schema

RELIEF = {"tip_relief_um": 15.0, "tip_length_mm": 1.2}
LOADED = {"torque_Nm": 60.0, "crack": (1.5, 60.0)}
OPTIONS = ({}, {"ring": True, "teeth": (31, 84)}, {"helix_deg": 15.0}, {"module": 4.5, "teeth": (19, 19)}, RELIEF, LOADED)


@pytest.mark.parametrize("options", OPTIONS)
def test_written_scene_is_the_pair_asked_for(options, tmp_path):
    scene = gf.load_scene(gf.new_scene(tmp_path / "my.toml", **options))
    pair = scene.pair().pair
    assert (pair.gear_1.z, pair.gear_2.z) == options.get("teeth", (21, 31))
    assert pair.gear_1.m_n == options.get("module", 2.0)
    assert pair.gear_2.internal is options.get("ring", False)
    assert math.degrees(pair.gear_1.beta) == pytest.approx(options.get("helix_deg", 0.0))
    assert len(scene.assumptions) == 1
    curve = gf.mesh_stiffness(scene.pair().case("cracked"), phases=[0.5], refine=0.5)
    assert (curve.k > 0).all()


def test_tip_relief_of_both_gears_starts_so_far_below_the_tip(tmp_path):
    chosen = gf.load_scene(gf.new_scene(tmp_path / "my.toml", **RELIEF)).pair()
    for side, gear in (("pinion", chosen.pair.gear_1), ("wheel", chosen.pair.gear_2)):
        flank = chosen.flanks[side]
        assert flank.tip_relief == pytest.approx(0.015)
        assert flank.tip_start_roll == pytest.approx(gear.roll_a - 1.2)
    for wrong in ({"tip_relief_um": 15.0}, {"tip_relief_um": -1.0, "tip_length_mm": 1.0}, RELIEF | {"tip_length_mm": 50.0}):
        with pytest.raises(ValueError, match=r"tip relief|tip_start_length_mm = 50"):
            gf.new_scene(tmp_path / "other.toml", **wrong)


def test_torque_and_crack_asked_for_are_those_of_the_scene(tmp_path):
    chosen = gf.load_scene(gf.new_scene(tmp_path / "my.toml", **LOADED)).pair()
    assert chosen.force * chosen.pair.gear_1.r_b == pytest.approx(60e3)
    (crack,) = chosen.damage["cracked"]["pinion"]
    assert (crack.length, math.degrees(crack.angle)) == pytest.approx((1.5, 60.0))
    for wrong, words in (({"torque_Nm": -1.0}, "must be positive"), ({"crack": (2.0, 120.0)}, "between 5 and 90 degrees")):
        with pytest.raises(ValueError, match=words):
            gf.new_scene(tmp_path / "other.toml", **wrong)


def test_a_ring_of_the_default_teeth_needs_no_trimming(tmp_path):
    assert not gf.load_scene(gf.new_scene(tmp_path / "my.toml", ring=True)).pair().pair.notes


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


@pytest.mark.slow
def test_written_scene_runs_on_the_command_line(tmp_path, capsys):
    path = str(tmp_path / "my.toml")
    assert main(["new", path, "--teeth", "17", "23", "--width", "8"]) == 0
    assert main(["stiffness", path, "--phases", "4"]) == 0
    assert main(["compare", path, "--case", "cracked", "--phases", "4", "--refine", "0.4"]) == 0
    assert "z = 17" in (tmp_path / "my.toml").read_text()
    assert "| single " in capsys.readouterr().out


@pytest.mark.parametrize("options", OPTIONS)
def test_all_that_a_scene_can_say_stands_in_it_and_holds(options, tmp_path):
    """Every key of the loader is written; with the # taken away from all of them the scene is read."""
    text = gf.new_scene(tmp_path / "my.toml", **options).read_text()
    machine = ("machine", "impact", "body")
    tables = [table for name, table in scene_schema().items() if name not in ("row", "ring_support") and name not in machine]
    keys = [key for table in tables for key in table.keys if key not in ("given", "later", "machine")]
    keys += [] if options.get("ring") else [key for name in machine for key in scene_schema()[name].keys]
    assert not [key for key in keys if not re.search(rf"\b{key}\b", text)]
    (tmp_path / "all.toml").write_text(re.sub(r"^#(?=[\w\[])", "", text, flags=re.M))
    scene = gf.load_scene(tmp_path / "all.toml")
    chosen = scene.pair()
    assert set(chosen.damage) == {"cracked", "cracked_part", "pitted", "spalled", "missing", "chipped"}
    assert set(chosen.supports) == {"pinion", "wheel"}
    assert chosen.flanks["pinion"].tip_relief == pytest.approx(
        1e-3 * options.get("tip_relief_um", 10 * options.get("module", 2.0))
    )
    assert chosen.flanks["wheel"].tip_relief == chosen.flanks["pinion"].tip_relief
    assert chosen.misalignment.F_beta_x == 0.01
    assert bool(scene.machine) is not options.get("ring", False)
    if scene.machine:
        assert scene.machine["torque_Nm"] == pytest.approx(chosen.force * 1e-3 * chosen.pair.gear_1.r_b, abs=0.01)


def test_length_of_the_crack_beside_its_level_is_the_same_crack(tmp_path):
    path = gf.new_scene(tmp_path / "my.toml")
    run = {"phases": [0.8], "method": "ritz"}
    level = gf.mesh_stiffness(gf.load_scene(path).pair().case("cracked"), **run)
    path.write_text(re.sub(r"^level = 0.3  #.* or as a length: (length_mm = [\d.]+)", r"\1", path.read_text(), flags=re.M))
    crack = gf.load_scene(path).pair().damage["cracked"]["pinion"][0]
    assert crack.level is None
    assert gf.mesh_stiffness(gf.load_scene(path).pair().case("cracked"), **run).k[0] == pytest.approx(level.k[0], rel=2e-3)


@pytest.mark.parametrize(
    "options",
    [
        {"torque_Nm": 1e9}, {"torque_Nm": 1e-9}, {"width": 1e-9}, {"module": math.nan}, {"helix_deg": 80.0}, {"teeth": (21,)},
        {"teeth": (21.5, 31)}, {"crack": (1e9, 45.0)}, {"tip_relief_um": 20000.0, "tip_length_mm": 1.0}, {"tip_relief_um": 5.0},
    ],
)  # fmt: skip
def test_a_pair_that_check_rejects_is_not_written(tmp_path, options):
    with pytest.raises(ValueError):  # noqa: PT011 - for many reasons
        gf.new_scene(tmp_path / "my.toml", **options)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["a\nb.toml", "a\x1bb.toml", "a\udc80b.toml"])
def test_a_name_that_no_comment_can_hold_is_refused(tmp_path, name):
    with pytest.raises(ValueError, match="printable characters"):
        gf.new_scene(tmp_path / name)


@pytest.mark.parametrize("name", ["", "healthy"])
def test_a_case_of_damage_is_not_called_as_health_is(tmp_path, name):
    file = gf.new_scene(tmp_path / "my.toml")
    file.write_text(file.read_text().replace('case = "cracked"', f'case = "{name}"', 1))
    with pytest.raises(ValueError, match=f"case = '{name}': this names gears without damage"):
        gf.load_scene(file)


def test_shift_pressure_angle_and_bores_of_a_new_scene(tmp_path):
    gf.new_scene(tmp_path / "a.toml", teeth=(24, 43), module=3.0, x=(0.2, -0.1), alpha_deg=22.5, bore_mm=(30.0, 50.0))
    scene = gf.load_scene(tmp_path / "a.toml")
    one, two = scene.gears.values()
    assert (one.x, two.x, one.r_bore, two.r_bore, scene.assumptions) == (0.2, -0.1, 15.0, 25.0, ())
    assert_allclose([one.alpha_n, two.alpha_n], math.radians(22.5), rtol=1e-15)


def test_a_pair_states_its_torque_or_its_force(tmp_path):
    gf.new_scene(tmp_path / "a.toml", torque_Nm=80.0)
    text = re.sub("(?m)^force_N = .*$", "torque_Nm = 80", (tmp_path / "a.toml").read_text())
    (tmp_path / "b.toml").write_text(text)
    want, found = (gf.load_scene(tmp_path / name).pair().force for name in ("a.toml", "b.toml"))
    assert_allclose(found, want, rtol=1e-6)
    (tmp_path / "c.toml").write_text(text.replace("\ntorque_Nm = 80", "\nforce_N = 10.0\ntorque_Nm = 80"))
    with pytest.raises(ValueError, match="exclude each other"):
        gf.load_scene(tmp_path / "c.toml")
