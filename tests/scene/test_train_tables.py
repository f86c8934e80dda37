"""Tables of a gearbox in a scene: names in lists, and other values that reach the whole train."""

import copy
from dataclasses import replace

import pytest
from gearboxes import TWO_STAGE
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.scene.load import scene_of
from gearfe.scene.toml_file import toml


@pytest.mark.parametrize(("key", "value", "message"), [
    ("gears", ["nope"], r"own.toml \[shaft.one\] gears = 'nope': no such gear"),
    ("bearings", ["one"], r"\[shaft.one\] bearings = 'one': no such bearing"),
    ("bearings_N_per_um", [150.0, 90.0, 40.0], "give 2 entries, one for each section, gear or bearing"),
    ("bearings", ["one", "two"], r"\[shaft.one\] bearings = 'one': no such bearing"),
])  # fmt: skip
def test_names_in_lists_are_those_of_tables(key, value, message):
    tables = copy.deepcopy(TWO_STAGE)
    tables["shaft"]["one"][key] = value
    with pytest.raises(ValueError, match=message):
        scene_of("own.toml", tables)


@pytest.mark.parametrize("change", [{"speed_rpm": 3000.0}, {"torque_Nm": 10.0}])
def test_other_speeds_and_torques_reach_the_whole_train(change, tmp_path):
    """A copy of a scene with another speed had the former one on its shafts."""
    (tmp_path / "own.toml").write_text(toml(TWO_STAGE), encoding="utf-8")
    scene = gf.load_scene(tmp_path / "own.toml")
    with pytest.raises(ValueError, match=r"scene own: a speed, torque or force was replaced.*load_scene\(..., values="):
        replace(scene, machine=scene.machine | change)
    ((key, value),) = change.items()
    other = gf.load_scene(tmp_path / "own.toml", {f"machine.{key}": value})
    ratio = value / TWO_STAGE["machine"][key]
    before, after = ({"speed_rpm": one.train.speeds, "torque_Nm": one.train.torques}[key] for one in (scene, other))
    assert_allclose([*after.values()], [ratio * number for number in before.values()], rtol=1e-12)
    with pytest.raises(ValueError, match="there is no 'speed'"):
        gf.load_scene(tmp_path / "own.toml", {"machine.speed": 1.0})
