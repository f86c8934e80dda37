"""Programs of the how-to pages on vibration and signals run, page by page."""

import re
from pathlib import Path

import numpy as np
import pytest

import gearfe as gf

HOWTO = Path(__file__).parents[2] / "gearfe" / "docs" / "howto"
VIBRATION = ("machine", "any_tooth", "sampling", "resonances", "run_up", "housing_sensor")
SIGNALS = ("order_tracking", "gear_indicators", "envelope", "spectra")


def program(page):
    """The Python blocks of a page as one program."""
    return "\n".join(re.findall(r"```python\n(.*?)```", (HOWTO / f"{page}.md").read_text(encoding="utf-8"), re.S))


@pytest.mark.parametrize("page", [*VIBRATION, pytest.param("force_laws", marks=pytest.mark.slow)])
def test_the_programs_of_vibration_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    exec(compile(program(page), page, "exec"), {})


@pytest.mark.parametrize("page", SIGNALS)
def test_the_programs_of_signals_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rate, time = 10240.0, np.arange(3 * 10240) / 10240.0
    turn = 25.0 * time
    noise = 0.1 * np.random.default_rng(0).standard_normal(time.size)
    teeth = 24 if page == "order_tracking" else 32
    signal = gf.Signal(np.cos(2 * np.pi * teeth * turn) + 0.3 * np.cos(4 * np.pi * teeth * turn) + noise, rate, "m/s^2", "acc")
    tachometer = gf.Signal((np.mod(10 * turn, 1) < 0.5).astype(float), rate, "V", "tacho")
    average = gf.synchronous_average(gf.with_tachometer(signal, tachometer, pulses=10))[0]
    exec(compile(program(page), page, "exec"), {"gf": gf, "signal": signal, "tachometer": tachometer, "average": average})


def test_the_programs_of_reading_run(tmp_path, monkeypatch):
    """On text files; the other formats have their own tests."""
    monkeypatch.chdir(tmp_path)
    values = np.column_stack([np.arange(64) / 640, np.sin(np.arange(64)), np.cos(np.arange(64))])
    np.savetxt("bare.txt", values, delimiter=",")
    last = program("read_signals").splitlines()[-1]
    found = eval(last, {"gf": gf})
    assert (found.unit, found.values.size) == ("g", 64)
