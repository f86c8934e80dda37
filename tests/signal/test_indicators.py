import math
import re
from dataclasses import replace

import centroid
import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.signal import indicators as ind
from gearfe.signal.indicator_table import increment, tabulate_indicators
from gearfe.signal.spectrum import Spectrum
from validation.shared import places

RATE, N = 5120.0, 51200  # 10 s, bins 0.1 Hz apart
F_M, F_FAULT = 280.0, 40.0  # of S0's machine
TIME = np.arange(N) / RATE


def cos(frequency, phase=0.0):
    return np.cos(2 * np.pi * frequency * TIME + phase)


def family(severity=0.3, impact=0.0, *, lean=0.0, noise=0.0, seed=0):
    """Mesh line of amplitude 1 with fault sidebands 40 Hz apart and impact sidebands 2 Hz apart [N].

    `lean` moves amplitude from the lower to the upper fault sideband, as a phase modulation beside the amplitude modulation does.
    """
    x = (
        cos(F_M)
        + severity * ((1 - lean) * cos(F_M - F_FAULT, 1.0) + (1 + lean) * cos(F_M + F_FAULT, 2.0))
        + 0.5 * severity * cos(F_FAULT)
    )
    for k in range(1, 6):
        x = x + impact / k * (cos(F_M - 2 * k, 0.5) + cos(F_M + 2 * k, 0.7))
    return gf.Signal(x + noise * np.random.default_rng(seed).standard_normal(N), RATE, "N")


@pytest.mark.parametrize("mean", [0.0, -9.0])
def test_indicators_of_a_sine(mean):
    x = mean + 3.0 * np.sin(2 * np.pi * (np.arange(4096) + 0.5) / 1024)
    top = np.cos(np.pi / 1024)  # the samples nearest to the crest are half a step beside it
    found = gf.Signal(x, RATE, "um").indicators()
    assert_allclose(found["rms"], math.sqrt(4.5 + mean**2))
    assert_allclose(found["peak"], 3.0, rtol=1e-5)
    assert_allclose(found["crest factor"], math.sqrt(2) * top, rtol=1e-5)
    assert_allclose(found["crest factor S4"], 3.0 / math.sqrt(4.5 + mean**2), rtol=1e-5)
    assert_allclose(found["kurtosis"], 1.5, rtol=1e-12)
    assert_allclose(found["shape factor"], math.pi / (2 * math.sqrt(2)), rtol=1e-5)
    assert_allclose(found["impulse factor"], math.pi / 2, rtol=1e-5)


def test_indicators_of_a_square_wave_are_one():
    found = gf.Signal(np.tile([2.0, 2.0, -2.0, -2.0], 50), RATE, "N").indicators()
    assert_allclose(list(found.values()), [2, 2, 1, 1, 1, 1, 1])


def test_indicators_of_impulses():
    """One sample of A in n: with p = 1/n, kurtosis (1 - 3 p + 3 p^2) / (p (1 - p))."""
    n, p = 100, 0.01
    x = np.tile(np.append(np.zeros(n - 1), 5.0), 7)
    found = ind.of_values(x, "x")
    assert_allclose(found["kurtosis"], (1 - 3 * p + 3 * p**2) / (p * (1 - p)))
    assert_allclose(found["crest factor"], math.sqrt((1 - p) / p))
    assert_allclose(found["impulse factor"], 1 / (2 * p))
    assert_allclose(found["shape factor"], 1 / (2 * math.sqrt(p * (1 - p))))


def test_a_constant_has_no_shape():
    with np.errstate(all="raise"), pytest.raises(ValueError, match="x is constant"):
        ind.of_values(np.full(100, 9.81), "x")


def test_the_crest_factor_s4_prints_falls_with_the_mean():
    """S4's healthy sun, -7.21 ... -10.77 um: printed 0.2; of the oscillation alone 1.4."""
    x = -8.99 + 1.78 * cos(480.0)
    found = ind.of_values(x, "x")
    assert_allclose(found["crest factor S4"], 0.196, atol=1e-3)
    assert_allclose(found["crest factor"], math.sqrt(2), rtol=1e-3)


