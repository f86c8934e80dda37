"""The reference integrator between located changes of contact, against bounces in closed form; motion that no run can follow."""

import math

import numpy as np
import pytest
from machines import stepped

import gearfe as gf
from gearfe.dynamics.motion import simulate as dynamics
from gearfe.dynamics.motion.simulate import simulate

MASS, STIFF, FORCE, SPEED = 1.0, 1e8, 2000.0, 0.3


def bouncing(t, speed=SPEED):
    """Compression of a mass under a constant force that bounces on a spring without damping; it leaves at time 0."""
    omega, deep = math.sqrt(STIFF / MASS), FORCE / STIFF
    flight = 2 * speed * MASS / FORCE
    phase = math.atan2(deep, speed / omega)  # of x = deep - amplitude cos(omega (t - middle)) at first touch
    touch = 2 * (math.pi - math.atan2(speed / omega, deep)) / omega
    assert phase > 0
    t = np.mod(t, flight + touch)
    own = t - flight
    pressed = deep + speed / omega * np.sin(omega * own) - deep * np.cos(omega * own)
    return np.where(t < flight, -speed * t + FORCE / MASS * t**2 / 2, pressed)


@pytest.mark.parametrize("method", [pytest.param("RK45", marks=pytest.mark.slow), "DOP853"])
def test_bounces_follow_the_closed_form(method):
    """Each is found, and the error after all of them is in proportion to the tolerance."""
    machine = gf.single_mesh(MASS, STIFF, 1.0, force=FORCE, backlash=1e-3)
    start = np.zeros(1), np.array([-SPEED])
    errors = []
    for rtol in (1e-6, 1e-8):
        got = stepped(machine, 0.012, dt=2e-5, method=method, rtol=rtol, initial=start)
        want = bouncing(got.time)
        left = np.diff((want > 0).astype(int)) == -1
        assert got.stats["losses"] == left.sum() == 16
        errors.append(np.abs(got["compression mesh"] - want).max() / np.ptp(want))
    assert errors[0] < 5e-4
    assert errors[1] < errors[0] / 30


@pytest.mark.parametrize(("method", "dt", "rtol", "speed", "losses"), [
    ("RK45", 2e-5, 1e-7, 0.002, 9), ("DOP853", 2e-5, 1e-7, 0.002, 9), ("DOP853", 2e-3, 1e-8, SPEED, 8),
])  # fmt: skip
def test_flights_and_bounces_shorter_than_a_step(method, dt, rtol, speed, losses):
    """Of 2 us, where the method would go on for 100 us: it both leaves and returns within a step. Outputs farther apart, too."""
    machine = gf.single_mesh(MASS, STIFF, 1.0, force=FORCE, backlash=1e-3)
    got = stepped(machine, 0.006, dt=dt, method=method, rtol=rtol, initial=(np.zeros(1), np.array([-speed])))
    assert got.stats["losses"] == losses
    np.testing.assert_allclose(got["compression mesh"], bouncing(got.time, speed), atol=2e-4 * FORCE / STIFF)


def test_motion_that_no_run_can_follow_says_so(monkeypatch):
    """Rattling between both flanks; with the disturbance that a healthy run forgives as large as one that it does not."""
    machine = gf.single_mesh(
        1.0, 1e8, 500.0, force=200.0, damping=50.0, backlash=4e-5, error=((4e-5, 700.0, 0.3), (3e-5, 1130.0, 0.0))
    )
    monkeypatch.setattr(dynamics, "ALLOWED", 1e-12)
    monkeypatch.setattr(dynamics, "GROWN", 1e-12)
    got = simulate(machine, 0.004)
    assert "no integration can follow" in got.stats["chaotic"]
    assert "switched" not in got.stats
