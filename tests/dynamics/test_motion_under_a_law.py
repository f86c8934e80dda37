"""Motion under a force law: statics, contact solved at every step, energy, the reference, and loads outside the law.

The law and what it is held against share the contact solver; a brute-force integration shares neither its table nor its
integrator.
"""

import math
import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from machines import difference, worst
from numpy.testing import assert_allclose
from scipy.integrate import cumulative_simpson
from usual import PAIR

import gearfe as gf
from gearfe.dynamics.machine.of_scene import with_flanks
from gearfe.dynamics.machine.scene_curves import teeth_of
from gearfe.dynamics.motion.law_range import between_phases

STEEL = gf.Material(E=207e3, nu=0.25)
MASS, DAMPING = 0.15, 2 * 0.02 * math.sqrt(3.12e8 * 0.15)  # kg, N s/m
CRACK = {"pinion": [gf.Crack(level=0.5)]}


@cache
def law():
    return gf.force_law(PAIR, [50.0 * 2 ** (i / 2) for i in range(15)], STEEL, force=1600.0)


def mass(stiffness, frequency, force, **mesh):
    return gf.single_mesh(MASS, stiffness, frequency, force=force, **({"damping": DAMPING, "backlash": math.inf} | mesh))


def rms(values):
    return math.sqrt(np.mean(np.square(values)))


@pytest.mark.slow
@pytest.mark.parametrize("load", [120.0, 700.0, 3000.0])
def test_turned_slowly_a_mesh_has_its_static_transmission_error_at_every_load(load):
    frequency = 2.0
    response = gf.simulate(mass(law(), frequency, load, damping=20 * DAMPING), 1 / frequency, rate=256 * frequency)
    want = gf.mesh_stiffness(PAIR, load, STEEL, phases=256).deflection
    got = response["compression mesh"][:256]
    assert rms(got[8:] / want[8:] - 1) < 2e-3
    assert_allclose(got[8:], want[8:], rtol=1e-2, err_msg="the worst is between two phases solved where a pair comes in")
    assert abs(np.ptp(got[8:]) / np.ptp(want[8:]) - 1) < 0.01


@pytest.mark.parametrize("load", [pytest.param(300.0, marks=pytest.mark.slow), 1600.0])
def test_relieved_flanks_turned_slowly_have_the_transmission_error_that_the_contact_has(load):
    """Unloaded gaps and deflections together, at loads that close the relief and at such that do not."""
    gears = {"pinion": PAIR.gear_1, "wheel": PAIR.gear_2}
    flanks = {side: gf.Flank(tip_relief=0.01, tip_start_diameter=2 * one.r_a - 1.5) for side, one in gears.items()}
    relieved = gf.force_law(PAIR, [50.0 * 2 ** (i / 2) for i in range(13)], STEEL, force=1600.0, flanks=flanks)
    frequency = 2.0
    machine = with_flanks(mass(relieved, frequency, load, damping=20 * DAMPING))
    response = gf.simulate(machine, 1 / frequency, rate=128 * frequency, filtered=False)
    want = gf.mesh_stiffness(PAIR, load, STEEL, phases=128, flanks=flanks).te
    got = response["pair.x"][:128]
    assert rms(got[8:] / want[8:] - 1) < 5e-3
    assert_allclose(got[8:], want[8:], rtol=2e-2)
    assert rms(gf.mesh_stiffness(PAIR, load, STEEL, phases=128).te[8:] / want[8:] - 1) > 0.05, "the relief matters"


@pytest.mark.slow
def test_a_cracked_tooth_turned_slowly_has_its_static_transmission_error():
    loads, load, frequency = [200.0 * 2**i for i in range(4)], 900.0, 2.0
    hurt = gf.force_law(PAIR, loads, STEEL, damage=CRACK, span="tooth")
    more = {"damage": (gf.ToothDamage(0, 0, hurt),), "teeth": (21, 31), "damping": 20 * DAMPING, "phase": 20.0}
    machine = mass(gf.force_law(PAIR, loads, STEEL), frequency, load, **more)
    response = gf.simulate(machine, 2.5 / frequency, rate=128 * frequency, filtered=False)
    phase = 20.0 + frequency * response.time - 21
    near = (phase > -0.2) & (phase < 1.4)
    want = gf.mesh_stiffness(PAIR, load, STEEL, damage=CRACK, phases=phase[near]).deflection
    assert_allclose(response["compression mesh"][near], want, rtol=5e-3)
    healthy = gf.mesh_stiffness(PAIR, load, STEEL, phases=phase[near] % 1).deflection
    assert np.abs(want / healthy - 1).max() > 0.02, "the crack matters"


