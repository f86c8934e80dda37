"""The energy model in three dimensions: its pieces against integrals and identities, the whole against the plane and limits."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe import contact3d, lines3d
from gearfe.contact3d import pair_stiffness3d
from gearfe.energy import halfspace, panel3d, ritz, ritz3d
from gearfe.hertz import half_plane, half_width, hat_logarithm
from gearfe.sharing import share
from geometry.sector import sector
from geometry.tooth import cartesian, flank, flank_normal, roll_at_arc
from geometry.triangle import ENDS

STEEL = gf.Material(E=207e3, nu=0.3)
RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
BETA = math.radians(16)
GEAR = gf.Gear(z=18, r_bore=9.0, b=12.0, beta=BETA, **RACK)
RING = gf.Gear(z=72, r_rim=90.0, b=12.0, beta=BETA, tip_radius=0.3, addendum=0.85, **RACK)


def pair_of(width=12.0, beta=BETA):
    rack = RACK | {"b": width}
    return gf.GearPair(gf.Gear(z=18, r_bore=9.0, beta=beta, **rack), gf.Gear(z=27, r_bore=12.0, beta=-beta, **rack))


def hats_apart(knots, others, u):
    """Integral over s of hat(s) hat'(s - u) for every u, piecewise quadratic."""

    def hat(s, start, top, stop):
        return 2 / (stop - start) * np.maximum(np.minimum((s - start) / (top - start), (stop - s) / (stop - top)), 0.0)

    cuts = np.clip(np.hstack([knots + 0 * u[:, None], others + u[:, None]]), knots[0], knots[2])
    cuts = np.sort(cuts, axis=1)[..., None]
    gauss, weight = leggauss(3)
    s = (cuts[:, :-1] + cuts[:, 1:]) / 2 + np.diff(cuts, axis=1) / 2 * gauss
    return (np.diff(cuts, axis=1) / 2 * weight * hat(s, *knots) * hat(s - u[:, None, None], *others)).sum(axis=(1, 2))


def panels(ends, longest, count):
    """Gauss points and weights on the panels between `ends`, cut to at most `longest`."""
    gauss, weight = leggauss(count)
    ends = np.concatenate([np.linspace(a, b, math.ceil((b - a) / longest) + 1)[:-1] for a, b in pairwise(ends)] + [ends[-1:]])
    half = np.diff(ends)[:, None] / 2
    return ((ends[:-1] + ends[1:])[:, None] / 2 + half * gauss).ravel(), (half * weight).ravel()


@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_patch_kernel_equals_its_integral(slope):
    """The same mean over differences t = z - z' (in ln t) and u = s - s' (in arsinh, which takes up 1 / R)."""
    knots = np.array([[0.0, 0.3, 0.7], [0.5, 1.0, 1.1], [1.2, 1.6, 1.9]]).T
    width, stretch = 5.0, 1.1
    got = halfspace.patch_kernel(knots, width, 3, np.full((3, 3), slope), stretch)
    gauss, weight = leggauss(6)
    for (i, a), (j, b) in [((0, 0), (0, 0)), ((0, 1), (1, 2)), ((2, 3), (0, 3)), ((1, 2), (1, 1))]:
        one, two = knots[:, i], knots[:, j]
        kinks = np.unique(np.subtract.outer(one, two))
        want = 0.0
        logs, steps = panels(np.log([1e-9, 0.3, 1.5, width]), 0.7, 8)
        for t, step in zip(np.exp(logs), np.exp(logs) * steps, strict=True):
            for signed in (t, -t):
                low, high = max(0.0, signed), min(width, width + signed)
                z = (low + high) / 2 + (high - low) / 2 * gauss
                both = halfspace.modes(z, width, 3)[:, a] * halfspace.modes(z - signed, width, 3)[:, b]
                x, dx = panels(np.arcsinh((kinks - slope * signed) / (stretch * t)), 1.0, 8)
                across = hats_apart(one, two, slope * signed + stretch * t * np.sinh(x)) @ dx
                want += step * (high - low) / 2 * (weight @ both) * across
        assert_allclose(got[i, a, j, b], want, rtol=1e-6, atol=1e-7 * got[i, 0, i, 0])


