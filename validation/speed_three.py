"""Speed against error in three dimensions: seconds, peak memory and errors of the energy model by its orders."""

import json
import math
import resource
import subprocess
import sys
import time
from pathlib import Path

from . import machine  # first: it sets the number of threads

import numpy as np  # isort: skip

import gearfe as gf  # isort: skip
from gearfe.contact3d import pair_stiffness3d  # isort: skip
from gearfe.energy import ritz3d  # isort: skip
from gearfe.export import written  # isort: skip
from geometry.pit import pit_row  # isort: skip

PAGE = Path(__file__).parent / "speed_three.md"
SETTINGS = ((2, 8), (2, 11), (3, 8), (3, 11), (3, 14), (4, 16))  # the last is the reference
PHASES, FORCE, WIDTH = 64, 7120.0, 30.0  # width of a half


def solve(order, axial, last=27.0):
    """A herringbone sun-planet pair, 18/27, with a crack of 30 % and seven pits in each half, at 64 phases."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 2 * WIDTH}
    sun, planet = (
        gf.Gear(z=z, r_bore=0.5 * (z * 1.0403 - 2.5), beta=sense * math.radians(16), **rack) for z, sense in ((18, 1), (27, -1))
    )
    row = {"radius": sun.r, "axes": (1.0, 1.0), "depth": 0.1}
    pits = [*pit_row(7, 3.0, last, **row), *pit_row(7, 57.0, 2 * WIDTH - last, **row)]
    damage = {"pits": (pits, ()), "cracks": ((gf.Crack(level=0.3),), ())}
    pair, steel = gf.GearPair(sun, planet), gf.Material(E=206e3, nu=0.3)
    return pair_stiffness3d(pair, FORCE, steel, PHASES, face="herringbone", order=order, axial=axial, **damage).k


def measure(order, axial):
    """Seconds of a pair, of another layout of its pits, peak memory [MB] and k, in a process of its own."""
    started = time.process_time()
    k = solve(order, axial)
    middle = time.process_time()
    solve(order, axial, last=26.0)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {"seconds": middle - started, "again": time.process_time() - middle, "peak": peak, "k": k.tolist()}


def run():
    """Measure, write `speed_three.md`, and print the page."""
    found = []
    for order, axial in SETTINGS:
        command = [sys.executable, "-m", "validation.speed_three", str(order), str(axial)]
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=Path(__file__).parent.parent)
        found.append(json.loads(done.stdout))
        print(order, axial, {name: round(found[-1][name], 2) for name in ("seconds", "again", "peak")}, flush=True)
    default = (3, ritz3d.axial_degree(WIDTH, 2.0))
    truth = np.array(found[-1]["k"])
    lines = [
        "# Speed against error, 3-D",
        "",
        f"Made by `python -m validation speed_three` on {machine.describe()}.",
        "`ritz3d` on both halves of a herringbone sun-planet pair: 18/27, m_n 2 mm, 16 degrees, halves of 30 mm, bores at half",
        f"the root radius, {FORCE:g} N, {PHASES} phases, sun with a full-width crack of 30 % and fourteen pits of 2 mm. Each row",
        "is a process of its own; seconds are the processor's, imports excluded; memory includes them. Error of k at each phase",
        "against the last row: self-convergence of the polynomials, all with the same triangles.",
        "",
        "| order | axial degree | seconds | another row of pits | peak memory | mean error | max error |",
        "|---|---|---|---|---|---|---|",
    ]
    for setting, row in zip(SETTINGS, found, strict=True):
        error = 100 * np.abs(np.array(row["k"]) / truth - 1)
        away = f"{error.mean():.2f} % | {error.max():.2f} %" if setting != SETTINGS[-1] else "reference | "
        bold = "**" if setting == default else ""
        time_, again = f"{row['seconds']:.1f}", f"{row['again']:.1f}"
        lines.append(f"| {bold}{setting[0]}{bold} | {setting[1]} | {time_} | {again} | {row['peak']:.0f} MB | {away} |")
    lines += ["", "Bold: the default. A further row of pits costs only the contact along the lines; the bodies are known.", ""]
    with written(PAGE) as name:
        Path(name).write_text("\n".join(lines), encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    print(json.dumps(measure(int(sys.argv[1]), int(sys.argv[2]))))
