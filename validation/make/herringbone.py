"""The page `herringbone`: article S4's ten rows by every method, and under every reading of what it does not print."""

import csv
import math
from dataclasses import replace
from pathlib import Path

import gearfe as gf
from gearfe.comparison.case_table import case_curve, case_table, damage_cycle, printed_cases
from gearfe.scene.stored import read_curves, stored_file, write_curves

from ..shared import (
    herringbone_contact_line,
    herringbone_page,
    herringbone_reading,
    herringbone_section,
    herringbone_statements,
    page,
)
from ..shared.herringbone_page import SCENE, SUMS, TABLES
from ..shared.kept_rows import begin

REFINE = {"sun_planet": 0.8, "planet_ring": 0.65}  # of the finite elements: 0.2 to 0.55 million unknowns a gear
EVERY = 4  # of the cycle's phases, for the sensitivities
VARIATIONS = {
    "as in the scene": {},
    "bores 0.35 of the root radius": {"bore": 0.35},
    "bores 0.7 of the root radius": {"bore": 0.7},
    "a quarter of the load": {"load": 0.25},
    "four times the load": {"load": 4.0},
    "pits of 2 mm diameter": {"pit": {"axes": (1.0, 1.0)}},
    "pits 0.5 mm deep": {"pit": {"depth": 0.5}},
    "pits 0.6 mm nearer the tip": {"shift": 0.6},
    "pits 0.6 mm nearer the root": {"shift": -0.6},
    "crack from the root circle": {"crack": {"start": "root"}},
    "crack at 35 degrees": {"crack": {"angle": math.radians(35)}},
}


def varied(chosen, *, bore=None, load=1.0, pit=None, shift=0.0, crack=None):
    """A scene's pair with other bores (part of the root radius; rings stay), load (factor), pits and cracks."""
    pair = chosen.pair
    if bore is not None:
        gears = [g if g.internal else replace(g, r_bore=bore * g.r_f) for g in (pair.gear_1, pair.gear_2)]
        pair = gf.GearPair(*gears, pair.a)

    def other(one):
        if isinstance(one, gf.Pit):
            return replace(one, radius=one.radius + shift, **(pit or {}))
        return replace(one, **(crack or {}))

    damage = {case: {side: [other(one) for one in found] for side, found in own.items()} for case, own in chosen.damage.items()}
    return replace(chosen, pair=pair, force=load * chosen.force, damage=damage)


def sensitivity(variation, pair):
    """Rows (variation, pair, case, mean k by `ritz3d` and by the closed forms [N/m]); work of one process."""
    chosen = varied(gf.load_scene(SCENE).pair(pair), **VARIATIONS[variation])
    phase = damage_cycle(chosen)[EVERY // 2 :: EVERY]
    return [
        [variation, pair, case or "healthy", *(case_curve(chosen.case(case), m, phase).mean for m in ("ritz3d", *SUMS))]
        for name, case in printed_cases(gf.load_scene(SCENE))
        if name == pair
    ]


def save(name, header, rows):
    """Write a table of numbers and names."""
    TABLES.mkdir(exist_ok=True)
    with (TABLES / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(header)
        out.writerows([[f"{v:.6g}" if isinstance(v, float) else v for v in row] for row in rows])


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
            one = case_curve(pair.case(case), "fe3d", phase, error=name != "planet_ring", refine=REFINE[name], tell=_tell)
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
    save(SCENE, header, rows)


def sensitivities():
    """Compute the table of other assumptions and write it."""
    jobs = [{"variation": name, "pair": pair} for pair in gf.load_scene(SCENE).pairs for name in VARIATIONS]
    done = gf.batch(jobs, work=sensitivity, progress=lambda n, of: print(f"  sensitivity {n}/{of}", flush=True))
    for found in done.results:
        if isinstance(found, Exception):
            raise found
    header = ["variation", "pair", "case", "ritz3d [N/m]", *(f"{name} [N/m]" for name in SUMS)]
    save(f"{SCENE}_sensitivity", header, [row for found in done.results for row in found])


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
        sensitivities()
        section = herringbone_section.rows(gf.load_scene(SCENE), REFINE)
        save(f"{SCENE}_section", ["pair", "resolution", "mean", "least", "most"], section)
        begin(herringbone_contact_line.path("ritz3d"))
        herringbone_contact_line.compute()
    page.write("herringbone", *text())


def cheap():
    """Rows that `validation.check` computes again: closed forms and `ritz3d` of the scene of the contact line."""
    for (name, pair, case), (k, *_) in herringbone_contact_line.stored().items():
        if name != "fe3d":
            row = name, pair, case
            yield ", ".join(row), k, lambda row=row: herringbone_contact_line.solved(*row)[0]
