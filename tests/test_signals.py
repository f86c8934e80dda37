import math

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.io import savemat

import gearfe as gf
from gearfe.kurtogram import Kurtogram
from gearfe.orders import by_turn

RATE = 5120.0


def sine(amplitude, frequency, n, rate=RATE, phase=0.3):
    return amplitude * np.cos(2 * np.pi * frequency * np.arange(n) / rate + phase)


def noise(n, seed=0):
    return np.random.default_rng(seed).standard_normal(n)


def impulses(n, *, every, ringing, decay, rate=RATE):
    """Ringings of one natural frequency [Hz], `every` samples apart, on a grid that repeats exactly."""
    k = np.arange(n) % every
    return np.exp(-decay * k / rate) * np.sin(2 * np.pi * ringing * k / rate)


# ---------------------------------------------------------------- spectra


@pytest.mark.parametrize("window", ["hann", "boxcar", "flattop", ("kaiser", 8.0)])
@pytest.mark.parametrize("n", [1024, 1025])
def test_amplitude_of_a_sine_on_a_bin_and_mean_at_zero(window, n):
    rate = n / 2.0  # bins 0.5 Hz apart
    found = gf.spectrum(gf.Signal(sine(3.0, 50.0, n, rate) - 7.0, rate, "um"), window=window)
    assert (found.resolution, found.unit, found.axis) == (0.5, "um", "Hz")
    assert_allclose(found.frequency[100], 50.0)
    assert_allclose(found.values[[0, 100]], [7.0, 3.0], rtol=1e-6)


@pytest.mark.parametrize("n", [999, 1000])
def test_parseval(n):
    x = 2.0 + noise(n)
    amplitude = gf.spectrum(gf.Signal(x, RATE, "N"), window="boxcar").values
    power = amplitude**2 / 2
    power[0] *= 2
    if n % 2 == 0:
        power[-1] *= 2
    assert_allclose(power.sum(), np.mean(x**2), rtol=1e-12)


def test_scalloping_is_as_the_docstring_says():
    worst = {
        name: gf.spectrum(gf.Signal(sine(1.0, 100.5, 5120), RATE, "N"), window=name).values.max()
        for name in ("boxcar", "hann", "flattop")
    }
    assert_allclose([worst["boxcar"], worst["hann"], worst["flattop"]], [0.637, 0.849, 0.999], atol=2e-3)


@pytest.mark.parametrize(("window", "bins"), [("boxcar", 1.0), ("hann", 1.5)])
def test_noise_bandwidth(window, bins):
    found = gf.spectrum(gf.Signal(noise(2000), 1000.0, "N"), window=window)
    assert_allclose(found.bandwidth, bins * 0.5)


def test_density_integrates_to_the_variance_and_is_flat_for_noise():
    x = 5.0 + 2.0 * noise(200_000)
    found = gf.power_spectral_density(gf.Signal(x, RATE, "m/s^2"), resolution=20.0)
    assert (found.unit, found.resolution) == ("(m/s^2)^2/Hz", 20.0)
    assert_allclose(found.values.sum() * found.resolution, 4.0, rtol=0.02)
    assert_allclose(found.values[2:-2], 8.0 / RATE, rtol=0.15, err_msg="white noise of variance 4: 4 / (rate / 2)")


def test_density_of_one_segment_obeys_parseval_exactly():
    x = noise(1024)
    found = gf.power_spectral_density(gf.Signal(x, 1024.0, "N"), resolution=1.0, window="boxcar")
    assert_allclose(found.values.sum(), x.var(), rtol=1e-12)


@pytest.mark.parametrize("resolution", [0.0, -1.0, 1e-3, 1e5])
def test_density_refuses_a_resolution_the_record_lacks(resolution):
    with pytest.raises(ValueError, match=r"resolution = .* Hz, but a record of 0\.2 s"):
        gf.power_spectral_density(gf.Signal(noise(1024), RATE, "N"), resolution=resolution)


