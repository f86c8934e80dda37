"""Steady states and their stability against closed forms and independent integrations."""

import math

import numpy as np
import pytest
from machines import stepped, tooth, two_masses
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b

from gearfe.dynamics.machine.single_mesh import single_mesh
from gearfe.dynamics.machine.tooth_damage import ToothDamage
from gearfe.dynamics.motion.steady import common_period, steady_state


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
        largest = abs(steady_state(machine, dt=2 * math.pi / (ratio * omega) / 200).multipliers[0])
        assert (largest > 1 + 1e-5) == unstable, (ratio, largest)


@pytest.mark.parametrize(("damping", "beta"), [(200.0, 0.0), (0.0, 3e-6)])
def test_multipliers_against_a_general_integrator(damping, beta):
    """``m x'' + c x' + k(t) (x + beta x') = 0``; the fast path carries compressions and rates as one."""
    k, frequency = 1e8 * (1 + 0.3 * np.cos(2 * math.pi * np.arange(2048) / 2048)), 2900.0
    machine = single_mesh(1.0, k, frequency, damping=damping, damping_per_stiffness=beta)
    got = steady_state(machine, dt=1 / frequency / 200).multipliers

    def rate(t, y):
        now = 1e8 * (1 + 0.3 * math.cos(2 * math.pi * frequency * t))
        return [y[1], -damping * y[1] - now * (y[0] + beta * y[1])]

    ends = [solve_ivp(rate, (0, 1 / frequency), start, "DOP853", rtol=1e-12, atol=1e-14).y[:, -1] for start in ([1, 0], [0, 1])]
    want = np.linalg.eigvals(np.array(ends).T)
    assert_allclose(np.sort_complex(got), np.sort_complex(want), rtol=1e-5)


def test_steady_state_is_where_the_transient_ends():
    machine = two_masses(c=2000.0, zeta=0.1, error=((3e-6, 500.0, 0.3),))
    found = steady_state(machine, dt=2.5e-5)
    late = stepped(machine, 0.2, dt=2.5e-5)
    n = found.response.time.size
    assert found.stable
    assert found.residual < 1e-9
    assert_allclose(found.response.q, late.q[-n:], atol=1e-5 * np.ptp(late.q[-n:]))


def test_steady_state_with_contact_loss():
    machine = single_mesh(1.0, 1e8, 700.0, force=1500.0, damping=3000.0, backlash=np.inf, error=((15e-6, 1400.0, 0.0),))
    dt = 1 / 700 / 100
    late = stepped(machine, 140 / 700, dt=dt)
    n = 100
    found = steady_state(machine, dt=dt, initial=(late.q[-1 - n], late.v[-1 - n]))
    assert found.response["force mesh"].min() < 0.9 * 1500
    assert found.stable
    assert_allclose(found.response["pair.x"].max(), late["pair.x"][-n:].max(), rtol=1e-4)


def test_the_period_of_a_damaged_tooth_is_its_bodys_turn():
    """500 Hz and a tooth of 24: stiffness comes back to itself after 24 cycles, and after none of their parts."""
    hurt = tooth(np.full(64, 1e8), 0.3, 1.5)
    machine = two_masses(stiffness=np.full(64, 1e8), damage=(ToothDamage(0, 0, hurt),), teeth=(24, 36))
    period = common_period(machine)
    assert_allclose(period, 24 / 500.0, rtol=1e-12)
    t, k = np.linspace(0, period, 997), machine.meshes[0].k
    assert_allclose(k(t + period), k(t), rtol=1e-9)
    for part in (2, 3):
        assert np.abs(k(t + period / part) - k(t)).max() > 0.1 * k(t).max()


def test_period_and_what_has_none():
    machine = two_masses(error=((1e-6, 200.0, 0.0),))
    assert_allclose(common_period(machine), 0.01)
    with pytest.raises(ValueError, match="no common period"):
        common_period(two_masses(error=((1e-6, 500 * math.sqrt(2), 0.0),)))
    with pytest.raises(ValueError, match="give the period"):
        common_period(two_masses(load=lambda t: t))
