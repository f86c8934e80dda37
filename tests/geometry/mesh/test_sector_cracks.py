"""Sectors with cracks at any angle: no triangle of nothing, and the stiffness of the section follows the crack."""

import math

import numpy as np
import pytest

import gearfe as gf
from geometry.mesh.sector import sector

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 12.0}
GEAR = gf.Gear(z=18, r_bore=3.0, **RACK)


@pytest.mark.parametrize("degrees", [50.0, 60.0, 70.0])
@pytest.mark.parametrize("level", [0.5, 0.6, 0.7])
def test_no_triangle_is_flat(level, degrees):
    """At 60 degrees and 50 or 60 % a straight line of the crack and ahead of it made a triangle of area zero."""
    made = sector(GEAR, (gf.Crack(level=level, angle=math.radians(degrees)),))
    corners = made.points[:, made.triangles]
    (ax, ay), (bx, by) = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    longest = np.hypot(*(corners - np.roll(corners, 1, axis=1))).max(axis=0)
    assert ((ax * by - ay * bx) / longest**2).min() > 1e-6


def test_a_steep_deep_crack_lies_between_its_neighbours(steel):
    pair = gf.GearPair(GEAR, gf.Gear(z=27, r_bore=12.0, **RACK))
    k = []
    for level in (0.5, 0.6, 0.7):
        crack = gf.Crack(level=level, angle=math.radians(60))
        k.append(gf.mesh_stiffness(pair, 1200.0, steel, method="ritz", phases=4, damage={"pinion": [crack]}).k)
    assert (np.diff(k, axis=0) < 0).all()
