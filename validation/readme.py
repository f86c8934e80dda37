"""Remake what the README shows: the comparison table and the output of its program."""

import contextlib
import io
import os
import re
import tempfile
from pathlib import Path

import gearfe as gf

README = Path(__file__).parents[1] / "README.md"
PROGRAM = re.compile(r"```python\n(.*?)```", re.S)
OUTPUT = re.compile(r"(prints\n\n```text\n)(.*?)(```)", re.S)
TABLE = re.compile(r"\| zone \|.*?\| seconds [^\n]*\|", re.S)


def program_output(text):
    """What the README's program prints, run in an empty folder."""
    printed, here = io.StringIO(), Path.cwd()
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(printed):
        os.chdir(folder)
        try:
            exec(compile(PROGRAM.search(text)[1], "README.md", "exec"), {})
        finally:
            os.chdir(here)
    return printed.getvalue()


def run():
    """Write the README anew."""
    text = README.read_text(encoding="utf-8")
    gf.compare(gf.load_scene("planetary_pitting"))  # warm
    table = gf.compare(gf.load_scene("planetary_pitting")).table()
    text = TABLE.sub(lambda _: table, text)
    text = OUTPUT.sub(lambda m: m[1] + program_output(text) + m[3], text)
    README.write_text(text, encoding="utf-8")
    print("README.md remade")
