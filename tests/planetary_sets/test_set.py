import math
import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sets import FORCE, STEEL, case, gears, unequal

import gearfe as gf
from gearfe.planetary_sets.case import PlanetaryCase
from gearfe.planetary_sets.rim_supports import RimBed, RimSupports
from gearfe.planetary_sets.solve import bodies_of, planetary_stiffness
from gearfe.planetary_sets.standing import standing
from gearfe.planetary_sets.whole_gear import carry

PADS = RimSupports(6, 4.8)
MESHES = 5e-4  # of k with a crack: the pair has it in the energy method's triangles, the set in others of one sector


def isolated(pair, phase, force=FORCE, **options):
    return gf.mesh_stiffness(pair, force=force, material=STEEL, method="ritz", phases=np.atleast_1d(phase), **options)


@pytest.mark.parametrize(
    "given",
    [
        pytest.param(case(), marks=pytest.mark.slow),
        unequal(0, 25, 53),
        case(flanks={"sun": gf.Flank(tip_relief=0.01, tip_start_diameter=44.5)}),
    ],
    ids=["equal", "unequal", "relief"],
)
def test_meshes_that_do_not_feel_each_other_are_isolated_pairs(given):
    """Corners and kinks included; the pair's own solver, its active set and its rounds are not used."""
    found = planetary_stiffness(given, 48, coupled=False)
    for inner in (0, 1):
        for planet in range(3):
            flanks = {"pinion": given.flanks["sun"]} if given.flanks and not inner else None
            stand = standing(given.gears, np.array(given.planet_angles), found.position)
            phase = (stand.outer, stand.inner)[inner][:, planet]
            phase = np.round(phase - np.floor(phase), 9)
            want = isolated(given.pairs[inner], phase, flanks=flanks)
            assert_allclose(found.k_alone[inner, :, planet], want.k, rtol=1e-6)
            if given.planet_angles == case().planet_angles:
                assert_allclose(found.k[inner, :, planet], want.k, rtol=1e-6)
                continue
            for i in range(0, 48, 8):  # planets that are not in phase carry other loads
                own = isolated(given.pairs[inner], phase[i], found.force[inner, i, planet])
                assert_allclose(found.k[inner, i, planet], own.k[0], rtol=1e-6)


@pytest.mark.parametrize("ring", ["held", RimBed(1e4, 1e4), PADS, RimSupports(6, 4.8, radial=0, pushes=True)])
def test_everything_is_in_balance(ring):
    """Sun: torque; every planet: torque; a floating sun: both directions. Pair forces are those of their mesh."""
    given = unequal(0, 30, 71, ring=ring, floating=True, errors=[(0.004, -0.003), (0, 0), (0, 0.002)], pin=3e5)
    found = planetary_stiffness(given, [0.1, 0.83, 7.4])
    total = 3 * FORCE
    assert_allclose(found.force[0].sum(axis=1), total, rtol=1e-10)
    assert_allclose(found.force[0], found.force[1], rtol=1e-10)
    angles = np.array(given.planet_angles)
    turned = angles + math.pi / 2 - given.pairs[0].alpha_wt  # direction of the force of each mesh
    pushed = np.array([np.sin(turned), np.cos(turned)]) @ found.force[0].T
    assert_allclose(pushed, 0, atol=1e-10 * total)
    assert_allclose(found.pair_force.sum(axis=3), found.force, rtol=1e-12)
    assert (found.pair_force >= 0).all()
    assert (found.tooth[found.pair_force > 0] >= 0).all()


def test_pads_hold_what_the_planets_push():
    """The torque on the ring's pads is that of its meshes."""
    given = case(ring=PADS)
    rim = bodies_of(given).rim
    found = planetary_stiffness(given, [0.4])
    loads = np.zeros((84, 8))
    for planet in range(3):
        for k, order in enumerate(found.order):
            if found.pair_force[1, 0, planet, k]:
                loads[(planet * 28 + order) % 84] += found.pair_force[1, 0, planet, k] / 20 * carry(given.ring_gear, [80.0])[0]
    torque = rim.pads.turns[2] @ np.einsum("pta,ta->p", rim.reaction, loads)
    assert_allclose(torque, 3 * FORCE / 20 * given.ring_gear.r_b, rtol=1e-10)


@pytest.mark.parametrize("ring", ["held", PADS])
def test_equal_planets_in_phase_carry_the_same(ring):
    found = planetary_stiffness(case(ring=ring, floating=True), 16)
    assert_allclose(found.share, 1, rtol=1e-9)
    assert_allclose(found.orbit, 0, atol=1e-12)
    assert_allclose(found.k[:, :, 1:], found.k[:, :, :1].repeat(2, axis=2), rtol=1e-9)


def test_the_set_repeats_after_the_ring_has_moved_by_a_pad():
    """84 / 6 mesh cycles, and the pads are where they were; half of that, and planets stand between them."""
    found = planetary_stiffness(case(ring=PADS), [0.3, 7.3, 14.3])
    assert_allclose(found.k[:, 2], found.k[:, 0], rtol=1e-9)
    assert abs(found.k[1, 1] / found.k[1, 0] - 1).min() > 0.01
    moved = planetary_stiffness(case(ring=RimSupports(6, 4.8, first=math.pi / 6)), [0.3])
    assert_allclose(moved.k[:, 0], found.k[:, 1], rtol=1e-6)


