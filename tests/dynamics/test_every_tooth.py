"""Vibration with damage and deviations of any tooth: lines, shifts in time, quasi-static limit, another integrator."""

import math
from dataclasses import replace

import numpy as np
import pytest
from machines import stepped
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator

import gearfe as gf
from gearfe.comparison.machine_vibration import analysis
from gearfe.comparison.settled import recorded
from gearfe.dynamics.machine.scene_curves import teeth_of
from gearfe.dynamics.machine.tooth_damage import ToothDamage
from gearfe.scene.load import scene_of

GEAR = {"m_n_mm": 3.0, "alpha_n_deg": 20.0, "b_mm": 15.0, "material": "steel"}
MESH = 680.0  # Hz
TURNS = {"pinion": MESH / 17, "wheel": MESH / 38}


def scene(flank=None, machine=None, **damage):
    """Pair of 17 and 38 teeth at 2400 rpm with tables of damage by case."""
    tables = {
        "title": "Pair 17/38",
        "source": "own gear pair",
        "material": {"steel": {"E_MPa": 206000.0, "nu": 0.3}},
        "gear": {"pinion": GEAR | {"z": 17, "r_bore_mm": 10.9}, "wheel": GEAR | {"z": 38, "r_bore_mm": 26.6}},
        "pair": {"stage": {"gear_1": "pinion", "gear_2": "wheel", "force_N": 1669.298}},
        "machine": {"model": "helical_pair", "speed_rpm": 2400.0, "torque_Nm": 40.0} | (machine or {}),
        "flank": {} if flank is None else {flank["gear"]: flank},
        "crack": [{"case": "cracked", "angle_deg": 60.0, "length_mm": 2.0} | row for row in damage.get("crack", ())],
        "missing_tooth": [{"case": "missing"} | row for row in damage.get("missing_tooth", ())],
        "chip": [{"case": "chipped", "depth_mm": 1.5} | row for row in damage.get("chip", ())],
    }
    return scene_of("pair.toml", tables)


def amplitude(machine, *frequencies, seconds=0.95):
    """Amplitudes of the mesh force [N] at some frequencies; the record holds whole turns of both gears."""
    force = recorded(machine, seconds, 16 * MESH)["force mesh"]
    size = round(16 * MESH * seconds)
    parts = 2 / size * np.abs(np.fft.rfft(np.asarray(force)[:size]))
    return parts[[round(frequency * seconds) for frequency in frequencies]]


SHOWN = {  # kind and tooth of damage, machine, least sideband [N], largest one of the other gear over it
    "crack": ({}, 0.2, 2e-2),
    "chip": ({}, 0.5, 0.1),
    "missing_tooth": ({"backlash_um": 300.0}, 5.0, 0.1),
}


@pytest.mark.parametrize(
    ("kind", "row"),
    [
        *[
            ("crack", {"gear": gear, "tooth": tooth})
            for gear, tooth in (("pinion", 0), ("pinion", 5), ("wheel", 0), ("wheel", 23))
        ],
        ("chip", {"gear": "pinion", "tooth": 6}),
        ("chip", {"gear": "wheel", "tooth": 0}),
        pytest.param("chip", {"gear": "wheel", "tooth": 5, "width_mm": [0.0, 7.5], "radius_mm": 3.0}, marks=pytest.mark.slow),
        pytest.param("missing_tooth", {"gear": "pinion", "tooth": 0}, marks=pytest.mark.slow),
        pytest.param("missing_tooth", {"gear": "wheel", "tooth": 23}, marks=pytest.mark.slow),
    ],
)
def test_damage_shows_at_the_turns_of_its_gear_and_nowhere_else(kind, row):
    """17 and 38 have no common factor: sidebands at both gears' turns are lines apart."""
    settings, least, beside = SHOWN[kind]
    case = {"crack": "cracked", "chip": "chipped", "missing_tooth": "missing"}[kind]
    machine = gf.build_machine(scene(machine=settings, **{kind: [row]}), case, **({} if kind == "crack" else {"phases": 32}))
    other = {"pinion": "wheel", "wheel": "pinion"}[row["gear"]]
    own, away = (amplitude(machine, *(MESH + sign * TURNS[gear] for sign in (-1, 1))) for gear in (row["gear"], other))
    assert own.min() > least
    assert away.max() < beside * own.min()
    faults = [(one.gear, one.tooth, round(one.frequency, 6)) for one in machine.faults]
    assert faults == [(row["gear"], row["tooth"], round(TURNS[row["gear"]], 6))]


