"""A small data set: what its windows hold against independent ways to it, no leakage, stopped and continued; and its verb."""

import copy
import json
import re
import shutil

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.io import loadmat
from test_dataset_plan import changed

import gearfe as gf
from gearfe.app.cli import main
from gearfe.planetary_sets.added import added_compliance
from gearfe.runs.datasets import make
from gearfe.runs.datasets.conditions import conditions
from gearfe.runs.datasets.plan import read_plan
from gearfe.runs.datasets.windows import simulated

PLAN = changed(
    repeats=2,
    operation={"speed_rpm": [1000.0], "torque_Nm": [80.0], "spread": 0.01},
    fault=[{"kind": "crack", "gear": "sun", "severity": [0.4]}],
    sensor=[
        {"name": "force", "channel": "force sun_planet1", "noise": [0.0, 20.0]},
        {"name": "housing", "housing": "planet_ring", "angle_deg": 90.0, "noise": [0.0]},
    ],
    scatter={"machine.runout_um": {"uniform": [5.0, 10.0]}},
    split={"train": 0.5, "validation": 0.0, "test": 0.5},
)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return gf.dataset(PLAN, tmp_path_factory.mktemp("set"), also=["mat", "hdf5"], workers=1)


@pytest.fixture
def plan():
    return copy.deepcopy(PLAN)


@pytest.mark.slow
def test_windows_are_those_of_the_simulation(made, plan):
    """Mean and strongest lines, in size and phase, against those of the fine response that the windows were cut from."""
    plan = read_plan(plan)
    (condition,) = [one for one in conditions(plan) if one.number == 2]
    assert condition.label == "crack"
    _, response, _ = simulated(plan, condition)
    signals, labels = made.windows({"condition": 2, "sensor": "force", "noise": 0.0})
    assert labels["window"].tolist() == [0, 1]
    assert signals.shape == (2, 400)
    assert signals.dtype == np.float32
    starts = labels["start_s"].to_numpy()
    inside = (response.time >= starts[0]) & (response.time < starts[-1] + 0.05)
    fine, at = response["force sun_planet1"][inside], response.time[inside] - starts[0]
    assert_allclose(signals.mean(), fine.mean(), rtol=1e-4)
    frequency = np.arange(50.0, 3000.0, 5.0)

    def lines(values, time):
        weight = np.sin(np.pi * time / 0.1) ** 2
        return np.exp(-2j * np.pi * np.outer(frequency, time)) @ (weight * (values - values.mean())) / weight.sum()

    want, got = lines(fine, at), lines(signals.ravel(), np.arange(800) / 8000.0)
    strong = np.argsort(-np.abs(want))[:5]  # one sample too early or late turns them by 0.1 and more
    assert (np.abs(got - want)[strong] < 0.02 * np.abs(want)[strong]).all()


def test_loss_of_stiffness_is_that_of_the_curves(made):
    """The label against `mesh_stiffness` of the damaged and the healthy tooth at the same force, both in the scene's set."""
    labels = made.labels({"fault": "crack"})
    row = labels.iloc[0]
    scene = gf.load_scene("planetary_pitting")
    pair, added = scene.pair("sun_planet"), added_compliance(scene).added[0].mean()
    run = pair.case().as_dict() | {"force": 2000.0 * row["torque_Nm"] / 100.0, "span": "tooth", "method": "ritz"}
    hurt = gf.mesh_stiffness(**run, damage={"pinion": [gf.Crack(level=0.4)]})
    loss = 1 - hurt.with_compliance(added).k / gf.mesh_stiffness(**run).with_compliance(added).k
    assert_allclose(row["loss_max"], loss.max(), atol=2e-3)
    assert_allclose(row["loss_mean"], loss.mean(), atol=5e-3)
    assert made.labels({"fault": "healthy"})["loss_max"].max() == 0.0


