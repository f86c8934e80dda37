"""Pairs of finite width: contact lines, load sharing along them, and limits in which the stiffness is known."""

import math
from dataclasses import replace

import numpy as np
import pytest
from checks import line_kernel
from numpy.testing import assert_allclose
from usual import BETA, STEEL
from usual import pair_18_27 as pair_of

import gearfe as gf
from gearfe.contact import bodies as bodies3d
from gearfe.contact.cell_sharing import SharedLines
from gearfe.contact.cells import cells_of
from gearfe.contact.joined_lines import System
from gearfe.contact.pieces import pieces_of
from gearfe.contact.sharing import share
from gearfe.flexibility import halfspace
from gearfe.flexibility.energy.ritz.solid import flexibility3d
from gearfe.flexibility.hertz import half_width
from gearfe.geometry.tooth.profile import cartesian, flank
from validation.shared.solid_pair import solid_contact

RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
RING = gf.Gear(z=72, r_rim=90.0, b=12.0, beta=BETA, rack_tip_radius=0.3, addendum=0.85, **RACK)


def surface(gear, roll, z):
    """Points ``(3, n)`` of the loaded flank in space: the section turned clockwise."""
    radius, angle = flank(gear, roll)
    return np.vstack([cartesian(radius, angle + math.tan(gear.beta) / gear.r * z), np.broadcast_to(z, np.shape(radius))])


@pytest.mark.parametrize("face", ["pinion", "wheel", "ring"])
def test_contact_lines_are_straight_with_one_normal(face):
    """In space the cells of a line lie on a straight line of the plane of action, as long as the depth over cos(beta_b)."""
    pair = pair_of(20.0)
    if face == "ring":
        pair = gf.GearPair(replace(pair.gear_1, b=20.0), replace(RING, b=20.0))
    found = pieces_of(pair, [1.2], ((), ()), [(0.0, 20.0)], pair.gear_1.beta_b)[0]
    cells = cells_of(pair, [found], [(0.0, 20.0)], math.tan(pair.gear_1.beta_b), [(0.1, 0.5)])[0]
    gear = bodies3d.seen_gears(pair, "helical", 0.0)[face != "pinion"][0]
    roll = cells.roll_1 if face == "pinion" else cells.roll_2
    for number in np.unique(cells.order):
        own = cells.order == number
        depth = cells.depth[own]
        points = surface(gear, roll[own], depth)
        if own.sum() > 2:
            ahead = np.diff(points, axis=1) / np.diff(depth)
            assert_allclose(ahead, ahead[:, :1] * np.ones(ahead.shape[1]), atol=1e-9)
            assert_allclose(np.linalg.norm(ahead, axis=0), 1 / math.cos(gear.beta_b), rtol=1e-9)


@pytest.mark.slow
def test_mirrored_pair_is_as_stiff():
    run = {"order": 2, "axial": 6}
    pits = [gf.Pit(radius=18.7, z=3.0, axes=(1.0, 1.5), depth=0.1, angle=0.3)]
    one = solid_contact(pair_of(), 1500.0, STEEL, 4, pits=(pits, ()), **run)
    pits = [replace(pits[0], z=9.0, angle=-0.3)]
    two = solid_contact(pair_of(beta=-BETA), 1500.0, STEEL, 4, pits=(pits, ()), **run)
    assert_allclose(one.k, two.k, rtol=1e-9)
    assert_allclose(one.cells[1].z, 12.0 - two.cells[1].z, atol=1e-9)


@pytest.mark.slow
def test_no_helix_is_the_limit_of_a_small_one():
    run = {"order": 2, "axial": 6, "phases": np.array([0.1, 0.25, 0.7, 0.9])}
    spur = solid_contact(pair_of(beta=0.0), 1500.0, STEEL, face="spur", **run)
    slight = solid_contact(pair_of(beta=math.radians(0.01)), 1500.0, STEEL, **run)
    assert_allclose(slight.k, spur.k, rtol=1e-4)


