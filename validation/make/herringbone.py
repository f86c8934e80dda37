"""The page `herringbone`: article S4's ten rows by every method, and under every reading of what it does not print."""

from pathlib import Path

import gearfe as gf
from gearfe.comparison.case_table import case_curve, case_table, damage_cycle, printed_cases
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

REFINE = {"sun_planet": 0.8, "planet_ring": 0.65}  # of the finite elements: 0.2 to 0.55 million unknowns a gear


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
            # of the ring pair a coarser mesh cannot carry the patches, and a finer one does not fit into 24 GB
            how = gf.Solve("fe3d", phase, error=name != "planet_ring", refine=REFINE[name], tell=_tell)
            one = case_curve(pair.case(case), how)
            kept[name, case] = phase, one.k, one.tooth, one.estimate, one.seconds
            write_curves(scene, kept, Path(stored_file(scene)))
            print(f"  {one.seconds:.0f} s, mean {one.mean:.4e} N/m, estimate {100 * one.estimate:.2f} %", flush=True)


def _tell(text):
    print(f"  {text}", flush=True)


def every_case():
    """Compute the table of every case by every method and write it."""
    scene = gf.load_scene(SCENE)
    print("every case by every method")
    table = case_table(scene, printed_cases(scene), progress=print)
    rows = []
    for pair, case in table.cases():
        for method in table.methods:
            found = table.curves[pair, case, method]
            drops = table.drops(pair, case, method) if case else (0.0,) * 3
            errors = table.errors(pair, case, method)
            rows.append(
                [pair, case or "healthy", method, found.mean, found.largest, *errors, *drops, found.estimate, found.seconds]
            )
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
    return answer, how, reading, said, herringbone_page.ten_rows(), herringbone_page.as_printed()


def _claim():
    """What the frozen scan of readings opens with, and a link to it."""
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
