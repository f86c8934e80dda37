"""Opening of a mesh along a chain of edges: a crack of zero width with two faces."""

import numpy as np


def open_seam(points, triangles, chain):
    """Double the nodes of a chain of mesh edges that starts on the boundary of the mesh.

    The last node, the tip, is not doubled.

    `points` are ``(2, n)``, `triangles` ``(3, m)``, `chain` the nodes. The result has three parts: the points with the new ones
    appended, the triangles, and the chain on its right side with the shared tip. Triangles right of the chain (towards the tip)
    use the new points. RuntimeError if the chain does not consist of edges of the mesh.
    """
    triangles = triangles.copy()
    sides = {tuple(sorted(edge)) for edge in zip(chain[:-1].tolist(), chain[1:].tolist(), strict=True)}
    double = chain.copy()
    double[:-1] = points.shape[1] + np.arange(chain.size - 1)
    change = []
    for i, node in enumerate(chain[:-1].tolist()):
        fan = np.flatnonzero((triangles == node).any(axis=0)).tolist()
        left = _left_part(points, triangles, node, int(chain[i + 1]), fan, sides)
        change += [(tri, node, int(double[i])) for tri in fan if tri not in left]
    for tri, old, new in change:
        column = triangles[:, tri]
        column[column == old] = new
    return np.hstack([points, points[:, chain[:-1]]]), triangles, double


def _left_part(points, triangles, node, following, fan, sides):
    """Return the triangles of the fan around `node` that lie left of the edge to `following`."""
    ahead = points[:, following] - points[:, node]
    corners = {tri: set(triangles[:, tri].tolist()) for tri in fan}
    seeds = []
    for tri in fan:
        if following in corners[tri]:
            (third,) = corners[tri] - {node, following}
            arm = points[:, third] - points[:, node]
            if ahead[0] * arm[1] - ahead[1] * arm[0] > 0:
                seeds.append(tri)
    if not seeds:
        raise RuntimeError("gmsh placed no mesh edges along the crack: change the crack or the resolution")
    left, waiting = set(seeds), list(seeds)
    while waiting:
        tri = waiting.pop()
        for other in fan:
            shared = corners[tri] & corners[other]
            if other not in left and len(shared) == 2 and node in shared and tuple(sorted(shared)) not in sides:
                left.add(other)
                waiting.append(other)
    return left
