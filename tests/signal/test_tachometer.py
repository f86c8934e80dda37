"""The angle from the pulses of a tachometer, against shafts whose angle is known at every time."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.signal.tachometer import pulse_times, tachometer_angle

RATE = 8000.0
TIME = np.arange(int(4 * RATE)) / RATE


def shaft(turns):
    """Signals of a shaft by its turns at every time: of its pulses, sawteeth that rise in a tenth of a turn."""
    phase = turns % 1
    return gf.Signal(5 * np.clip(10 * phase, 0, 1) * (phase < 0.5), RATE, "V", "tacho")


def chirp(start, rise):
    """Turns of a shaft from `start` Hz, faster by `rise` Hz every second."""
    return 0.3 + start * TIME + rise * TIME**2 / 2


@pytest.mark.parametrize(("start", "rise"), [(12.37, 0.0), (5.0, 6.0), (40.0, -8.0)])
def test_the_angle_of_a_chirp(start, rise):
    turns = chirp(start, rise)
    tacho = shaft(turns)
    angle, samples = tachometer_angle(pulse_times(tacho), tacho)
    off = angle - 2 * np.pi * turns[samples]
    assert np.ptp(off) < 2 * np.pi * 1e-6
    assert (np.diff(angle) > 0).all()


def test_order_spectrum_of_a_run_up_with_a_tachometer():
    """A mesh line of 23 per turn and amplitude 2, smeared over 23 * 24 Hz in the plain spectrum."""
    turns = chirp(10.0, 6.0)
    signal = gf.Signal(2 * np.cos(2 * np.pi * 23 * turns), RATE, "m/s^2")
    found = gf.order_spectrum(gf.with_tachometer(signal, shaft(turns)))
    _, values = found.within(22.8, 23.2)
    assert_allclose(values.max(), 2.0, rtol=0.02)
    assert gf.spectrum(signal).values[1:].max() < 0.4


def test_an_encoder_with_many_pulses_and_falling_edges():
    turns = chirp(10.0, 2.0)
    encoder = gf.Signal(np.sign(np.sin(2 * np.pi * 60 * turns)), RATE, "V")
    angle, samples = tachometer_angle(pulse_times(encoder, falling=True), encoder, 60)
    assert np.ptp(angle - 2 * np.pi * turns[samples]) < 2 * np.pi * 1.5 * turns[-1] / (TIME[-1] * RATE), "a sample and a half"


def test_noise_makes_no_pulses():
    turns = chirp(10.0, 2.0)
    clean = shaft(turns)
    noisy = gf.Signal(clean.values + 0.3 * np.random.default_rng(1).standard_normal(TIME.size), RATE, "V")
    assert pulse_times(noisy).size == pulse_times(clean).size


def test_refusals():
    tacho = shaft(chirp(10.0, 0.0))
    with pytest.raises(ValueError, match="pulses = 0, but it must be a whole number"):
        gf.with_tachometer(tacho, tacho, 0)
    with pytest.raises(ValueError, match="0 pulses through 9 V, but an angle needs 4 or more"):
        gf.with_tachometer(tacho, tacho, level=9.0)
    lost = tacho.values.copy()
    lost[(TIME > 1.0) & (TIME < 1.17)] = 0
    with pytest.raises(ValueError, match=r"no pulse for 0\.2 s after .* one was lost"):
        gf.with_tachometer(tacho, gf.Signal(lost, RATE, "V"))
    with pytest.raises(ValueError, match=r"give records that were taken together"):
        gf.with_tachometer(gf.Signal(TIME, 2 * RATE, "N"), tacho)


def test_channels_of_a_file_get_the_angle_of_its_tachometer(tmp_path):
    turns = chirp(10.0, 6.0)
    np.savez(tmp_path / "run.npz", acc=np.cos(2 * np.pi * 23 * turns), tacho=shaft(turns).values, rate=RATE)
    found = gf.read_signals(tmp_path / "run.npz", units="m/s^2", tachometer="tacho")
    assert list(found) == ["acc"]
    assert found["acc"].angle is not None
    assert_allclose(found["acc"].angle[-1] / (2 * np.pi), round(found["acc"].angle[-1] / (2 * np.pi)), atol=0.01)
