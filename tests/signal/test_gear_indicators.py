"""FM0 ... NB4 against averages whose indicators are known in closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.signal.gear_indicators import GEAR_SOURCES, tabulate_gear_indicators
from gearfe.signal.orders import mesh_coherence

N, Z = 4096, 24
TURN = 2 * np.pi * np.arange(N) / N


def gear(*, sidebands=0.0, extra=(), mesh=(2.0, 1.0)):
    """Average with mesh harmonics, first sidebands of the first, and lines of other orders."""
    x = 7.0 + sum(a * np.cos((n + 1) * Z * TURN) for n, a in enumerate(mesh))
    x += sidebands * (np.cos((Z - 1) * TURN) + np.cos((Z + 1) * TURN))
    return x + sum(a * np.cos(k * TURN + 0.4) for k, a in extra)


def test_na4_and_nb4_remember_earlier_records():
    """A fault that doubles the residual after four equal records: the mean variance is (4 * 1 + 4) / 5 instead of 4."""
    calm, worse = (gear(extra=[(31, a), (18, a)]) for a in (0.1, 0.2))
    alone, after = gf.gear_indicators(worse, Z), gf.gear_indicators(worse, Z, before=[calm] * 4)
    assert_allclose(alone["NA4"], gf.gear_indicators(calm, Z)["NA4"])
    assert_allclose(after["NA4"] / alone["NA4"], (4 / 1.6) ** 2, rtol=1e-9)
    assert after["NB4"] > 5 * alone["NB4"]
    assert_allclose([after[name] for name in ("FM0", "FM4", "energy ratio")], [alone[n] for n in ("FM0", "FM4", "energy ratio")])


def test_a_table_over_records_of_a_shaft_that_varies():
    rate, rng = 8000.0, np.random.default_rng(3)
    time = np.arange(4 * int(rate)) / rate
    turns = 10 * time + 0.3 * np.sin(time)
    knocks = np.exp(-(((turns % 1 - 0.4) / 0.003) ** 2))
    signals = {}
    for name, size in (("new", 0.0), ("later", 0.0), ("worn", 3.0)):
        values = np.cos(2 * np.pi * Z * turns) + size * knocks + 0.2 * rng.standard_normal(time.size)
        signals[name] = gf.Signal(values, rate, "m/s^2", angle=2 * np.pi * turns)
    table = gf.gear_indicator_table(signals, Z)
    for name in ("FM0", "FM4", "M6A", "M8A", "NA4", "NB4", "energy ratio"):
        assert table["worn"][name] > 1.3 * table["later"][name], name
    head, *rows = tabulate_gear_indicators(table).cells()
    assert head == ["indicator", "new", "later", "worn"]
    assert len(rows) == len(GEAR_SOURCES)


def test_a_healthy_gear_without_any_rest_has_no_moments():
    found = gf.gear_indicators(gear(), Z)
    assert math.isnan(found["FM4"])
    assert math.isnan(found["NA4"])
    assert found["energy ratio"] < 1e-12
    assert ["FM4", ""] in tabulate_gear_indicators({"new": found}).cells()


def test_refusals():
    with pytest.raises(ValueError, match="a constant average"):
        gf.gear_indicators(np.ones(100), 20)
    with pytest.raises(ValueError, match="teeth = 60, but an average of 100 samples"):
        gf.gear_indicators(np.arange(100.0), 60)
    with pytest.raises(ValueError, match="no mesh line of 24 teeth"):
        gf.gear_indicators(np.cos(5 * TURN), Z)


def test_the_average_keeps_the_mesh_line_that_follows_the_shaft():
    rate, turning, teeth = 12800.0, 16.7, 23
    time = np.arange(4 * 12800) / rate
    angle = 2 * np.pi * turning * (time + 0.002 / 1.9 * (1 - np.cos(1.9 * time)))  # 0.2 % of fluctuation
    values = np.cos(teeth * angle) + 0.5 * np.random.default_rng(3).standard_normal(time.size)
    follows = gf.Signal(values, rate, "m/s^2", "follows", angle=angle)
    constant = gf.Signal(values, rate, "m/s^2", "constant", shaft_frequency=turning)
    assert_allclose(mesh_coherence(follows, teeth), 1.0, atol=0.02)
    phase = teeth * (angle - 2 * np.pi * turning * time)
    assert_allclose(mesh_coherence(constant, teeth), abs(np.exp(1j * phase).mean()), atol=0.02)
    with pytest.warns(UserWarning, match="constant: the average keeps .* % of the mesh line of 23 teeth"):
        gf.gear_indicator_table([follows, constant], teeth)
    noise = replace(follows, values=np.random.default_rng(1).standard_normal(time.size))
    assert np.isnan(mesh_coherence(noise, teeth))


def test_records_of_one_name_in_a_list_are_rejected():
    one = gf.Signal(np.cos(np.arange(1000.0)), 1000.0, "g", shaft_frequency=10.0)
    with pytest.raises(ValueError, match="two records have the same name"):
        gf.gear_indicator_table([one, one], 16)