# ---------------------------------------------------------------- orders


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
        ({"shaft_frequency": 2.0}, r"covers 0\.\d+ turns"),
        ({"angle": np.concatenate([np.arange(900.0), 899 + 1e-3 * np.arange(1, 125)])}, "slows down to .* where it stands"),
    ],
)
def test_orders_need_a_turning_shaft(options, message):
    with pytest.raises(ValueError, match=message):
        gf.order_spectrum(gf.Signal(noise(1024), RATE, "N", **options))


def test_samples_per_turn_that_would_fold_are_refused():
    signal = gf.Signal(noise(1025), 1024.0, "N", shaft_frequency=8.0)
    assert by_turn(signal, 200).shape == (8, 200)
    with pytest.raises(ValueError, match="samples_per_turn = 100, but signal has 128 where it is slowest"):
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
    with pytest.raises(ValueError, match="turns_per_period = 12, but signal has 11 whole turns"):
        gf.synchronous_average(signal, turns_per_period=12)


def test_residual_and_difference_keep_the_local_fault_only():
    n, teeth = 420, 21
    turn = 2 * np.pi * np.arange(n) / n
    healthy = 2 + np.cos(turn) + 3 * np.cos(teeth * turn) + np.cos(2 * teeth * turn + 1)
    first, second = 0.4 * np.cos((teeth - 1) * turn), 0.2 * np.cos((teeth + 2) * turn)
    assert_allclose(gf.residual_signal(healthy + first + second, teeth), first + second, atol=1e-12)
    assert_allclose(gf.residual_signal(healthy + first + second, teeth, sidebands=1), second, atol=1e-12)
    for options in ({"teeth": 300}, {"teeth": 21, "sidebands": 10}, {"teeth": 21, "shaft_orders": 21}):
        with pytest.raises(ValueError, match=r"teeth = 300|nothing is left"):
            gf.residual_signal(healthy, **options)


# ---------------------------------------------------------------- envelopes


@pytest.mark.parametrize("n", [5120, 5121])
def test_envelope_of_a_modulated_carrier(n):
    rate = float(n)
    slow = 1 + 0.5 * sine(1.0, 8.0, n, rate)
    x = 3.0 + 2.0 * slow * sine(1.0, 800.0, n, rate, 0.0) + sine(5.0, 100.0, n, rate)
    found = gf.envelope(gf.Signal(x, rate, "N"), band=(700.0, 900.0))
    assert_allclose(found.values, 2.0 * slow, rtol=1e-9)
    squared = gf.squared_envelope_spectrum(gf.Signal(x, rate, "N"), (700.0, 900.0))
    assert squared.unit == "(N)^2"
    assert_allclose(squared.values[[8, 16]], [2 * 0.5 * 4, 0.5**2 * 4 / 2], rtol=1e-6, err_msg="2 m A^2, m^2 A^2 / 2")


def test_envelope_of_everything_is_that_of_scipy():
    from scipy.signal import hilbert

    for n in (512, 513):
        x = noise(n)
        assert_allclose(gf.envelope(gf.Signal(x, 1.0, "N")).values, np.abs(hilbert(x - x.mean())), rtol=1e-9)


@pytest.mark.parametrize("band", [(900.0, 700.0), (-1.0, 100.0), (100.0, 2600.0)])
def test_envelope_refuses_a_band_outside_the_spectrum(band):
    with pytest.raises(ValueError, match=r"band = .* but signal has 0 to 2560 Hz"):
        gf.envelope(gf.Signal(noise(100), RATE, "N"), band)


@pytest.mark.parametrize("n", [5120, 5121])
def test_displacement_from_acceleration(n):
    """S4 measures acceleration and integrates twice."""
    rate = float(n)
    omega = 2 * np.pi * 480.0
    signal = gf.Signal(9.81 + sine(-(omega**2) * 3e-6, 480.0, n, rate) + sine(1.0, 2.0, n, rate), rate, "m/s^2")
    found = gf.integrate(signal, 2, 10.0, "m")
    assert found.unit == "m"
    assert_allclose(found.values, sine(3e-6, 480.0, n, rate), atol=1e-15)
    for arguments in ((0, 10.0), (2, 0.0), (2, 3000.0)):
        with pytest.raises(ValueError, match="give times >= 1 and above between 0 and"):
            gf.integrate(signal, *arguments, "m")


