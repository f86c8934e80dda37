"""Stress intensity factors at a crack tip in the polynomial triangles of a sector, from two additional load vectors."""

from dataclasses import dataclass

import numpy as np

from ....geometry.aliases import Floats
from ....geometry.mesh.triangle import lobatto, table
from ...flamant import traction
from ...plane_elements import stiffness
from ...tip import face_factor, tip_rows

RING = 0.4  # radius of the ring relative to the distance to the nearest boundary or kink, which excludes bent triangles
ROOTS = 12  # points on an edge of a crack face, distributed by the square root of the distance to the tip


@dataclass(frozen=True, slots=True)
class Tip:
    """Tip of the crack of a sector: axes `turn` (2, 2), place (2,) [mm], and q at the vertices of the sector (n,)."""

    turn: Floats
    place: Floats
    q: Floats


def tip_of(sector):
    """Return the `Tip` of the only crack of a `Sector`, with q of the largest ring within which the crack is straight."""
    (faces,) = sector.faces
    line = sector.points[:, faces[0]]
    ahead = line[:, -1] - line[:, -2]
    ahead = ahead / np.hypot(*ahead)
    turn = np.array([ahead, [-ahead[1], ahead[0]]])
    place = turn @ (sector.points - line[:, -1:])
    distance = np.hypot(*place)
    off = np.abs(place[1, faces[0]]) > 1e-6 * distance[faces[0]].max()
    straight = distance[faces[0]][int(off.nonzero()[0].max(initial=-1)) + 1]
    rim = np.unique([edge for edge in sector.bulge])
    rim = rim[~np.isin(rim, faces)]
    reach = RING * min(straight, distance[rim].min())
    return Tip(turn, line[:, -1], np.clip(2 - 2 * distance / reach, 0.0, 1.0))


def tip_columns(sector, tip, numbers, order, material, state):
    """Return the forces of both load vectors on the unknowns: unknowns, columns 0 and 1, forces."""
    q = tip.q[sector.triangles]
    used = np.flatnonzero((q.max(axis=0) > 0) & (q.min(axis=0) < 1))
    corners = sector.points[:, sector.triangles[:, used]]
    basis = table(order)
    arms = np.einsum("dcm,ce->mde", corners, basis.corner_slope)
    back = np.linalg.inv(arms)  # derivatives of the reference coordinates by x and y
    grads = np.einsum("ad,med,enq->namq", tip.turn, back, basis.slope)
    slope = np.einsum("ad,med,ce,cm->am", tip.turn, back, basis.corner_slope, q[:, used])[:, :, None]
    place = np.einsum("ad,dcm,cq->amq", tip.turn, corners - tip.place[:, None, None], basis.corner)
    area = np.abs(np.linalg.det(arms))[:, None] * basis.weight
    rows = tip_rows(grads, place, np.broadcast_to(slope, place.shape), area, material, state)
    rows = np.einsum("knam,ad->mknd", rows, tip.turn).reshape(used.size, 2, -1)
    local = stiffness(basis.slope, basis.weight, arms, *material.lame(state))
    kept = 2 * (basis.count - basis.inside)
    if basis.inside:
        inner = np.linalg.solve(local[:, kept:, kept:], local[:, kept:, :kept])
        rows = rows[:, :, :kept] - rows[:, :, kept:] @ inner
    unknowns = (2 * numbers[:, used].T[:, :, None] + np.arange(2)).reshape(used.size, 1, -1)
    columns = np.broadcast_to(np.arange(2)[:, None], rows.shape)
    return np.broadcast_to(unknowns, rows.shape).ravel(), columns.ravel(), rows.ravel()


def face_columns(sector, tip, order):
    """Second integral ``(2, k)`` for unit forces that push apart facing nodes of the crack."""
    line = sector.points[:, sector.faces[0][0]]
    part = (lobatto(order)[:-1] + 1) / 2
    places = (line[:, :-1, None] * (1 - part) + line[:, 1:, None] * part).reshape(2, -1)
    q = tip.q[sector.faces[0][0]]
    away = np.hypot(*(places - tip.place[:, None]))
    return np.array([face_factor(away, (q[:-1, None] * (1 - part) + q[1:, None] * part).ravel()), np.zeros(away.size)])


def load_columns(sector, tip, where, inward, tip_side):
    """Second integral ``(2, n)`` for the face tractions that cancel those of the singular fields of n loads."""
    chain = sector.faces[0][0]
    away, q = np.hypot(*(sector.points[:, chain] - tip.place[:, None])), tip.q[chain]
    edges = np.flatnonzero(q[1:] > 0)
    gauss, weight = np.polynomial.legendre.leggauss(ROOTS)
    far, near = np.sqrt(away[:-1][edges, None]), np.sqrt(away[1:][edges, None])
    root = (near + far) / 2 + (far - near) / 2 * gauss
    distance = root**2
    value = q[1:][edges, None] + (q[:-1] - q[1:])[edges, None] * (distance - near**2) / (far**2 - near**2)
    factor = face_factor(distance, value) * (far - near) / 2 * weight * 2 * root
    points = tip.place[:, None] - tip.turn[0][:, None] * distance.ravel()
    normal = np.broadcast_to(tip.turn[1][:, None], points.shape)
    spread = traction(points, normal, where, inward, tip_side)
    return np.einsum("ad,dlp,p->al", tip.turn[::-1], spread, factor.ravel())