def test_a_pin_with_an_error_is_a_spring_in_series():
    """Planets are springs side by side: k of both meshes by `mesh_stiffness` at the load each carries, and the pin."""
    pin, error = 1e5, 0.02
    given = case(pin=pin, errors=[(0, 0), (0.01, error), (0, 0)])
    found = planetary_stiffness(given, [0.9], coupled=False)
    one, two = given.pairs
    across = math.cos(one.alpha_wt) + math.cos(two.alpha_wt)
    up = math.sin(one.alpha_wt) - math.sin(two.alpha_wt)
    ways = []
    for planet, (radial, along) in enumerate(given.errors):
        force = found.force[0, 0, planet]
        meshes = ((one, 0.9), (two, _inner_phase(given, 0.9, planet)))
        closes = [force / isolated(pair, phase, force).k[0] for pair, phase in meshes]
        ways.append(1e3 * sum(closes) + force * (across**2 + up**2) / pin + across * along + up * radial)
    assert_allclose(ways, 1e3 * found.te[0], rtol=1e-5)
    assert found.force[0, 0, 1] < 0.9 * found.force[0, 0, 0]
    assert found.K_gamma > 1.05


def _inner_phase(given, position, planet):
    phase = standing(given.gears, np.array(given.planet_angles), [position]).inner[0, planet]
    return round(phase - math.floor(phase), 9)


def test_a_floating_sun_levels_an_error_of_three_planets():
    given = case(errors=[(0, 0.005), (0, 0), (0, 0)])
    held, floats = (planetary_stiffness(given.with_(floating=one), [0.3]) for one in (False, True))
    assert held.K_gamma > 1.1
    assert_allclose(floats.share, 1, rtol=1e-9)
    assert np.hypot(*floats.orbit[0]) > 1e-6


def test_stiff_pins_and_beds_are_rigid():
    plain = planetary_stiffness(case(), [0.2, 0.7])
    for given in (case(pin=1e13), case(ring=RimBed(1e12, 1e12))):
        assert_allclose(planetary_stiffness(given, [0.2, 0.7]).k, plain.k, rtol=1e-6)


@pytest.mark.slow
def test_lugs_that_all_push_are_pads_without_radial_force(monkeypatch):
    """The torque presses all of them; what is a contact of its own there is taken into the ring's flexibility here."""
    monkeypatch.setattr("gearfe.planetary_sets.pads.TERMS", 1)
    lugs, pads = (
        planetary_stiffness(case(ring=RimSupports(6, 4.8, radial=0, tangential=1e5, pushes=one)), [0.2, 3.6], cache=False)
        for one in (True, False)
    )
    for name in ("k", "rim", "ring_moved"):
        want = getattr(pads, name)
        assert_allclose(getattr(lugs, name), want, atol=1e-6 * abs(want).max())


@pytest.mark.parametrize(("name", "inner", "planet"), [("sun", 0, 0), ("planet2", 0, 1), ("ring", 1, 0)])
def test_pitch_deviations_are_those_of_the_teeth_named(name, inner, planet):
    """Tooth 0 that lies off changes how the pairs of one mesh share its load, and of no other mesh of that kind."""
    found = planetary_stiffness(case(), [0.2])
    pitch = [0.02] + [0.0] * (case().gear_of(name).z - 1)
    moved = planetary_stiffness(case(flanks={name: gf.Flank(pitch=pitch)}), [0.2])
    parts = [one.pair_force[inner, 0] / one.force[inner, 0][:, None] for one in (moved, found)]
    changed = abs(parts[0] - parts[1]).max(axis=1) > 0.2
    assert np.flatnonzero(changed).tolist() == [planet]


@pytest.mark.parametrize("crack", [gf.Crack(level=0.5), gf.Crack(level=0.95, turning=True)], ids=["half", "nearly off"])
def test_uncoupled_cracks_are_those_of_isolated_pairs(crack):
    """A tooth that is nearly off gives way until the next pair touches."""
    at = [0.2, 0.75, 1.3]
    want = isolated(case().pairs[0], at, damage={"pinion": [crack]})
    one = planetary_stiffness(unequal(0, damage={"sun": [crack]}), at, coupled=False)  # one planet: the pair's load
    assert_allclose(one.k[0, :, 0], want.k, rtol=2 * MESHES)
    assert_allclose(one.k_alone[0, :, 0], want.k, rtol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["planet1", "ring"])
