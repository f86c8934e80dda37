"""Pits cut out of cracked teeth: the ten rows of S4 with holes and crack in the tooth, circular and elliptic (resumable).

A row is computed once and appended to `tables/holed_cracks.csv`; `run` computes what the table lacks and writes the page from it.
"""

import csv
import math
import time
from dataclasses import replace
from pathlib import Path

import gearfe as gf
from gearfe.files import written
from gearfe.stress.holed import pressed_tooth
from gearfe.studies.case_table import damage_cycle, printed_cases

from ..shared import machine
from ..shared.herringbone_page import SCENE
from ..shared.places import PAGES, TABLES

PAGE = PAGES / "holed_cracks.md"
TABLE = TABLES / "holed_cracks.csv"
COLUMNS = ("pair", "case", "pits", "refine", "phases", "k mean [N/m]", "mean change", "largest change", "unknowns", "seconds")
EVERY = 8  # of the cycle's 32 phases
SHAPES = {"circular": 1.0, "elliptic": 2.0}  # long over short axis at equal area, the long one along the width
MAIN, FINE = 1.0, 1.6
FINER = (("sun_planet", "case2"), ("sun_planet", "case3"))  # solved on both meshes

TEXT = """
In the other pages pits take contact away and no material. Here the ten rows of article S4 are solved with their pits cut out of
the tooth *and* its crack in it: the damaged tooth and its neighbours in straight second-order tets (`gearfe.stress.holed`), once
with the holes and once with the same mesh filled, both cracked, under the loads that `ritz3d` finds along the contact lines that
the pits leave. The work of these loads on the difference, over force times approach, is by how much the missing material makes
the pair softer: k with holes is k with lost contact over 1 + that. The loads do not redistribute, so it is an upper bound.

Elliptic pits have the area, depth and place of the scene's circular ones, are twice as long as wide and lie along the width.
Mean: over the mesh cycle in which the damaged tooth is in the middle of its engagement ({phases} phases). Lost contact: `ritz3d`
with contact on the path only, so it is below the table of [S4](herringbone.md) by what the tip corners carry.
"""


def wanted():
    """(pair, case, shape, refine) of all rows, in order of importance."""
    cases = [(pair, case) for pair, case in printed_cases(gf.load_scene(SCENE)) if case]
    main = [(*one, shape, MAIN) for shape in SHAPES for one in cases]
    return main + [(*one, "circular", FINE) for one in FINER]


def stored():
    """Rows of the table by (pair, case, shape, refine)."""
    if not TABLE.exists():
        return {}
    with TABLE.open(encoding="utf-8", newline="") as file:
        return {(r["pair"], r["case"], r["pits"], float(r["refine"])): r for r in csv.DictReader(file)}


def shaped(damage, ratio):
    """Damage with its pits `ratio` times as long as wide, at the same area."""

    def other(one):
        if not isinstance(one, gf.Pit):
            return one
        size = math.sqrt(one.axes[0] * one.axes[1])
        return replace(one, axes=(size / math.sqrt(ratio), size * math.sqrt(ratio)))

    return {side: [other(one) for one in found] for side, found in damage.items()}


def solve(pair, case, shape, refine):
    """One row of the table."""
    chosen = gf.load_scene(SCENE).pairs[pair]
    phases = damage_cycle(chosen)[EVERY // 2 :: EVERY]
    started = time.process_time()
    found = pressed_tooth(
        chosen.pair, chosen.force, chosen.materials, shaped(chosen.damage[case], SHAPES[shape]),
        phases=phases, refine=refine, removal=True, face=chosen.face, groove=chosen.groove,
    )  # fmt: skip
    seconds = time.process_time() - started
    k = found.contact.k
    change = 1 / (1 + found.extra) - 1
    means = (k.mean(), (k * (1 + change)).mean() / k.mean() - 1, change.min())
    numbers = (refine, phases.size, *means, found.unknowns, seconds)
    return dict(zip(COLUMNS, (pair, case, shape, *(f"{v:.6g}" for v in numbers)), strict=True))


def table():
    """Ten rows as Markdown: stiffness with lost contact, and what cutting the pits out changes."""
    known = stored()
    lines = ["| pair | case | k, lost contact [N/um] | circular, mean | largest | elliptic, mean | largest | finer mesh, mean |"]
    lines.append("|---" * 8 + "|")
    for pair, case in printed_cases(gf.load_scene(SCENE)):
        rows = [known.get((pair, case, shape, MAIN)) for shape in SHAPES]
        if case and rows[0]:
            finer = known.get((pair, case, "circular", FINE))
            cells = [_percent(row and row[name]) for row in rows for name in ("mean change", "largest change")]
            cells = [pair, case, f"{float(rows[0]['k mean [N/m]']) / 1e6:.1f}", *cells, _percent(finer and finer["mean change"])]
            lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _percent(value):
    return f"{100 * float(value):+.3f} %" if value else ""


def verdict():
    """What the table says in a sentence."""
    rows = stored().values()
    most = min(rows, key=lambda row: float(row["largest change"]))
    mean = max(abs(float(row["mean change"])) for row in rows)
    return (
        f"Pits as lost contact leave out at most {100 * mean:.3f} % of the mean stiffness of these cracked teeth and "
        f"{-100 * float(most['largest change']):.3f} % at a phase ({most['pair']}, {most['case']}, {most['pits']})."
    )


def page():
    """The page, from its table alone."""
    known = stored()
    phases = next(iter(known.values()))["phases"]
    seconds = sum(float(row["seconds"]) for row in known.values())
    lines = [
        "# Pits cut out of cracked teeth",
        "",
        f"Made by `python -m validation holed_cracks` from `tables/holed_cracks.csv`; {len(known)} solves took {seconds:.0f} s",
        f"of the processor on {machine.describe()}.",
        *TEXT.format(phases=phases).rstrip().splitlines(),
        "",
        table(),
        "",
        verdict(),
    ]
    left = sum(key not in known for key in wanted())
    lines += ["", f"{left} of {len(wanted())} rows are not computed yet."] if left else []
    return "\n".join(lines) + "\n"


def run():
    """Compute the rows that the table lacks, each kept at once, and write the page."""
    for key in wanted():
        known = stored()
        if key in known:
            continue
        row = solve(*key)
        TABLE.parent.mkdir(exist_ok=True)
        with written(TABLE) as name, open(name, "w", encoding="utf-8", newline="") as file:
            out = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            out.writeheader()
            out.writerows([*known.values(), row])
        print(f"  {key}: {row['mean change']}, {float(row['seconds']):.0f} s", flush=True)
    with written(PAGE) as name:
        Path(name).write_text(page(), encoding="utf-8")
    print(table())
