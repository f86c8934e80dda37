"""Every script of the documentation runs without a warning; its printed numbers are those on record."""

import re
import runpy
from pathlib import Path

import matplotlib as mpl
import pytest
from numpy.testing import assert_allclose

mpl.use("Agg")
import matplotlib.pyplot as plt

SITE = Path(__file__).parents[2] / "gearfe" / "docs"
SCRIPTS = sorted(SITE.glob("tutorials/*.py")) + sorted(SITE.glob("gallery/*.py"))
SLOW = ("picture_08_section_stress", "picture_10_pitted_tooth", "tutorial_10_damage_along_the_width")
RECORD = Path(__file__).parent / "printed"
NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]\d+)?")


def test_scripts_are_found():
    assert len(SCRIPTS) >= 39
    assert {path.stem for path in RECORD.glob("*.txt")} <= {path.stem for path in SCRIPTS}


PARAMETERS = [pytest.param(path, id=path.stem, marks=pytest.mark.slow if path.stem in SLOW else ()) for path in SCRIPTS]


@pytest.mark.parametrize("script", PARAMETERS)
def test_script_prints_what_is_on_record(script, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(script))
    assert not plt.get_fignums(), "close what you draw"
    drawn = re.findall(r'"(\w+\.png)"', script.read_text(encoding="utf-8"))
    assert all(Path(name).stat().st_size > 5000 for name in drawn)
    printed = capsys.readouterr().out
    record = RECORD / f"{script.stem}.txt"
    shown = record.read_text(encoding="utf-8") if record.exists() else ""
    assert NUMBER.sub("#", printed).split() == NUMBER.sub("#", shown).split()
    assert_allclose(*([float(x) for x in NUMBER.findall(text)] for text in (printed, shown)), rtol=0.01, atol=0.02)
