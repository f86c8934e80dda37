"""Whole outlines of gears, without load and pressed together, beside gearfe: distributions and the ten worst phases."""

import numpy as np

from gearfe.files import written

from ..shared import outlines_plane, outlines_three
from ..shared.arbiter import kept, unloaded_table
from ..shared.arbiter.beside import beside
from ..shared.arbiter.cases import fresh
from ..shared.places import PAGES

__all__ = ["reference", "run"]

PAGE = PAGES / "outlines.md"
METHODS = ("ritz", "fe")
INTRODUCTION = """# Whole outlines pressed together

An arbiter that shares nothing of gearfe's contact geometry (`validation/shared/arbiter`): teeth cut by brute force, whole
outlines, finite elements of whole gears in plane strain of its own, contact between outline points with true gaps and normals.
Pairs are random, undercut ones, close and trimmed rings, rounded tips over-represented; phases are those where off-path pairs
come near. They were chosen before any was pressed. Its mesh error is the larger of two that three meshes tell.

What is left, in the ten worst phases of each method. Where a corner touches off the path close to a base circle (15/68, 9/57,
11/60, 10/32) the difference grows with the load: below 0.1 % at an eighth of it, without crack and modification 0.4 % at half
of it and 0.5 to 0.7 % at the whole, which is 90 to 200 N/mm for each millimetre of module; `ritz` is too soft at tip corners of
rings and too stiff at edges of undercut pinions. That the arbiter's outlines move along each other elastically is 0.1 % of it;
the rest is not explained, and may be either side's. On a tip in a fillet (13/45) the flexibility is that of the flank's end,
gone on straight. Where an arc at a tip begins on the flank (14/47), and where a pair off the path carries all of a light load
(12/17), it is not explained.

`python -m validation outlines` makes this page; `--reference` computes the gaps and presses the cases that are not on file.

"""

FRESH = """## Fresh pairs

Fourteen pairs of the same draw (`fresh` in `validation/shared/arbiter/cases.py`), on which nothing was tried: pressed and judged
once, after the last change above. Differences in per cent.

"""


def reference():
    """Compute what is not on file: gaps of random pairs, sections pressed by the arbiter, whole gears by CalculiX."""
    unloaded_table.reference()
    kept.reference()
    kept.reference(fresh(), kept.FRESH)
    outlines_plane.reference()
    outlines_three.reference()


def run():
    """Write the page."""
    parts = [INTRODUCTION, unloaded_table.section()]
    for method in METHODS:
        rows = [(row, found) for row, found in beside(method)]
        refused = sorted({f"{row['pair']}: {found['refused']}" for row, found in rows if "refused" in found})
        rows = [(row, found) for row, found in rows if "refused" not in found]
        off = np.array([abs(found["difference"]) for _, found in rows])
        corner = np.array([bool(row["places"]) for row, _ in rows])
        covered = np.array([abs(found["difference"]) <= found["estimate"] for _, found in rows])
        mesh = np.array([float(row["mesh_error_percent"]) for row, _ in rows])
        parts.append(
            f"## `{method}`\n\n{off.size} phases; estimate covers the difference in {100 * covered.mean():.1f} %. Mesh error of "
            f"the arbiter: median {np.median(mesh):.3f} %, largest {mesh.max():.3f} %.\n\n"
            "| difference [%] | phases | median | 90 % | 99 % | largest |\n|---|---|---|---|---|---|\n"
        )
        for name, some in (("no corner, joint or fillet pressed", off[~corner]), ("one of them pressed", off[corner])):
            spread = " | ".join(f"{value:.3f}" for value in np.quantile(some, [0.5, 0.9, 0.99, 1.0])) if some.size else "| | |"
            parts.append(f"| {name} | {some.size} | {spread} |\n")
        parts.append("\n| seed | pair | load [N/mm] | phase | k arbiter | mesh error % | difference % | estimate % | pressed |\n")
        parts.append("|---|---|---|---|---|---|---|---|---|\n")
        for i in np.argsort(-off)[:10]:
            row, found = rows[i]
            parts.append(
                f"| {row['seed']} | {row['pair']} {row['crack']} | {row['load_N_mm']} | {row['phase_48']}/48 | "
                f"{float(row['k_N_um_mm']):.3f} | {float(row['mesh_error_percent']):.3f} | {found['difference']:.3f} | "
                f"{found['estimate']:.3f} | {row['places']} |\n"
            )
        parts.append("\n" + "".join(f"Refused: {text}\n" for text in refused) + "\n")
    parts += [_fresh(), outlines_plane.section(), outlines_three.section()]
    with written(PAGE) as target, open(target, "w", encoding="utf-8") as file:
        file.write("".join(parts))
    print(f"wrote {PAGE.name}")


def _fresh():
    """The section of the pairs on which nothing was tried."""
    lines = [
        FRESH,
        "| method | phases | 50 % | 90 % | largest | at a corner: largest | estimate covers | refused |\n|---" + "|---" * 7,
    ]
    lines[-1] += "|\n"
    for method in METHODS:
        found = list(beside(method, given=fresh(), table=kept.FRESH))
        rows = [(row, one) for row, one in found if "refused" not in one]
        off, estimate = (np.array([abs(one[name]) for _, one in rows]) for name in ("difference", "estimate"))
        corner = np.array([bool(row["places"]) for row, _ in rows])
        cells = [f"{value:.3f}" for value in (*np.quantile(off, [0.5, 0.9, 1.0]), off[corner].max(initial=0.0))]
        cells += [f"{int((off <= estimate).sum())} of {off.size}", str(len(found) - len(rows))]
        lines.append(f"| `{method}` | {off.size} | {' | '.join(cells)} |\n")
    return "".join(lines) + "\n"
