"""Flexibility of a ring's teeth with its support: held at all points, an elastic bed, or pads of some width.

A ring on pads is a free ring under the tractions p of its pads, with a motion q as a whole::

    u_teeth = C f + B' p + R q,    u_pads = B f + A p + R_p q = -p / k,    R' f + R_p' p = 0

The addition by pads to the flexibility of the free ring is a small matrix, and one solve of the ring serves all layouts. The rim
moves with the pad below it. Tractions are Chebyshev polynomials over ``sqrt(1 - s**2)``, with the singularity at both ends of a
rigid punch. On the mesh of the rim they are distributed over several edges. The additional local effect is that on a half-plane,
which is known exactly.

References
----------
K. L. Johnson, Contact Mechanics, 1985, sec. 2.8 (tractions under a rigid punch).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry.aliases import Floats
from ..geometry.tooth.profile import turned
from .cracked import CrackedTooth, CrackOpenings, faces_of
from .pads import Pads, among, by_teeth, pads_on
from .rim_supports import RimBed, RimSupports, check_support
from .whole_gear import PLACES, WholeGear, between_teeth, motion

SURE = 1e-9  # A smaller singular value, relative to the largest, indicates a rigid-body motion of the ring.


NONE_2, NONE_3 = np.zeros((0, 0)), np.zeros((0, 0, 0))  # empty arrays of a ring without pads


class Rim(NamedTuple):
    """Flexibility of a ring's teeth with its support, per mm of width (z teeth, `PLACES` loads on each right flank).

    `more` ``(z, PLACES, z, PLACES)`` is added to the flexibility with the rim held. For p tractions of pads, `reaction` ``(p,
    z, PLACES)`` are the tractions per load. `moves` ``(3, z, PLACES)`` are rigid motions of the ring per load: along x, along
    y [mm], clockwise rotation [rad]. The l unilateral lugs are separate contacts. `lug` ``(l, l)`` and `across` ``(l, z,
    PLACES)`` are their flexibilities. `turns` ``(3, l)`` and `gives` ``(3, z, PLACES)`` are the displacements of lugs and
    loads by rigid motions of the ring. `grip` ``(p + 3, p)`` are the tractions of the pads and the motions of the ring by unit
    displacements of the pads.
    """

    whole: WholeGear
    more: Floats
    pads: Pads | None = None
    reaction: NDArray = NONE_3
    moves: NDArray = NONE_3
    lug: NDArray = NONE_2
    across: NDArray = NONE_3
    turns: NDArray = NONE_2
    gives: NDArray = NONE_3
    grip: NDArray = NONE_2


def ring_on(whole: WholeGear, support: "str | RimBed | RimSupports", width: float) -> Rim:
    """Return the `Rim` of a ring on its support. The face `width` [mm] shares the stiffness of pads.

    ValueError for the reasons of `check_support`, or if the ring could move without force.
    """
    gear = whole.gear
    check_support(support, gear)
    if isinstance(support, RimBed):
        return Rim(whole, between_teeth(whole.between(whole.bedded_inverse(_springs(support))) - whole.held()))
    if not isinstance(support, RimSupports):
        return Rim(whole, np.zeros((gear.z, PLACES) * 2))
    loose = whole.loose_inverse()
    pads = pads_on(whole, support, width, whole.moved(loose))
    more = whole.between(loose) - whole.held()
    teeth, across, between = between_teeth(more), by_teeth(pads), among(pads) + pads.compliance
    gives = _moves(gear)
    if support.pushes:
        return Rim(whole, teeth, pads, lug=between, across=across, turns=pads.turns, gives=gives)
    p, n = pads.compliance.shape[0], gear.z * PLACES
    scale = np.diag(between).mean()
    unit = scale * np.array([1.0, 1.0, 1 / gear.held])[:, None]  # Scaling gives all entries of the system one magnitude.
    system = np.block([[between, (unit * pads.turns).T], [unit * pads.turns, np.zeros((3, 3))]])
    if np.linalg.svd(unit * pads.turns, compute_uv=False)[-1] < SURE * scale:
        raise ValueError("ring: it moves freely on these pads: give more pads, or support both directions")
    right = np.concatenate([across.reshape(p, n), unit * gives.reshape(3, n)])
    solved = -np.linalg.solve(system, np.hstack([right, np.eye(p + 3, p)]))
    more = teeth.reshape(n, n) + right.T @ solved[:, :n]
    solved[p:] *= unit
    shape = gear.z, PLACES
    return Rim(
        whole, ((more + more.T) / 2).reshape(*shape, *shape), pads, solved[:p, :n].reshape(p, *shape),
        solved[p:, :n].reshape(3, *shape), grip=solved[:, n:],
    )  # fmt: skip


def _springs(bed):
    return np.array([bed.radial, bed.tangential])


def ring_faces(rim: Rim, support: "str | RimBed | RimSupports", teeth: tuple[CrackedTooth, ...]) -> CrackOpenings:
    """Return the `CrackOpenings` of a ring's cracks on its support. Lugs belong to the contact problem."""
    whole = rim.whole
    held = faces_of(whole, teeth, whole.held_inverse())
    if isinstance(support, RimBed):
        found = faces_of(whole, teeth, whole.bedded_inverse(_springs(support)))
    elif rim.pads is None:
        return held
    else:
        found = faces_of(whole, teeth, whole.loose_inverse())
        moved = np.einsum("zrp,zre->pe", rim.pads.close, found.edge, optimize=True)
        by_teeth, stiffness = found.by_teeth[..., :PLACES], found.stiffness
        if rim.grip.size:  # pads that transmit tension and pressure
            pulled = rim.grip[: moved.shape[0]] @ moved
            by_teeth = by_teeth + np.einsum("pe,pta->eta", moved, rim.reaction)
            stiffness = stiffness - moved.T @ pulled
        found = found._replace(stiffness=stiffness, by_teeth=by_teeth, pads=moved)
    by_teeth = found.by_teeth[..., :PLACES]
    return found._replace(by_teeth=by_teeth, released=by_teeth - held.by_teeth[..., :PLACES])


