"""Spectrogram and cepstrum against chirps and echoes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf

RATE, N = 4000.0, 16000
TIME = np.arange(N) / RATE


def test_the_ridge_of_a_chirp():
    values = 3.0 * np.cos(2 * np.pi * (200 * TIME + 75 * TIME**2))
    found = gf.spectrogram(gf.Signal(values, RATE, "m/s^2"), 256)
    ridge = found.frequency[found.values.argmax(axis=0)]
    assert np.abs(ridge - (200 + 150 * found.time)).max() <= 0.51 * RATE / 256 + 1
    assert found.values.max(axis=0).min() > 0.8 * 3
    assert found.values.max() < 3.01
    assert found.unit == "m/s^2"


@pytest.mark.parametrize("size", [200, 201, None])
def test_a_lasting_sine_has_its_amplitude_in_every_frame(size):
    found = gf.spectrogram(gf.Signal(7 + 2.0 * np.cos(2 * np.pi * 500 * TIME), RATE, "N"), size)
    assert_allclose(found.values.max(axis=0), 2.0, rtol=1e-3 if size != 201 else 0.16)
    assert found.values.shape == (found.frequency.size, found.time.size)


def test_lines_without_a_twin_are_not_doubled():
    """At 0 Hz a frame's mean, here 3 in one half of the record and -3 in the other; at Nyquist's frequency the whole line."""
    values = np.where(np.arange(N) < N // 2, 3.0, -3.0) + 0.5 * np.cos(np.pi * np.arange(N))
    found = gf.spectrogram(gf.Signal(values, RATE, "N"), 256)
    apart = np.abs(found.time - TIME[N // 2]) > 256 / RATE
    assert_allclose(found.values[0, apart], 3.0, rtol=1e-12)
    assert_allclose(found.values[-1, apart], 0.5, rtol=1e-12)


def test_an_echo_in_the_cepstrum():
    """Log(1 + a exp(-i w t)): a / 2 at t, -a**2 / 4 at 2 t."""
    noise = np.random.default_rng(0).standard_normal(N)
    plain = gf.cepstrum(gf.Signal(noise, RATE, "N"))
    echo = gf.cepstrum(gf.Signal(noise + 0.4 * np.roll(noise, 100), RATE, "N"))
    assert_allclose(echo.frequency[100], 0.025)
    assert_allclose((echo.values - plain.values)[[100, 200, 300]], [0.2, -0.04, 0.4**3 / 6], atol=1e-3)
    assert (echo.axis, echo.unit) == ("s", "1")


def test_sidebands_gather_in_one_peak():
    """Knocks 16 times a second ring at 900 Hz: the largest peak past the ringing is at a sixteenth of a second."""
    since = np.mod(TIME, 1 / 16)
    x = np.exp(-300 * since) * np.sin(2 * np.pi * 900 * since) + 1e-3 * np.random.default_rng(0).standard_normal(N)
    found = gf.cepstrum(gf.Signal(x, RATE, "N"))
    past = found.frequency > 0.03
    assert_allclose(found.frequency[past][found.values[past].argmax()] * 16 % 1, 0.0, atol=1e-9)


def test_refusals():
    with pytest.raises(ValueError, match="size = 9000 samples, but signal has 16000: give 8 to 8000"):
        gf.spectrogram(gf.Signal(TIME, RATE, "N"), 9000)
    with pytest.raises(ValueError, match="is constant"):
        gf.cepstrum(gf.Signal(np.full(100, 3.0), RATE, "N"))


def test_a_spectrogram_is_drawn(tmp_path):
    gf.plot_spectrogram(gf.spectrogram(gf.Signal(np.cos(2000 * TIME**2), RATE, "N"), 256), tmp_path / "s.png", "run-up")
    assert (tmp_path / "s.png").stat().st_size > 5000
