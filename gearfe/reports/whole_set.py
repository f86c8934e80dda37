"""The section of a report on the planetary set of its scene."""

from functools import partial
from typing import Any

from ..comparison.told_set import set_headline, set_table, spread, told_set, told_span
from ..planetary_sets.case import PlanetaryCase
from ..planetary_sets.curves import SetCurves
from ..planetary_sets.of_scene import build_set
from ..planetary_sets.shape import plot_planetary_set
from ..planetary_sets.solve import planetary_stiffness
from ..scene.load import Scene
from .template import picture_data

POSITIONS = 32


def find_set(scene: Scene, case: str | None) -> tuple[dict[str, SetCurves], list[str]]:
    """Return the curves of a scene's set at equal positions, healthy and damaged, and reasons for missing curves."""
    made: dict[str, PlanetaryCase] = {}
    notes = []
    for which in dict.fromkeys((case, None)):
        try:
            made[which or "healthy"] = build_set(scene, which)
        except ValueError as error:
            notes.append(f"the set is not shown {'healthy' if which is None else f'in case {which}'}: {error}")
    if not made:
        return {}, list(dict.fromkeys(notes))
    at = spread(next(iter(made.values())), POSITIONS)
    return {name: planetary_stiffness(one, at) for name, one in reversed(made.items())}, notes


def set_section(found: dict[str, SetCurves]) -> list[dict[str, Any]]:
    """Return the page data of a set: a sentence, a description, a `Table`, pictures."""
    out = []
    for name, curves in found.items():
        healthy = found.get("healthy") if name != "healthy" else None
        out.append({
            "loads": picture_data(partial(curves.plot, dpi=90), f"the loads, {name}"),
            "bent": picture_data(partial(plot_planetary_set, curves, 0, dpi=110), f"the bent set, {name}"),
            "case": name, "headline": set_headline(curves, healthy), "told": told_set(curves.meta["case"]),
            "span": told_span(curves.position), "table": set_table(curves),
        })  # fmt: skip
    return out