# ---------------------------------------------------------------- kurtogram


def test_kurtogram_tree_tiles_the_spectrum_at_every_level():
    found = gf.fast_kurtogram(gf.Signal(noise(128 * 32), RATE, "N"))
    levels, counts = np.unique(found.level.round(2), return_counts=True)
    assert_allclose(levels, [0, 1, 1.58, 2, 2.58, 3, 3.58, 4, 4.58, 5])
    assert_array_equal(counts, [1, 2, 3, 4, 6, 8, 12, 16, 24, 32])
    assert_allclose(found.bandwidth, RATE / 2 ** (found.level + 1))
    for level in np.unique(found.level):
        rows = found.level == level
        edges = found.centre[rows] - found.bandwidth[rows] / 2
        assert_allclose(edges, np.arange(rows.sum()) * found.bandwidth[rows][0], atol=1e-9)


@pytest.mark.parametrize("frequency", [50.0, 370.0, 680.0, 980.0, 1220.0, 1560.0, 1770.0, 2120.0, 2510.0])
def test_every_band_holds_its_own_frequencies(frequency):
    """A burst of one frequency must be loudest in the band whose edges enclose it, at every level."""
    n = 2**14
    x = sine(1.0, frequency, n) * np.exp(-(((np.arange(n) - n / 2) / 700.0) ** 2))
    from gearfe.kurtogram import _positive, _split

    bands = [_positive(x)]
    for level in range(3):
        for parts in (2, 3):
            pieces = [piece for band in bands for piece in _split(band, parts)]
            loudest = int(np.argmax([np.abs(piece).max() for piece in pieces]))
            assert loudest == int(frequency / (RATE / 2 / len(pieces))), (level, parts)
            assert_allclose(np.abs(pieces[loudest]).max(), 1.0, atol=0.05)
        bands = [piece for band in bands for piece in _split(band, 2)]


@pytest.mark.parametrize("parts", [2, 3])
def test_bands_keep_amplitudes_in_their_middle_and_stop_far_away(parts):
    from gearfe.kurtogram import _split

    for i in range(parts):
        for off, gain in ((0.5, 1.0), (1e-3, 0.96)):  # middle and lower edge of band i
            x = np.exp(2j * np.pi * (i + off) / (2 * parts) * np.arange(600))
            loud = np.array([np.abs(piece).mean() for piece in _split(x, parts)])
            assert_allclose(loud[i], gain, atol=6e-3)
            assert np.delete(loud, [i] if off == 0.5 else [i, i - 1] if i else [0]).max(initial=0) < 0.01


def test_kurtogram_of_noise_is_flat_also_beside_zero():
    found = gf.fast_kurtogram(gf.Signal(3.0 + noise(2**17), RATE, "N"), 5)
    assert np.abs(found.kurtosis).max() < 0.25
    lowest = found.centre < found.bandwidth
    assert np.abs(found.kurtosis[lowest]).max() < 0.2, "real bands would have 1"


def test_kurtogram_finds_the_ringing_and_its_squared_envelope_the_repetition():
    n, every = 2**16, 320  # 16 Hz, about the fault of S2's first sun
    x = impulses(n, every=every, ringing=850.0, decay=300.0) + 0.1 * noise(n) + sine(2.0, 168.0, n) + sine(1.0, 336.0, n)
    signal = gf.Signal(x, RATE, "m/s^2")
    assert np.mean((x - x.mean()) ** 4) / x.var() ** 2 < 3, "the meshes hide it from plain kurtosis"
    found = gf.fast_kurtogram(signal)
    low, high = found.band
    assert low < 850.0 < high
    assert found.kurtosis[found.best] > 1.5
    squared = gf.squared_envelope_spectrum(signal, found.band)
    top = squared.frequency[1 + np.argmax(squared.values[1:])]
    assert_allclose(top, 16.0, atol=squared.resolution)


@pytest.mark.parametrize("frequency", [50.7, 411.3, 1290.1, 2500.9])
def test_a_sine_that_does_not_close_makes_no_impulse_in_any_band(frequency):
    """Through a Fourier transform the click at the ends has a kurtosis of 100 in bands that hold nothing else."""
    found = gf.fast_kurtogram(gf.Signal(7 + sine(1.0, frequency, 2**14), RATE, "N"))
    assert found.kurtosis.max() < 0.5


