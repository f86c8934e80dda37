"""The loaded tooth with its damage as a rotatable surface."""

import math

import numpy as np

# corners of the faces of a tetrahedron seen from outside, and the opposite corner
SIDES = ((1, 2, 3, 0), (0, 3, 2, 1), (0, 1, 3, 2), (0, 2, 1, 3))
DEEP = 2.2  # shown depth of the body below the root circle [m_n]


def surface(cells, points):
    """Return the outer triangles ``(3, k)`` of tets, ordered so that normals point outwards."""
    faces = np.hstack([cells[list(side[:3])] for side in SIDES])
    inner = np.hstack([cells[side[3]] for side in SIDES])
    _, first, count = np.unique(np.sort(faces, axis=0), axis=1, return_index=True, return_counts=True)
    faces, inner = faces[:, first[count == 1]], inner[first[count == 1]]
    a, b, c = points[:, faces].transpose(1, 0, 2)
    wrong = (np.cross(b - a, c - a, axis=0) * (points[:, inner] - a)).sum(axis=0) > 0
    faces[1:, wrong] = faces[2:0:-1, wrong]
    return faces


def shown_tooth(pressed, field, scale):
    """Surface of tooth 0 and its neighbours, without most of the body: points, faces and von Mises stress.

    The points ``(3, n)`` [mm] are displaced by `scale` times their displacement, with z along the width and y outwards through
    the tooth. The faces ``(3, k)`` are triangles of these points. The stress ``(n,)`` is in MPa.
    """
    gear = pressed.sector.gear
    faces = surface(field.cells[:4], field.points)
    deep = gear.outward * (np.hypot(*field.points[:2]) - gear.r_f) > -DEEP * gear.m_n
    faces = faces[:, deep[faces].all(axis=0)]
    used, faces = np.unique(faces, return_inverse=True)
    points = (field.points + scale * field.moved)[:, used]
    return points, faces.reshape(3, -1), field.mises[used]


def towards_flank(gear):
    """Return the unit vector towards the camera that views the loaded flank of tooth 0, with the tip of the tooth upwards."""
    turn = gear.twist_rate * gear.b / 2
    out = np.array([math.cos(turn), -math.sin(turn), 0.0])
    up = gear.outward * np.array([math.sin(turn), math.cos(turn), 0.0])
    view = out + 0.7 * up + np.array([0.0, 0.0, 0.5])
    return view / np.linalg.norm(view), up
