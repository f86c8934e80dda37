"""Cracks and missing teeth of a gear: their effect on all its teeth, and the contact of crack faces.

A gear with all faces held together is the healthy gear. Openings d of the faces act on it as forces on the sides of the cracked
sectors. Let v be the unknowns of all sectors, K the healthy block-circulant stiffness, and E that of the cracked sectors. With
loads f of the teeth and forces r that push the faces apart::

    K v = B f - E K_vd d,    r = S d - Q f,    S = K_dd - K_vd' E' K^-1 E K_vd,    u = C f + Q' d

The healthy gear, solved once, and one solve for each opening therefore give any cracked gear exactly. C is the healthy
flexibility. Open faces have r = 0. Faces in contact press along their normal and slide without friction.

A missing tooth changes the stiffness of its sector by ``W s W'``, s = 1 or -1 by column, from the eigenvectors of the change.
With d = -s W' v it has the form of open faces: E K_vd = -W, K_dd = -s. The identity is that of Woodbury.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from ..geometry.aliases import Floats
from ..geometry.damage.crack import Crack
from ..geometry.damage.missing import missing_teeth
from ..geometry.mesh.periodic_sector import periodic_sector
from .whole_gear import PLACES, WholeGear, in_chain, sector_stiffness

NEGLIGIBLE = 1e-9  # Smaller changes of a sector's stiffness, relative to the largest, are omitted.


class CrackedTooth(NamedTuple):
    """Openings (e of them) between the faces of the cracks of a tooth: normal components, then components along the faces.

    A missing tooth has e modes of its change instead (see the module), which are never in contact. `sides` ``(N, e)`` are the
    forces by unit openings on the N unknowns of the sector and of the next side. `faces` ``(e, e)`` are those on the faces.
    `loads` ``(e, 2 PLACES)`` is the work of unit loads on the tooth per unit opening. `touch` marks the openings that
    must not be negative. `side` are the indices of one side among the unknowns of a sector.
    """

    tooth: int
    side: NDArray[np.int64]
    sides: Floats
    faces: Floats
    loads: Floats
    touch: NDArray[np.bool_]


class CrackOpenings(NamedTuple):
    """All crack openings of a gear (e of them), for a given support of its held edge.

    `stiffness` ``(e, e)`` is the matrix S of the module, and `by_teeth` ``(e, z, 2 PLACES)`` is Q. `touch` ``(e,)`` marks
    openings that must not be negative. `edge` ``(z, r, e)`` are displacements of the held edge by unit openings. For a ring on
    p pads, `pads` ``(p, e)`` are the displacements of the pads, and `released` ``(e, z, PLACES)`` is the part of Q that the
    support adds.
    """

    stiffness: Floats
    by_teeth: Floats
    touch: NDArray[np.bool_]
    edge: Floats
    pads: Floats
    released: Floats


def cracked_teeth(whole: WholeGear, damage: Any, refine: float) -> tuple[CrackedTooth, ...]:
    """Return the `CrackedTooth` by tooth from cracks and missing teeth. Teeth are counted clockwise.

    Chips are left out: tips without load hardly change the deflection of other teeth.
    """
    cracks = [one for one in damage if isinstance(one, Crack)]
    own, next_, side = in_chain(periodic_sector(whole.gear, refine=refine))
    order = np.concatenate([own, next_])
    out = []
    for tooth in sorted({crack.tooth % whole.gear.z for crack in cracks}):
        sector = periodic_sector(whole.gear, [one for one in cracks if one.tooth % whole.gear.z == tooth], refine=refine)
        pairs, normal, touch = _pairs(sector.mesh, sector.seams)
        matrix, load, _ = sector_stiffness(sector, whole.material, pairs)
        sides, faces, loads = _opened(matrix, load, normal, order)
        out.append(CrackedTooth(tooth, side, sides, faces, loads, touch))
    if gone := missing_teeth(whole.gear, damage):
        sectors = (periodic_sector(whole.gear, missing=missing, refine=refine) for missing in (True, False))
        without, drawn = (sector_stiffness(sector, whole.material)[0][np.ix_(order, order)] for sector in sectors)
        change, modes = np.linalg.eigh(without - drawn)
        strong = np.abs(change) > NEGLIGIBLE * np.abs(change).max()
        sides, signs = -modes[:, strong] * np.sqrt(np.abs(change[strong])), np.sign(change[strong])
        rest = np.diag(-signs), np.zeros((signs.size, 2 * PLACES)), np.zeros(signs.size, dtype=bool)
        out += [CrackedTooth(tooth, side, sides, *rest) for tooth in gone]
    return tuple(out)


def _pairs(mesh, seams):
    """Return facing nodes ``(2, m)`` of all cracks without tips, normals ``(2, m)``, and which openings ``(2 m,)`` may touch.

    The pair next to a tip lies at a quarter of its edge and is omitted, see `gearfe.flexibility.finite_elements.fe`.
    """
    pairs = np.hstack([faces[:, :-1] for faces in seams])
    ahead = np.hstack([np.gradient(mesh.doflocs[:, faces[0]], axis=1)[:, :-1] for faces in seams])
    touch = np.concatenate([np.arange(faces.shape[1] - 1) < faces.shape[1] - 2 for faces in seams])
    return pairs, np.array([-ahead[1], ahead[0]]) / np.hypot(*ahead), np.append(touch, np.zeros(touch.size, dtype=bool))


def _opened(matrix, load, normal, order):
    """Compute `sides`, `faces` and `loads` of a `CrackedTooth` from the result of `sector_stiffness` with facing nodes.

    One face moves by u, and the other by u minus the openings. The unknown u is eliminated.
    """
    m, n = normal.shape[1], order.size
    x, y, k = 2 * np.arange(m), 2 * np.arange(m) + 1, np.arange(m)
    apart = np.zeros((2 * m, 2 * m))
    apart[x, k], apart[y, k] = normal
    apart[x, m + k], apart[y, m + k] = -normal[1], normal[0]
    to = block_diag(np.eye(n), np.vstack([np.eye(2 * m)] * 2))
    to = np.hstack([to, np.vstack([np.zeros((n + 2 * m, 2 * m)), -apart])])
    total, forces = to.T @ matrix @ to, to.T @ load
    gone, kept = np.arange(n, n + 2 * m), np.append(order, np.arange(n + 2 * m, n + 4 * m))
    through = np.linalg.solve(total[np.ix_(gone, gone)], np.hstack([total[gone][:, kept], forces[gone]]))
    rest = np.hstack([total[np.ix_(kept, kept)], forces[kept]]) - total[np.ix_(kept, gone)] @ through
    return rest[:n, n : n + 2 * m], rest[n:, n : n + 2 * m], rest[n:, n + 2 * m :]


def faces_of(whole: WholeGear, teeth: tuple[CrackedTooth, ...], inverse: NDArray[np.complex128]) -> CrackOpenings:
    """Return `CrackOpenings` from the inverses ``(h, n, n)`` of the healthy gear's harmonics with the support of its edge."""
    z, n = whole.gear.z, whole.stiffness.shape[1]
    ends = np.cumsum([0, *(one.faces.shape[0] for one in teeth)])
    parts = [slice(a, b) for a, b in zip(ends[:-1], ends[1:], strict=True)]
    force = np.zeros((z, n, ends[-1]))
    for one, at in zip(teeth, parts, strict=True):
        force[one.tooth, :, at] -= one.sides[:n]
        force[(one.tooth + 1) % z, one.side, at] -= one.sides[n:]
    waves = inverse @ np.fft.rfft(force, axis=0)
    moved = np.fft.irfft(waves, n=z, axis=0)
    by_teeth = np.fft.irfft(np.conj(whole.push.mT) @ waves, n=z, axis=0).transpose(2, 0, 1)
    stiffness = block_diag(*(one.faces for one in teeth))
    for one, at in zip(teeth, parts, strict=True):
        stiffness[at] += one.sides[:n].T @ moved[one.tooth] + one.sides[n:].T @ moved[(one.tooth + 1) % z, one.side]
        by_teeth[at, one.tooth] += one.loads
    touch = np.concatenate([one.touch for one in teeth])
    none = np.zeros((0, ends[-1])), np.zeros((ends[-1], z, PLACES))
    return CrackOpenings((stiffness + stiffness.T) / 2, by_teeth, touch, moved[:, : whole.edge], *none)