def test_kurtogram_of_a_constant_envelope_is_minus_one():
    found = gf.fast_kurtogram(gf.Signal(sine(1.0, 800.0, 2**13), RATE, "N"), 3)
    rows = np.abs(found.centre - 800.0) < found.bandwidth / 2
    assert_allclose(found.kurtosis[rows & (found.level > 0)], -1.0, atol=1e-3)
    assert_allclose(found.kurtosis[0], -1.5, atol=1e-3, err_msg="real sine: 1.5 - 3")


def test_centres_printed_by_s2_are_edges_of_the_tree():
    """S2 prints level 5.5 at 800 Hz and 6.5 at 80 Hz (5120 Hz, 5 s): both lie between two bands of 5.58 and 6.58."""
    found = gf.fast_kurtogram(gf.Signal(noise(25600), RATE, "m/s^2"))
    assert found.level.max() == 7
    for level, centre in ((5.5, 800.0), (6.5, 80.0)):
        rows = np.floor(10 * found.level) / 10 == level
        edges = np.append(found.centre[rows] - found.bandwidth[rows] / 2, RATE / 2)
        assert_allclose(np.abs(edges - centre).min(), 0.0, atol=1e-9)


@pytest.mark.parametrize("levels", [0, 4])
def test_kurtogram_refuses_levels_the_record_is_too_short_for(levels):
    with pytest.raises(ValueError, match=f"levels = {levels}, but signal with 1024 samples allows 1 to 3"):
        gf.fast_kurtogram(gf.Signal(noise(1024), RATE, "N"), levels)


def test_a_constant_has_no_kurtogram():
    for make in (gf.fast_kurtogram, lambda signal: gf.spectral_kurtosis(signal, 64)):
        with pytest.raises(ValueError, match="is constant"):
            make(gf.Signal(np.full(1024, 9.81), RATE, "N"))


def test_best_band_is_the_row_of_the_largest_kurtosis():
    table = Kurtogram(np.array([0.0, 1, 1]), np.array([50.0, 25, 75]), np.array([100.0, 50, 50]), np.array([0.1, 0.2, 4.0]))
    assert (table.best, table.band) == (2, (50.0, 100.0))


def test_spectral_kurtosis_of_noise_sine_and_impulses():
    n = 2**16
    plain = gf.spectral_kurtosis(gf.Signal(noise(n), RATE, "N"), 64)
    assert plain.unit == "1"
    assert np.abs(plain.values).max() < 0.3, "2 / sqrt(1024) = 0.06 for separate frames; real bins included"
    with_sine = gf.spectral_kurtosis(gf.Signal(noise(n) + sine(20.0, 800.0, n), RATE, "N"), 64)
    assert_allclose(with_sine.values[10], -1.0, atol=0.05)
    x = impulses(n, every=512, ringing=1600.0, decay=400.0) + 0.02 * noise(n)
    found = gf.spectral_kurtosis(gf.Signal(x, RATE, "N"), 64)
    assert abs(found.frequency[np.argmax(found.values)] - 1600.0) <= 3 * found.resolution
    with pytest.raises(ValueError, match="size = 300 samples, but signal has 1000: give 8 to 250"):
        gf.spectral_kurtosis(gf.Signal(noise(1000), RATE, "N"), 300)


# ---------------------------------------------------------------- phase plane


def test_phase_portrait_of_a_sine_is_an_ellipse():
    signal = gf.Signal(sine(2.0, 40.0, 2000, 2000.0), 2000.0, "um")
    x, v = gf.phase_portrait(signal)
    inside = slice(20, -20)
    assert_allclose((x[inside] / 2) ** 2 + (v[inside] / (2 * 2 * np.pi * 40)) ** 2, 1.0, rtol=1e-6)
    given = gf.Signal(-2 * 2 * np.pi * 40 * np.sin(2 * np.pi * 40 * signal.time + 0.3), 2000.0, "um/s")
    assert_allclose(gf.phase_portrait(signal, given)[1], given.values)
    with pytest.raises(ValueError, match="must be those of one record"):
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


