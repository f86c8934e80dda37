"""Zones of the faces of cracks in hexahedra, and the forces that push them apart, for contact of crack faces.

The contact pressure is uniform on each zone, and the mean opening of a zone is not negative. Pressure and opening use the same
weights, so that the influence matrix is symmetric.
"""

import numpy as np

from .hexahedron import face_shapes

ACROSS, ALONG = 4, 8  # largest number of contact zones of a crack: from mouth to tip, along the width
NEAR_TIP = 0.1  # Within this part of its length from the tip, a crack has no contact zone.


def zone_forces(mesh):
    """Nodal forces ``(3 nodes, k)`` of unit resultant [N] that push apart the faces of each zone of all cracks.

    The forces are those of the cracks of a `gearfe.geometry.mesh.solid.Solid`, with x, y, z of each node in sequence. Zones
    without a face are omitted.
    """
    out, count = [], mesh.points.shape[1]
    for body in (name for name in mesh.faces if name.startswith("crack ") and name.endswith(" body")):
        faces = np.array([mesh.faces[body], mesh.faces[body.replace("body", "tooth")]])
        forces, middle = _pressures(mesh.points, faces[0])
        place = _places(mesh, int(body.split()[1]), faces[0], middle[2])
        ends = np.linspace(middle[2].min(), middle[2].max(), ALONG + 1)[1:-1]
        zone = np.searchsorted(np.linspace(0.0, 1.0 - NEAR_TIP, ACROSS + 1)[1:], place) * ALONG + np.searchsorted(ends, middle[2])
        sign = _to_tooth(mesh, faces[1, :, 0], forces[:, :, 0].sum(axis=0))
        for in_zone in (np.flatnonzero(zone == k) for k in range(ACROSS * ALONG)):
            if in_zone.size:
                out.append(_apart(count, faces[:, :, in_zone], sign * forces[:, :, in_zone]))
    return np.column_stack(out) if out else np.zeros((3 * count, 0))


def _pressures(points, faces):
    """Nodal forces ``(8, 3, m)`` of unit pressure along the normals of faces [N], and their middles ``(3, m)``."""
    at, weight = np.polynomial.legendre.leggauss(3)
    x, y = (v.ravel() for v in np.meshgrid(at, at, indexing="ij"))
    step, nodes = 1e-4, points[:, faces]  # difference step, exact for shape functions of second degree in x and y
    first, second = (
        np.einsum("dnm,nq->dmq", nodes, (face_shapes(x + h, y + v) - face_shapes(x - h, y - v)) / (2 * step))
        for h, v in ((step, 0.0), (0.0, step))
    )
    normal = np.cross(first, second, axis=0)
    forces = np.einsum("nq,dmq,q->ndm", face_shapes(x, y), normal, np.outer(weight, weight).ravel())
    return forces, nodes[:, :4].mean(axis=1)


def _places(mesh, number, faces, heights):
    """Return the positions ``(m,)`` of element faces of crack `number`: 0 at the mouth, 1 at the tip at the same height."""
    section = mesh.section
    ((edges, depth),) = [
        (cut.edges[[0, 2]][:, cut.crack == number], cut.depth[cut.crack == number]) for cut in section.cuts if number in cut.crack
    ]
    first = edges[:, depth.argmin()]
    mouth = first[0] if np.count_nonzero(edges == first[0]) == 1 else first[1]
    turn = mesh.gear.twist_rate * mesh.points[2]
    x, y, _ = mesh.points
    flat = np.array([np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y])
    away = np.hypot(*(flat - section.points[:, [mouth]]))[faces[:4]]
    layer = np.searchsorted(mesh.levels, heights)
    reach = np.zeros(mesh.levels.size)
    np.maximum.at(reach, layer, away.max(axis=0))
    return away.mean(axis=0) / reach[layer]


def _to_tooth(mesh, face, normal):
    """Return 1 if the normal of a face on the tooth side points into the tooth, otherwise -1."""
    (cell,) = np.flatnonzero(np.isin(mesh.cells, face).sum(axis=0) == face.size)
    inside = mesh.points[:, mesh.cells[:, cell]].mean(axis=1) - mesh.points[:, face].mean(axis=1)
    return 1.0 if inside @ normal > 0 else -1.0


def _apart(count, faces, forces):
    """Return a column ``(3 count,)``: `forces` on the tooth side of a crack, and opposite forces on the other side."""
    out = np.zeros((count, 3))
    forces = forces.mT / np.linalg.norm(forces.sum(axis=(0, 2)))
    for side, sign in zip(faces, (-1.0, 1.0), strict=True):
        np.add.at(out, side, sign * forces)
    return out.ravel()
