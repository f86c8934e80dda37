"""Crack faces of a planetary set under the loads of its meshes: their opening, and the flexibility that they add."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from ..contact.unknowns import OVERLAP
from ..geometry.aliases import Floats
from .case import planet_name
from .cracked import CrackOpenings
from .whole_gear import PLACES


class CrackContacts(NamedTuple):
    """Openings of all cracks of a set (e of them) at a position under n contact loads.

    `more` ``(n, n)`` is the flexibility of the contacts added by free faces. `by_loads` ``(e, n)`` are the openings of
    free faces under unit loads, `ease` ``(e, e)`` those under unit forces on the faces. See `CrackOpenings` for `touch` ``(e,)``.
    `ring` are the openings of the ring's cracks.
    """

    more: Floats
    by_loads: Floats
    ease: Floats
    touch: NDArray[np.bool_]
    ring: slice

    def overlap(self, opened: Floats) -> bool:
        """Return True if crack faces that may touch overlap."""
        own = opened[self.touch]
        return bool(own.min(initial=0.0) < -OVERLAP * np.abs(own).max(initial=0.0))


def crack_contacts(
    cracked: dict[Any, CrackOpenings], blocks: list[Any], n: int, lugs: int, *, apart: bool
) -> CrackContacts | None:
    """Return the `CrackContacts` of the `cracked` gears in the meshes `blocks`, or None without cracks.

    The last `lugs` of the n loads are those of the ring's lugs. With `apart`, cracks have no effect between meshes.
    """
    rows, stiffness, ring = [], [], slice(0)
    touch: list[NDArray[np.bool_]] = []
    for name, faces in cracked.items():
        loaded = [(one, *way) for one in blocks if (way := _loads_on(one, name))]
        for group in [[one] for one in loaded] if apart else [loaded]:
            row = np.zeros((faces.touch.size, n))
            for one, which, flank in group:
                teeth = one.teeth[which] % faces.by_teeth.shape[1]
                row[:, one.at] = faces.by_teeth[:, teeth, flank].reshape(faces.touch.size, -1) @ one.spread[which].T
            if name == "ring":
                ring = slice(start := sum(part.size for part in touch), start + faces.touch.size)
                if lugs:
                    row[:, -lugs:] = faces.pads.T
            rows.append(row)
            stiffness.append(faces.stiffness)
            touch.append(faces.touch)
    if not rows:
        return None
    ease, by_openings = np.linalg.inv(block_diag(*stiffness)), np.vstack(rows)
    ease = (ease + ease.T) / 2
    by_loads = ease @ by_openings
    return CrackContacts(by_openings.T @ by_loads, by_loads, ease, np.concatenate(touch), ring)


def _loads_on(block, name):
    """Return the side of a gear in a mesh (0 pinion, 1 wheel) and the loads of its flank, or None outside the mesh."""
    if name == "sun":
        return None if block.inner else (0, slice(PLACES))
    if name == "ring":
        return (1, slice(PLACES)) if block.inner else None
    if name != planet_name(block.planet):
        return None
    return (0, slice(PLACES, None)) if block.inner else (1, slice(PLACES))
