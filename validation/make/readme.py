"""Remake what the README shows: the comparison table, five rows of article S4's and the output of its program."""

import contextlib
import io
import os
import re
import tempfile
from pathlib import Path

import gearfe as gf

from ..shared.herringbone_page import error_table
from ..shared.places import ROOT

README = ROOT / "README.md"
PROGRAM = re.compile(r"```python\n(.*?)```", re.S)
OUTPUT = re.compile(r"(prints\n\n```text\n)(.*?)(```)", re.S)
FIVE = re.compile(r"@@FIVE@@|\| pair \| case \| FE .*?(?=\n\n)", re.S)
TABLE = re.compile(r"\| zone \|.*?\| seconds [^\n]*\|", re.S)


def five_rows():
    """The rows of sun and planet of the table of ten, healthy and in all cases of damage."""
    return "\n".join(line for line in error_table().splitlines() if not line.startswith("| planet_ring"))


def outputs(text):
    """What each of the README's programs prints, run in an empty folder."""
    return [_printed(program) for program in PROGRAM.findall(text)]


def _printed(program):
    printed, here = io.StringIO(), Path.cwd()
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(printed):
        os.chdir(folder)
        try:
            exec(compile(program, "README.md", "exec"), {})
        finally:
            os.chdir(here)
    return printed.getvalue()


def run(again=True):
    """Write the README anew."""
    text = README.read_text(encoding="utf-8")
    gf.compare(gf.load_scene("planetary_pitting"))  # warm
    table = gf.compare(gf.load_scene("planetary_pitting")).table()
    text = TABLE.sub(lambda _: table, text)
    text = FIVE.sub(lambda _: five_rows(), text)
    printed = iter(outputs(text))
    text = OUTPUT.sub(lambda m: m[1] + next(printed) + m[3], text)
    README.write_text(text, encoding="utf-8")
    print("README.md remade")
