"""Compute the README: its picture, the comparison table, five rows of article S4 and the output of its program."""

import contextlib
import io
import math
import os
import re
import tempfile
from pathlib import Path

import gearfe as gf

from ..shared.herringbone_page import error_table
from ..shared.places import PAGES, ROOT

README = ROOT / "README.md"
PICTURE = PAGES / "pictures" / "readme.png"
PROGRAM = re.compile(r"```python\n(.*?)```", re.S)
OUTPUT = re.compile(r"(prints\n\n```text\n)(.*?)(```)", re.S)
FIVE = re.compile(r"@@FIVE@@|\| pair \| case \| FE .*?(?=\n\n)", re.S)
TABLE = re.compile(r"\| zone \|.*?\| seconds [^\n]*\|", re.S)


def five_rows():
    """Return the rows of sun and planet of the table of ten, healthy and in all cases of damage."""
    head = error_table().split("\n| planet_ring", 1)[0]
    return head.replace("\n|  |", "\n| sun_planet |")


def outputs(text):
    """Output of each program of the README, run in an empty folder."""
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


def draw():
    """Draw the picture: mesh stiffness of the program's pair, healthy and with a deep crack, next to the stress in the tooth."""
    import matplotlib.pyplot as plt

    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    crack = gf.Crack(level=0.5)
    case = gf.Case(pair, 2000.0, gf.Material(E=207e3, nu=0.25), damage={"pinion": [crack]})
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.2, 3.4), width_ratios=(1.45, 1), dpi=110, layout="constrained")
    for one, label in ((case.healthy, "healthy"), (case, crack._description(pair.gear_1))):
        curve = gf.solve(one, gf.Solve(method="fe", phases=128, span="tooth", error=True))
        (line,) = left.plot(curve.phase, curve.k / 1e6, label=label)
        band = (curve.k - curve.error) / 1e6, (curve.k + curve.error) / 1e6
        left.fill_between(curve.phase, *band, color=line.get_color(), alpha=0.3, lw=0)
    left.set(xlabel="mesh cycles of tooth 0", ylabel="mesh stiffness [N/\u00b5m]", ylim=(110, None))
    left.set_title("time-varying mesh stiffness, bands: estimated error", fontsize=10)
    left.legend(frameon=False, loc="lower right", fontsize=9)
    with tempfile.TemporaryDirectory() as folder:
        gf.render_stress(case, f"{folder}/stress.png", size=(900, 760))
        right.imshow(plt.imread(f"{folder}/stress.png"))
    right.set_title("von Mises stress", fontsize=10)
    right.axis("off")
    figure.savefig(PICTURE)


def run(again=True):
    """Write the README again."""
    text = README.read_text(encoding="utf-8")
    gf.compare(gf.load_scene("planetary_pitting"))  # warm
    table = gf.compare(gf.load_scene("planetary_pitting")).table().markdown()
    text = TABLE.sub(lambda _: table, text)
    text = FIVE.sub(lambda _: five_rows(), text)
    printed = iter(outputs(text))
    text = OUTPUT.sub(lambda m: m[1] + next(printed) + m[3], text)
    README.write_text(text, encoding="utf-8")
    draw()
    print("README.md remade")
