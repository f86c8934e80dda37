"""The energy model in three dimensions: identities, rigid motions, and the plane as its limit."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.flexibility import halfspace
from gearfe.flexibility import solid as flexibility3d
from gearfe.flexibility.energy.ritz import depth, elimination, panel3d, short_edges
from gearfe.flexibility.energy.ritz import plane as ritz
from gearfe.flexibility.energy.ritz import solid as ritz3d
from gearfe.flexibility.energy.ritz.axial import axial
from gearfe.flexibility.energy.ritz.join import join
from gearfe.flexibility.energy.ritz.panel import SectionModel
from gearfe.flexibility.hertz import half_plane, hat_logarithm
from gearfe.flexibility.solved import PROCESS
from gearfe.geometry.mesh.sector import sector
from gearfe.geometry.mesh.triangle import ENDS
from gearfe.geometry.tooth.profile import cartesian, flank, flank_normal, roll_at_arc

RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
BETA = math.radians(16)
GEAR = gf.Gear(z=18, r_bore=9.0, b=12.0, beta=BETA, **RACK)
RING = gf.Gear(z=72, r_rim=90.0, b=12.0, beta=BETA, rack_tip_radius=0.3, addendum=0.85, **RACK)


def surface(gear, roll, z):
    """Points ``(3, n)`` of the loaded flank in space: the section turned clockwise."""
    radius, angle = flank(gear, roll)
    return np.vstack([cartesian(radius, angle + math.tan(gear.beta) / gear.r * z), np.broadcast_to(z, np.shape(radius))])


@pytest.mark.parametrize("gear", [GEAR, replace(GEAR, beta=-BETA), RING], ids=["right", "left", "ring"])
def test_loads_act_at_right_angles_to_the_helicoid(gear):
    order = 3
    made = sector(gear, sizes=ritz3d.SIZES)
    _, count, chain = panel3d.numbering(made, order)
    force = panel3d._hats(gear, made, chain, count, flexibility3d.hats(gear), order, gear.beta_b).sum(axis=0)
    points, weight = halfspace.hat_points(flexibility3d.hats(gear), 12)
    for i, (arc, share_of) in enumerate(zip(points, weight, strict=True)):
        roll, h = roll_at_arc(gear, arc), 1e-5
        along = (surface(gear, roll + h, 0.0) - surface(gear, roll - h, 0.0)) / (2 * h)
        trace = (surface(gear, roll, h) - surface(gear, roll, -h)) / (2 * h)
        normal = np.cross(along, trace, axis=0)
        normal *= np.sign((normal[:2] * flank_normal(gear, roll)).sum(axis=0)) / np.linalg.norm(normal, axis=0)
        assert_allclose(force[:, i], -(normal @ share_of), atol=1e-6)


def test_rigid_motions_store_no_energy():
    width, degree, order = 12.0, 8, 2
    coarse = {"flank": 0.8, "corner": 0.8, "kink": 0.8, "fillet": 0.8, "root": 2.0, "side": 2.0}
    made = sector(GEAR, sizes=coarse)
    made = replace(made, bulge={edge: 0 * curve for edge, curve in made.bulge.items()})  # nodes at the middles
    numbers, count, _ = panel3d.numbering(made, order)
    numbers, _ = elimination.all_nodes(numbers, count, order)
    section = panel3d._section(panel3d.SolidModel(GEAR, STEEL, order), made, math.tan(BETA) / GEAR.r)
    no = np.zeros(0, dtype=int)
    section = elimination.LoadedSection(numbers, section, np.zeros((count, 3, 1)), np.arange(1), no)
    body = elimination.body_of(section, axial(width, degree))
    size = int(body.size[: body.first_load].sum())
    blocks = [np.zeros(shape, order="F") for shape in ((0, 0), (size, 0), (size, size))]
    elimination.leaf(body, np.arange(numbers.shape[1]), no, np.arange(body.first_load), blocks)
    stiffness = np.tril(blocks[2]) + np.tril(blocks[2], -1).T
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
    points, weight = halfspace.hat_points(flexibility3d.hats(gear), 8)
    carry = ritz.carry(gear, points.ravel()).reshape(*points.shape, -1)
    mean = np.einsum("hg,hgk->hk", weight, carry)
    knots = flexibility3d.hats(gear)
    local = half_plane(STEEL) * hat_logarithm(knots, knots)
    for cracks in ((), (gf.Crack(level=0.5),)):
        plane = [ritz.loaded_sector(SectionModel(gear, STEEL, order=6), own) for own in (cracks, ())]
        solid = [ritz3d.solid_sector(panel3d.SolidModel(replace(gear, b=10.0), STEEL), own) for own in (cracks, ())]
        want, _ = join(gear, dict(enumerate(plane)), plane[1])
        got, _ = join(gear, dict(enumerate(solid)), solid[1])
        places = slice(carry.shape[-1])  # the loads after these lean off the normal
        own = mean @ want[0, 0][places, places] @ mean.T + local
        assert_allclose(got[0, 0][1:, 1:], own[1:, 1:], rtol=4e-3, atol=2e-3 * own.max(), err_msg=str(cracks))
        across = mean @ want[0, 1][places, places] @ mean.T
        assert_allclose(got[0, 1], across, rtol=5e-3)


def test_less_along_the_width_and_fewer_cubics_are_stiffer_by_almost_nothing(monkeypatch):
    """What is left out makes a space within the other: no load moves less in that, and none much more."""
    made = sector(GEAR, sizes=ritz3d.SIZES)
    knots = flexibility3d.hats(GEAR)[:, ::2]

    def loads():
        found = panel3d.panel3d(panel3d.SolidModel(replace(GEAR, b=12.0), STEEL, axial=7), made, knots)
        return found, join(GEAR, {0: found}, found)[0][0, 0]

    few, less = loads()
    monkeypatch.setattr(depth, "LEAST", 99)
    monkeypatch.setattr(short_edges, "SHORT", 0.0)
    many, more = loads()
    assert few.unknowns < many.unknowns
    assert np.linalg.eigvalsh(more - less)[0] > -1e-9 * np.abs(more).max()
    assert 0 < np.trace(more - less) < 2e-3 * np.trace(more)


@pytest.mark.parametrize(
    "part", [{}, *(pytest.param(one, marks=pytest.mark.slow) for one in ({"width": (0.0, 2.5)}, {"ends": (1.0, 0.3)}))], ids=str
)
def test_the_other_hand_is_the_mirror_image(part):
    """A gear with negative beta is not solved for; solving for it gives the same, opening of its cracks included."""
    gear, crack = replace(GEAR, beta=-BETA, b=6.0), gf.Crack(level=0.5, **part)
    case = panel3d.SolidModel(gear, STEEL, 2, 3, 0.7), (crack,), 1
    mirrored, solved = ritz3d._mirrored(*case, PROCESS), ritz3d._solved(*case, PROCESS)
    assert mirrored.gear == solved.gear
    for one, two in ((mirrored, solved), (mirrored.healthy, solved.healthy)):
        for key, want in (one.near | one.far).items():
            assert_allclose((two.near | two.far)[key], want, atol=1e-9 * np.abs(want).max())
    shut = []  # the points where faces touch are in another order
    for found in (mirrored, solved):
        opening, seam = found.seam.opening[0], found.seam.influence
        shut.append(found.near[0] - opening.T @ np.linalg.solve(seam, opening))
    assert_allclose(*shut, atol=1e-9 * np.abs(shut[1]).max())


@pytest.mark.parametrize(
    ("cracks", "message"),
    [
        ((gf.Crack(level=0.5, ends=(1.0, 0.5)), gf.Crack(level=0.3, ends=(1.0, 0.5), side="unloaded")), "follows one front"),
        ((gf.Crack(level=0.7, turning=True, ends=(1.0, 0.5)),), "only straight cracks"),
        ((gf.Crack(level=0.5, width=(0, 3)), gf.Crack(level=0.3, width=(6, 9))), "cracks of different shape"),
    ],
)
def test_cracks_the_energy_model_has_not(cracks, message):
    with pytest.raises(ValueError, match=message):
        ritz3d.flexibility3d(GEAR, STEEL, cracks)


@pytest.mark.parametrize(
    ("options", "message"),
    [({"order": 1}, "polynomial order"), ({"axial": 2}, "degree along the width")],
)
def test_impossible_options(options, message):
    with pytest.raises(ValueError, match=message):
        ritz3d.flexibility3d(GEAR, STEEL, **options)
