"""The page `herringbone`: article S4's ten rows by every method, and under every reading of its unprinted values."""

import math
import time
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.comparison.compare import compare_cases, damage_cycle, solve_fitted
from gearfe.comparison.losses import tooth_stiffness
from gearfe.comparison.printed_stiffness import printed_cases
from gearfe.scene.stored import read_curves, stored_file, write_curves

from ..shared import (
    herringbone_contact_line,
    herringbone_page,
    herringbone_reading,
    herringbone_statements,
    page,
)
from ..shared.herringbone_page import SCENE, TABLES
from ..shared.kept_rows import begin
from ..shared.table_rows import write_table

REFINE = {"sun_planet": 0.8, "planet_ring": 0.65}  # refinement of the finite elements: 0.2 to 0.55 million unknowns a gear


def reference():
    """Compute the finite elements of the ten rows of both scenes; each is kept at once."""
    begin(herringbone_contact_line.path("fe3d"))
    herringbone_contact_line.compute(["fe3d"])
    scene = gf.load_scene(SCENE)
    begin(Path(stored_file(scene)))
    kept = read_curves(scene)
    for name, case in printed_cases(scene):
        if (name, case) not in kept:
            print(f"{name} {case or 'healthy'}: finite elements", flush=True)
            pair = scene.pairs[name]
            phase = damage_cycle(pair)
            # for the ring pair, a coarser mesh cannot carry the patches, and a finer one does not fit into 24 GB
            how = gf.Solve("fe3d", phase, error=name != "planet_ring", refine=REFINE[name], tell=_tell)
            started, one = time.perf_counter(), solve_fitted(pair.case(case), how)
            seconds, estimate = time.perf_counter() - started, _estimate(one)
            kept[name, case] = phase, one.k, tooth_stiffness(one, 0), estimate, seconds
            write_curves(scene, kept, Path(stored_file(scene)))
            print(f"  {seconds:.0f} s, mean {one.k.mean():.4e} N/m, estimate {100 * estimate:.2f} %", flush=True)


def _estimate(curve):
    """Mean relative error estimate of a curve; nan without one."""
    return math.nan if curve.error is None else float((curve.error / curve.k).mean())


def _tell(text):
    print(f"  {text}", flush=True)


def every_case():
    """Compute the table of every case by every method and write it."""
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
    """Arguments of `page.text`, from the tables."""
    answer = herringbone_reading.answer(_claim(), herringbone_page.beyond())
    how = [
        "`python -m validation herringbone` computes this page and `tables/herringbone*.csv`.",
        "The finite elements, in `gearfe/scene/scenes/herringbone_fe3d.csv`, are computed by `... herringbone --reference`.",
    ]
    reading, said = herringbone_reading.section(), herringbone_statements.section()
    return answer, reading, said, herringbone_page.ten_rows(), herringbone_page.as_printed(), ["## Method", "", *how]


def _claim():
    """First sentence of the frozen scan of readings, with a link to it."""
    return page.read("herringbone_readings")[0].splitlines()[2].replace("The claim", "[The claim](herringbone_readings.md)", 1)


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    if again:
        herringbone_statements.rows(again)
        every_case()
        begin(herringbone_contact_line.path("ritz3d"))
        herringbone_contact_line.compute()
    page.write("herringbone", *text())


def cheap():
    """Rows that `validation.check` computes again: closed forms and `ritz3d` of the scene of the contact line."""
    for (name, pair, case), (k, *_) in herringbone_contact_line.stored().items():
        if name != "fe3d":
            row = name, pair, case
            yield ", ".join(row), k, lambda row=row: herringbone_contact_line.solved(*row)[0]
