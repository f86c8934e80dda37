"""Parts of the page on the error table of article S4, written from stored tables."""

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
DROPS = ("largest drop", "drop of mean")
TEXT = """
## The ten rows

One tooth of the sun (case1 to case4) or of the planet (planet1 to planet4) has a crack and pits. k is the secant stiffness along
the transverse line of action, over the mesh cycle with the damaged tooth in the middle of its engagement.

| case | 1 | 2 | 3 | 4 |
|---|---|---|---|---|
| root crack [%] | 10 | 30 | 60 | 30 |
| pits | 3 | 7 | 7 | 14 |

- FE: 20-node hexahedra of the whole gears (`fe3d`), with pits as lost contact. The ring pair has no estimate, because another
  mesh is too coarse for the load patches or exceeds 24 GB.
- Errors are relative to FE. Bold errors exceed 3 %.
- `ritz3d` is the converged energy model. `herringbone_article` and `textbook` are closed forms in exact slices. For the ring,
  `herringbone_article` has S4's foundation, and `textbook` has none.
- Pits cut out: mean additional loss of k if the pits are holes ([holes.md](holes.md)).

{errors}

`ritz3d` is within {mean:.2f} % of FE in all ten means, {largest:.2f} % in all ten maxima and {phase:.2f} % at every phase. No
constant of `ritz3d` is fitted to a gear. Most of the difference is due to the coarse section of the hexahedra. The energy
model gives its excess stiffness: {section}. The rest is due to the layers along the width. Smaller pairs with a ring, on finer
meshes, are within 0.25 % ([three.md](three.md)).

`fe3d` and `ritz3d` share the contact lines, the half-space under each line and the loaded patches of the flanks. Both keep
the faces of a crack apart.

## Loss of stiffness by damage

The table gives the largest loss over the cycle in percent. In brackets: loss of the mean.
[tables/herringbone.csv](tables/herringbone.csv) also has the loss of the damaged tooth's own pair.

{drops}

[assumptions.md](assumptions.md) and [herringbone_readings.md](herringbone_readings.md) have the effects of other values.
"""
PRINTED = """
## As printed, and after the stated corrections

{printed}
"""


def said(rows):
    """State in one sentence the increase of k by the refined section of the hexahedra.

    The numbers were computed once, together with the hexahedra, in commit 7e0439a.
    """
    parts = (
        f"{row['pair'].replace('_', '-')} {100 * float(row['mean']):+.2f} % on average ({100 * float(row['least']):+.2f} to "
        f"{100 * float(row['most']):+.2f} %)"
        for row in rows
    )
    return "; ".join(parts)


def load(name):
    """Return the rows of a table as dicts of text."""
    return rows_of(TABLES / f"{name}.csv")


def found():
    """Return computed values by reference id, each a dict by (case, pair)."""
    rows = load(SCENE)
    reference = "fe3d"

    def values(method, column, factor=1.0):
        return {(r["case"], r["pair"]): factor * float(r[column]) for r in rows if r["method"] == method}

    means = values("herringbone_article", "mean [N/m]"), values(reference, "mean [N/m]")
    return printed_beside(gf.load_scene(SCENE), *means, values(reference, "largest drop", 100.0))


def error_table(*, pits=False):
    """Return ten rows as Markdown: finite elements, and errors of mean and maximum over the cycle by every method.

    With `pits`, the change of k by cutting the pits out is added.
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
        lines.append(f"| {pair if case == 'healthy' else ''} | {case} | " + " | ".join([*numbers, *cells]) + " |")
    return "\n".join(lines)


def _by_method(rows):
    """Return ((pair, case), rows by method) of all pairs and cases."""
    for key in dict.fromkeys((row["pair"], row["case"]) for row in rows):
        yield key, {row["method"]: row for row in rows if (row["pair"], row["case"]) == key}


def _error(value):
    """Return an error in percent, in bold type above 3 %."""
    return f"{100 * value:+.2f} %" if abs(value) < 0.03 else f"**{100 * value:+.1f} %**"


def drop_table():
    """Return reductions as Markdown, by method: largest over the cycle, and of the mean in brackets."""
    rows = [row for row in load(SCENE) if row["case"] != "healthy"]
    methods = list(dict.fromkeys(row["method"] for row in rows))
    printed = next(one for one in gf.load_scene(SCENE).references if one.id == "stiffness_reduction")
    printed = {(row.case, row.pair): row.value for row in printed.rows}
    head = " | ".join(f"`{name}`" for name in methods)
    lines, above = [f"| pair | case | printed | {head} |", "|---" * (3 + len(methods)) + "|"], ""
    for (pair, case), own in _by_method(rows):
        cells = ["{:.1f} ({:.1f})".format(*(100 * float(own[name][word]) for word in DROPS)) for name in methods]
        lines.append(f"| {'' if pair == above else pair} | {case} | {printed[case, pair]:.2f} | " + " | ".join(cells) + " |")
        above = pair
    return "\n".join(lines)


def beyond():
    """Return in how many of the ten rows the mean by `herringbone_article` differs by more than 3 % from finite elements."""
    return sum(abs(float(row["error of mean"])) >= 0.03 for row in load(SCENE) if row["method"] == "herringbone_article")


def ten_rows():
    """Return the Markdown lines of the section on the ten rows of article S4."""
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
    """Return the references of S4's table of stiffness, and rows with their verdicts."""
    ours = found()
    references = [one for one in gf.load_scene(SCENE).references if one.id in ours]
    return references, [row for one in references for row in judge(one, ours[one.id])]


def as_printed():
    """Return lines with every number of the table of S4 and its verdict."""
    return PRINTED.format(printed=text(*judged())).strip().splitlines()
