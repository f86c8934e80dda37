"""Crack of the live page after growth along its computed path."""

from functools import lru_cache
from typing import Any

import numpy as np

from ..geometry.damage.crack import crack_path
from ..scene.load import scene_of
from ..strength.growth import grow_crack, single_crack
from .damage import CASE

SAME = 1e-6  # corners at a smaller distance are one [mm]
GIVEN = ("length_mm", "level", "angle_deg", "turning")  # keys of a straight crack


def grown_tables(tables: dict[str, Any], by: float) -> dict[str, Any]:
    """Return the tables of a one-pair scene whose crack has grown by a length [mm], at most to the end of its path.

    Raises
    ------
    ValueError
        If the damage is no single crack through the width of a spur gear.
    """
    found = single_crack(scene_of("page", tables).pair().case(CASE))
    if found is None:
        raise ValueError(f"a crack that has grown by {by:g} mm must be the only damage: leave out the other damage")
    corners = _path(scene_of("page", tables).pair().case(), *found)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
    reach = min(along[max(len(found[1].path or ()) - 1, 0)] + by, along[-1])
    end = [np.interp(reach, along, values) for values in corners.T]
    path = np.vstack([corners[along < reach - SAME], end])
    crack = {key: value for key, value in tables["crack"][0].items() if key not in GIVEN} | {"path_mm": path.ravel().tolist()}
    return tables | {"crack": [crack]}


@lru_cache(maxsize=8)
def _path(case, side, crack):
    """Return the corners ``(n, 2)`` of the whole path of growth, starting at the tip of the given crack [mm]."""
    grown = grow_crack(case, crack, side).cracks[-1]
    if grown.path:
        return np.array(grown.path)
    gear = case.pair.gears[side == "wheel"]
    return crack_path(gear, crack).T[-1:]
