"""A part of the page `speed`: cost of the energy model in three dimensions over teeth, width, helix angle, order and phases."""

import json
import math
import subprocess
import sys
import time

import numpy as np

import gearfe as gf

from ..shared.places import ROOT
from ..shared.solid_pair import solid_contact

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
    solid_contact(pair, 100 * width, gf.Material(E=206e3, nu=0.3), setting["phases"], **run)
    return time.process_time() - started


def seconds():
    """Measure, each setting in a process of its own: CPU seconds by what is varied."""
    found = {}
    for name, values in OVER.items():
        fixed = STANDARD | (SPUR if name.endswith(", spur") else {})
        found[name] = [_apart(fixed | {name.removesuffix(", spur"): value}) for value in values]
        print(name, np.round(found[name], 2), flush=True)
    return found


def _apart(setting):
    command = [sys.executable, "-m", "validation.make.cost_three", json.dumps(setting)]
    return float(subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout)


if __name__ == "__main__":
    print(measure(json.loads(sys.argv[1])))