@pytest.mark.slow
def test_it_is_the_motion_of_contact_solved_at_every_step():
    frequency, load, steps, phase = 2500.0, 300.0, 60, 0.55  # half a cycle: a pair leaves, another comes in
    h = 0.5 / frequency / steps
    start = float(gf.mesh_stiffness(PAIR, load, STEEL, phases=[phase]).deflection[0])
    force = load

    def solved(x, t):
        """Force at a compression, by Newton's method on the load of the contact solver."""
        nonlocal force
        for _ in range(8):
            one = gf.mesh_stiffness(PAIR, force, STEEL, phases=[(phase + frequency * t) % 1])
            away = x - float(one.deflection[0])
            force = max(force + float(one.k_tangent[0]) * away, 20.0)
            if abs(away) < 1e-5 * x:
                return force
        raise AssertionError(f"no contact found at {x} m")

    def rate(t, q, v):
        return (load - solved(q, t) - DAMPING * v) / MASS

    q, v, path = start, 0.0, [start]
    for i in range(steps):  # Runge-Kutta-Nystroem, of order four
        t = i * h
        a = rate(t, q, v)
        b = rate(t + h / 2, q + h / 2 * v + h * h / 8 * a, v + h / 2 * a)
        c = rate(t + h / 2, q + h / 2 * v + h * h / 8 * a, v + h / 2 * b)
        d = rate(t + h, q + h * v + h * h / 2 * c, v + h * c)
        q, v = q + h * v + h * h / 6 * (a + b + c), v + h / 6 * (a + 2 * b + 2 * c + d)
        path.append(q)
    options = {"rate": 1 / h, "initial": ([start], [0.0])}
    got = gf.simulate(mass(law(), frequency, load, phase=phase), 0.5 / frequency, **options)
    own = gf.mesh_stiffness(PAIR, 1600.0, STEEL, phases=64)
    plain = gf.simulate(mass(own, frequency, load, phase=phase), 0.5 / frequency, **options)
    off, usual = (np.abs(one["pair.x"] - path).max() / np.ptp(path) for one in (got, plain))
    print(f"largest difference over the range: law {off:.1e}, stiffness of another load {usual:.1e}")
    assert off < 0.01
    assert usual > 0.2


def test_standing_still_energy_is_kept_through_losses_of_contact():
    machine = mass(law(), 0.0, 300.0, damping=0.0)
    response = gf.simulate(machine, 0.004, rate=1e6, initial=([4e-6], [0.0]), step=2.5e-7, filtered=False)
    assert response.stats["losses"] > 10
    x, v = response["pair.x"], response["pair.x velocity"]
    depth = np.linspace(0.0, 1.01 * x.max(), 20001)
    stored = cumulative_simpson(law()(depth, 0.0), x=depth, initial=0.0)
    energy = MASS * v**2 / 2 + np.interp(np.maximum(x, 0.0), depth, stored) - 300.0 * x
    assert np.ptp(energy) < 1e-4 * np.ptp(MASS * v**2 / 2)


@pytest.mark.parametrize("frequency", [2500.0, pytest.param(7000.0, marks=pytest.mark.slow)])
def test_the_fast_path_is_the_reference(frequency):
    machine = mass(law(), frequency, (np.array([0.0, 0.0006, 0.0012]), np.array([200.0, 800.0, 200.0])))
    got = gf.simulate(machine, 0.0012, rate=1e5)
    want = gf.simulate(machine, 0.0012, rate=1e5, method="DOP853", rtol=1e-6)
    assert worst(got, want) < 2 * got.stats["error"]
    assert worst(got, want) < 2e-3


@pytest.mark.parametrize("frequency", [pytest.param(1200.0, marks=pytest.mark.slow), 2500.0])
def test_the_estimate_covers_a_run_that_grows_worse_after_its_stretch(frequency):
    """Near superharmonic resonances of a little damped mass; before, 1.4e-3 of the range at an estimate of 5.5e-4."""
    machine = mass(law(), frequency, 1600.0, backlash=1e-4)
    got = gf.simulate(machine, 0.004, rate=1e4, filtered=False)
    want = gf.simulate(machine, 0.004, rate=1e4, method="DOP853", rtol=1e-7, filtered=False)
    assert max(difference(got, want)) < got.stats["error"] < 1e-3


