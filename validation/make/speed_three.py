"""A part of the page `speed`: seconds, memory and errors of energy model, hexahedra and closed forms in three dimensions."""

import json
import math
import os
import resource
import subprocess
import sys
import time

import numpy as np

import gearfe as gf
from gearfe.flexibility.energy.ritz import solid as ritz3d
from gearfe.geometry.damage.pit import pit_row

from ..shared.places import ROOT
from ..shared.solid_pair import solid_contact

SETTINGS = ((2, 8), (2, 11), (3, 8), (3, 11), (3, 14), (4, 16))  # order and axial degree; the last is the reference
BRUTE = 0.8  # resolution of the finite elements
PHASES, FORCE, WIDTH = 64, 7120.0, 30.0  # width of a half
ABOUT = (
    "Both halves of a herringbone sun-planet pair: 18/27, m_n 2 mm, 16 degrees, halves of 30 mm, bores at half the root radius, "
    f"{FORCE:g} N, {PHASES} phases, sun with a full-width crack of 30 % and fourteen pits of 2 mm. Each row is a process of "
    "its own; "
    "imports are excluded from its seconds, not from its peak memory. Reference: order 4, axial degree 16. Another layout of "
    "pits "
    "costs only the contact along the lines; the bodies are known."
)


def case(last=27.0):
    """Return a herringbone sun-planet pair, 18/27, with a crack of 30 % and seven pits in each half, and its damage."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 2 * WIDTH}
    sun, planet = (
        gf.Gear(z=z, r_bore=0.5 * (z * 1.0403 - 2.5), beta=sense * math.radians(16), **rack) for z, sense in ((18, 1), (27, -1))
    )
    row = {"radius": sun.r, "axes": (1.0, 1.0), "depth": 0.1}
    pits = [*pit_row(7, 3.0, last, **row), *pit_row(7, 57.0, 2 * WIDTH - last, **row)]
    return gf.GearPair(sun, planet), gf.Material(E=206e3, nu=0.3), [gf.Crack(level=0.3)], pits


def solve(method, *setting, last=27.0):
    """Its k at 64 phases."""
    pair, steel, cracks, pits = case(last)
    if method == "ritz3d":
        order, axial = map(int, setting)
        damage = {"pits": (pits, ()), "cracks": (tuple(cracks), ())}
        return solid_contact(pair, FORCE, steel, PHASES, face="herringbone", order=order, axial=axial, **damage).k
    options = {"refine": float(setting[0])} if setting else {}
    damage = {"pinion": [*cracks, *pits]}
    return gf.mesh_stiffness(pair, FORCE, steel, method=method, phases=PHASES, face="herringbone", damage=damage, **options).k


def measure(*setting):
    """Seconds of a pair, of another layout of its pits, peak memory [MB] and k, in a separate process."""
    gf.mesh_stiffness(*case()[:1], FORCE, case()[1], method="textbook", phases=1, face="herringbone")  # imports
    started = time.process_time()
    k = solve(*setting)
    middle = time.process_time()
    solve(*setting, last=26.0)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {"seconds": middle - started, "again": time.process_time() - middle, "peak": peak, "k": k.tolist()}


def rows():
    """Measure: rows of `speed_page.table`."""
    asked = [("ritz3d", *map(str, setting)) for setting in SETTINGS]
    asked += [("fe3d", str(BRUTE)), ("textbook",), ("herringbone_article",)]
    found = {}
    for setting in asked:
        command = [sys.executable, "-m", "validation.make.speed_three", *setting]
        environment = os.environ | {"GEARFE_CACHE": ""}
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT, env=environment)
        found[setting] = json.loads(done.stdout)
        print(*setting, {name: round(found[setting][name], 2) for name in ("seconds", "again", "peak")}, flush=True)
    truth = np.array(found[asked[len(SETTINGS) - 1]]["k"])
    return [_row(setting, one, np.abs(np.array(one["k"]) / truth - 1)) for setting, one in found.items()]


def _row(setting, one, error):
    kind = setting[0]
    name = {"ritz3d": "ritz3d, order {}, axial degree {}", "fe3d": "fe3d, refine {}"}.get(kind, kind).format(*setting[1:])
    default = setting == ("ritz3d", "3", str(ritz3d.axial_degree(WIDTH, 2.0)))
    more = f"{one['again']:.2g} s with other pits, {one['peak']:.0f} MB"
    return kind, name, one["seconds"], float(error.mean()), float(error.max()), int(default), more


if __name__ == "__main__":
    print(json.dumps(measure(*sys.argv[1:])))
