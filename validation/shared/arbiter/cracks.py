"""Starts and paths of cracks on the outlines of the independent solver."""

import math

import numpy as np


def crack_start(side, crack):
    """Return the place on the fillet at which a crack begins: root, middle, or the tangent angle to the centre-line [degrees]."""
    last = side.joints[1]
    if crack.start == "root":
        return 1e-6 * last
    if crack.start == "middle":
        return last / 2
    s = np.linspace(0, last, 4001)[1:-1]
    steep = np.abs(side.normal(s) - math.pi / 2)  # angle between the tangent and the centre-line
    return float(s[np.flatnonzero(steep <= math.radians(float(crack.start.removesuffix("deg"))))[0]])


def crack_corners(side, crack):
    """Return corners ``(2, 2 or 3)`` [mm] of a crack from mouth to tip, with the tooth along +y.

    At level 0.5 the crack reaches the centre-line. A turning crack goes on from there towards the mirror image of its mouth.
    """
    radius, angle = (float(v[0]) for v in side.place(np.array([crack_start(side, crack)])))
    mouth = np.array([radius * math.sin(angle), radius * math.cos(angle)])
    direction = np.array([-math.sin(crack.angle), -side.sign * math.cos(crack.angle)])
    half = mouth[0] / math.sin(crack.angle)
    turns = crack.turning and crack.level > 0.5
    length = crack.length if crack.length is not None else 2 * half * (0.5 if turns else crack.level)
    corners = [mouth, mouth + length * direction]
    if turns:
        corners.append(corners[1] + (2 * crack.level - 1) * (mouth * [-1, 1] - corners[1]))
    return np.array(corners).T * [[1.0 if crack.side == "loaded" else -1.0], [1.0]]
