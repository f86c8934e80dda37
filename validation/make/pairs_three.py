"""A part of the page `three`: pairs by the energy model against hexahedra of both whole gears, healthy and damaged.

The finite elements take minutes; `reference` appends what is missing to a table, case by case.
"""

import csv
import math
import sys
import time
import warnings
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.core.files import written
from gearfe.geometry.damage.pit import pit_row

from ..shared.kept_rows import begin, kept
from ..shared.places import TABLES

TABLE = TABLES / "pairs_three.csv"
OURS = "pairs_three_ritz3d"  # table of rows
COLUMNS = ("pair", "case", "refine", "dofs 1", "dofs 2", "seconds", "phase", "k [N/m]")
STEEL = gf.Material(E=207e3, nu=0.3)
LOAD = 100.0  # [N/mm]
PHASES = 12  # of a mesh cycle, over the whole engagement of the damaged tooth
MAIN, COARSE = 0.8, 0.55  # resolutions
CASES = ("healthy", "crack 30 %", "crack 60 %", "7 pits")
TWO = ("17/ring 42", "healthy")  # with both resolutions

TEXT = f"""
## Pairs over their engagement, beside hexahedra

`fe3d`: 20-node hexahedra of both whole gears, kept in `tables/{TABLE.name}`: {LOAD:g} N/mm, m_n 2 mm, {PHASES} phases per cycle
over the engagement of the pinion's tooth 0, which bears the damage: full-width cracks, or 7 pits in a row at the pitch line, as
lost contact; contact on the path only. What hexahedra of other pairs say is in [sample.md](sample.md), with an estimate of their
error. Phases at which the load presses the faces of a crack together are left out: the
hexahedra on file let them pass through each other.

Mean and largest: `ritz3d` against the finest mesh, over all phases; bold beyond 0.5 % in the mean or 1 % at a phase. Last step:
mean change of k from the mesh before to the finest. Drop: largest loss of k by the damage in the finite elements, and by how much
of itself that of `ritz3d` differs there and in the mean over the phases. The hexahedra are too stiff by their own discretisation,
most of it in the section; in losses by damage it cancels. The largest differences of cracked teeth are beside the phases left
out.
"""
SHARED = """
Shared by both: the contact lines, the half-space and its images in the end faces that are taken out of each patch, and the
patches, 8 hats across the flank (along the width the finite elements have two more modes). With 12 narrower hats on finer
triangles `ritz3d` finds k of the healthy 12/20 within 0.07 % of that with 8, but for two phases at the ends of the path, 0.3 %.
CalculiX, above, has none of them.
"""


def pairs():
    """Pairs by name: teeth, helix angle, width in modules; wheel or ring with its rim radius."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20)}
    ring = {"tip_radius": 0.2, "addendum": 0.8}

    def made(one, two, degrees, b, **wheel):
        beta, rim = math.radians(degrees), wheel.get("r_rim")
        first = gf.Gear(z=one[0], r_bore=one[1], b=b, beta=beta, **rack)
        second = gf.Gear(z=two[0], b=b, beta=beta if rim else -beta, **wheel, **rack, **(ring if rim else {"r_bore": two[1]}))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # a ring's trimmed tip
            return gf.GearPair(first, second)

    return {
        "12/20": ("30 degrees, b/m 5", made((12, 6.0), (20, 12.0), 30, 10.0)),
        "17/ring 42": ("10 degrees, b/m 5", made((17, 8.0), (42,), 10, 10.0, r_rim=54.0)),
    }


def damage(pair, case):
    """Damage of the pinion's tooth 0 in a case."""
    gear = pair.gear_1
    if case == "7 pits":
        radius = pair.pitch_radius_1
        size = {"axes": (0.4 * gear.m_n, min(0.5 * gear.m_n, gear.b / 20)), "depth": 0.05 * gear.m_n}
        return {"pinion": pit_row(7, 0.1 * gear.b, 0.9 * gear.b, radius=radius, **size)}
    return None if case == "healthy" else {"pinion": [gf.Crack(level=float(case.split()[1]) / 100)]}


def curve(pair, case, **options):
    """Stiffness curve over the engagement of tooth 0."""
    run = {"phases": PHASES, "span": "tooth", "damage": damage(pair, case), "extended": False}
    return gf.mesh_stiffness(pair, LOAD * pair.gear_1.b, STEEL, **(run | options))


def model_curve(pair, case):
    """Stiffness by the energy model, and the phases (a mask) at which no load presses the faces of a crack together."""
    found = curve(pair, case, method="ritz3d")
    return found.k, ~np.isin(found.phase, found.meta.get("crack_closed_phases", ()))


def kept_model(name, pair, case, again):
    """What `model_curve` gives, from its row on file."""

    def make():
        k, apart = model_curve(pair, case)
        return {"k": [float(f"{v:.8g}") for v in k], "apart": apart.tolist()}

    row = kept(OURS, f"{name}, {case}", make, again)
    return np.array(row["k"]), np.array(row["apart"])


def wanted():
    """(pair, case, refine) of all runs, in order of importance."""
    return [(name, case, MAIN) for name in pairs() for case in CASES] + [(*TWO, COARSE)]