def test_cracks_of_planet_and_ring_are_those_of_isolated_pairs(name):
    """Counted and mirrored as the pair of planet and ring has them: what the sun loads is unloaded there."""
    plain = planetary_stiffness(unequal(0), [0.2], coupled=False)
    given = unequal(0)
    stand = standing(given.gears, np.array(given.planet_angles), [0.2])
    tooth = int(plain.tooth[1, 0, 0].max())  # of the planet, in mesh with the ring
    pair = -tooth + given.gears.planet.z * round((tooth - stand.inner[0, 0]) / given.gears.planet.z)
    pair += given.gears.planet.z * round((-stand.inner[0, 0] + 0.5 - pair) / given.gears.planet.z)
    if name == "ring":
        crack, damage = gf.Crack(level=0.5, tooth=int(stand.ring[0]) - pair), {"wheel": [gf.Crack(level=0.5, tooth=pair)]}
    else:
        crack, damage = gf.Crack(level=0.5, tooth=tooth), {"pinion": [gf.Crack(level=0.5, tooth=pair, side="unloaded")]}
    hurt = planetary_stiffness(unequal(0, damage={name: [crack]}), [0.2], coupled=False)
    want = isolated(given.pairs[1], stand.inner[:, 0], damage=damage)
    assert_allclose(hurt.k[1, :, 0], want.k, rtol=1e-3)  # where faces touch, the pair leaves out how contacts slide: 8e-4
    assert abs(hurt.k[1, 0, 0] / plain.k[1, 0, 0] - 1) > 1e-3


def test_crack_faces_do_not_pass_through_each_other():
    """A load on the next tooth closes the crack: the pair says so at the first of these phases, and the set has its k.

    Before that its tooth is so far from the mesh that the pair leaves the crack out.
    """
    crack = gf.Crack(level=0.5)
    at = np.linspace(-0.25, 1.5, 8)
    want = isolated(case().pairs[0], at, damage={"pinion": [crack]})
    found = planetary_stiffness(unequal(0, damage={"sun": [crack]}), at, coupled=False)
    assert found.meta["shut"] == want.meta["crack_closed_phases"] == [-0.25]
    assert_allclose(found.k[0, :, 0], want.k, rtol=MESHES)


def test_plain_positions_and_bad_ones():
    assert planetary_stiffness(case(), 4, cycles=2).position.tolist() == [k / 4 for k in range(8)]
    assert planetary_stiffness(case(), np.int64(4)).position.tolist() == [k / 4 for k in range(4)]
    for bad in (0, 2.0, [math.nan], [], [[0, 1]], [1e12]):
        with pytest.raises(ValueError, match="positions = "):
            planetary_stiffness(case(), bad)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"planet_angles": [0, 1]}, "cannot be assembled"),
        ({"floating": True, "planet_angles": [0.0]}, "do not hold a floating sun"),
        ({"ring": None}, "a ring needs a support"),
        ({"ring": RimSupports(6, 100.0)}, r"longer than its rim.*less than 99\.48 mm"),
        ({"damage": {"sun": gf.Crack(level=0.3)}}, "give a list, also for a single entry"),
        ({"pin": 0.0}, "pin = 0"),
        ({"errors": [(0, 0)]}, r"for each of 3 planets"),
        ({"errors": [(0, 20.0)] * 3}, "20 um are 0.02"),
        ({"flanks": {"carrier": gf.Flank()}}, "flanks of 'carrier'"),
        ({"flanks": {"sun": gf.Flank(helix_crowning=0.01)}}, "change along the width"),
        ({"flanks": {"planet": gf.Flank(eccentricity=0.01)}}, "eccentricity"),
        (
            {"damage": {"sun": [gf.Pit(radius=21.0, z=10.0, axes=(0.5, 0.5), depth=0.1)]}},
            "in a section, which allows no other type",
        ),
    ],
)
def test_what_cannot_be_is_refused(options, message):
    with pytest.raises(ValueError, match=message):
        case(**options)


def test_helical_sets_are_refused():
    turned = [replace(one, beta=0.1) for one in (gears().sun, gears().planet, gears().ring)]
    with pytest.raises(ValueError, match="x_ring =") as told:
        gf.PlanetarySet(*turned, 3)
    turned[2] = replace(turned[2], x=float(re.findall(r"x_ring = ([-0-9.]+) \(", str(told.value))[0]))
    with pytest.raises(ValueError, match="spur gears only"):
        PlanetaryCase(gf.PlanetarySet(*turned, 3), FORCE, STEEL)


@pytest.mark.slow
def test_planets_out_of_mesh_carry_nothing_and_the_others_all():
    """Errors so large for the load that planets leave their meshes, with hats at corners open and closed."""
    rng = np.random.default_rng(5)
    for _ in range(6):
        given = unequal(0, 26, 53, 79, errors=rng.normal(0, 0.02, (4, 2))).with_(force=150.0)
        found = planetary_stiffness(given, rng.uniform(0, 20, 2))
        assert (found.force == 0).any() or found.force.min() < 1.0
        assert_allclose(found.force[0].sum(axis=1), 4 * 150.0, rtol=1e-10)
        assert_allclose(found.force[0], found.force[1], atol=1e-9 * 150)
        assert (found.pair_force >= 0).all()


def test_lugs_do_not_hold_a_ring_that_one_planet_pushes_away():
    with pytest.raises(RuntimeError, match="no compressive mesh forces"):
        planetary_stiffness(unequal(0, ring=RimSupports(6, 4.8, radial=0, pushes=True)), [0.2])
