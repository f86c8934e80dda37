"""Integrators against closed forms, independent integrations and conservation laws; steady states; contact laws; responses."""

import importlib.util
import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.io import loadmat
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b

from gearfe.contact_law import force, friction_coefficient, slopes, step
from gearfe.dynamics import simulate
from gearfe.machine import Load, Machine, Spring, natural_frequencies, pulses
from gearfe.mesh_errors import with_errors
from gearfe.meshing import Mesh, Samples, ToothDamage, cycle_table
from gearfe.models import single_mesh
from gearfe.steady import common_period, floquet, steady_state

WAVE = 1e8 * (1 + 0.2 * np.cos(2 * math.pi * np.arange(64) / 64))
RUNS = [False] + [True] * (importlib.util.find_spec("numba") is not None)  # compiled loop where there is one


def two_masses(c=10.0, zeta=0.03, stiffness=WAVE, load=1000.0, **mesh):
    one = Mesh("m", np.array([1.0, -1.0]), stiffness, frequency=500.0, zeta=zeta, **mesh)
    ground = Spring("ground", np.array([0.0, 1.0]), 5e7, c)
    return Machine(("a.x", "b.x"), np.array([1.0, 2.0]), (ground,), (one,), (Load("F", np.array([1.0, 0.0]), load),))


def worst(got, want):
    """Largest error of a displacement over its range."""
    return (np.abs(got.q - want.q).max(axis=0) / np.ptp(want.q, axis=0)).max()


def test_step_and_friction_at_their_corners():
    assert_allclose(step([-1, 0, 0.25, 0.5, 1, 2], 0, 1.0, 1, 3.0), [1, 1, 1.3125, 2, 3, 3])
    slip = np.array([-1.0, -1e-4, -5e-5, 0.0, 5e-5, 1e-4, 5.05e-3, 1e-2, 1.0])
    got = friction_coefficient(slip, static=0.08, dynamic=0.05, v_static=1e-4, v_dynamic=1e-2)
    assert_allclose(got, [-0.05, -0.08, -0.055, 0, 0.055, 0.08, 0.065, 0.05, 0.05], atol=1e-12)


def test_slopes_are_derivatives_of_the_force():
    law = {
        "power": np.array([1.0, 1.0, 1.5, 1.5]),
        "damping": np.array([50.0, 30.0, 80.0, 80.0]),
        "beta": np.array([0.0, 1e-6, 0.0, 0.0]),
        "per_depth": np.array([0.0, 0.0, 1e4, 1e4]),
        "backlash": np.array([0.0, 2e-5, np.inf, 3e-5]),
        "film": np.array([1.0, 0.3, 1.0, 0.0]),
        "push": np.array([False, False, True, True]),
    }
    rng = np.random.default_rng(3)
    k, h = np.array([1e8, 2e8, 3e9, 3e9]), 1e-9
    for _ in range(200):
        x, v = rng.uniform(-1e-4, 1e-4, 4), rng.uniform(-0.2, 0.2, 4)
        near = np.minimum(np.abs(x), np.abs(x + law["backlash"])) < 1e-6
        by_x, by_v = slopes(x, v, k, law)
        numeric = (force(x + h, v, k, law) - force(x - h, v, k, law)) / (2 * h)
        ok = ~near & (np.sign(force(x - h, v, k, law)) == np.sign(force(x + h, v, k, law)))
        assert_allclose(by_x[ok], numeric[ok], rtol=1e-3, atol=1e-2)
        numeric = (force(x, v + 1e-6, k, law) - force(x, v - 1e-6, k, law)) / 2e-6
        assert_allclose(by_v[ok], numeric[ok], rtol=1e-5, atol=1e-4)


def test_table_passes_through_its_samples_without_overshoot():
    rng = np.random.default_rng(1)
    values = rng.uniform(0, 1, 40)
    table = cycle_table(values)
    assert_allclose(table(np.arange(40) / 40), values, rtol=1e-12)
    fine = table(np.linspace(0, 1, 4001)[:-1])
    assert values.min() - 1e-12 <= fine.min()
    assert fine.max() <= values.max() + 1e-12
    assert_allclose(table.mean, fine.mean(), rtol=1e-6)


