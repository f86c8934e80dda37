"""Pits cut out of cracked teeth: the ten rows of S4 with holes and crack in the tooth, circular and elliptic (resumable).

A row is computed once and appended to `tables/holed_cracks.csv`; `run` computes what the table lacks and writes the page from it.
"""

import csv
import math
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.contact.solid import pair_stiffness3d
from gearfe.files import written
from gearfe.stress.holed import SPREAD, pressed_tooth
from gearfe.studies.case_table import damage_cycle, printed_cases

from ..shared import machine
from ..shared.herringbone_page import SCENE
from ..shared.places import PAGES, TABLES

PAGE = PAGES / "holed_cracks.md"
TABLE = TABLES / "holed_cracks.csv"
COLUMNS = (
    "pair",
    "case",
    "pits",
    "refine",
    "load",
    "spread [m_n]",
    "phases",
    "k mean [N/m]",
    "mean change",
    "largest change",
    "unknowns",
    "seconds",
)
EVERY = 8  # of the cycle's 32 phases
SHAPES = {"circular": 1.0, "elliptic": 2.0}  # long over short axis at equal area, the long one along the width
MAIN, FINE = 1.0, 1.6
FINER = (("sun_planet", "case2"), ("sun_planet", "case3"))  # solved on both meshes
WIDE, HERTZ = "wide", "hertz"  # how far the load is spread to either side of its line
HAT = 1.2  # Hertz half widths: a hat of this half base is as wide, in the square, as his pressure

TEXT = """
In the other pages pits take contact away and no material. Here the ten rows of article S4 are solved with their pits cut out of
the tooth *and* its crack in it: the damaged tooth and its neighbours in straight second-order tets (`gearfe.stress.holed`), once
with the holes and once with the same mesh filled, both cracked, under the loads that `ritz3d` finds along the contact lines that
the pits leave. The work of these loads on the difference, over force times approach, is by how much the missing material makes
the pair softer: k with holes is k with lost contact over 1 + that.

The walls of a pit give way under what is pressed beside them, the more the nearer: the load is spread to either side of its line
as wide as Hertz's pressure (a hat of {HAT} half widths), in a mesh with edges of that length along the line. Rows of 0.15 m_n are
spread wider, as for pictures of stress, and show less. The loads do not redistribute; how far holes are from lost contact where
CalculiX solves the contact itself is in [outsider_three.md](outsider_three.md).

Elliptic pits have the area, depth and place of the scene's circular ones, are twice as long as wide and lie along the width.
Mean: over the mesh cycle in which the damaged tooth is in the middle of its engagement ({phases} phases). Lost contact: `ritz3d`
with contact on the path only, so it is below the table of [S4](herringbone.md) by what the tip corners carry.
"""


def wanted():
    """(pair, case, shape, refine, load) of all rows, in order of importance."""
    cases = [(pair, case) for pair, case in printed_cases(gf.load_scene(SCENE)) if case]
    main = [(*one, shape, MAIN, load) for load in (HERTZ, WIDE) for shape in SHAPES for one in cases]
    return main + [(*one, "circular", FINE, WIDE) for one in FINER]


def stored():
    """Rows of the table by (pair, case, shape, refine, load)."""
    if not TABLE.exists():
        return {}
    with TABLE.open(encoding="utf-8", newline="") as file:
        return {(r["pair"], r["case"], r["pits"], float(r["refine"]), r["load"]): r for r in csv.DictReader(file)}


def shaped(damage, ratio):
    """Damage with its pits `ratio` times as long as wide, at the same area."""

    def other(one):
        if not isinstance(one, gf.Pit):
            return one
        size = math.sqrt(one.axes[0] * one.axes[1])
        return replace(one, axes=(size / math.sqrt(ratio), size * math.sqrt(ratio)))

    return {side: [other(one) for one in found] for side, found in damage.items()}


def hertz(chosen, phases):
    """Half width of Hertz's pressure [m_n], the mean over the contact lines of the healthy pair, weighted by the load."""
    options = {"face": chosen.face, "groove": chosen.groove, "extended": False}
    cells = pair_stiffness3d(chosen.pair, chosen.force, chosen.materials, phases, **options).cells
    load, width, pressure = (np.concatenate([getattr(one, name) for one in cells]) for name in ("load", "width", "pressure"))
    some = (load > 0) & np.isfinite(pressure)
    half = 2 * load[some] * math.cos(chosen.pair.gear_1.beta_b) / width[some] / (math.pi * pressure[some])
    return float((load[some] * half).sum() / load[some].sum()) / chosen.pair.gear_1.m_n