@pytest.mark.parametrize("severity", [0.1, 0.3, 0.8])
def test_sideband_index_is_the_mean_of_the_first_order(severity):
    signal = family(severity, lean=0.5)
    assert_allclose(ind.sideband_index(gf.spectrum(signal), F_M, F_FAULT), severity, rtol=1e-9)
    two = gf.Signal(signal.values + 2 * cos(560 - 40.0) + 4 * cos(560 + 40.0), RATE, "N")
    assert_allclose(ind.sideband_index(gf.spectrum(two), F_M, F_FAULT, harmonics=2), (2 * severity + 6) / 4, rtol=1e-9)


def test_sideband_index_needs_sidebands_apart_from_the_mesh_line():
    short = gf.Signal(cos(F_M)[:256], RATE, "N")
    with pytest.raises(ValueError, match=r"bins of 20 Hz, so that the mesh line covers its sidebands; record 0\.1 s or longer"):
        ind.sideband_index(gf.spectrum(short), F_M, F_FAULT)
    longer = gf.Signal(cos(F_M)[:512], RATE, "N")
    assert ind.sideband_index(gf.spectrum(longer), F_M, F_FAULT) < 1e-9


def both(signal):
    found = gf.spectrum(signal, window="boxcar")
    return ind.sideband_centroid_s0(found, F_M, F_FAULT), ind.sideband_centroid_s1(found, F_M, F_FAULT)


def test_centroids_of_known_lines():
    """Amplitudes 0.15, 1, 0.45 at 240, 280, 320 Hz; 801 bins from 240 to 320 Hz."""
    s0, s1 = both(family(0.3, lean=0.5))
    assert_allclose(s0, (0.15**2 * 240 + 280 + 0.45**2 * 320) / (0.15**2 + 1 + 0.45**2), rtol=1e-9)
    assert_allclose(s1, (0.15 * 240 + 280 + 0.45 * 320) / (801 * 280), rtol=1e-9)


