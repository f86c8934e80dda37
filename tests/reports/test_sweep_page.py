"""The page of a sweep: one file, with the numbers of its table."""

import re

import pytest

import gearfe as gf
from gearfe.reports.sweep_page import SHOWN
from gearfe.runs.store.shards import fields
from gearfe.runs.sweeps.kinds import KINDS

pytest.importorskip("plotly")
pytest.importorskip("jinja2")


def test_page_of_a_sweep_has_its_numbers(tmp_path):
    study = {
        "title": "bores </script>",
        "scene": "planetary_pitting",
        "pair": "sun_planet",
        "options": {"method": "textbook", "phases": 8},
        "vary": {"gear.sun.r_bore_mm": [6.0, 7.0, 99.0], "pair.sun_planet.force_N": [1000.0, 2000.0]},
    }
    runs = gf.sweep(study, tmp_path / "runs", workers=1)
    text = gf.sweep_report(runs, tmp_path / "page.html").read_text(encoding="utf-8")
    done = runs.table(where={"status": "done"})
    for value in (done["k_mean"].min(), done["k_mean"].max()):
        assert f"<td>{1e-6 * value:.5g}</td>" in text
    assert "<td>N/um</td>" in text
    assert "bores </script>" not in text
    places = re.findall(r' id="([^"]+)"', text)
    assert {"effects", "curves", "figure-effects", "figure-bands"} <= set(places)
    assert len(set(places)) == len(places)
    assert "r_bore" in text[text.index("Cases without a result") :]
    own = re.sub(r"<script>/\*\*.*?</script>", "", text, flags=re.DOTALL)
    assert not re.findall(r"<(?:script|img|link|iframe)[^>]*(?:src|href)=\"(?!data:)[^\"]*", own)
    with pytest.raises(ValueError, match="no folder"):
        gf.sweep_report(tmp_path / "none", tmp_path / "page.html")


def test_a_single_input_is_drawn_over_its_values(tmp_path):
    vary = {"gear.sun.r_bore_mm": [6.0, 6.5, 7.0]}
    study = {"title": "bores", "scene": "planetary_pitting", "pair": "sun_planet", "vary": vary}
    runs = gf.sweep(study | {"options": {"method": "textbook", "phases": 8}}, tmp_path / "runs", workers=1)
    text = gf.sweep_report(runs, tmp_path / "page.html").read_text(encoding="utf-8")
    drawn = text[text.index("figure-effects") :]
    assert '"x":["6","6.5","7"]' in drawn
    assert '"text":"gear.sun.r_bore_mm"' in drawn
    assert '<th scope="col">distinct values</th>' in text
    assert 'class="words"' not in text


def test_every_kind_of_study_has_a_page():
    """What is drawn of a kind are columns of its results."""
    assert set(SHOWN) == set(KINDS)
    for kind, (output, curve) in SHOWN.items():
        assert {output, curve} - {None} <= set(fields(kind))
