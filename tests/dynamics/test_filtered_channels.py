"""Channels made of what the loop tells at every step, filtered: they are those that are computed at every step, then filtered."""

import math

import numpy as np
import pytest
from machines import WAVE, tooth, two_masses
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.machine.phase_table import table
from gearfe.dynamics.machine.tooth_damage import ToothDamage
from gearfe.dynamics.motion.fixed_step import fixed_steps
from gearfe.dynamics.motion.response import all_channels
from gearfe.dynamics.motion.thinned import stages, thinned

ERROR = ((2e-6, 500.0, 0.3), (1e-6, 0.0, 1.0))
IMPACT = {"power": 1.5, "push": True, "depth": 1e-5, "damping": 2e3, "zeta": 0.0, "stiffness": 5e9 / WAVE.mean() * WAVE}
HISTORY = np.array([0.0, 1e-3, 1e-3, 2e-3]), np.array([900.0, 1500.0, 600.0, 1100.0])
RUB = np.array([0.3, -0.1]), table(0.05 * np.sin(2 * np.pi * np.arange(32) / 32), 0.0, 1 / 32, periodic=True)


def under_a_law(**mesh):
    """With a cracked tooth, and solved at few phases."""
    pair = gf.GearPair(*(gf.Gear(z=z, r_bore=r, m_n=2.0, alpha_n=math.radians(20), b=20.0) for z, r in ((21, 7.4), (31, 11.4))))
    steel, loads = gf.Material(E=207e3, nu=0.25), [200.0, 800.0, 3200.0]
    hurt = gf.force_law(pair, loads, steel, phases=16, damage={"pinion": [gf.Crack(level=0.5)]}, span="tooth")
    damage = {"teeth": (21, 31), "damage": (ToothDamage(0, 0, hurt),)}
    return two_masses(stiffness=gf.force_law(pair, loads, steel, phases=16), **damage, **mesh)


MADE = {
    "always closed": lambda: two_masses(damping_per_stiffness=1e-6, error=ERROR),
    "lost contact": lambda: two_masses(backlash=4e-5, error=((80e-6, 500.0, 0.3),), film=0.2),
    "damaged tooth": lambda: two_masses(teeth=(5, 7), damage=(ToothDamage(0, 0, tooth(WAVE, 0.9, 1.5)),)),
    "load that jumps": lambda: two_masses(load=HISTORY),
    "load as a function": lambda: two_masses(load=lambda t: 1000 + 300 * np.sin(3000 * t)),
    "impacts": lambda: two_masses(backlash=1e-4, error=ERROR, **IMPACT),
    "force law": lambda: under_a_law(backlash=math.inf, error=ERROR),
    "friction": lambda: two_masses(friction=(RUB,)),
    "changing speed": lambda: gf.with_speed(two_masses(error=ERROR), [0.0, 0.004], [1.0, 1.6]),
}


@pytest.mark.parametrize("name", MADE)
def test_channels_are_those_of_every_step_filtered(name):
    machine, every, kept, start, length = MADE[name](), math.prod(stages(5)), 300, 0.0005, 0.003
    state = np.concatenate([machine.rest(start), np.zeros(2)])
    options = {"start": start, "adapt": name == "impacts"}
    got = fixed_steps(machine, length, kept * every, state, every=every, counts=stages(5), **options)
    whole = fixed_steps(machine, length, kept * every, state, **options)
    want = thinned([all_channels(whole)], stages(5))
    assert got.filtered.shape == want.shape == (kept + 1, 9)
    assert_allclose(got.states, whole.states[::every], rtol=0, atol=1e-12 * np.abs(whole.states).max())
    away = np.abs(got.filtered - want).max(axis=0)
    assert (away < 1e-6 * np.ptp(want, axis=0) + 1e-9 * np.abs(want).max(axis=0)).all(), away / np.abs(want).max(axis=0)
