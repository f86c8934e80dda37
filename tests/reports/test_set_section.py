"""The section of a report on a planetary set has the set's own numbers and pictures, healthy first."""

import base64
import re

import numpy as np
from conftest import ROOT

import gearfe as gf
from gearfe.reports.whole_set import find_set, set_section

PAGE = (ROOT / "gearfe" / "docs" / "howto" / "planetary_set.md").read_text(encoding="utf-8")
SCENE = re.search(r"```toml\n(title.*?)```", PAGE, re.DOTALL)[1]
PNG = b"\x89PNG"


def loaded(tmp_path, text):
    path = tmp_path / "s.toml"
    path.write_text(text)
    return gf.load_scene(path)


def test_health_and_damage(tmp_path):
    found, notes = find_set(loaded(tmp_path, SCENE), "cracked")
    assert not notes
    assert list(found) == ["healthy", "cracked"]
    assert np.array_equal(found["healthy"].position, found["cracked"].position)
    healthy, cracked = set_section(found)
    assert f"{found['healthy'].k[0, :, 1].mean() / 1e6:.1f}" in healthy["table"]
    assert "the damage takes up to" in cracked["headline"]
    assert "the damage" not in healthy["headline"]
    for picture in (healthy["loads"], healthy["bent"], cracked["loads"]):
        assert base64.b64decode(picture["data"]).startswith(PNG)
    assert "cracks of a set are not meshed" in cracked["bent"]["missing"]


def test_what_cannot_be_solved_is_said(tmp_path):
    pits = '[[spall]]\ncase = "spalled"\ngear = "sun"\nradius_mm = 21\nz_mm = 10\nsides_mm = [1, 2]\ndepth_mm = 0.1\n'
    held = '[support.a]\ngear = "sun"\nradial_N_per_um = 100\n'
    found, notes = find_set(loaded(tmp_path, SCENE + pits + held), "spalled")
    assert not found
    assert len(notes) == 2
    assert "springs or misalignment, which a set does not know" in notes[0]
