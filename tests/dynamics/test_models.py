"""Machines: published natural frequencies, mesh phases from geometry, the frequencies of the articles."""

import math

import numpy as np
import pytest
from machines import SHAPE, herringbone, tooth
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.machine.compound_planetary import KINDS, compound_planetary, scene_pairs
from gearfe.dynamics.machine.layout import around, through
from gearfe.dynamics.machine.modes import natural_frequencies
from gearfe.dynamics.machine.pitted_planetary import pitted_planetary
from gearfe.dynamics.machine.planetary import stage_phases
from validation.shared.reference import lin_parker

pytestmark = pytest.mark.quick

PAIRS = scene_pairs(gf.load_scene("compound_planetary"))


def test_frequencies_of_lin_and_parker():
    """Twelve distinct values: six rotational modes once, six translational ones twice; the rigid-body mode at 0."""
    single = [0.0, 1475.7, 1930.3, 2658.3, 7462.8, 11775.3]
    twice = [743.2, 1102.4, 1896.0, 2276.4, 6986.3, 9647.9]
    got, modes = natural_frequencies(lin_parker())
    want = np.sort(single + 2 * twice)
    assert_allclose(got, want, rtol=1e-4, atol=1e-9, err_msg="Lin & Parker 1999, Table 1, N = 3")
    assert got[0] == 0.0
    machine = lin_parker()
    for value in single:  # rotational modes: centres at rest
        mode = modes[:, np.argmin(np.abs(got - value))]
        centre = [machine.dofs.index(f"{b}.{d}") for b in ("sun", "ring", "carrier") for d in "xy"]
        assert np.abs(mode[centre]).max() < 1e-9 * np.abs(mode).max()


def test_planet_modes_appear_from_four_planets_on():
    """N - 3 planet modes of each of three frequencies, with the central members at rest (Lin & Parker 1999)."""
    machine = lin_parker(n=5)
    got, modes = natural_frequencies(machine)
    centre = [i for i, name in enumerate(machine.dofs) if not name.startswith("planet")]
    values, counts = np.unique(got.round(4), return_counts=True)
    assert sorted(counts) == [1] * 6 + [2] * 9
    still = 0
    for value in values[counts == 2]:
        pair = modes[:, np.abs(got - value) < 1e-3]
        still += np.abs(pair[centre]).max() < 1e-9 * np.abs(pair).max()
    assert still == 3


def test_phase_through_an_idler_against_its_outline(spur_stage):
    """Turn the planet until its tooth touches the ring at the pitch point: measured on the flanks' angles, not on formulas."""
    outer, inner = spur_stage.sun_planet, spur_stage.planet_ring
    planet = outer.gear_2
    pitch = 2 * math.pi / planet.z
    driven, driving = (planet.half_thickness(r) for r in (outer.pitch_radius_2, inner.pitch_radius_1))
    # the sun, counter-clockwise at the left of the planet (angle pi), pushes its trailing flank; the planet turns clockwise
    centres = math.pi - driven + pitch * np.arange(planet.z)
    leading = (centres - driving) % (2 * math.pi)
    steps = leading.min() / pitch  # mesh cycles until a leading flank is at angle 0, the ring's pitch point
    got = through(outer.pitch_phase, outer, inner, -1, -math.pi)
    assert_allclose((inner.pitch_phase - got - steps + 0.5) % 1.0, 0.5, atol=1e-9)


def test_phases_of_a_stage_are_consistent(spur_stage):
    """The phase between both meshes of a planet is the same for every planet; ring teeth are whole numbers."""
    rows = stage_phases((spur_stage.sun_planet, spur_stage.planet_ring), 3)
    between = [(rows[f"planet_ring{i}"]["phase"] - rows[f"sun_planet{i}"]["phase"]) % 1.0 for i in (1, 2, 3)]
    assert_allclose(between, between[0], atol=1e-9)
    assert [rows[f"sun_planet{i}"]["phase"] for i in (1, 2, 3)] == pytest.approx([0, -7, -14])
    assert [rows[f"planet_ring{i}"]["first"] for i in (1, 2, 3)] == [(0, 0), (0, 35), (0, 70)]


def test_unequal_places_must_allow_assembly(spur_stage):
    pairs = spur_stage.sun_planet, spur_stage.planet_ring
    with pytest.raises(ValueError, match="cannot be assembled"):
        stage_phases(pairs, 2, planet_angles=(0.0, 1.0))


