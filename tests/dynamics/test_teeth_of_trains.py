"""Damage of any tooth of planetary and compound trains: meshes, lines, names that are unknown."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.machine.mesh_curves import changed
from gearfe.dynamics.machine.of_scene import flat_machine
from gearfe.dynamics.machine.pitted_planetary import pitted_planetary
from gearfe.scene.load import read_tables, scene_of


def scene(name, *cracks, **tables):
    """A built-in scene with cracks as the case x, its meshes as stiff as isolated pairs."""
    left = ("assumption", "given", "reference", "set")
    given = {key: value for key, value in read_tables(name)[1].items() if key not in left}
    rows = [{"case": "x", "level": 0.3} | row for row in cracks]
    return scene_of(f"{name}.toml", given | {"crack": [*given.get("crack", []), *rows]} | tables)


def damaged(machine):
    """Meshes with damage."""
    return {mesh.name for mesh in machine.meshes if mesh.changes}


BODIES = {
    "sun": ({"gear": "sun", "tooth": 3}, {"sun_planet1", "sun_planet2", "sun_planet3"}, 40.0),
    "planet 2": ({"gear": "planet", "body": "planet2"}, {"sun_planet2", "planet_ring2"}, 280 / 31),
    "ring": ({"gear": "ring", "tooth": 7}, {"planet_ring1", "planet_ring2", "planet_ring3"}, 10.0),
}


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("kind", ["missing_tooth", "chip"])
def test_broken_teeth_are_in_all_meshes_of_their_body(kind, name):
    row, meshes, frequency = BODIES[name]
    row = row | {"case": "broken"} | ({"depth_mm": 1.0, "angle_deg": 60.0} if kind == "chip" else {})
    given = read_tables("planetary_pitting")[1]["machine"] | {"contact": "linear", "backlash_um": 200.0}
    broken = scene("planetary_pitting", machine=given, **{kind: [row]})
    machine = gf.build_machine(broken, "broken", phases=8, method="ritz")
    assert damaged(machine) == meshes
    assert [(fault.gear, fault.tooth) for fault in machine.faults] == [(row.get("body", row["gear"]), row.get("tooth", 0))]
    assert_allclose(machine.faults[0].frequency, frequency, rtol=1e-9)


@pytest.mark.parametrize(("contact", "message"), [("linear", "backlash_um"), ("impact", "limited to unbroken teeth")])
def test_a_contact_that_cannot_open_or_break_refuses_a_missing_tooth(contact, message):
    """Before anything is solved: `flat_machine` is what checks a scene."""
    given = read_tables("planetary_pitting")[1]["machine"] | {"contact": contact}
    broken = scene("planetary_pitting", machine=given, missing_tooth=[{"case": "broken", "gear": "sun", "tooth": 4}])
    for build in (flat_machine, gf.build_machine):
        with pytest.raises(ValueError, match=message):
            build(broken, "broken")


def test_a_planet_s_crack_is_open_in_one_mesh_and_pressed_shut_in_the_other():
    """The crack is on the flank that the sun loads: in the mesh with the ring its faces slide, and push each other."""
    machine = gf.build_machine(scene("planetary_pitting", {"gear": "planet", "level": 0.5}), "x", phases=16, method="ritz")
    loss = {mesh.name: -mesh.changes[0][2].cells[:, 0].min() / mesh.cycle.mean for mesh in machine.meshes if mesh.changes}
    assert loss["sun_planet1"] > 0.15
    assert 0 < loss["planet_ring1"] < 0.25 * loss["sun_planet1"]


def test_a_tooth_of_a_sun_is_tooth_0_at_another_time():
    """Each mesh of sun tooth 3 has the stiffness of tooth 0, 21 - 3 cycles later."""
    first, other = (
        gf.build_machine(scene("planetary_pitting", {"gear": "sun", "tooth": tooth}), "x", phases=8, method="ritz")
        for tooth in (0, 3)
    )
    phase = np.arange(0, 21, 1 / 8)
    for one, two in zip(first.meshes[:3], other.meshes[:3], strict=True):
        assert_allclose(one.at_phase(phase), two.at_phase(phase + 18), rtol=1e-11)


@pytest.mark.slow
def test_two_damaged_teeth_of_sun_and_planet_meet():
    """Sun tooth 0 and tooth 5 of planet 2: their meeting is solved in that mesh alone, every 651 cycles."""
    rows = {"gear": "sun"}, {"gear": "planet", "body": "planet2", "tooth": 5}
    machine = gf.build_machine(scene("planetary_pitting", *rows), "x", phases=8, method="ritz")
    periods = {mesh.name: {z for z, _, _ in mesh.changes} for mesh in machine.meshes if mesh.changes}
    assert periods["sun_planet1"] == periods["sun_planet3"] == {21.0}
    assert periods["sun_planet2"] == {21.0, 31.0, 651.0}
    case = scene("planetary_pitting", {"gear": "sun"}, {"gear": "planet", "tooth": 5}).pair("sun_planet").case("x")
    mesh = next(mesh for mesh in machine.meshes if mesh.name == "sun_planet2")
    force = machine.notes["mesh forces at rest [N]"]["sun_planet"]
    phase = 21.0 * 3 + np.arange(-4, 20) / 8  # where sun tooth 0 enters a fourth time
    want = gf.mesh_stiffness(**case.as_dict() | {"force": force, "phases": phase, "method": "ritz", "span": "tooth"})
    assert_allclose(mesh.at_phase(phase), want.k, rtol=1e-9)


@pytest.mark.slow
def test_deviations_of_ring_and_planet_are_solved_as_their_teeth_meet():
    """Both gears of a ring mesh differ: planet 2 meets the ring with other teeth than planet 1."""
    planet, ring = [-20.0] + [0.0] * 30, [-15.0] + [0.0] * 83
    flanks = {
        "planet": {"gear": "planet", "pair": "planet_ring", "pitch_um": planet},
        "ring": {"gear": "ring", "pitch_um": ring},
    }
    made = scene("planetary_pitting", flank=flanks)
    machine = gf.build_machine(made, phases=8, method="ritz")
    in_set = gf.build_machine(scene("planetary_pitting", flank=flanks, set={"n_planets": 3}), phases=8, method="ritz")
    assert in_set.notes == machine.notes  # a set gives both flanks of a planet the same form, so the pairs stay isolated
    case = made.pair("planet_ring").case()
    force = machine.notes["mesh forces at rest [N]"]["planet_ring"]
    for name in ("planet_ring1", "planet_ring2"):
        mesh = next(mesh for mesh in machine.meshes if mesh.name == name)
        ahead = mesh.first[1]
        pitch = tuple(
            1e-3 * ring[(k - ahead) % 84] for k in range(84)
        )  # pair k has the planet's tooth k and the ring's k - ahead
        meeting = next(k for k in range(31 * 84) if k % 31 == 0 and (k - ahead) % 84 == 0)
        own = {"pinion": gf.Flank(pitch=tuple(1e-3 * value for value in planet)), "wheel": gf.Flank(pitch=pitch)}
        phase = np.arange(-4, 20) / 8 - meeting
        want = gf.mesh_stiffness(
            **case.as_dict() | {"force": force, "flanks": own, "phases": phase, "method": "ritz", "span": "tooth"}
        )
        assert_allclose(changed(mesh.shifts, phase), want.unloaded, atol=1e-10)
        assert_allclose(mesh.at_phase(phase), want.k, rtol=1e-7)
        assert want.unloaded.min() < -3e-5


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        ({"Sun": (0, {})}, "'Sun'.*nearest: 'sun'"),
        ({"planet": (0, {})}, "'planet'.*nearest: 'planet"),
        ({"planet4": (0, {})}, "'planet4'.*nearest: 'planet"),
        ({"sun": (0, {"sun-planet": 1e8})}, "'sun-planet'.*nearest: 'sun_planet'"),
        ({"sun": (0.5, {"sun_planet": 1e8})}, "tooth 0.5"),
        ({"sun": (math.nan, {"sun_planet": 1e8})}, "tooth nan"),
    ],
)
def test_unknown_names_are_refused_with_the_nearest(damage, message):
    stage = gf.PlanetarySet(*(scene("planetary_pitting").gears[name] for name in ("sun", "planet", "ring")), 3)
    with pytest.raises(ValueError, match=message):
        pitted_planetary(stage, {"sun_planet": 3e8, "planet_ring": 4e8}, damage=damage)


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ({"gear": "planet", "body": "planet7"}, "body 'planet7'.*planet1, planet2, planet3; nearest"),
        ({"gear": "sun", "body": "planet2"}, r"damages body 'planet2' as \w+ of pair \w+, but bodies with this gear are sun"),
    ],
)
def test_a_body_that_no_mesh_has_is_refused(row, message):
    with pytest.raises(ValueError, match=message):
        flat_machine(scene("planetary_pitting", row), "x")