# ---------------------------------------------------------------- pictures


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


# ---------------------------------------------------------------- Signal and files


@pytest.mark.parametrize(
    ("values", "options", "message"),
    [
        ([1.0, np.nan, 2.0], {}, "case: sample 1 is nan; cut or mend the 1 samples"),
        ([[1.0, 2.0]], {}, r"case: values of shape \(1, 2\)"),
        ([1.0], {}, r"give a row of two or more real numbers"),
        ([1j, 2.0], {}, "real numbers"),
        ([1.0, 2.0], {"rate": 0.0}, r"case: rate = 0\.0, but give a positive number of Hz"),
        ([1.0, 2.0], {"rate": None}, "case: rate = None"),
        ([1.0, 2.0], {"rate": "5120"}, "case: rate = '5120'"),
        ([1.0, 2.0], {"rate": math.inf}, "case: rate = inf"),
        ([1.0, 2.0], {"unit": " "}, "case: unit = ' ', but a signal needs one"),
        ([1.0, 2.0], {"shaft_frequency": -1.0}, "case: shaft_frequency = -1.0"),
        ([1.0, 2.0], {"shaft_frequency": 1.0, "angle": [0.0, 1.0]}, "both angle and shaft_frequency"),
        ([1.0, 2.0], {"angle": [0.0, 1.0, 2.0]}, "3 angles for 2 samples"),
        ([1.0, 2.0, 3.0], {"angle": [0.0, 6.2, 0.1]}, r"sample 2 has 0\.1 rad after 6\.2; .* numpy\.unwrap"),
    ],
)
def test_signal_refuses(values, options, message):
    with pytest.raises(ValueError, match=message):
        gf.Signal(np.array(values), **({"rate": RATE, "unit": "N", "name": "case"} | options))


def test_signal_keeps_its_own_samples():
    raw = np.arange(4)
    signal = gf.Signal(raw, 2, "N")
    raw[0] = 9
    assert_array_equal(signal.values, [0.0, 1.0, 2.0, 3.0])
    assert_array_equal(signal.time, [0.0, 0.5, 1.0, 1.5])
    assert signal.duration == 2.0
    with pytest.raises(ValueError, match="read-only"):
        signal.values[0] = 1.0


ROWS = "\n".join(f"{i / 1000:.3f},{i * i}" for i in range(10))


@pytest.mark.parametrize(
    ("text", "rate", "unit"),
    [
        (f"time [s],a [m/s^2]\n{ROWS}\n", 1000.0, "m/s^2"),
        (f"# time [s],a (m/s^2)\n{ROWS}\n", 1000.0, "m/s^2"),
        (f"t [ms],a [g]\n{ROWS}\n", 1e6, "g"),
        ("time [s];a [N]\n" + ROWS.replace(",", ";"), 1000.0, "N"),
        ('"time [s]"\t"a [N]"\n' + ROWS.replace(",", "\t"), 1000.0, "N"),
        ("# rate = 61.44 kHz\n# unit: m/s^2\n" + "\n".join(str(i * i) for i in range(10)), 61440.0, "m/s^2"),
        ("% fs = 61440 Hz\na [N]\n" + "\n".join(str(i * i) for i in range(10)), 61440.0, "N"),
    ],
)
def test_csv(tmp_path, text, rate, unit):
    path = tmp_path / "x.csv"
    path.write_text(text, encoding="utf-8")
    signal = gf.read_signal(path)
    assert_array_equal(signal.values, np.arange(10.0) ** 2)
    assert_allclose(signal.rate, rate)
    assert signal.unit == unit


def test_csv_with_angle_and_several_columns(tmp_path):
    path = tmp_path / "run.csv"
    rows = "\n".join(f"{i / 64:.6f},{i * 15},{i},{2 * i}" for i in range(40))
    path.write_text(f"time [s],angle [deg],in [N],out [N]\n{rows}\n")
    signal = gf.read_signal(path, column="out")
    assert_array_equal(signal.values, 2.0 * np.arange(40))
    assert_allclose(signal.angle, np.radians(15.0 * np.arange(40)))
    assert signal.name == "run out"


