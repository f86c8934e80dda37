"""Gearboxes of scenes against assemblies of the same stated model in plain numpy, written without the program's own."""

import copy
import math

import numpy as np
import pytest
from gearboxes import BRANCHING, PLANETARY, SPACE, TWO_STAGE
from numpy.testing import assert_allclose
from plain_train import Plain
from scipy.integrate import cumulative_simpson, solve_ivp

import gearfe as gf
from gearfe.dynamics.machine.gearbox import gearbox
from gearfe.dynamics.machine.of_scene import flat_machine
from gearfe.scene.load import scene_of

TRAINS = {"two stages": TWO_STAGE, "planetary": PLANETARY, "branching": BRANCHING, "planets in space": SPACE}
STIFFNESS = {"fast": 2.1e8, "slow": 3.3e8, "outer": 2.6e8, "inner": 4.1e8, "left": 1.7e8, "right": 2.9e8}


def stiffness(name):
    """Mean, amplitude and phase of the stiffness over the mesh cycle."""
    return STIFFNESS[name], 0.15 * STIFFNESS[name], len(name)


def sampled(name):
    mean, amplitude, turn = stiffness(name)
    return mean + amplitude * np.cos(2 * math.pi * np.arange(64) / 64 + turn)


def pair_of(name):
    """Scene, its machine with waves, and the plain one, with the order of its unknowns in the machine."""
    tables = TRAINS[name]
    made = scene_of("own.toml", copy.deepcopy(tables))
    plain = Plain(tables).build()
    curves = {pair: sampled(pair) for pair in tables["pair"]}
    machine = gearbox(made, curves, {mesh: () for mesh, *_ in plain.meshes})
    return made, machine, plain


def frequencies(K, G, mass):
    """Undamped, sorted angular frequencies of a gyroscopic system, by its first-order form."""
    n = mass.size
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-K / mass[:, None], -G / mass[:, None]]])
    return np.sort(np.abs(np.linalg.eigvals(A).imag))[::2] / (2 * math.pi)


@pytest.mark.parametrize("name", TRAINS)
def test_natural_frequencies_are_those_of_plain_matrices(name):
    _, machine, plain = pair_of(name)
    K = plain.K + sum(stiffness(kind)[0] * np.outer(g, g) for _, kind, g, _ in plain.meshes)
    got, want = gf.natural_frequencies(machine)[0], frequencies(K, plain.G, plain.M)
    assert len(got) == len(want)
    moving = want > 1e-4 * want.max() ** 0.5
    assert moving.sum() == len(want) - 1, "one rigid-body mode"
    assert_allclose(np.sort(got)[moving], want[moving], rtol=1e-9)
    assert got[0] == 0


@pytest.mark.parametrize("name", [*list(TRAINS)[:3], pytest.param("planets in space", marks=pytest.mark.slow)])
def test_response_is_that_of_the_plain_equations(name):
    made, machine, plain = pair_of(name)
    n, phases = plain.M.size, {mesh.name: mesh.phase for mesh in machine.meshes}
    rows = np.array([g for _, _, g, _ in plain.meshes])
    means, amplitudes, turns = (np.array([stiffness(kind)[i] for _, kind, *_ in plain.meshes]) for i in range(3))
    rates, starts = np.array([rate for *_, rate in plain.meshes]), np.array([phases[mesh] for mesh, *_ in plain.meshes])
    beta = made.machine["damping_per_stiffness_s"]

    def slope(t, u):
        q, v = u[:n], u[n:]
        k = means + amplitudes * np.cos(2 * math.pi * (starts + rates * t) + turns)
        force = rows.T @ (k * (rows @ (q + beta * v)))
        return np.concatenate([v, (plain.f - plain.K @ q - plain.C @ v - plain.G @ v - force) / plain.M])

    duration, zero = 0.01, np.zeros(n)
    t = np.linspace(0, duration, 101)
    want = solve_ivp(slope, (0, duration), np.zeros(2 * n), method="DOP853", t_eval=t, rtol=1e-10, atol=1e-13)
    got = gf.simulate(machine, duration, rate=10_000.0, initial=(zero, zero), step=2e-6, filtered=False)
    force = {mesh: stiffness(kind)[0] * (g @ want.y[:n] + beta * (g @ want.y[n:])) for mesh, kind, g, _ in plain.meshes}
    for i, (mesh, kind, g, _) in enumerate(plain.meshes):
        k = means[i] + amplitudes[i] * np.cos(2 * math.pi * (starts[i] + rates[i] * t) + turns[i])
        force[mesh] = k * (g @ want.y[:n] + beta * (g @ want.y[n:]))
        assert np.abs(got[f"force {mesh}"] - force[mesh]).max() < 1e-4 * np.ptp(force[mesh]), (mesh, kind)
    assert_allclose(
        np.sort(np.ptp(got.q, axis=0)), np.sort(np.ptp(want.y[:n], axis=1)), rtol=1e-3, atol=1e-4 * np.ptp(want.y[:n])
    )


