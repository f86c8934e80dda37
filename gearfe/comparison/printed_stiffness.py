"""Printed stiffnesses of a scene's source, for healthy and damaged gears, compared with a `Comparison`."""

from ..scene.verdicts import judge, text
from .losses import LARGEST


def printed_beside(scene, published, reference, drops):
    """Return the computed values for the stiffnesses that the source of a scene prints, by reference id, for `judge`.

    `published`, `reference` and `drops` are dictionaries by (case, pair), with the case "healthy" for undamaged gears.
    `published` is the mean stiffness [N/m] by the source's own formulas (`herringbone_article`), `reference` that by the
    reference method, and `drops` the largest loss of stiffness [%]. The printed errors are recomputed from the printed
    (corrected) stiffnesses. The result is empty if the source prints no stiffness.
    """
    ids = {"stiffness_analytical": published, "stiffness_fe": reference, "stiffness_reduction": drops}
    targets = {entry.id: {(row.case, row.pair): row.target for row in entry.rows} for entry in scene.references}
    if not all(name in targets for name in (*ids, "stiffness_error")):
        return {}
    analytical, by_fe = targets["stiffness_analytical"], targets["stiffness_fe"]
    return ids | {
        "stiffness_error": {key: round(100 * abs(analytical[key] - by_fe[key]) / analytical[key], 2) for key in analytical}
    }


def printed_cases(scene):
    """Return (pair, case) of the stiffnesses that the source of a scene prints for healthy and damaged gears."""
    rows = [row for reference in scene.references if reference.id == "stiffness_fe" for row in reference.rows]
    return [(row.pair, None if row.case == "healthy" else row.case) for row in rows]


def printed_text(scene, found):
    """Return the source's table of stiffness with the values of a `Comparison` and verdicts, as Markdown, or an empty text."""
    reference, rows = found.methods[0], list(found.rows())

    def by_case(method, zone, number, factor=1.0):
        chosen = (row for row in rows if (row.method, row.zone) == (method, zone))
        return {(row.case or "healthy", row.pair): factor * getattr(row, number) for row in chosen}

    means = (by_case(method, "mean", "k") for method in ("herringbone_article", reference))
    ours = printed_beside(scene, *means, by_case(reference, LARGEST, "loss", 100.0))
    printed = [entry for entry in scene.references if entry.id in ours]
    return text(printed, [row for entry in printed for row in judge(entry, ours[entry.id])]) if printed else ""
