import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from waves import noise, sine

import gearfe as gf
from gearfe.signal.orders import by_turn

pytestmark = pytest.mark.quick
RATE = 5120.0


def ramp(n, rate, start, stop):
    """Angle [rad] of a shaft whose speed rises linearly [turns/s]."""
    t = np.arange(n) / rate
    return 2 * np.pi * (start * t + (stop - start) * t**2 * rate / (2 * n))


def test_order_spectrum_of_a_run_up_is_sharp_where_the_spectrum_is_smeared():
    angle = ramp(4 * 5120, RATE, 10.0, 30.0)
    x = np.cos(12 * angle) + 0.3 * np.cos(24 * angle + 1)
    signal = gf.Signal(x, RATE, "N", angle=angle)
    found = gf.order_spectrum(signal)
    assert (found.axis, found.unit) == ("order", "N")
    lines = gf.find_lines(found, {"mesh": 12.0, "second": 24.0})
    assert_allclose([lines["mesh"], lines["second"]], [(12.0, 1.0), (24.0, 0.3)], rtol=2e-3)
    away = np.abs(found.frequency[:, None] - [12.0, 24.0]).min(axis=1) > 3 * found.resolution
    assert found.values[away].max() < 2e-3
    assert gf.spectrum(signal).values.max() < 0.15, "the mesh line runs from 120 to 360 Hz"


def test_orders_at_constant_speed_are_frequencies_over_that_of_the_shaft():
    signal = gf.Signal(sine(2.0, 240.0, 1600, 1600.0), 1600.0, "N", shaft_frequency=20.0)
    found, plain = gf.order_spectrum(signal), gf.spectrum(signal)
    assert by_turn(signal).shape == (20, 80), "the last turn is whole: its end is the first sample of the next"
    assert_allclose(found.frequency * 20.0, plain.frequency)
    assert_allclose(found.values, plain.values, atol=1e-9)


@pytest.mark.parametrize("part", [0.1, 0.25, 1 / 2.56])
def test_spline_error_is_as_the_docstring_says(part):
    n = 4000
    angle = 2 * np.pi * np.arange(n) / 100  # 100 samples a turn
    x = np.cos(part * 100 * angle)
    found = by_turn(gf.Signal(x, 100.0, "N", angle=angle), 731)[5:35]
    exact = np.cos(part * 100 * 2 * np.pi * np.arange(30 * 731) / 731).reshape(found.shape)  # turn 5 is a whole number of periods
    if part == 1 / 2.56:
        exact = np.cos(part * 100 * 2 * np.pi * (5 + np.arange(30 * 731) / 731)).reshape(found.shape)
    bound = (part / (1 - part)) ** 6
    assert 0.5 * bound < np.abs(found - exact).max() < 3 * bound


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "has no shaft"),
        ({"shaft_frequency": 2.0}, r"covers 0\.\d+ revolutions"),
        ({"angle": np.concatenate([np.arange(900.0), 899 + 1e-3 * np.arange(1, 125)])}, "slows down to .* cut out standstill"),
    ],
)
def test_orders_need_a_turning_shaft(options, message):
    with pytest.raises(ValueError, match=message):
        gf.order_spectrum(gf.Signal(noise(1024), RATE, "N", **options))


def test_samples_per_turn_that_would_fold_are_refused():
    signal = gf.Signal(noise(1025), 1024.0, "N", shaft_frequency=8.0)
    assert by_turn(signal, 200).shape == (8, 200)
    with pytest.raises(ValueError, match="samples_per_turn = 100, but signal has 128 per turn at its lowest speed"):
        by_turn(signal, 100)


@pytest.mark.parametrize("turns", [25, 100, 400])
def test_synchronous_average_lowers_noise_by_the_root_of_the_turns(turns):
    n = 64
    one = np.cos(2 * np.pi * 7 * np.arange(n) / n) + 0.5 * np.sin(2 * np.pi * 3 * np.arange(n) / n)
    signal = gf.Signal(np.tile(one, turns) + noise(turns * n), n * 10.0, "N", shaft_frequency=10.0)
    average, periods = gf.synchronous_average(signal)
    assert periods == turns
    assert_allclose((average - one).std() * math.sqrt(turns), 1.0, rtol=0.25)


def test_average_over_two_turns_keeps_what_repeats_every_two():
    x = np.tile(np.concatenate([np.zeros(32), np.ones(32)]), 5)
    signal = gf.Signal(np.append(x, np.zeros(32)), 32.0, "N", shaft_frequency=1.0)
    average, periods = gf.synchronous_average(signal, turns_per_period=2)
    assert periods == 5
    assert_allclose(average, x[:64], atol=1e-12)
    with pytest.raises(ValueError, match="turns_per_period = 12, but signal has 11 whole revolutions"):
        gf.synchronous_average(signal, turns_per_period=12)


