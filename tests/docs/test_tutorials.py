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
SLOW = (
    "picture_03_crack_conventions", "picture_06_crack_front", "picture_08_section_stress", "picture_10_pitted_tooth",
    "picture_17_relief", "picture_18_misaligned", "picture_22_ring", "picture_28_run_up", "picture_29_surrogate",
    "tutorial_04_own_model", "tutorial_05_helical", "tutorial_06_planetary_vibration", "tutorial_07_measured_signal",
    "tutorial_08_many_cases", "tutorial_09_modified_flanks", "tutorial_10_damage_along_the_width",
)  # fmt: skip
RECORD = Path(__file__).parent / "printed"
NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]\d+)?")
FEWER = {  # of scripts that print nothing: what is repeated, and how often here, ends included; the site runs them as they are
    "picture_04_crack_angle": ("np.linspace(25, 75, 11)", "np.linspace(25, 75, 3)"),
    "picture_05_crack_growth": ("lengths = [0.2, 0.5, 1.0, 1.5, 2.0, 2.5]", "lengths = [0.2, 2.5]"),
    "picture_07_crack_and_scatter": ("0.003, (60, 2))", "0.003, (4, 2))"),
    "picture_21_root_stress": ("np.linspace(*pair.path, 7)", "np.linspace(*pair.path, 4)"),
    "picture_24_resonance": ("np.linspace(0.15, 1.4, 60)", "np.linspace(0.15, 1.4, 6)"),
}


@pytest.mark.quick
def test_scripts_are_found():
    assert len(SCRIPTS) >= 39
    assert {path.stem for path in RECORD.glob("*.txt")} <= {path.stem for path in SCRIPTS}


PARAMETERS = [pytest.param(path, id=path.stem, marks=pytest.mark.slow if path.stem in SLOW else ()) for path in SCRIPTS]


def fewer(script, folder):
    """The script, or a copy of it that does the same less often."""
    if script.stem not in FEWER:
        return script
    text, (often, here) = script.read_text(encoding="utf-8"), FEWER[script.stem]
    assert text.count(often) == 1, f"{script.name} has no {often!r}: change it in FEWER too"
    assert not (RECORD / f"{script.stem}.txt").exists(), "what it prints is on record: run all of it"
    copy = folder / script.name
    copy.write_text(text.replace(often, here), encoding="utf-8")
    return copy


@pytest.mark.slow
@pytest.mark.parametrize("script", PARAMETERS)
def test_script_prints_what_is_on_record(script, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(fewer(script, tmp_path)))
    assert not plt.get_fignums(), "close what you draw"
    drawn = re.findall(r'"(\w+\.png)"', script.read_text(encoding="utf-8"))
    assert all(Path(name).stat().st_size > 5000 for name in drawn)
    printed = capsys.readouterr().out
    record = RECORD / f"{script.stem}.txt"
    shown = record.read_text(encoding="utf-8") if record.exists() else ""
    assert NUMBER.sub("#", printed).split() == NUMBER.sub("#", shown).split()
    assert_allclose(*([float(x) for x in NUMBER.findall(text)] for text in (printed, shown)), rtol=0.01, atol=0.02)
