"""Estimated increase of the deflection of a flank by the material that pits, spalls and chips remove.

Contact lines end at the walls of a recess. At a chip of a part of the width they continue at its corner, nearer the root. A wall
is treated as a free end face, at which the mirror image of every load is added (`gearfe.flexibility.end_faces`), but only down to
the depth h of the recess. A load at a distance R from an image adds::

    psi k (1 / R - 1 / sqrt(R**2 + 4 h**2))

with the half-space's k and the weight psi of an end face. The second term is an assumption: it is the field of the image at the
depth 2 h, and the sum vanishes with h. In finite elements of ten layouts of recesses and in CalculiX the loss is smaller than
this estimate (``tests/contact/test_missing_material.py``).
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..flexibility.end_faces import edge_factor
from ..flexibility.halfspace import half_space
from ..geometry.aliases import Floats

JUMP = 0.2  # step of the roll length along a line at the end of a chip [m_n]
APART = 1e-9  # gap relative to the cell width beyond which a recess lies between two cells


def missing_material(case: Any, found: Any) -> Floats:
    """Return the estimated error of k of a `Contact3D` whose pits remove no material from its bodies ``(phases,)`` [N/m].

    The modelled teeth are too stiff. The error follows from virtual work under the solved loads. It is an upper estimate,
    because the loads would be redistributed.
    """
    out = np.zeros(found.k.size)
    for pits, material, sense in zip(case.pits, case.materials, (1, -1), strict=True):
        gear = case.pair.gear_1 if sense > 0 else case.pair.gear_2
        depths: dict[int, float] = {}
        for pit in pits:
            depths[pit.tooth % gear.z] = max(pit.depth, depths.get(pit.tooth % gear.z, 0.0))
        kernel = edge_factor(material) * half_space(material)
        for i, cells in enumerate(found.cells if depths else ()):
            height = gear.outward * (cells.roll_1 if sense > 0 else cells.roll_2) / (JUMP * gear.m_n)
            work = sum(
                _work(cells, (cells.order == order) & (cells.half == half), depth, height) / math.cos(case.pair.gear_1.beta_b)
                for order, half in sorted(set(zip(cells.order.tolist(), cells.half.tolist(), strict=True)))
                if (depth := depths.get(sense * order % gear.z))
            )
            out[i] += kernel * work / cells.load.sum()
    closing = found.approach - (0.0 if found.unloaded is None else found.unloaded)
    return found.k * out / (closing * math.cos(case.pair.gear_1.beta_b))


def _work(cells: Any, on: NDArray[np.bool_], depth: float, height: Floats) -> float:
    """Return the sum of load products divided by image distances [N**2/mm] for one contact line.

    Images are mirror images of cells at the walls of recesses, and at steps of more than 1 in `height`.
    """
    first, last, load = cells.depth - cells.width / 2, cells.depth + cells.width / 2, np.where(cells.floor > 0, 0.0, cells.load)
    at = np.flatnonzero(on)
    at = at[np.argsort(cells.depth[at])]
    apart, step = first[at[1:]] - last[at[:-1]] > APART * cells.width[at[1:]], np.diff(height[at])
    apart |= np.diff(cells.floor[at]) != 0
    ends = np.flatnonzero(apart | (np.abs(step) > 1))
    runs, out = np.split(at, ends + 1), 0.0
    for run, following, cut, rise in zip(runs[:-1], runs[1:], apart[ends].tolist(), step[ends].tolist(), strict=True):
        for own, wall, high in ((run, last[run[-1]], rise < 0), (following, first[following[0]], rise > 0)):
            away = np.abs(cells.depth[own] - wall)
            image = np.add.outer(away, away)
            out += float(load[own] @ (1 / image - 1 / np.hypot(image, 2 * depth)) @ load[own]) if cut or high else 0.0
    return out
