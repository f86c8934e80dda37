"""Pits as real holes: their volume, cuts that fail, tets, flanks and seams."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

import gearfe as gf
from gearfe.geometry.damage.hollow import centre_arc
from gearfe.geometry.damage.hollow_volume import hollow_frame, removed_volume
from gearfe.geometry.mesh import holes
from gearfe.geometry.mesh.holes import filled, holed_sector
from gearfe.geometry.tooth.profile import cartesian, flank, flank_normal, roll_at_arc, turned

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 6.0}
GEAR = gf.Gear(z=18, r_bore=9.0, **RACK)
RING = gf.Gear(z=40, r_rim=52.0, addendum=0.8, rack_tip_radius=0.2, **RACK)
PIT = {"z": 3.0, "axes": (0.5, 0.8), "depth": 0.2}
COARSE = {"far": 3.0, "tooth": 1.0, "flank": 0.8, "fillet": 0.6, "tip": 0.3}


def pit(gear, **numbers):
    return gf.Pit(**{"radius": gear.r, **PIT} | numbers)


@pytest.mark.parametrize("gear", [GEAR, RING], ids=["gear", "ring"])
@pytest.mark.parametrize("axes", [(0.5, 0.8), (0.9, 0.3)])
def test_volume_by_columns_over_the_tangent_plane(gear, axes):
    """Of a spur gear: width of the ellipse times depth and height of the involute over the tangent plane."""
    one = pit(gear, axes=axes)
    roll = math.sqrt(one.radius**2 - gear.r_b**2)
    middle, normal = cartesian(*flank(gear, roll)), flank_normal(gear, roll)
    tangent = np.array([-normal[1], normal[0]])

    def place(s):
        away = cartesian(*flank(gear, float(roll_at_arc(gear, s)))) - middle
        return away @ tangent, away @ normal

    def column(s):
        (a, h), step = place(s), 1e-5
        width = 2 * axes[1] * math.sqrt(max(1 - (a / axes[0]) ** 2, 0.0))
        return width * (one.depth + h) * abs(place(s + step)[0] - place(s - step)[0]) / (2 * step)

    at = centre_arc(gear, one)
    want = quad(column, at - 1.2 * axes[0], at + 1.2 * axes[0], limit=400, points=[at - axes[0], at, at + axes[0]])[0]
    assert_allclose(removed_volume(gear, [one]), want, rtol=2e-4)


@pytest.mark.parametrize("side", ["loaded", "unloaded"])
@pytest.mark.parametrize("beta", [0.0, 0.3, -0.5])
def test_pits_are_cut_along_the_normal_of_the_helicoid(beta, side):
    gear = replace(GEAR, beta=beta)
    one = pit(gear, side=side)
    sign = 1 if side == "loaded" else -1

    def surface(roll, z):
        xy = cartesian(*flank(gear, roll)) * [sign, 1]
        return turned(np.array([*xy, z]), gear.twist_rate * z)

    roll, step = math.sqrt(one.radius**2 - gear.r_b**2), 1e-5
    along = [surface(roll + a, one.z + b) - surface(roll - a, one.z - b) for a, b in ((step, 0), (0, step))]
    normal = np.cross(*along)
    normal *= np.sign(normal[0] * sign * math.cos(gear.twist_rate * one.z)) / np.linalg.norm(normal)
    centre, _, push, _ = hollow_frame(gear, one)
    ends = [turned(place, gear.twist_rate * place[2]) for place in (centre - step * push, centre + step * push)]
    assert_allclose((ends[1] - ends[0]) / (2 * step), -one.depth * normal, atol=1e-8)


@pytest.mark.parametrize("side", ["loaded", "unloaded"])
@pytest.mark.parametrize("beta", [0.0, 0.3, -0.5])
def test_small_pits_take_their_area_times_their_depth(beta, side):
    gear = replace(GEAR, beta=beta)
    one = pit(gear, axes=(0.05, 0.08), depth=0.1, angle=0.4, side=side)
    area = math.pi * 0.05 * 0.08 / math.cos(gear.beta_b)  # of the flank: dA = ds dz / cos(beta_b)
    assert_allclose(removed_volume(gear, [one]), area * 0.1, rtol=5e-3)


LAYOUTS = {
    "turned": [{"angle": 0.6}],
    "tip edge": [{"radius": GEAR.r_a}],
    "end face": [{"z": 0.0}, {"z": 6.0}],
    "corner": [{"radius": GEAR.r_a - 0.1, "z": 5.8}],
    "overlapping": [{"z": 2.6}, {"z": 3.2, "radius": GEAR.r + 0.4}, {"z": 3.4, "angle": 1.0}],
    "nested": [{}, {"axes": (0.2, 0.3)}],
    "both sides": [{}, {"side": "unloaded", "z": 2.5}],
}


@pytest.mark.parametrize(
    ("name", "beta"),
    [
        pytest.param(
            name,
            -0.2 if name == "both sides" else 0.4,
            marks=pytest.mark.slow if name in ("turned", "nested", "overlapping") else (),
        )
        for name in LAYOUTS
    ],
)
def test_what_is_cut_is_what_the_pits_take(name, beta):
    gear = replace(GEAR, beta=beta)
    scale = gear.r / GEAR.r
    found = [pit(gear, **one | ({"radius": one["radius"] * scale} if "radius" in one else {})) for one in LAYOUTS[name]]
    found = [replace(one, radius=min(one.radius, gear.r_a)) for one in found]
    made = holed_sector(gear, found, teeth=1, sizes=COARSE)
    wanted, cut, meshed = made.removed
    assert_allclose(cut, wanted, rtol=2e-3)
    a, b, c, d = made.points[:, made.cells].transpose(1, 0, 2)
    size = np.einsum("im,im->m", np.cross(b - a, c - a, axis=0), d - a) / 6
    assert size.min() > 0
    assert_allclose(size[made.plug >= 0].sum(), meshed, rtol=5e-3)  # the turn by the helix keeps volumes
    assert 0.88 < meshed / wanted < 1.12
    assert made.faces["pits"].size


def test_the_helix_turns_no_tet_inside_out():
    """This coarse mesh has flat tets that the turn would invert; it is made anew."""
    pair = gf.load_scene("helical_pitting").pair()
    sizes = {"tooth": 0.5, "flank": 0.18, "fillet": 0.22, "rim": 0.3}
    made = holed_sector(pair.pair.gear_1, pair.damage["minor"]["pinion"], refine=0.5, sizes=sizes)
    a, b, c, d = made.points[:, made.cells].transpose(1, 0, 2)
    assert np.einsum("im,im->m", np.cross(b - a, c - a, axis=0), d - a).min() > 0


def test_a_mesh_that_gmsh_cannot_make_is_made_finer(monkeypatch):
    """Pits that touch along a contact line: gmsh found overlapping facets, and with edges 1.07 times shorter it did not."""
    import gmsh

    generate, asked = gmsh.model.mesh.generate, []

    def failing(dimension):
        asked.append(dimension)
        if len(asked) == 1:
            raise Exception("Invalid boundary mesh (overlapping facets)")
        generate(dimension)

    monkeypatch.setattr(gmsh.model.mesh, "generate", failing)
    assert holed_sector(GEAR, [pit(GEAR)], teeth=1, sizes=COARSE).faces["pits"].size
    assert len(asked) == 2
    monkeypatch.setattr(holes, "FINER", (1.0,))
    asked.clear()
    with pytest.raises(RuntimeError, match=r"overlapping facets\); increase refine"):
        holed_sector(GEAR, [pit(GEAR)], teeth=1, sizes=COARSE)


def test_holes_in_a_ring():
    made = holed_sector(RING, [pit(RING)], teeth=1, sizes=COARSE)
    assert_allclose(made.removed[1], made.removed[0], rtol=2e-3)


@pytest.mark.parametrize("fault", ["no cut", "shallow", "moved"])
def test_a_boolean_that_fails_is_caught(fault, monkeypatch):
    """Tools that miss the tooth, are too short or are beside their place: no error of gmsh, but the volume is wrong."""
    tool = holes.tool

    def wrong(gear, one, squeeze):
        ((kind, points),), push = tool(gear, one, squeeze)
        moved = {"no cut": -2 * push, "shallow": 0 * push, "moved": np.array([0.0, 0.02, 0.0])}[fault]
        points = np.column_stack([points[:, 0] + moved, points[:, 1:]])
        return [(kind, points)], (0.9 * push if fault == "shallow" else push)

    found = [pit(GEAR)]
    monkeypatch.setattr(holes, "tool", wrong)
    with pytest.raises(RuntimeError, match=r"should take .* mm\*\*3 from the tooth"):
        holed_sector(GEAR, found, teeth=1, sizes=COARSE)


@pytest.mark.parametrize(
    ("pits", "options", "message"),
    [
        ([{"radius": GEAR.r_form + 0.1}], {}, "below the form circle"),
        ([{}, {"tooth": 1, "z": 1.0}], {}, "one tooth only"),
        ([{"depth": 3.0}], {}, "shallower"),
        ([{"z": 7.0}], {}, "0 <= z <= b"),
        ([{}], {"teeth": 2}, "odd number"),
        ([{}], {"refine": 0.0}, "refine > 0"),
        ([{}], {"crack": 0.3}, "give a Crack"),
    ],
)
def test_what_cannot_be_cut_is_refused(pits, options, message):
    with pytest.raises(ValueError, match=message):
        holed_sector(GEAR, [pit(GEAR, **one) for one in pits], **options)


@cache
def uncut(crack):
    return holed_sector(replace(GEAR, beta=0.3), (), crack, teeth=1, sizes=COARSE)


@pytest.mark.parametrize("crack", [gf.Crack(level=0.3), gf.Crack(level=0.7, turning=True), gf.Crack(level=0.4, side="unloaded")])
def test_cracks_are_seams(crack):
    """Two faces that lie on each other, open at the mouth and shut at the tip; no volume is lost."""
    made, whole = uncut(crack), uncut(None)
    body, tooth = made.faces["crack body"], made.faces["crack tooth"]
    assert_allclose(made.points[:, body], made.points[:, tooth], atol=1e-12)
    assert (body != tooth).any(axis=0).all()
    assert (body == tooth).any(), "the front is one line of nodes"

    def volume(mesh):
        a, b, c, d = mesh.points[:, mesh.cells].transpose(1, 0, 2)
        return np.einsum("im,im->", np.cross(b - a, c - a, axis=0), d - a) / 6

    assert_allclose(volume(made), volume(whole), rtol=5e-3)


def test_filled_holes_leave_a_whole_flank_and_the_crack():
    """Across the pit's rim: the flank's area grows by the pit's opening, the body by the pit's volume, the seam stays."""
    gear = replace(GEAR, beta=0.3)
    made = holed_sector(gear, [pit(gear)], gf.Crack(level=0.3), teeth=1, sizes=COARSE)
    whole = filled(made, teeth=1)

    def area(mesh):
        a, b, c = mesh.points[:, mesh.faces["flank 0"]].transpose(1, 0, 2)
        return np.linalg.norm(np.cross(b - a, c - a, axis=0), axis=0).sum() / 2

    assert (made.plug >= 0).any()
    assert (whole.plug < 0).all()
    assert whole.points is made.points
    assert whole.cells is made.cells
    assert not set(map(tuple, whole.faces["pits"].T.tolist())) & set(map(tuple, made.faces["flank 0"].T.tolist()))
    assert whole.faces["pits"].shape[1] + made.faces["flank 0"].shape[1] == whole.faces["flank 0"].shape[1]
    roll = np.array([gear.roll_f, gear.roll_a])
    straight = np.ptp(roll**2) / (2 * gear.r_b) * gear.b / math.cos(gear.beta_b)  # of the helicoid
    assert_allclose(area(whole), straight, rtol=5e-3)
    assert_allclose(area(whole) - area(made), math.pi * 0.5 * 0.8, rtol=0.12)
    assert whole.faces["crack tooth"] is made.faces["crack tooth"]
    for name in ("held", "end 0", "flank 0"):
        assert holes.skin(whole.cells).shape[1] >= whole.faces[name].shape[1] >= made.faces[name].shape[1]


def test_no_face_of_a_flank_is_lost_near_the_base_circle():
    """Where nodes lie inside of the flank and the involute bends most, a spline that is off it would lose faces of the flank."""
    gear = gf.Gear(z=13, x=0.3, beta=math.radians(15), r_bore=8.0, **RACK)
    assert gear.r_form - gear.r_b < 0.02 * gear.m_n
    made = filled(holed_sector(gear, [pit(gear, radius=13.13, axes=(0.4, 0.4))], teeth=1, sizes=COARSE), teeth=1)
    a, b, c = made.points[:, made.faces["flank 0"]].transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a, axis=0), axis=0).sum() / 2
    whole = (gear.roll_a**2 - gear.roll_f**2) / (2 * gear.r_b) * gear.b / math.cos(gear.beta_b)
    assert_allclose(area, whole, rtol=1e-2)
