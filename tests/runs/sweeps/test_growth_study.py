"""Studies of crack growth: scatter of the law and of the start, on a tooth of either gear."""

import numpy as np
import pytest
from gearboxes import STEEL, gear
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.runs.sweeps.blocks import blocks, rows
from gearfe.runs.sweeps.study import read_study
from gearfe.scene.toml_file import toml

OPTIONS = {"C": 1e-13, "m": 3.0, "steps": 2, "step_mm": 0.4, "refine": 0.7}


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    tables = {
        "title": "pair", "source": "own", "material": STEEL, "gear": {"a": gear(20, 2.0, 20.0), "b": gear(41, 2.0, 20.0)},
        "pair": {"only": {"gear_1": "a", "gear_2": "b", "force_N": 500.0}},
        "crack": [
            {"case": "wheel", "gear": "b", "tooth": 17, "length_mm": 0.6},
            {"case": "pinion", "gear": "a", "tooth": 3, "level": 0.1}
        ],
    }  # fmt: skip
    file = tmp_path_factory.mktemp("growth") / "pair.toml"
    file.write_text(toml(tables), encoding="utf-8")
    return str(file)


def run(scene, case="wheel", options=(), **more):
    study = read_study({"scene": scene, "kind": "growth", "case": case, "options": OPTIONS | dict(options)} | more)
    return [row for block in blocks(study)[0] for row in rows(study, block)]


def test_lives_scatter_by_the_constants_of_the_law(scene):
    """The path does not depend on C and m: lives are as 1/C, and the integral of K**-m over the length."""
    drawn = {"method": "latin", "count": 6, "of": {"options.C": {"lognormal": [1e-13, 0.5]}}}
    made = run(scene, sample=drawn)
    lives, constants = (np.array([row[key] for row in made]) for key in ("revolutions", "options.C"))
    assert np.ptp(np.log(lives)) > 0.5
    assert_allclose(lives * constants, lives[0] * constants[0], rtol=1e-12)
    assert {row["outcome"] for row in made} == {"unfinished"}


@pytest.mark.parametrize("case", ["wheel", "pinion"])
def test_a_row_is_the_growth_of_its_values(scene, case):
    grid = {"pair.only.force_N": [400.0, 800.0], "options.m": [2.5, 3.5]}
    start = {"crack.wheel.length_mm": [0.9]} if case == "wheel" else {"crack.pinion.level": [0.15]}
    made = {(row["pair.only.force_N"], row["options.m"]): row for row in run(scene, case, vary=grid | start)}
    crack = gf.Crack(length=0.9) if case == "wheel" else gf.Crack(level=0.15)
    own = gf.load_scene(scene).pair("only").case()
    law = gf.ParisLaw(1e-13, 3.5)
    want = gf.grow_crack(gf.Case(own.pair, 800.0, own.material), crack, case, step=0.4, steps=2, refine=0.7, law=law)
    row = made[800.0, 3.5]
    assert_allclose([row["revolutions"], row["length"], row["K_I_max"]], [want.cycles[-1], want.length[-1], want.K_I.max()])
    assert_allclose(made[400.0, 2.5]["K_I_max"], row["K_I_max"] / 2, rtol=0.01)


def test_threshold_and_toughness_end_a_path_as_they_end_a_growth(scene):
    (free,) = run(scene)
    (still,) = run(scene, options={"threshold": 2 * free["K_I_max"]})
    assert (still["outcome"], still["revolutions"]) == ("arrested", 0.0)
    own = gf.load_scene(scene).pair("only").case()
    law = gf.ParisLaw(1e-13, 3.0, K_Ic=0.999 * free["K_I_max"])
    grown = gf.grow_crack(own, gf.Crack(length=0.6), "wheel", step=0.4, steps=2, refine=0.7, law=law)
    (broken,) = run(scene, options={"K_Ic": law.K_Ic})
    assert broken["outcome"] == grown.outcome == "fracture"
    assert_allclose([broken["length"], broken["revolutions"]], [grown.length[-1], grown.cycles[-1]])


def test_a_healthy_case_has_no_growth(scene):
    (row,) = run(scene, "healthy")
    assert (row["status"], "choose a case with a single crack" in row["error"]) == ("failed", True)
