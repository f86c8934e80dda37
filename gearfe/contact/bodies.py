"""The elastic bodies behind the contact lines: both gears, or their halves, and the flexibility between the cells on them.

Heights count from the end that touches first: the pinion's roll length falls with them, so its beta is negative. The wheel's, in
its own frame, is the opposite one; also a ring's, whose frame is mirrored.
"""

from dataclasses import replace

import numpy as np
from scipy.linalg import block_diag

from geometry.damage.crack import check_single, crack_in_band

from ..steps import steps


def seen_gears(pair, face, groove):
    """Pinion and wheel, or a half of each, and where contact begins on them: ``[(Gear, offset [mm]), ...]``."""
    out = []
    common = min(pair.gear_1.b, pair.gear_2.b)
    for gear, sense in ((pair.gear_1, -1), (pair.gear_2, 1)):
        width = (gear.b - groove) / 2 if face == "herringbone" else gear.b
        out.append((replace(gear, beta=sense * abs(gear.beta), b=width), (gear.b - common) / 2))
    return out


def seen_cracks(gear, cracks, seen, band):
    """Cracks of a gear in the body `seen` over a band (first, last), heights counted from its first end."""
    first, inwards = (0.0, 1.0) if band[0] < band[1] else (gear.b, -1.0)
    found = (crack_in_band(crack, gear.b, first, first + inwards * seen.b) for crack in cracks)
    return tuple(crack for crack in found if crack is not None)


def bodies_of(pair, materials, cracks, bands, face, groove, flexible, shafts=(None, None)):
    """Flexibilities of both gears in each band: ``[[(Flexibility3D, offset [mm]), ...], ...]``.

    Parameters
    ----------
    pair : GearPair
    materials : (Material, Material)
    cracks : (tuple, tuple)
        Of pinion and wheel.
    bands : list of (float, float)
        See `geometry.pair.lines.bands_of`.
    face, groove
        As in `gearfe.contact.solid.pair_stiffness3d`.
    flexible : callable
        ``flexible(gear, material, cracks)`` gives a `Flexibility3D`.
    shafts : (Shaft or None, Shaft or None)
        Of gears that are one piece with them: ``flexible`` gets them as ``shaft``, seen from the end that touches first.

    Raises
    ------
    ValueError
        If a crack lies in the relief groove, or a body has two on one side of a tooth.
    """
    gears = list(zip((pair.gear_1, pair.gear_2), seen_gears(pair, face, groove), materials, cracks, shafts, strict=True))
    for gear, (body, _), _, own, _ in gears:
        for crack in own:
            if not any(seen_cracks(gear, [crack], body, band) for band in bands):
                raise ValueError(f"crack open from z = {crack.width} mm: no tooth is there, but the groove of {groove:g} mm")
        for band in bands:
            check_single(body, seen_cracks(gear, own, body, band))
    return [
        [
            (flexible(body, material, seen_cracks(gear, own, body, band), **_as_seen(shaft, band)), offset)
            for gear, (body, offset), material, own, shaft in steps(gears)
        ]
        for band in steps(bands)
    ]


def _as_seen(shaft, band):
    return {} if shaft is None else {"shaft": shaft if band[0] < band[1] else shaft.turned()}


def between(cells, bodies):
    """Approach ``(n, n)`` of `Cells` per unit normal force on each, half-space left out [mm/N]."""
    out = np.zeros((cells.z.size,) * 2)
    for half in np.unique(cells.half):
        at = np.flatnonzero(cells.half == half)
        for (body, offset), sense, roll in zip(bodies[half], (1, -1), (cells.roll_1, cells.roll_2), strict=True):
            out[np.ix_(at, at)] += body.matrix(sense * cells.order[at], roll[at], cells.depth[at] + offset)
    return (out + out.T) / 2


def faces_of(cells, bodies):
    """Faces of the cracks of all bodies, as `cell_sharing.line_cells` takes them; None without cracks.

    Returns
    -------
    (ndarray (m, n), ndarray (m, m), ndarray (m,)) or None
        Opening under unit normal forces on the cells, and of unit forces that push the faces apart [mm/N], and the half.
    """
    rows, own, halves = [], [], []
    for half in np.unique(cells.half).tolist():
        at = np.flatnonzero(cells.half == half)
        for (body, offset), sense, roll in zip(bodies[half], (1, -1), (cells.roll_1, cells.roll_2), strict=True):
            if body.seam is not None and body.seam.influence.size:
                row = np.zeros((body.seam.influence.shape[0], cells.z.size))
                row[:, at] = body.opening(sense * cells.order[at], roll[at], cells.depth[at] + offset)
                rows.append(row)
                own.append(body.seam.influence)
                halves.append(np.full(row.shape[0], half))
    return (np.concatenate(rows), block_diag(*own), np.concatenate(halves)) if rows else None
