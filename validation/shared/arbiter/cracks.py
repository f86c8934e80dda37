"""Straight cracks on the outlines of the arbiter: where they start, and where they run."""

import math

import numpy as np


def crack_start(side, crack):
    """Place on the fillet at which a crack begins: root, middle, or its tangent's angle to the centre-line in degrees."""
    last = side.joints[1]
    if crack.start == "root":
        return 1e-6 * last
    if crack.start == "middle":
        return last / 2
    s = np.linspace(0, last, 4001)[1:-1]
    steep = np.abs(side.normal(s) - math.pi / 2)  # of the tangent against the centre-line
    return float(s[np.flatnonzero(steep <= math.radians(float(crack.start.removesuffix("deg"))))[0]])


def crack_line(side, crack):
    """Start (x, y) and direction of a straight crack, tooth along +y."""
    radius, angle = (float(v[0]) for v in side.place(np.array([crack_start(side, crack)])))
    x = 1.0 if crack.side == "loaded" else -1.0
    start = np.array([x * radius * math.sin(angle), radius * math.cos(angle)])
    return start, np.array([-x * math.sin(crack.angle), -side.sign * math.cos(crack.angle)])


def crack_length(side, crack):
    """Length [mm]: at level 0.5 the crack reaches the centre-line."""
    if crack.length is not None:
        return crack.length
    start, direction = crack_line(side, crack)
    return crack.level / 0.5 * abs(start[0] / direction[0])