def test_damaged_tooth_replaces_the_healthy_curve_once_in_z_cycles():
    phase = np.arange(-16, 116) / 64
    hurt = Samples(phase, 0.7 * cycle_table(WAVE)(phase % 1.0))
    mesh = Mesh("m", np.ones(1), WAVE, 100.0, phase=-3.0, teeth=(5, 7), damage=(ToothDamage(0, 2, hurt),))
    inside = np.linspace(-0.2, 1.75, 300)
    for cycle in (2, 7, 12, -3):
        assert_allclose(mesh.at_phase(cycle + inside), 0.7 * mesh.cycle(inside % 1.0), rtol=2e-4)
    assert_allclose(mesh.at_phase(4.2 + np.linspace(0, 2.4, 50)), mesh.cycle((4.2 + np.linspace(0, 2.4, 50)) % 1.0), rtol=1e-12)
    assert_allclose(mesh.entries(0.2), [[0, 0.05, 0.1, 0.15, 0.2]], atol=1e-12)
    assert_allclose(mesh.k(0.05 + 0.007), mesh.at_phase(2.7))


@pytest.mark.parametrize("compiled", RUNS)
def test_order_of_the_fast_path_and_the_reference(compiled):
    """Smooth stiffness and error: fourth order, and the same as RK45 and DOP853, which share nothing with it but the tables."""
    fine = 1e8 * (1 + 0.2 * np.cos(2 * math.pi * np.arange(1024) / 1024))
    machine = two_masses(stiffness=fine, error=((1e-6, 500.0, 0.3),))
    want = simulate(machine, 0.004, dt=1e-4, method="DOP853", rtol=1e-10)
    other = simulate(machine, 0.004, dt=1e-4, method="RK45", rtol=1e-6)
    assert worst(other, want) < 1e-4
    errors = [worst(simulate(machine, 0.004, dt=dt, every=round(1e-4 / dt), numba=compiled), want) for dt in (1e-4, 5e-5, 2.5e-5)]
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (rates > 3.5).all(), (errors, rates)
    assert errors[-1] < 1e-5


@pytest.mark.parametrize("compiled", RUNS)
def test_order_survives_contact_loss(compiled):
    """Steps are halved about changes of contact: the error falls by far more than the first order of plain fixed steps."""
    machine = two_masses(error=((80e-6, 500.0, 0.3),), backlash=4e-5)
    want = simulate(machine, 0.01, dt=1e-4, method="RK45", rtol=1e-9)
    runs = [simulate(machine, 0.01, dt=dt, every=round(1e-4 / dt), numba=compiled) for dt in (5e-5, 2.5e-5, 1.25e-5)]
    errors = np.array([worst(run, want) for run in runs])
    assert runs[0].stats["losses"] >= 5
    assert want["force m"].min() < -1000  # the back flanks hit too
    assert (np.log2(errors[:-1] / errors[1:]) > 2.5).all(), errors
    assert errors[-1] < 1e-4


def test_compiled_loop_is_the_same(monkeypatch):
    """Where numba is missing its loop is run as it stands, for a shorter time."""
    monkeypatch.setattr("gearfe.fast.find_spec", lambda name: True)
    duration = 0.02 if importlib.util.find_spec("numba") else 0.006
    cases = [
        two_masses(error=((1e-6, 500.0, 0.3),)),
        two_masses(error=((80e-6, 500.0, 0.3),), backlash=4e-5),
        two_masses(load=pulses(500.0, 3000.0, 4e-3, 1e-3, 4), film=0.2, backlash=1e-4, beta=1e-6),
        two_masses(
            load=lambda t: 800 + 300 * np.sin(600 * t), backlash=np.inf, power=1.5, depth=5e-5, push=True, stiffness=300 * WAVE
        ),
    ]
    for machine in cases:
        one, two = (simulate(machine, duration, dt=5e-5, numba=numba) for numba in (False, True))
        assert_allclose(two.q, one.q, atol=1e-9 * np.ptp(one.q))
        assert one.stats["losses"] == two.stats["losses"]


