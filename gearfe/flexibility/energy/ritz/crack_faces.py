"""Forces that push the faces of cracks in a section apart."""

import numpy as np

from ....geometry.mesh.triangle import lagrange, lobatto


def face_forces(sector, chain, count, order, at):
    """Return unit forces ``(count, 3, k)`` that push facing points of the cracks apart, and the crack of each point.

    `chain` is the result of `panel.numbering` for polynomials of an `order`. The points are the nodes of polynomials of order
    `at` on the faces, without the crack tips.
    """
    columns, owner = [np.zeros((count, 3, 0))], []
    shapes = lagrange(order, tuple(lobatto(at)[:-1].tolist()))[:, None]  # (order + 1, 1, points of an edge)
    for i, faces in enumerate(sector.faces):
        nodes = [chain(np.array([face[:-1], face[1:]])) for face in faces]  # (order + 1, edges)
        ahead = np.diff(sector.points[:, faces[0]], axis=1)
        normal = np.array([-ahead[1], ahead[0]]) / np.hypot(*ahead)
        for edge in range(ahead.shape[1]):
            pushed = np.zeros((count, 3, at))
            for sign, own in zip((1, -1), nodes, strict=True):
                pushed[own[:, edge], :2] += sign * shapes * normal[:, edge, None]
            columns.append(pushed)
            owner += [i] * at
    return np.concatenate(columns, axis=2), owner