def test_noise_is_of_the_stated_size_and_no_other(made):
    clean, _ = made.windows({"sensor": "force", "noise": 0.0})
    noisy, labels = made.windows({"sensor": "force", "noise": 20.0})
    noise = noisy - clean
    assert_allclose(noise.std(), 20.0, rtol=0.03)
    assert abs(np.corrcoef(noise[0], noise[1])[0, 1]) < 0.2
    rms = labels["rms"].to_numpy()
    assert_allclose(labels["snr_dB"], 20 * np.log10(rms / 20.0))


def test_no_condition_lies_on_two_sides(made):
    labels = made.labels()
    assert (labels.groupby("condition")["side"].nunique() == 1).all()
    assert set(labels["side"]) == {"train", "test"}
    assert len(labels) == len(made) == 4 * 2 * 3
    assert labels["error"].max() < 5e-3
    signals, labels = made.windows({"sensor": "housing"})
    train, test = (signals[(labels["side"] == side).to_numpy()] for side in ("train", "test"))
    assert not any((one == other).all() for one in train for other in test)


def test_mat_and_hdf5_hold_the_same(made):
    import h5py

    signals, labels = made.windows({"side": "test"})
    mat = loadmat(made.folder / "test.mat")
    assert (mat["signals"] == signals).all()
    assert [one.item() for one in mat["fault"].ravel()] == labels["fault"].tolist()
    with h5py.File(made.folder / "test.h5") as file:
        assert (file["signals"][:] == signals).all()
        assert [one.decode() for one in file["sensor"][:]] == labels["sensor"].tolist()
        assert file["speed_rpm"].attrs["units"] == "rpm"
    assert not (made.folder / "validation.mat").exists()


def test_card_counts_what_is_there(made):
    text = (made.folder / "card.md").read_text(encoding="utf-8")
    labels = made.labels()
    cracked = labels[labels["fault"] == "crack"]
    count = (cracked["side"] == "train").sum()
    assert f"| crack | {cracked['gear'].iloc[0]} | 0.4 | {count} | 0 |" in text
    assert "no signal of the healthy machine" not in text
    assert "half of the amplitude at 4000 Hz" in text


@pytest.mark.slow
def test_stopped_and_continued_is_the_same(made, plan, tmp_path, monkeypatch):
    """Two conditions taken away and made again, in a folder begun before: file by file the same."""
    folder = tmp_path / "again"
    shutil.copytree(made.folder, folder)
    for number in (1, 3):
        (folder / "windows" / f"condition-{number:06d}.parquet").unlink()
    (folder / "windows" / ".part-killed").write_bytes(b"half")
    asked = []
    real = make.simulate_condition
    monkeypatch.setattr(make, "simulate_condition", lambda plan, one: asked.append(one.number) or real(plan, one))
    gf.dataset(plan, folder, workers=1)
    assert asked == [1, 3]
    names = sorted(one.name for one in (made.folder / "windows").glob("*.parquet"))
    assert names == sorted(one.name for one in (folder / "windows").iterdir() if one.name != ".lock")
    for name in names:
        assert (folder / "windows" / name).read_bytes() == (made.folder / "windows" / name).read_bytes(), name