@pytest.mark.parametrize(
    "options", [{"method": "fast", "numba": False}, pytest.param({"method": "DOP853", "rtol": 1e-10}, marks=pytest.mark.slow)]
)
def test_energy_of_free_vibration_over_1000_periods(options):
    """Constant stiffness, no damping: the energy stays within 1e-6 over 1000 periods of the slowest mode."""
    row = np.array([1.0, -1.0])
    ground = Spring("ground", np.array([0.0, 1.0]), 5e7)
    machine = Machine(("a.x", "b.x"), np.array([1.0, 2.0]), (ground,), (Mesh("m", row, 1e8),))
    slow = natural_frequencies(machine)[0][0]
    start = np.array([1e-5, -2e-5]), np.array([0.1, 0.05])
    got = simulate(machine, 1000 / slow, initial=start, dt=0.7 / slow, **options)
    energy = 0.5 * (got.v**2 @ machine.mass + np.einsum("ti,ij,tj->t", got.q, machine.linear()[0], got.q))
    assert_allclose(energy, energy[0], rtol=1e-6)


def test_power_in_is_power_dissipated():
    """Over a steady period: work of the loads, of the error and of the changing stiffness is what the dampers take."""
    machine = two_masses(c=3000.0, error=((2e-6, 500.0, 0.3),))
    found = steady_state(machine, dt=1 / 500 / 800)
    r, mesh = found.response, machine.meshes[0]
    t = r.time
    rate = mesh.e(t)[1]
    x, c = r["compression m"], machine.law["damping"][0]
    v = r["a.x velocity"] - r["b.x velocity"]
    k = mesh.k(t)
    slope = np.gradient(k, t, edge_order=2)
    work = 1000 * r["a.x velocity"] + r["force m"] * rate * 1.0 + 0.5 * slope * x**2
    loss = c * (v - rate) ** 2 + 3000.0 * r["b.x velocity"] ** 2
    assert loss.mean() > 0
    assert_allclose(np.trapezoid(loss, t), np.trapezoid(work - 2 * r["force m"] * rate, t), rtol=1e-3)


@pytest.mark.parametrize(("gamma", "order"), [(0.3, 1), (0.2, 2)])
def test_instability_boundaries_of_mathieu(gamma, order):
    """``m x'' + k0 (1 + gamma cos(2 pi f t)) x = 0`` is unstable in the tongues between the characteristic values a_r and b_r."""
    omega, k = 1e4, 1e8 * (1 + gamma * np.cos(2 * math.pi * np.arange(2048) / 2048))

    def boundary(value):  # a = (2 omega / W)**2, q = gamma a / 2
        return brentq(lambda w: 4 / w**2 - value(order, 2 * gamma / w**2), 1.6 / order, 2.5 / order)

    low, high = sorted((boundary(mathieu_a), boundary(mathieu_b)))
    away = 0.05 * (high - low)
    inside = {low - away: False, low + away: True, high - away: True, high + away: False}
    for ratio, unstable in inside.items():
        machine = single_mesh(1.0, k, ratio * omega / (2 * math.pi))
        largest = abs(floquet(machine, dt=2 * math.pi / (ratio * omega) / 200)[0])
        assert (largest > 1 + 1e-5) == unstable, (ratio, largest)


def test_multipliers_against_a_general_integrator():
    k, frequency, c = 1e8 * (1 + 0.3 * np.cos(2 * math.pi * np.arange(2048) / 2048)), 2900.0, 200.0
    got = floquet(single_mesh(1.0, k, frequency, damping=c), dt=1 / frequency / 200)

    def rate(t, y):
        return [y[1], -c * y[1] - 1e8 * (1 + 0.3 * math.cos(2 * math.pi * frequency * t)) * y[0]]

    ends = [solve_ivp(rate, (0, 1 / frequency), start, "DOP853", rtol=1e-12, atol=1e-14).y[:, -1] for start in ([1, 0], [0, 1])]
    want = np.linalg.eigvals(np.array(ends).T)
    assert_allclose(np.sort_complex(got), np.sort_complex(want), rtol=1e-5)