def test_flanks_that_only_push_and_damp_by_depth_meet_under_a_law_as_the_reference_has_them():
    """Impact damping and loss of contact with the force of the law: both halve their steps about the same places."""
    impact = {"damping": 2e3, "depth": 1e-5, "push": True, "backlash": 1e-4, "error": ((40e-6, 1130.0, 0.0),)}
    machine = mass(law(), 2500.0, 800.0, **impact)
    got = gf.simulate(machine, 0.0015, rate=2e4)
    want = gf.simulate(machine, 0.0015, rate=2e4, method="DOP853", rtol=1e-7)
    assert got.stats["losses"] == want.stats["losses"] > 0
    assert worst(got, want) < got.stats["error"] < 1e-2


@pytest.mark.parametrize("load", [150.0, 1600.0])
def test_standing_still_small_vibration_has_the_frequency_of_the_tangent_at_its_load(load):
    at_load = gf.mesh_stiffness(PAIR, load, STEEL, phases=[0.4])
    start = 1.01 * float(at_load.deflection[0])
    response = gf.simulate(mass(law(), 0.0, load, damping=0.0, phase=0.4), 0.004, rate=1e6, initial=([start], [0.0]))
    x = response["pair.x"] - response["pair.x"].mean()
    ups = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    times = response.time[ups] - x[ups] / (x[ups + 1] - x[ups]) * 1e-6
    got = (times.size - 1) / (times[-1] - times[0])
    want, secant = (math.sqrt(float(k[0]) / MASS) / (2 * math.pi) for k in (at_load.k_tangent, at_load.k))
    assert abs(got / want - 1) < 3e-3
    assert abs(secant / want - 1) > 0.01


def test_a_law_that_no_load_changes_is_its_stiffness_over_the_phase():
    curve = gf.mesh_stiffness(PAIR, 1000.0, STEEL, phases=256)
    others = [
        replace(curve, k_tangent=curve.k, deflection=part * curve.deflection, meta=curve.meta | {"force_N": 1000.0 * part})
        for part in (0.1, 1.0, 3.0)
    ]
    same = gf.ForceLaw.of(others)
    given = {"frequency": 2500.0, "force": 800.0, "zeta": 0.02, "backlash": math.inf}
    one, two = (gf.simulate(gf.single_mesh(MASS, k, **given), 0.01, rate=1e5) for k in (curve, same))
    assert worst(two, one) < 2e-3


def test_steady_state_is_where_long_runs_end():
    machine = mass(law(), 2500.0, 1600.0, damping=4 * DAMPING)
    steady = gf.steady_state(machine)
    long = gf.simulate(machine, 0.02, rate=2e5)
    assert steady.stable
    last = long.time >= 0.02 - 1 / 2500 - 1e-9
    assert_allclose(rms(steady.response["pair.x acceleration"]), rms(long["pair.x acceleration"][last]), rtol=0.02)


def test_forces_above_the_loads_of_a_law_are_told():
    small = gf.force_law(PAIR, [100.0, 200.0, 400.0], STEEL, phases=16)
    with pytest.warns(UserWarning, match=r"mesh .* N, its force law up to 400 N"):
        response = gf.simulate(mass(small, 100.0, 900.0), 0.002)
    assert "up to 400 N" in response.stats["loads"][0]
    assert "loads" not in gf.simulate(mass(small, 100.0, 300.0), 0.002).stats
    curve = gf.mesh_stiffness(PAIR, 2000.0, STEEL)
    told = gf.simulate(mass(curve, 100.0, 1600.0), 0.002).stats["loads"]
    assert "its stiffness is that of 2000 N" in told[0]


