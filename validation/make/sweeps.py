"""The page `sweeps`: what thousands of cases cost, what a sweep survives, calls from several threads, and stand-ins."""

import os
import tempfile
import time
from pathlib import Path

import numpy as np

import gearfe as gf

from ..shared import machine, page, sweep_trials, sweeps_page
from ..shared.kept_rows import kept
from . import surrogate, threads

GRID = sweep_trials.BASE | {  # 2000 cases
    "title": "crack level x angle x load x bore",
    "options": {"method": "ritz", "phases": 32},
    "vary": {
        "gear.sun.r_bore_mm": {"from": 5.0, "to": 7.5, "count": 4},
        "crack.cracked.level": {"from": 0.05, "to": 0.55, "count": 25},
        "crack.cracked.angle_deg": [35.0, 40.0, 45.0, 50.0, 55.0],
        "pair.sun_planet.force_N": {"from": 500.0, "to": 4000.0, "count": 4},
    },
}
NEW = GRID | {"vary": {"crack.cracked.level": {"from": 0.05, "to": 0.55, "count": 64}}}  # every case another cracked gear


def new_cracks():
    """Processor time of cracked gears not solved before, in a sweep and by single calls in turn."""
    pair = gf.load_scene("planetary_pitting").pair("sun_planet")
    with tempfile.TemporaryDirectory() as name:
        swept = gf.sweep(NEW, Path(name) / "runs", workers=1).table()["seconds"].to_numpy()
        levels = np.linspace(0.0501, 0.5501, 32)
        alone = []
        for level in levels:
            begun = time.process_time()
            run = pair.case().as_dict() | {"damage": {"pinion": [gf.Crack(level=float(level))]}, "span": "tooth"}
            gf.mesh_stiffness(**run, method="ritz", phases=32)
            alone.append(time.process_time() - begun)
    return {
        "swept": float(np.median(swept[1:])),
        "least": float(swept.min()),
        "alone": float(np.median(alone)),
        "cases": len(swept),
    }


def grid():
    """The cases, watched, on two processes."""
    with tempfile.TemporaryDirectory() as name:
        found = sweep_trials.watched(GRID, Path(name) / "runs", 2) | {"load_average": os.getloadavg()[0]}
    sizes = [size for _, size, _ in found["memory"]]
    return found | {"memory": [sizes[0], max(sizes), sizes[-1]]}


PARTS = {
    "grid": (grid, sweeps_page.cost),
    "new cracks": (new_cracks, sweeps_page.new),
    "kills": (sweep_trials.kills, sweeps_page.kills),
    "refusals": (sweep_trials.refusals, sweeps_page.refusals),
    "cluster": (sweep_trials.cluster, sweeps_page.cluster),
    "threads of the caller": (threads.callers, threads.callers_told),
    "threads of the linear algebra": (threads.algebra, threads.algebra_told),
    "stand-ins": (surrogate.fitted, surrogate.told),
}
HOW = """
`python -m validation sweeps` makes this page from `tables/sweeps.jsonl` and computes them ({parts}).
The full disk needs leave to mount, the cluster needs dask. Seconds are of
the machine named beside them.
"""


def answer(found):
    """The first line."""
    grid, kills, callers = (found[name] for name in ("grid", "kills", "threads of the caller"))
    same = kills["same"] and found["refusals"]["same"] and found["cluster"]["same"] and not callers["failed"]
    least, most = min(callers["ratios"]), max(callers["ratios"])
    part = grid["case_seconds"] / (grid["parent_seconds"] + grid["worker_seconds"])
    return (
        f"{'Yes' if same else '**Not always**'}: a case costs {1e3 * grid['case_seconds'] / grid['cases']:.0f} ms of one "
        f"processor, {100 * part:.0f} % of all processes' time is in cases, and {len(kills['kills'])} kills, full disks, a lost "
        f"worker and calls from {threads.THREADS} threads {'changed no bit of a result' if same else 'changed results'}. "
        f"Use processes: {threads.THREADS} threads take {least:.2g} to {most:.2g} times as long as one."
    )


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    found = {}
    for name, (make, _) in PARTS.items():
        found[name] = kept("sweeps", name, lambda make=make: make() | {"machine": machine.describe()}, again)
    sections = [tell(found[name]) for name, (_, tell) in PARTS.items()]
    page.write("sweeps", answer(found), HOW.format(parts=", ".join(PARTS)).strip().splitlines(), *sections)
