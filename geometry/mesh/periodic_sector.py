"""One pitch sector of a gear in curved second-order triangles, its two sides alike, so that z of them make the gear exactly."""

import math
from dataclasses import dataclass

import numpy as np
from skfem import MeshTri2

from ..tooth.gear import Gear
from ..tooth.profile import cartesian
from .outline import doubled, half, spaced, stations
from .section_mesh import fill

# longest edges in modules: flanks, fillets, root and tip, sides; on the held circle of a ring as many to a pitch as `RIM`
FLANK, FILLET, COARSE, SIDE = 0.2, 0.12, 0.4, 0.4
RIM = 24
GROWTH = 0.5  # of the edge length per length, away from the rim of a ring


@dataclass(frozen=True, slots=True)
class PeriodicSector:
    """A sector from half a pitch before the tooth's centre-line to half a pitch after it.

    `left`, `right` are the vertices of the sides from the held edge to the root, at the same radii; `held` those of the held
    edge from left to right, both corners included; `flank` those of the two flanks, right and left, from root to tip, `roll`
    their roll lengths [mm].
    """

    gear: Gear
    mesh: MeshTri2
    left: np.ndarray
    right: np.ndarray
    held: np.ndarray
    flank: tuple
    roll: np.ndarray


def periodic_sector(gear, *, refine=1.0):
    """Mesh one pitch sector of a gear; `refine` divides the edge lengths."""
    unit, pitch = gear.m_n / refine, math.pi / gear.z
    roll = stations(gear, FLANK * unit)
    half_tooth = half(gear, roll, FILLET * unit, COARSE * unit)
    radius, angle = np.append(half_tooth.radius, gear.r_f), np.append(half_tooth.angle, pitch)
    thick = abs(gear.r_f - gear.held)
    cells = math.ceil((RIM if gear.internal else 2) * refine)
    fine = 2 * pitch * gear.held / cells
    away = spaced(0.0, thick, SIDE * unit, [(0.0, 0.0, fine), (thick, thick, COARSE * unit)], 1, GROWTH)
    side = doubled(gear.held - away if gear.internal else gear.held + away)
    side[-1] = gear.r_f
    held = np.linspace(pitch, -pitch, 2 * cells + 1)
    parts = [  # clockwise from the lower left corner, each without its last point
        (side, np.full(side.size, -pitch)),
        (radius[::-1], -angle[::-1]),
        (radius, angle),
        (side[::-1], np.full(side.size, pitch)),
        (np.full(held.size, gear.held), held),
    ]
    r, a = (np.concatenate([part[k][:-1] for part in parts]) for k in (0, 1))
    first = np.cumsum([0, *(part[0].size - 1 for part in parts)]) // 2
    mesh, _ = fill(cartesian(r, a), np.zeros((2, 0)))
    count = first[-1]
    left, _, _, right, below = ((np.arange(first[k], first[k + 1] + 1)) % count for k in range(5))
    up = half_tooth.flank  # from the tip to the form point, from the middle of the tip
    flanks = (first[2] + up)[::-1], (first[2] - up)[::-1]
    return PeriodicSector(gear, mesh, left, right[::-1], below[::-1], flanks, roll)