def exact_bouncing(times, *, k=1e8, c=400.0, load=300.0, amplitude=20e-6, omega=2 * math.pi * 700.0):
    """Piecewise exact motion of one mass on a one-sided mesh with error ``e = amplitude sin(omega t)``, the switches by brentq.

    In terms of ``x = q - e``: touching ``x'' + c x' + k x = F - e''`` (m = 1), in flight ``q'' = F``.
    """
    decay, turn = c / 2, math.sqrt(k - c**2 / 4)
    forced = amplitude * omega**2 / (k - omega**2 + 1j * c * omega)  # of exp(i omega t), imaginary part

    def touching(t0, x0, v0):
        def particular(t):
            wave = forced * np.exp(1j * omega * t)
            return load / k + wave.imag, (1j * omega * wave).imag

        p, dp = particular(t0)
        a, b = x0 - p, (v0 - dp + decay * (x0 - p)) / turn

        def at(t):
            s = t - t0
            damp, cos, sin = np.exp(-decay * s), np.cos(turn * s), np.sin(turn * s)
            own, speed = particular(t)
            x = damp * (a * cos + b * sin)
            return x + own, damp * turn * (b * cos - a * sin) - decay * x + speed

        return at

    def flying(t0, x0, v0):
        e0, r0 = amplitude * math.sin(omega * t0), amplitude * omega * math.cos(omega * t0)

        def at(t):
            q = x0 + e0 + (v0 + r0) * (t - t0) + load / 2 * (t - t0) ** 2
            return q - amplitude * np.sin(omega * t), v0 + r0 + load * (t - t0) - amplitude * omega * np.cos(omega * t)

        return at

    state, t0, touch, out, losses = (load / k, -amplitude * omega), 0.0, True, [], 0
    while t0 < times[-1]:
        at = (touching if touch else flying)(t0, *state)
        grid = t0 + np.linspace(0, 2e-3, 4001)[1:]
        sign = 1 if touch else -1
        crossed = np.flatnonzero((sign * at(grid)[0] < 0) & (grid > t0 + 1e-8))
        end = (
            times[-1] + 1e-9
            if not crossed.size
            else brentq(lambda t, at=at: at(t)[0], grid[max(crossed[0] - 1, 0)], grid[crossed[0]])
        )
        if not crossed.size:
            end = grid[-1]
        inside = times[(times >= t0) & (times < end)]
        out.append(at(inside)[0] + amplitude * np.sin(omega * inside))
        losses += bool(touch and crossed.size and end <= times[-1])
        if crossed.size:
            state, touch = (0.0, at(end)[1]), not touch
        else:
            state = at(end)
        t0 = end
    return np.concatenate(out), losses


@pytest.mark.parametrize("compiled", RUNS)
def test_backlash_oscillator_against_its_piecewise_exact_motion(compiled):
    error, w = ((20e-6, 700.0, 0.0),), 2 * math.pi * 700
    machine = single_mesh(1.0, 1e8, 700.0, force=300.0, damping=400.0, backlash=np.inf, film=0.0, error=error)
    start = np.array([300.0 / 1e8]), np.array([0.0])
    got = simulate(machine, 0.01, dt=5e-6, initial=start, numba=compiled)
    want, losses = exact_bouncing(got.time, omega=w)
    assert losses >= 5
    assert got.stats["losses"] == losses
    assert_allclose(got["pair.x"], want, atol=1e-3 * np.ptp(want))


def test_steady_state_is_where_the_transient_ends():
    machine = two_masses(c=2000.0, zeta=0.1, error=((3e-6, 500.0, 0.3),))
    found = steady_state(machine, dt=2.5e-5)
    late = simulate(machine, 0.2, dt=2.5e-5, numba=False)
    n = found.response.time.size
    assert found.stable
    assert found.residual < 1e-9
    assert_allclose(found.response.q, late.q[-n:], atol=1e-5 * np.ptp(late.q[-n:]))


