"""A part of the page `map`: closed forms on known pairs, why their errors are what they are, what each ingredient changes."""

import numpy as np

from ..shared import reference
from ..shared.kept_rows import kept
from ..shared.ladder import ladder


def section(again=False):
    """Lines of the page."""
    tables = reference.load()
    pairs = tables["healthy"]["rows"]
    study, trend, rungs = (
        kept("map", name, lambda job=job: {"lines": job(tables)}, again)["lines"] for name, job in JOBS.items()
    )
    return [
        """
        ## Below 3 % is a coincidence of load and zone

        Lowest to highest error of four external pairs (19/48, 25/30, 18/27, 21/31 at 200, 150, 127 and 150 N/mm), in percent
        of `fe`, beside an earlier study: against finite elements of five teeth on a plain rim, as that study had, and of the
        whole gear; no contact beyond the path of contact.

        | formulation | zone | earlier study | five teeth | whole gear | verdict |
        |---|---|---|---|---|---|
        """,
        *study,
        """
        The textbook is near the truth with one pair in contact because two errors cancel: its teeth are too soft, its linear
        contact far too stiff. With two pairs its teeth share nothing and it is a fifth to a third too stiff. As the contact
        stiffens with load and the textbook's does not, its error moves with the load; the 62/62 pair at the pitch point:

        | N/mm | source | here, composed as there | against `fe` |
        |---|---|---|---|
        """,
        *trend,
        """
        The source composes its truth from teeth by finite elements at their centre-line and Weber's formula for what lies
        above; that is 1.5 % stiffer than the whole contact by finite elements, whence the difference of the last two columns.

        ## What each ingredient changes

        Error of the rung in the single / double zone and in the mean, for the same pairs.
        """,
        "",
        "| rung | " + " | ".join("{}/{}".format(*row["z"]) for row in pairs) + " |",
        "|---" * (len(pairs) + 1) + "|",
        *rungs,
        "",
        "`coupled`, the last rung, has nothing fitted, but its root arc (the feet of the fillet, as Sainsot's, not the 30-degree",
        "section) was chosen with these four pairs in view; on others it is less good: see the map above.",
    ]


def _study(tables):
    lines = []
    for row in tables["formulations"]["rows"]:
        few, whole = reference.formulation(row, teeth=5), reference.formulation(row)
        for zone, as_there, errors in zip(("single", "double"), few, whole, strict=True):
            low, high = row[zone]
            off = np.abs([as_there.min() - low, as_there.max() - high]).max()
            verdict = "reproduced" if off <= tables["formulations"]["tolerance"] else "**not reproduced**"
            cells = [f"{v.min():+.1f} ... {v.max():+.1f}" for v in (as_there, errors)]
            lines.append(
                f"| {row['name']} | {zone} | {low:+g} ... {high:+g} | {' | '.join(cells)} | {verdict}: {off:.1f} points off |"
            )
    return lines


def _trend(tables):
    lines = []
    for row in tables["load_trend"]["rows"]:
        composed, whole = reference.load_trend(row["line_load"])
        lines.append(f"| {row['line_load']:g} | {row['value']:+.1f} % | {composed:+.1f} % | {whole:+.1f} % |")
    return lines


def _ladders(tables):
    found, lines = [], []
    for row in tables["healthy"]["rows"]:
        pair, steel = reference.healthy_pair(row)
        found.append(ladder(pair, row["line_load"], steel))
    for k, rung in enumerate(found[0][:-1]):
        cells = []
        for rungs in found:
            single, double, mean, _ = rungs[k].error(rungs[-1])
            cells.append(f"{100 * single:+.1f} / {100 * double:+.1f}, {100 * mean:+.1f}")
        lines.append(f"| {rung.name} | " + " | ".join(cells) + " |")
    return lines


JOBS = {"earlier study": _study, "load": _trend, "rungs": _ladders}  # rows of the table
