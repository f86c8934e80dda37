"""Channels with different starts, tachometers on another shaft, pulse times: each against a signal in closed form."""

from fractions import Fraction

import numpy as np
import pytest
import pyuff
from nptdms import ChannelObject, TdmsWriter
from numpy.testing import assert_allclose
from universal_files import data_set

import gearfe as gf

RATE, SECONDS, LATE, TEETH = 5000.0, 8.0, 1.0, 24
TIME = np.arange(int(RATE * SECONDS)) / RATE
BEGUN = np.datetime64("2024-03-01T10:00:00")


def turns(time):
    """Revolutions of a shaft that runs up from 10 to 20 Hz."""
    return 10 * time + 10 * time**2 / (2 * SECONDS)


TACHO = (np.mod(turns(TIME), 1) < 0.5).astype(float)
MESH = np.sin(2 * np.pi * TEETH * turns(TIME + LATE))  # recorded from `LATE` on


def tdms(path, early, late):
    with TdmsWriter(path) as file:
        told = {"wf_increment": 1 / RATE, "unit_string": "V"}
        file.write_segment(
            [ChannelObject("run", n, v, properties=told | at) for n, v, at in (("tacho", TACHO, early), ("acc", MESH, late))]
        )


def uff(path):
    for node, (name, values, begin) in enumerate((("tacho", TACHO, 0.0), ("acc", MESH, LATE)), 1):
        pyuff.UFF(str(path)).write_sets([data_set(name, values, node, RATE, begin)], "add")


WRITERS = {
    "offset.tdms": lambda path: tdms(path, {"wf_start_offset": 0.0}, {"wf_start_offset": LATE}),
    "start.tdms": lambda path: tdms(path, {"wf_start_time": BEGUN}, {"wf_start_time": BEGUN + np.timedelta64(1, "s")}),
    "offset.uff": uff,
}


@pytest.mark.parametrize("name", WRITERS)
def test_channels_that_start_apart_are_aligned(tmp_path, name):
    path = tmp_path / name
    WRITERS[name](path)
    tacho, acc = list(gf.read_signals(path))
    found = gf.read_signals(path, tachometer=tacho)[acc]
    spectrum = gf.order_spectrum(found)
    assert_allclose(spectrum.frequency[np.argmax(spectrum.values)], TEETH, atol=0.01)
    assert spectrum.values.max() > 0.98  # 0.6 and less if the start is ignored
    both = gf.read_signals(path)
    assert {one.values.size for one in both.values()} == {int(RATE * (SECONDS - LATE))}


def test_channels_without_a_common_time_are_rejected(tmp_path):
    tdms(tmp_path / "a.tdms", {"wf_start_offset": 0.0}, {"wf_start_offset": 2 * SECONDS})
    with pytest.raises(ValueError, match=r"have different time axes and start at 'tacho' at 0 s, 'acc' at 16 s"):
        gf.read_signals(tmp_path / "a.tdms")


def test_a_tachometer_on_another_shaft_serves_with_the_ratio():
    """29 teeth drive 95: the second shaft has a gear of 36 teeth."""
    ratio = Fraction(29, 95)
    clock = gf.Signal(TACHO, RATE, "V")
    acc = gf.Signal(np.sin(2 * np.pi * 36 * float(ratio) * turns(TIME)), RATE, "g")
    for tachometer in (clock, TIME[1:][np.diff(TACHO) > 0]):
        found = gf.order_spectrum(gf.with_tachometer(acc, tachometer, ratio=ratio))
        assert_allclose(found.frequency[np.argmax(found.values)], 36, atol=0.05)
        assert found.values.max() > 0.9
    for ratio in (0, -1.0, np.nan, "29/95", True):
        with pytest.raises(ValueError, match=r"ratio = .*(but it needs a number|the gear's shaft over that of the tachometer's)"):
            gf.with_tachometer(acc, clock, ratio=ratio)


def test_pulse_times_serve_as_a_tachometer(tmp_path):
    """A short vector that rises holds the times of the pulses, here two per revolution."""
    from scipy.io import savemat

    pulses = np.interp(np.arange(0, turns(TIME[-1]), 0.5), turns(TIME), TIME)
    savemat(tmp_path / "a.mat", {"acc": np.sin(2 * np.pi * 20 * turns(TIME))[:, None], "tach": pulses[:, None]})
    found = gf.read_signals(tmp_path / "a.mat", tachometer="tach", pulses=2, rate=RATE, unit="g")["acc"]
    spectrum = gf.order_spectrum(found)
    assert_allclose(spectrum.frequency[np.argmax(spectrum.values)], 20, atol=0.01)
    assert spectrum.values.max() > 0.98
    with pytest.raises(ValueError, match="times of pulses, but an angle needs 4 or more times"):
        gf.with_tachometer(found, [0.1, 0.3, 0.2, 0.4])


def test_an_average_of_another_shaft_is_reported():
    acc = gf.Signal(np.sin(2 * np.pi * 36 * turns(TIME)) + 0.2 * np.random.default_rng(0).normal(size=TIME.size), RATE, "g")
    right, wrong = (gf.with_tachometer(acc, gf.Signal(TACHO, RATE, "V"), ratio=ratio) for ratio in (1, 0.31))
    gf.gear_indicator_table([right], 36)
    with pytest.warns(UserWarning, match="no line at 36 orders"):
        gf.gear_indicator_table([wrong], 36)
