import json

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy.io import loadmat

import gearfe as gf

pytestmark = pytest.mark.quick


@pytest.fixture(scope="module")
def curve(pair, steel):
    return gf.mesh_stiffness(pair, 2000.0, steel, method="textbook", phases=16)


def test_csv_round_trip_is_exact(pair, steel, tmp_path):
    more = {"flanks": {"pinion": gf.Flank(profile_slope=0.01)}, "supports": {"wheel": gf.Support(radial=2e5)}}
    before = gf.mesh_stiffness(pair, 2000.0, steel, phases=8, **more)
    before.to_csv(tmp_path / "k.csv")
    after = gf.StiffnessCurve.from_csv(tmp_path / "k.csv")
    for name in ("phase", "k", "k_tangent", "deflection", "order", "force", "pressure", "unloaded", "support_deflection"):
        assert_array_equal(getattr(after, name), getattr(before, name), err_msg=name)
    assert after.error is None
    assert after.meta == json.loads(json.dumps(before.meta))


def test_numpy_scalars_in_the_input_can_be_saved(tmp_path):
    rack = {"m_n": np.float32(2), "alpha_n": np.radians(20), "b": np.int64(20)}
    pair = gf.GearPair(gf.Gear(z=np.int64(21), r_bore=np.float64(7.4), **rack), gf.Gear(z=31, r_bore=11, **rack))
    steel = gf.Material(E=np.float64(207e3), nu=np.float32(0.3))
    damage = {"pinion": [gf.Crack(level=np.float64(0.2), tooth=np.int64(0))]}
    gf.mesh_stiffness(pair, np.float64(2000), steel, phases=[0.2, 0.4], damage=damage).save(tmp_path / "k.json")
    gf.write_inp(tmp_path / "k.inp", pair.gear_1, 21.5, 10.0, steel, refine=0.5)
    assert "np.float" not in (tmp_path / "k.inp").read_text()


def test_plot_of_a_tooths_engagement_runs_forward(pair, steel):
    figure = gf.mesh_stiffness(pair, 2000.0, steel, method="textbook", phases=16, span="tooth").plot()
    assert (np.diff(figure.axes[0].lines[0].get_xdata()) >= 0).all()  # jumps are upright


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