@pytest.mark.parametrize(
    "line_load", [pytest.param(20.0, marks=pytest.mark.slow), 150.0, pytest.param(600.0, marks=pytest.mark.slow)]
)
def test_corner_contact_of_a_wide_spur_pair_is_that_of_the_plane(line_load):
    """At the ends of the path and beyond them, where a tip corner carries up to all of the load; elsewhere, too."""
    pair = pair_of(400.0, 0.0)
    phases = np.array([-0.02, 0.0, 0.01, 0.3, 0.57, 0.58, 0.6, 0.62, 0.8])
    force = 400.0 * line_load
    plane, without = (gf.mesh_stiffness(pair, force, STEEL, phases=phases, extended=e, method="ritz").k for e in (True, False))
    solid = solid_contact(pair, force, STEEL, phases, face="spur", axial=0, step=20.0)
    print(np.round(100 * (solid.k / plane - 1), 2), np.round(100 * (plane / without - 1), 1))
    assert_allclose(solid.k, plane, rtol=4e-3)
    assert (plane / without).max() > 1.02
    if line_load > 100.0:
        touching = [set(own.corner[own.load > 0].tolist()) for own in solid.cells]
        assert {1, 2} <= set().union(*touching), "both gears' corners are seen"


def test_corner_contact_of_a_ring_and_of_two_materials_is_that_of_the_plane():
    rack, materials = RACK | {"b": 400.0}, (STEEL, gf.Material(E=110e3, nu=0.25))
    planet = gf.Gear(z=27, r_bore=12.0, **rack)
    pair = gf.GearPair(planet, gf.Gear(z=72, r_rim=90.0, addendum=0.8, rack_tip_radius=0.2, **rack))
    leaves = pair.eps_alpha - 1
    phases = np.array([-0.02, 0.0, 0.4, leaves, leaves + 0.02, leaves + 0.05])
    plane, without = (gf.mesh_stiffness(pair, 6e4, materials, phases=phases, extended=e, method="ritz").k for e in (True, False))
    solid = solid_contact(pair, 6e4, materials, phases, face="spur", axial=0, step=20.0)
    assert (plane > 1.2 * without).any()
    assert_allclose(solid.k, plane, rtol=5e-3)


@pytest.mark.slow
def test_helical_contact_goes_on_beyond_the_path():
    """Lines end where the gap is the approach, loads stay positive, and more contact is stiffer."""
    pair, phases = pair_of(20.0), np.linspace(0, 1, 5)[:-1]
    run = {"order": 2, "axial": 8}
    inside, beyond = (solid_contact(pair, 3000.0, STEEL, phases, extended=e, **run) for e in (False, True))
    assert (beyond.k > 1.003 * inside.k).all()
    assert (beyond.k > 1.02 * inside.k).any()
    fine = solid_contact(pair, 3000.0, STEEL, phases, step=0.15, **run)
    assert_allclose(beyond.k, fine.k, rtol=2e-3)
    for own, approach in zip(beyond.cells, beyond.approach, strict=True):
        assert (own.gap[own.load > 0] < approach).all()
        assert ((own.gap == 0) == (own.corner == 0)).all()
        assert own.load[own.corner > 0].sum() > 0.005 * own.load.sum()


def test_loads_satisfy_the_contact_conditions():
    """Hard random cases: every cell that carries closes by the approach, every other stays open; and as `share` would."""
    for seed in range(60):
        rng = np.random.default_rng(seed)
        n = int(rng.integers(2, 40))
        edge = np.cumsum(rng.uniform(0.05, 1.0, n + 1))
        line = np.sort(rng.integers(0, 3, n))
        root = rng.standard_normal((n, 5))
        matrix = 10 ** rng.uniform(-7, -5) * root @ root.T
        gap = 10 ** rng.uniform(-4, -1) * rng.random(n)
        load, radius, modulus, k = n * 10 ** rng.uniform(-2, 4), rng.uniform(1, 10, n), 1.1e5, 2.8e-6
        ends = edge[:-1], edge[1:]
        both = SharedLines([System(matrix, gap, ends, line, radius)], k, modulus)
        force, approach, _ = both.solve(np.array([load]))[0]
        mean = np.maximum(both.joined.smoother(np.array([load])) @ force, 1e-9 * load / np.diff(edge))
        x = np.minimum(halfspace.strip(half_width(mean, radius, modulus)), both.joined.widest)
        total = matrix + k * np.where(line[:, None] == line, line_kernel(*ends, x), 0.0)
        closed = total @ force + gap
        close = (
            1e-5 if (half_width(mean, radius, modulus) < np.diff(edge)).all() else 0.1
        )  # there the strips' widths need not settle
        assert_allclose(force.sum(), load, rtol=1e-9)
        assert (force >= 0).all()
        assert_allclose(closed[force > 0], approach, rtol=close, err_msg=f"seed {seed}")
        assert (closed[force == 0] >= approach * (1 - close)).all()
        assert_allclose(share(total, gap, load)[1], approach, rtol=close)


