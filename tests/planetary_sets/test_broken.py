"""Missing teeth and chips in sets, beside finite elements without the tooth, isolated pairs, and other positions."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sets import STEEL, case, unequal
from test_cracked import GEARS, direct, ours, with_faces

import gearfe as gf
from gearfe.comparison.told_set import spread, told_set
from gearfe.geometry.tooth.profile import cartesian, fillet_length, flank, root_curve
from gearfe.planetary_sets.cracked import cracked_teeth, faces_of
from gearfe.planetary_sets.loaded_gears import drawable, touching
from gearfe.planetary_sets.shape import loaded_shapes
from gearfe.planetary_sets.solve import planetary_stiffness
from gearfe.planetary_sets.whole_gear import between_teeth, whole_gear

GAP = np.array([-0.6, -0.25, 0.1, 0.45])  # positions at which tooth 1 would be in mesh


@pytest.mark.slow
@pytest.mark.parametrize("gear", GEARS, ids=["sun", "ring"])
def test_other_teeth_yield_as_those_of_a_gear_drawn_without_the_tooth(gear, monkeypatch):
    teeth, broken = (1, 2, 4, gear.z - 1), (gf.MissingTooth(tooth=0),)
    whole = whole_gear(gear, STEEL)
    faces = faces_of(whole, cracked_teeth(whole, broken, 1.0), whole.held_inverse())
    ((want, _),), _, _ = direct(gear, (), teeth, monkeypatch, broken=broken)
    ((drawn, _),), _, _ = direct(gear, (), teeth, monkeypatch)
    healthy = ours(gear, between_teeth(whole.held()), teeth)
    changed = with_faces(gear, between_teeth(whole.held()), faces, teeth)[0] - healthy
    expected, away = want - drawn, ~np.eye(4, dtype=bool)
    assert_allclose(changed[away], expected[away], atol=0.02 * abs(expected).max())
    assert abs(expected[away]).max() > 0.01 * abs(want[away]).max()


@pytest.mark.parametrize("damage", [gf.MissingTooth(tooth=1), gf.Chip(depth=0.5, tooth=1)])
def test_uncoupled_meshes_are_those_of_isolated_pairs(damage):
    given = unequal(0, damage={"sun": [damage]})
    found = planetary_stiffness(given, GAP, coupled=False, error=False)
    pair = given.pairs[0]
    alone = gf.mesh_stiffness(pair, given.force, STEEL, damage={"pinion": [damage]}, phases=GAP, method="ritz", extended=True)
    assert_allclose(found.k[0, :, 0], alone.k, rtol=2e-4)
    assert_allclose(found.k_alone[0, :, 0], alone.k, rtol=1e-9)


@pytest.mark.parametrize(("name", "cycles"), [("sun", 1), ("planet2", 0), ("ring", 0)])
def test_tooth_n_is_tooth_0_so_many_cycles_before(name, cycles):
    """In every mesh of that gear; the sun's tooth n is in mesh with planet 1 n cycles before tooth 0."""
    at = np.arange(-2, 2, 0.5) + 0.2
    for damage in (gf.MissingTooth, lambda tooth: gf.Chip(depth=0.4, tooth=tooth)):
        z = getattr(case().gears, "planet" if cycles == 0 and name != "ring" else name).z
        first, same = (planetary_stiffness(case(damage={name: [damage(tooth=n)]}), at, error=False) for n in (2, 2 + z))
        assert_allclose(same.k, first.k, rtol=1e-12)
        if cycles:
            later = planetary_stiffness(case(damage={name: [damage(tooth=5)]}), at - 3, error=False)
            assert_allclose(later.k[:, :, 0], first.k[:, :, 0], rtol=2e-3)


def test_a_missing_tooth_leaves_its_load_to_the_other_planets():
    """The torque stays in balance; with a floating sun all planets carry the same load, and the sun moves."""
    damage = {"sun": [gf.MissingTooth(tooth=1)]}
    held, floating = (planetary_stiffness(case(damage=damage, floating=way), GAP, error=False) for way in (False, True))
    for found in (held, floating):
        assert_allclose(found.force[0].sum(axis=1), 6000.0, rtol=1e-9)
        assert_allclose(found.force[0], found.force[1], rtol=1e-6, atol=1e-3)
    assert held.force[0, :, 0].min() == 0.0
    assert held.k[0, held.force[0, :, 0] == 0.0, 0].max() == 0.0
    assert_allclose(floating.force, 2000.0, rtol=1e-9)
    assert np.hypot(*floating.orbit.T).max() > 0.4 * floating.gap.max() > 5e-6


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        ([gf.MissingTooth(), gf.Crack(level=0.3)], "tooth 0 of z = 21 is missing and has a crack"),
        ([gf.MissingTooth(), gf.MissingTooth(tooth=1)], "only one of two adjacent teeth may be missing"),
        ([gf.Chip(depth=9.0)], "depth = 9 mm: the chip leaves less than"),
        ([gf.Spall(z=10.0, radius=21.0, sides=(1.0, 2.0), depth=0.1)], "is no Crack nor a MissingTooth nor a Chip"),
    ],
)
def test_what_a_section_lacks_is_named(damage, message):
    with pytest.raises(ValueError, match=message):
        case(damage={"sun": damage})


