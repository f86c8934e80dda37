"""Teeth of a gearbox keep their identity: when a damaged tooth meshes, in which meshes, and what sensors receive of it."""

import copy
import math
from types import SimpleNamespace

import numpy as np
import pytest
from gearboxes import BRANCHING, PLANETARY, TWO_STAGE, gear
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.comparison.machine_vibration import analysis, gears_table
from gearfe.comparison.named_lines import named_lines
from gearfe.comparison.settled import recorded
from gearfe.dynamics.machine.gearbox import gearbox, pair_phases
from gearfe.dynamics.machine.layout import through
from gearfe.dynamics.machine.mode_words import critical_speeds, mode_words, modes_table
from gearfe.dynamics.machine.of_scene import build_machine, flat_machine
from gearfe.dynamics.motion.heard import ring_force
from gearfe.scene.load import scene_of

CRACK = {"case": "hurt", "gear": "a", "tooth": 3, "level": 0.4}


def with_crack(tables, **crack):
    return scene_of("own.toml", copy.deepcopy(tables) | {"crack": [CRACK | crack]})


@pytest.fixture(scope="module")
def branching():
    return build_machine(with_crack(BRANCHING), "hurt", phases=24)


def test_a_tooth_passes_both_meshes_of_its_gear_by_its_rotation(branching):
    """Tooth 3 of the driver meshes at 20 and at 205 degrees: the second mesh has it 185 / 360 of a rotation later."""
    turn, pairs = 60 / 1500, with_crack(BRANCHING).pairs
    meshes = {mesh.name: mesh for mesh in branching.meshes}
    left, right = (  # when the tooth is at the pitch point
        meshes[name].entries(2 * turn)[0] + pairs[name].pair.pitch_phase / meshes[name].frequency for name in ("left", "right")
    )
    after = (right[:, None] - left[None, :]) / turn % 1.0
    assert_allclose(after, 185 / 360, atol=1e-9)
    assert [fault.gear for fault in branching.faults] == ["a"]
    assert_allclose(branching.faults[0].frequency, 25.0, rtol=1e-12)


def test_the_other_gear_has_its_own_rotation():
    made = flat_machine(with_crack(BRANCHING, gear="c", tooth=52), "hurt")
    assert [(fault.gear, fault.tooth) for fault in made.faults] == [("c", 52)]
    assert_allclose(made.faults[0].frequency, 25 * 20 / 53, rtol=1e-12)


def test_two_equal_gears_on_a_shaft_are_one_idler():
    """Gears b and c alike and not turned against each other: the phases are those of an idler of one gear."""
    tables = copy.deepcopy(TWO_STAGE)
    tables["gear"] = {"a": gear(23, 2.0, 20.0), "b": gear(31, 2.0, 20.0), "c": gear(31, 2.0, 20.0), "d": gear(47, 2.0, 20.0)}
    tables["pair"]["fast"]["angle_deg"] = 25.0
    tables["shaft"]["two"]["gears_turned_deg"] = [0.0, 0.0]
    scene = scene_of("own.toml", tables)
    first, second = scene.pair("fast").pair, scene.pair("slow").pair
    phases, turn = pair_phases(scene), math.radians(70.0) - (math.radians(25.0) + math.pi)
    assert_allclose(phases["slow"], through(phases["fast"], first, second, -1, turn), rtol=1e-12)


