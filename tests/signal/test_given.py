"""What averages, bands and whole numbers of the signal room cannot be: refused by name, never a traceback."""

import math
import warnings
from fractions import Fraction

import numpy as np
import pytest

import gearfe as gf

TURN = np.cos(24 * np.linspace(0, 2 * np.pi, 512, endpoint=False)) + 0.1 * np.random.default_rng(0).normal(size=512)
SHAFT = gf.Signal(TURN, 512.0, "g", shaft_frequency=1.0)
HOLE = np.where(np.arange(512) == 3, np.nan, TURN)
ROWS = [
    (HOLE, "average: sample 3 is nan"),
    ([], r"average: values of shape \(0,\)"),
    ([[]], "average: values of shape"),
    (TURN.reshape(2, -1), r"average: values of shape \(2, 256\)"),
    (1e200 * TURN, "average: the largest value is 1.*, not a plausible measured value"),
    (1e-200 * TURN, "average: the largest value is"),
    (1j * TURN, "average: values .* type complex128"),
    (np.full(512, np.inf), "average: sample 0 is inf"),
    (TURN > 0, "average: values .* type bool"),
    ("abc", "average: 'abc', but give a row"),
    (None, "average: None, but give a row"),
    (3.0, "average: 3.0, but give a row"),
    ([[1.0], [1.0, 2.0]], "(average|before) = .*give rows of one length"),
]
COUNTS = [(24.0, "give teeth = 24$"), (24.5, "must be a whole number"), (True, "teeth = True"), ("24", "teeth = '24'"),
          (None, "teeth = None"), (-3, "teeth = -3"), (10**30, "teeth = 1000"), (math.nan, "teeth = nan")]  # fmt: skip


@pytest.fixture(autouse=True)
def no_word_of_numpy():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


@pytest.mark.parametrize(("row", "said"), ROWS)
def test_averages_that_are_none(row, said):
    for work in (
        lambda: gf.gear_indicators(row, 24),
        lambda: gf.gear_indicators(TURN, 24, before=[row]),
        lambda: gf.residual_signal(row, 24),
    ):
        with pytest.raises(ValueError, match=said):
            work()


@pytest.mark.parametrize(("teeth", "said"), COUNTS)
def test_teeth_that_are_none(teeth, said):
    for work in (gf.gear_indicators, gf.residual_signal):
        with pytest.raises(ValueError, match=said):
            work(TURN, teeth)
    assert gf.gear_indicators(TURN, np.int64(24)) == gf.gear_indicators(TURN, 24)


def test_before_is_a_list():
    for wrong in (TURN, 3):
        with pytest.raises(ValueError, match=r"before = .*, but give a list|before is .*, but give a list of earlier averages"):
            gf.gear_indicators(TURN, 24, before=wrong)


@pytest.mark.parametrize("wrong", [True, "x", math.nan, 2.5, [1], -1, 0, 10**9])
def test_numbers_of_turns_rates_and_bands(wrong):
    tries = {
        "samples_per_turn": lambda: gf.synchronous_average(SHAFT, wrong),
        "turns_per_period": lambda: gf.synchronous_average(SHAFT, turns_per_period=wrong),
        "band": lambda: gf.envelope(SHAFT, wrong),
        "mesh_frequency": lambda: SHAFT.indicators(wrong, 1.0),
        "fault_frequency": lambda: SHAFT.indicators(24.0, wrong),
    }
    for name, work in tries.items():
        if wrong in (2.5, 10**9) and name.endswith("frequency"):
            continue  # frequencies
        with pytest.raises(ValueError, match=name if wrong != 10**9 else "turn|band"):
            work()
    for pair in ((1.0, wrong), (wrong, 100.0)):
        if wrong not in (2.5, 0):
            with pytest.raises(ValueError, match=r"band = .*, but (it needs|give) a|band = .* Hz, but signal has 0 to 256 Hz"):
                gf.envelope(SHAFT, pair)
    if wrong not in (2.5,):
        with pytest.raises(ValueError, match="rate = "):
            gf.decimate(SHAFT, wrong)


@pytest.mark.parametrize("kind", [np.float32, np.float64, np.int32, int, Fraction])
def test_rates_of_any_type_are_floats(kind):
    signal = gf.Signal(np.arange(8.0), kind(1000), "g", shaft_frequency=kind(20))
    assert type(signal.rate) is type(signal.shaft_frequency) is float
    assert (signal.rate, signal.shaft_frequency) == (1000.0, 20.0)
    with pytest.raises(ValueError, match="rate = 1000"):
        gf.Signal(np.arange(8.0), 10**400, "g")