def test_far_and_near_kernels_agree():
    knots = np.array([[0.0, 0.3, 0.7], [0.5, 1.0, 1.1]]).T
    c = halfspace.FAR * 0.7 * np.array([1 - 1e-9, 1 + 1e-9])
    near, far = np.moveaxis(halfspace.hat_distance(knots, np.full((2, 2, 2), 0.4), c), 2, 0)
    assert_allclose(near, far, rtol=1e-7)


def test_long_line_is_the_plane_law():
    """Displacement in the middle of an even line load: ``2 ln(2 L) + 2 (ln(2 / a) + 1/2)``, L its half length."""
    a, reach = 0.05, 400.0
    for count in (2001, 801):
        edge = np.linspace(-reach, reach, count + 1)
        kernel = halfspace.line_kernel(edge[:-1], edge[1:], halfspace.strip(np.full(count, a)))
        got = (kernel @ np.diff(edge))[count // 2]
        assert_allclose(got, 2 * math.log(2 * reach) + 2 * (math.log(2 / a) + 0.5), rtol=1e-6)


def surface(gear, roll, z):
    """Points ``(3, n)`` of the loaded flank in space: the section turned clockwise."""
    radius, angle = flank(gear, roll)
    return np.vstack([cartesian(radius, angle + math.tan(gear.beta) / gear.r * z), np.broadcast_to(z, np.shape(radius))])


@pytest.mark.parametrize("gear", [GEAR, replace(GEAR, beta=-BETA), RING], ids=["right", "left", "ring"])
def test_loads_act_at_right_angles_to_the_helicoid(gear):
    order = 3
    made = sector(gear, sizes=ritz3d.SIZES)
    _, count, chain = panel3d._numbering(made, order)
    force = panel3d._hats(gear, made, chain, count, ritz3d._knots(gear), order).sum(axis=0)
    points, weight = halfspace.hat_points(ritz3d._knots(gear), 12)
    for i, (arc, share_of) in enumerate(zip(points, weight, strict=True)):
        roll, h = roll_at_arc(gear, arc), 1e-5
        along = (surface(gear, roll + h, 0.0) - surface(gear, roll - h, 0.0)) / (2 * h)
        trace = (surface(gear, roll, h) - surface(gear, roll, -h)) / (2 * h)
        normal = np.cross(along, trace, axis=0)
        normal *= np.sign((normal[:2] * flank_normal(gear, roll)).sum(axis=0)) / np.linalg.norm(normal, axis=0)
        assert_allclose(force[:, i], -(normal @ share_of), atol=1e-6)


@pytest.mark.parametrize("face", ["pinion", "wheel", "ring"])
def test_contact_lines_are_straight_with_one_normal(face):
    """In space the cells of a line lie on a straight line of the plane of action, as long as the depth over cos(beta_b)."""
    pair = pair_of(20.0)
    if face == "ring":
        pair = gf.GearPair(replace(pair.gear_1, b=20.0), replace(RING, b=20.0))
    found = lines3d.lines_of(pair, 1.2, ((), ()), [(0.0, 20.0)], pair.gear_1.beta_b)
    cells = lines3d.cells_of(pair, found, [(0.0, 20.0)], math.tan(pair.gear_1.beta_b), 0.5)
    gear = contact3d._gears(pair, "helical", 0.0)[face != "pinion"][0]
    roll = cells.roll_1 if face == "pinion" else cells.roll_2
    for number in np.unique(cells.order):
        own = cells.order == number
        depth = cells.depth[own]
        points = surface(gear, roll[own], depth)
        if own.sum() > 2:
            ahead = np.diff(points, axis=1) / np.diff(depth)
            assert_allclose(ahead, ahead[:, :1] * np.ones(ahead.shape[1]), atol=1e-9)
            assert_allclose(np.linalg.norm(ahead, axis=0), 1 / math.cos(gear.beta_b), rtol=1e-9)


def test_rigid_motions_store_no_energy():
    width, degree, order = 12.0, 8, 2
    coarse = {"flank": 0.8, "corner": 0.8, "kink": 0.8, "fillet": 0.8, "root": 2.0, "side": 2.0}
    made = sector(GEAR, sizes=coarse)
    made = replace(made, bulge={edge: 0 * curve for edge, curve in made.bulge.items()})  # nodes at the middles
    numbers, count, _ = panel3d._numbering(made, order)
    body = panel3d._body(made, numbers, order, np.zeros((count, 3, 1)), np.arange(1), np.zeros(0, dtype=int))
    body.section = panel3d._section(made, order, STEEL, math.tan(BETA) / GEAR.r)
    body.axial = panel3d._axial(width, degree)
    stiffness = panel3d._leaf(body, np.arange(numbers.shape[1]), np.arange(body.first_load))
    straight = np.zeros((2, count))
    straight[:, numbers[:3]] = made.points[:, made.triangles]
    for k, (a, b) in enumerate(ENDS):
        straight[:, numbers[3 + k]] = made.points[:, made.triangles[[a, b]]].mean(axis=1)
    gauss, weight = leggauss(degree + 1)
    z = width * (1 + gauss) / 2
    to_modes = (halfspace.modes(z, width, degree) * (weight * width / 2)[:, None]).T
    angle = math.tan(BETA) / GEAR.r * z
    (x, y), one = straight[:, :, None], np.ones(z.size)
    cos, sin, flat = np.cos(angle), np.sin(angle), np.zeros((count, z.size))
    place_x, place_y = x * cos + y * sin, y * cos - x * sin  # clockwise
    motions = {
        "x": (flat + one, flat, flat), "y": (flat, flat + one, flat), "z": (flat, flat, flat + one),
        "about z": (place_y, -place_x, flat), "about x": (flat, -z + flat, place_y), "about y": (z + flat, flat, -place_x),
    }  # fmt: skip
    rng = np.random.default_rng(0)
    scale = np.abs(np.diag(stiffness)).mean()
    for name, (u, v, w) in motions.items():
        turned = np.stack([u * cos - v * sin, v * cos + u * sin, w], axis=1)  # into the turning frame
        field = (turned @ to_modes.T).ravel()
        energy = field @ stiffness @ field / (field @ field)
        noise = rng.standard_normal(field.size)
        assert abs(energy) < 1e-10 * scale, name
        assert noise @ stiffness @ noise / (noise @ noise) > 0.1 * scale


def test_plane_strain_is_the_constant_along_the_width():
    """One axial mode on spur gears: patch to patch what `ritz` gives in the plane, logarithm and all, healthy and cracked."""
    gear = replace(GEAR, beta=0.0)
    points, weight = halfspace.hat_points(ritz3d._knots(gear), 8)
    carry = ritz._carry(ritz._variable(gear, points.ravel())).reshape(*points.shape, -1)
    mean = np.einsum("hg,hgk->hk", weight, carry)
    knots = ritz3d._knots(gear)
    local = half_plane(STEEL) * hat_logarithm(knots, knots)
    for cracks in ((), (gf.Crack(level=0.5),)):
        plane = [ritz._panel(gear, STEEL, own, "plane strain", 6, 1.0) for own in (cracks, ())]
        solid = [ritz3d._panel(gear, STEEL, own, 10.0, 3, 0, 1.0) for own in (cracks, ())]
        want, _ = ritz._join(gear, dict(enumerate(plane)), plane[1])
        got, _ = ritz._join(gear, dict(enumerate(solid)), solid[1])
        own = mean @ want[0, 0] @ mean.T + local
        assert_allclose(got[0, 0][1:, 1:], own[1:, 1:], rtol=4e-3, atol=2e-3 * own.max(), err_msg=str(cracks))
        across = mean @ want[0, 1] @ mean.T
        assert_allclose(got[0, 1], across, rtol=5e-3)


def test_even_load_on_a_wide_gear_is_the_plane_law():
    """Bulk of one mode and half-space along the line together, at an even load: S(s, s) + c (ln(2 / a) + 1/2)."""
    width, a = 400.0, 0.06
    gear = replace(GEAR, beta=0.0, b=width)
    body = ritz3d.flexibility3d(gear, STEEL, axial=0)
    edge = np.linspace(0, width, 801)
    z = (edge[1:] + edge[:-1]) / 2
    kernel = body.kernel * halfspace.line_kernel(edge[:-1], edge[1:], halfspace.strip(np.full(z.size, a)))
    plane = ritz.flexibility(gear, STEEL, order=6)
    for arc in np.linspace(*plane.limits, 9)[2:-1]:
        roll = roll_at_arc(gear, np.full(z.size, arc))
        moved = (body.matrix(np.zeros(z.size, dtype=int), roll, z) + kernel) @ np.diff(edge)
        want = plane.near[0](arc) + half_plane(STEEL) * (math.log(2 / a) + 0.5)
        assert_allclose(moved.mean(), want, rtol=3e-3)


def test_mirrored_helix_has_mirrored_flexibility():
    right = ritz3d.flexibility3d(replace(GEAR, beta=-BETA), STEEL, order=2, axial=6)
    left = ritz3d.flexibility3d(GEAR, STEEL, order=2, axial=6)
    sign = np.tile((-1.0) ** np.arange(left.degree + 1), ritz3d.PLACES)
    for one, two in ((left.near[0], right.near[0]), (left.far[0, 1], right.far[0, 1])):
        assert_allclose(two, sign[:, None] * one * sign, atol=1e-9 * np.abs(one).max())
        assert np.abs(two - one).max() > 1e-3 * np.abs(one).max()
    pits = [gf.Pit(radius=18.7, z=3.0, axes=(1.0, 1.5), depth=0.1, angle=0.3)]
    run = {"order": 2, "axial": 6}
    one = pair_stiffness3d(pair_of(), 1500.0, STEEL, 4, pits=(pits, ()), **run)
    pits = [replace(pits[0], z=9.0, angle=-0.3)]
    two = pair_stiffness3d(pair_of(beta=-BETA), 1500.0, STEEL, 4, pits=(pits, ()), **run)
    assert_allclose(one.k, two.k, rtol=1e-9)
    assert_allclose(one.cells[1].z, 12.0 - two.cells[1].z, atol=1e-9)


def test_no_helix_is_the_limit_of_a_small_one():
    run = {"order": 2, "axial": 6, "phases": np.array([0.1, 0.25, 0.7, 0.9])}
    spur = pair_stiffness3d(pair_of(beta=0.0), 1500.0, STEEL, face="spur", **run)
    slight = pair_stiffness3d(pair_of(beta=math.radians(0.01)), 1500.0, STEEL, **run)
    assert_allclose(slight.k, spur.k, rtol=1e-4)


def test_herringbone_is_twice_a_half():
    run = {"order": 2, "axial": 6, "phases": 4}
    half = pair_stiffness3d(pair_of(), 1500.0, STEEL, **run)
    whole = pair_stiffness3d(pair_of(28.0), 3000.0, STEEL, face="herringbone", groove=4.0, **run)
    assert_allclose(whole.k, 2 * half.k, rtol=1e-7)
    assert_allclose(whole.load.sum(axis=1), 3000.0, rtol=1e-9)
    z, width = whole.cells[0].z, whole.cells[0].width
    assert not ((z + width / 2 > 12 + 1e-9) & (z - width / 2 < 16 - 1e-9)).any()
    pits = [gf.Pit(radius=18.2, z=z, axes=(1.0, 1.0), depth=0.1) for z in (3.0, 25.0)]
    damaged = pair_stiffness3d(pair_of(28.0), 3000.0, STEEL, face="herringbone", groove=4.0, pits=(pits, ()), **run)
    one = pair_stiffness3d(pair_of(), 1500.0, STEEL, pits=([replace(pits[0], z=9.0)], ()), **run)
    assert (damaged.k <= whole.k * (1 + 1e-9)).all()
    assert (damaged.k / whole.k).min() < 0.99
    assert_allclose(damaged.k, 2 * one.k, rtol=1e-6)


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
        force, approach = contact3d.line_cells(matrix, gap, load, k, ends, line, radius, modulus)
        reach = contact3d.SMOOTH * half_width(load / np.diff(edge).sum(), radius.mean(), modulus)
        mean = np.maximum(contact3d._smoother(ends, line, reach) @ force, 1e-9 * load / np.diff(edge))
        x = halfspace.strip(half_width(mean, radius, modulus))
        total = matrix + k * np.where(line[:, None] == line, halfspace.line_kernel(*ends, x), 0.0)
        closed = total @ force + gap
        close = (
            1e-5 if (half_width(mean, radius, modulus) < np.diff(edge)).all() else 0.1
        )  # there the strips' widths need not settle
        assert_allclose(force.sum(), load, rtol=1e-9)
        assert (force >= 0).all()
        assert_allclose(closed[force > 0], approach, rtol=close, err_msg=f"seed {seed}")
        assert (closed[force == 0] >= approach * (1 - close)).all()
        assert_allclose(share(total, gap, load)[1], approach, rtol=close)


def test_cells_that_cannot_touch_are_as_good_as_absent():
    edge = np.linspace(0, 10, 21)
    gap = np.where((np.arange(20) > 5) & (np.arange(20) < 9), np.inf, 0.0)
    some = np.isfinite(gap)
    args = np.full(20, 3.0), 1.1e5
    line = np.zeros(20, dtype=int)
    force, approach = contact3d.line_cells(np.full((20, 20), 1e-6), gap, 500.0, 2.8e-6, (edge[:-1], edge[1:]), line, *args)
    few = contact3d.line_cells(
        np.full((17, 17), 1e-6), gap[some], 500.0, 2.8e-6, (edge[:-1][some], edge[1:][some]), line[some], args[0][some], args[1]
    )
    assert_allclose(force[some], few[0], rtol=1e-9)
    assert approach == few[1]
    assert (force[~some] == 0).all()
    with pytest.raises(RuntimeError, match="no cell can touch"):
        contact3d.line_cells(
            np.eye(2), np.full(2, np.inf), 1.0, 1e-6, (np.arange(2.0), np.arange(2.0) + 1), np.zeros(2), 1.0, 1.0
        )


def test_moving_pits_by_parts_of_a_cell():
    """A row on a spur gear's line; on a helical gear, where moving means another phase, the drop by cell size."""
    run = {"order": 2, "axial": 8, "phases": np.array([0.7])}
    pair, drops = pair_of(30.0, 0.0), []
    healthy = pair_stiffness3d(pair, 3800.0, STEEL, face="spur", **run).k[0]
    radius = math.hypot(pair.gear_1.r_b, pair.path[0] + 0.7 * pair.p_bt)
    for shift in (0.0, 0.1, 0.2, 0.3):
        pits = [gf.Pit(radius=radius, z=z + shift, axes=(1.0, 1.0), depth=0.1) for z in np.linspace(2.0, 27.7, 7)]
        drops.append(1 - pair_stiffness3d(pair, 3800.0, STEEL, face="spur", pits=(pits, ()), **run).k[0] / healthy)
    assert min(drops) > 0.03
    assert np.ptp(drops) < 0.02 * np.mean(drops)
    pair, drops = pair_of(30.0), []
    run["phases"] = np.array([1.1])
    pits = [gf.Pit(radius=18.2, z=z, axes=(1.0, 1.0), depth=0.1) for z in np.linspace(2.0, 27.7, 7)]
    for step in (contact3d.STEP, contact3d.STEP / 4):
        healthy, pitted = (pair_stiffness3d(pair, 3800.0, STEEL, pits=(own, ()), step=step, **run).k[0] for own in ((), pits))
        drops.append(1 - pitted / healthy)
    assert drops[0] > 0.02
    assert abs(drops[0] - drops[1]) < 0.02 * drops[1]


@pytest.mark.parametrize(
    ("options", "message"),
    [({"width": 0.0}, "positive face width"), ({"order": 1}, "polynomial order"), ({"axial": 2}, "degree along the width")],
)
def test_impossible_options(options, message):
    with pytest.raises(ValueError, match=message):
        ritz3d.flexibility3d(GEAR, STEEL, **options)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"force": -1.0}, "force"), ({"step": 0.0}, "step"), ({"face": "double"}, "face"), ({"face": "spur"}, "helix angle"),
        ({"groove": 2.0}, "groove"), ({"face": "herringbone", "groove": 12.0}, "groove"),
    ],
)  # fmt: skip
def test_impossible_pairs(options, message):
    with pytest.raises(ValueError, match=message):
        pair_stiffness3d(pair_of(), **({"force": 1500.0, "material": STEEL} | options))


