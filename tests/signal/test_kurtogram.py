from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from waves import noise, sine

import gearfe as gf

RATE = 5120.0


def impulses(n, *, every, ringing, decay, rate=RATE):
    """Ringings of one natural frequency [Hz], `every` samples apart, on a grid that repeats exactly."""
    k = np.arange(n) % every
    return np.exp(-decay * k / rate) * np.sin(2 * np.pi * ringing * k / rate)


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
    from gearfe.signal.kurtogram import _positive, _split

    bands = [_positive(x)]
    for level in range(3):
        for parts in (2, 3):
            pieces = [piece for band in bands for piece in _split(band, parts)]
            loudest = int(np.argmax([np.abs(piece).max() for piece in pieces]))
            assert loudest == int(frequency / (RATE / 2 / len(pieces))), (level, parts)
            assert_allclose(np.abs(pieces[loudest]).max(), 1.0, atol=0.05)
        bands = [piece for band in bands for piece in _split(band, 2)]


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
    with pytest.raises(ValueError, match="is constant"):
        gf.fast_kurtogram(gf.Signal(np.full(1024, 9.81), RATE, "N"))


def test_antonis_filters_give_what_an_independent_package_gives():
    """Ringing, a sine and a chirp; no random numbers, so that anyone can repeat it."""
    k = np.arange(2**13)
    x = np.exp(-0.06 * (k % 320)) * np.sin(2 * np.pi * 0.166 * (k % 320)) + 0.3 * np.sin(2 * np.pi * 0.0329 * k)
    signal = gf.Signal(x + 0.2 * np.sin(0.01 * k * np.sqrt(k)) + 0.05, RATE, "g")
    found = gf.fast_kurtogram(signal, 5, filters="antoni")
    level, band, kurtosis = np.loadtxt(Path(__file__).with_name("antoni_kurtogram.csv"), delimiter=",").T
    assert_allclose(found.level, level, atol=1e-6)
    assert_allclose(found.centre, (band + 0.5) * found.bandwidth)
    assert_allclose(np.clip(found.kurtosis, 0, None), kurtosis, rtol=1e-7, atol=1e-9)