def test_two_damaged_teeth_meet_at_the_hunting_interval(herringbone_stage):
    both = {"sun_planet": tooth(6e8 * SHAPE, 0.3, 1.5)}
    mesh = herringbone(herringbone_stage, {"sun": (0, both), "planet1": (0, both)}).meshes[0]
    cycles = np.arange(400)
    low = mesh.at_phase(cycles + 0.75)
    meet = cycles[low < low.min() + 1e-6 * low.max()]
    assert list(meet) == list(range(0, 400, math.lcm(18, 27)))
    assert mesh.cycles() == 54
    assert_allclose(mesh.at_phase(cycles + 54.3), mesh.at_phase(cycles + 0.3), rtol=1e-12)


def test_frequencies_of_the_articles(spur_stage, herringbone_stage):
    spur = pitted_planetary(spur_stage, {"sun_planet": 3e8 * SHAPE, "planet_ring": 4e8 * SHAPE})
    assert_allclose([spur.notes[k] for k in list(spur.notes)[:3]], [280, 40, 10 / 3], rtol=1e-9, err_msg="S0: f_m, f_fault, f_c")
    assert_allclose(1 / spur.notes["fault frequency of a sun tooth [Hz]"], 0.025, rtol=1e-9)
    angled = herringbone(herringbone_stage)
    assert_allclose([angled.notes[k] for k in list(angled.notes)[:2]], [480, 80], rtol=1e-9, err_msg="S4: f_m, f_g")
    assert (len(angled.dofs), len(angled.meshes)) == (55, 12)
    compound = compound_planetary(dict.fromkeys(KINDS, 1.6e9 * SHAPE), pairs=PAIRS)
    assert_allclose(compound.notes["mesh frequencies [Hz]"], [168, 182], rtol=1e-9, err_msg="S2")
    assert_allclose(compound.notes["fault frequencies of sun teeth [Hz]"], [16.8, 18.2], rtol=1e-9, err_msg="S2")
    assert len(compound.dofs) == 39


def test_the_carrier_turns_with_its_planets_as_points(spur_stage):
    """All planets' mass, at the distance of their axes from the sun's."""
    machine = pitted_planetary(spur_stage, {"sun_planet": 3e8 * SHAPE, "planet_ring": 4e8 * SHAPE})
    mass = dict(zip(machine.dofs, machine.mass.tolist(), strict=True))
    together = sum(value for name, value in mass.items() if name.startswith("planet") and name.endswith(".x"))
    away = 1e-3 * spur_stage.sun_planet.a
    assert_allclose([mass["carrier.x"], mass["carrier.theta"]], [together, together * away**2], rtol=1e-12)


def test_phase_table_of_the_compound_stage():
    """Three planets divide all tooth numbers, so that branches are in phase; within a branch each mesh has its own phase."""
    table = compound_planetary(dict.fromkeys(KINDS, 1.6e9), pairs=PAIRS).notes["relative phases"]
    assert_allclose([first for first, _ in table.values()], 0, atol=1e-9)
    pairs = PAIRS
    planet = pairs["b_c"].gear_1
    for i in (1, 2, 3):
        alone = through(0.0, pairs["sun1_p"], pairs["p_ring"], -1, -math.pi) % 1.0
        assert_allclose(table[f"p{i}_ring"][1], alone, atol=1e-8)
        assert table[f"b{i}_c{i}"][1] == pytest.approx(table["b1_c1"][1], abs=1e-8)
    # turning a whole chain by a full circle changes no phase but by whole cycles
    assert (around(0.3, planet.z, 1, 2 * math.pi) - 0.3) % 1.0 == pytest.approx(0, abs=1e-9)


def test_compound_stage_balances_its_torques():
    machine = compound_planetary(dict.fromkeys(KINDS, 1.6e9), pairs=PAIRS, torque=200.0)
    forces = machine.G @ machine.rest() * 1.6e9
    assert (forces > 0).all()
    by_kind = forces.reshape(3, 5)
    assert_allclose(by_kind, by_kind[:1].repeat(3, axis=0), rtol=1e-6)
    assert_allclose(by_kind[0, 0] / by_kind[0, 4], 78 / 72, rtol=1e-6)  # the ring passes the torque from stage 2 to stage 1


def test_the_compound_carrier_turns_with_all_planets_as_points():
    """Those of stage 2 lie at the sun's centre distance and, the outer ones, at the ring's."""
    machine = compound_planetary(dict.fromkeys(KINDS, 1.6e9), pairs=PAIRS)
    mass = dict(zip(machine.dofs, machine.mass.tolist(), strict=True))
    away = {"p": PAIRS["sun1_p"].a, "b": PAIRS["sun2_b"].a, "c": PAIRS["c_ring"].a}
    points = [(mass[f"{name}{i}.x"], 1e-3 * a) for name, a in away.items() for i in (1, 2, 3)]
    want = sum(m for m, _ in points), sum(m * a**2 for m, a in points)
    assert_allclose([mass["carrier.x"], mass["carrier.theta"]], want, rtol=1e-12)
