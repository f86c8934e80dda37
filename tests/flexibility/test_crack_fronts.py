"""Cracks whose depth changes along the width, in the energy model in three dimensions: limits, mirror images, hexahedra."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.flexibility import solid as flexibility3d
from gearfe.flexibility.energy.ritz import solid as ritz3d
from gearfe.flexibility.energy.ritz.bent import bent
from gearfe.flexibility.energy.ritz.join import join
from gearfe.flexibility.energy.ritz.panel3d import SolidModel
from gearfe.flexibility.finite_elements import fe3d
from gearfe.geometry.damage.crack_form import deepest
from gearfe.geometry.damage.front import Front, shallowest
from gearfe.geometry.mesh.quads import quad_section
from gearfe.geometry.mesh.sector import sector
from gearfe.geometry.mesh.solid import follow_front

RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
SPUR = gf.Gear(z=18, r_bore=9.0, b=6.0, **RACK)
HELICAL = replace(SPUR, beta=math.radians(16))
HAT = 5  # the patch that is looked at


def compliance(gear, crack, *, order=2, modes=3):
    """Influence ``(modes, modes)`` [mm per N/mm] of the first modes along the width under one patch."""
    model = SolidModel(gear, STEEL, order, 6)
    healthy = ritz3d.solid_sector(model, ())
    panels = {0: ritz3d.solid_sector(model, (crack,)) if crack else healthy, 1: healthy}
    at = HAT * 7 + np.arange(modes)
    return join(gear, panels, healthy)[0][0, 0][np.ix_(at, at)]


def test_a_front_that_hardly_slopes_is_one_parallel_to_the_teeth():
    """The section that moves with the front gives what a section with that crack gives."""
    want = compliance(HELICAL, gf.Crack(level=0.35))
    even = gf.Crack(level=0.5, ends=(0.7, 0.7))
    assert_allclose(compliance(HELICAL, even), want, rtol=1e-12, err_msg="an even one is meshed so")
    pinned = gf.Crack(level=0.5, ends=(1.0, 1.0 - 1e-9))
    assert_allclose(compliance(HELICAL, pinned), compliance(HELICAL, gf.Crack(level=0.5)), rtol=2e-3)


@pytest.mark.slow
def test_what_cubics_lack_at_the_tip_is_known_of_fronts_too():
    """A gear with a front that hardly slopes moves as with the straight crack, whose difference to plane strain is known."""
    at = HAT * 7
    flat, steep, none = (
        ritz3d.flexibility3d(SPUR, STEEL, own, order=3, axial=6).near[0][at, at]
        for own in ((gf.Crack(level=0.5),), (gf.Crack(level=0.5, ends=(1.0, 1.0 - 1e-6)),), ())
    )
    print(f"what the crack adds differs by {100 * ((steep - none) / (flat - none) - 1):.3f} %")
    assert_allclose(steep - none, flat - none, rtol=2e-3)


def test_a_front_seen_from_the_other_end():
    """On a spur gear the modes of even degree are the same, those between even and odd ones change sign."""
    one, other = (compliance(SPUR, gf.Crack(level=0.5, ends=ends)) for ends in ((1.0, 0.3), (0.3, 1.0)))
    sign = np.array([1.0, -1.0, 1.0])
    assert_allclose(one, sign[:, None] * other * sign, rtol=2e-3, atol=1e-3 * one[0, 0])
    assert one[0, 1] < -0.01 * one[0, 0], "more compliant at the end at z = 0, where it is deep"


def test_the_depths_at_which_matrices_are_computed_are_enough(monkeypatch):
    crack = gf.Crack(level=0.5, ends=(1.0, 0.3))
    want = compliance(SPUR, crack)
    monkeypatch.setattr("gearfe.flexibility.energy.ritz.bent.DEPTHS", 10)
    found = compliance(replace(SPUR, r_bore=SPUR.r_bore + 1e-12), crack)  # another key, so that it is solved anew
    assert_allclose(found, want, rtol=1e-4, atol=1e-6 * want[0, 0])


def hexahedra(gear, crack, opened=True):
    """Influence ``(2, 2)`` of the first modes by hexahedra; if not `opened`, those of the same mesh with the crack shut."""
    knots = flexibility3d.hats(gear)[:, HAT : HAT + 1]
    patches, scale = fe3d.Patches((0,), knots, 2), np.sqrt((2 * np.arange(2) + 1) * gear.b)
    fine = [(0.0, 0.0, 0.3), (gear.b, gear.b, 0.3)]
    mesh = fe3d.mesh_patches(gear, patches, cracks=(crack,), refine=0.8, fine=fine)
    if not opened:
        glued = np.arange(mesh.points.shape[1])
        glued[mesh.faces["crack 0 tooth"]] = mesh.faces["crack 0 body"]
        kept, cells = np.unique(glued[mesh.cells], return_inverse=True)
        number = np.searchsorted(kept, glued)
        faces = {name: number[nodes] for name, nodes in mesh.faces.items()}
        mesh = replace(
            mesh, points=mesh.points[:, kept], cells=cells.reshape(mesh.cells.shape), faces=faces, held=number[mesh.held]
        )
    return scale[:, None] * fe3d.influence(mesh, STEEL, patches).matrix[0, 0, :, 0, 0] * scale


@pytest.mark.slow
def test_what_half_an_ellipse_adds_is_that_of_hexahedra():
    """Even load and load that rises along the width; the hexahedra follow the front too and are a little too stiff.

    The contribution of the crack is the difference to the same hexahedra with the crack shut: that of a half ellipse under the
    load that rises is 3 % of the whole, as much as other layers of elements change it.
    """
    gear, crack = HELICAL, gf.Crack(level=0.5, width=(1.0, 5.0), ends=(0.0, 1.0, 0.0), rounded=True)
    model = [compliance(gear, own, order=3, modes=2) for own in (None, crack)]
    hexes = [hexahedra(gear, crack, opened) for opened in (False, True)]
    added = [found[1] - found[0] for found in (model, hexes)]
    print(np.round(100 * np.diag(added[0] / added[1] - 1), 2), "% of what the crack adds, which is", end=" ")
    print(np.round(100 * np.diag(added[1] / hexes[0]), 1), "% of the healthy gear's")
    assert_allclose(np.diag(added[0]), np.diag(added[1]), rtol=0.03)
    assert_allclose(np.diag(model[1]), np.diag(hexes[1]), rtol=0.01)


def test_fronts_are_followed_to_their_shallowest_place_or_refused():
    """A front that does not run out has its own depth at the shallow end, in both meshes; what meshes cannot follow, they say."""
    crack = gf.Crack(level=0.5)
    quads, triangles = quad_section(SPUR, cracks=(crack,), refine=0.5), sector(SPUR, (crack,), sizes=ritz3d.SIZES)

    def fronts(low):
        own = replace(crack, ends=(1.0, low))
        yield lambda: follow_front(quads, 0, own)[1]
        yield lambda: bent(SPUR, triangles, 0, own)[1]

    for low in (0.7, 0.3, 0.2):
        for follow in fronts(low):
            assert_allclose(follow().depth(np.array([0.0, 3.0, 6.0]))[0], [1.0, (1 + low) / 2, low], rtol=1e-8)
            assert follow().open() == ((0.0, 6.0),)
    for follow in fronts(1e-4):
        with pytest.raises(RuntimeError, match=r"falls to 0.0001 of the largest depth, .* give ends that run out to 0"):
            follow()


def test_the_heights_at_which_a_front_has_a_depth_are_all_found():
    """Also those that are among the heights looked at first."""
    front = Front(gf.Crack(level=0.5, ends=(1.0, 0.0)), 6.0, 0.25)
    assert_allclose(front.kinks(), [0.0, 6.0, 4.5])
    assert_allclose(front.open(), [(0.0, 5.0)])


@pytest.mark.slow
def test_a_crack_that_the_load_closes_hardly_matters():
    """Kept apart, faces on the unloaded side change k as the section says; the energy model's forces on them are independent."""
    rack = RACK | {"b": 4.0}
    pair = gf.GearPair(gf.Gear(z=12, x=0.3, r_bore=5.0, **rack), gf.Gear(z=13, x=0.3, r_bore=5.0, **rack))
    lost = {}
    for method in ("ritz", "ritz3d"):
        cracked, healthy = (
            gf.mesh_stiffness(pair, 400.0, STEEL, damage=own, method=method, phases=2)
            for own in ({"pinion": [gf.Crack(level=0.4, side="unloaded")]}, None)
        )
        assert cracked.meta["crack_closed_phases"] == [0.0, 0.5]
        lost[method] = 1 - cracked.k / healthy.k
    assert_allclose(lost["ritz3d"], lost["ritz"], atol=0.003)
    assert lost["ritz3d"].max() > 0.005, "faces slide on each other"


@pytest.mark.parametrize(("ends", "least"), [((0.5, 1.0), 0.5), ((0.8, 0.4), 0.5), ((0.2, 0.6, 0.2), 1 / 3)])
@pytest.mark.parametrize("rounded", [False, True])
def test_the_shallowest_place_is_a_part_of_the_deepest(ends, least, rounded):
    """Depths at the ends, and half-way, are those given, rounded or not."""
    crack = gf.Crack(level=0.5, ends=ends, rounded=rounded)
    assert_allclose([deepest(crack), shallowest(crack)], [max(ends), least], rtol=1e-12)