def test_chips_need_sharp_tips():
    with pytest.raises(ValueError, match="leave out the tip edges of 'sun', or its chips"):
        case(damage={"sun": [gf.Chip(depth=0.4)]}, flanks={"sun": gf.Flank(tip_rounding=0.1)})


def test_faces_of_a_crack_and_a_missing_tooth_of_one_gear():
    """Both changes act together: far apart their effects on the sun's mesh add."""
    at = [0.3]
    k = {
        name: planetary_stiffness(case(damage={"sun": list(own)}), at, error=False).k[0, 0, 0]
        for name, own in {
            "none": (), "both": (gf.MissingTooth(tooth=9), gf.Crack(level=0.4, tooth=0)),
            "missing": (gf.MissingTooth(tooth=9),), "crack": (gf.Crack(level=0.4, tooth=0),),
        }.items()
    }  # fmt: skip
    soft = {name: 1 / value for name, value in k.items()}
    assert math.isclose(soft["both"] - soft["none"], soft["missing"] + soft["crack"] - 2 * soft["none"], rel_tol=1e-2)


@pytest.mark.parametrize(
    ("name", "side"), [("sun", "loaded"), ("planet2", "loaded"), ("planet3", "unloaded"), ("ring", "loaded")]
)
def test_default_positions_are_those_in_which_the_damaged_tooth_passes(name, side):
    """Any tooth loses what tooth 0 loses, as the verb and the sweep see it; they saw two cycles of tooth 0."""
    lost = {}
    for tooth in (0, 19):
        given = case(damage={name: [gf.Crack(level=0.6, tooth=tooth, side=side)]})
        at = spread(given, 5)
        hurt, plain = (planetary_stiffness(one, at, error=False).k for one in (given, case()))
        lost[tooth] = (1 - hurt / plain).max()
    assert min(lost.values()) > 0.05
    assert_allclose(list(lost.values()), lost[0], rtol=5e-3)
    assert f"tooth 19 of {name}: " in told_set(given)


PICTURED = {"sun": [gf.MissingTooth(tooth=1)], "planet1": [gf.Chip(depth=0.8, tooth=2)], "ring": [gf.Chip(depth=0.5, tooth=30)]}


@pytest.mark.slow
def test_pictures_have_the_broken_teeth_and_all_loads():
    """Areas of the drawn gears are the healthy ones less polygons of what is lost; pairs of teeth have the load of their mesh."""
    found = planetary_stiffness(case(damage=PICTURED), GAP, error=False)
    whole = planetary_stiffness(case(), GAP, error=False)
    ((hurt, _),), ((healthy, _),) = (loaded_shapes(curves, [1]) for curves in (found, whole))
    gears = found.meta["case"].gears
    lost = [_tooth_area(gears.sun), _chip_area(gears.planet, PICTURED["planet1"][0]), 0.0, 0.0]
    lost += [_chip_area(found.meta["case"].ring_gear, PICTURED["ring"][0])]
    areas = [[_area(shape) for shape in shapes] for shapes in (healthy, hurt)]
    assert_allclose(np.subtract(*areas), lost, rtol=5e-3, atol=0.01)  # edges are parabolas
    assert found.force[0, :, 0].min() == 0.0  # a mesh that is open at one of the positions
    for at in range(GAP.size):
        made, stand = drawable(found, at)
        loads = np.zeros((2, made.planets))
        for pinion, wheel in touching(made, stand, found, at):
            assert pinion["force"] == wheel["force"]
            outer = pinion["body"] == 0
            loads[0 if outer else 1, (wheel if outer else pinion)["body"] - 1] += pinion["force"] * made.width
        assert_allclose(loads, found.force[:, at], rtol=1e-6, atol=1e-3)


def _area(shape):
    """Area of second-order triangles [mm2]: corners, and a parabolic segment on each edge."""
    a, b, c, *middles = shape.place[:, shape.triangles].transpose(1, 0, 2)
    whole = _cross(b - a, c - a) / 2
    for start, stop, middle in zip((a, b, c), (b, c, a), middles, strict=True):
        whole = whole - 2 / 3 * _cross(stop - start, middle - (start + stop) / 2)
    return float(abs(whole).sum())


def _cross(u, v):
    return u[0] * v[1] - u[1] * v[0]


def _tooth_area(gear):
    """Area above the root circle [mm2], from the flank's and the fillet's polar coordinates."""
    pieces = flank(gear, np.linspace(gear.roll_a, gear.roll_f, 400)), root_curve(gear, np.linspace(fillet_length(gear), 0.0, 400))
    radius, angle = np.hstack(pieces)
    tip = (gear.r_a**2 - gear.r_f**2) * angle[0]
    return tip + float(np.trapezoid(radius**2 - gear.r_f**2, angle))


def _chip_area(gear, chip):
    """Area of the polygon of the cut, the tip circle and the flank [mm2]."""
    roll, where, end = chip.cut(gear)
    assert where == "tip"
    arc = cartesian(gear.r_a, np.linspace(end, gear.half_thickness(gear.r_a), 200))
    side = cartesian(*flank(gear, np.linspace(gear.roll_a, roll, 200)))
    x, y = np.hstack([arc, side])
    return float(abs(x @ np.roll(y, 1) - y @ np.roll(x, 1)) / 2)
