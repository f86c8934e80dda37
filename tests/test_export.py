import json

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy.io import loadmat

import gearfe as gf


@pytest.fixture(scope="module")
def curve(pair, steel):
    return gf.mesh_stiffness(pair, 2000.0, steel, method="textbook", phases=16)


def test_csv_round_trip_is_exact(pair, steel, tmp_path):
    before = gf.mesh_stiffness(pair, 2000.0, steel, phases=8)
    before.to_csv(tmp_path / "k.csv")
    after = gf.StiffnessCurve.from_csv(tmp_path / "k.csv")
    for name in ("phase", "k", "k_tangent", "lte", "order", "force", "pressure"):
        assert_array_equal(getattr(after, name), getattr(before, name), err_msg=name)
    assert after.error is None
    assert after.meta == before.meta


def test_other_formats(curve, tmp_path):
    for suffix in ("npz", "mat", "json"):
        curve.save(tmp_path / f"k.{suffix}")
    assert_array_equal(np.load(tmp_path / "k.npz")["k"], curve.k)
    assert_array_equal(loadmat(tmp_path / "k.mat")["k"].ravel(), curve.k)
    data = json.loads((tmp_path / "k.json").read_text())
    assert data["k"] == curve.k.tolist()
    assert data["units"]["k"] == "N/m"
    assert data["meta"]["force_N"] == 2000.0
    assert data["pressure"][0] == [None, None], "nan has no place in JSON"


def test_meta_names_what_is_needed_to_repeat_it(curve):
    assert curve.meta["gear_1"]["r_bore"] == 7.4
    assert {"force_N", "width_mm", "a_mm", "materials", "method", "versions"} <= curve.meta.keys()


@pytest.mark.parametrize("name", ["missing/k.csv", "missing/k.npz", "missing/k.mat", "missing/k.json"])
def test_unwritable_path(curve, tmp_path, name):
    with pytest.raises(ValueError, match=r"cannot write .*existing, writable folder"):
        curve.save(tmp_path / name)


def test_a_failed_write_leaves_nothing(curve, tmp_path, monkeypatch):
    target = tmp_path / "k.json"
    target.write_text("old")
    monkeypatch.setitem(curve.meta, "bad", object())
    with pytest.raises(TypeError):
        curve.save(target)
    assert [p.name for p in tmp_path.iterdir()] == ["k.json"]
    assert target.read_text() == "old"


def test_unknown_suffix(curve, tmp_path):
    with pytest.raises(ValueError, match=r"use one of \.csv, \.npz, \.mat, \.json"):
        curve.save(tmp_path / "k.xls")


def test_damaged_files(curve, tmp_path):
    path = tmp_path / "k.csv"
    with pytest.raises(ValueError, match="cannot read"):
        gf.StiffnessCurve.from_csv(path)
    path.write_text("phase,k\n0,1\n")
    with pytest.raises(ValueError, match="not a curve written by gearfe"):
        gf.StiffnessCurve.from_csv(path)
    curve.to_csv(path)
    lines = path.read_text().splitlines()
    for change, message in (
        ([*lines[:3], lines[4], lines[3], *lines[5:]], "phase must rise, but line 5"),
        ([*lines[:4], lines[4] + ",1", *lines[5:]], "damaged|numbers"),
        ([*lines[:3], lines[3].replace("0.0,", "zero,", 1), *lines[4:]], "damaged table"),
        ([*lines[:2], lines[2].replace("k [N/m]", "k [kN/m]", 1), *lines[3:]], r"no column 'k \[N/m\]'"),
        (lines[:2], "not a curve"),
    ):
        path.write_text("\n".join(change))
        with pytest.raises(ValueError, match=message):
            gf.StiffnessCurve.from_csv(path)
