"""Quads and hexahedra of whole gears: boundary on the profile, volume, ordering, cracks."""

import math
from dataclasses import replace

import numpy as np
import pytest
from exact_area import section_area
from numpy.testing import assert_allclose
from skfem import Basis, ElementHexS2, MeshHex

import gearfe as gf
from gearfe.flexibility.finite_elements.hexahedron import gauss, shapes, slopes_at
from gearfe.geometry.damage.crack import crack_path
from gearfe.geometry.mesh.quads import Cut, jacobian, quad_section
from gearfe.geometry.mesh.solid import extrude, layers, solid
from gearfe.geometry.tooth.profile import cartesian, flank

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 6.0}
GEAR = gf.Gear(z=12, x=0.3, r_bore=5.0, **RACK)
HELICAL = replace(GEAR, beta=math.radians(20))
RING = gf.Gear(z=26, r_rim=33.0, addendum=0.6, rack_tip_radius=0.2, z_cutter=16, **RACK)
COARSE = {"flank": 0.5, "corner": 0.3, "fillet": 0.4, "root": 0.6, "near": 1.0, "far": 2.0}


def volume(made):
    points, weight = gauss(3)
    return float((slopes_at(made.points[:, made.cells], shapes(points)[1])[1] * weight).sum())


@pytest.fixture(scope="module")
def healthy():
    return solid(HELICAL, layer=1.5, loaded=(0, 1, 11), sizes=COARSE)


def test_a_straight_box_matches_scikit_fems_own_numbers():
    """Vertices and edges of a MeshHex, numbered as scikit-fem numbers its unknowns, take the same shape functions."""
    mesh = MeshHex().refined(1)
    # MeshHex runs from (0, 0, 0) to (1, 1, 1), its reference the other way round: a mirror image until it is turned round
    mesh = MeshHex(mesh.p + 0.05 * np.sin(7 * mesh.p[[1, 2, 0]]), mesh.t[::-1])
    basis = Basis(mesh, ElementHexS2(), intorder=3)
    points = np.hstack([mesh.p, mesh.p[:, mesh.edges].mean(axis=1)])
    cells = np.vstack([mesh.t, mesh.nvertices + mesh.t2e])
    assert_allclose(slopes_at(points[:, cells], shapes(basis.X)[1])[1] * basis.W, basis.dx, rtol=1e-12)
    slopes = np.array([basis.basis[i][0].grad for i in range(20)])
    assert_allclose(slopes_at(points[:, cells], shapes(basis.X)[1])[0].transpose(1, 2, 0, 3), slopes, atol=1e-11)


@pytest.mark.parametrize("gear", [GEAR, RING, gf.Gear(z=12, r_bore=3.0, **RACK)], ids=["gear", "ring", "undercut"])
def test_boundary_lies_on_the_profile(gear):
    section = quad_section(gear, loaded=(0, 2), sizes=COARSE)
    for tooth in (0, 2):
        ends, roll = section.flank[tooth], section.roll[tooth]
        assert gear.outward * np.diff(roll).min() > 0
        turn = 2 * math.pi * tooth / gear.z
        for nodes, at in ((ends[0], roll[:-1]), (ends[1], (roll[1:] + roll[:-1]) / 2), (ends[2], roll[1:])):
            radius, angle = flank(gear, at)
            assert_allclose(section.points[:, nodes], cartesian(radius, angle + turn), atol=1e-12)
        assert_allclose(np.hypot(*section.points[:, ends[[0, 2], [0, -1]]]), [gear.r_form, gear.r_a], rtol=1e-9)
    assert_allclose(np.hypot(*section.points[:, section.held]), gear.held, rtol=1e-12)
    edges = np.sort(section.quads[[[0, 1, 2, 3], [1, 2, 3, 0]]].reshape(2, -1), axis=0)
    alone = np.unique(edges, axis=1, return_counts=True)[1] == 1
    rim = np.unique(edges, axis=1)[:, alone]
    away = np.abs(np.hypot(*section.points[:, rim]) - gear.held).min(axis=0) > 1e-9
    assert (~away).sum() == section.held.shape[1]
    radius = np.hypot(*section.points[:, rim[:, away]])
    assert_allclose([radius.min(), radius.max()], sorted((gear.r_f, gear.r_a)), rtol=1e-9)
    assert jacobian(section).min() > 0