@pytest.mark.parametrize("name", TRAINS)
def test_torques_balance_on_every_shaft_and_powers_in_all(name):
    made, machine, plain = pair_of(name)
    train = made.train
    assert max(map(abs, train.balance().values())) < 1e-10 * made.machine["torque_Nm"]
    power = sum(train.torques[end] * train.speeds[row["shaft"]] for end, row in train.ends.items())
    assert abs(power) < 1e-10 * train.torques["motor"] * train.speeds[train.ends["motor"]["shaft"]]
    assert_allclose(
        [train.speeds[shaft] for shaft in plain.w if shaft in train.speeds],
        [plain.w[s] for s in plain.w if s in train.speeds],
        rtol=1e-12,
    )
    assert_allclose([train.torques[end] for end in train.ends], [plain.torque(end) for end in train.ends], rtol=1e-12)
    flat = machine.with_meshes(stiffness=2e8)
    for mesh, force in zip(flat.meshes, 2e8 * (flat.G @ flat.rest()), strict=True):
        assert_allclose(force, train.forces[mesh.name.rstrip("0123456789")], rtol=1e-7, err_msg=mesh.name)


@pytest.mark.parametrize(("key", "value", "message"), [
    ("runout_um", 20.0, "neglect it; give dofs = 'six'"), ("misplaced_y_um", 1.0, "neglect it; give dofs = 'six'"),
    ("n_planets", 4, r"those of \[stage.NAME\]"), ("contact", "impact", "has linear contact only"),
])  # fmt: skip
def test_keys_that_a_gearbox_neglects_are_rejected(key, value, message):
    tables = copy.deepcopy(PLANETARY)
    tables["machine"][key] = value
    with pytest.raises(ValueError, match=message):
        flat_machine(scene_of("own.toml", tables))


@pytest.mark.parametrize("given", [{}, {"bearings_N_per_um": [1.0, 1.0], "bearings_axial_N_per_um": [0.0, 0.0]}])
def test_shafts_in_six_directions_need_bearings(given):
    tables = copy.deepcopy(TWO_STAGE)
    for key in ("bearings_N_per_um", "bearings_axial_N_per_um", "bearings_Ns_per_mm"):
        tables["shaft"]["three"].pop(key, None)
    tables["shaft"]["three"] |= given
    with pytest.raises(ValueError, match=r"\[shaft.three\].*(bearings_N_per_um|no bearing locates)"):
        flat_machine(scene_of("own.toml", tables))


@pytest.mark.parametrize(("table", "values", "message"), [
    ("shaft.two", {"bearings_at_mm": [15.0], "bearings_N_per_um": [150.0], "bearings_Ns_per_mm": [0.3]}, "two bearings or more"),
    ("stage.set", {"pin_tilt_Nm_per_mrad": 0.0}, "planet[1-4].tilt_. can move without any deflection"),
    ("stage.set", {"pin_N_per_um": None}, r"\[stage.set\]: dofs = 'six' needs pin_N_per_um"),
])  # fmt: skip
def test_bodies_in_six_directions_are_held(table, values, message):
    tables = copy.deepcopy(SPACE if table.startswith("stage") else TWO_STAGE)
    kind, name = table.split(".")
    tables[kind][name] = {key: value for key, value in (tables[kind][name] | values).items() if value is not None}
    with pytest.raises(ValueError, match=message):
        flat_machine(scene_of("own.toml", tables))


@pytest.mark.parametrize("name", TRAINS)
def test_work_of_the_loads_is_stored_or_lost(name):
    """From rest, with waves of stiffness: kinetic energy, energy and losses of springs, and work on the meshes are the work.

    Gyroscopic moments do no work. Simpson's rule at 400 kHz leaves the error of the integrator; the trapezoidal rule adds up to
    1e-7.
    """
    _, machine, plain = pair_of(name)
    n = plain.M.size
    run = gf.simulate(machine, 0.005, rate=400_000.0, initial=(np.zeros(n), np.zeros(n)), filtered=False, error=False)
    rows, k, c = (np.array([getattr(spring, field) for spring in machine.springs]) for field in ("row", "k", "c"))
    stored = 0.5 * (run.v**2 @ machine.mass + (run.q @ rows.T) ** 2 @ k)
    lost = (run.v @ rows.T) ** 2 @ c + sum(run[f"force {mesh.name}"] * (run.v @ mesh.row) for mesh in machine.meshes)
    work = cumulative_simpson(run.v @ machine.load(), x=run.time)
    gained = work - cumulative_simpson(lost, x=run.time)
    assert np.abs(stored[1:] - gained).max() < 2e-9 * np.abs(work).max()