def test_pits_over_a_whole_line_are_refused():
    pit = gf.Pit(radius=18.7, z=6.0, axes=(8.0, 20.0), depth=0.1)
    pits = [replace(pit, tooth=k) for k in range(3)]
    with pytest.raises(RuntimeError, match="no contact"):
        pair_stiffness3d(pair_of(), 1500.0, STEEL, 4, pits=(pits, ()), order=2, axial=6)


@pytest.mark.slow
@pytest.mark.parametrize(("ratio", "want"), [(5, -0.040), (10, -0.025), (20, -0.014), (30, -0.009)])
def test_plane_strain_is_too_stiff_by(ratio, want):
    """18/27, away from tip corners; the bores matter by about half a point."""
    pair, phase = pair_of(2.0 * ratio, 0.0), np.linspace(0.1, 0.9, 9)
    plane = gf.mesh_stiffness(pair, 400.0 * ratio, STEEL, phases=phase, extended=False, order=6).k
    solid = pair_stiffness3d(pair, 400.0 * ratio, STEEL, phase, face="spur").k
    print(f"b/m = {ratio}: {100 * (solid.mean() / plane.mean() - 1):.2f} %")
    assert_allclose(solid.mean() / plane.mean() - 1, want, atol=0.006)


@pytest.mark.slow
def test_herringbone_sun_and_planet():
    rack = RACK | {"b": 60.0, "beta": BETA}
    sun, planet = (gf.Gear(z=z, r_bore=0.5 * (z * 1.0403 - 2.5), **rack) for z in (18, 27))
    solved = pair_stiffness3d(gf.GearPair(sun, planet), 7120.0, gf.Material(E=206e3, nu=0.3), 32, face="herringbone")
    print(f"{solved.k.mean():.4g} N/m")
    assert_allclose(solved.k.mean(), 0.970e9, rtol=0.01)


@pytest.mark.slow
def test_error_estimate_covers_a_finer_solve():
    solved = pair_stiffness3d(pair_of(20.0), 2400.0, STEEL, 6, error=True)
    fine = pair_stiffness3d(pair_of(20.0), 2400.0, STEEL, 6, order=4, axial=13, refine=1.3)
    print(f"off by at most {np.abs(solved.k / fine.k - 1).max():.2e}, estimated {(solved.error / solved.k).max():.2e}")
    assert (np.abs(solved.k - fine.k) < solved.error).all()
    assert (solved.error < 0.03 * solved.k).all()
