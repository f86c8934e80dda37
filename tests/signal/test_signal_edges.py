"""Responses read back as signals, frequencies the wrong way round, a squared envelope of lines only, scalloping as stated."""

import numpy as np
import pytest
from machines import stepped
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.signal.demodulation import Demodulated
from gearfe.signal.indicators import sideband_index
from gearfe.signal.kurtogram import fast_kurtogram
from gearfe.signal.spectrum import Spectrum


@pytest.mark.parametrize("suffix", [".npz", ".mat", ".csv"])
def test_a_saved_response_is_read_as_a_signal(tmp_path, suffix):
    machine = gf.single_mesh(1.0, 1e8 * (1 + 0.1 * np.cos(2 * np.pi * np.arange(16) / 16)), 100.0, force=10.0, damping=300.0)
    response = stepped(machine, 0.01, dt=1e-5)
    path = tmp_path / f"r{suffix}"
    response.save(path)
    got = gf.read_signal(path, column="force mesh")
    assert got.unit == "N"
    assert_allclose(got.rate, 1e5, rtol=1e-9)
    assert_allclose(got.values, response["force mesh"], rtol=1e-12)
    with pytest.raises(ValueError, match=r"'pair\.x' \[m\], 'force mesh' \[N\]"):
        gf.read_signal(path)


def sine(frequency, n=4000):
    return np.sin(2 * np.pi * frequency * np.arange(n) / 1000)


def test_a_fault_above_the_mesh_is_refused_by_name():
    found = gf.spectrum(gf.Signal(sine(50.0), 1000.0, "N"))
    with pytest.raises(ValueError, match=r"fault_frequency = 100.0 Hz, but sidebands need one between 0 and f_m = 50.0 Hz"):
        sideband_index(found, 50.0, 100.0)


def test_lines_without_a_background_are_told_with_their_amplitudes():
    kurtogram = fast_kurtogram(gf.Signal(sine(50.0) + 0.1 * sine(7.0), 1000.0, "N"), 2)
    spectrum = Spectrum(np.arange(5.0), np.zeros(5), "(N)^2", 1.0, 1.5)
    assert "f_fault 3.00 Hz 2 (N)^2" in Demodulated(kurtogram, spectrum, {"f_fault": (3.0, 2.0)}, 0.0).text()
    assert "f_fault 3.00 Hz 4 x" in Demodulated(kurtogram, spectrum, {"f_fault": (3.0, 2.0)}, 0.5).text()


@pytest.mark.parametrize("part", np.arange(0, 1, 0.125))
@pytest.mark.parametrize("window", ["hann", "flattop"])
def test_sideband_index_and_mesh_line_do_not_depend_on_where_between_the_bins_they_lie(part, window):
    """Bins of 0.25 Hz; the largest bin of Hann's window alone would be up to 15 % low."""
    mesh, fault = 200.0 + 0.25 * part, 9.875 + 0.1 * part
    values = sine(mesh) + 0.5 * sine(mesh - fault) + 0.5 * sine(mesh + fault)
    found = gf.Signal(values, 1000.0, "N").indicators(mesh, fault, window=window)
    assert_allclose(found["mesh line"], 1.0, rtol=1e-4 if window == "hann" else 3e-3)
    assert_allclose(found["sideband index"], 0.5, rtol=1e-3 if window == "hann" else 3e-3)


def test_a_line_is_placed_between_its_bins():
    spectrum = gf.spectrum(gf.Signal(sine(100.1), 1000.0, "N"))
    assert_allclose(gf.find_lines(spectrum, {"f": 100.1}, between=True)["f"], (100.1, 1.0), rtol=1e-5)
    assert gf.find_lines(spectrum, {"f": 100.1})["f"][1] < 0.93, "the bin alone"
    assert gf.find_lines(spectrum, {"f": 101.0}, between=True) == gf.find_lines(spectrum, {"f": 101.0}), "no maximum"
