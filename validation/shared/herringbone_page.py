"""Parts of the page of article S4's error table, from its tables alone."""

import math

import gearfe as gf
from gearfe.comparison.printed_stiffness import printed_beside
from gearfe.core.units import in_newton_per_um
from gearfe.scene.verdicts import judge, text

from .kept_rows import stored
from .places import TABLES
from .table_rows import rows_of

SCENE = "herringbone"
SUMS = ("herringbone_article", "textbook")
TEXT = """
## The ten rows

Sun-planet and planet-ring pair, healthy and with a root crack of 10, 30, 60, 30 % and 3, 7, 7, 14 pits on one tooth of the sun
(case1 to case4) or of the planet (planet1 to planet4). k is secant, along the transverse line of action, over the mesh cycle in
which the damaged tooth is in the middle of its engagement. What S4 does not print is an assumption of the scene
(`gearfe scenes`).

FE: 20-node hexahedra of the whole gears (`fe3d`), pits as lost contact; the estimate is of its mesh (of the ring pair a coarser
one cannot carry the patches and a finer one does not fit into 24 GB: none). Errors are against it; bold: beyond 3 %. `ritz3d`
is the converged energy model, `herringbone_article` and `textbook` closed forms in exact slices (of the ring
`herringbone_article` has the foundation that S4 prints, `textbook` none, since no usual formula is for a ring). Pits cut out:
what k loses beyond the lost contact of the same pits when they are holes, in the mean over the cycle, by a linear estimate
([holes.md](holes.md)).

{errors}

`ritz3d` is within {mean:.2f} % of the finite elements in all ten means, {largest:.2f} % in all ten maxima and {phase:.2f} %
at every phase; no constant of it is fitted to any gear. Most of this is the section of these hexahedra, which is coarser than
the default: what it lacks in plane strain against one of twice the default's resolution, put into the energy model's gears,
makes k stiffer by: {section}. The rest are the layers along the width; of the ring pair they are the coarsest that carry the
patches. Smaller pairs with a ring, on finer meshes, are within 0.25 % ([three.md](three.md)).

Shared by `fe3d` and `ritz3d`: the contact lines, the half-space under each and the patches that the flanks are loaded by. These
hexahedra were solved when `fe3d` did not yet keep the faces of a crack apart, as `ritz3d` does.

## What damage takes

In percent: largest over the cycle, of the mean over the cycle, and of the damaged tooth's own pair.

{drops}

What moves the healthy stiffness: [assumptions.md](assumptions.md), and [herringbone_readings.md](herringbone_readings.md).
"""
PRINTED = """
## As printed, and after the stated corrections

{printed}
"""


def said(rows):
    """By how much the section of the hexahedra on file stiffens k, in a sentence; computed once, with them, in commit 7e0439a."""
    parts = (
        f"{row['pair'].replace('_', '-')} {100 * float(row['mean']):+.2f} % in the mean ({100 * float(row['least']):+.2f} to "
        f"{100 * float(row['most']):+.2f} %)"
        for row in rows
    )
    return "; ".join(parts)


def load(name):
    """Rows of a table as dicts of text."""
    return rows_of(TABLES / f"{name}.csv")


def found():
    """Ours by the id of a reference, each a dict by (case, pair)."""
    rows = load(SCENE)
    reference = "fe3d"

    def values(method, column, factor=1.0):
        return {(r["case"], r["pair"]): factor * float(r[column]) for r in rows if r["method"] == method}

    means = values("herringbone_article", "mean [N/m]"), values(reference, "mean [N/m]")
    return printed_beside(gf.load_scene(SCENE), *means, values(reference, "largest drop", 100.0))


def error_table(*, pits=False):
    """Ten rows as Markdown: finite elements, and the errors of the mean and of the maximum over the cycle by every method.

    With `pits`: also what cutting them out does to k.
    """
    rows = load(SCENE)
    methods = [name for name in dict.fromkeys(row["method"] for row in rows) if name != "fe3d"]
    names = [*(["pits cut out"] if pits else []), *(f"`{name}` mean | max" for name in methods)]
    columns = 5 + pits + 2 * len(methods)
    lines = [f"| pair | case | FE mean [N/um] | max | estimate | {' | '.join(names)} |", "|---" * columns + "|"]
    holes = stored("holed_cracks")
    for (pair, case), own in _by_method(rows):
        truth = own["fe3d"]
        cells = [_error(float(own[name][f"error of {what}"])) for name in methods for what in ("mean", "max")]
        numbers = [in_newton_per_um(float(truth[name]), 5) for name in ("mean [N/m]", "max [N/m]")]
        doubt = float(truth["estimate"])
        numbers.append("none" if math.isnan(doubt) else f"± {100 * doubt:.2f} %")
        if pits:
            cut = holes.get(f"{pair}, {case}")
            numbers.append(f"{100 * cut['mean']:+.3f} %" if cut else "")
        lines.append(f"| {pair} | {case} | " + " | ".join([*numbers, *cells]) + " |")
    return "\n".join(lines)


def _by_method(rows):
    """((pair, case), rows by method) of all pairs and cases."""
    for key in dict.fromkeys((row["pair"], row["case"]) for row in rows):
        yield key, {row["method"]: row for row in rows if (row["pair"], row["case"]) == key}


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
    for (pair, case), own in _by_method(rows):
        columns = ("largest drop", "drop of mean", "drop of the damaged tooth")
        cells = [f"{100 * float(own[name][column]):.1f}" for name in methods for column in columns]
        lines.append(f"| {pair} | {case} | {printed[case, pair]:.2f} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def beyond():
    """In how many of the ten rows the mean of `herringbone_article` is beyond 3 % of finite elements in the scene as it is."""
    return sum(abs(float(row["error of mean"])) >= 0.03 for row in load(SCENE) if row["method"] == "herringbone_article")


def ten_rows():
    """Lines: the ten rows by every method."""
    own = [row for row in load(SCENE) if row["method"] == "ritz3d"]
    worst = {name: 100 * max(abs(float(row[name])) for row in own) for name in own[0] if "error" in name}
    made = TEXT.format(
        errors=error_table(pits=True),
        mean=worst["error of mean"],
        largest=worst["error of max"],
        phase=worst["largest error at a phase"],
        section=said(load(f"{SCENE}_section")),
        drops=drop_table(),
    )
    return made.strip().splitlines()


def judged():
    """References of S4's table of stiffness, and rows with their verdicts."""
    ours = found()
    references = [one for one in gf.load_scene(SCENE).references if one.id in ours]
    return references, [row for one in references for row in judge(one, ours[one.id])]


def as_printed():
    """Lines: every number of S4's table with its verdict."""
    return PRINTED.format(printed=text(*judged())).strip().splitlines()
