"""The page of article S4's error table, from its tables alone."""

import csv
import math

import numpy as np

import gearfe as gf
from gearfe.pictures.stiffness_plots import plot_errors
from gearfe.scene.verdicts import judge, text
from gearfe.studies.case_table import printed_beside
from gearfe.units import in_newton_per_um

from .herringbone_section import said
from .places import TABLES

SCENE = "herringbone"
SUMS = ("published", "textbook")
SPREADS = {"hertz": "as wide as Hertz's pressure", "wide": "wider than Hertz's pressure, which makes it less"}
PAGE = """# Article S4: error table of a herringbone planetary stage with crack and pits

Made by `python -m validation herringbone` from `tables/herringbone*.csv`; the finite elements, in
`gearfe/scenes/herringbone_fe3d.csv`, by `python -m validation --reference`.

Sun-planet and planet-ring pair, healthy and with a root crack of 10, 30, 60, 30 % and 3, 7, 7, 14 pits on one tooth of the sun
(case1 to case4) or of the planet (planet1 to planet4). k is secant, along the transverse line of action, over the mesh cycle in
which the damaged tooth is in the middle of its engagement. What S4 does not print is an assumption of the scene
(`gearfe scenes`).

## S4's formulas in two readings of the ring

S4 prints one foundation formula and uses it for every pair, the ring included (`foundation = "printed"`, h = 1); the formula is a
fit to discs held at their bore, and the rows below it leave the ring's out (`"external"`). Errors of the mean against FE; which
unprinted values would bear S4's table is in [herringbone_scan.md](herringbone_scan.md).

{readings}

## Ours

FE: 20-node hexahedra of the whole gears (`fe3d`), pits as lost contact; the estimate is of its mesh (of the ring pair a coarser
one cannot carry the patches and a finer one does not fit into 24 GB: none). Errors are against it; bold: beyond 3 %. `ritz3d`
is the converged energy model, `published` and `textbook` closed forms in exact slices (of the ring `published` has the
foundation that S4 prints, `textbook` none, since no usual formula is for a ring). Contact lines, the half-space under each and
the patches that the flanks are loaded by are common to `fe3d` and `ritz3d`. These hexahedra were solved when `fe3d` did not yet
keep the faces of a crack apart, as `ritz3d` does.

Pits cut out: what k loses beyond the lost contact of the same pits when they are holes in the cracked tooth, in the mean over the
cycle and, in brackets, at the phase where it loses most. Circular pits are the scene's; elliptic ones have their area and are
twice as long, along the width, as wide. A linear estimate under the loads of lost contact, spread {spread};
[holed_cracks.md](holed_cracks.md) has the meshes, [outsider_three.md](outsider_three.md) holes in contact.

{errors}

{pits}

`ritz3d` is within {mean:.2f} % of the finite elements in all ten means, {largest:.2f} % in all ten maxima and {phase:.2f} %
at every phase; no constant of it is fitted to any gear. Most of this is the section of these hexahedra, which is coarser than
the default: what it lacks in plane strain against one of twice the default's resolution, put into the energy model's gears,
makes k stiffer by: {section}. The rest are the layers along the width; of the ring pair they are the coarsest that carry the
patches, and finer ones do not fit into 24 GB. Smaller pairs with a ring, on finer meshes, are within 0.25 %
([pairs](pairs_three.md)).

{seconds}

Seconds, one thread, on {machine}; a gear that several rows share is counted in the first.

## What damage takes

In percent: largest over the cycle, of the mean over the cycle, and of the damaged tooth's own pair.

{drops}

## What moves the errors

![errors of the closed forms](tables/herringbone_sensitivity.png)

Mean over the cycle against `ritz3d` of the same gears, loads and damage. The healthy stiffness itself moves, sun-planet and
planet-ring:

{moved}

## As printed, and after the stated corrections

{printed}
"""


