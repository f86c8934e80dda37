"""Studies of planetary sets: their numbers are those of single calls, and what holds a set varies by its keys."""

import re

import numpy as np
import pytest
from set_page import PAGE, SCENE

import gearfe as gf
from gearfe.runs.sweeps.blocks import blocks, rows
from gearfe.runs.sweeps.study import read_study

STUDY = re.search(r"```toml\n(scene.*?)```", PAGE, re.DOTALL)[1]


@pytest.fixture
def place(tmp_path):
    (tmp_path / "my_set.toml").write_text(SCENE)
    (tmp_path / "study.toml").write_text(STUDY)
    return tmp_path


def test_the_study_of_the_page(place):
    every, _ = blocks(read_study(place / "study.toml"))
    assert sum(len(one.cases) for one in every) == 4 * 2 * 3 * 5


def test_a_row_is_the_set_that_its_values_make(place):
    study = read_study({
        "scene": str(place / "my_set.toml"), "kind": "set", "options": {"positions": 2, "cycles": 1},
        "vary": {"ring": {"support": {"count": [4, 6]}}, "pin.first.tangential_um": [20.0], "set.pin_N_per_um": [100.0]},
    })  # fmt: skip
    made = [row for block in blocks(study)[0] for row in rows(study, block)]
    assert [row["status"] for row in made] == ["done", "done"]
    text = SCENE.replace("count = 6", "count = 4").replace("tangential_um = 5", "tangential_um = 20")
    (place / "other.toml").write_text(text.replace("pin_N_per_um = 300", "pin_N_per_um = 100"))
    found = gf.planetary_stiffness(gf.build_set(gf.load_scene(place / "other.toml")), 2)
    (row,) = [row for row in made if row["ring.support.count"] == 4]
    assert row["k_planet_ring"] == pytest.approx(found.k[1].mean(), rel=1e-9)
    assert row["k_sun_planet_alone"] == pytest.approx(found.k_alone[0].mean(), rel=1e-9)
    assert row["K_gamma"] == pytest.approx(found.K_gamma, rel=1e-9)
    assert row["te_peak_to_peak"] == pytest.approx(np.ptp(found.te), rel=1e-9)
    assert row["k_planet_ring"] != made[1 - made.index(row)]["k_planet_ring"]


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ("ring.support.size", "there is no 'size'; there is kind, count, width_mm"),
        ("ring.pads.count", "there is no 'pads'; there is support"),
        ("pin.second.radial_um", "there is no 'second'; there is first"),
        ("set.planets", "there is no 'planets'; there is n_planets"),
    ],
)
def test_keys_of_a_set_that_are_not_there(place, key, message):
    with pytest.raises(ValueError, match=message):
        read_study({"scene": str(place / "my_set.toml"), "kind": "set", "vary": {key: [1, 2]}})
