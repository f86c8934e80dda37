"""Mesh of a gear of finite width with modified flanks. Nodes rotate about the gear's axis by the removed material."""

from collections.abc import Iterable

import numpy as np

from ..aliases import Floats
from ..tooth.gear import Gear
from ..tooth.modified import FlankForm
from .relieved import bend


def relieved_points(points: Floats, gear: Gear, form: FlankForm, teeth: Iterable[int]) -> Floats:
    """Return the nodes of a gear in its own frame with modified loaded flanks of some teeth.

    Like `geometry.mesh.relieved.relieved`, section by section: each node of such a tooth rotates by ``C / r_b``. C is the
    material removed at its radius and height, all of it on the loaded flank, nothing on the other.

    Parameters
    ----------
    points : ndarray, shape (3, n)
        Nodes [mm]; z from the end face at 0.
    gear : Gear
        Gear; its `beta` is the helix angle of the sections.
    form : FlankForm
    teeth : iterable of int
        Tooth numbers in the gear's own frame.

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
