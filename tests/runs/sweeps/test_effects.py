"""Read-outs of sweeps, on stores whose truth is known."""

import json
import math

import numpy as np
import pytest

import gearfe as gf
from gearfe.runs.store import folder as place
from gearfe.runs.store.shards import ShardColumn, encoded, table, write_shard
from gearfe.runs.sweeps.runs import FORMAT, SHAPE
from gearfe.runs.sweeps.samples import cube


def stored(folder, points, outputs, sample, extra=None, cases=None):
    """Runs of drawn inputs a, b, c with an output ``y`` and a curve."""
    names = ("a", "b", "c")
    study = {"kind": "stiffness", "pair": "p", "case": "c", "options": {}, "axes": [], "sample": sample, "seed": 0, "block": 1}
    about = {
        "format": FORMAT,
        "title": "known",
        "cases": cases or len(points),
        "study": json.loads(json.dumps(study)),
        "made": {},
    }
    place.begin(folder, about, SHAPE)
    fields = {"number": ShardColumn("whole"), "point": ShardColumn("whole"), "draw": ShardColumn("whole")}
    fields |= {name: ShardColumn("number") for name in names} | {
        "y": ShardColumn("number", "m"),
        "phase": ShardColumn("list"),
        "k": ShardColumn("list", "N/m"),
    }
    fields |= {"status": ShardColumn("text")}
    rows = [
        {"number": i, "point": 0, "draw": i, **dict(zip(names, x, strict=True)), "y": y, "status": "done"}
        | {"phase": [0.0, 0.5], "k": [y, 2 * y]}
        for i, (x, y) in enumerate(zip(points.tolist(), outputs.tolist(), strict=True))
    ]
    rows += extra or []
    write_shard(folder, "block-000000", encoded(table(rows, fields)))
    return gf.open_runs(folder)


def test_sobol_indices_are_those_of_ishigami(tmp_path):
    """T. Ishigami, T. Homma, ISUMA (1990): first order 0.3139, 0.4424, 0; total 0.5576, 0.4424, 0.2437 (a = 7, b = 0.1)."""
    points = cube("saltelli", 2**10, 3, 1)
    x = 2 * math.pi * points - math.pi
    y = np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])
    sample = {"method": "saltelli", "count": 2**10, "of": {name: {"uniform": [0, 1]} for name in "abc"}}
    found = gf.sobol_indices(stored(tmp_path / "runs", points, y, sample), "y")
    for name, truth in (("first", [0.3139, 0.4424, 0.0]), ("total", [0.5576, 0.4424, 0.2437])):
        wide = (found[f"{name}_high"] - found[f"{name}_low"]) / 2  # of the 95 % interval: two standard errors
        assert (np.abs(found[name] - truth) < 1.5 * wide).all(), found
        assert (wide < 0.15).all(), found


def test_main_effects_and_bands_of_a_sum(tmp_path):
    points = cube("latin", 800, 3, 2)
    sample = {"method": "latin", "count": 800, "of": {name: {"uniform": [0, 1]} for name in "abc"}}
    failed = [{"number": 800, "draw": 800, "a": 0.5, "b": 0.5, "c": 0.5, "status": "failed"}]
    runs = stored(tmp_path / "runs", points, 3 * points[:, 0] + points[:, 1], sample, failed)
    effects = gf.main_effects(runs, "y").set_index("input")
    a = effects.loc["a"]
    np.testing.assert_allclose(a["mean"], 3 * a["value"].astype(float) + 0.5, atol=0.1)
    assert np.ptp(effects.loc["c"]["mean"]) < 0.25
    assert effects.loc["a"]["cases"].sum() == 800
    bands = gf.curve_bands(runs, "k", percentiles=(10, 50, 90))
    np.testing.assert_allclose(bands["k"][:, 1], 2 * bands["k"][:, 0])
    np.testing.assert_allclose(bands["k"][1, 0], 2.0, atol=0.05)
    assert bands["k"].attrs["units"] == "N/m"
    with pytest.raises(ValueError, match="'latin', but Sobol indices need"):
        gf.sobol_indices(runs, "y")
    with pytest.raises(ValueError, match="no column of numbers"):
        gf.main_effects(runs, "status")
    with pytest.raises(ValueError, match="no finished case"):
        gf.main_effects(runs, "y", {"status": "failed"})


def test_a_missing_draw_is_said(tmp_path):
    points = cube("saltelli", 8, 3, 1)
    sample = {"method": "saltelli", "count": 8, "of": {name: {"uniform": [0, 1]} for name in "abc"}}
    runs = stored(tmp_path / "runs", points[:-1], points[:-1, 0], sample, cases=40)
    with pytest.raises(ValueError, match="each of the 40 draws once, but there are 39"):
        gf.sobol_indices(runs, "y")


def test_told_apart_of_normal_values():
    """Of two normal distributions of the same spread: the normal distribution of their distance over sqrt(2) spreads."""
    drawn = np.random.default_rng(4)
    found = gf.roc_auc(drawn.normal(0, 1, 4000), drawn.normal(1, 1, 4000))
    assert abs(found - 0.76025) < 0.01
    assert gf.roc_auc([1, 2], [3, 4]) == 1
    assert gf.roc_auc([1, 2], [1, 2]) == 0.5


def test_bands_have_only_places_that_all_cases_have(tmp_path):
    """A curve without a value at a place: the percentiles of the rest would be those of other cases."""
    sample = {"method": "latin", "count": 4, "of": {name: {"uniform": [0, 1]} for name in "abc"}}
    hole = [{"number": 4, "draw": 4, "a": 0.5, "b": 0.5, "c": 0.5, "status": "done", "phase": [0.0, 0.5], "k": [math.nan, 10.0]}]
    runs = stored(tmp_path / "runs", cube("latin", 4, 3, 2), np.array([1.0, 2.0, 3.0, 4.0]), sample, hole)
    bands = gf.curve_bands(runs, "k", percentiles=(0, 50, 100))
    assert bands["k"].shape == (3, 1)
    np.testing.assert_allclose(bands["k"][:, 0], [2.0, 6.0, 10.0])  # of 2, 4, 6, 8, 10