def test_area_converges_to_that_of_the_exact_outline():
    fine, errors = section_area(GEAR), []
    for refine in (1, 4):
        made = extrude(quad_section(GEAR, sizes=COARSE, refine=refine), np.array([0.0, 2.0]), 0.0)
        errors.append(abs(volume(made) / 2 / fine - 1))
    print("area errors", errors)
    assert errors[0] < 1e-3
    assert errors[1] < errors[0] / 5


def test_twist_keeps_the_volume_and_puts_nodes_on_the_helicoid(healthy):
    flat = solid(replace(HELICAL, beta=0.0), layer=1.5, sizes=COARSE)
    section = healthy.section
    straight = extrude(section, healthy.levels, 0.0)
    assert_allclose(volume(healthy), volume(straight), rtol=2e-3)
    assert volume(flat) != pytest.approx(volume(healthy), rel=1e-3), "a helical gear of the same normal module is larger"
    rate = math.tan(HELICAL.beta) / HELICAL.r
    assert HELICAL.twist_rate == pytest.approx(rate)
    nodes = healthy.faces["flank 1"]
    x, y, z = healthy.points[:, nodes]
    back = np.arctan2(x, y) - rate * z - 2 * math.pi / 12
    roll = np.sqrt(x**2 + y**2 - HELICAL.r_b**2)
    assert_allclose(back, flank(HELICAL, roll)[1], atol=1e-12)
    assert set(np.unique(z)) == set(np.unique(np.concatenate([healthy.levels, (healthy.levels[1:] + healthy.levels[:-1]) / 2])))


def test_levels_meet_breaks_and_are_graded():
    levels = layers(20.0, 4.0, breaks=(7.3,), fine=[(20.0, 20.0, 0.5)])
    assert 7.3 in levels
    assert np.diff(levels)[-1] < 0.9 < 2 < np.diff(levels)[0]
    assert levels[[0, -1]].tolist() == [0.0, 20.0]


CRACKS = {
    "straight": (GEAR, (gf.Crack(level=0.3),)),
    "past the middle": (GEAR, (gf.Crack(level=0.6, tooth=1, side="unloaded"),)),
    "turning": (HELICAL, (gf.Crack(level=0.8, turning=True, tooth=-1),)),
    "both sides": (GEAR, (gf.Crack(level=0.2), gf.Crack(level=0.3, side="unloaded"))),
    "ring": (RING, (gf.Crack(level=0.3, start="60deg"),)),
    "two teeth": (GEAR, (gf.Crack(level=0.3), gf.Crack(level=0.3, tooth=1))),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CRACKS)
def test_cracks_open_on_element_faces_without_losing_volume(name):
    gear, cracks = CRACKS[name]
    made = solid(gear, layer=3.0, loaded=(0,), cracks=cracks, sizes=COARSE)
    whole = extrude(made.section, made.levels, gear.twist_rate)
    assert volume(made) == pytest.approx(volume(whole), rel=1e-12)
    assert made.points.shape[1] > whole.points.shape[1]
    used = np.zeros(made.points.shape[1], dtype=bool)
    used[made.cells] = True
    assert used.all(), "no node without an element"
    for number, crack in enumerate(cracks):
        body, tooth = made.faces[f"crack {number} body"], made.faces[f"crack {number} tooth"]
        assert_allclose(made.points[:, body], made.points[:, tooth], atol=0)
        for side in (body, tooth):
            sides = np.sort(side[:4], axis=0)
            assert not set(map(tuple, sides.T.tolist())) - faces_once(made), "a crack face belongs to one element only"
        first, last = (made.points[:, body[k]] for k in (0, 1))
        flat = made.points[2, body[0]] == 0.0
        area = np.linalg.norm(last - first, axis=0)[flat].sum()
        length = np.hypot(*np.diff(crack_path(gear, crack), axis=1)).sum()
        assert area == pytest.approx(length, rel=1e-9), "as long as the crack"


