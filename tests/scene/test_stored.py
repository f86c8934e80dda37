"""Stored curves: written, read, and refused for any other gears, loads or damages."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.scene.stored import fingerprint, read_curves, write_curves


@pytest.fixture(scope="module")
def scene():
    return gf.load_scene("herringbone")


def curves():
    phase = np.linspace(0, 0.75, 4)
    return {
        ("sun_planet", None): (phase, 1e9 + phase, 5e8 + phase, 0.01, 2.0),
        ("sun_planet", "case1"): (phase,) * 3 + (0.02, 3.0),
    }


def test_round_trip(scene, tmp_path):
    file = tmp_path / "curves.csv"
    write_curves(scene, curves(), file)
    found = read_curves(scene, file)
    assert list(found) == list(curves())
    for key, wanted in curves().items():
        for one, other in zip(found[key], wanted, strict=True):
            assert_allclose(one, other, rtol=1e-7)


def test_nothing_for_another_load_or_bore(scene, tmp_path):
    file = tmp_path / "curves.csv"
    write_curves(scene, curves(), file)
    pair = scene.pairs["sun_planet"]
    bored = gf.GearPair(replace(pair.pair.gear_1, r_bore=8.0), pair.pair.gear_2, pair.pair.a)
    for other in (replace(pair, force=7000.0), replace(pair, pair=bored), replace(pair, groove=2.0)):
        assert read_curves(replace(scene, pairs={"sun_planet": other}), file) == {}


def test_other_damage_is_another_case(scene, tmp_path):
    file = tmp_path / "curves.csv"
    write_curves(scene, curves(), file)
    deeper = scene.with_damage("case1", {"sun_planet": {"pinion": [gf.Crack(level=0.11)]}})
    assert list(read_curves(deeper, file)) == [("sun_planet", None)]


def test_no_file_no_curves(scene, tmp_path):
    assert read_curves(scene, tmp_path / "none.csv") == {}


def test_fingerprint_does_not_count_defaults(scene):
    said, unsaid = (
        scene.with_damage("one", {"sun_planet": {"pinion": [crack]}}).case("sun_planet", "one")
        for crack in (gf.Crack(level=0.3, start="30deg"), gf.Crack(level=0.3))
    )
    assert fingerprint(said) == fingerprint(unsaid) != fingerprint(said.healthy)
