from fractions import Fraction

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from waves import noise, sine

import gearfe as gf

pytestmark = pytest.mark.quick

RATE = 5120.0


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
    density = gf.power_spectral_density(gf.Signal(noise(2000), 1000.0, "N"), resolution=20.0, window=window)
    assert_allclose(density.bandwidth, bins * 20.0)


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
    for arguments, said in (
        ((0, 10.0), "times = 0, but it must be a whole number from 1 on"),
        ((2, 0.0), "above = 0.0, but give a positive number of Hz"),
        ((2, 3000.0), "above = 3000.0 Hz, but give a frequency between 0 and"),
    ):
        with pytest.raises(ValueError, match=said):
            gf.integrate(signal, *arguments, "m")


@pytest.mark.parametrize(
    ("values", "options", "message"),
    [
        ([1.0, np.nan, 2.0], {}, "case: sample 1 is nan; remove or replace the 1 samples"),
        ([[1.0, 2.0]], {}, r"case: values of shape \(1, 2\)"),
        ([1.0], {}, r"give a row of two or more real numbers"),
        ([1j, 2.0], {}, "real numbers"),
        ([1.0, 2.0], {"rate": 0.0}, r"case: rate = 0\.0, but give a positive number of Hz"),
        ([1.0, 2.0], {"rate": "5120"}, "case: rate = '5120'"),
        ([1.0, 2.0], {"rate": True}, "case: rate = True"),
        ([1.0, 2.0], {"shaft_frequency": True}, "case: shaft_frequency = True"),
        ([1e200, 2.0], {}, r"case: the largest value is 1e\+200, not a plausible measured value"),
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


def test_slices_and_parts_of_a_record_keep_their_angles():
    angle = np.cumsum(1 + 0.1 * np.cos(np.arange(1000) / 50))
    whole = gf.Signal(np.arange(1000.0), 100.0, "g", angle=angle)
    for part in (whole[200:500], whole.between(2.0, 5.0), whole.part(200, 500)):
        assert_allclose(part.values, np.arange(200.0, 500.0))
        assert_allclose(part.angle, angle[200:500])
    assert whole.between(9.5).values.size == 50
    for start, stop in ((5.0, 5.0), (10.0, 11.0), (-1.0, 2.0)):
        with pytest.raises(ValueError, match="signal has 0 to 10 s"):
            whole.between(start, stop)
    with pytest.raises(TypeError, match="without a step"):
        whole[::2]


def test_a_record_of_rounding_has_no_indicators():
    time = np.arange(2000) / 1000
    healthy = gf.Signal(1e-13 * np.sin(700 * time), 1000.0, "N")
    found = gf.indicator_table({"healthy": healthy, "faulty": gf.Signal(np.sin(500 * time), 1000.0, "N")})
    assert all(np.isnan(pair).all() for pair in found["healthy"].values())
    assert all(np.isfinite(value) and np.isnan(change) for value, change in found["faulty"].values())


@pytest.mark.parametrize("kind", [np.float32, np.int32, int, Fraction])
def test_rates_of_any_type_are_floats(kind):
    signal = gf.Signal(np.arange(8.0), kind(1000), "g", shaft_frequency=kind(20))
    assert type(signal.rate) is type(signal.shaft_frequency) is float
    assert (signal.rate, signal.shaft_frequency) == (1000.0, 20.0)
