"""Recorded texts that tests compare with the present output; ``python -m tests.remake NAME`` writes one again.

- ``readme``: the README's picture, comparison table, five rows of article S4 and output of its program;
- ``tutorials``: what the scripts of the documentation print, in ``tests/docs/printed``;
- ``notebooks``: the tutorials of `NOTEBOOKS` as Jupyter notebooks;
- ``own_model``: a stiffness curve as MATLAB's ``writetable`` leaves it: 15 digits, CRLF, the unit in the variable name.
"""

import contextlib
import io
import math
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import gearfe as gf
from validation.shared.herringbone_page import error_table
from validation.shared.places import PAGES, ROOT

README = ROOT / "README.md"
PICTURE = PAGES / "pictures" / "readme.png"
PROGRAM = re.compile(r"```python\n(.*?)```", re.S)
OUTPUT = re.compile(r"(prints\n\n```text\n)(.*?)(```)", re.S)
FIVE = re.compile(r"@@FIVE@@|\| pair \| case \| FE .*?(?=\n\n)", re.S)
TABLE = re.compile(r"\| zone \|.*?\| seconds [^\n]*\|", re.S)
SITE = ROOT / "gearfe" / "docs"
RECORD = ROOT / "tests" / "docs" / "printed"
EXAMPLE = PAGES / "matlab_curve.csv"
ROWS = 128  # of the example
NOTEBOOKS = "tutorial_01_first_curve", "tutorial_07_measured_signal"


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


def readme():
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


def tutorials():
    """Run every script in an empty folder and write its output."""
    own = {"PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg", "OMP_NUM_THREADS": "1"}
    for script in sorted(SITE.glob("tutorials/*.py")) + sorted(SITE.glob("gallery/*.py")):
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, "-W", "error", script]
            done = subprocess.run(command, cwd=folder, env=os.environ | own, capture_output=True, text=True, check=True)
        if done.stdout:
            (RECORD / f"{script.stem}.txt").write_text(done.stdout, encoding="utf-8")
        print(f"{script.stem}: {len(done.stdout.splitlines())} lines")


def notebooks():
    """Write some tutorials as notebooks without output."""
    from sphinx_gallery.gen_gallery import DEFAULT_GALLERY_CONF
    from sphinx_gallery.notebook import jupyter_notebook, save_notebook
    from sphinx_gallery.py_source_parser import split_code_and_text_blocks

    for name in NOTEBOOKS:
        script = SITE / "tutorials" / f"{name}.py"
        made = jupyter_notebook(split_code_and_text_blocks(script)[1], DEFAULT_GALLERY_CONF, script.parent)
        save_notebook(made, script.with_suffix(".ipynb"))


def example_text():
    """Return the example's text: the textbook's total stiffness of the first pair of `planetary_pitting`."""
    chosen = gf.load_scene("planetary_pitting").pair()
    phase = np.arange(ROWS) / ROWS
    curve = gf.mesh_stiffness(chosen.pair, chosen.force, chosen.materials, method="textbook", phases=phase)
    rows = [f"{x:.15g},{k:.15g}" for x, k in zip(phase, curve.k, strict=True)]
    return "\r\n".join(["phase,k_N_per_m", *rows, ""])


def own_model():
    """Write the example again."""
    EXAMPLE.write_bytes(example_text().encode())
    print(f"{EXAMPLE.name} remade")


if __name__ == "__main__":
    {"readme": readme, "tutorials": tutorials, "notebooks": notebooks, "own_model": own_model}[sys.argv[1]]()