@pytest.mark.parametrize(
    ("ratio", "printed", "found"), [(5, -0.040, -0.034), pytest.param(20, -0.014, -0.013, marks=pytest.mark.slow)]
)
def test_verdict_on_how_much_plane_strain_is_too_stiff(ratio, printed, found):
    """Away from tip corners, against an earlier study whose pair and load are not stated: found at b/m 20, not at 5 and 10.

    -4.0 and -2.6 % are the gears' own flexibility by hexahedra, without the contact, which the study may have meant. Hexahedra
    composed to a pair give -3.4 and -2.2 % at b/m 5 and 10.
    """
    pair, phase = pair_of(2.0 * ratio, 0.0), np.linspace(0.1, 0.9, 9)
    plane = gf.mesh_stiffness(pair, 400.0 * ratio, STEEL, phases=phase, extended=False, order=6).k
    solid = solid_contact(pair, 400.0 * ratio, STEEL, phase, face="spur", extended=False).k
    print(f"b/m = {ratio}: {100 * (solid.mean() / plane.mean() - 1):.2f} %")
    ours = solid.mean() / plane.mean() - 1
    assert (abs(ours - printed) < 0.002) == (ratio == 20)
    assert_allclose(ours, found, atol=0.001)


@pytest.mark.slow
def test_a_corner_that_meets_its_mate_late_is_cut_into_cells_from_there():
    """The flank of an undercut mate ends before the path: up to there nothing touches, and k hung on one cell (0.7 % off)."""
    rack = {"m_n": 1.0, "alpha_n": math.radians(17.5), "b": 4.5, "rack_tip_radius": 0.2}
    beta = 0.26682
    pinion = gf.Gear(z=12, x=0.3243, r_bore=2.02, beta=beta, **rack)
    pair = gf.GearPair(pinion, gf.Gear(z=13, x=0.003, r_bore=2.29, beta=-beta, **rack))
    k, fine = (solid_contact(pair, 110.4, STEEL, [0.6466, 0.6803], order=2, axial=6, step=step) for step in (0.2, 0.025))
    print(f"off by {k.k / fine.k - 1}; cells at corners {[int((c.corner > 0).sum()) for c in k.cells]}")
    assert all((cells.corner > 0).sum() >= 4 for cells in k.cells)
    assert_allclose(k.k, fine.k, rtol=3e-4)


