"""Page `outlines`, written from its tables and from stiffnesses by gearfe."""

import numpy as np

from . import page
from .arbiter import kept
from .arbiter.beside import beside
from .arbiter.cases import fresh

METHODS = ("ritz", "fe")
INTRODUCTION = """
The independent reference (`validation/shared/arbiter`) shares nothing of gearfe's contact geometry. It generates teeth by
simulated cutting and has finite elements of complete gears in plane strain, and contact between outline points with true gaps and
normals. Its mesh error is the larger of two estimates from three meshes. Pairs are random. Undercut pairs, trimmed rings with few
more teeth than their pinion, and rounded tips are over-represented. Phases are those at which pairs off the path come near. All
were chosen before the reference was computed.

A corner touches off the path along the normal of the other gear's flank. This direction differs from its own involute normal by
several degrees. A modified flank is also inclined to its involute. Teeth deflect along and across their normal, with coupling.
These parts of the model were developed on the pairs of the tables. CalculiX confirms the reference on four of them
([outlines_calculix.md](outlines_calculix.md)). The fresh pairs are an independent test.

Remaining differences at corners:

- Where a ring's tip touches before the path (13/46 and 9/26 at 47/48), both methods are 0.3 to 0.4 % too stiff. The cause is
  unknown. The estimates of 0.7 to 1.0 % cover it.
- The flexibility is that of teeth without chamfers (14/47 2/48, 36/10 2 and 3/48: 0.3 to 0.5 % too stiff).
- In a fillet, the flexibility is extrapolated linearly from the end of the flank (11/63, 13/45).
- On 15/68 (12/48, -0.4 to -0.5 %) the tip of a cracked tooth carries load.
- On 9/16 (13/48) `fe` does not resolve the tip of a nearly pointed tooth. With `refine=2` its difference is 0.09 %.

Away from corners, heavy loads have the largest differences: 14/13 (26/48, 200 N/mm at a module of 1 mm) has -0.20 % with `ritz`,
and -0.08 % at a tenth of the load.

[outlines_unloaded.md](outlines_unloaded.md) has the gaps of 1000 unloaded pairs, and [outlines_three.md](outlines_three.md) has
undercut pairs in three dimensions.

`python -m validation outlines` writes this page. With `--reference`, it also computes the reference.

"""

FRESH = """## Fresh pairs

Fourteen further pairs of the same draw (`fresh` in `validation/shared/arbiter/cases.py`) were not used during development. They
were computed once, after the last change of the model. Differences are in percent.

"""


def _largest(row, found):
    """Return a line of the table of the largest differences."""
    return (
        f"| {row['seed']} | {row['pair']} {row['crack']} | {row['load_N_mm']} | {row['phase_48']}/48 | "
        f"{float(row['k_N_um_mm']):.3f} | {float(row['mesh_error_percent']):.3f} | {found['difference']:.3f} | "
        f"{found['estimate']:.3f} | {row['places']} |\n"
    )


def write():
    """Write the page."""
    parts, answers = [INTRODUCTION], []
    for method in METHODS:
        rows = list(beside(method))
        refused = sorted({f"{row['pair']}: {found['refused']}" for row, found in rows if "refused" in found})
        rows = [(row, found) for row, found in rows if "refused" not in found]
        off = np.array([abs(found["difference"]) for _, found in rows])
        corner = np.array([bool(row["places"]) for row, _ in rows])
        covered = np.array([abs(found["difference"]) <= found["estimate"] for _, found in rows])
        mesh = np.array([float(row["mesh_error_percent"]) for row, _ in rows])
        parts.append(
            f"## `{method}`\n\nThe estimate covers the difference in {100 * covered.mean():.1f} % of {off.size} phases. The "
            "mesh error "
            f"of the reference is {np.median(mesh):.3f} % in the median and {mesh.max():.3f} % at most.\n\n"
            "| difference [%] | phases | median | 90 % | 99 % | largest |\n|---|---|---|---|---|---|\n"
        )
        answers.append(f"`{method}` by {np.median(off):.2f} % of k in the median and {off.max():.1f} % at most")
        for name, some in (("no corner, joint or fillet pressed", off[~corner]), ("one of them pressed", off[corner])):
            spread = " | ".join(f"{value:.3f}" for value in np.quantile(some, [0.5, 0.9, 0.99, 1.0])) if some.size else "| | |"
            parts.append(f"| {name} | {some.size} | {spread} |\n")
        parts.append(
            "\n| seed | pair | load [N/mm] | phase | k reference | mesh error % | difference % | estimate % | pressed |\n"
        )
        parts.append("|---|---|---|---|---|---|---|---|---|\n")
        parts += [_largest(*rows[i]) for i in np.argsort(-off)[:10]]
        parts.append("\n" + "".join(f"Refused: {text}\n" for text in refused) + "\n")
    parts.append(_fresh())
    answer = (
        f"An independent reference with complete tooth outlines differs from {' and from '.join(answers)}. The comparison has "
        f"{off.size} phases at which tooth pairs off the path come near."
    )
    page.write("outlines", answer, "".join(parts))


def _fresh():
    """Return the section on pairs that were not used during development."""
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
