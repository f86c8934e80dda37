"""Cubic triangles with quadratic short edges, which are accurate enough for small triangles.

Along a short edge the displacement is constrained to a parabola. With the ends' values a and b, ``u = (1 - s) a + s b + q`` at
both, and q is the height of the parabola there. The first inner node becomes q, the second is removed. All triangles at an
edge use the same rule, so that displacements stay continuous. Edges on the curved outline, where stress changes most, and
those on the sides and on crack faces stay cubic.
"""

import numpy as np

from ....geometry.mesh.triangle import ENDS, lobatto

ORDER = 3  # The functions below require triangles of this order.
SHORT = 0.8  # Shorter edges are quadratic [m_n].
TIP = 0.2  # Edges closer to a crack tip stay cubic [m_n].


def quadratic_edges(gear, sector):
    """Return the quadratic edges of the triangles, as local edges ``(3, m)``."""
    corners = sector.points[:, sector.triangles]
    outline = np.unique(np.array(list(sector.bulge)))
    lines = [sector.left, sector.right, *(face for pair in sector.faces for face in pair)]
    far = np.ones(sector.points.shape[1], dtype=bool)
    for left, _ in sector.faces:
        far &= np.hypot(*(sector.points - sector.points[:, left[-1:]])) > TIP * gear.m_n
    out = np.zeros(sector.triangles.shape, dtype=bool)
    for k, (a, b) in enumerate(ENDS):
        start, end = sector.triangles[a], sector.triangles[b]
        out[k] = np.hypot(*(corners[:, a] - corners[:, b])) < SHORT * gear.m_n
        out[k] &= ~np.isin(start, outline) & ~np.isin(end, outline) & (far[start] | far[end])
        out[k] &= ~np.any([np.isin(start, line) & np.isin(end, line) for line in lines], axis=0)
    return out


def bind(section, load, numbers, edges):
    """Make the `edges` of `quadratic_edges` quadratic, in place, and return the removed nodes.

    `elimination.Section` describes `section` ``(3, m, 3 n, 3 n)``, `load` and `numbers`.
    """
    s = (1 + lobatto(ORDER)[1]) / 2
    bound = np.tile(np.eye(numbers.shape[0]), (edges.shape[1], 1, 1))
    done = set()
    for k, (a, b) in enumerate(ENDS):
        first, second = 3 + 2 * k, 4 + 2 * k
        triangles = np.flatnonzero(edges[k])
        swapped = numbers[first, triangles] > numbers[second, triangles]  # All triangles at an edge omit the same node.
        kept, lost = np.where(swapped, second, first), np.where(swapped, first, second)
        bound[triangles, first, a], bound[triangles, first, b] = 1 - s, s
        bound[triangles, second, a], bound[triangles, second, b] = s, 1 - s
        bound[triangles, lost, lost] = 0.0
        bound[triangles, lost, kept] = 1.0
        for t in triangles.tolist():
            pair = numbers[first, t], numbers[second, t]
            if min(pair) in done:
                continue
            done.add(min(pair))
            at_first, at_second = load[pair[0]].copy(), load[pair[1]].copy()
            load[numbers[a, t]] += (1 - s) * at_first + s * at_second
            load[numbers[b, t]] += s * at_first + (1 - s) * at_second
            load[min(pair)], load[max(pair)] = at_first + at_second, 0.0
    bound = np.kron(bound, np.eye(3))
    section[:] = bound.mT @ section @ bound
    pairs = [np.max([numbers[3 + 2 * k, edges[k]], numbers[4 + 2 * k, edges[k]]], axis=0) for k in range(3)]
    return np.unique(np.concatenate(pairs))