def test_a_missing_tooth_needs_a_backlash():
    """Without one the contact could not open."""
    with pytest.raises(ValueError, match="backlash_um"):
        gf.build_machine(scene(missing_tooth=[{"gear": "pinion"}]), "missing")


def test_sidebands_of_a_cracked_wheel():
    """2 mm on the wheel: 0.63 and 0.87 N at 662.1 and 644.2 Hz, as of the same curve put on the wheel by hand.

    The curve by hand lacks the neighbours of the tooth, which is 2.5 % of these lines. The lines are those of 1024 equal phases.
    """
    hurt = scene(crack=[{"gear": "wheel"}])
    machine = gf.build_machine(hurt, "cracked")
    near, far, pinion = amplitude(machine, MESH - TURNS["wheel"], MESH - 2 * TURNS["wheel"], MESH - TURNS["pinion"])
    curve = gf.solve(hurt.case(case="cracked"), gf.Solve("ritz", 64, "tooth"))
    by_hand = gf.build_machine(hurt).with_meshes(damage=(ToothDamage(1, 0, curve),))
    assert_allclose([near, far], amplitude(by_hand, MESH - TURNS["wheel"], MESH - 2 * TURNS["wheel"]), rtol=0.04)
    assert_allclose([near, far], [0.6301, 0.8738], rtol=0.01)
    assert pinion < 1e-2


@pytest.mark.slow
def test_teeth_of_both_gears_show_both_lines():
    """Cracks of pinion and wheel: both sidebands, and both faults are named."""
    both = scene(crack=[{"gear": "pinion", "tooth": 3}, {"gear": "wheel", "tooth": 5}])
    machine = gf.build_machine(both, "cracked")
    assert amplitude(machine, MESH - TURNS["wheel"], MESH - TURNS["pinion"]).min() > 0.3
    assert [f"{fault}".split(" mm")[0] for fault in machine.faults] == ["tooth 3 of the pinion: 2", "tooth 5 of the wheel: 2"]
    found = analysis({"healthy": recorded(gf.build_machine(both), 0.5, 8000.0), "cracked": recorded(machine, 0.5, 8000.0)})
    assert_allclose([found.lines["f_m - f_r"], found.lines["f_m - f_wheel"]], [MESH - TURNS[gear] for gear in TURNS])


def small_pair(**fields):
    """Case of 11 and 13 teeth, whose same teeth meet every 143 cycles."""
    rack = {"m_n": 3.0, "alpha_n": math.radians(20), "b": 15.0}
    pair = gf.GearPair(gf.Gear(z=11, x=0.45, r_bore=5.5, **rack), gf.Gear(z=13, x=0.35, r_bore=7.0, **rack))
    return gf.Case(pair, 1000.0, gf.Material(E=206e3, nu=0.3), **fields)


def one_mass(case, phases, *, mass, frequency, fine=False, **mesh):
    """A mass on the mesh of a `small_pair`."""
    cycle = gf.mesh_cycle(case, gf.Solve(phases=phases), fine=fine)
    return gf.single_mesh(mass, cycle.healthy, frequency, force=case.forces[0], teeth=(11, 13), damage=teeth_of(cycle), **mesh)


FLANKS = {
    "pitch and eccentricity": {
        "pinion": gf.Flank(pitch=(0.0,) * 3 + (0.01,) + (0.0,) * 7),
        "wheel": gf.Flank(eccentricity=0.008, eccentric_tooth=1.5),
    },
    "eccentricity": {"pinion": gf.Flank(eccentricity=0.015)},
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FLANKS)
def test_slow_motion_is_the_loaded_transmission_error(name):
    """So slow and damped that nothing vibrates: the compression is the transmission error over the hunting period."""
    case = small_pair(flanks=FLANKS[name], damage={"wheel": [gf.Crack(level=0.3, tooth=6)]})
    found = gf.transmission_error(case, phases=16, span="hunting")
    machine = one_mass(case, 16, mass=1e-6, frequency=1.0, zeta=1.0)
    run = stepped(machine, 143.0, dt=1 / 1024, every=64)  # Longer steps pass the jumps of pitch late, and a warning says so.
    assert_allclose(run["pair.x"][16:-1], found.te[0][16:], atol=1e-3 * np.ptp(found.te))


