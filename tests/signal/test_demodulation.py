"""Kurtogram and squared envelope together, and measured signals on the command line."""

import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.vibration import analyse

pytestmark = pytest.mark.quick

RATE, FAULT = 20480.0, 18.2


def with_noise(signal, decibels, seed=0):
    """The signal with white Gaussian noise, its power `decibels` below that of the signal without its mean."""
    size = np.std(signal.values) * 10 ** (-decibels / 20)
    noise = np.random.default_rng(seed).standard_normal(signal.values.size)
    return replace(signal, values=signal.values + size * noise, name=f"{signal.name} with noise {-decibels:+g} dB")


def impulses(seconds=2.0):
    """Ringings at 3 kHz, `FAULT` of them a second, under a mesh line a hundred times their power."""
    t = np.arange(round(RATE * seconds)) / RATE
    since = t % (1 / FAULT)
    ringing = np.exp(-600 * since) * np.sin(2 * np.pi * 3000 * since)
    return gf.Signal(ringing + 3 * np.sin(2 * np.pi * 182 * t), RATE, "m/s^2", "housing")


def test_fault_is_found_under_noise():
    noisy = with_noise(impulses(), 10.0)
    assert_allclose(np.std(noisy.values - impulses().values), np.std(impulses().values) * 10**-0.5, rtol=0.02)
    noisy = with_noise(impulses(), 15.0)
    found = gf.demodulate(noisy, FAULT)
    low, high = found.kurtogram.band
    assert low < 3000 < high
    for k, (frequency, amplitude) in enumerate(found.lines.values(), 1):
        assert abs(frequency - k * FAULT) <= found.spectrum.resolution
        assert amplitude > 5 * found.background
    away = gf.demodulate(noisy, 23.3)
    assert max(amplitude for _, amplitude in away.lines.values()) < 5 * away.background
    with pytest.raises(ValueError, match="give a positive frequency below"):
        gf.demodulate(noisy, 4000.0)


def test_measured_signal_on_the_command_line(tmp_path, capsys):
    path, picture, spectra = tmp_path / "a.csv", tmp_path / "k.png", tmp_path / "s.png"
    noisy = with_noise(impulses(), 15.0)
    path.write_text("housing [m/s^2]\n" + "\n".join(f"{value:.7g}" for value in noisy.values) + "\n")
    command = ["signal", str(path), "--rate", str(RATE), "--mesh", "182", "--fault", "18.2"]
    assert main([*command, "--kurtogram", str(picture), "--plot", str(spectra)]) == 0
    text = capsys.readouterr().out
    row = next(line for line in text.splitlines() if line.startswith("| mesh frequency "))
    assert_allclose(float(row.split("|")[3]), 3.0, rtol=0.02)
    assert "| kurtosis " in text
    assert re.search(r"impulsive band: fault frequency at 18\.00 Hz \(expected at 18\.20\), \d", text)
    assert picture.stat().st_size > 5000
    assert spectra.stat().st_size > 5000
    assert main(["signal", str(path), "--rate", str(RATE)]) == 0
    assert "f_m" not in capsys.readouterr().out
    assert main(["signal", str(path)]) == 1
    assert "rate" in capsys.readouterr().err


@pytest.mark.parametrize(("fault", "told"), [(9.43396, "at 9.00 Hz (expected at 9.43), "), (10.0, "at 10.00 Hz, ")])
def test_a_bin_beside_the_fault_is_stated_with_it(fault, told):
    """One second has bins of 1 Hz: a fault at 9.43 Hz is found in that of 9 Hz."""
    time, rng = np.arange(20_000) / 20_000.0, np.random.default_rng(0)
    mesh = np.sin(2 * np.pi * 500 * time) + 0.02 * rng.standard_normal(time.size)
    hurt = mesh + 0.5 * np.sin(2 * np.pi * 4000 * time) * (time * fault % 1 < 0.02)
    signals = {name: gf.Signal(values, 20_000.0, "N") for name, values in (("healthy", mesh), ("hurt", hurt))}
    assert f"fault frequency {told}" in analyse(signals, 500.0, turning=fault).envelope()[1]
