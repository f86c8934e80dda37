"""Shifts of the vertices of a section along its crack, so that one mesh represents a crack front of variable depth.

The section with a crack open over the part f of its length is the section of the whole crack with all points moved by ``(f - 1)
shift``. Points on the crack move towards its mouth in proportion to their distance from it. The motion decreases with the
distance from the crack and is zero from `REACH` crack lengths on.
"""

import math

import numpy as np

from ..damage.front import LEAST, Front, shallowest

SPARE = 0.8  # The mesh must stay valid down to this multiple of the least resolved depth.
REACH = 1.2, 0.8  # distance from the crack within which vertices move [crack lengths], and its minimum [m_n]
STIFFER = 0.5  # Stiffness of a triangle is its area to the power -0.5, so that small triangles keep their shape.
# factor of the stiffness of triangles that zero crack depth would invert, and number of searches for such triangles
HARD, ROUNDS = 1000.0, 10


def follow(gear, crack, width, points, triangles, fixed, line, folds):
    """Return the shift ``(2, n)`` [mm] of a section's vertices that follows the front of a crack, and the followed `Front`.

    If the depth of the front decreases to zero, the mesh follows it down to the first value of `geometry.damage.front.LEAST`
    at which no element folds. Any other front is followed completely. RuntimeError if the mesh cannot follow. `width` is the
    face width [mm]. ``folds(points)`` returns True if the mesh folds with its vertices at points ``(2, n)``. `shifts`
    describes the other arguments.
    """
    length = math.dist(*points[:, np.atleast_2d(line)[0, [0, -1]]].T)
    shift = shifts(points, triangles, fixed, line, max(REACH[0] * length, REACH[1] * gear.m_n))
    low = shallowest(crack)
    for least in LEAST if low == 0 else (low * (1 - 1e-9),):
        if not folds(points + (SPARE * least - 1) * shift):
            return shift, Front(crack, width, least)
    remedy = "change refine a little" if low == 0 else "give ends that run out to 0, or a front that is less shallow there"
    raise RuntimeError(
        f"z = {gear.z}, crack with ends = {crack.ends}: where its depth falls to {least:.2g} of the largest depth, elements of "
        "the "
        f"mesh would be inverted; {remedy}"
    )


def shifts(points, triangles, fixed, line, reach):
    """Return the shift ``(2, n)`` of all vertices per part of the crack's length, always along the crack.

    The magnitude spreads from the crack like heat conduction. For a crack of the part f of its length, the area of a triangle
    is multiplied by ``1 + (f - 1) s``, with the slope s of the shift along the crack. Triangles with s > 1 get a higher
    resistance.

    Parameters
    ----------
    points : ndarray, shape (2, n)
        Vertices [mm].
    triangles : ndarray, shape (3, m)
        Counter-clockwise; others are left out.
    fixed : ndarray
        Vertices that must not move: the outline.
    line : ndarray, shape (k,) or (2, k)
        Vertices on the straight crack (on both its faces), from mouth to tip.
    reach : float
        Vertices further than this from the crack do not move [mm].
    """
    line = np.atleast_2d(line)
    ends = points[:, line[0, [0, -1]]]
    along = ends[:, 1] - ends[:, 0]
    length = math.hypot(*along)
    place = along @ (points - ends[:, :1]) / length
    away = np.hypot(*(points - ends[:, :1] - along[:, None] * np.clip(place / length, 0.0, 1.0)))
    still, on_crack = np.union1d(fixed, np.flatnonzero(away > reach)), np.unique(line)
    out = np.zeros(place.size)
    out[on_crack] = place[on_crack]
    out[still] = 0.0
    free = np.setdiff1d(np.arange(place.size), np.union1d(on_crack, still))
    slope, area = _slopes(points, triangles)
    good = area > 1e-9 * area.max()
    slope, area, triangles = slope[..., good], area[good], triangles[:, good]
    rise = np.einsum("nam,a->nm", slope, along / length)
    weight = area * (area.max() / area) ** STIFFER
    plain = _added(np.einsum("nam,kam,m->mnk", slope, slope, weight), triangles, out.size)
    steep = np.zeros(area.size, dtype=bool)
    for _ in range(ROUNDS):
        hard = HARD * weight * steep
        matrix = plain + _added(np.einsum("nm,km,m->mnk", rise, rise, hard), triangles, out.size)
        force = np.bincount(triangles.ravel(), (rise * hard).ravel(), out.size)
        out[free] = 0.0
        out[free] = np.linalg.solve(matrix[np.ix_(free, free)], (force - matrix @ out)[free])
        steeper = steep | ((rise * out[triangles]).sum(axis=0) > 1)
        if (steeper == steep).all():
            break
        steep = steeper
    return along[:, None] / length * out


def _slopes(points, triangles):
    """Slopes ``(3, 2, m)`` of the linear functions of triangles, and their areas."""
    corner = points[:, triangles]
    (xx, xy), (yx, yy) = (corner[:, 1:] - corner[:, :1]).transpose(0, 1, 2)
    area = (xx * yy - xy * yx) / 2
    inverse = np.array([[yy, -xy], [-yx, xx]]) / (2 * area)
    return np.einsum("xam,xn->nam", inverse, np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])), area


def _added(local, triangles, count):
    """Return the sum ``(count, count)`` of the matrices ``(m, 3, 3)`` of triangles."""
    out = np.zeros((count, count))
    np.add.at(out, (triangles.T[:, :, None], triangles.T[:, None, :]), local)
    return out