@pytest.mark.slow
def test_another_integrator_with_contact_solved_for_the_teeth_that_meet():
    """DOP853 with k of dense phases of its own, over 143 cycles of 11/13 teeth that are cracked on both gears.

    The default differs by less than 1e-3 of the range; twice the phases and 1024 steps per mesh cycle by less than 1e-4. Both
    sides share the contact solver (`gearfe.solve`), damping and start. The integrators, the phases and the cycles solved differ.
    """
    case = small_pair(damage={"pinion": [gf.Crack(level=0.4, tooth=4)], "wheel": [gf.Crack(level=0.3, tooth=9)]})
    frequency, mass, last = 900.0, 0.15, round(2048 * (case.pair.eps_alpha - 1))
    one = np.unique([*range(0, 2048, 32), *range(2048 - 61, 2048), *range(25), *range(last - 28, last + 54)]) / 2048
    phase = (np.arange(143)[:, None] + one).ravel()
    brute = [gf.solve(case, gf.Solve(phases=part, span="tooth")).k for part in np.array_split(phase, 12)]
    k = PchipInterpolator(np.append(phase, 143.0), np.append(np.concatenate(brute), brute[0][0]))
    start, c = (case.forces[0] / k(0.0), 0.0), 0.06 * math.sqrt(mass * k(0.0))

    def rate(t, y):
        return y[1], (case.forces[0] - k(frequency * t) * y[0] - c * y[1]) / mass

    for phases, options, limit in ((64, {}, 1e-3), (128, {"step": 1 / frequency / 1024}, 1e-4)):
        machine = one_mass(case, phases, mass=mass, frequency=frequency, fine=True, damping=c)
        run = gf.simulate(machine, 143 / frequency, rate=64 * frequency, initial=([start[0]], [0.0]), filtered=False, **options)
        if phases == 64:
            options = {"rtol": 1e-8, "atol": 1e-14, "max_step": 0.01 / frequency}
            want = solve_ivp(rate, (0, run.time[-1]), start, "DOP853", run.time, **options).y[0]
        differs = np.abs(run["pair.x"] - want).max() / np.ptp(want)
        assert differs < limit
        assert differs < run.stats["error"] + run.stats["error_phases"]


@pytest.mark.slow
def test_eccentric_pinion_runs_as_one_off_its_axis():
    """30 um: one line of 30 um a turn in the transmission error; the force is that of a body off its axis."""
    flank = {"gear": "pinion", "eccentricity_um": 30.0}
    for phases in (8, 32):
        te = gf.transmission_error(scene(flank).case(), phases=phases, span="revolution").te[0]
        assert_allclose(2 / te.size * np.abs(np.fft.rfft(te))[1], 30e-6, rtol=1e-3)
    machines = gf.build_machine(scene(flank)), gf.build_machine(scene(machine={"runout_um": 30.0}))
    own, other = (recorded(machine, 0.2, 16 * MESH)["force mesh"] for machine in machines)
    assert_allclose([own.min(), own.max(), own.mean()], [other.min(), other.max(), other.mean()], atol=0.05 * np.ptp(other))
    assert_allclose(own.mean(), 1669.3, rtol=2e-3)


def test_pitch_of_one_tooth_reaches_the_vibration():
    """20 um on tooth 3: sidebands of the pinion's turns, and the fault is named."""
    machine = gf.build_machine(scene({"gear": "pinion", "pitch_um": [0.0, 0.0, 0.0, 20.0] + [0.0] * 13}))
    assert amplitude(machine, MESH - TURNS["pinion"]).min() > 10
    assert f"{machine.faults[0]}" == "tooth 3 of the pinion: off its place; it meshes at 40 Hz"


@pytest.mark.slow
def test_several_loads_with_damage_of_both_gears():
    """Force laws: at the load of the curves they give the same force as curves do."""
    both = scene(crack=[{"gear": "pinion", "tooth": 3}, {"gear": "wheel", "tooth": 3}])
    one, law = (gf.build_machine(both, "cracked", phases=32, loads=loads) for loads in ((1.0,), (0.8, 1.0, 1.25)))
    phase = np.arange(-4, 4, 1 / 32)
    secant = law.meshes[0].secants[0](phase % 1.0, 5.3e-6)[0]
    assert len(law.meshes[0].changes) == len(one.meshes[0].changes) == len(law.meshes[0].secants) - 1
    at = law.meshes[0].at_phase(phase)
    assert_allclose(at, one.meshes[0].at_phase(phase), rtol=5e-3)
    assert np.abs(secant / at - 1).max() > 0.05
    with pytest.raises(ValueError, match="give one load"):
        gf.build_machine(scene({"gear": "pinion", "eccentricity_um": 5.0}), phases=16, loads=(0.8, 1.0, 1.25))


