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
from gearfe.pictures.sweep_plots import plot_states

from ..shared import machine, sweep_trials
from ..shared.places import PAGES, TABLES

PAGE, KEPT, PICTURE = PAGES / "sweeps.md", TABLES / "sweeps.json", PAGES / "sweeps_tolerances.png"
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
STATES = {"healthy": "healthy", "10 % crack": "ten", "30 % crack": "thirty"}
TOLERANCES = {
    "title": "cracks among manufacturing scatter",
    "scene": "planetary_pitting",
    "pair": "sun_planet",
    "seed": 3,
    "crack": [{"case": "ten", "gear": "sun", "level": 0.1}, {"case": "thirty", "gear": "sun", "level": 0.3}],
    "flank": {"sun": {"gear": "sun", "pair": "sun_planet"}, "planet": {"gear": "planet", "pair": "sun_planet"}},
    "options": {"method": "ritz", "phases": 32, "span": "tooth"},
    "vary": {"case": list(STATES.values())},
    "sample": {
        "method": "sobol",
        "count": 128,
        "of": {
            "gear.sun.x": {"normal": [-0.02, 0.005], "within": [-0.035, -0.005]},
            "gear.planet.x": {"normal": [-0.02, 0.005], "within": [-0.035, -0.005]},
            "flank.sun.slope_um": {"normal": [0.0, 3.0], "within": [-6.0, 6.0]},
            "flank.planet.slope_um": {"normal": [0.0, 3.0], "within": [-6.0, 6.0]},
            "gear.sun.r_bore_mm": {"uniform": [7.39, 7.41]},
            "gear.sun.b_mm": {"uniform": [19.9, 20.1]},
            "material.20CrMnTi.E_MPa": {"normal": [207e3, 2e3]},
            "pair.sun_planet.force_N": {"normal": [2000.0, 40.0]},
        },
    },
}
INDICES = TOLERANCES | {"case": "healthy", "vary": {}, "sample": TOLERANCES["sample"] | {"method": "saltelli", "count": 32}}


def tolerances():
    """Bands and told-apart chances of the worked example; draws its picture."""
    with tempfile.TemporaryDirectory() as name:
        runs = gf.sweep(TOLERANCES, Path(name) / "runs", workers=1)
        table = runs.table(where={"status": "done"})
        curves, means, out = {}, {}, {"cases": len(table), "states": {}}
        by_draw = {case: own.set_index("draw") for case, own in table.groupby("case")}
        # the same number of phases in all curves: the engagement's length varies little with the shifts
        for state, case in STATES.items():
            found = gf.curve_bands(runs, "k", where={"case": case})
            curves[state] = (found["phase"].to_numpy(), found["k"].to_numpy() / 1e6)
            means[state] = by_draw[case]["k_mean"].to_numpy() / 1e6
        rng = np.random.default_rng(1)
        healthy = by_draw["healthy"]
        for state, case in STATES.items():
            own = by_draw[case]
            loss = 1 - own["k_mean"] / healthy["k_mean"].reindex(own.index)
            row = {"mean": float(own["k_mean"].mean()), "spread": float(own["k_mean"].std() / own["k_mean"].mean())}
            row |= {"loss": float(loss.mean()), "loss_spread": float(loss.std())}
            row |= {name: gf.told_apart(healthy[name], own[name]) for name in ("k_mean", "k_min", "te_peak_to_peak")}
            for noise in (0.001, 0.003, 0.01):  # of each of two measurements of one machine
                quiet, hurt = (rng.normal(0, noise * 2**0.5, (200, len(own))) for _ in range(2))
                row[f"own {noise}"] = gf.told_apart(quiet.ravel(), (loss.to_numpy() + hurt).ravel())
            out["states"][state] = row
        plot_states(curves, means, PICTURE, labels=("mesh phase", "k [N/um]", "mean k [N/um]"))
        indices = gf.sweep(INDICES, Path(name) / "indices", workers=1)
        found = gf.sobol_indices(indices, "k_mean")
        out["indices"] = {key: [float(v) for v in row] for key, row in zip(found.index, found.to_numpy(), strict=True)}
        out["indices_cases"] = len(indices)
    return out


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
    "new_cracks": new_cracks, "tolerances": tolerances, "grid": grid, "kills": sweep_trials.kills,
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
