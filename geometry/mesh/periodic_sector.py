"""Pitch sector of a gear in curved second-order triangles with equal sides, for a gear of z equal sectors."""

import math
from dataclasses import dataclass

import numpy as np
from skfem import MeshTri2

from ..damage.crack import check_sector, meshed_path, start_arc
from ..tooth.gear import Gear
from ..tooth.profile import cartesian, lengths
from .outline import along, bare, doubled, half, spaced, stations
from .section_mesh import CRACK_EDGE, fill

# longest edges [m_n]: flanks, fillets, root and tip, sides; `RIM` is the number of edges per pitch on a ring's held circle
FLANK, FILLET, COARSE, SIDE = 0.2, 0.12, 0.4, 0.4
RIM = 24
SIDES = ("loaded", "unloaded")  # right and left flank
GROWTH = 0.5  # growth of the edge length per length, away from the rim of a ring


@dataclass(frozen=True, slots=True)
class PeriodicSector:
    """Sector from half a pitch before the tooth's centre-line to half a pitch after it.

    `left` and `right` are the vertices of the sides from the held edge to the root, at the same radii. `held` are those of the
    held edge from left to right, both corners included. `flank` are those of the two flanks, right and left, from root to tip,
    `roll` their roll lengths [mm]. `seams` are the nodes of the faces of its cracks, see
    `gearfe.geometry.mesh.section_mesh.Seam`.
    """

    gear: Gear
    mesh: MeshTri2
    left: np.ndarray
    right: np.ndarray
    held: np.ndarray
    flank: tuple
    roll: np.ndarray
    seams: tuple = ()


def periodic_sector(gear, cracks=(), *, missing=False, refine=1.0):
    """Mesh one pitch sector of a gear. The factor `refine` divides the edge lengths.

    `cracks` ``(Crack, ...)`` belong to its tooth, whatever their tooth number. Each side has at most one. The sides and the
    held edge of the sector do not depend on them. The sector of a `missing` tooth has the root circle and no flanks.
    ValueError if a crack is too short, leaves the sector, or shares its side with another.
    """
    unit = gear.m_n / refine
    lines, marks = {}, {}
    for crack in cracks:
        if crack.side in lines:
            raise ValueError(f"two cracks on the {crack.side} side of tooth {crack.tooth}: give one to each side of a tooth")
        corners = meshed_path(gear, crack)
        if crack.path is not None:
            check_sector(gear, crack)
        length = lengths(corners)[-1]
        tip = min(CRACK_EDGE * FILLET * unit, length / 5)
        marks[crack.side] = start_arc(gear, crack), min(FILLET * unit, length / 4)
        lines[crack.side] = along(corners, marks[crack.side][1], tip, FILLET * unit)[:, 1:]
    roll = np.zeros(0) if missing else stations(gear, FLANK * unit)
    right, left = (
        bare(gear, FILLET * unit) if missing else half(gear, roll, FILLET * unit, COARSE * unit, mark=marks.get(side))
        for side in SIDES
    )
    parts = _parts(gear, right, left, refine)
    r, a = (np.concatenate([part[k][:-1] for part in parts]) for k in (0, 1))
    first = np.cumsum([0, *(part[0].size - 1 for part in parts)]) // 2
    starts = {"loaded": (first[2], right, 1), "unloaded": (first[2], left, -1)}
    chains = [(int(top + sense * one.mark), lines[side]) for side, (top, one, sense) in starts.items() if side in lines]
    mesh, faces = fill(cartesian(r, a), np.zeros((2, 0)), chains)
    below, _, _, beyond, held = ((np.arange(first[k], first[k + 1] + 1)) % first[-1] for k in range(5))
    flanks = (first[2] + right.flank)[::-1], (first[2] - left.flank)[::-1]
    return PeriodicSector(gear, mesh, below, beyond[::-1], held[::-1], flanks, roll, tuple(faces))


def _parts(gear, right, left, refine):
    """Return the outline clockwise from the lower left corner: radii and angles, each part without its last point."""
    unit, pitch = gear.m_n / refine, math.pi / gear.z
    thick = abs(gear.r_f - gear.held)
    cells = math.ceil((RIM if gear.internal else 2) * refine)
    fine = 2 * pitch * gear.held / cells
    away = spaced(0.0, thick, SIDE * unit, [(0.0, 0.0, fine), (thick, thick, COARSE * unit)], 1, GROWTH)
    side = doubled(gear.held - away if gear.internal else gear.held + away)
    side[-1] = gear.r_f
    held = np.linspace(pitch, -pitch, 2 * cells + 1)
    (r_1, a_1), (r_2, a_2) = ((np.append(one.radius, gear.r_f), np.append(one.angle, pitch)) for one in (right, left))
    return [
        (side, np.full(side.size, -pitch)),
        (r_2[::-1], -a_2[::-1]),
        (r_1, a_1),
        (side[::-1], np.full(side.size, pitch)),
        (np.full(held.size, gear.held), held),
    ]