def load(name):
    """Rows of a table as dicts of text."""
    with (TABLES / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def found():
    """Ours by the id of a reference, each a dict by (case, pair)."""
    rows = load(SCENE)
    reference = "fe3d"

    def values(method, column, factor=1.0):
        return {(r["case"], r["pair"]): factor * float(r[column]) for r in rows if r["method"] == method}

    means = values("published", "mean [N/m]"), values(reference, "mean [N/m]")
    return printed_beside(gf.load_scene(SCENE), *means, values(reference, "largest drop", 100.0))


def error_table(*, pits=False):
    """Ten rows as Markdown: finite elements, and the errors of the mean and of the maximum over the cycle by every method.

    With `pits`: also what cutting them out does to the finite elements' k.
    """
    rows = load(SCENE)
    methods = [name for name in dict.fromkeys(row["method"] for row in rows) if name != "fe3d"]
    shapes = ("circular", "elliptic") if pits else ()
    names = [*(f"pits cut out, {shape}" for shape in shapes), *(f"`{name}` mean | max" for name in methods)]
    columns = 5 + len(shapes) + 2 * len(methods)
    lines = [f"| pair | case | FE mean [N/um] | max | estimate | {' | '.join(names)} |", "|---" * columns + "|"]
    holes = {(r["pair"], r["case"], r["pits"]): r for r in _main_holes()} if pits else {}
    for pair, case in dict.fromkeys((row["pair"], row["case"]) for row in rows):
        own = {row["method"]: row for row in rows if (row["pair"], row["case"]) == (pair, case)}
        truth = own["fe3d"]
        cells = [_error(float(own[name][f"error of {what}"])) for name in methods for what in ("mean", "max")]
        numbers = [in_newton_per_um(float(truth[name]), 5) for name in ("mean [N/m]", "max [N/m]")]
        doubt = float(truth["estimate"])
        estimate = "none" if math.isnan(doubt) else f"± {100 * doubt:.2f} %"
        cut = [_cut(holes.get((pair, case, shape))) for shape in shapes]
        lines.append(f"| {pair} | {case} | " + " | ".join([*numbers, estimate, *cut, *cells]) + " |")
    return "\n".join(lines)


def _main_holes():
    """Rows of the pits cut out under loads as wide as Hertz's, if every case has one; otherwise under wider ones."""
    rows = load("holed_cracks")
    wide = [row for row in rows if row["load"] == "wide" and row["refine"] == rows[0]["refine"]]
    narrow = [row for row in rows if row["load"] == "hertz"]
    return narrow if len(narrow) >= len(wide) else wide


def _cut(row):
    """What the holes take from k: mean, and largest at a phase."""
    return "" if row is None else f"{100 * float(row['mean change']):+.3f} % ({100 * float(row['largest change']):+.3f} %)"


def _pits_said():
    """How far k with holes is from k with lost contact, in a sentence."""
    rows = _main_holes()
    mean = max(abs(float(row["mean change"])) for row in rows)
    most = max(rows, key=lambda row: abs(float(row["largest change"])))
    doubt = np.nanmin([float(row["estimate"]) for row in load(SCENE) if row["method"] == "fe3d"])
    where, than = f"{most['pair']}, {most['case']}, {most['pits']}", "less" if mean < doubt else "more"
    return (
        f"Cutting the pits out takes at most {100 * mean:.3f} % of the mean and {-100 * float(most['largest change']):.3f} %\n"
        f"at a phase ({where}), {than} than the smallest estimate of the mesh ({100 * doubt:.2f} %)."
    )


def _error(value):
    """In percent, bold beyond 3 %."""
    return f"{100 * value:+.2f} %" if abs(value) < 0.03 else f"**{100 * value:+.1f} %**"


def drop_table():
    """Reductions as Markdown: largest over the cycle, of the mean, and of the damaged tooth's own pair, by method."""
    rows = [row for row in load(SCENE) if row["case"] != "healthy"]
    methods = list(dict.fromkeys(row["method"] for row in rows))
    printed = next(one for one in gf.load_scene(SCENE).references if one.id == "stiffness_reduction")
    printed = {(row.case, row.pair): row.value for row in printed.rows}
    head = " | ".join(f"`{name}` largest | mean | tooth" for name in methods)
    lines = [f"| pair | case | printed | {head} |", "|---" * (3 + 3 * len(methods)) + "|"]
    for pair, case in dict.fromkeys((row["pair"], row["case"]) for row in rows):
        own = {row["method"]: row for row in rows if (row["pair"], row["case"]) == (pair, case)}
        columns = ("largest drop", "drop of mean", "drop of the damaged tooth")
        cells = [f"{100 * float(own[name][column]):.1f}" for name in methods for column in columns]
        lines.append(f"| {pair} | {case} | {printed[case, pair]:.2f} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def seconds_table():
    """Seconds by method and pair, as Markdown."""
    rows = load(SCENE)
    lines = ["| method | pair | seconds of five conditions |", "|---|---|---|"]
    for method, pair in dict.fromkeys((row["method"], row["pair"]) for row in rows):
        total = sum(float(row["seconds"]) for row in rows if (row["method"], row["pair"]) == (method, pair))
        lines.append(f"| `{method}` | {pair} | {total:.1f} |")
    return "\n".join(lines)


def picture(path):
    """Draw the sensitivities."""
    rows = load(f"{SCENE}_sensitivity")
    columns = list(dict.fromkeys((row["pair"], row["case"]) for row in rows))
    names = list(dict.fromkeys(row["variation"] for row in rows))
    errors = {}
    for method in SUMS:
        by = {(r["variation"], r["pair"], r["case"]): float(r[f"{method} [N/m]"]) / float(r["ritz3d [N/m]"]) - 1 for r in rows}
        errors[f"`{method}` against ritz3d"] = np.array([[by[name, *column] for column in columns] for name in names])
    plot_errors(errors, names, [f"{pair.replace('_', '-')} {case}" for pair, case in columns], path)


def moved_table():
    """What a variation does to the healthy stiffness, as Markdown."""
    rows = [row for row in load(f"{SCENE}_sensitivity") if row["case"] == "healthy"]
    k = {(row["variation"], row["pair"]): float(row["ritz3d [N/m]"]) for row in rows}
    names, pairs = (list(dict.fromkeys(key[i] for key in k)) for i in (0, 1))
    lines = [f"| variation | {' | '.join(pairs)} |", "|---" * (1 + len(pairs)) + "|"]
    for name in names[1:]:
        change = [100 * (k[name, pair] / k[names[0], pair] - 1) for pair in pairs]
        if max(map(abs, change)) > 0.01:
            lines.append(f"| {name} | " + " | ".join(f"{one:+.1f} %" for one in change) + " |")
    return "\n".join(lines)


def readings_table():
    """Markdown: `published` with the foundation of both gears, as S4 prints it, and without the ring's, against FE."""
    truth = {(r["pair"], r["case"]): float(r["mean [N/m]"]) for r in load(SCENE) if r["method"] == "fe3d"}
    found = {(r["pair"], r["case"], r["foundation"]): float(r["mean [N/m]"]) for r in load(f"{SCENE}_foundation")}
    lines = ["| pair | case | as printed | no foundation of the ring |", "|---|---|---|---|"]
    for (pair, case), k in truth.items():
        cells = [f"{100 * (found[pair, case, name] / k - 1):+.1f} %" for name in ("printed", "external")]
        lines.append(f"| {pair} | {case} | {' | '.join(cells)} |")
    return "\n".join(lines)


def page():
    """Text of `herringbone.md`."""
    ours = found()
    references = [one for one in gf.load_scene(SCENE).references if one.id in ours]
    own = [row for row in load(SCENE) if row["method"] == "ritz3d"]
    worst = {name: 100 * max(abs(float(row[name])) for row in own) for name in own[0] if "error" in name}
    return PAGE.format(
        readings=readings_table(),
        errors=error_table(pits=True),
        pits=_pits_said(),
        spread=SPREADS[_main_holes()[0]["load"]],
        mean=worst["error of mean"],
        largest=worst["error of max"],
        phase=worst["largest error at a phase"],
        section=said(load(f"{SCENE}_section")),
        seconds=seconds_table(),
        machine=load(f"{SCENE}_run")[0]["machine"],
        drops=drop_table(),
        moved=moved_table(),
        printed=text(references, [row for one in references for row in judge(one, ours[one.id])]),
    )
