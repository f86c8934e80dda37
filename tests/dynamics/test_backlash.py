"""Contact loss against piecewise exact motion and the reference."""

import math

import numpy as np
import pytest
from machines import stepped, two_masses, worst
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from gearfe.dynamics.machine.single_mesh import single_mesh


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


def test_backlash_oscillator_against_its_piecewise_exact_motion():
    error, w = ((20e-6, 700.0, 0.0),), 2 * math.pi * 700
    machine = single_mesh(1.0, 1e8, 700.0, force=300.0, damping=400.0, backlash=np.inf, film=0.0, error=error)
    start = np.array([300.0 / 1e8]), np.array([0.0])
    got = stepped(machine, 0.01, dt=5e-6, initial=start)
    want, losses = exact_bouncing(got.time, omega=w)
    assert losses >= 5
    assert got.stats["losses"] == losses
    assert_allclose(got["pair.x"], want, atol=1e-3 * np.ptp(want))


@pytest.mark.slow
def test_order_survives_contact_loss():
    """Steps are halved about changes of contact: the error falls by far more than the first order of plain fixed steps."""
    machine = two_masses(error=((80e-6, 500.0, 0.3),), backlash=4e-5)
    want = stepped(machine, 0.01, dt=1e-4, method="RK45", rtol=1e-9)
    runs = [stepped(machine, 0.01, dt=dt, every=round(1e-4 / dt)) for dt in (5e-5, 2.5e-5, 1.25e-5)]
    errors = np.array([worst(run, want) for run in runs])
    assert runs[0].stats["losses"] >= 5
    assert want["force m"].min() < -1000  # the back flanks hit too
    assert (np.log2(errors[:-1] / errors[1:]) > 2.5).all(), errors
    assert errors[-1] < 1e-4
