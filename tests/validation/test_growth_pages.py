"""Rows of the frozen pages on growth, computed again. Random polylines are in `tests/strength/test_growth.py`."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.geometry.damage.crack import crack_path
from gearfe.geometry.tooth.profile import fillet_length
from validation.shared.kept_rows import stored

STEEL = gf.Material(E=206e3, nu=0.3)
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
CASE = gf.Case(gf.GearPair(gf.Gear(z=21, r_bore=9.2, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK)), 2000.0, STEEL)


@pytest.mark.parametrize(("ratio", "free", "part"), [(0.3, 60, 0.5), (0.5, 90, 0.5)])
def test_rims_break_as_on_file(ratio, free, part):
    """28/28 teeth with a backup ratio, the bore free over an arc [degrees], from a part of the fillet's arc."""
    rack = RACK | {"m_n": 3.175, "b": 6.35}
    rim = gf.Gear(z=28, r_bore=(12.75 - 2.25 * ratio) * 3.175, **rack)
    case = gf.Case(gf.GearPair(rim, gf.Gear(z=28, r_bore=15.0, **rack)), 1500.0, STEEL)
    model = gf.CrackModel(held=[(math.radians(free / 2), math.radians(360 - free / 2))])
    grown = gf.grow_crack(case, gf.Crack(length=0.26, start=part * fillet_length(rim)), step=0.5, model=model)
    known = stored("growth_rims")[f"{ratio} {free} {part}"]
    assert grown.outcome == known["outcome"] == "rim cut"
    assert_allclose(crack_path(rim, grown.cracks[-1]), known["path"], atol=0.02)


@pytest.mark.parametrize("steps", [3, pytest.param(11, marks=pytest.mark.slow)])
def test_k_along_a_path_is_that_of_calculix_within_two_percent(steps):
    model, start = gf.CrackModel(loading="single", method="ritz"), gf.Crack(length=0.4, angle=math.radians(20))
    grown, rows = gf.grow_crack(CASE, start, step=0.25, steps=steps, model=model), stored("growth_calculix")
    for number in (one for one in map(int, rows) if one <= steps):
        row = rows[str(number)]
        assert grown.K_I[number] == pytest.approx(row["K_I"], rel=0.02)
        assert grown.K_II[number] == pytest.approx(row["K_II"], abs=0.02 * row["K_I"])


def test_straight_cracks_lose_the_stiffness_on_file():
    """18/40 teeth, backup ratio 3: straight cracks by their angle, and the path, as long as 0.6 of the chord."""
    pair = gf.GearPair(gf.Gear(z=18, r_bore=0.3 * 15.5, **RACK), gf.Gear(z=40, r_bore=15.0, **RACK))
    case, run = gf.Case(pair, 2000.0, STEEL), gf.Solve(method="ritz", span="tooth", phases=32)
    last = 1.2 * abs(crack_path(pair.gear_1, gf.Crack(length=0.3))[0, 0])
    path = gf.grow_crack(case, gf.Crack(length=0.3), step=(last - 0.3) / 8, steps=8).cracks[-1]
    cracks = [path, *(gf.Crack(length=last, angle=math.radians(angle)) for angle in (5, 15, 30, 45, 60, 75, 90))]
    hurt = [gf.solve(replace(case, damage={"pinion": [crack]}), run).k for crack in cracks]
    known = stored("growth_conventions")["k 18 3.0"]
    losses = 100 * (1 - np.array(hurt) / gf.solve(case, run).k).max(axis=1)
    assert_allclose(losses, [known["path"], *known["straight"]], rtol=1e-3)


def test_a_growing_crack_has_the_life_and_the_losses_on_file():
    law = gf.ParisLaw(5.21e-13, 3.0, threshold=63.0)
    grown = gf.grow_crack(CASE, gf.Crack(length=0.3), step=0.1, steps=7, law=law)
    assert grown.cycles[-1] == pytest.approx(1.05e6, rel=5e-3)
    case = replace(CASE, damage={"pinion": [grown.cracks[-1]]})
    hurt = gf.solve(case, gf.Solve(span="tooth"))
    sound = gf.solve(CASE, gf.Solve(span="tooth", phases=hurt.phase))
    known = stored("growth_detection")["7"]
    assert 100 * (1 - (hurt.k / sound.k).min()) == pytest.approx(known["k_percent"], rel=1e-3)
    assert 1e6 * (np.ptp(hurt.deflection) - np.ptp(sound.deflection)) == pytest.approx(known["te_um"], rel=5e-3)