def test_other_folders_are_refused_and_left_alone(made, plan, tmp_path):
    with pytest.raises(ValueError, match="another plan, begun with seed = 3, not 4"):
        gf.dataset(plan | {"seed": 4}, made.folder, workers=1)
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(ValueError, match="holds other files"):
        gf.dataset(plan, tmp_path, workers=1)
    assert [one.name for one in tmp_path.iterdir()] == ["letter.txt"]
    about = json.loads((made.folder / "_about.json").read_text())
    assert about["conditions"] == 4
    with pytest.raises(ValueError, match="no column 'colour'"):
        made.labels({"colour": 1})
    with pytest.raises(ValueError, match="where: side = 'trian', but no row has that; there is "):
        made.windows({"side": "trian"})
    with pytest.raises(ValueError, match="form = 'xls'"):
        made.export("xls")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"window": {"seconds": 0.05, "rate_Hz": 2000.0, "harmonics": 5}}, r"5 harmonics of the mesh at 1000 rpm reach 141\d Hz"),
        ({"window": {"seconds": 0.01, "rate_Hz": 8000.0}}, "may not contain the damage"),
        ({"sensor": [{"name": "moon", "channel": "moon.x"}]}, "moon: no channel 'moon.x'"),
        ({"sensor": [{"name": "h", "housing": "moon"}]}, "no mesh has a name such as 'moon1'"),
    ],
)
def test_what_shows_no_fault_is_refused_before_work(given, said, plan, tmp_path):
    with pytest.raises(ValueError, match=said):
        gf.dataset(plan | given, tmp_path / "set", workers=1)
    assert not (tmp_path / "set").exists()


def test_a_condition_that_fails_is_recorded(plan, tmp_path, monkeypatch):
    plan |= {"sensor": [{"name": "ring", "channel": "ring.x"}]}
    monkeypatch.setattr(make, "rows_of", lambda plan, one: (_ for _ in ()).throw(RuntimeError("grew beyond all bounds")))
    made = gf.dataset(plan, tmp_path / "set", workers=1)
    assert len(made.failed()) == 4
    assert "grew beyond all bounds" in next(iter(made.failed().values()))
    assert "4 of 4" in (tmp_path / "set" / "card.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_several_processes_make_the_same(made, plan, tmp_path):
    gf.dataset(plan, tmp_path / "set", workers=2)
    for one in (made.folder / "windows").glob("*.parquet"):
        assert (tmp_path / "set" / "windows" / one.name).read_bytes() == one.read_bytes(), one.name


def toml(plan):
    """A plan as TOML: JSON with ``=`` for ``:`` is nearly that."""
    return "\n".join(f"{name} = {_value(value)}" for name, value in plan.items())


def _value(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(name)} = {_value(one)}" for name, one in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(_value(one) for one in value) + "]"
    return json.dumps(value)


def test_verb_goes_on_with_a_folder(made, plan, tmp_path, capsys):
    (tmp_path / "set.toml").write_text(toml(plan))
    assert main(["dataset", str(tmp_path / "set.toml"), "-o", str(made.folder), "--workers", "1"]) == 0
    text = capsys.readouterr().out
    assert "cracks: 24 windows of 4 conditions" in text
    labels = made.labels()
    lost = labels["loss_max"][(labels["fault"] == "crack") & (labels["severity"] == 0.4)].mean()
    assert float(re.search(r"crack \w+ 0\.4 .*loss of stiffness ([\d.]+) %", text)[1]) == pytest.approx(100 * lost, abs=0.051)
    assert "described in card.md" in text


@pytest.mark.slow
def test_dry_run_says_what_it_takes_and_writes_nothing(made, plan, tmp_path, capsys):
    (tmp_path / "set.toml").write_text(toml(plan))
    assert main(["dataset", str(tmp_path / "set.toml"), "-o", str(tmp_path / "new"), "--dry-run", "--workers", "1"]) == 0
    text = capsys.readouterr().out
    assert "4 conditions, 24 windows" in text
    there = sum(one.stat().st_size for one in (made.folder / "windows").glob("*.parquet"))
    assert float(re.search(r"disk: about ([\d.]+) MB", text)[1]) == pytest.approx(there / 1e6, rel=0.05)
    assert not (tmp_path / "new").exists()


def test_refusals_are_one_line(tmp_path, capsys):
    (tmp_path / "set.toml").write_text(toml(changed(fault=[{"kind": "rust", "severity": [1.0]}])))
    assert main(["dataset", str(tmp_path / "set.toml"), "-o", str(tmp_path / "new")]) == 1
    assert "kind = 'rust', but it must be one of crack" in capsys.readouterr().err