def test_residual_and_difference_keep_the_local_fault_only():
    n, teeth = 420, 21
    turn = 2 * np.pi * np.arange(n) / n
    healthy = 2 + np.cos(turn) + 3 * np.cos(teeth * turn) + np.cos(2 * teeth * turn + 1)
    first, second = 0.4 * np.cos((teeth - 1) * turn), 0.2 * np.cos((teeth + 2) * turn)
    assert_allclose(gf.residual_signal(healthy + first + second, teeth), first + second, atol=1e-12)
    assert_allclose(gf.residual_signal(healthy + first + second, teeth, sidebands=1), second, atol=1e-12)
    for options in ({"teeth": 300}, {"teeth": 21, "sidebands": 10}, {"teeth": 21, "shaft_orders": 21}):
        with pytest.raises(ValueError, match=r"teeth = 300|remove all orders"):
            gf.residual_signal(healthy, **options)


def test_phase_portrait_of_a_sine_is_an_ellipse():
    signal = gf.Signal(sine(2.0, 40.0, 2000, 2000.0), 2000.0, "um")
    x, v = gf.phase_portrait(signal)
    inside = slice(20, -20)
    assert_allclose((x[inside] / 2) ** 2 + (v[inside] / (2 * 2 * np.pi * 40)) ** 2, 1.0, rtol=1e-6)
    given = gf.Signal(-2 * 2 * np.pi * 40 * np.sin(2 * np.pi * 40 * signal.time + 0.3), 2000.0, "um/s")
    assert_allclose(gf.phase_portrait(signal, given)[1], given.values)
    with pytest.raises(ValueError, match="both must come from one record"):
        gf.phase_portrait(signal, gf.Signal(given.values[1:], 2000.0, "um/s"))


def spread_points(section):
    """Number of different points of a Poincare section."""
    return len(np.unique((section / np.abs(section).max(axis=0)).round(3), axis=0))


def test_poincare_section_counts_the_period():
    """S4: healthy few points, a fault more: 480 Hz mesh, 80 Hz fault repeat after 6 mesh periods."""
    rate, n = 51200.0, 51200
    mesh = sine(1.0, 480.0, n, rate) + sine(0.6, 960.0, n, rate)
    healthy = gf.poincare_section(gf.Signal(mesh, rate, "um"), 480.0, start=0.1)
    assert healthy.shape == (432, 2)
    assert spread_points(healthy) == 1
    faulty = gf.Signal(mesh + sine(0.5, 80.0, n, rate), rate, "um")
    assert spread_points(gf.poincare_section(faulty, 480.0, start=0.1)) == 6
    assert spread_points(gf.poincare_section(faulty, 80.0, start=0.1)) == 1
    with pytest.raises(ValueError, match=r"start = 2 s, but signal lasts from 0 to 0\.99998"):
        gf.poincare_section(faulty, 80.0, start=2)
    with pytest.raises(ValueError, match="frequency = 30000 Hz, but signal has 0 to 25600 Hz"):
        gf.poincare_section(faulty, 30000)


def test_plot_of_spectra_marks_the_lines(tmp_path):
    found = gf.spectrum(gf.Signal(sine(1.0, 280.0, 5120), RATE, "N"))
    lines = gf.expected_lines(280.0, 40.0, count=1)
    figure = gf.plot_spectra({"healthy": found, "pitted": found}, lines, tmp_path / "s.png")
    assert (tmp_path / "s.png").stat().st_size > 1000
    assert {text.get_text() for text in figure.axes[0].texts} == set(lines)
    assert_allclose(sorted(line.get_xdata()[0] for line in figure.axes[1].lines[1:]), sorted(lines.values()))
    assert_allclose(figure.axes[1].get_xlim(), (0, 1.2 * 320))
    assert_allclose(gf.plot_spectra({"all": found}).axes[0].get_xlim(), (0, 2560))


def test_plot_of_a_portrait_shows_the_section(tmp_path):
    signal = gf.Signal(sine(1.0, 40.0, 2000, 2000.0), 2000.0, "um")
    section = gf.poincare_section(signal, 40.0)
    figure = gf.plot_phase(gf.phase_portrait(signal), section, "um", tmp_path / "p.png")
    assert_allclose(figure.axes[0].lines[1].get_xydata(), section)
    assert figure.axes[0].get_ylabel() == "velocity [um/s]"
    assert (tmp_path / "p.png").exists()