def test_s1_depends_on_the_length_of_the_record():
    whole = family(0.4, lean=0.5)
    half = gf.Signal(whole.values[: N // 2], RATE, "N")
    assert_allclose(both(half)[1] / both(whole)[1], 2.0, rtol=5e-3)


def test_printed_349_8_and_352_9_are_impossible():
    """The largest S0's form can give has all energy in the last bin of the window: 320 Hz."""
    frequency = np.arange(0, 2560, 0.1)
    for edge, extreme in ((F_M - F_FAULT, 240.0), (F_M + F_FAULT, 320.0)):
        amplitude = np.where(np.isclose(frequency, edge), 1.0, 0.0)
        amplitude[frequency > 330] = 1e6  # energy above the window cannot help
        found = ind.sideband_centroid_s0(Spectrum(frequency, amplitude, "N", 0.1, 0.1), F_M, F_FAULT)
        assert_allclose(found, extreme)
    assert 315.4 < found < 349.8 < 352.9, "the moderate values lie in the window, the severe ones beyond its end"


def test_the_page_says_what_the_formulas_do():
    found = centroid.study()
    text = (places.PAGES / "sideband_centroid.md").read_text(encoding="utf-8")
    told = [word == "holds" for word in re.findall(r"\| (holds|does not hold) \|", text)]
    assert centroid.verdicts(found) == told == [False, False, True, False]
    assert "\n".join(centroid.rows(found)) in text


@pytest.mark.parametrize(
    ("mesh", "fault", "message"),
    [
        (280.0, 0.0, r"fault_frequency = 0\.0 Hz, but sidebands need one between 0 and f_m"),
        (280.0, 280.0, "fault_frequency = 280"),
        (2540.0, 40.0, r"ends at 2560 Hz, below f_m \+ f_fault = 2580 Hz"),
        (280.0, 0.3, "has 7 bins around f_m, 0.1 Hz apart: record longer"),
    ],
)
@pytest.mark.parametrize("centroid", [ind.sideband_centroid_s0, ind.sideband_centroid_s1])
def test_centroids_refuse(centroid, mesh, fault, message):
    with pytest.raises(ValueError, match=message):
        centroid(gf.spectrum(family()), mesh, fault)


def test_no_energy_no_centroid():
    frequency = np.arange(0, 2560, 0.1)
    with pytest.raises(ValueError, match="is zero around 280 Hz"):
        ind.sideband_centroid_s0(Spectrum(frequency, 0 * frequency, "N", 0.1, 0.1), F_M, F_FAULT)


def test_every_indicator_states_its_source():
    assert list(family().indicators(F_M, F_FAULT)) == list(ind.SOURCES)
    assert list(family().indicators()) == list(ind.SOURCES)[:7]


def test_indicators_of_the_family():
    found = family(0.3, lean=0.5).indicators(F_M, F_FAULT, window="boxcar")
    assert_allclose(found["mesh line"], 1.0)
    assert_allclose(found["sideband index"], 0.3)
    assert_allclose([found["SC (S0)"], found["SC (S1)"]], both(family(0.3, lean=0.5)))
    with pytest.raises(ValueError, match=r"mesh_frequency = 280, fault_frequency = None: give both, or neither"):
        family().indicators(280)


def test_table_of_increments():
    table = gf.indicator_table({"healthy": family(0.1), "mild": family(0.15), "severe": family(0.3)}, F_M, F_FAULT)
    assert_allclose([table[case]["sideband index"][1] for case in table], [0, 50, 200], atol=1e-6)
    assert_allclose(table["severe"]["sideband index"][0], 0.3)
    text = tabulate_indicators(table).markdown().splitlines()
    assert text[0] == "| indicator | healthy | mild | mild, change | severe | severe, change |"
    assert "| mean amplitude of the first sidebands | 0.1 | 0.15 | +50.0 % | 0.3 | +200.0 % |" in text
    assert len(text) == 2 + len(ind.SOURCES)


def test_increment():
    assert_allclose(increment(3.0, 2.0), 50.0)
    assert_allclose(increment(1.5, 2.0), -25.0)
    with pytest.raises(ValueError, match="an increment in percent needs a value other than 0"):
        increment(3.0, 0.0)


@pytest.mark.parametrize(
    "other",
    [
        gf.Signal(np.ones(N), 2 * RATE, "N"),
        gf.Signal(np.ones(N), RATE, "m/s^2"),
    ],
)
def test_table_compares_like_with_like(other):
    with pytest.raises(ValueError, match=r"bad: .* but healthy has 5120 Hz in N: compare records of the same rate and unit"):
        gf.indicator_table({"healthy": family(), "bad": other}, F_M, F_FAULT)


def test_longer_records_are_cut_to_the_shortest():
    whole, part = family(), replace(family(), values=family().values[: N - 700])
    found = gf.indicator_table({"healthy": part, "again": whole}, F_M, F_FAULT)
    assert all(growth == 0 or math.isnan(growth) for _, growth in found["again"].values())


def test_table_needs_the_healthy_case():
    with pytest.raises(ValueError, match="no case 'healthy' to compare with; there are new"):
        gf.indicator_table({"new": family()})
    table = gf.indicator_table({"new": family()}, healthy="new")
    assert table["new"]["kurtosis"][1] == 0.0


def test_what_grows_from_nothing_has_no_percentage():
    table = tabulate_indicators({"healthy": {"sideband index": (1e-12, 0.0)}, "cracked": {"sideband index": (0.07, 7e12)}})
    assert table.cells()[-1] == ["mean amplitude of the first sidebands", "1e-12", "0.07", "healthy: none"]


def test_more_than_ten_times_is_told_as_a_factor():
    table = tabulate_indicators({"healthy": {"kurtosis": (2.0, 0.0)}, "cracked": {"kurtosis": (50.0, 2400.0)}})
    assert table.cells()[-1] == ["kurtosis", "2", "50", "25 x healthy"]
