"""Sectors with cracks at any angle: no triangle of nothing, and the stiffness of the section follows the crack."""

import math
import warnings

import numpy as np
import pytest

import gearfe as gf
from gearfe.geometry.mesh.outline import stations
from gearfe.geometry.mesh.section_mesh import section
from gearfe.geometry.mesh.sector import sector

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


with warnings.catch_warnings():
    warnings.simplefilter("ignore", UserWarning)  # the tool's tip is fully round, and the pair trims the ring's
    RING = gf.Gear(z=83, r_rim=95.0, **RACK)  # the fillets of its teeth meet: no root arc between them
    INTO_RING = gf.GearPair(gf.Gear(z=20, r_bore=10.0, **RACK), RING)


@pytest.mark.parametrize("side", ["loaded", "unloaded"])
def test_a_crack_between_two_teeth_leaves_the_sides_whole(side):
    """Its mouth is a corner of the sector: the side belongs to one of the two faces."""
    made = sector(RING, (gf.Crack(level=0.3, start="root", side=side),))
    edges = {tuple(sorted(pair)) for tri in made.triangles.T.tolist() for pair in zip(tri, tri[1:] + tri[:1], strict=True)}
    for line in (made.left, made.right):
        assert {tuple(sorted(pair)) for pair in zip(line[:-1].tolist(), line[1:].tolist(), strict=True)} <= edges


@pytest.mark.slow
def test_a_crack_between_two_teeth_softens_as_the_section_has_it(steel):
    """gmsh did not end; the sector's crack was shut at its mouth, and stiffer the deeper it went."""
    shallow, deep, section = (
        gf.mesh_stiffness(
            INTO_RING, 2000.0, steel, method=method, phases=[0.2], damage={"wheel": [gf.Crack(level=level, start="root")]}
        ).k[0]
        for method, level in (("ritz", 0.02), ("ritz", 0.3), ("fe", 0.3))
    )
    assert deep < 0.92 * shallow
    np.testing.assert_allclose(deep, section, rtol=2e-3)


def test_cracks_that_no_mesh_can_follow_are_refused():
    m = 2.0
    ring = gf.Gear(z=60, r_rim=70.0, rack_tip_radius=0.2, **RACK)
    sizes = {"fillet_size": 0.15 * m, "size": 0.3 * m, "far_size": 0.8 * m, "teeth": 5}

    def meshed(gear, *cracks):
        return section(gear, {0: stations(gear, 0.25 * m)}, **sizes, cracks=cracks)

    with pytest.raises(
        ValueError, match="crack from 'root' at 90 degrees on tooth 0 of z = 60 leaves the body along its outline"
    ):
        meshed(ring, gf.Crack(level=0.02, start="root", angle=math.radians(90)))
    with pytest.raises(ValueError, match="it reaches the held edge of z = 18"):
        meshed(GEAR, gf.Crack(level=0.9, angle=math.radians(5), turning=True))
    with pytest.raises(ValueError, match="two cracks start at the same place between two teeth"):
        meshed(RING, gf.Crack(level=0.2, start="root"), gf.Crack(level=0.2, start="root", tooth=1, side="unloaded"))
    assert meshed(ring, gf.Crack(level=0.02, start="root")).seams