def test_one_curve_says_within_which_loads_it_holds():
    """A load that swings about that of the curve is told although its mean is right; the loads named change k as much as told."""
    curve = gf.mesh_stiffness(PAIR, 1600.0, STEEL, phases=32)

    def told(low, high):
        history = (np.array([0.005, 0.015, 0.025, 0.035]), np.array([low, high, high, low]))
        return gf.simulate(mass(curve, 2500.0, history), 0.04, rate=25600.0).stats.get("loads", [])

    assert not told(1500.0, 1700.0)
    (line,) = told(200.0, 3000.0)
    mean, low, high, stated, least, most = (float(one) for one in re.findall(r"[\d.]+(?= N)|[\d.]+(?= to)", line))
    assert_allclose((mean, low, high, stated), (1600.0, 200.0, 3000.0, 1600.0), rtol=0.1)
    for load, change in ((least, -0.01), (most, 0.01)):
        k = gf.mesh_stiffness(PAIR, load, STEEL, phases=32).k.mean()
        assert_allclose(k / curve.k.mean() - 1, change, rtol=0.15)


CASE = gf.Case(PAIR, 1600.0, STEEL)


@cache
def dense_curve():
    return gf.solve(CASE, gf.Solve(phases=4096))


@pytest.mark.parametrize(
    ("phases", "fine", "most"), [(32, False, 0.1), (64, False, 0.02), (128, False, 5e-3), (32, True, 1e-3), (64, True, 5e-4)]
)
def test_the_error_of_a_stiffness_between_its_phases_is_told_and_covers(phases, fine, most):
    """Equal phases, and further ones where pairs enter and leave, against 4096 phases."""
    curve, dense = gf.mesh_cycle(CASE, gf.Solve(phases=phases), fine=fine).healthy, dense_curve()
    made = mass(curve, 2500.0, 1600.0)
    told = gf.simulate(made, 0.002).stats["error_phases"]
    true = rms(made.meshes[0].cycle(dense.phase) - dense.k) / np.ptp(dense.k)
    assert true < told < 20 * true
    assert true < most


HURT = {
    "crack": {"damage": {"wheel": [gf.Crack(level=0.35, tooth=5)]}},
    "chip": {"damage": {"pinion": [gf.Chip(depth=0.8, tooth=2)]}},
    "missing tooth": {"damage": {"pinion": [gf.MissingTooth(tooth=3)]}},
    "pitch": {"flanks": {"pinion": gf.Flank(pitch=(0.0, 0.012, *(0.0,) * (PAIR.gear_1.z - 2)))}},
}


@pytest.mark.slow
@pytest.mark.parametrize("fine", [False, True])
@pytest.mark.parametrize("name", HURT)
def test_the_error_between_phases_covers_damaged_teeth(name, fine):
    """Against phases by chance over the engagement of the tooth. Curves of missing teeth bend more than the healthy one."""
    case = gf.Case(PAIR, 1600.0, STEEL, **HURT[name])
    cycle = gf.mesh_cycle(case, gf.Solve(phases=32), fine=fine)
    teeth = PAIR.gear_1.z, PAIR.gear_2.z
    made = gf.single_mesh(1.0, cycle.healthy, 900.0, force=1600.0, teeth=teeth, damage=teeth_of(cycle))
    mesh, (part,) = made.meshes[0], cycle.parts
    phase = np.sort(np.random.default_rng(45).uniform(part.curve.phase[0], part.curve.phase[-1], 300))
    dense = gf.solve(case, gf.Solve(phases=phase + part.position, span="tooth"))
    true = rms(mesh.at_phase(phase + part.position) - dense.k) / np.ptp(dense.k)
    healthy, told = between_phases(replace(made, meshes=(replace(mesh, damage=()),))), between_phases(made)
    print(f"{name}, fine {fine}: true {true:.2e}, estimate {told:.2e}, of the healthy cycle {healthy:.2e}")
    assert true < told < 30 * true
    assert told > healthy or not fine or name not in ("missing tooth", "pitch")


def test_smooth_samples_are_known_between_them_and_laws_have_an_error_of_their_own():
    def told(count):
        wave = 3e8 * (1 + 0.1 * np.cos(6 * np.pi * np.arange(count) / count + 0.3))
        return gf.simulate(mass(wave, 2500.0, 1600.0), 0.002).stats["error_phases"]

    assert told(64) < 1e-3
    assert told(256) < told(128) / 12
    assert "error_phases" not in gf.simulate(mass(law(), 2500.0, 1600.0), 0.002).stats
    assert "error_phases" not in gf.simulate(mass(3e8, 2500.0, 1600.0), 0.002).stats