@pytest.mark.slow
def test_error_estimate_sees_the_length_of_the_cells():
    """Near a tip corner cells err more than the bodies do: the estimate covers what half of them give."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 6.75, "beta": math.radians(8.72), "rack_tip_radius": 0.2}
    ring = gf.Gear(z=32, r_rim=41.8, addendum=0.688, **rack)
    pair = gf.GearPair(gf.Gear(z=12, x=0.197, r_bore=5.73, **rack), ring)
    solved = solid_contact(pair, 496.0, STEEL, [0.049], error=True)
    half = solid_contact(pair, 496.0, STEEL, [0.049], step=0.2)
    print(f"half the cells {half.k / solved.k - 1}, estimated {solved.error / solved.k}")
    assert np.abs(half.k - solved.k)[0] < solved.error[0] < 0.01 * solved.k[0]


def test_problems_solved_together_are_those_solved_alone():
    """With a local law, faces of cracks, floors and two bodies."""
    systems, softer = [], []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        n = int(rng.integers(8, 30))
        edge, line = np.linspace(0, n / 2, n + 1), np.repeat([0, 1], [n // 2, n - n // 2])
        matrix = 1e-6 * (line[:, None] == line) + 1e-8 * np.eye(n)
        opening = np.vstack([np.linspace(-4e-7, 1e-7, n), np.linspace(-1e-7, -5e-7, n)]) * (line == np.array([[0], [1]]))
        faces = (opening, 1e-6 * np.eye(2), np.array([0, 1])) if seed % 2 else None
        floor = np.where(np.arange(n) % 5 == 0, 1e-4 * (seed > 3), 0.0)
        systems.append(
            System(matrix, 1e-4 * rng.random(n) + floor, (edge[:-1], edge[1:]), line, np.full(n, 3.0), line, faces, floor)
        )
        softer.append(np.linspace(0.0, 0.5, n))
    loads = 500.0 + 100.0 * np.arange(6)
    both, whole = SharedLines(systems, 2.8e-6, 1.1e5), np.concatenate(softer)
    found = both.solve(loads, lambda along: whole * np.log1p(along))
    assert any(one.force[-2:].max() > 0 for one in found[1::2]), "a face that would pass through the other is held back"
    for system, load, own, one in zip(systems, loads.tolist(), softer, found, strict=True):
        alone = SharedLines([system], 2.8e-6, 1.1e5).solve(np.array([load]), lambda along, own=own: own * np.log1p(along))[0]
        assert_allclose([one.approach, one.tangent], [alone.approach, alone.tangent], rtol=1e-5)
        assert_allclose(one.force, alone.force, rtol=1e-9, atol=1e-9 * load)


@pytest.mark.parametrize("seed", range(8))
def test_the_tangent_is_that_of_a_little_more_load(seed):
    """The linearisation of what was solved against central differences of solves of the same cells."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(20, 60))
    edge, line = np.cumsum(rng.uniform(0.1, 0.5, n + 1)), np.sort(rng.integers(0, 3, n))
    root = rng.standard_normal((n, 5))
    gap = 1e-3 * np.linspace(-1, 1, n) ** 2
    system = System(1e-6 * root @ root.T, gap, (edge[:-1], edge[1:]), line, rng.uniform(3, 9, n))
    softer, load = rng.uniform(0, 0.3, n), np.array([200.0 * n])
    both, more = SharedLines([system], 2.8e-6, 1.1e5), 1e-3
    one, less, further = (both.solve(load * by, lambda along: softer * np.log(along))[0] for by in (1, 1 - more, 1 + more))
    same = ((one.force > 0) == (less.force > 0)).all() and ((one.force > 0) == (further.force > 0)).all()
    wanted = 2 * more * load[0] / (further.approach - less.approach)
    assert_allclose(one.tangent, wanted, rtol=1e-5 if same else 1e-2)


def test_a_piece_that_vanishes_takes_its_load_with_it():
    """A short piece of line beside a long one: what it carries falls to nothing with its length."""
    edge = np.linspace(0, 10, 26)
    carried = []
    for length in (0.1, 0.01, 0.001):
        ends = np.append(edge[:-1], 12.0), np.append(edge[1:], 12.0 + length)
        line = np.zeros(26, dtype=int)
        system = System(np.full((26, 26), 1e-6), np.zeros(26), ends, line, np.full(26, 3.0))
        force = SharedLines([system], 2.8e-6, 1.1e5).solve(np.array([1500.0]))[0].force
        carried.append(force[-1])
    assert_allclose(np.array(carried[:2]) / carried[1:], 10.0, rtol=0.5)
    assert carried[2] < 1e-3 * 1500.0


def test_teeth_that_bend_far_are_coupled_to_all_that_touch():
    """A thin helical disc bends, so that three pairs touch where the first guess of the approach has two: all know each other."""
    gears = [gf.Gear(z=z, b=2.46, beta=side * math.radians(30), r_bore=11.0 * z / 18, **RACK) for z, side in ((33, -1), (66, 1))]
    pair, run = gf.GearPair(*gears), {"order": 2, "axial": 5}
    found = solid_contact(pair, 246.0, STEEL, [0.75], **run)

    def all_teeth(gear, material, cracks, neighbours):
        return flexibility3d(gear, material, cracks, neighbours=5, **run)

    assert np.ptp(found.cells[0].order) == 2
    assert_allclose(found.k, solid_contact(pair, 246.0, STEEL, [0.75], model=all_teeth).k, rtol=1e-9)
