"""Many cases at once, and the error map made of them."""

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.runs.errormap import CRACKED, HEALTHY, RANGES, ErrorMap, build

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 1.0}
PAIR = gf.GearPair(gf.Gear(z=18, r_bore=9.0, **RACK), gf.Gear(z=27, r_bore=12.0, **RACK))
CASES = [{"pair": PAIR, "force": force, "material": gf.Material(), "phases": 8} for force in (50.0, 100.0, -1.0, 200.0)]


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_a_batch_is_its_cases_in_order(workers, monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    seen = []
    done = gf.batch(CASES, workers=workers, progress=lambda done, total: seen.append((done, total)))
    assert done.workers == workers
    assert seen == [(k, 4) for k in (1, 2, 3, 4)]
    assert all(s > 0 for s in done.seconds)
    assert isinstance(done.results[2], ValueError), "a case that cannot be does not stop the others"
    for k in (0, 1, 3):
        assert_allclose(done.results[k].k, gf.mesh_stiffness(**CASES[k]).k, rtol=1e-9)
    assert os.environ["OMP_NUM_THREADS"] == "7", "the environment is as before"


def test_what_cannot_be_handed_to_processes_is_refused():
    with pytest.raises(ValueError, match="workers = 1"):
        gf.batch([{"x": 1}, {"x": 2}], work=lambda x: x, workers=2)
    assert gf.batch([{"x": 1}], work=lambda x: x, workers=1).results == [1]
    with pytest.raises(ValueError, match="workers = 0"):
        gf.batch([], workers=0)


ENVIRONMENT = os.environ | {"PYTHONPATH": str(Path(gf.__file__).parents[1])}
PLAIN = """
import gearfe as gf

with open(__file__ + ".runs", "a") as file:
    file.write("once")
done = gf.batch([{"E": 1e5}, {"E": 2e5}], work=gf.Material, workers=2)
print(len(done.results), open(__file__ + ".runs").read())

def work(x):
    return x

gf.batch([{"x": 1}, {"x": 2}], work=work, workers=2)
"""


@pytest.mark.slow
def test_a_plain_script_runs_once_however_many_workers(tmp_path):
    """Its main module is not imported by the workers; without that it would run once for each of them, and fail."""
    file = tmp_path / "plain.py"
    file.write_text(PLAIN)
    done = subprocess.run([sys.executable, file], capture_output=True, text=True, timeout=120, check=False, env=ENVIRONMENT)
    assert done.stdout.split() == ["2", "once"], done.stderr
    assert done.returncode == 1
    assert "__main__" in done.stderr.splitlines()[-1]
    assert len(done.stderr.splitlines()) < 40, done.stderr


@pytest.fixture(scope="module")
def found():
    return gf.error_map(4, seed=1, loads=(20.0, 100.0), phases=12, workers=1)


@pytest.mark.slow
def test_rows_of_the_map(found):
    columns = found.columns
    assert columns["load"].size == 4 * 2 + 2 * 2, "every pair healthy, every second one also cracked, at two loads"
    assert set(columns["load"]) == {20.0, 100.0}
    for name, (low, high) in RANGES.items():
        assert ((columns[name] >= low) | ((columns[name] == 0) & (name == "crack"))).all()
        assert (columns[name] <= high).all()
    healthy = found.rows(crack=(0, 0))
    assert np.isfinite(columns["textbook mean"][healthy]).all()
    assert np.isnan(columns["textbook mean"][~healthy]).all()
    assert np.isfinite(columns["textbook straight single"][~healthy]).any()
    assert set(found.formulations) == {*HEALTHY, *CRACKED}


def test_a_row_of_the_map_is_what_the_methods_give(found):
    row = int(np.flatnonzero(found.rows(crack=(0, 0), load=(100, 100)))[0])
    pair = build({name: found.columns[name][row] for name in RANGES})
    run = {"material": gf.Material(), "phases": (np.arange(12) + 0.5) / 12, "extended": False}
    truth, formula = (gf.mesh_stiffness(pair, 100.0, method=m, **run).zones() for m in ("ritz", "textbook"))
    for zone in ("double", "mean", "max"):
        assert_allclose(found.columns[f"k {zone}"][row], truth[zone] * 1e-6, rtol=1e-9)
        assert_allclose(found.columns[f"textbook {zone}"][row], formula[zone] / truth[zone] - 1, rtol=1e-6)


def test_bands(found):
    low, middle, high, share, count = found.bands("textbook", "mean", crack=(0, 0))
    error = found.columns["textbook mean"][found.rows(crack=(0, 0))]
    assert_allclose([low, middle, high], np.percentile(error, [5, 50, 95]))
    assert_allclose(share, (np.abs(error) < 0.03).mean())
    assert count == 8
    assert math.isnan(found.bands("textbook", "mean", load=(1, 2))[0])


@pytest.mark.parametrize("pairs", [0, 1.5])
def test_impossible_number_of_pairs(pairs):
    with pytest.raises(ValueError, match="pairs = "):
        gf.error_map(pairs)


def test_models_too_soft_count_as_those_too_stiff():
    """Of four errors two are within 3 %, whichever way."""
    columns = {"load": np.ones(4), "mine mean": np.array([-0.5, -0.02, 0.02, 0.5])}
    made = ErrorMap(columns, ("mine",))
    assert made.bands("mine")[3:] == (0.5, 4)
