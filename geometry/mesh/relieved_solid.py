"""A gear of finite width with modified flanks: nodes move about the gear's axis, as far as material is removed at their place."""

from collections.abc import Iterable

import numpy as np

from ..aliases import Floats
from ..tooth.gear import Gear
from ..tooth.modified import FlankForm
from .relieved import bend


def relieved_points(points: Floats, gear: Gear, form: FlankForm, teeth: Iterable[int]) -> Floats:
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
    out, z = points.copy(), points[2]
    for tooth in teeth:

        def removed(roll, inside, tooth=tooth):
            own = form.at(z[inside])
            return own.removed(roll) + own.shift(np.full(roll.size, tooth))

        bend(out, gear, 2 * np.pi * tooth / gear.z + gear.twist_rate * z, removed, form.flank.both_sides)
    return out
