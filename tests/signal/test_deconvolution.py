"""Deconvolution: pulses that are known, seen through a filter that is known, come back."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.signal import lfilter

import gearfe as gf
from gearfe.signal.deconvolution import _impulsive

PERIOD = 200


def heard(noise, seed=0, train=True):
    """Pulses each 200 samples through a damped resonance, in noise."""
    rng = np.random.default_rng(seed)
    pulses = np.zeros(8000)
    pulses[100::PERIOD] = 1.0 if train else 0.0
    pulses[3000] += 0.0 if train else 3.0
    pole = 0.95 * np.exp(0.8j)
    ringing = lfilter([1.0], [1.0, -2 * pole.real, abs(pole) ** 2], pulses)
    return pulses, gf.Signal(ringing + noise * rng.standard_normal(pulses.size), 20000.0, "g")


def recovered(found, pulses):
    """Largest correlation of what came out with the pulses, over all delays."""
    y = np.abs(found.values[200:] - found.values[200:].mean())
    return max(float(np.corrcoef(y, np.roll(pulses, delay)[200:])[0, 1]) for delay in range(100))


@pytest.mark.parametrize("frequency", [None, 100.0])
def test_without_noise_the_pulses_come_back(frequency):
    pulses, signal = heard(1e-3)
    found, taps = gf.deconvolve(signal, frequency, length=60)
    assert recovered(signal, pulses) < 0.6
    assert recovered(found, pulses) > 0.95
    assert found.indicators()["kurtosis"] > 3 * signal.indicators()["kurtosis"]
    assert taps.shape == (60,)
    assert abs(found.values.std() / signal.values.std() - 1) < 1e-6


def test_in_noise_correlated_kurtosis_finds_the_train_and_kurtosis_a_single_knock():
    _, signal = heard(0.5)
    found, _ = gf.deconvolve(signal, 100.0, length=100, shifts=2)
    raw = gf.find_lines(gf.squared_envelope_spectrum(signal), {"f": 100.0})["f"][1] / signal.values.var()
    now = gf.find_lines(gf.squared_envelope_spectrum(found), {"f": 100.0})["f"][1] / found.values.var()
    assert now > 2 * raw
    _, once = heard(0.1, train=False)
    assert gf.deconvolve(once, length=60)[0].indicators()["kurtosis"] > 1.5 * once.indicators()["kurtosis"]


@pytest.mark.parametrize("apart", [[0], [0, 7], [0, 7, 14]])
def test_the_slope_is_the_derivative_of_what_is_made_large(apart):
    """Of the sum above the line, by differences in a direction by chance; and the steps do make it large."""
    rng = np.random.default_rng(3)
    y, to = rng.standard_normal((2, 200))

    def above(y):
        return _impulsive(y, apart)[0] * (y**2).sum() ** max(2, len(apart))

    want = (above(y + 1e-5 * to) - above(y - 1e-5 * to)) / 2e-5
    assert_allclose((4 if len(apart) == 1 else 2) * _impulsive(y, apart)[1] @ to, want, rtol=1e-6)
    _, signal = heard(0.5)
    apart = [PERIOD * i for i in range(len(apart))]
    given = (None if len(apart) == 1 else 100.0), {"length": 100, "shifts": max(1, len(apart) - 1)}
    once, best = (gf.deconvolve(signal, given[0], iterations=n, **given[1])[0].values for n in (1, 30))
    assert _impulsive(best, apart)[0] > 1.5 * _impulsive(once, apart)[0]


def test_what_cannot_be_deconvolved_is_refused():
    _, signal = heard(0.1)
    for given, said in (
        ({"frequency": -1.0}, "frequency = -1"),
        ({"frequency": 19000.0}, "fewer than two samples per period"),
        ({"frequency": 4.0}, "needs twice as many"),
        ({"length": 1}, "length = 1"),
        ({"length": 5000}, "needs twice as many"),
        ({"frequency": 100.0, "shifts": 0}, "shifts = 0"),
    ):
        with pytest.raises(ValueError, match=said):
            gf.deconvolve(signal, **given)
    with pytest.raises(ValueError, match="is constant"):
        gf.deconvolve(gf.Signal(np.ones(4000), 1e3, "g"))
