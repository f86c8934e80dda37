"""Page `herringbone`: the ten rows of article S4 by every method, and their dependence on unprinted values."""

import math
import time
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.comparison.compare import compare_cases, damage_cycle
from gearfe.comparison.losses import tooth_stiffness
from gearfe.comparison.printed_stiffness import printed_cases
from gearfe.comparison.solved_curves import solve_fitted
from gearfe.scene.stored import read_curves, stored_file, write_curves

from ..shared import herringbone_page, page
from ..shared.herringbone_page import SCENE, SUMS, TABLES
from ..shared.kept_rows import begin
from ..shared.table_rows import write_table

# refinement of the finite element meshes, which then have 0.2 to 0.55 million unknowns per gear
REFINE = {"sun_planet": 0.8, "planet_ring": 0.65}


def reference():
    """Compute the ten rows by finite elements. Each row is stored when it is complete."""
    scene = gf.load_scene(SCENE)
    begin(Path(stored_file(scene)))
    kept = read_curves(scene)
    for name, case in printed_cases(scene):
        if (name, case) not in kept:
            print(f"{name} {case or 'healthy'}: finite elements", flush=True)
            pair = scene.pairs[name]
            phase = damage_cycle(pair)
            # For the ring pair, a coarser mesh cannot resolve the contact patches, and a finer mesh exceeds 24 GB.
            how = gf.Solve("fe3d", phase, error=name != "planet_ring", refine=REFINE[name], tell=_tell)
            started, one = time.perf_counter(), solve_fitted(pair.case(case), how)
            seconds, estimate = time.perf_counter() - started, _estimate(one)
            kept[name, case] = phase, one.k, tooth_stiffness(one, 0), estimate, seconds
            write_curves(scene, kept, Path(stored_file(scene)))
            print(f"  {seconds:.0f} s, mean {one.k.mean():.4e} N/m, estimate {100 * estimate:.2f} %", flush=True)


def _estimate(curve):
    """Return the mean relative error estimate of a curve, or nan if there is none."""
    return math.nan if curve.error is None else float((curve.error / curve.k).mean())


def _tell(text):
    print(f"  {text}", flush=True)


def every_case():
    """Compute every case by every method, and write the table."""
    scene = gf.load_scene(SCENE)
    print("every case by every method")
    found, rows = compare_cases(scene, printed_cases(scene)), []
    for pair, case in found.asked:
        truth = found.of(pair, case)["fe3d"].k
        for method, curve in found.of(pair, case).items():
            whole = found.solved[pair, None, method]
            tooth, before = (tooth_stiffness(one, 0).mean() for one in (curve, whole))
            k, most = curve.k.mean(), curve.k.max()
            drops = ((1 - curve.k / whole.k).max(), 1 - k / whole.k.mean(), 1 - tooth / before) if case else (0.0,) * 3
            errors = k / truth.mean() - 1, most / truth.max() - 1, np.abs(curve.k / truth - 1).max()
            numbers = k, most, *errors, *drops, _estimate(curve), found.times[pair, case, method]
            rows.append([pair, case or "healthy", method, *map(float, numbers)])
    header = ["pair", "case", "method", "mean [N/m]", "max [N/m]", "error of mean", "error of max", "largest error at a phase"]
    header += ["largest drop", "drop of mean", "drop of the damaged tooth", "estimate", "seconds"]
    write_table(TABLES / f"{SCENE}.csv", header, rows)


def text():
    """Return the arguments of `page.text` from the tables."""
    fit = _sentences("herringbone_fit", 2).replace("along the contact line", "[along the contact line](herringbone_fit.md)", 1)
    claim = _sentences("herringbone_readings").replace("This claim", "[This claim](herringbone_readings.md)", 1)
    usual = f"In the scene with usual values, the article's formulas are beyond 3 % in {herringbone_page.beyond()} of ten rows."
    answer = f"{fit}\n- {claim}\n- {usual}"
    how = [
        "`python -m validation herringbone` computes this page and `tables/herringbone*.csv`.",
        "[herringbone_statements.md](herringbone_statements.md) has the conclusions of S4 from its stiffness.",
        "The finite elements, in `gearfe/scene/scenes/herringbone_fe3d.csv`, are computed by `... herringbone --reference`.",
    ]
    return answer, herringbone_page.ten_rows(), herringbone_page.as_printed(), ["## Method", "", *how]


def _sentences(name, count=1):
    """Return the first `count` lines of the answer of a frozen page."""
    return "\n".join(page.read(name)[0].splitlines()[2 : 2 + count])


def run(again=True):
    """Write the page. With `again`, its stored rows are computed again."""
    if again:
        every_case()
    page.write("herringbone", *text())


def cheap():
    """Yield the rows that `validation.check` computes again: mean and largest k of the closed forms."""
    pairs = gf.load_scene(SCENE).pairs
    for row in herringbone_page.load(SCENE):
        if row["method"] in SUMS:
            case = pairs[row["pair"]].case(None if row["case"] == "healthy" else row["case"])
            how = gf.Solve(row["method"], damage_cycle(pairs[row["pair"]]))
            known = [float(row["mean [N/m]"]), float(row["max [N/m]"])]
            yield ", ".join((row["method"], row["pair"], row["case"])), known, lambda case=case, how=how: _sizes(case, how)


def _sizes(case, how):
    k = solve_fitted(case, how).k
    return [k.mean(), k.max()]
