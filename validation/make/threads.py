"""Threads of the linear algebra: what a pair costs with one, with all, and with the limit that gearfe sets itself."""

import json
import os
import subprocess
import sys
import time
from math import radians
from pathlib import Path

import gearfe as gf
from gearfe.files import written
from gearfe.threads import CHOSEN

from ..shared import machine
from ..shared.places import PAGES, ROOT

METHODS = {"ritz": 5, "fe": 2, "ritz3d": 1}  # and how often


def pair():
    """A helical pair; in the section it is taken for a spur pair."""
    gears = (gf.Gear(z=z, m_n=2.0, alpha_n=radians(20), beta=radians(16), b=20.0, r_bore=0.45 * 2 * z) for z in (18, 27))
    return gf.GearPair(*gears)


def measure():
    """Processor and clock seconds of a pair by each method, in this process."""
    out, steel = {}, gf.Material(E=207e3, nu=0.3)
    for method, often in METHODS.items():
        phases = 16 if method == "ritz3d" else 64
        one = {"material": steel, "method": method, "phases": phases, "cache": False}
        gf.mesh_stiffness(pair(), 4000.0, **one | {"phases": 1})  # imports
        cpu, clock = time.process_time(), time.perf_counter()
        for _ in range(often):
            gf.mesh_stiffness(pair(), 4000.0, **one)
        out[method] = [(time.process_time() - cpu) / often, (time.perf_counter() - clock) / often]
    return out


def run():
    """Measure in processes of their own, write `threads.md` and print it."""
    cores = os.cpu_count()
    settings = {"not set: one inside of gearfe": {}, "1": {"OMP_NUM_THREADS": "1"}, f"{cores}": {"OMP_NUM_THREADS": f"{cores}"}}
    rest = {name: value for name, value in os.environ.items() if name not in CHOSEN} | {"GEARFE_CACHE": ""}
    found = {}
    for said, chosen in settings.items():
        command = [sys.executable, "-c", "import json; from validation.make.threads import measure; print(json.dumps(measure()))"]
        # the package sets one thread where nothing is set: an empty value stays
        blank = dict.fromkeys(CHOSEN, "")
        done = subprocess.run(command, env=rest | blank | chosen, capture_output=True, text=True, check=True, cwd=ROOT)
        found[said] = json.loads(done.stdout)
    load, made_on = os.getloadavg()[0], machine.describe().replace(", one thread used", "")
    lines = [
        "# Threads of the linear algebra",
        "",
        f"Made by `python -m validation threads` on {made_on}, load {load:.1f} at the "
        "end. A helical pair 18/27, nothing cached: its section by `ritz` and `fe`, 64 phases, and `ritz3d`, 16 phases. "
        "gearfe uses one thread unless an environment variable says how many; the last row is what it did before it had that "
        "limit. On a machine that does other work too, threads wait for each other.",
        "",
        "| OMP_NUM_THREADS | " + " | ".join(f"`{method}` CPU s | clock s" for method in METHODS) + " |",
        "|---" * (1 + 2 * len(METHODS)) + "|",
        *(
            f"| {said} | " + " | ".join(f"{cpu:.3g} | {clock:.3g}" for cpu, clock in row.values()) + " |"
            for said, row in found.items()
        ),
        "",
    ]
    with written(PAGES / "threads.md") as name:
        Path(name).write_text("\n".join(lines), encoding="utf-8")
    print("\n".join(lines))
