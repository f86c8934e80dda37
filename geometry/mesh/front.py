"""Moving a section's vertices along its crack, so that one mesh carries a crack front that is not parallel to the teeth.

The section of a crack open over the part f of its length is that of the whole crack with all points moved by ``(f - 1) shift``:
those on the crack towards its mouth in proportion, its neighbours with them, everything from `REACH` crack lengths on not at all.
"""

import math

import numpy as np

from ..damage.front import LEAST, Front

SPARE = 0.8  # a mesh must not fold at this part of the least depth that it follows
REACH = 1.2, 0.8  # how far from the crack vertices move: in its lengths, and at least [m_n]
STIFFER = 0.5  # small triangles resist as their area to minus this power: they keep their shape, the large ones give way


def follow(gear, crack, width, points, triangles, *, outline, line, folds):
    """How a section follows the front of a crack: the shift ``(2, n)`` [mm] of its vertices, and the `Front` followed.

    Parameters
    ----------
    gear : Gear
    crack : Crack
    width : float
        Of the face [mm].
    points, triangles
        As of `shifts`.
    outline : ndarray
        Vertices that must not move.
    line : ndarray, shape (k,) or (2, k)
        Vertices on the crack from mouth to tip.
    folds : callable
        Whether the mesh folds with its vertices at points ``(2, n)``.

    Raises
    ------
    RuntimeError
        If the mesh cannot follow it.
    """
    length = math.dist(*points[:, np.atleast_2d(line)[0, [0, -1]]].T)
    shift = shifts(points, triangles, outline, line, max(REACH[0] * length, REACH[1] * gear.m_n))
    for least in LEAST:
        if not folds(points + (SPARE * least - 1) * shift):
            return shift, Front(crack, width, least)
    raise RuntimeError(f"z = {gear.z}, crack over parts {crack.ends} of its length: the mesh folds; change refine a little")


def shifts(points, triangles, fixed, line, reach):
    """Shift ``(2, n)`` of all vertices per part of the crack's length.

    Linear elasticity of triangles without Poisson's ratio carries the shift of the crack into its neighbourhood.

    Parameters
    ----------
    points : ndarray, shape (2, n)
        Vertices [mm].
    triangles : ndarray, shape (3, m)
        Counter-clockwise.
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
    part = np.clip(along @ (points - ends[:, :1]) / (along @ along), 0.0, 1.0)
    away = np.hypot(*(points - ends[:, :1] - along[:, None] * part))
    still = np.union1d(fixed, np.flatnonzero(away > reach))
    out = np.zeros(points.shape)
    own = np.unique(line)
    out[:, own] = points[:, own] - ends[:, :1]
    out[:, still] = 0.0
    free = np.setdiff1d(np.arange(points.shape[1]), np.union1d(own, still))
    matrix = _elastic(points, triangles)
    rows = (2 * free[:, None] + np.arange(2)).ravel()
    out = out.T.ravel()
    out[rows] = np.linalg.solve(matrix[np.ix_(rows, rows)], -(matrix @ out)[rows])
    return out.reshape(-1, 2).T


def _elastic(points, triangles):
    """Stiffness ``(2 n, 2 n)`` of linear triangles with Young's modulus by their area, and no Poisson's ratio."""
    corner = points[:, triangles]
    (xx, xy), (yx, yy) = (corner[:, 1:] - corner[:, :1]).transpose(0, 1, 2)
    area = (xx * yy - xy * yx) / 2
    inverse = np.array([[yy, -xy], [-yx, xx]]) / (2 * area)
    slope = np.einsum("xam,xn->nam", inverse, np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]]))
    weight = area * (area.max() / area) ** STIFFER
    local = np.einsum("aem,bdm,m->madbe", slope, slope, weight)
    dot = np.einsum("acm,bcm,m->mab", slope, slope, weight)
    for d in range(2):
        local[:, :, d, :, d] += dot
    rows = (2 * triangles[:, None] + np.arange(2)[:, None]).transpose(2, 0, 1).reshape(-1, 6)
    out = np.zeros((2 * points.shape[1],) * 2)
    np.add.at(out, (rows[:, :, None], rows[:, None, :]), local.reshape(-1, 6, 6))
    return out
