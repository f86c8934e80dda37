"""Estimated increase of the deflection of a flank by the material that pits and spalls remove.

Contact lines end at the walls of a recess. A wall deflects as a free end face does, where every load acts once more from its
mirror image (`gearfe.flexibility.end_faces`), but down to the depth h of the recess only. A load at a distance R from an image
adds::

    psi k (1 / R - 1 / sqrt(R**2 + 4 h**2))

with the half-space's k and the weight psi of an end face. The second term is an assumption: it is the field of the image at the
depth 2 h, and the sum vanishes with h. Finite elements of ten layouts of recesses and CalculiX lose less than this estimate
(``tests/contact/test_missing_material.py``).
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..flexibility.end_faces import edge_factor
from ..flexibility.halfspace import half_space
from ..geometry.aliases import Floats

APART = 1e-9  # gap relative to the cell width beyond which a recess lies between two cells


def missing_material(case: Any, found: Any) -> Floats:
    """Return the estimated excess of k of a `Contact3D` whose recesses remove no material ``(phases,)`` [N/m].

    By virtual work under the solved loads. Load redistribution would reduce it.
    """
    out = np.zeros(found.k.size)
    for pits, material, sense in zip(case.pits, case.materials, (1, -1), strict=True):
        z = (case.pair.gear_1 if sense > 0 else case.pair.gear_2).z
        depths: dict[int, float] = {}
        for pit in pits:
            depths[pit.tooth % z] = max(pit.depth, depths.get(pit.tooth % z, 0.0))
        kernel = edge_factor(material) * half_space(material)
        for i, cells in enumerate(found.cells if depths else ()):
            work = sum(
                _work(cells, (cells.order == order) & (cells.half == half), depth) / math.cos(case.pair.gear_1.beta_b)
                for order, half in sorted(set(zip(cells.order.tolist(), cells.half.tolist(), strict=True)))
                if (depth := depths.get(sense * order % z))
            )
            out[i] += kernel * work / cells.load.sum()
    closing = found.approach - (0.0 if found.unloaded is None else found.unloaded)
    return found.k * out / (closing * math.cos(case.pair.gear_1.beta_b))


def _work(cells: Any, on: NDArray[np.bool_], depth: float) -> float:
    """Return the sum of load products over distances to the images in the walls of recesses [N**2/mm], for one line."""
    first, last, load = cells.depth - cells.width / 2, cells.depth + cells.width / 2, np.where(cells.floor > 0, 0.0, cells.load)
    at = np.flatnonzero(on)
    at = at[np.argsort(cells.depth[at])]
    new = (first[at[1:]] - last[at[:-1]] > APART * cells.width[at[1:]]) | (np.diff(cells.floor[at]) != 0)
    runs, out = np.split(at, np.flatnonzero(new) + 1), 0.0
    for number, run in enumerate(runs):
        for wall, inner in ((first[run[0]], number > 0), (last[run[-1]], number < len(runs) - 1)):
            away = np.abs(cells.depth[run] - wall)
            apart = np.add.outer(away, away)
            out += float(load[run] @ (1 / apart - 1 / np.hypot(apart, 2 * depth)) @ load[run]) if inner else 0.0
    return out
