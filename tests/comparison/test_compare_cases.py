"""All cases of a scene by every method."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.comparison.compare import compare_cases
from gearfe.comparison.comparison import Comparison
from gearfe.comparison.losses import LARGEST, tooth_stiffness

pytestmark = pytest.mark.quick


@pytest.fixture(scope="module")
def cracked():
    scene = gf.load_scene("compound_planetary")
    pair = scene.pairs["sun_planet"]
    few = replace(pair, owned={name: pair.owned[name] for name in ("crack30", "crack70")})
    return replace(scene, pairs={"sun_planet": few, "planet_planet": scene.pairs["planet_planet"]})


@pytest.fixture(scope="module")
def found(cracked):
    return compare_cases(cracked)


def test_sections_are_judged_by_finite_elements(found):
    assert found.methods[0] == "fe"
    assert found.asked == (
        ("sun_planet", None), ("sun_planet", "crack30"), ("sun_planet", "crack70"), ("planet_planet", None),
    )  # fmt: skip
    ritz = [row for row in found.rows() if row.method == "ritz" and row.zone != LARGEST]
    assert len(ritz) == 16
    assert all(abs(row.error) < 5e-3 for row in ritz)


def test_notebooks_display_the_headline_and_the_table(found):
    assert repr(found) == f"<Comparison: {found.headline}>"
    page = found._repr_html_()
    assert f"<p>{found.headline}</p>" in page
    assert found.table().html() in page


def test_deeper_cracks_take_more(found):
    small, large = (found.losses(("sun_planet", case))["ritz"] for case in ("crack30", "crack70"))
    for zone in ("mean", LARGEST):
        assert 0 < small[zone] < large[zone] < 1
    assert found.subject == ("sun_planet", "crack70")
    before, after = (tooth_stiffness(found.solved["sun_planet", case, "ritz"], 0).mean() for case in (None, "crack30"))
    assert 1 - after / before > small["mean"], "the tooth itself loses more than the mesh that it shares"


def test_tables_have_rows_for_each_case(found):
    head, *rows = found.table().cells()
    assert len(rows) == 2 * 4 + 1
    assert head[:3] == ["pair", "case", "zone"]
    assert len(found.loss_table().rows) == 3 * 2
    assert "none" in rows[4]
    assert not [cell for row in rows for cell in row if "nan" in cell]
    assert set(found.left_out) == {
        "textbook of sun_planet crack70",
        "herringbone_article of sun_planet crack70",
    }  # past the centre-line


def test_record_has_every_number(found, tmp_path):
    found.record().save(tmp_path / "all.csv")
    rows = (tmp_path / "all.csv").read_text().splitlines()
    assert rows[0].startswith("pair,case,method,zone,k [N/m],estimate [%],error [%],loss [%]")
    assert len(rows) == 1 + len(list(found.rows()))
    assert f"{next(found.rows()).k!r}" in rows[1]


def test_errors_and_losses_of_known_curves():
    none, case = np.zeros((2, 1)), gf.load_scene("compound_planetary").case("sun_planet", "crack30")

    def curve(*k):
        values = np.array(k)
        phase, meta = np.array([0.25, 0.75]), {"eps_alpha": 1.5, "face": "helical"}
        return gf.StiffnessCurve(phase, values, values, none[:, 0], np.array([0]), none, none, meta=meta)

    curves = {
        ("p", None, "a"): curve(2.0, 4.0), ("p", "x", "a"): curve(1.0, 3.0),
        ("p", None, "b"): curve(2.2, 4.0), ("p", "x", "b"): curve(1.1, 3.3),
    }  # fmt: skip
    found = Comparison({("p", None): case.healthy, ("p", "x"): case}, (("p", "x"),), curves)
    errors = {row.zone: row.error for row in found.rows() if row.method == "b"}
    assert_allclose([errors["mean"], errors["max"]], [0.1, 0.1])
    assert_allclose([found.losses()["a"][zone] for zone in (LARGEST, "mean")], [0.5, 1 / 3])


def test_no_damage_no_table():
    scene = gf.load_scene("compound_planetary")
    with pytest.raises(ValueError, match="no cases of damage"):
        compare_cases(replace(scene, pairs={"planet_planet": scene.pairs["planet_planet"]}))
