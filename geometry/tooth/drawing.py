"""Coarse outline of a gear for drawings."""

import math

import numpy as np

from .profile import cartesian, fillet_length, flank, root_curve


def outline_points(gear, *, points=5):
    """Return the closed transverse outline of all teeth ``(2, n)`` [mm] with few points."""
    rise = np.linspace(0.0, fillet_length(gear), points), np.linspace(gear.roll_f, gear.roll_a, points)
    radius, angle = (np.concatenate(pair) for pair in zip(root_curve(gear, rise[0]), flank(gear, rise[1]), strict=True))
    radius, angle = np.concatenate([radius, radius[::-1]]), np.concatenate([-angle, angle[::-1]])
    turns = 2 * math.pi * np.arange(gear.z)[:, None] / gear.z
    return cartesian(np.tile(radius, gear.z), (angle + turns).ravel())
