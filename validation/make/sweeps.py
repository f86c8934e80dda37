"""The page `sweeps.md`: what a sweep costs, what it survives, and how sure a crack is told from manufacturing scatter.

Every part is kept in `tables/sweeps.json`, so that a run can be stopped and continued; delete a part there to compute it anew.
"""

import json
import os
import tempfile
import time
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.files import written

from ..shared import machine, sweep_trials, sweeps_page
from ..shared.places import PAGES, TABLES

PAGE, KEPT = PAGES / "sweeps.md", TABLES / "sweeps.json"
GRID = sweep_trials.BASE | {  # 10 000 cases
    "title": "crack level x angle x load x bore",
    "options": {"method": "ritz", "phases": 32},
    "vary": {
        "gear.sun.r_bore_mm": {"from": 5.0, "to": 7.5, "count": 10},
        "crack.cracked.level": {"from": 0.05, "to": 0.55, "count": 25},
        "crack.cracked.angle_deg": [35.0, 40.0, 45.0, 50.0, 55.0],
        "pair.sun_planet.force_N": {"from": 500.0, "to": 4000.0, "count": 8},
    },
}
NEW = GRID | {"vary": {"crack.cracked.level": {"from": 0.05, "to": 0.55, "count": 128}}}  # every case another cracked gear


def new_cracks():
    """Processor time of cracked gears not solved before, in a sweep and by single calls in turn."""
    pair = gf.load_scene("planetary_pitting").pair("sun_planet")
    with tempfile.TemporaryDirectory() as name:
        swept = gf.sweep(NEW, Path(name) / "runs", workers=1).table()["seconds"].to_numpy()
        levels = np.linspace(0.0501, 0.5501, 64)
        alone = []
        for level in levels:
            begun = time.process_time()
            run = pair.case() | {"damage": {"pinion": [gf.Crack(level=float(level))]}, "span": "tooth"}
            gf.mesh_stiffness(**run, method="ritz", phases=32)
            alone.append(time.process_time() - begun)
    return {
        "swept": float(np.median(swept[1:])),
        "least": float(swept.min()),
        "alone": float(np.median(alone)),
        "cases": len(swept),
    }


def grid():
    """The 10 000 cases, watched, on two processes."""
    with tempfile.TemporaryDirectory() as name:
        return sweep_trials.watched(GRID, Path(name) / "runs", 2) | {"load_average": os.getloadavg()[0]}


PARTS = {
    "new_cracks": new_cracks, "grid": grid, "kills": sweep_trials.kills,
    "refusals": sweep_trials.refusals, "cluster": sweep_trials.cluster,
}  # fmt: skip


def run():
    """Compute the parts that are not on file, and write the page."""
    kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.is_file() else {}
    only = os.environ.get("SWEEP_PARTS", ",".join(PARTS)).split(",")
    for name, part in PARTS.items():
        if name in kept or name not in only:
            continue
        kept[name] = part() | {"machine": machine.describe()}
        with written(KEPT) as file:
            Path(file).write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
        print(f"  {name}", flush=True)
    with written(PAGE) as file:
        Path(file).write_text(sweeps_page.page(kept), encoding="utf-8")
    print(f"wrote {PAGE.name} on {machine.describe()}")
