"""The angle of a shaft from its tachometer, against a chirp in closed form."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf

RATE, SECONDS = 10e3, 3.0
TIME = np.arange(round(RATE * SECONDS)) / RATE
ANGLE = 2 * np.pi * (5 * TIME + 4 * TIME**2 / 2)  # from 5 to 17 turns per second


def pulses(marks, noise=0.0):
    wave = (np.mod(marks * ANGLE / (2 * np.pi) - 0.25, 1.0) < 0.3).astype(float)
    return gf.Signal(wave + noise * np.random.default_rng(1).standard_normal(TIME.size), RATE, "V", "tachometer")


@pytest.mark.parametrize(("marks", "noise"), [(1, 0.0), (4, 0.0), (4, 0.05)])
def test_angle_of_an_even_run_up(marks, noise):
    got = gf.tachometer_angle(pulses(marks, noise), marks)
    away = got - ANGLE
    inside = (TIME > 0.3) & (TIME < 2.9)
    assert np.ptp(away[inside]) < 2 * 2 * np.pi * 17 / RATE  # a sample at the highest speed, at two pulses
    assert_allclose(np.mean(away), -np.pi / 2 / marks, atol=0.02)  # zero at the first pulse


def test_a_gear_s_order_is_found_by_the_angle_measured():
    values = 0.7 * np.sin(23 * ANGLE)
    angle = gf.tachometer_angle(pulses(4), 4)
    found = gf.order_spectrum(gf.Signal(values, RATE, "m/s^2", angle=angle))
    order, size = found.within(22.0, 24.0)
    assert_allclose(order[np.argmax(size)], 23.0, atol=found.resolution)
    assert_allclose(size.max(), 0.7, rtol=0.02)


def test_records_without_pulses_are_refused():
    with pytest.raises(ValueError, match="four are needed"):
        gf.tachometer_angle(gf.Signal(np.sin(2 * np.pi * TIME), RATE, "V"))
    with pytest.raises(ValueError, match="pulses = 0"):
        gf.tachometer_angle(pulses(1), 0)
