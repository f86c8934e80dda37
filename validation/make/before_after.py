"""Seconds, memory and errors of today's code beside those of an earlier commit, alternating in one run on one machine."""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.files import written

from ..shared import machine
from ..shared.places import PAGES, ROOT

BEFORE = "dea26c6"  # the last commit before the work on three dimensions' speed
ROUNDS, PHASES = 2, 64
CASES = {  # scene, pair, case, options; and the options of the finest solution
    "S4 sun-planet, crack and pits (case 4)": ("herringbone", "sun_planet", "case4", {"method": "ritz3d"}, {"order": 4}),
    "S3 pair, healthy": ("helical_pitting", "pinion_wheel", None, {"method": "ritz3d"}, {"order": 4}),
    "S4, the same, order 2": ("herringbone", "sun_planet", "case4", {"method": "ritz3d", "order": 2}, {"order": 4}),
    "S3, the same, order 2": ("helical_pitting", "pinion_wheel", None, {"method": "ritz3d", "order": 2}, {"order": 4}),
    "section, new pair": ("planetary_pitting", "sun_planet", None, {"method": "ritz"}, {"method": "fe", "refine": 3.0}),
    "section, crack 50 %": ("planetary_pitting", "sun_planet", 0.5, {"method": "ritz"}, {"method": "fe", "refine": 3.0}),
    "section, finite elements": ("planetary_pitting", "sun_planet", None, {"method": "fe"}, {"method": "fe", "refine": 3.0}),
}


def measure(name, finest=False):
    """CPU seconds, peak memory [MB] and k [N/m] of a case by the code that is imported here; nothing known before."""
    scene, pair, case, options, finer = CASES[name]
    chosen = gf.load_scene(scene).pair(pair)
    crack = isinstance(case, float)
    damage = {"pinion": [gf.Crack(level=case)]} if crack else chosen.damage[case] if case else None
    run = {"damage": damage, "phases": PHASES, "cache": False} | options | (finer if finest else {})
    if run["method"] == "ritz3d":
        run |= {"face": chosen.face, "groove": chosen.groove}
    _warm()
    started = time.process_time()
    curve = gf.mesh_stiffness(chosen.pair, chosen.force, chosen.materials, **run)
    seconds = time.process_time() - started
    return {"seconds": seconds, "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, "k": curve.k.tolist()}


def _warm():
    """Another pair, so that imports and what every pair shares do not count."""
    rack = {"m_n": 3.0, "alpha_n": np.radians(20), "b": 9.0}
    pair = gf.GearPair(*(gf.Gear(z=z, r_bore=z, **rack) for z in (17, 23)))
    for method in ("ritz", "fe"):
        gf.mesh_stiffness(pair, 1000.0, gf.Material(E=206e3, nu=0.3), method=method, phases=1)


def run():
    """Measure both, write `before_after.md` and print it."""
    with tempfile.TemporaryDirectory() as folder:
        old = Path(folder) / "before"
        subprocess.run(["git", "worktree", "add", "--detach", str(old), BEFORE], cwd=ROOT, check=True, capture_output=True)
        try:
            rows = [_row(name, old) for name in CASES]
        finally:
            subprocess.run(["git", "worktree", "remove", "--force", str(old)], cwd=ROOT, check=True)
    text = f"""# Before and after

Made by `python -m validation before_after` on {machine.describe()}.
One mesh cycle of {PHASES} phases, each run a process of its own after another small pair and with nothing known of this one,
commit {BEFORE} and today's code in turn, the faster of {ROUNDS} runs each; seconds are the processor's, memory is the peak of the
process with all imports. Error: the largest at a phase against the finest solution of today's code (three dimensions: order 4
with the same functions along the width, what more of those change stands in [speed_three.md](speed_three.md); sections: finite
elements with edges a third as long). In three dimensions the error before contains what today's code models in addition, free end
faces.

| case | seconds before | after | ratio | memory before | after | error before | after |
|---|---|---|---|---|---|---|---|
{chr(10).join(rows)}
"""
    with written(PAGES / "before_after.md") as file:
        Path(file).write_text(text, encoding="utf-8")
    print(text)


def _row(name, old):
    places = {"before": old, "after": ROOT}
    runs = {one: [] for one in places}
    for _ in range(ROUNDS):
        for one, place in places.items():
            runs[one].append(_apart(place, name))
    finest = np.array(_apart(ROOT, name, True)["k"])
    best = {one: min(found, key=lambda each: each["seconds"]) for one, found in runs.items()}
    errors = {one: np.abs(np.array(found["k"]) / finest - 1).max() for one, found in best.items()}
    (a, b), (before, after) = errors.values(), best.values()
    row = f"| {name} | {before['seconds']:.3g} | {after['seconds']:.3g} | {before['seconds'] / after['seconds']:.1f} | "
    row += f"{before['peak']:.0f} MB | {after['peak']:.0f} MB | {100 * a:.2g} % | {100 * b:.2g} % |"
    print(row, flush=True)
    return row


def _apart(place, name, finest=False):
    environment = os.environ | {"PYTHONPATH": str(place), "GEARFE_CACHE": "", "OMP_NUM_THREADS": "1"}
    call = f"import json, runpy; found = runpy.run_path({__file__!r}, run_name='validation.make.apart')"
    call += f"['measure']({name!r}, {finest}); print(json.dumps(found))"
    done = subprocess.run([sys.executable, "-c", call], cwd=place, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{name} in {place}:\n{done.stderr[-2000:]}")
    return json.loads(done.stdout.splitlines()[-1])
