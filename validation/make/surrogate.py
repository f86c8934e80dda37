"""A part of the page `sweeps`: stand-ins fitted for `ritz`, their error on fresh cases, and the time of a call."""

import math
import time

import numpy as np

import gearfe as gf

HELD = 32
CRACKED = {"force": (500.0, 4000.0), "level": (0.05, 0.6)}
WIDE = CRACKED | {"angle": (math.radians(30), math.radians(60)), "bore_1": (0.3, 0.75), "x_1": (-0.2, 0.4)}
TEETH = {"force": (500.0, 4000.0), "z_1": (19, 25), "z_2": (28, 36), "x_1": (0.0, 0.3), "bore_1": (0.4, 0.7)}
FITS = (("load and crack", CRACKED, 32), ("load, crack and pinion", WIDE, 96), ("healthy, other teeth", TEETH, 48))
SHOWN = {"force": "N", "level": "-", "angle": "rad"}


def fitted():
    """Lines of what the fits and the calls gave."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    steel = gf.Material(E=207e3, nu=0.3)
    lines, made = [], {}
    for name, inputs, cases in FITS:
        started = time.process_time()
        one = made[name] = gf.fit_surrogate(pair, steel, inputs, cases=cases, held_back=HELD, workers=1)
        errors = " | ".join(f"{100 * one.error[key]:.3f} %" for key in ("mean", "worst", "worst mean k"))
        cost = time.process_time() - started
        lines.append(f"| {name} | {len(inputs)} | {cases} | {one.meta['terms']} | {errors} | {cost:.0f} |")
        print(lines[-1], flush=True)
    ranges = [f"- {name}: {_told(one)}" for name, one in made.items()]
    return {"fits": lines, "ranges": ranges, "calls": _times(made["load, crack and pinion"], steel)}


def told(found):
    """Lines of the page."""
    return [
        "## Stand-ins",
        "",
        "`gf.fit_surrogate` about a 21/31 pair of 2 mm module and 20 mm width, and how far k is from `ritz` on",
        f"{HELD} cases that had no part in the fit, at 64 phases a cycle that were not fitted. The discretisation error of",
        "`ritz`",
        f"itself is not in it. On {found['machine']}:",
        "",
        "| ranges | inputs | cases | terms | mean | worst phase | worst mean k | CPU s of the fit |",
        "|---|---|---|---|---|---|---|---|",
        *found["fits"],
        "",
        *found["ranges"],
        "",
        *found["calls"],
    ]


def _told(one):
    """Ranges of a surrogate, and where in the mesh cycle it is worst."""
    ends = one.space.ranges.items()
    ranges = ", ".join(f"`{name}` {low:.3g} to {high:.3g} {SHOWN.get(name, '')}".rstrip(" -") for name, (low, high) in ends)
    worst = 100 * np.sort(one.worst)
    return f"{ranges}; worst of the {worst.size} pieces of the mesh cycle {worst[-1]:.2f} %, median {np.median(worst):.2f} %"


def _times(one, steel):
    """CPU time of calls, beside that of what they stand for."""
    point = {name: low + 0.4 * (high - low) for name, (low, high) in one.space.ranges.items()}
    phase = np.linspace(0.0, 1.0, 64)
    case, how = one.space.case(point, steel), {"phases": phase, "method": "ritz"}
    calls = {
        "k at one phase": (lambda: one.k(0.3, **point), 1000),
        "k at 64 phases": (lambda: one.k(phase, **point), 1000),
        "k at 10 000 phases": (lambda: one.k(np.linspace(0.0, 1.0, 10_000), **point), 100),
        "`mesh_stiffness` at 64 phases, gears not seen before": (lambda: gf.mesh_stiffness(case, **how, cache=False), 5),
        "`mesh_stiffness` at 64 phases, gears kept": (lambda: gf.mesh_stiffness(case, **how), 10),
    }
    out = ["| call, five inputs | CPU time | of one k |", "|---|---|---|"]
    for name, (call, count) in calls.items():
        call()
        started = time.process_time()
        for _ in range(count):
            call()
        each = (time.process_time() - started) / count
        phases = 10_000 if "10 000" in name else 64 if "64" in name else 1
        out.append(f"| {name} | {1e6 * each:.0f} us | {1e6 * each / phases:.2g} us |")
    return out
