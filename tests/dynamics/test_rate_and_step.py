"""What is kept and how it is integrated are two things: rate and step of `simulate`."""

import os
import subprocess
import sys

import numpy as np
import pytest
from machines import difference, stepped, two_masses
from numba import njit
from numba.core.caching import CacheImpl
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.motion.loop_parts import announced, kept
from gearfe.dynamics.motion.simulate import simulate


@pytest.fixture(scope="module")
def reference():
    """Ten mesh cycles of two masses, kept at 2 kHz."""
    return stepped(two_masses(), 0.02, dt=5e-4, method="DOP853", rtol=1e-8)


def test_a_low_rate_keeps_the_step_and_its_error(reference):
    """At 2 kHz, a quarter of what one mesh cycle of 500 Hz needs as a step, the states are those of a fine run."""
    machine = two_masses()
    got = simulate(machine, 0.02, rate=2e3)
    assert_allclose(got.time, np.arange(41) / 2e3, rtol=1e-12)
    assert got.stats["dt"] < 1e-4
    assert max(difference(got, reference)) < 1e-3


def test_a_given_step_is_estimated_and_warned_of(reference):
    machine = two_masses()
    with pytest.warns(UserWarning, match="too long for this machine"):
        got = stepped(machine, 0.02, dt=5e-4)
    assert got.stats["error"] > 0.1
    assert max(difference(got, reference)) > 0.1
    fine = simulate(machine, 0.02, rate=2e3, step=2e-5)
    assert 0 < fine.stats["error"] < 1e-2
    assert fine.stats["dt"] <= 2e-5
    assert max(difference(fine, reference)) < max(1.5 * fine.stats["error"], 1e-6)
    assert "error" not in stepped(machine, 0.002, dt=1e-5, error=False).stats


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rate": 0.0}, "rate = 0 Hz"),
        ({"rate": 10.0}, "keeps one sample"),
        ({"step": -1.0}, "step = -1 s"),
        ({"start": np.nan}, "start = nan"),
    ],
)
def test_what_contradicts_itself_is_refused(options, message):
    with pytest.raises(ValueError, match=message):
        simulate(two_masses(), 0.01, **options)


def test_decimation_keeps_what_is_below_and_takes_out_what_is_above():
    t = np.arange(40000) / 40e3
    whole = gf.Signal(3 + 2 * np.sin(2 * np.pi * 300 * t) + 5 * np.sin(2 * np.pi * 3600 * t), 40e3, "N")
    low = gf.decimate(whole, 4e3)
    assert low.rate == 4e3
    inside = slice(100, -100)
    want = 3 + 2 * np.sin(2 * np.pi * 300 * low.time)
    assert np.abs(whole.values[::10] - want)[inside].max() > 4  # folded to 400 Hz without a filter
    assert_allclose(low.values[inside], want[inside], atol=0.01)
    with pytest.raises(ValueError, match="rate = 80000"):
        gf.decimate(whole, 80e3)


@pytest.mark.slow
def test_what_is_compiled_is_told_of_once_and_what_is_kept_on_the_disk_is_not(tmp_path):
    """Each time in a process of its own, a function that is compiled as the loop is."""
    (tmp_path / "own.py").write_text("""
import numpy as np
from gearfe.dynamics.motion.loop_parts import announced, kept
@kept
def twice(x):
    return 2 * x
told = []
for _ in range(2):
    with announced(told.append):
        twice(1.0)
        twice(2.0)
print(len([line for line in told if line.startswith("compiling the integrator")]))
""")
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, str(tmp_path / "own.py")]
    found = [subprocess.run(command, capture_output=True, text=True, env=environment) for _ in range(2)]
    assert [one.stdout.strip() for one in found] == ["1", "0"], found[0].stderr


def test_without_a_listener_compiling_is_a_warning():
    with pytest.warns(UserWarning, match="compiling the integrator"), announced() as found:
        njit(lambda x: x + 1)(1)
    assert found.seconds > 0
    with announced() as found:
        pass
    assert found.seconds == 0


def test_where_nothing_may_be_written_loops_are_compiled_all_the_same(monkeypatch):
    monkeypatch.setattr(CacheImpl, "_locator_classes", [])

    def twice(x):
        return 2 * x

    with pytest.raises(RuntimeError, match="cannot cache"):
        njit(cache=True)(twice)
    assert kept(twice)(21) == 42