def test_a_gear_turned_on_its_shaft_by_a_pitch_meshes_a_cycle_later_or_sooner():
    """Shaft two turns clockwise: tooth 0 of c placed a pitch counter-clockwise comes a mesh cycle later."""
    tables, turned = copy.deepcopy(TWO_STAGE), []
    for angle in (0.0, 360 / 19, 4.0):
        tables["shaft"]["two"]["gears_turned_deg"] = [0.0, angle]
        turned.append(pair_phases(scene_of("own.toml", tables))["slow"])
    assert_allclose(np.diff(turned[:2]), -1.0, rtol=1e-9)
    assert_allclose(turned[2] - turned[0], -4.0 * 19 / 360, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(("crack", "body", "mesh"), [
    ({"gear": "sun", "tooth": 2}, "sun", ("outer1", "outer2", "outer3")),
    ({"gear": "planet", "tooth": 4, "body": "planet2"}, "planet2", ("outer2", "inner2")),
    ({"gear": "b", "tooth": 9}, "b", ("fast",)),
    ({"gear": "ring", "tooth": 7}, "ring", ("inner1", "inner2", "inner3")),
])  # fmt: skip
def test_any_tooth_of_any_gear_of_a_planetary_train(crack, body, mesh):
    made = flat_machine(with_crack(PLANETARY, **crack), "hurt")
    assert tuple(fault.gear for fault in made.faults) == (body,)
    damaged = tuple(one.name for one in gf.build_machine(with_crack(PLANETARY, **crack), "hurt", phases=8).meshes if one.damage)
    assert damaged == mesh


def test_a_carrier_that_drives_runs_the_contacts_backwards():
    """The GRC gearbox: the sun is driven, so that its torque opposes its rotation; forces press in all meshes."""
    scene = gf.load_scene("nrel_grc")
    made = flat_machine(scene)
    negative = {mesh.name.rstrip("0123456789") for mesh in made.meshes if mesh.frequency < 0}
    assert negative == {"sun_planet", "planet_ring"}
    flat = gearbox(scene, dict.fromkeys(scene.pairs, 1e9), {mesh.name: () for mesh in made.meshes})
    at_rest = 1e9 * (flat.G @ flat.rest())
    for mesh, force in zip(flat.meshes, at_rest, strict=True):
        assert_allclose(force, scene.pairs[mesh.name.rstrip("0123456789")].force, rtol=1e-6)


@pytest.fixture(scope="module")
def records(branching):
    healthy = build_machine(with_crack(BRANCHING), phases=24)
    return {name: recorded(made, 0.4, 20_000.0) for name, made in (("healthy", healthy), ("hurt", branching))}


@pytest.mark.slow
def test_sensors_at_bearings_and_couplings(records):
    """Bearing forces carry the mesh forces, the coupling the torque of its load, on average."""
    run = records["hurt"]
    forces = {dof: sum(run[f"spring bearing in{i} {dof}"] for i in (1, 2)).mean() for dof in "xy"}
    sums = np.zeros(2)
    for name, angle in (("left", 20.0), ("right", 205.0)):
        at = math.radians(angle + 90 - 20)  # along the line of action, from the driver that turns counter-clockwise
        sums += run[f"force {name}"].mean() * np.array([math.cos(at), math.sin(at)])
    assert_allclose([forces["x"], forces["y"]], -sums, rtol=1e-3)
    assert_allclose(run["spring coupling pump"].mean(), 20.0, rtol=1e-3)  # against the rotation, which is clockwise
    assert run.unit("spring coupling pump") == "N m"
    assert run.unit("spring bearing in1 x") == "N"
    with pytest.raises(ValueError, match=r"no channel 'spring bearing'.*spring bearing in1 x"):
        run["spring bearing"]


@pytest.mark.slow
def test_indicators_by_gear_point_at_the_damaged_one(records):
    table = gears_table(records)
    rows = {row[0]: dict(zip([c.name for c in table.columns], row, strict=True)) for row in table.rows}
    grown = {name: row["energy ratio, hurt"] / row["energy ratio, healthy"] for name, row in rows.items()}
    assert max(grown, key=grown.get) == "a"
    assert math.isnan(rows["a"]["FM4, healthy"]), "both meshes of gear a have one frequency: no difference signal"
    assert rows["a"]["FM4, hurt"] > 5
    report = analysis(records)
    assert any("f_r" in name for name in report.standing()), "sidebands at the rotation of the damaged gear"


def test_a_tooth_that_exceeds_the_mesh_lines_is_no_doubt_about_the_teeth(branching):
    """An impulse in each revolution with a weak mesh line, as of a missing tooth: no warning."""
    time = np.arange(20_000) / 20_000.0

    def signal(_, turns):
        values = np.where(time * turns % 1.0 < 0.005, 100.0, 0.0) + 1e-3 * np.sin(2 * np.pi * 500.0 * time)
        return gf.Signal(values, 20_000.0, "N", "force", 2 * np.pi * turns * time)

    table = gears_table({"hurt": SimpleNamespace(machine=branching, signal=signal)})
    assert {row[0] for row in table.rows} == {"a", "b", "c"}
    assert all(row[2] > 20 for row in table.rows), "FM4"


def test_a_line_of_two_stages_has_both_names():
    """The pinion of both stages has one mesh frequency, 500 Hz; the sideband at 9.43 Hz is that of gear c alone."""
    time, rng = np.arange(40_000) / 10_000.0, np.random.default_rng(2)
    wave = np.sin(2 * np.pi * 500 * time) + 0.1 * np.sin(2 * np.pi * (500 + 25 * 20 / 53) * time)
    record = gf.Signal(wave + 0.01 * rng.standard_normal(time.size), 10_000.0, "N")
    names = [line.name for line in named_lines(gf.spectrum(record), scene_of("own.toml", copy.deepcopy(BRANCHING)))[0]]
    assert names == ["mesh frequency, stage left or mesh frequency, stage right", "1 x mesh frequency + 1 f(c), stage right"]


@pytest.mark.slow
def test_lines_of_a_noisy_record_are_named(branching):
    """Every line of ten times the local median of a bearing's force has a name; an alien line has none."""
    run, rng = recorded(branching, 4.0, 5120.0), np.random.default_rng(1)
    force = np.asarray(run["spring bearing in1 y"])
    noisy = force + 0.05 * force.std() * rng.standard_normal(force.size)
    scene = with_crack(BRANCHING)
    lines, covered = named_lines(gf.spectrum(gf.Signal(noisy, 5120.0, "N")), scene)
    assert len(lines) > 10
    assert all(line.name for line in lines), [line for line in lines if not line.name]
    print(f"{len(lines)} lines named, {100 * covered:.1f} % of the bins fit a name")
    assert covered < 0.5
    alien = noisy + force.std() * np.sin(2 * np.pi * 728.6 * run.time)
    others = [line for line in named_lines(gf.spectrum(gf.Signal(alien, 5120.0, "N")), scene)[0] if not line.name]
    assert [round(line.frequency) for line in others] == [729]


def test_a_sensor_on_the_ring_hears_the_planets_pass():
    """Three planets in phase on a ring of 72: a cracked planet tooth brings sidebands of the carrier, a healthy set none."""
    scene = gf.load_scene("sdust_planetary")
    rows = {}
    for case in (None, "planet"):
        run = recorded(build_machine(scene, case, phases=16), 1.2, 10_000.0)
        found = gf.spectrum(gf.housing_signal(run, kind="planet_ring"))
        rows[case] = {f: found.values[round(f / found.resolution)] for f in (360.0, 355.0, 365.0, 360 - 40 / 3 + 5)}
    assert max(rows[None][355.0], rows[None][365.0]) < 1e-3 * rows[None][360.0]
    for line in (355.0, 365.0, 360 - 40 / 3 + 5):
        assert rows["planet"][line] > 10 * rows[None][line]


class OfPlanet2(dict):
    """Response in which the meshes of planet 2 alone have a force."""

    def __init__(self, scene, duration):
        self.machine, self.time = flat_machine(scene), np.linspace(0.0, duration, 20_001)

    def __getitem__(self, name):
        return np.full(self.time.size, float(name.endswith("2")))


@pytest.mark.parametrize(("ring", "carrier"), [("low_planet_ring", 12.1 / 60), ("mid_planet_ring", 12.1 / 60 * (1 + 56 / 19))])
def test_planets_of_each_stage_pass_a_sensor_on_its_ring(ring, carrier):
    """NREL 5 MW, whose suns brake: planets are numbered clockwise, planet 2 stands at -120 degrees and turns the other way."""
    response = OfPlanet2(gf.load_scene("nrel_5mw"), 1 / carrier)
    found = ring_force(response, ring, math.radians(40.0))
    assert_allclose(response.time[np.argmax(found)], (40 + 120) / 360 / carrier, rtol=1e-3)


def test_a_carrier_that_turns_clockwise_passes_a_sensor_clockwise():
    """Planet 2 stands at -120 degrees, and the carrier turns by -2 Hz: it comes to 40 degrees after 200 degrees."""
    response = OfPlanet2(scene_of("own.toml", copy.deepcopy(PLANETARY)), 0.5)
    for degrees, turned in ((40.0, 200.0), (-130.0, 10.0)):
        found = ring_force(response, "inner", math.radians(degrees))
        assert_allclose(response.time[np.argmax(found)], turned / 360 / 2.0, atol=1e-4)


def test_modes_in_words_and_critical_speeds():
    tables = copy.deepcopy(TWO_STAGE)
    tables["machine"]["dofs"] = "torsion"
    made = gearbox(scene_of("own.toml", tables), {"fast": 2e8, "slow": 3e8}, {"fast": (), "slow": ()})
    energy = gf.modal_energy(made)
    assert mode_words(made, energy, 0) == "rotation of the train as a whole"
    first = mode_words(made, energy, 1)  # the brake, by far the largest inertia, on its soft coupling
    assert first.startswith("torsion: brake against motor; strain energy 9")
    assert "in coupling brake" in first
    assert len(modes_table(made, 2000.0).rows) == (energy.frequencies <= 2000).sum()
    table, found = critical_speeds(made, 1500.0, np.linspace(0.1, 2.0, 96))
    assert table.rows
    for (rpm, line, f, *_), one in zip(table.rows, found.crossings, strict=True):
        assert_allclose(f, found.orders[line] * rpm / 1500, rtol=1e-9)
        assert_allclose(f, energy.frequencies[one.mode], rtol=1e-9)