def test_steady_state_with_contact_loss():
    machine = single_mesh(1.0, 1e8, 700.0, force=1500.0, damping=3000.0, backlash=np.inf, error=((15e-6, 1400.0, 0.0),))
    dt = 1 / 700 / 100
    late = simulate(machine, 140 / 700, dt=dt, numba=False)
    n = 100
    found = steady_state(machine, dt=dt, initial=(late.q[-1 - n], late.v[-1 - n]))
    assert found.response["force mesh"].min() < 0.9 * 1500
    assert found.stable
    assert_allclose(found.response["pair.x"].max(), late["pair.x"][-n:].max(), rtol=1e-4)


def test_period_and_what_has_none():
    machine = two_masses(error=((1e-6, 200.0, 0.0),))
    assert_allclose(common_period(machine), 0.01)
    with pytest.raises(ValueError, match="no common period"):
        common_period(two_masses(error=((1e-6, 500 * math.sqrt(2), 0.0),)))
    with pytest.raises(ValueError, match="give the period"):
        common_period(two_masses(load=lambda t: t))


def test_rigid_body_motion_and_torque_histories():
    """Two free bodies in mesh under a jump of torque: the centre of mass moves as a point mass would, by every method."""
    row = np.array([1.0, -1.0])
    jump = np.array([0.0, 4e-3, 4e-3, 1.0]), np.array([0.0, 0.0, 100.0, 100.0])
    machine = Machine(
        ("a.x", "b.x"), np.array([1.0, 3.0]), (), (Mesh("m", row, WAVE, 500.0),), (Load("F", np.array([1.0, 0.0]), jump),)
    )
    for options in ({"numba": False, "dt": 3e-5}, {"method": "RK45", "dt": 1e-4}):
        got = simulate(machine, 0.01, initial=(np.zeros(2), np.zeros(2)), **options)
        want = 100 / 4 * np.maximum(got.time - 4e-3, 0) ** 2 / 2
        assert_allclose(got.q @ machine.mass / 4, want, atol=2e-3 * want.max())
    assert natural_frequencies(machine)[0][0] == 0.0


def test_errors_of_a_machine_shift_its_bodies():
    """A body displaced by s answers as the error -row s: at rest the misplaced teeth carry the same forces as a moved body."""
    machine = two_masses()
    moved = with_errors(machine, profile=1e-6, runout={"a": (2e-6, 30.0, 0.4)}, place={"b": (5e-7, 0.0)})
    t = np.linspace(0, 0.05, 7)
    want = 1e-6 * np.sin(2 * math.pi * 500 * t) - 2e-6 * np.cos(2 * math.pi * 30 * t + 0.4) + 5e-7
    assert_allclose(moved.meshes[0].e(t)[0], want, atol=1e-18)
    with pytest.raises(ValueError, match="no body 'c'"):
        with_errors(machine, place={"c": (0.0, 0.0)})


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"duration": 0.0}, "duration"),
        ({"method": "RK4"}, "method"),
        ({"dt": -1.0}, "dt"),
        ({"every": 0}, "every"),
        ({"initial": (np.zeros(2), np.array([0.0, np.nan]))}, "initial"),
    ],
)
def test_impossible_input_is_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        simulate(two_masses(), **({"duration": 0.01} | changes))


def test_impossible_machines_are_refused():
    machine = two_masses()
    with pytest.raises(ValueError, match="mass"):
        replace(machine, mass=np.array([1.0, 0.0]))
    with pytest.raises(ValueError, match="finite numbers"):
        replace(machine, springs=(Spring("s", np.ones(3), 1.0),))
    with pytest.raises(ValueError, match="needs a backlash"):
        Mesh("m", np.ones(1), 1e8, power=1.5)
    with pytest.raises(RuntimeError, match="no state of rest"):
        single_mesh(1.0, 1e8, 100.0, force=-10.0, backlash=np.inf).rest()


def test_unstable_machine_ends_in_an_error():
    machine = single_mesh(1.0, 1e8 * (1 + 0.9 * np.cos(2 * math.pi * np.arange(64) / 64)), 1e4 / math.pi, force=1.0)
    with pytest.raises(RuntimeError, match="unstable"):
        simulate(machine, 2.0, numba=False)