def test_arguments_state_what_a_file_does_not(tmp_path):
    path = tmp_path / "bare.txt"
    path.write_text("1\n2\n4\n")
    signal = gf.read_signal(path, rate=8000, unit="m/s^2", shaft_frequency=41.67)
    assert (signal.rate, signal.unit, signal.shaft_frequency) == (8000.0, "m/s^2", 41.67)


@pytest.mark.parametrize("digits", [6, 9])
def test_times_printed_with_few_digits_are_even(tmp_path, digits):
    """Microseconds at S0's 61 440 Hz: every step is off by up to 6 % of itself."""
    path = tmp_path / "x.csv"
    path.write_text("time [s],a [N]\n" + "\n".join(f"{i / 61440:.{digits}f},{i}" for i in range(6144)))
    assert_allclose(gf.read_signal(path).rate, 61440.0, rtol=1e-5)


def with_rows(rows, header="time [s],a [N]"):
    return header + "\n" + "\n".join(rows) + "\n"


EVEN = [f"{i / 1000:.3f},{i}" for i in range(20)]


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        (with_rows(EVEN, "a [N],b [N]"), {}, r"2 columns of values; it has 'a', 'b': give one as column="),
        (with_rows(EVEN), {"column": "c"}, r"no column 'c'; it has 'a'"),
        (with_rows(EVEN, "time [s],a"), {}, "no unit for 'a'; give one"),
        (with_rows(EVEN), {"unit": "g"}, "units N, g for 'a'; give one"),
        (with_rows(EVEN, "time,a [N]"), {}, r"column 'time' has unit '', but must state one of s, ms, us: 'time \[s\]'"),
        (with_rows(EVEN, "time [s],t [s]"), {}, "'time' and 't'; keep one"),
        (with_rows(EVEN, "angle [turns],a [N]"), {"rate": 1}, "must state one of rad, deg"),
        (with_rows(["1", "2"], "a [N]"), {}, "states no sampling rate: add a column"),
        (with_rows(EVEN[:5] + EVEN[6:]), {}, r"sample \d+ at 0\.\d+ s does not fit a step"),
        (with_rows(EVEN[:1] + EVEN[2:]), {}, r"sample 1 at 0\.002 s does not fit"),
        (with_rows(EVEN[::-1]), {}, "times must rise"),
        (with_rows(["0,1", "nan,2", "2,3"]), {}, "time 1 is nan"),
        (with_rows(["0,1"]), {}, "1 times for 1 samples"),
        (with_rows(["0,1", "1,inf", "2,3"]), {}, "sample 1 is inf"),
        (with_rows(EVEN), {"rate": 2000}, "rate = 2000 Hz, but its times are 1000 Hz"),
        ("# rate = 5 Hz\n" + with_rows(["1", "2"], "a [N]"), {"rate": 6}, "rate is given as 6 and 5 Hz"),
        ("# rate = 5 rpm\n" + with_rows(["1", "2"], "a [N]"), {}, "rate = '5 rpm', but give a positive number of Hz"),
        ("# fs = -5\n" + with_rows(["1", "2"], "a [N]"), {}, "rate = '-5', but give a positive"),
        (with_rows(["0,1", "1,x"]), {}, r"line 3: '1,x' is not a row of 2 numbers"),
        (with_rows(["0,1", "1,2,3"]), {}, r"line 3: '1,2,3' is not a row of 2 numbers"),
        (with_rows(["0;1,5", "1;2,5"], "time [s];a [N]"), {}, "line 2: .* use a decimal point"),
        ("\n".join(EVEN), {}, "2 columns without names; write a header"),
        (with_rows(EVEN, "a [N],a [g]"), {}, r"two columns have the same name"),
        ("# nothing\n", {}, "no rows of numbers"),
        ("# rate = 5\n# rate = 6\n" + with_rows(["1", "2"], "a [N]"), {}, "rate is stated twice, 5 and 6"),
        ("# run 3 (second try)\n1\n2\n", {"rate": 1}, "no unit for 'signal'"),
        ("a [N]\n", {"rate": 1}, "no rows of numbers"),
    ],
)
def test_csv_refusals(tmp_path, text, options, message):
    path = tmp_path / "x.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=message) as caught:
        gf.read_signal(path, **options)
    assert "x" in str(caught.value)


