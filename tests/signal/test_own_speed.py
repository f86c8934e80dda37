"""The speed of a shaft from the signal alone, on signals and simulated run-ups whose speed is known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.signal import lfilter

import gearfe as gf

TEETH = 21


def off(found, turns):
    """Largest error of the speed over its largest value, and of the angle in mesh cycles; the ends left out."""
    angle = found.angle - found.angle[found.angle.size // 2]
    true = 2 * np.pi * (turns - turns[turns.size // 2])
    inside = slice(angle.size // 20, -angle.size // 20)
    speed, want = np.gradient(angle)[inside], np.gradient(true)[inside]
    return np.abs(speed - want).max() / want.max(), TEETH * np.abs(angle - true)[inside].max() / (2 * np.pi)


@pytest.mark.parametrize("noise", [0.0, 1.0])
def test_a_line_that_sweeps(noise):
    t = np.arange(100_000) / 2e4
    turns = 10 * t + 1.5 * t**2 + 0.1 * np.sin(2 * np.pi * 0.5 * t)
    values = sum(np.cos(k * TEETH * 2 * np.pi * turns + k) / k for k in (1, 2, 3))
    values = values + noise * np.random.default_rng(0).standard_normal(t.size)
    found = gf.with_estimated_speed(gf.Signal(values, 2e4, "g"), TEETH, (8.0, 30.0))
    speed, angle = off(found, turns)
    assert speed < (0.01 if noise else 0.0005)
    assert angle < (0.05 if noise else 0.01)


@pytest.mark.parametrize("swing", [0.0, 0.005, 0.02])
@pytest.mark.parametrize("resonant", [False, True])
def test_a_speed_that_hardly_changes(swing, resonant):
    """Lines that stay at their frequency are not taken for resonances, nor resonances for lines."""
    t = np.arange(25_000) / 5e3
    turns = 20 * t + 20 * swing * np.sin(np.pi * t) / np.pi
    values = sum(np.cos(k * TEETH * 2 * np.pi * turns + k) / k for k in (1, 2, 3))
    values = values + 0.5 * np.random.default_rng(1).standard_normal(t.size)
    if resonant:  # at 390 Hz, beside the mesh line, damping ratio 0.01
        w, r = 2 * np.pi * 390 / 5e3, 1 - 0.01 * 2 * np.pi * 390 / 5e3
        values = values + lfilter([3 * (1 - r)], [1, -2 * r * np.cos(w), r * r], values)
    for speeds in ((10.0, 30.0), (18.0, 22.0)):
        assert off(gf.with_estimated_speed(gf.Signal(values, 5e3, "g"), TEETH, speeds), turns)[0] < 0.01


def test_noise_and_a_speed_outside_of_the_range_are_refused():
    noise = np.random.default_rng(2)
    for seconds in (1, 3):
        alone = gf.Signal(noise.standard_normal(5000 * seconds), 5e3, "g")
        for speeds in ((10.0, 30.0), (18.0, 22.0)):
            with pytest.raises(ValueError, match=r"no line of order 21 stands out at any speed of the range: look at"):
                gf.with_estimated_speed(alone, TEETH, speeds)
    t = np.arange(25_000) / 5e3
    values = np.cos(TEETH * 2 * np.pi * (12 * t + 1.4 * t**2)) + 0.1 * noise.standard_normal(t.size)
    with pytest.raises(ValueError, match=r"from 0\.0\d+ to 1\.\d+ s no line"):
        gf.with_estimated_speed(gf.Signal(values, 5e3, "g"), TEETH, (18.0, 26.0))


def test_what_shows_no_speed_is_refused():
    signal = gf.Signal(np.sin(np.arange(4000.0)), 1000.0, "g")
    for given, said in (
        ((21, (30.0, 20.0)), "lowest and then the highest"),
        ((21, (20.0, 30.0)), "shows up to 500 Hz"),
        ((-1, (1.0, 2.0)), "order = -1"),
        ((4, (0.5, 2.0), 3, 2.0), "four or more are needed"),
    ):
        with pytest.raises(ValueError, match=said):
            gf.with_estimated_speed(signal, given[0], given[1], **dict(zip(("harmonics", "seconds"), given[2:], strict=False)))
    assert_allclose(signal.values[0], 0.0)
