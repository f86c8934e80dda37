"""Machines whose meshes are those of a set: at rest they turn as far as the set does, whoever has the ring's motion."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sets import FORCE, case, unequal

import gearfe as gf
from gearfe.dynamics.machine.with_set import ring_springs
from gearfe.planetary_sets.added import cycles_of
from gearfe.planetary_sets.standing import standing

MESH = 280.0  # Hz
HELD = 1e17  # N/m, N m/rad: beside it meshes are soft, 1e-9
SOFT = gf.RimSupports(6, 4.8, radial=2e5, tangential=1e5)
PADS = gf.RimSupports(6, 4.8)
BED = gf.RimBed(30.0, 50.0)
ERRORS = [(0.004, -0.003), (0, 0), (0, 0.002)]
RELIEF = {"sun": gf.Flank(tip_relief=0.01, tip_start_diameter=44.5)}


def machine(given, **changed):
    """A machine with the bearings that the set has, its carrier held; k to be replaced."""
    gears = given.gears
    body = {
        name: gf.Member(1.0, 1e-3, HELD, 1e-3 * radius, torsion)
        for name, radius, torsion in (
            ("ring", gears.ring.r_b, HELD), ("carrier", gears.a, HELD),
        )
    }  # fmt: skip
    body["sun"] = gf.Member(1.0, 1e-3, 0.0 if given.floating else HELD, 1e-3 * gears.sun.r_b)
    body["planet"] = gf.Member(1.0, 1e-3, min(1e3 * given.pin, HELD), 1e-3 * gears.planet.r_b)
    phases = gf.stage_phases(given.pairs, given.planets, frequency=MESH, planet_angles=given.planet_angles, start=0.4)
    options = {
        "n_planets": given.planets,
        "alpha": tuple(pair.alpha_wt for pair in given.pairs),
        "stiffness": {"sun_planet": 1e8, "planet_ring": 1e8},
        "mesh": lambda kind, i: phases[f"{kind}{i + 1}"],
        "loads": {"sun": 1e-3 * given.planets * FORCE * gears.sun.r_b},
        "planet_angles": given.planet_angles,
    }
    return gf.planetary(**(body | options | changed))


def at_rest(made, t):
    """Displacements and mesh forces under the loads, stiffnesses and errors of time t."""
    k, e = (
        np.array([one(t) for one in values])
        for values in ([m.k for m in made.meshes], [lambda t, m=m: m.e(t)[0] for m in made.meshes])
    )
    q = np.linalg.solve(made.K + made.G.T @ (k[:, None] * made.G), made.load() + made.G.T @ (k * e))
    return q, k * (made.G @ q - e)


@pytest.mark.parametrize(
    ("given", "cycles", "ring"),
    [
        (case(), 1, "lumped"),
        (unequal(0, 30, 71, errors=ERRORS, pin=3e5, floating=True, flanks=RELIEF), 1, "lumped"),
        pytest.param(unequal(0, 30, 71, errors=ERRORS, ring=BED), 1, "lumped", marks=pytest.mark.slow),
        (unequal(0, 30, 71, errors=ERRORS, ring=BED), 1, "body"),
        pytest.param(unequal(0, 30, 71, errors=ERRORS, ring=SOFT, pin=3e5), 14, "lumped", marks=pytest.mark.slow),
        (unequal(0, 30, 71, errors=ERRORS, ring=SOFT, pin=3e5), 14, "body"),
        (unequal(0, 30, 71, ring=PADS), 14, "lumped"),
    ],
    ids=["equal", "relief", "bed in k", "bed", "soft pads in k", "soft pads", "rigid pads in k"],
)
def test_a_machine_turns_as_far_as_its_set(given, cycles, ring):
    """Turn of the sun and load of every mesh at rest, at several positions: what gives way is there once, and all of it."""
    found = gf.planetary_stiffness(given, 4, cycles=cycles)
    made = gf.with_set(machine(given), found, ring=ring)
    names = [mesh.name for mesh in made.meshes]
    for i in range(0, found.position.size, 5 if cycles > 1 else 1):
        q, forces = at_rest(made, (found.position[i] - 0.4) / MESH)
        turn = 1e-3 * given.gears.sun.r_b * q[made.dofs.index("sun.theta")]
        assert_allclose(turn, found.te[i], rtol=1e-6)
        for inner, kind in enumerate(("sun_planet", "planet_ring")):
            own = [forces[names.index(f"{kind}{planet + 1}")] for planet in range(3)]
            assert_allclose(own, found.force[inner, i], rtol=1e-6)


def test_only_the_motion_of_a_rigid_ring_is_taken_out():
    """Beside soft springs the ring is rigid: what is left in k is that a free ring bends, whatever the springs."""
    means = []
    for k in (0.5, 1.0):
        given = case(ring=gf.RimBed(k, k))
        found = gf.planetary_stiffness(given, [0.3, 0.8])
        made = gf.with_set(machine(given), found, ring="body")
        means.append((found.k[1].mean(), made.meshes[1].cycle.mean))
    (soft, left), (stiff, also) = means
    assert soft < 0.6 * stiff
    assert_allclose(left, also, rtol=0.05)


def test_springs_softer_than_what_tip_corners_pass_on_are_refused():
    """At position 0 planet and ring touch at a corner alone, and the ring feels less torque than the row of a mesh says."""
    given = case(ring=gf.RimBed(0.1, 0.1))
    with pytest.raises(ValueError, match="more than the whole set does"):
        gf.with_set(machine(given), gf.planetary_stiffness(given, 2), ring="body")


def test_springs_of_a_rigid_ring_are_those_of_its_pads():
    """By the sum over pads, each a spring along and across."""
    given = case(ring=SOFT)
    angle = 0.3 + 2 * math.pi / 6 * np.arange(6)
    out, along = np.array([np.sin(angle), np.cos(angle)]), np.array([np.cos(angle), -np.sin(angle)])
    want = 2e5 * out @ out.T + 1e5 * along @ along.T
    x, y, turn = ring_springs(given)
    assert_allclose(1e3 * want, np.diag([x, y]), atol=1e-9 * x)
    assert_allclose(turn, 1e-3 * 6 * 1e5 * given.ring_gear.r_rim**2)
    assert np.isinf(ring_springs(case(ring=PADS))).all()


def test_a_rigidly_held_ring_keeps_the_springs_of_its_machine():
    found = gf.planetary_stiffness(case(ring=PADS), 2, cycles=14)
    plain = machine(case())
    made = gf.with_set(plain, found, ring="body")
    assert_allclose(made.K, plain.K, rtol=1e-12)
    assert_allclose(made.meshes[1].stiffness, found.k[1, :, 0])
    assert made.dofs == plain.dofs


def test_damping_ratios_of_the_ring_stay():
    given = case(ring=BED)
    made = gf.with_set(machine(given, zeta=0.03), gf.planetary_stiffness(given, 2), ring="body")
    own = [one for one in made.springs if one.name.startswith("ring")]
    assert len(own) == 3
    for one in own:
        size = (one.row**2 * made.mass).sum()
        assert_allclose(one.c / (2 * math.sqrt(one.k * size)), 0.03)


def test_phases_of_the_set_are_those_of_the_stage():
    """Planets and both meshes apart, from two derivations: fractions of a cycle between any two meshes agree."""
    given = unequal(0, 30, 71)
    stand = standing(given.gears, np.array(given.planet_angles), [0.0])
    own = gf.stage_phases(given.pairs, 3, planet_angles=given.planet_angles)
    apart = [
        one - own[f"{kind}{planet + 1}"]["phase"]
        for kind, row in (("sun_planet", stand.outer[0]), ("planet_ring", stand.inner[0]))
        for planet, one in enumerate(row)
    ]
    assert_allclose((np.array(apart) - apart[0] + 0.5) % 1.0, 0.5, atol=1e-6)


def test_sets_repeat_by_their_pads_and_their_faults():
    assert cycles_of(case()) == 1
    assert cycles_of(case(ring=PADS)) == 14
    assert cycles_of(case(ring=gf.RimSupports(5, 4.8))) == 84
    assert cycles_of(case(damage={"sun": [gf.Crack(level=0.3)]}, flanks=RELIEF)) == 21
    pitch = [0.01] + [0.0] * 30
    assert cycles_of(case(damage={"sun": [gf.Crack(level=0.3)]}, flanks={"planet2": gf.Flank(pitch=pitch)})) == 21 * 31


def test_machines_and_sets_that_do_not_fit_are_refused():
    given = case()
    found, made = gf.planetary_stiffness(given, 2), machine(given)
    pads = gf.planetary_stiffness(case(ring=PADS), 2)
    uneven = gf.planetary_stiffness(given, [0.0, 0.1, 0.5])
    lugs = gf.RimSupports(6, 4.8, radial=0, tangential=1e5, pushes=True)
    other = machine(unequal(0, 30, 71))
    hurt = made.with_meshes(damage=(gf.ToothDamage(0, 0, gf.Samples(np.array([0.0, 1.0]), np.array([1e8, 1e8]))),))
    for options, message in (
        ((made, pads, "lumped"), "repeats after 14"),
        ((made, uneven, "lumped"), "not equally spaced"),
        ((machine(unequal(0, 50)), found, "lumped"), "the set has 3 planets"),
        ((other, found, "lumped"), "has another direction than in the set"),
        ((hurt, found, "lumped"), "is damaged: give"),
        ((made, gf.planetary_stiffness(case(ring=lugs), 1, cycles=14), "body"), "not linear springs of a body"),
        ((gf.with_set(made, found, ring="lumped"), found, "lumped"), "has no body 'ring'"),
    ):
        with pytest.raises(ValueError, match=message):
            gf.with_set(options[0], options[1], ring=options[2])
    free = machine(given, ring=gf.Member(1.0, 1e-3, 1e8, 1e-3 * given.gears.ring.r_b))
    with pytest.raises(ValueError, match="rotates freely"):
        gf.with_set(free, found, ring="lumped")


@pytest.mark.parametrize("loads", [(1.0,), pytest.param((0.5, 1.0, 2.0), marks=pytest.mark.slow)], ids=["curve", "force laws"])
def test_meshes_of_a_scene_are_as_stiff_as_in_its_set(loads):
    """The machine of a scene with a set, against `with_set` on that of isolated pairs; damage keeps the set's compliance."""
    gears = {"gear.sun.z": 22, "gear.planet.z": 30, "gear.ring.z": 82, "gear.ring.x": 0.0}
    scene = gf.load_scene("planetary_pitting", gears | {"set.n_planets": 4, "machine.n_planets": 4})
    made = gf.build_machine(scene, loads=loads)
    isolated = gf.build_machine(replace(scene, set=None), loads=loads)
    force = made.notes["mesh forces at rest [N]"]["sun_planet"]
    whole = gf.with_set(isolated, gf.planetary_stiffness(gf.build_set(scene).with_(force=force), 64, error=False), ring="lumped")
    time = np.linspace(0, 1 / made.meshes[0].frequency, 64, endpoint=False)
    other = {mesh.name: mesh.k(time) for mesh in whole.meshes}
    for mesh, alone in zip(made.meshes, isolated.meshes, strict=True):
        assert_allclose(mesh.k(time).mean(), other[mesh.name].mean(), rtol=1e-3)  # pairs enter between 32 and 64 positions
        assert_allclose(np.median(mesh.k(time) / other[mesh.name]), 1.0, rtol=2e-4)
        assert abs(mesh.k(time).mean() / alone.k(time).mean() - 1) > 0.01
    told = [made.notes[f"mean stiffness {where} [N/um]"]["sun_planet"] for where in ("in the set", "of isolated pairs")]
    assert_allclose(told, [1e-6 * one.mean_stiffness()[0] for one in (made, isolated)])
    cracked = scene.with_damage("crack", {"sun_planet": {"pinion": [gf.Crack(level=0.3, tooth=4)]}})
    hurt = [gf.build_machine(one, "crack", loads=loads).meshes[2] for one in (cracked, replace(cracked, set=None))]
    at = time + hurt[0].entries(0.2)[0][0]  # tooth 4 is in mesh
    added = [1 / one.k(at) - 1 / other.k(at) for one, other in ((made.meshes[2], isolated.meshes[2]), hurt)]
    assert_allclose(added[1], added[0], rtol=0.05)
    assert hurt[0].k(at).mean() < 0.99 * made.meshes[2].k(at).mean()
