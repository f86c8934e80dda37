"""The README's program prints what the README says; numbers may differ in the last digit shown (another gmsh, another mesh)."""

import contextlib
import io
import re
from pathlib import Path

from numpy.testing import assert_allclose

import gearfe as gf

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]\d+)?")


def same(printed, shown):
    assert NUMBER.sub("#", printed) == NUMBER.sub("#", shown)
    found = [[float(x) for x in NUMBER.findall(text)] for text in (printed, shown)]
    assert_allclose(*found, rtol=2e-3, atol=0.1)


def test_program_prints_what_is_shown(tmp_path, monkeypatch):
    program = re.search(r"```python\n(.*?)```", README, re.S)[1]
    shown = re.search(r"prints\n\n```text\n(.*?)```", README, re.S)[1]
    monkeypatch.chdir(tmp_path)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(program, "README.md", "exec"), {})
    same(printed.getvalue(), shown)
    assert (tmp_path / "sun_planet.csv").exists()


def test_table_is_what_compare_gives():
    table = gf.compare(gf.load_scene("planetary_pitting")).table().splitlines()
    shown = re.search(r"(\| zone \|.*?)\n\| seconds", README, re.S)[1]
    same("\n".join(table[:-1]), shown)