def test_matlab_and_numpy_files(tmp_path):
    x = noise(50)
    savemat(tmp_path / "a.mat", {"acc": x[:, None], "Fs": 5120.0, "unit": "m/s^2", "shaft_frequency": 11.7})
    np.savez(tmp_path / "a.npz", acc=x, time=np.arange(50) / 5120, angle=np.arange(50.0), unit="m/s^2", note="run 3")
    for suffix in ("mat", "npz"):
        signal = gf.read_signal(tmp_path / f"a.{suffix}")
        assert_array_equal(signal.values, x)
        assert_allclose(signal.rate, 5120.0)
        assert signal.unit == "m/s^2"
    assert signal.angle[-1] == 49.0
    assert gf.read_signal(tmp_path / "a.mat").shaft_frequency == 11.7


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"a": np.ones(9), "unit": "N"}, "states no sampling rate"),
        ({"a": np.ones(9), "fs": 3.0}, "no unit for 'a'"),
        ({"a": np.ones(9), "fs": 3.0, "rate": 4.0, "unit": "N"}, "rate is given as 4 and 3 Hz"),
        ({"a": np.ones((3, 3)), "fs": 3.0}, r"no vector of real numbers; it has a float64\[3, 3\], fs float64"),
        ({"a": np.ones(9), "b": np.ones(9), "fs": 3.0, "unit": "N"}, "2 columns of values; it has 'a', 'b'"),
        ({"a": np.ones(9), "time": np.arange(8.0), "unit": "N"}, "8 times for 9 samples"),
    ],
)
@pytest.mark.parametrize("suffix", ["mat", "npz"])
def test_array_file_refusals(tmp_path, arrays, message, suffix):
    path = tmp_path / f"x.{suffix}"
    np.savez(path, **arrays) if suffix == "npz" else savemat(path, arrays)
    if suffix == "mat" and "no vector" in message:
        message = "no vector of real numbers"
    with pytest.raises(ValueError, match=message):
        gf.read_signal(path)


def test_files_that_are_something_else(tmp_path):
    for name, content, message in (
        ("a.wav", b"RIFF", r"no format for '\.wav'; use one of \.csv, \.txt, \.mat, \.npz"),
        ("a.npz", b"no archive at all", "is not a numpy archive"),
        ("a.mat", b"no matlab file, but long enough to hold a header " * 5, "is not a MATLAB file"),
        ("b.mat", b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM" + b"\x89HDF", r"version 7\.3 \(HDF5\): save it with '-v7'"),
        ("a.csv", b"\xff\xfe\x00\x01", "is not text in UTF-8"),
    ):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ValueError, match=message):
            gf.read_signal(tmp_path / name)
    np.savez_compressed(tmp_path / "whole.npz", a=noise(5000))
    savemat(tmp_path / "whole.mat", {"a": noise(5000)}, do_compression=True)
    for name in ("npz", "mat"):
        whole = (tmp_path / f"whole.{name}").read_bytes()
        for part in (0, 3, 200, len(whole) // 2, len(whole) - 40):
            (tmp_path / f"cut.{name}").write_bytes(whole[:part])
            with pytest.raises(ValueError, match=r"is not a (numpy archive|MATLAB file)|cannot read"):
                gf.read_signal(tmp_path / f"cut.{name}", rate=1, unit="N")
    with open(tmp_path / "array.npz", "wb") as file:
        np.save(file, noise(9))
    with pytest.raises(ValueError, match="is not a numpy archive"):
        gf.read_signal(tmp_path / "array.npz")
    with pytest.raises(ValueError, match=r"cannot read .*No such file"):
        gf.read_signal(tmp_path / "missing.csv")
    np.savez(tmp_path / "o.npz", a=np.array([{}, 1], dtype=object), allow_pickle=True)
    with pytest.raises(ValueError, match="is not a numpy archive of plain arrays"):
        gf.read_signal(tmp_path / "o.npz")
