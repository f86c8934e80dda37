"""Arguments of a wrong type or size: an error of gearfe that names them, at once."""

import time

import numpy as np
import pytest

import gearfe as gf

pytestmark = pytest.mark.quick
BAD = [None, 5, "x", -1, 0, np.nan, np.inf, 10**400, True, [], {}, (1,), 1.5, np.ma.masked, 1e300, 1j]
VALUES = np.sin(np.arange(4000.0) / 5) + 0.1 * np.random.default_rng(0).standard_normal(4000)
RECORD = gf.Signal(VALUES, 1000.0, "g", name="record", shaft_frequency=20.0)
AVERAGE = gf.synchronous_average(RECORD)[0]
MESHING = np.cos(24 * np.linspace(0, 2 * np.pi, 512, endpoint=False)) + 0.1 * np.random.default_rng(0).standard_normal(512)
TIMES = np.arange(9.0) / 4
CALLS = {
    "scene": gf.load_scene,
    "study": lambda bad: gf.sweep(bad, "nowhere"),
    "plan": lambda bad: gf.dataset(bad, "nowhere"),
    "runs": gf.open_runs,
    "data set": gf.open_dataset,
    "surrogate": gf.Surrogate.load,
    "file": gf.read_signal,
    "cases": lambda bad: gf.batch(bad, workers=1),
    "healthy": lambda bad: gf.roc_auc(bad, []),
    "resolution": lambda bad: gf.power_spectral_density(RECORD, resolution=[bad]),
    "window": lambda bad: gf.spectrum(RECORD, window=[bad]),
    "window of power": lambda bad: gf.power_spectral_density(RECORD, window=("none such", bad)),
    "window of frames": lambda bad: gf.spectrogram(RECORD, window=[bad]),
    "window of orders": lambda bad: gf.order_spectrum(RECORD, window=("none such", bad)),
    "band": lambda bad: gf.envelope(RECORD, [bad]),
    "teeth": lambda bad: gf.gear_indicators(AVERAGE, [bad]),
    "average": lambda bad: gf.gear_indicators(bad, 20),
    "earlier averages": lambda bad: gf.gear_indicators(MESHING, 24, before=[bad]),
    "residual": lambda bad: gf.residual_signal(AVERAGE, [bad]),
    "samples per turn": lambda bad: gf.synchronous_average(RECORD, [bad]),
    "turns": lambda bad: gf.synchronous_average(RECORD, turns_per_period=[bad]),
    "new rate": lambda bad: gf.decimate(RECORD, [bad]),
    "mesh": lambda bad: RECORD.indicators([bad], 20.0),
    "records": lambda bad: gf.gear_indicator_table({} if bad is None else bad, 20),
    "cases of signals": gf.indicator_table,
    "filters": lambda bad: gf.fast_kurtogram(RECORD, filters=bad),
    "levels": lambda bad: gf.fast_kurtogram(RECORD, [bad]),
    "fault": lambda bad: gf.demodulate(RECORD, [bad]),
    "harmonics": lambda bad: RECORD.indicators(100.0, 20.0, harmonics=[bad]),
    "many harmonics": lambda bad: RECORD.indicators(100.0, 20.0, harmonics=10**9),
    "speeds": lambda bad: gf.with_estimated_speed(RECORD, 2, bad),
    "size": lambda bad: gf.spectrogram(RECORD, [bad]),
    "unit": lambda bad: gf.integrate(RECORD, 1, 5.0, [bad]),
    "ratio": lambda bad: gf.with_tachometer(RECORD, TIMES, ratio=[bad]),
    "pulses": lambda bad: gf.with_tachometer(RECORD, TIMES, [bad]),
    "sun": lambda bad: gf.stage_lines([bad], 82, 3, 5.0),
    "many lines": lambda bad: gf.stage_lines(20, 82, 3, 5.0, harmonics=10**7),
    "roller": lambda bad: gf.bearing_lines(25.0, 9, [bad], 5.0),
    "lines": lambda bad: gf.find_lines(gf.spectrum(RECORD), {"a": [bad]}),
    "values": lambda bad: gf.Signal(bad, 1.0, "g"),
    "rate": lambda bad: gf.Signal(VALUES, [bad], "g"),
    "stiffness": lambda bad: gf.Support(radial=[bad]),
    "modulus": lambda bad: gf.Material(E=[bad]),
    "segments": lambda bad: gf.Shaft(segments=bad, bearings=(0, 50), gear=25, material=gf.Material()),
    "bearings": lambda bad: gf.Shaft(segments=[(50, 10)], bearings=bad, gear=25, material=gf.Material()),
}


@pytest.mark.parametrize("name", CALLS)
def test_what_cannot_be_is_refused_by_gearfe(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    started, wrong = time.process_time(), []
    for bad in BAD:
        try:
            CALLS[name](bad)
        except (ValueError, RuntimeError):
            continue
        except TypeError as error:
            if ", but give " not in str(error):
                wrong.append(f"{bad!r}: {error}")
        except Exception as error:
            wrong.append(f"{bad!r}: {type(error).__name__}: {error}")
        else:
            wrong.append(f"{bad!r}: nothing was said")
    assert not wrong, "\n".join(wrong)
    assert time.process_time() - started < 5.0
    assert not list(tmp_path.iterdir())


WINDOWS = [("kaiser", np.nan), ("kaiser", 10**400), ("kaiser", 1e300), ("chebwin", np.inf), ("general_cosine", [0.0])]
WINDOWS += [("kaiser",), ("tukey", "no"), (), ("exponential", None, 0.0)]


@pytest.mark.parametrize("window", WINDOWS)
@pytest.mark.parametrize("function", [gf.spectrum, gf.power_spectral_density, gf.spectrogram, gf.order_spectrum])
def test_windows_without_values_are_refused(function, window):
    with pytest.raises(ValueError, match="but give a name such as"):
        function(RECORD, window=window)


@pytest.mark.parametrize("resolution", [5e-324, 10**400, 1e-300])
def test_resolution_finer_than_any_record(resolution):
    with pytest.raises(ValueError, match=r"resolves 0\.25 to 500 Hz|the maximum is"):
        gf.power_spectral_density(RECORD, resolution=resolution)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda row: np.where(np.arange(row.size) == 3, np.nan, row), "average: sample 3 is nan"),
        (lambda row: row.reshape(2, -1), "average: values of shape"),
        (lambda row: 1e200 * row, "average: the largest value is .*, not a plausible measured value"),
    ],
)
def test_averages_that_are_none(change, said):
    with pytest.raises(ValueError, match=said):
        gf.gear_indicators(change(AVERAGE), 20)
