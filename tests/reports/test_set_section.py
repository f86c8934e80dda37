"""The section of a report on a planetary set has the set's own numbers and pictures, healthy first."""

import base64
import re
from functools import partial

import numpy as np
import pytest
from set_page import SCENE, loaded

import gearfe as gf
from gearfe.reports import findings, page, whole_set
from gearfe.reports.whole_set import find_set

pytest.importorskip("plotly")
pytest.importorskip("jinja2")

PNG = b"\x89PNG"


@pytest.mark.slow
def test_health_and_damage(tmp_path, monkeypatch):
    """The page has the set as it is solved alone, healthy and cracked."""
    monkeypatch.setattr(page, "_pictures", lambda found: [])
    monkeypatch.setattr(findings, "_tooth", lambda found: None)
    monkeypatch.setattr(findings, "compare", partial(gf.compare, refine=0.35))  # pairs are no part of this section
    monkeypatch.setattr(whole_set, "POSITIONS", 4)
    scene = loaded(tmp_path, SCENE)
    text = gf.report(scene, tmp_path / "page.html", phases=2, duration=0).read_text(encoding="utf-8")
    text = text[text.index('<section id="set">') :]
    text = text[: text.index("</section>")]
    at = 2 * np.arange(5) / 5  # 4 positions in the two cycles of the damaged tooth, one more so that no phase repeats
    healthy, cracked = (gf.planetary_stiffness(gf.build_set(scene, case), at) for case in (None, "cracked"))
    assert re.findall("<h3>(.*?)</h3>", text) == ["healthy", "cracked"]
    first, second = text.split("<h3>cracked</h3>")
    for part, found in ((first, healthy), (second, cracked)):
        for planet in range(3):
            assert f"<td>{found.k[0, :, planet].mean() / 1e6:.1f}</td>" in part
    assert "the damage reduces k by up to" not in first
    assert f"the damage reduces k by up to {100 * (1 - cracked.k / healthy.k).max():.1f} %" in second
    pictures = re.findall('data:image/png;base64,([^"]*)', text)
    assert [base64.b64decode(one)[:4] for one in pictures] == [PNG] * 4


def test_what_cannot_be_solved_is_said(tmp_path):
    pits = '[[spall]]\ncase = "spalled"\ngear = "sun"\nradius_mm = 21\nz_mm = 10\nsides_mm = [1, 2]\ndepth_mm = 0.1\n'
    held = '[support.a]\ngear = "sun"\nradial_N_per_um = 100\n'
    found, notes = find_set(loaded(tmp_path, SCENE + pits + held), "spalled")
    assert not found
    assert len(notes) == 2
    assert "springs or misalignment, which a set does not support" in notes[0]
