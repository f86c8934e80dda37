"""What the energy model costs in three dimensions, over teeth, width, helix angle, order and phases, with exponents."""

import json
import math
import subprocess
import sys
import time
from pathlib import Path

import matplotlib
import numpy as np

import gearfe as gf
from gearfe.contact.solid import pair_stiffness3d
from gearfe.files import written

from ..shared import machine
from ..shared.places import PAGES, ROOT

STANDARD = {"teeth": 24, "b/m": 8, "helix angle": 16, "order": 3, "phases": 16}
OVER = {
    "teeth": (18, 36, 72, 144),
    "b/m": (5, 10, 20, 40),
    "b/m, spur": (5, 10, 20, 40),
    "helix angle": (4, 8, 16, 32),
    "order": (2, 3, 4, 5),
    "phases": (16, 64, 256, 1024),
}
SPUR = {"helix angle": 0}  # of rows called so
PICTURE = "cost_three.png"


def measure(setting):
    """CPU seconds of a healthy pair, z and z + 1, m_n 2 mm, bores at half the root radius, 100 N/mm; nothing known before."""
    beta, z = math.radians(setting["helix angle"]), setting["teeth"]
    width = 2.0 * setting["b/m"]
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": width}
    one, two = (
        gf.Gear(z=n, beta=turn, r_bore=0.5 * (n / math.cos(beta) - 2.5), **rack) for n, turn in ((z, beta), (z + 1, -beta))
    )  # equal gears would be one another's mirror image, of which one is solved for
    pair = gf.GearPair(one, two)
    started = time.process_time()
    run = {"order": setting["order"], "cache": False}
    pair_stiffness3d(pair, 100 * width, gf.Material(E=206e3, nu=0.3), setting["phases"], **run)
    return time.process_time() - started


def run():
    """Measure, each setting in a process of its own, write `cost_three.md` with its picture, and print the page."""
    found = {}
    for name, values in OVER.items():
        fixed = STANDARD | (SPUR if name.endswith(", spur") else {})
        found[name] = [_apart(fixed | {_setting(name): value}) for value in values]
        print(name, np.round(found[name], 2), flush=True)
    _draw(found)
    standard = ", ".join(f"{name} {value}" for name, value in STANDARD.items())
    lines = ["# Cost in three dimensions", ""]
    lines += [
        f"Made by `python -m validation cost_three` on {machine.describe()}. A healthy pair by `ritz3d`, the",
        f"wheel with one tooth more, nothing known before: {standard}; one of them is varied at a time,",
        "once more for spur gears, whose even and odd functions along the width are solved for apart.",
        "CPU seconds; exponent: of the last doubling, or of the last step of the order.",
        "",
        "| varied | values | CPU seconds | exponent |",
        "|---|---|---|---|",
    ]
    for name, values in OVER.items():
        rise = math.log(found[name][-1] / found[name][-2]) / math.log(values[-1] / values[-2])
        lines.append(f"| {name} | {_list(values)} | {_list(f'{t:.3g}' for t in found[name])} | {rise:.1f} |")
    lines += ["", f"![CPU seconds over each of them]({PICTURE})", ""]
    with written(PAGES / "cost_three.md") as name:
        Path(name).write_text("\n".join(lines), encoding="utf-8")
    print("\n".join(lines))


def _setting(name):
    return name.removesuffix(", spur")


def _list(values):
    return ", ".join(map(str, values))


def _apart(setting):
    command = [sys.executable, "-m", "validation.make.cost_three", json.dumps(setting)]
    return float(subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout)


def _draw(found):
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    for name, values in OVER.items():
        axes.loglog(np.array(values) / STANDARD[_setting(name)], found[name], "o-", label=name)
    axes.set_xlabel(
        "in parts of the standard case: " + ", ".join(f"{name} {value}" for name, value in STANDARD.items()), fontsize=8
    )
    axes.set_ylabel("CPU seconds of a pair")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend()
    figure.savefig(PAGES / PICTURE, dpi=120)
    plt.close(figure)


if __name__ == "__main__":
    print(measure(json.loads(sys.argv[1])))
