"""Folded elements: second-order tets or hexahedra without positive Jacobian, and their repair for tets."""

import numpy as np
from skfem import ElementHexS2

from ...geometry.kept import keeping
from .hexahedron import TWENTY, gauss, shapes
from .tetrahedron import EDGES, INNER, OUTER

LEFT = 0.05  # least Jacobian of a curved tetrahedron, relative to the straight one
NEAR = 0.975  # position of the checked point near a corner of a hexahedron; quads with a straight angle at the corner are valid
HALVINGS = 5  # number of halvings of an edge's curvature before the edge is made straight


@keeping(2)
def _slopes(count):
    """Slopes ``(count, 3, q)`` of the shapes of a C3D10 or C3D20R at its integration points and at or near its corners."""
    if count == 20:
        corners = 1 - NEAR + (2 * NEAR - 1) * np.array(ElementHexS2.doflocs[:8], dtype=float).T
        return shapes(np.hstack([gauss(2)[0], corners]))[1][TWENTY]
    place = np.hstack([np.full((4, 4), OUTER) + (INNER - OUTER) * np.eye(4), np.eye(4)])
    out = np.zeros((10, 4, place.shape[1]))
    for k in range(4):
        out[k, k] = 4 * place[k] - 1
    for k, (a, b) in enumerate(EDGES, 4):
        out[k, a], out[k, b] = 4 * place[b], 4 * place[a]
    return out[:, 1:] - out[:, :1]


def jacobians(points, cells):
    """Least Jacobian determinant ``(m,)`` of second-order elements at CalculiX's integration points and at (or near) corners.

    For hexahedra the points lie at `NEAR` of the way to the corners, since quads of a section may have a straight angle. `points`
    are ``(3, n)`` [mm], `cells` ``(10 or 20, m)`` nodes in CalculiX's order.
    """
    slopes = _slopes(len(cells))
    out = np.empty(cells.shape[1])
    for start in range(0, cells.shape[1], 5000):
        chunk = slice(start, start + 5000)
        out[chunk] = np.linalg.det(np.einsum("dkm,kcq->mqdc", points[:, cells[:, chunk]], slopes, optimize=True)).min(axis=1)
    return out


def unfolded(nodes, cells):
    """Nodes of bent tets ``(10, m)`` moved towards their chords until no tet folds.

    A tet that keeps less than `LEFT` of the Jacobian of the straight tet is repaired. The nodes in the middle of its edges
    move half of the way to the chord, repeatedly, and finally the whole way. This is necessary for a tet with two faces on one
    smooth surface, or across the end of a flank, because no curvature suits both faces. Straight tets between the corners must
    not fold.
    """
    nodes = nodes.copy()
    ends = np.array(EDGES).T
    for part in (*[0.5] * HALVINGS, 0.0):
        sides = nodes[:, cells[1:4]] - nodes[:, cells[:1]]
        least = LEFT * np.linalg.det(sides.transpose(2, 0, 1))
        folded = jacobians(nodes, cells) < least
        if not folded.any():
            break
        middle, place = np.unique(cells[4:, folded], return_index=True)
        chord = nodes[:, cells[ends][:, :, folded]].mean(axis=1).reshape(3, -1)[:, place]
        nodes[:, middle] = chord + part * (nodes[:, middle] - chord)
    return nodes


def check_folds(points, cells):
    """Raise RuntimeError if an element folds, because CalculiX would stop. Elements are ordered as in `jacobians`."""
    least = jacobians(points, cells)
    if not least.min() > 0:
        worst = int(np.argmin(least))
        x, y, z = points[:, cells[:, worst]].mean(axis=1)
        raise RuntimeError(
            f"{(least <= 0).sum()} of {least.size} elements of this mesh fold, the worst at ({x:.4g}, {y:.4g}, {z:.4g}) mm: "
            "change refine a little, or give more layers to a steep helix"
        )