@pytest.mark.parametrize("kind", ["broken tooth", "zero damping", "loss everywhere", "stiff bearing", "resonance"])
def test_hard_cases_end_in_a_result_with_an_error(kind):
    phase = np.arange(-16, 116) / 64
    broken = ToothDamage(0, 0, Samples(phase, np.where((phase > 0.6) & (phase < 1.0), 0.0, 0.5) * cycle_table(WAVE)(phase % 1.0)))
    machine = {
        "broken tooth": two_masses(teeth=(5, 7), damage=(broken,)),
        "zero damping": two_masses(c=0.0, zeta=0.0),
        "loss everywhere": two_masses(load=50.0, error=((80e-6, 500.0, 0.3),), backlash=4e-5),
        "stiff bearing": replace(two_masses(), springs=(Spring("ground", np.array([0.0, 1.0]), 5e11, 10.0),)),
        "resonance": two_masses(c=1.0, zeta=1e-3, error=((1e-6, 630.48, 0.0),)),
    }[kind]
    got = simulate(machine, 0.02, dt=1.25e-5, error=True, numba=False)
    assert np.isfinite(got.q).all()
    assert got.stats["error"] < 1e-2
    if kind == "stiff bearing":  # the held body stays: one mass on the mesh
        held = single_mesh(1.0, WAVE, 500.0, force=1000.0, damping=machine.law["damping"][0])
        want = simulate(held, 0.02, dt=1.25e-5, method="RK45", rtol=1e-6)
        away = np.abs(got["a.x"] - want["pair.x"]).max() / np.ptp(want["pair.x"])
    else:
        away = worst(got, simulate(machine, 0.02, dt=1.25e-5, method="RK45", rtol=1e-6))
    assert away < 2 * got.stats["error"] + 2e-3


def test_channels_units_and_files(tmp_path):
    machine = two_masses(error=((1e-6, 500.0, 0.3),))
    r = simulate(machine, 0.01, dt=2e-5, numba=False)
    speed, motion = r["a.x velocity"], r["a.x"]
    assert_allclose(np.gradient(motion, r.time)[2:-2], speed[2:-2], atol=5e-3 * np.ptp(speed))
    assert_allclose(np.gradient(speed, r.time)[2:-2], r["a.x acceleration"][2:-2], atol=2e-2 * np.ptp(r["a.x acceleration"]))
    assert_allclose(r["a.x acceleration"], 1000.0 - r["force m"], rtol=1e-6, atol=1e-3)
    units = {"a.x": "m", "b.x velocity": "m/s", "a.x acceleration": "m/s2", "force m": "N", "stiffness m": "N/m"}
    assert {name: r.unit(name) for name in units} == units
    assert len(r.names) == 3 * 2 + 3
    with pytest.raises(ValueError, match="no channel"):
        r["c.x"]
    r.save(tmp_path / "r.csv", ["a.x", "force m"])
    rows = np.loadtxt(tmp_path / "r.csv", delimiter=",", skiprows=3)
    assert_allclose(rows, np.stack([r.time, r["a.x"], r["force m"]], axis=1), rtol=0)
    r.save(tmp_path / "r.npz")
    with np.load(tmp_path / "r.npz") as data:
        assert list(data["names"]) == ["a.x", "b.x", "force m"]
        assert_allclose(data["values"][:, 2], r["force m"], rtol=0)
    r.save(tmp_path / "r.mat")
    data = loadmat(tmp_path / "r.mat")
    assert_allclose(data["values"], np.stack([r["a.x"], r["b.x"], r["force m"]], axis=1), rtol=0)
    with pytest.raises(ValueError, match="no format"):
        r.save(tmp_path / "r.txt")


@pytest.mark.skipif(importlib.util.find_spec("numba") is not None, reason="numba is there")
def test_asking_for_numba_without_having_it_is_refused():
    with pytest.raises(ValueError, match="not installed"):
        simulate(two_masses(), 0.001, numba=True)
