"""Gearboxes in sweeps, data sets, pages and the live page: their values reach every case."""

import copy

import numpy as np
import pytest
from gearboxes import BRANCHING
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.scene.load import scene_of
from gearfe.scene.toml_file import toml

pytest.importorskip("pyarrow")
TABLES = copy.deepcopy(BRANCHING) | {"crack": [{"case": "hurt", "gear": "c", "tooth": 11, "level": 0.4}]}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("box")
    (path / "box.toml").write_text(toml(TABLES), encoding="utf-8")
    return path


def test_a_sweep_of_the_torque_solves_each_stage_under_its_own_load(folder):
    study = {
        "title": "torque",
        "scene": str(folder / "box.toml"),
        "kind": "stiffness",
        "pair": "right",
        "options": {"phases": 16},
    }
    found = gf.sweep(study | {"vary": {"machine.torque_Nm": [15.0, 30.0]}}, folder / "runs", workers=1).table()
    for torque, mean in zip(found["machine.torque_Nm"], found["k_mean"], strict=True):
        scene = scene_of("box.toml", TABLES | {"machine": TABLES["machine"] | {"torque_Nm": torque}})
        right = (torque - 20.0 * 20 / 41) / scene.gears["a"].r_b * 1e3  # what the pump leaves, on the base circle of the driver
        assert_allclose(scene.pair("right").force, right, rtol=1e-12)
        assert_allclose(mean, gf.solve(scene.case("right"), gf.Solve(phases=16)).k.mean(), rtol=1e-9)


def test_a_data_set_labels_the_tooth_of_its_gear(folder):
    plan = {
        "title": "box", "scene": str(folder / "box.toml"), "phases": 16,
        "window": {"seconds": 0.2, "rate_Hz": 5120.0, "harmonics": 1},
        "operation": {"speed_rpm": [1500.0], "torque_Nm": [18.0]},
        "fault": [{"kind": "crack", "gear": "c", "tooth": 11, "severity": [0.4]}],
        "sensor": [{"name": "bearing", "channel": "spring bearing down1 x"}],
        "split": {"train": 1.0, "validation": 0.0, "test": 0.0},
    }  # fmt: skip
    gf.dataset(plan, folder / "set", workers=1)
    signals, rows = gf.open_dataset(folder / "set").windows()
    place = int(np.flatnonzero(rows["fault"] != "healthy")[0])
    hurt = rows.iloc[place]
    assert (hurt["body"], hurt["tooth"], hurt["unit"]) == ("c", 11, "N")
    assert_allclose(hurt["turning_Hz"], 25 * 20 / 53, rtol=1e-9)
    assert np.ptp(signals[place]) > 0