def solve(pair, case, shape, refine, load):
    """One row of the table."""
    chosen = gf.load_scene(SCENE).pairs[pair]
    phases = damage_cycle(chosen)[EVERY // 2 :: EVERY]
    started = time.process_time()
    spread = SPREAD if load == WIDE else HAT * hertz(chosen, phases)
    found = pressed_tooth(
        chosen.pair, chosen.force, chosen.materials, shaped(chosen.damage[case], SHAPES[shape]), phases=phases, refine=refine,
        removal=True, face=chosen.face, groove=chosen.groove, spread=spread, strip=None if load == WIDE else spread,
    )  # fmt: skip
    seconds = time.process_time() - started
    k = found.contact.k
    change = 1 / (1 + found.extra) - 1
    means = (k.mean(), (k * (1 + change)).mean() / k.mean() - 1, change.min())
    numbers = (spread, phases.size, *means, found.unknowns, seconds)
    return dict(zip(COLUMNS, (pair, case, shape, f"{refine:g}", load, *(f"{v:.6g}" for v in numbers)), strict=True))


def table():
    """Ten rows as Markdown: stiffness with lost contact, and what cutting the pits out changes."""
    known = stored()
    kinds = [(shape, MAIN, HERTZ) for shape in SHAPES] + [("circular", MAIN, WIDE), ("circular", FINE, WIDE)]
    names = ("pair", "case", "k, lost contact [N/um]", "circular, mean", "largest", "elliptic, mean", "largest")
    lines = ["| " + " | ".join((*names, "circular, 0.15 m_n, mean", "the same, finer mesh")) + " |"]
    lines.append("|---" * 9 + "|")
    for pair, case in printed_cases(gf.load_scene(SCENE)):
        rows = [known.get((pair, case, *kind)) for kind in kinds]
        if case and any(rows):
            k = float(next(row for row in rows if row)["k mean [N/m]"]) / 1e6
            names = [("mean change", "largest change"), ("mean change", "largest change"), ("mean change",), ("mean change",)]
            cells = [_percent(row and row[name]) for row, own in zip(rows, names, strict=True) for name in own]
            lines.append("| " + " | ".join([pair, case, f"{k:.1f}", *cells]) + " |")
    return "\n".join(lines)


def _percent(value):
    return f"{100 * float(value):+.3f} %" if value else ""


def verdict():
    """What the table says in a sentence."""
    rows = [row for row in stored().values() if row["load"] == HERTZ]
    if not rows:
        return "No row with loads as wide as Hertz's yet."
    most = min(rows, key=lambda row: float(row["largest change"]))
    mean = max(abs(float(row["mean change"])) for row in rows)
    return (
        f"By this estimate lost contact leaves out at most {100 * mean:.3f} % of the mean stiffness of these cracked teeth\n"
        f"and {-100 * float(most['largest change']):.3f} % at a phase ({most['pair']}, {most['case']}, {most['pits']})."
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
        *TEXT.format(phases=phases, HAT=HAT).rstrip().splitlines(),
        "",
        table(),
        "",
        verdict(),
    ]
    left = sum(key not in known for key in wanted())
    lines += ["", f"{left} of {len(wanted())} rows are not computed yet."] if left else []
    return "\n".join(lines) + "\n"


def keep(rows):
    """Write the table."""
    TABLE.parent.mkdir(exist_ok=True)
    with written(TABLE) as name, open(name, "w", encoding="utf-8", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        out.writeheader()
        out.writerows(rows)


def run():
    """Compute the rows that the table lacks, each kept at once, and write the page."""
    for key in wanted():
        known = stored()
        if key in known:
            continue
        row = solve(*key)
        keep([*known.values(), row])
        print(f"  {key}: {row['mean change']}, {float(row['seconds']):.0f} s", flush=True)
    with written(PAGE) as name:
        Path(name).write_text(page(), encoding="utf-8")
    print(table())
