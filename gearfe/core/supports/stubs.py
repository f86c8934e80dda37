"""Stiffness of the two shaft stubs at the end faces of a gear that is one piece with its shaft."""

from typing import Any

import numpy as np

from ...geometry.aliases import Floats
from .beam import beam_element, pieces_between

RIGID = 1e7  # stiffness that counts as rigid, relative to the largest stiffness
MOTIONS = 6  # motions of a face: displacements x, y, z [mm], rotations about x, y, z [rad]


def stub_stiffness(shaft: Any, width: float) -> Floats:
    """Return the stiffness ``(12, 12)`` of the shaft stubs: forces and moments on both end faces of the gear per motion.

    The rows and columns are six motions of the face z = 0, then of the face z = b. A stub that reaches no bearing moves
    freely. A shaft that ends at a face has no stub there. The first bearing of the shaft holds it along the axis, its `torque`
    about the axis. `width` is that of the gear [mm].
    """
    faces = (shaft.gear - width / 2, shaft.gear + width / 2)
    nodes, pieces = pieces_between(shaft.segments, [*shaft.bearings, shaft.torque, *faces])
    bend, turn, pull = (np.zeros((n * nodes.size,) * 2) for n in (2, 1, 1))
    for i, (length, section) in enumerate(pieces):
        if faces[0] < (nodes[i] + nodes[i + 1]) / 2 < faces[1]:
            continue
        bend[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += beam_element(length, section, shaft.material)
        spring = np.array([[1, -1], [-1, 1]]) / length
        turn[i : i + 2, i : i + 2] += shaft.material.shear_modulus * 2 * section.second_moment * spring
        pull[i : i + 2, i : i + 2] += shaft.material.E * section.area * spring

    def nearest(place: float) -> int:
        return int(np.argmin(np.abs(nodes - place)))

    rigid = RIGID * np.abs(bend).max()
    for place, stiff in zip(shaft.bearings, shaft.bearing_stiffness, strict=True):
        bend[2 * nearest(place), 2 * nearest(place)] += min(stiff, rigid)
    turn[nearest(shaft.torque), nearest(shaft.torque)] += RIGID * turn.max()
    pull[nearest(shaft.bearings[0]), nearest(shaft.bearings[0])] += RIGID * pull.max()
    ends = [nearest(face) for face in faces]
    plane = _condensed(bend, [k for end in ends for k in (2 * end, 2 * end + 1)])
    out = np.zeros((2 * MOTIONS, 2 * MOTIONS))
    # A slope of x is a rotation about y, and a slope of y a negative rotation about x.
    for (across, about), sense in (((0, 4), 1), ((1, 3), -1)):
        at = np.array([across, about, MOTIONS + across, MOTIONS + about])
        signs = np.array([1, sense, 1, sense])
        out[np.ix_(at, at)] += signs[:, None] * plane * signs
    for motion, rod in ((5, turn), (2, pull)):
        at = np.array([motion, MOTIONS + motion])
        out[np.ix_(at, at)] += _condensed(rod, ends)
    return out


def _condensed(stiffness, kept):
    """Return the stiffness of the unknowns `kept`, condensed from the stiffness of all unknowns."""
    rest = np.setdiff1d(np.arange(len(stiffness)), kept)
    rest = rest[np.abs(stiffness[rest]).max(axis=1) > 0] if rest.size else rest  # Unknowns inside the gear have no stiffness.
    cross = stiffness[np.ix_(rest, kept)]
    return stiffness[np.ix_(kept, kept)] - cross.T @ np.linalg.solve(stiffness[np.ix_(rest, rest)], cross)


def face_radii(shaft: Any, width: float) -> tuple[float, float]:
    """Return the radius of the shaft next to the faces z = 0 and z = b [mm], 0 where it ends there."""
    ends = np.cumsum([0.0, *(segment.length for segment in shaft.segments)])
    slack = 1e-9 * ends[-1]

    def beside(place: float) -> float:
        if not slack < place < ends[-1] - slack:
            return 0.0
        return shaft.segments[int(np.searchsorted(ends, place)) - 1].diameter / 2

    reach = 1e-6 * width
    return beside(shaft.gear - width / 2 - reach), beside(shaft.gear + width / 2 + reach)