def stored():
    """Runs of the table: by (pair, case, refine) the unknowns, seconds, phases and k."""
    if not TABLE.exists():
        return {}
    out = {}
    with TABLE.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            run = out.setdefault((row["pair"], row["case"], float(row["refine"])), {"phase": [], "k": []})
            run |= {"dofs": (int(row["dofs 1"]), int(row["dofs 2"])), "seconds": float(row["seconds"])}
            run["phase"].append(float(row["phase"]))
            run["k"].append(float(row["k [N/m]"]))
    return {key: run | {name: np.array(run[name]) for name in ("phase", "k")} for key, run in out.items()}


def reference():
    """Compute the runs and append each when it is done."""
    from rich.console import Console
    from rich.progress import MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    begin(TABLE)
    made, known = pairs(), stored()
    left = [key for key in wanted() if key not in known]
    columns = (TextColumn("{task.description}"), MofNCompleteColumn(), TimeElapsedColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), disable=not sys.stderr.isatty()) as progress:
        for name, case, refine in progress.track(left, description="hexahedra of whole gears"):
            started = time.process_time()
            found = curve(made[name][1], case, method="fe3d", refine=refine, tell=lambda line: print(f"  {line}", flush=True))
            seconds = time.process_time() - started
            _append(name, case, refine, found, seconds)
            print(f"{name} {case} {refine}: {found.meta['dofs']} unknowns, {seconds:.0f} s", flush=True)


def _append(name, case, refine, found, seconds):
    TABLE.parent.mkdir(exist_ok=True)
    text = TABLE.read_text(encoding="utf-8") if TABLE.exists() else ",".join(COLUMNS) + "\n"
    for phase, k in zip(found.phase, found.k, strict=True):
        text += f"{name},{case},{refine},{found.meta['dofs'][0]},{found.meta['dofs'][1]},{seconds:.0f},{phase:.6g},{k:.8g}\n"
    with written(TABLE) as part:
        Path(part).write_text(text, encoding="utf-8")


def drop(healthy, damaged, other_healthy, other):
    """Largest loss of stiffness, by how much of itself the other's differs there, and the same of the mean loss."""
    loss, second = 1 - damaged / healthy, 1 - other / other_healthy
    at = loss.argmax()
    return loss[at], second[at] / loss[at] - 1, second.mean() / loss.mean() - 1


def row(name, about, case, known, model):
    """One line of the table: differences of the model from the finest mesh, how that mesh still moved, the drop."""
    levels = [known[name, case, r] for r in (COARSE, MAIN) if (name, case, r) in known]
    k, apart = model[case]
    best, away = levels[-1], (k / levels[-1]["k"] - 1)[apart]
    step = f"{100 * (best['k'] / levels[-2]['k'] - 1).mean():+.2f} %" if len(levels) > 1 else ""
    lost = ""
    both = [r for r in (MAIN, COARSE) if (name, "healthy", r) in known and (name, case, r) in known]
    if case != "healthy" and both:
        healthy, damaged = (known[name, c, both[0]]["k"][apart] for c in ("healthy", case))
        loss, at_most, mean = drop(healthy, damaged, model["healthy"][0][apart], k[apart])
        lost = f"{100 * loss:.1f} % | {100 * at_most:+.1f} % | {100 * mean:+.1f} %"
    sizes = " / ".join(f"{sum(level['dofs']):,}" for level in levels)
    mean, most = 100 * away.mean(), 100 * np.abs(away).max()
    text = f"{mean:+.2f} %" if abs(mean) <= 0.5 else f"**{mean:+.2f} %**"
    worst = f"{most:.2f} %" if most <= 1 else f"**{most:.2f} %**"
    closed = f" (without {apart.size - apart.sum()} of {apart.size} phases)" if not apart.all() else ""
    return f"| {name}, {about} | {case}{closed} | {sizes} | {text} | {worst} | {step} | {lost or ' | | '} |"


def section(again=False):
    """Lines of the page; `again`: compute the rows of `ritz3d` again."""
    known = stored()
    lines = [
        *TEXT.strip().splitlines(),
        "",
        "| pair | case | unknowns, both gears | mean | largest | last step | drop | at most | mean drop |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for name, (about, pair) in pairs().items():
        model = {}
        for case in CASES:
            if any((name, case, resolution) in known for resolution in (MAIN, COARSE)):
                model[case] = kept_model(name, pair, case, again)
                lines.append(row(name, about, case, known, model))
    return [*lines, *SHARED.rstrip().splitlines()]


def worst(again=False):
    """Largest difference of `ritz3d` from the finest hexahedra, in the mean over the phases of a case and at a phase."""
    known, means, phases = stored(), [], []
    for name, (_, pair) in pairs().items():
        for case in CASES:
            levels = [known[name, case, r] for r in (COARSE, MAIN) if (name, case, r) in known]
            if levels:
                k, apart = kept_model(name, pair, case, again)
                off = (k / levels[-1]["k"] - 1)[apart]
                means.append(abs(off.mean()))
                phases.append(np.abs(off).max())
    return max(means), max(phases)