def _moves(gear):
    """Return the displacement of loads ``(3, z, PLACES)`` for rigid motions of the ring: along x, along y, clockwise rotation."""
    x, y, turn = motion(gear)[:, :PLACES]
    angle = 2 * math.pi / gear.z * np.arange(gear.z)[:, None]
    return turned((x, y, np.broadcast_to(turn, (gear.z, PLACES))), angle)


def rim_moved(rim: Rim, loads: Floats, tractions: NDArray, whole: NDArray) -> Floats:
    """Return the displacements ``(nodes, 2)`` of the rim nodes of a ring on pads, outwards and clockwise [mm].

    `rim_angles` are the angles of the nodes. `loads` ``(z, PLACES)`` are the loads on the teeth, `tractions` ``(p,)`` those of
    the pads [N/mm]. `whole` ``(3,)`` is the rigid motion of the ring: along x and y [mm], clockwise rotation [rad].
    """
    assert rim.pads is not None
    gear, pads, r = rim.whole.gear, rim.pads, rim.whole.edge
    waves = np.einsum("hra,ha->hr", pads.moved[:, :, :PLACES], np.fft.rfft(loads, axis=0))
    waves += np.einsum("hrs,hs->hr", pads.moved[:, :, -r:], np.fft.rfft(pads.load @ tractions, axis=0))
    moved = np.fft.irfft(waves, n=gear.z, axis=0).reshape(-1, 2)
    angle = rim_angles(rim.whole)
    sin, cos = np.sin(angle), np.cos(angle)
    x, y, turn = whole
    return moved + np.column_stack([sin * x + cos * y, cos * x - sin * y + gear.held * turn])


def rim_angles(whole: WholeGear) -> Floats:
    """Angles of all nodes of the rim, clockwise from the centre-line of tooth 0 [rad]."""
    sectors = 2 * math.pi / whole.gear.z * np.arange(whole.gear.z)
    return (sectors[:, None] + whole.angle).ravel()
