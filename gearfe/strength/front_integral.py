"""Stress intensities along the front of a crack in a solid, from its displacements: the interaction integral.

At each point of the front, axis 1 points ahead of it in the crack's plane, axis 2 is normal to that plane, axis 3 is tangential::

    K = E' / 2 int (s_ij w_i,1 + t_ij u_i,1 - t_kl e_kl delta_1j) q,j dV / int q ds      (K_III: mu instead of E' / 2)

Here u, s, e are the computed displacement, stress and strain. w and t are displacement and stress of the singular field of the
mode with K = 1 in plane strain. The weight q decreases from 1 at half the radius of a tube around the front to 0 at the tube,
and to 0 at the adjacent points of the front. The singular fields rotate with the front. The error by its curvature grows with
the radius of the tube, so K is extrapolated linearly from two tubes to radius 0. A parabola through three tubes would need one
of a quarter of the radius, where the elements have errors of percents, and would multiply these by 8 / 3.
"""

import numpy as np
from scipy.interpolate import CubicSpline

from ..flexibility.finite_elements.hexahedron import gauss, shapes, slopes_at
from ..flexibility.tip import singular

BLOCK = 400  # number of elements per block
PARTS = 6  # straight segments of the curve between two points of the front
TUBES = np.array([0.5, 1.0])  # tube radii relative to the wider tube
TO_ZERO = np.linalg.inv(np.vander(TUBES, increasing=True))[0]


def front_intensity(points, cells, moved, material, front, ahead, normal, radius):
    """Compute K_I, K_II and K_III at places of a crack front ``(3, k)`` [MPa sqrt(mm)].

    `points` and `moved` ``(3, n)`` are nodes and displacements [mm]. `cells` ``(20, m)`` are hexahedra, see
    `geometry.mesh.solid.Solid`; the crack's faces have separate nodes. `front` ``(k, 3)`` are places along the front [mm], k > 1.
    K is a mean weighted by a hat function from the previous to the next point. `ahead`, `normal` ``(k, 3)`` are unit vectors
    there: in the crack's plane ahead of the crack, and normal to that plane. `radius` is that of the widest tube [mm].
    It must not reach other boundaries, and six rings of elements should lie within half of it.

    References
    ----------
    J. F. Yau, S. S. Wang, H. T. Corten, J. Appl. Mech. 47 (1980) 335-341; F. Z. Li, C. F. Shih, A. Needleman, Eng. Fract.
    Mech. 21 (1985) 405-421 (domain along a front).
    """
    curve = _curve(front, ahead, normal)
    places, _, away, _ = _local(points, *curve)
    used = np.flatnonzero((away[cells] < radius).any(axis=0))
    if used.size == 0:
        raise ValueError(f"radius = {radius:g} mm: no element lies that close to the front; give a larger one")
    falls = np.clip(2 - 2 * away / (radius * TUBES[:, None]), 0.0, 1.0)
    q = TO_ZERO @ falls * np.array([np.interp(places / PARTS, np.arange(len(front)), row) for row in np.eye(len(front))])
    local, weight = gauss(3)
    value, slope = shapes(local)
    total = np.zeros((3, len(front)))
    for start in range(0, used.size, BLOCK):
        block = cells[:, used[start : start + BLOCK]]
        grads, size = slopes_at(points[:, block], slope)
        x = np.einsum("dnm,nq->dmq", points[:, block], value)
        du = np.einsum("inm,mnjq->ijmq", moved[:, block], grads)
        dq = np.einsum("knm,mnjq->kjmq", q[:, block], grads)
        _, frame, r, angle = _local(x.reshape(3, -1), *curve)
        turn = frame.reshape(3, 3, *size.shape)  # rows: axes 1, 2, 3
        du = np.einsum("aimq,ijmq,bjmq->abmq", turn, du, turn)
        dq = np.einsum("bjmq,kjmq->kbmq", turn, dq)
        flows = _flows(du, r.reshape(size.shape), angle.reshape(size.shape), material)
        total += np.einsum("fbmq,kbmq,mq->fk", flows, dq, size * weight, optimize=True)
    lengths = np.linalg.norm(np.diff(curve[0], axis=0), axis=1).reshape(-1, PARTS).sum(axis=1)
    ends = np.concatenate([[0.0], lengths]) + np.concatenate([lengths, [0.0]])
    factor = np.array([material.plane_modulus("plane strain") / 2] * 2 + [material.shear_modulus])
    return factor[:, None] * total / (ends / 2)


def _flows(du, r, angle, material):
    """Return the vectors that are multiplied by the gradient of q in the integral, for the three modes ``(3, 3, ...)``."""
    lam, mu = material.lame("plane strain")
    stress = mu * (du + du.swapaxes(0, 1))
    for d in range(3):
        stress[d, d] += lam * (du[0, 0] + du[1, 1] + du[2, 2])
    root = np.sqrt(2 * np.pi * r)
    out = []
    for mode in (1, 2, 3):
        aux_stress, aux_slope = np.zeros(du.shape), np.zeros(du.shape[1:])
        if mode == 3:
            aux_slope[2] = -np.sin(angle / 2) / (mu * root)
            aux_stress[0, 2] = aux_stress[2, 0] = -np.sin(angle / 2) / root
            aux_stress[1, 2] = aux_stress[2, 1] = np.cos(angle / 2) / root
        else:
            aux_stress[:2, :2], aux_slope[:2] = singular(mode, r, angle, material, "plane strain")
            aux_stress[2, 2] = material.nu * (aux_stress[0, 0] + aux_stress[1, 1])
        flow = np.einsum("ij...,i...->j...", stress, aux_slope) + np.einsum("ij...,i...->j...", aux_stress, du[:, 0])
        flow[0] -= np.einsum("ij...,ij...->...", aux_stress, du)
        out.append(flow)
    return np.array(out)


def _curve(front, ahead, normal):
    """Return front and axes, with each interval between points divided into `PARTS` pieces."""
    at = np.arange(PARTS * (len(front) - 1) + 1) / PARTS
    return [CubicSpline(np.arange(len(front)), values)(at) for values in (front, ahead, normal)]


def _local(points, front, ahead, normal):
    """Return the nearest place on the front (point numbers and fractions), its axes ``(3, 3, n)``, distance and angle."""
    away = np.full(points.shape[1], np.inf)
    place = np.zeros(points.shape[1])
    for k, (start, stop) in enumerate(zip(front[:-1], front[1:], strict=True)):
        arm = stop - start
        part = np.clip(arm @ (points - start[:, None]) / (arm @ arm), 0.0, 1.0)
        distance = np.linalg.norm(points - start[:, None] - arm[:, None] * part, axis=0)
        nearer = distance < away
        away[nearer], place[nearer] = distance[nearer], k + part[nearer]
    low = np.minimum(place.astype(int), len(front) - 2)
    part = place - low

    def at(values):
        return ((1 - part)[:, None] * values[low] + part[:, None] * values[low + 1]).T

    first, second = at(ahead), at(normal)
    first = first / np.linalg.norm(first, axis=0)
    second = second - (first * second).sum(axis=0) * first
    second = second / np.linalg.norm(second, axis=0)
    arm = points - at(front)
    x, y = (arm * first).sum(axis=0), (arm * second).sum(axis=0)
    axes = np.array([first, second, np.cross(first.T, second.T).T])
    return place, axes, np.hypot(x, y), np.arctan2(y, x)
