"""Root cracks: published reductions, limits and closure."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.geometry.damage.crack import check_apart, crack_path, path_length, start_arc
from gearfe.geometry.damage.front import crack_in_band, open_part
from gearfe.geometry.mesh.outline import stations
from gearfe.geometry.mesh.section_mesh import section
from gearfe.geometry.tooth.profile import cartesian, root_curve
from validation.shared import reference
from validation.shared.arbiter.cracks import crack_corners
from validation.shared.arbiter.outline import Outline
from validation.shared.arbiter.side import Side

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "beta": math.radians(16), "b": 1.0}
PAIR = gf.GearPair(gf.Gear(z=18, r_bore=9.0, **RACK), gf.Gear(z=27, r_bore=12.0, **RACK))
stiffness = partial(gf.mesh_stiffness, face="spur")  # transverse sections
TABLE = reference.load()["crack"]


def reduction(crack, side="pinion", **options):
    """Relative loss of k over the whole engagement of the cracked tooth."""
    run = {"span": "tooth", "phases": 32} | options
    healthy = stiffness(PAIR, 127.0, STEEL, **run)
    cracked = stiffness(PAIR, 127.0, STEEL, damage={side: [crack]}, **run)
    return 1 - cracked.k / healthy.k, cracked


@pytest.mark.parametrize("method", ["fe", "ritz"])
@pytest.mark.parametrize(
    "row",
    [
        pytest.param(row, id=f"{row['z']} {row['level']}", marks=pytest.mark.slow if i else ())
        for i, row in enumerate(TABLE["rows"])
    ],
)
def test_reductions_of_an_earlier_study(row, method):
    assert_allclose(100 * reference.crack_reduction(row, method), row["value"], atol=TABLE["tolerance"], err_msg=TABLE["source"])


@pytest.mark.parametrize("turning", [False, True])
def test_level_is_spelled_out(turning):
    gear = PAIR.gear_1
    half = crack_path(gear, gf.Crack(level=0.5, turning=turning))
    assert_allclose(half[0, -1], 0, atol=1e-12, err_msg="50 % reaches the centre-line")
    quarter = crack_path(gear, gf.Crack(level=0.25, turning=turning))
    assert_allclose(np.linalg.norm(np.diff(quarter)) * 2, np.linalg.norm(np.diff(half)), rtol=1e-12)
    assert_allclose(np.degrees(np.arctan2(*-np.diff(half)[:, 0])), 45, rtol=1e-12)
    start = cartesian(*root_curve(gear, start_arc(gear, gf.Crack(level=0.3))))
    assert_allclose(half[:, 0], start)


@pytest.mark.parametrize("start", ["30deg", "60deg", "root", "middle"])
@pytest.mark.parametrize("seed", range(6))
def test_start_is_where_the_tangent_of_the_cut_fillet_has_its_angle(seed, start):
    """Truth: tooth spaces cut by brute force, `validation.shared.arbiter.cutting`; external gears and rings."""
    rng = np.random.default_rng(seed)
    own = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 1.0, "rack_tip_radius": float(rng.uniform(0.1, 0.25))}
    gear = (
        gf.Gear(z=int(rng.integers(40, 130)), x=float(rng.uniform(-0.4, 0.3)), addendum=0.8, r_rim=150.0, **own)
        if seed % 2
        else gf.Gear(z=int(rng.integers(20, 90)), x=float(rng.uniform(-0.2, 0.5)), r_bore=5.0, **own)
    )
    crack = gf.Crack(level=0.3, start=start)
    corners = crack_corners(Side(Outline(gear)), crack)
    path = crack_path(gear, crack)
    assert_allclose(path[:, 0], corners[:, 0], atol=1e-3 * gear.m_n)
    along = np.diff(corners)[:, 0]
    assert_allclose(np.diff(path)[:, 0] / path_length(gear, crack), along / np.hypot(*along), atol=1e-12)


def test_a_ring_without_the_tangent_names_the_other_starts():
    ring = gf.Gear(z=50, m_n=2.0, alpha_n=math.radians(20), b=1.0, x=0.8, addendum=0.8, rack_tip_radius=0.2, r_rim=65.0)
    with pytest.raises(ValueError, match=r"make 3\d\.\d to 9\d\.\d degrees .* use start = '60deg', 'root', 'middle'"):
        crack_path(ring, gf.Crack(level=0.3))
    assert crack_path(ring, gf.Crack(level=0.3, start="60deg"))[0, 0] > 0


def test_turning_crack_heads_for_the_opposite_fillet():
    path = crack_path(PAIR.gear_1, gf.Crack(level=0.8, turning=True))
    assert path.shape == (2, 3)
    assert_allclose((path[:, 2] - path[:, 1]) / 0.6 + path[:, 1], path[:, 0] * [-1, 1], rtol=1e-12)


def test_unloaded_side_is_the_mirror_image():
    one, two = (crack_path(PAIR.gear_1, gf.Crack(level=0.4, side=s)) for s in ("loaded", "unloaded"))
    assert_allclose(one * [[-1], [1]], two)


@pytest.mark.parametrize("side", ["loaded", "unloaded"])
def test_seam_has_two_faces_and_one_tip(side):
    gear = PAIR.gear_1
    sizes = {"fillet_size": 0.2, "size": 0.8, "far_size": 1.8}
    crack = gf.Crack(level=0.3, side=side)
    mesh = section(gear, {0: stations(gear, 0.2)}, **sizes, cracks=[crack])
    left, right = mesh.seams[0].faces
    points = mesh.mesh.doflocs
    assert_allclose(points[:, left[[0, -1]]], crack_path(gear, crack), atol=1e-9)
    assert_allclose(points[:, left], points[:, right], atol=1e-12)
    assert left[-1] == right[-1]
    assert not set(left[:-1]) & set(right[:-1])
    tip, quarter, end = points[:, left[-1]], points[:, left[-2]], points[:, left[-3]]
    assert_allclose(quarter, 0.75 * tip + 0.25 * end, rtol=1e-12)
    used = np.unique(mesh.mesh.t)
    assert used.size == mesh.mesh.nvertices, "no vertex is left without a triangle"


def test_a_crack_never_stiffens_and_deeper_is_never_stiffer():
    losses = [reduction(gf.Crack(level=level))[0] for level in (0.02, 0.1, 0.3, 0.6, 0.8)]
    assert (losses[0] > -2e-4).all()
    for shallow, deep in zip(losses[:-1], losses[1:], strict=True):
        assert (deep > shallow - 2e-4).all()
    assert losses[0].max() < 0.01, "a tiny crack is nearly healthy"


def test_faces_do_not_pass_through_each_other():
    """On the unloaded side the load presses the faces together: kept apart, the tooth is nearly healthy."""
    loss, curve = reduction(gf.Crack(level=0.4, side="unloaded"))
    assert curve.meta["crack_closed_phases"]
    assert 0 < loss.max() < 0.1
    opened, curve = reduction(gf.Crack(level=0.4))
    assert opened.max() > 0.2
    closed = np.array(curve.meta["crack_closed_phases"])
    assert ((closed < 0.05) | (closed > PAIR.eps_alpha - 0.05)).all(), "only a neighbour's load closes it"


def test_wheel_crack_equals_pinion_crack_of_the_swapped_pair():
    swapped, phase, crack = gf.GearPair(PAIR.gear_2, PAIR.gear_1), np.arange(-8, 57) / 32, [gf.Crack(level=0.4)]
    mirrored = stiffness(swapped, 127.0, STEEL, damage={"pinion": crack}, phases=PAIR.eps_alpha - phase, extended=False)
    direct = stiffness(PAIR, 127.0, STEEL, damage={"wheel": crack}, phases=phase, extended=False)
    assert_allclose(direct.k, mirrored.k, rtol=1e-9)
    assert (direct.k < 0.9 * stiffness(PAIR, 127.0, STEEL, phases=phase, extended=False).k).any()


@pytest.mark.parametrize(("side", "z"), [("pinion", 18), ("wheel", 27)])
def test_a_cracked_tooth_comes_round_again(side, z):
    damage = {side: [gf.Crack(level=0.4)]}
    phase = np.array([0.1, 0.5, 0.9])
    first = stiffness(PAIR, 127.0, STEEL, phases=phase, damage=damage)
    later = stiffness(PAIR, 127.0, STEEL, phases=phase + z, damage=damage)
    assert_allclose(later.k, first.k, rtol=1e-9)
    renamed = stiffness(PAIR, 127.0, STEEL, phases=phase, damage={side: [gf.Crack(level=0.4, tooth=z)]})
    assert_allclose(renamed.k, first.k, rtol=1e-9)
    assert renamed.meta["damage"][side][0]["tooth"] == z


def test_cracks_on_both_sides_of_the_numbering_seam():
    damage = {"pinion": [gf.Crack(level=0.4), gf.Crack(level=0.4, tooth=17)]}
    same = {"pinion": [gf.Crack(level=0.4), gf.Crack(level=0.4, tooth=-1)]}
    one, two = (stiffness(PAIR, 127.0, STEEL, phases=[0.3, 0.7], damage=d) for d in (damage, same))
    assert_allclose(one.k, two.k, rtol=1e-9)


def test_a_bare_crack_is_a_list_of_one():
    listed = stiffness(PAIR, 127.0, STEEL, phases=[0.3], damage={"pinion": [gf.Crack(level=0.4)]})
    bare = stiffness(PAIR, 127.0, STEEL, phases=[0.3], damage={"pinion": gf.Crack(level=0.4)})
    assert bare.k == listed.k


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        ({"sun": [gf.Crack(level=0.3)]}, "'pinion' and 'wheel'"),
        ({"pinion": [0.3]}, "= 0.3, but give a Crack, a Pit"),
        ({"pinion": [gf.Crack(length=30.0)]}, "sector|held edge"),
        ({"pinion": [gf.Crack(level=0.3), gf.Crack(level=0.1)]}, "two cracks on the loaded side"),
        ({"pinion": [gf.Crack(level=0.5), gf.Crack(level=0.5, side="unloaded")]}, "two cracks of tooth 0 meet"),
    ],
)
def test_bad_damage(damage, message):
    with pytest.raises(ValueError, match=message):
        stiffness(PAIR, 127.0, STEEL, damage=damage, phases=[0.3])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"width": (3.0, 2.0)}, "from a height z >= 0 to a greater one"),
        ({"width": (-1.0, 2.0)}, "from a height z >= 0 to a greater one"),
        ({"width": (0.0, math.nan)}, "two finite numbers"),
        ({"width": 3.0}, "two finite numbers"),
        ({"width": (0.0, 1.0, 2.0)}, "two finite numbers"),
        ({"ends": (0.0, 0.0)}, "not all 0"),
        ({"ends": (0.5, 1.2)}, "from 0 to 1"),
        ({"ends": (-0.1, 1.0)}, "from 0 to 1"),
    ],
)
def test_impossible_widths_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        gf.Crack(level=0.3, **options)


def test_cracks_beyond_the_face_are_refused():
    with pytest.raises(ValueError, match=r"width = \(0\.5, 1\.5\) mm: the crack opens beyond the face, which ends at 1 mm"):
        stiffness(PAIR, 127.0, STEEL, damage={"wheel": [gf.Crack(level=0.3, width=(0.5, 1.5))]})
    with pytest.raises(ValueError, match="only cracks through the whole width"):
        gf.stress_intensity(PAIR.gear_1, gf.Crack(level=0.3, width=(0.0, 0.5)), 18.5, 100.0, STEEL)


def test_two_cracks_of_one_side_lie_beside_each_other():
    gear = replace(PAIR.gear_1, b=10.0)
    check_apart(gear, [gf.Crack(level=level, width=width) for level, width in ((0.3, (0, 4)), (0.6, (4, 10)))])
    with pytest.raises(ValueError, match="give one"):
        check_apart(gear, [gf.Crack(level=level, width=width) for level, width in ((0.3, (0, 4)), (0.6, (3, 10)))])


def test_bands_see_their_part_of_a_crack_from_their_own_end():
    """Halves of 30 mm with a groove of 6 mm; the second one is seen from z = 30."""
    sloping = gf.Crack(level=0.6, width=(6.0, 24.0), ends=(1.0, 0.4))
    for first, last, sense in ((0.0, 12.0, 1), (30.0, 18.0, -1)):
        seen = crack_in_band(sloping, 30.0, first, last)
        assert seen.width == (6.0, 12.0)
        z = np.linspace(0, 12, 49)
        assert_allclose(open_part(seen, 12.0, z), open_part(sloping, 30.0, first + sense * z), atol=1e-12)
    half = gf.Crack(level=0.6, width=(0.0, 12.0))
    assert crack_in_band(half, 30.0, 0.0, 12.0) == gf.Crack(level=0.6), "open over all of the band"
    assert crack_in_band(half, 30.0, 30.0, 18.0) is None
    assert crack_in_band(gf.Crack(level=0.6), 30.0, 30.0, 18.0) == gf.Crack(level=0.6)
    out = crack_in_band(gf.Crack(level=0.6, ends=(1.0, 0.0)), 30.0, 30.0, 18.0)
    assert (out.width, out.ends) == (None, (0.0, 0.4))
    arc = gf.Crack(level=0.6, ends=(0.3, 0.7, 0.5), rounded=True)
    assert crack_in_band(arc, 30.0, 30.0, 0.0) == replace(arc, ends=(0.5, 0.7, 0.3)), "the whole face: exactly"
