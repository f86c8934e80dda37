"""Gears that are one piece with their shaft: against beams where the gear is rigid, against held faces where the shaft is."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.flexibility.finite_elements.fe3d import Patches, influence, mesh_patches
from gearfe.flexibility.finite_elements.integral import integral_influence
from gearfe.flexibility.solid import hats
from gearfe.geometry.tooth.profile import flank_normal, roll_at_arc

B = 8.0
GEAR = gf.Gear(z=9, x=0.5, m_n=2.0, alpha_n=math.radians(20), b=B, r_bore=3.0)
SIZES = {"flank": 0.8, "corner": 0.5, "fillet": 0.8, "root": 1.2, "near": 1.5, "far": 2.5, "crack": 1.0, "crack tip": 1.0}
PATCHES = Patches((0,), hats(GEAR)[:, [3]], 2)


@pytest.fixture(scope="module")
def mesh():
    return mesh_patches(GEAR, PATCHES, per_hat=1, layer=4.0, sizes=SIZES)


def shaft(left=20.0, right=30.0, d_left=12.0, d_right=14.0, d_gear=24.0, **more):
    segments = [(left, d_left), (B, d_gear), (right, d_right)]
    bearings = (0.0, left + B + right)
    return gf.Shaft(segments=segments, bearings=bearings, gear=left + B / 2, material=STEEL, torque=0.0, integral=True, **more)


def by_beam(held):
    """Displacement and tilt of the flank under an even line load and one linear in z, the gear a rigid piece of the beam.

    The normals of a hat turn along the flank: its resultant is a little less than one, its torque is not.
    """
    springs = replace(held, integral=False).support()
    start, top, stop = PATCHES.knots[:, 0]
    arc = np.linspace(start, stop, 2001)
    hat = np.interp(arc, [start, top, stop], [0.0, 1.0, 0.0])
    less = np.hypot(*(flank_normal(GEAR, roll_at_arc(GEAR, arc)) @ hat / hat.sum())) ** 2
    linear = B / 6  # moment of P1 / b about the middle
    even = less / springs.radial + GEAR.r_b**2 / springs.torsion
    return np.array(
        [[even, less * springs.coupling * linear], [less * springs.coupling * linear, less * linear**2 / springs.tilt]]
    )


@pytest.mark.slow
@pytest.mark.parametrize("side", ["both", "left"])
def test_a_rigid_gear_on_elastic_stubs_is_a_rigid_piece_of_a_beam(mesh, side):
    """Loads along the involute's normal: force, tilt and torque of the hub, two stubs or an overhung gear."""
    if side == "both":
        held, rigid = shaft(bearing_stiffness=(3e5, 2e5)), shaft(bearing_stiffness=(3e5, 2e5), d_gear=1e3)
    else:
        parts = {"bearings": (0.0, 25.0), "gear": 30.0 + B / 2, "material": STEEL, "torque": 10.0, "integral": True}
        held, rigid = (gf.Shaft(segments=[(30.0, 12.0), (B, d)], **parts) for d in (24.0, 1e3))
    hard = SimpleNamespace(lame=lambda state: tuple(1e4 * one for one in STEEL.lame(state)))
    found = integral_influence(mesh, hard, PATCHES, held).matrix.reshape(2, 2)
    assert_allclose(found, by_beam(rigid), rtol=1e-3, atol=1e-4 * by_beam(rigid)[0, 0])


@pytest.mark.slow
def test_a_rigid_stub_is_a_held_face(mesh):
    """Of an overhung gear: both bearings are on the thick stub beside z = 0, and z = b is free."""
    parts = {"bearings": (0.0, 10.0), "gear": 10.0 + B / 2, "material": STEEL, "torque": 10.0, "integral": True}
    thick = gf.Shaft(segments=[(10.0, 1e3), (B, 24.0)], **parts)
    disc = (np.abs(mesh.points[2]) < 1e-9) & (np.hypot(*mesh.points[:2]) <= GEAR.r_f * (1 + 1e-9))
    expected = influence(replace(mesh, held=np.flatnonzero(disc)), STEEL, PATCHES).matrix
    assert_allclose(integral_influence(mesh, STEEL, PATCHES, thick).matrix, expected, rtol=1e-4)


@pytest.mark.slow
def test_a_shaft_seen_from_its_other_end(mesh):
    one, two = (integral_influence(mesh, STEEL, PATCHES, held).matrix.reshape(2, 2) for held in (shaft(), shaft().turned()))
    assert_allclose(one * [[1, -1], [-1, 1]], two, rtol=1e-5, atol=1e-9 * one.max())
    assert shaft().turned().turned() == shaft()
    assert one[0, 1] != 0


@pytest.mark.parametrize(
    ("held", "message"),
    [
        (shaft(left=2.0), "the gear from"),
        (shaft(d_left=4.0), "radius 2 mm next to the gear is less than that of its bore, r_bore = 3 mm"),
        (replace(shaft(), torque=24.0), "torque = 24 mm is inside of the gear"),
    ],
)
def test_impossible_ones_are_refused(mesh, held, message):
    held = replace(held, gear=3.0) if message == "the gear from" else held
    with pytest.raises(ValueError, match=message):
        integral_influence(mesh, STEEL, PATCHES, held)


def test_only_hexahedra_have_them():
    pair = gf.GearPair(GEAR, gf.Gear(z=30, m_n=2.0, alpha_n=math.radians(20), b=B, r_bore=12.0))
    for method in ("ritz", "ritz3d"):
        with pytest.raises(ValueError, match="the pinion is one piece with its shaft"):
            gf.mesh_stiffness(pair, 500.0, STEEL, method=method, supports={"pinion": shaft()})
    with pytest.raises(ValueError, match="the pinion is one piece with its shaft"):
        gf.contact_pattern(pair, 500.0, STEEL, supports={"pinion": shaft()})
    with pytest.raises(ValueError, match="needs the position torque"):
        replace(shaft(), torque=None)


@pytest.mark.slow
def test_pairs_with_a_pinion_cut_from_its_shaft():
    """Mirrored pairs on mirrored shafts are alike, an overhung pinion's too."""
    found = []
    for side in (1, -1):
        beta = side * math.radians(15)
        rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": B}
        pair = gf.GearPair(
            gf.Gear(z=12, x=0.3, beta=-beta, r_bore=3.0, **rack), gf.Gear(z=13, x=0.3, beta=beta, r_bore=5.0, **rack)
        )
        parts = {"bearings": (0.0, 25.0), "gear": 30.0 + B / 2, "material": STEEL, "torque": 0.0, "integral": True}
        held = gf.Shaft(segments=[(30.0, 16.0), (B, 19.0)], **parts)
        held = held if side > 0 else held.turned()
        options = {"supports": {"pinion": held}, "phases": [0.75], "refine": 0.4, "cache": False}
        found.append(gf.mesh_stiffness(pair, 500.0, STEEL, **options))
    assert found[0].meta["method"] == "fe3d"
    assert_allclose(found[0].k, found[1].k, rtol=1e-3)
