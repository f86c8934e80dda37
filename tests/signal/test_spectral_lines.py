import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf

pytestmark = pytest.mark.quick

RATE, N = 5120.0, 51200  # 10 s, bins 0.1 Hz apart
F_M, F_FAULT = 280.0, 40.0  # of S0's machine
TIME = np.arange(N) / RATE


def cos(frequency, phase=0.0):
    return np.cos(2 * np.pi * frequency * TIME + phase)


def test_expected_lines_of_s0():
    lines = gf.expected_lines(280.0, 40.0, 10 / 3, 2)
    assert_allclose(
        [
            lines[name]
            for name in ("f_m", "f_m - f_fault", "f_m + 2 f_fault", "f_fault", "2 f_fault", "f_m - f_carrier", "f_carrier")
        ],
        [280, 240, 360, 40, 80, 276.6667, 3.3333],
        rtol=1e-4,
    )
    assert len(lines) == 1 + 4 + 4 + 2 + 2


def test_expected_lines_stay_above_zero_and_count_harmonics():
    lines = gf.expected_lines(100.0, 60.0, count=2, harmonics=2)
    assert "f_m - 2 f_fault" not in lines
    assert_allclose(lines["2 f_m - 2 f_fault"], 80.0)
    assert gf.expected_lines(100.0, count=0) == {"f_m": 100.0}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0.0,), "f_m = 0.0, but give a positive number of Hz"),
        ((280.0, -40.0), "f_fault = -40.0, but"),
        ((280.0, 40.0, math.inf), "carrier_frequency = inf, but"),
        ((280.0, 40.0, None, -1), "count = -1"),
    ],
)
def test_expected_lines_refuse(arguments, message):
    with pytest.raises(ValueError, match=message):
        gf.expected_lines(*arguments)


def test_find_lines_finds_amplitudes_of_an_am_signal():
    carrier, depth = 3.0, 0.4
    x = carrier * (1 + depth * cos(F_FAULT)) * cos(F_M)
    found = gf.find_lines(gf.spectrum(gf.Signal(x, RATE, "N")), gf.expected_lines(F_M, F_FAULT, count=1))
    assert_allclose(found["f_m"], (280.0, 3.0))
    assert_allclose(found["f_m - f_fault"], (240.0, carrier * depth / 2))
    assert_allclose(found["f_m + f_fault"], (320.0, carrier * depth / 2))
    assert found["f_fault"][1] < 1e-9, "a product has no line at f_fault itself"


def test_find_lines_within_the_tolerance_only():
    """S1: 39.8 Hz measured for 40."""
    found = gf.spectrum(gf.Signal(cos(39.8), RATE, "N"))
    assert_allclose(gf.find_lines(found, {"f_fault": 40.0})["f_fault"], (39.8, 1.0))
    assert_allclose(gf.find_lines(found, {"f_fault": 40.0}, 0.05)["f_fault"], (40.0, 0.0), atol=1e-9)


def test_find_lines_refuses_what_the_spectrum_does_not_hold():
    found = gf.spectrum(gf.Signal(cos(40.0), RATE, "N"))
    with pytest.raises(ValueError, match="line f_m at 3000 lies above signal, which ends at 2560 Hz"):
        gf.find_lines(found, {"f_m": 3000.0})
    with pytest.raises(ValueError, match=r"no bin from 40\.03 to 40\.07 Hz: .* steps of 0\.1"):
        gf.find_lines(found, {"f_m": 40.05}, 0.02)


def test_a_line_is_not_found_on_its_neighbour():
    """S1's carrier sidebands, 3.33 Hz beside the mesh line, looked for as far as 3.4 Hz away."""
    found = gf.spectrum(gf.Signal(cos(F_M) + 0.1 * cos(F_M + 3.4), RATE, "N"))
    lines = gf.find_lines(found, gf.expected_lines(F_M, carrier_frequency=10 / 3, count=1), 3.4)
    assert_allclose(lines["f_m"], (280.0, 1.0))
    assert_allclose(lines["f_m + f_carrier"], (283.4, 0.1))
    assert lines["f_m - f_carrier"][1] < 1e-9