def faces_once(made):
    """Faces (sorted corners) that belong to one cell."""
    local = [[0, 1, 4, 2], [0, 2, 6, 3], [0, 3, 5, 1], [2, 4, 7, 6], [1, 5, 7, 4], [3, 6, 7, 5]]
    every = np.sort(np.hstack([made.cells[face] for face in local]), axis=0)
    faces, count = np.unique(every, axis=1, return_counts=True)
    return set(map(tuple, faces[:, count == 1].T.tolist()))


def test_extents_open_what_they_say():
    opened, sizes = {}, COARSE | {"fillet": 0.2, "crack": 0.2}
    for name, extent in {
        "whole": {},
        "part": {"width": (2.0, 4.5)},
        "sloping": {"ends": (1.0, 0.0)},
        "half": {"width": (0.0, 6.0), "ends": (0.5, 0.5)},
    }.items():
        made = solid(GEAR, layer=0.5, cracks=(gf.Crack(level=0.4, **extent),), sizes=sizes)
        body = made.faces["crack 0 body"]
        sides = np.mean(
            [np.linalg.norm(made.points[:, body[i]] - made.points[:, body[j]], axis=0) for i, j in ((1, 0), (2, 3))], axis=0
        )
        opened[name] = (sides * (made.points[2, body[3]] - made.points[2, body[0]])).sum()
        if name == "part":
            assert made.points[2, body].min() == 2.0
            assert made.points[2, body].max() == 4.5
            free = np.flatnonzero(made.points[2, made.faces["crack 0 tooth"]] == 2.0)
            assert np.array_equal(body.ravel()[free], made.faces["crack 0 tooth"].ravel()[free]), "the front is shared"
    assert_allclose(opened["part"], opened["whole"] * 2.5 / 6, rtol=1e-9)
    assert_allclose(opened["half"], opened["whole"] / 2, rtol=1e-9)
    assert_allclose(opened["sloping"], opened["whole"] / 2, rtol=0.03, err_msg="it ends where it is a sixth as deep")


def test_bad_input_is_refused():
    for call, message in (
        (lambda: solid(GEAR, layer=0.0), "layer = 0.0"),
        (lambda: solid(GEAR, layer=1.0, refine=-1.0), "edge lengths must be positive"),
        (lambda: solid(GEAR, layer=1.0, loaded=(0, 12)), "each once"),
        (lambda: solid(GEAR, layer=1.0, cracks=[gf.Crack(level=0.4, width=(2.0, 6.5))]), "beyond the face, which ends at 6 mm"),
        (
            lambda: solid(GEAR, layer=1.0, cracks=[gf.Crack(level=0.4, width=w) for w in ((0, 2), (3, 6))]),
            "only one can be meshed",
        ),
    ):
        with pytest.raises(ValueError, match=message):
            call()


@pytest.mark.parametrize(("z", "bore"), [(5, 0.3), (12, 0.9), (60, 0.9), pytest.param(200, 0.5, marks=pytest.mark.slow)])
@pytest.mark.parametrize("level", [None, 0.3])
def test_hard_gears_mesh(z, bore, level):
    r_f = gf.Gear(z=z, r_bore=0.1, **RACK).r_f
    gear = gf.Gear(z=z, r_bore=bore * r_f, **RACK)
    cracks = () if level is None else (gf.Crack(level=level if bore < 0.8 else 0.1),)
    section = quad_section(gear, cracks=cracks)
    assert jacobian(section).min() > 0
    assert all(isinstance(cut, Cut) for cut in section.cuts)


def test_edges_at_a_cracks_tip_have_their_middle_at_a_quarter():
    """Displacements there go with the root of the distance, which such elements follow."""
    crack = gf.Crack(level=0.4)
    section = quad_section(GEAR, cracks=(crack,), sizes=COARSE)
    tip = np.flatnonzero(np.hypot(*(section.points - crack_path(GEAR, crack)[:, -1:])) < 1e-9)
    starts, ends, middles = section.quads[:4], np.roll(section.quads[:4], -1, axis=0), section.quads[4:]
    for here, other in ((starts, ends), (ends, starts)):
        at = np.isin(here, tip)
        assert at.sum() >= 4
        near, far, half = (section.points[:, nodes[at]] for nodes in (here, other, middles))
        assert_allclose(half, 0.75 * near + 0.25 * far, atol=1e-12)