def test_mean_force_is_that_of_the_force_not_of_its_size():
    """A force that swings through zero has the mean of its own sign."""
    cycle = gf.mesh_cycle(small_pair(), gf.Solve(phases=16))
    swing = gf.single_mesh(0.15, cycle.healthy, MESH, force=lambda t: 1000 + 4000 * np.sin(2 * math.pi * MESH * t), zeta=0.03)
    run = gf.simulate(swing, 0.1)
    assert run["force mesh"].min() < -1000
    assert all(line.startswith(("mesh 999", "mesh 1000")) for line in run.stats.get("loads", ()))


def test_models_that_cannot_have_an_input_say_why():
    """The impact law is of involutes, and of one pinion tooth."""
    with pytest.raises(ValueError, match="neglects flank deviations"):
        gf.build_machine(replace(scene({"gear": "pinion", "eccentricity_um": 5.0}), machine=impact()))
    with pytest.raises(ValueError, match="one flank of the pinion"):
        gf.build_machine(replace(scene(crack=[{"gear": "wheel"}]), machine=impact()), "cracked")


def impact():
    """Machine table with the impact law."""
    return scene(machine={"contact": "impact"}).machine


@pytest.mark.slow
def test_slow_rotation_with_a_missing_tooth_has_the_transmission_error():
    """With the gap: as contact solved over the whole revolution has it, and as a mass that is moved slowly."""
    case = replace(scene(missing_tooth=[{"gear": "pinion", "tooth": 3}]).case(case="missing"), force=1669.298)
    cycle = gf.mesh_cycle(case, gf.Solve(phases=32))
    te = cycle.sampled("deflection") + cycle.sampled("unloaded")
    assert 5e-5 < np.ptp(te) < 3e-4
    want = gf.solve(case, gf.Solve(phases=32, span="revolution")).te
    assert_allclose(te, want, atol=1e-12)
    options = {"teeth": (17, 38), "damage": teeth_of(cycle), "zeta": 1.0, "backlash": 1e-3}
    machine = gf.single_mesh(1e-2, cycle.healthy, 1.0, force=1669.298, **options)
    run = gf.simulate(machine, 17.0, rate=32.0, filtered=False)
    assert_allclose(run["pair.x"][32:544], te[32:], atol=1e-3 * np.ptp(te))


BALANCED = {
    "shifts": {
        "flank": {"gear": "pinion", "pitch_um": [0.0] * 5 + [20.0] + [0.0] * 11},
        "crack": [{"gear": "pinion", "tooth": 3}],
    },
    "gap": {"missing_tooth": [{"gear": "pinion", "tooth": 3}]},
}


@pytest.mark.parametrize("name", BALANCED)
def test_energy_and_momentum_balance_with_shifts_and_gaps(name):
    """Over a revolution: what the load, the changing stiffness and the error put in is stored or taken by the damper."""
    made = scene(**BALANCED[name])
    case = replace(made.case(case=next(iter(made.pair().damage))), force=1669.298)
    cycle = gf.mesh_cycle(case, gf.Solve(phases=32))
    options = {"teeth": (17, 38), "damage": teeth_of(cycle), "zeta": 0.03, "backlash": 1e-3}
    machine = gf.single_mesh(0.15, cycle.healthy, MESH, force=1669.298, **options)
    run = stepped(machine, 17 / MESH, dt=1 / MESH / 2048)
    t, v, force, mesh = run.time, run["pair.x velocity"], run["force mesh"], machine.meshes[0]
    error, rate = mesh.e(t)[:2]
    x = np.maximum(run["pair.x"] - error, 0.0)
    assert ((x == 0).any(), np.ptp(error) > 5e-6) == (name == "gap", True)
    spent = machine.law["damping"][0] * (v - rate) ** 2
    power = 1669.298 * v + np.gradient(mesh.k(t), t, edge_order=2) * x**2 / 2 - spent - force * rate
    energy = 0.15 * v**2 / 2 + mesh.k(t) * x**2 / 2
    moved = np.trapezoid(np.abs(force * rate) + spent, t)
    assert abs(energy[-1] - energy[0] - np.trapezoid(power, t)) < 1e-3 * moved
    push = 1669.298 - force
    assert abs(0.15 * (v[-1] - v[0]) - np.trapezoid(push, t)) < 1e-5 * np.trapezoid(np.abs(push), t)
