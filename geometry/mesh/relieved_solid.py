"""A gear of finite width with modified flanks: nodes move about the gear's axis, as far as material is removed at their place."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ..tooth.gear import Gear
from ..tooth.modified import FlankForm


def relieved_points(points: NDArray[np.float64], gear: Gear, form: FlankForm, teeth: Iterable[int]) -> NDArray[np.float64]:
    """Nodes of a gear in its own frame with the loaded flanks of some teeth modified.

    As in `geometry.mesh.relieved.relieved`, section by section: each node of such a tooth turns by ``C / r_b``, C the material
    removed at its radius and height, all of it on the loaded flank, nothing on the other.

    Parameters
    ----------
    points : ndarray, shape (3, n)
        [mm]; z from the end face at 0.
    gear : Gear
        Its `beta` says how the sections turn with z.
    form : FlankForm
    teeth : iterable of int
        Their numbers in the gear's own frame.

    Returns
    -------
    ndarray, shape (3, n)
    """
    out = points.copy()
    x, y, z = points
    radius = np.hypot(x, y)
    least, most = sorted((gear.roll_f, gear.roll_a))
    for tooth in teeth:
        centre = 2 * np.pi * tooth / gear.z + gear.twist_rate * z
        angle = (np.arctan2(x, y) - centre + np.pi) % (2 * np.pi) - np.pi
        inside = np.flatnonzero((np.abs(angle) < np.pi / gear.z) & (gear.outward * (radius - gear.r_f) > 0))
        r, form_at_z = radius[inside], form.at(z[inside])
        roll = np.sqrt(np.maximum(r**2 - gear.r_b**2, 0.0))
        removed = form_at_z.removed(np.clip(roll, least, most)) + form_at_z.shift(np.full(inside.size, tooth))
        inner = gear.outward * (r - gear.r_form) < 0
        half = np.array([gear.half_thickness(node_radius) for node_radius in np.where(inner, gear.r_form, r).tolist()])
        across = np.clip(angle[inside] / half, -1.0, 1.0)
        across = across if form.flank.both_sides else (across + 1) / 2
        fade = np.clip((r - gear.r_f) / (gear.r_form - gear.r_f), 0.0, 1.0)
        turned = angle[inside] + centre[inside] - across * fade * removed / gear.r_b
        out[:2, inside] = r * np.array([np.sin(turned), np.cos(turned)])
    return out
