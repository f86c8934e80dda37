"""Integrators against closed forms, independent integrations and conservation laws."""

import math
from dataclasses import replace

import numpy as np
import pytest
from machines import WAVE, stepped, two_masses, worst
from numpy.testing import assert_allclose

from gearfe.dynamics.machine.gear_mesh import GearMesh
from gearfe.dynamics.machine.loads import pulses
from gearfe.dynamics.machine.mesh_curves import Samples, cycle_table
from gearfe.dynamics.machine.modes import natural_frequencies
from gearfe.dynamics.machine.single_mesh import single_mesh
from gearfe.dynamics.machine.springs import Spring
from gearfe.dynamics.machine.tables import Machine
from gearfe.dynamics.machine.tooth_damage import ToothDamage
from gearfe.dynamics.motion.simulate import simulate


def test_order_of_the_fast_path_and_the_reference():
    """Smooth stiffness and error: fourth order, and the same as RK45 and DOP853, which share nothing with it but the tables."""
    fine = 1e8 * (1 + 0.2 * np.cos(2 * math.pi * np.arange(1024) / 1024))
    machine = two_masses(stiffness=fine, error=((1e-6, 500.0, 0.3),))
    want = stepped(machine, 0.002, dt=1e-4, method="DOP853", rtol=1e-10)
    other = stepped(machine, 0.002, dt=1e-4, method="RK45", rtol=1e-6)
    assert worst(other, want) < 1e-4
    errors = [worst(stepped(machine, 0.002, dt=dt, every=round(1e-4 / dt)), want) for dt in (1e-4, 5e-5, 2.5e-5)]
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (rates > 3.5).all(), (errors, rates)
    assert errors[-1] < 1e-5


PHASE = np.arange(-16, 116) / 64
BROKEN = np.where((PHASE > 0.6) & (PHASE < 1.0), 0.0, 0.5) * cycle_table(WAVE)(PHASE % 1.0)
MACHINES = {
    "broken tooth": two_masses(teeth=(5, 7), damage=(ToothDamage(0, 0, Samples(PHASE, BROKEN)),)),
    "zero damping": two_masses(c=0.0, zeta=0.0),
    "stiff bearing": replace(two_masses(), springs=(Spring("ground", np.array([0.0, 1.0]), 5e11, 10.0),)),
    "resonance": two_masses(c=1.0, zeta=1e-3, error=((1e-6, 630.48, 0.0),)),
    "smooth": two_masses(error=((1e-6, 500.0, 0.3),)),
    "loses contact": two_masses(error=((80e-6, 500.0, 0.3),), backlash=4e-5),
    "damped by its stiffness": two_masses(
        error=((1e-6, 500.0, 0.3),), damping_per_stiffness=1e-6, load=lambda t: 800 + 300 * np.sin(600 * t)
    ),
    "pulses and a film": two_masses(
        load=pulses(500.0, 3000.0, 4e-3, 1e-3, 4), film=0.2, backlash=1e-4, damping_per_stiffness=1e-6
    ),
    "impact law": two_masses(
        load=lambda t: 800 + 300 * np.sin(600 * t), backlash=np.inf, power=1.5, depth=5e-5, push=True, stiffness=300 * WAVE
    ),
}


@pytest.mark.parametrize("kind", MACHINES)
def test_every_law_and_load_is_integrated_as_by_the_reference(kind):
    """DOP853 shares the tables and the law with the fast path, not the exponential steps, nor how contact is located."""
    got = stepped(MACHINES[kind], 0.002, dt=5e-6, every=10)
    want = stepped(MACHINES[kind], 0.002, dt=5e-5, method="DOP853", rtol=1e-9)
    assert worst(got, want) < (5e-5 if kind in ("pulses and a film", "broken tooth", "stiff bearing") else 1e-6)
    assert got.stats["losses"] == want.stats["losses"]
    assert want.stats["losses"] > 0 or kind != "loses contact"


def test_energy_of_free_vibration_over_1000_periods():
    """Constant stiffness, no damping: the energy stays within 1e-6 over 1000 periods of the slowest mode."""
    row = np.array([1.0, -1.0])
    ground = Spring("ground", np.array([0.0, 1.0]), 5e7)
    machine = Machine(("a.x", "b.x"), np.array([1.0, 2.0]), (ground,), (GearMesh("m", row, 1e8),))
    slow = natural_frequencies(machine)[0][0]
    start = np.array([1e-5, -2e-5]), np.array([0.1, 0.05])
    got = stepped(machine, 1000 / slow, initial=start, dt=0.7 / slow)
    energy = 0.5 * (got.v**2 @ machine.mass + np.einsum("ti,ij,tj->t", got.q, machine.linear()[0], got.q))
    assert_allclose(energy, energy[0], rtol=1e-6)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"duration": 0.0}, "duration"),
        ({"method": "RK4"}, "method"),
        ({"step": 1.0}, "step"),
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
        GearMesh("m", np.ones(1), 1e8, power=1.5)
    with pytest.raises(RuntimeError, match="no static equilibrium"):
        single_mesh(1.0, 1e8, 100.0, force=-10.0, backlash=np.inf).rest()


def test_unstable_machine_ends_in_an_error():
    machine = single_mesh(1.0, 1e8 * (1 + 0.9 * np.cos(2 * math.pi * np.arange(64) / 64)), 1e4 / math.pi, force=1.0)
    with pytest.raises(RuntimeError, match="unstable"):
        simulate(machine, 2.0)
