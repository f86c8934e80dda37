"""All cases of a scene by every method."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.comparison.case_table import CaseCurve, CaseTable, case_curve, case_table, damage_cycle

pytestmark = pytest.mark.quick


@pytest.fixture(scope="module")
def cracked():
    scene = gf.load_scene("compound_planetary")
    pair = scene.pairs["sun_planet"]
    few = replace(pair, damage={name: pair.damage[name] for name in ("crack30", "crack70")})
    return replace(scene, pairs={"sun_planet": few, "planet_planet": scene.pairs["planet_planet"]})


@pytest.fixture(scope="module")
def table(cracked):
    with pytest.warns(UserWarning, match="has no value for sun_planet crack70"):  # past the centre-line
        return case_table(cracked)


def test_sections_are_judged_by_finite_elements(table):
    assert table.reference == "fe"
    assert table.cases() == [("sun_planet", None), ("sun_planet", "crack30"), ("sun_planet", "crack70"), ("planet_planet", None)]
    for pair, case in table.cases():
        assert max(np.abs(table.errors(pair, case, "ritz"))) < 5e-3


def test_deeper_cracks_take_more(table):
    small, large = (table.drops("sun_planet", case, "ritz") for case in ("crack30", "crack70"))
    assert all(0 < a < b < 1 for a, b in zip(small, large, strict=True))
    assert small[2] > small[1]  # the tooth itself loses more than the mesh that it shares


def test_tables_have_a_row_for_each_case(table):
    assert len(table.table().splitlines()) == 2 + 4 + 1
    assert len(table.drop_table().splitlines()) == 2 + 2
    assert "none" in table.table().splitlines()[4]
    assert "nan" not in table.table()


def test_cycle_has_the_tooth_in_its_middle(cracked):
    chosen = cracked.pairs["sun_planet"]
    phase = damage_cycle(chosen)
    assert_allclose(phase.mean(), chosen.pair.eps_alpha / 2)
    assert_allclose(np.ptp(phase) + phase[1] - phase[0], 1.0)
    assert (case_curve(chosen.case("crack30"), gf.Solve("textbook", phase)).tooth > 0).all()


def test_errors_and_drops_of_known_curves():
    def curve(*k):
        return CaseCurve(np.array(k), np.array(k) / 2, 1.0, 0.0)

    curves = {
        ("p", None, "a"): curve(2.0, 4.0), ("p", "x", "a"): curve(1.0, 3.0),
        ("p", None, "b"): curve(2.2, 4.0), ("p", "x", "b"): curve(1.1, 3.3),
    }  # fmt: skip
    table = CaseTable({}, curves, ("a", "b"), "a")
    assert_allclose(table.errors("p", "x", "b"), [0.1, 0.1, 0.1])
    assert_allclose(table.drops("p", "x", "a"), [0.5, 1 / 3, 1 / 3])


def test_no_damage_no_table():
    scene = gf.load_scene("compound_planetary")
    with pytest.raises(ValueError, match="no cases of damage"):
        case_table(replace(scene, pairs={"planet_planet": scene.pairs["planet_planet"]}))
