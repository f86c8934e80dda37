"""Changing speed: phases integrated, orders that stay sharp, the angle from a tachometer; against chirps in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from machines import difference, stepped, two_masses
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.machine.speed import Speed
from gearfe.dynamics.machine.tooth_damage import ToothDamage
from gearfe.dynamics.motion.simulate import simulate
from gearfe.dynamics.motion.step_control import stretch

START, END, LAST = 0.3, 1.2, 0.05  # factors of the speed; seconds


def turned(t):
    """Integral of a speed that rises evenly, by hand."""
    return START * t + (END - START) / LAST * t**2 / 2


def run_up(**mesh):
    return gf.with_speed(two_masses(**mesh), [0.0, LAST], [START, END])


def test_turned_time_is_the_integral_between_the_knots_and_beyond_them():
    t = np.linspace(0.0, LAST, 7)
    speed = Speed((0.0, LAST), (START, END))
    assert_allclose(speed.turned(t), turned(t), rtol=1e-12)
    assert_allclose(speed.turned([-0.1, LAST + 0.1]), [-0.1 * START, turned(LAST) + 0.1 * END], rtol=1e-12)


def test_a_run_up_is_that_of_the_reference():
    machine = gf.with_speed(two_masses(error=((20e-6, 500.0, 0.3),)), [0.0, 0.004], [0.3, 1.2])
    got = simulate(machine, 0.006, rate=2e4)
    want = stepped(machine, 0.006, dt=5e-5, method="DOP853", rtol=1e-8)
    assert max(difference(got, want)) < 1e-3
    assert max(difference(got, want)) < got.stats["error"]


def test_a_slow_error_is_followed_as_a_chirp_whose_order_is_one_line():
    """So slow and stiff that the mass follows the error: its compression is the load over k, its motion the chirp itself."""
    machine = gf.with_speed(gf.single_mesh(1e-4, 1e8, 40.0, force=100.0, zeta=0.3, error=((1e-5, 40.0, 0.0),)), [0, 2], [0.25, 1])
    got = simulate(machine, 2.0, rate=4e3, step=2.5e-4, error=False)
    angle = 2 * np.pi * (0.25 * got.time + 0.375 * got.time**2 / 2)  # of a shaft of 1 Hz
    assert_allclose(got["pair.x"], 1e-6 + 1e-5 * np.sin(40 * angle), atol=2e-9)
    signal = got.signal("pair.x", turning=10.0)  # the error is its fourth order
    assert_allclose(signal.angle, 10 * angle, atol=1e-9)
    found = gf.order_spectrum(signal)
    order, size = found.within(3.5, 4.5)
    assert_allclose(order[np.argmax(size)], 4.0, atol=1e-9)
    assert_allclose(size.max(), 1e-5, rtol=2e-3)
    plain = gf.spectrum(replace(signal, angle=None))
    assert plain.within(1.0, 100.0)[1].max() < 0.3e-5  # over the time the same line is smeared


def test_the_stretch_lies_where_it_turns_fastest():
    machine = gf.with_speed(two_masses(), [0.0, 0.5, 1.0], [0.1, 2.0, 0.1])
    start, length = stretch(machine, 1.0)
    assert start < 0.5 < start + length
    assert_allclose(length, 3.5 / 1000)


def test_what_is_no_profile_is_refused():
    machine = two_masses(teeth=(5, 7), damage=())
    for times, factors, message in (
        ([0.0, 0.0], [1.0, 2.0], "sort the history by time"),
        ([0.0, 1.0], [1.0, -2.0], "0 or more"),
        ([0.0, 1.0], [1.0], "as many times"),
        ([0.0, np.nan], [1.0, 1.0], "times = nan"),
    ):
        with pytest.raises(ValueError, match=message):
            gf.with_speed(machine, times, factors)
    with pytest.raises(ValueError, match="speed changes"):
        gf.steady_state(gf.with_speed(machine, [0.0, 1.0], [1.0, 2.0]))


def test_a_damaged_tooth_returns_by_the_angle():
    hurt = ToothDamage(0, 0, gf.Samples(np.arange(0, 1.51, 0.02), 5e7 * np.ones(76)))
    got = simulate(run_up(teeth=(5, 7), damage=(hurt,)), LAST, rate=5e4, step=5e-6, error=False)
    low = got["stiffness m"] < 6e7
    first = np.flatnonzero(low[1:] & ~low[:-1]) + 1
    assert_allclose(500 * turned(got.time[first]) / 5, np.arange(1, first.size + 1), atol=0.01)
