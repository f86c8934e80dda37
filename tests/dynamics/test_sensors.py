"""Sensors of a scene: sums of channels through modes or a measured path, from the file to spectra, fits and data sets."""

import copy
import math
import os
from dataclasses import replace

import numpy as np
import pytest
from gearboxes import BRANCHING
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

import gearfe as gf
from gearfe.comparison.check_scene import check_scene
from gearfe.comparison.machine_vibration import analysis
from gearfe.comparison.settled import recorded
from gearfe.dynamics.machine.gearbox import gearbox
from gearfe.dynamics.machine.of_scene import flat_machine
from gearfe.dynamics.machine.sensor import with_sensors
from gearfe.dynamics.motion.heard import gain
from gearfe.scene.load import scene_of
from gearfe.scene.toml_file import toml

FORCES = ["spring bearing down2 x", "spring bearing down2 y"]
WAVE = 2e8 * (1 + 0.2 * np.cos(2 * math.pi * np.arange(64) / 64))
MODE = {"modes_Hz": [900.0, 2300.0], "modes_ratio": [0.05, 0.03], "modes_kg": [4.0, 7.0]}
SENSORS = {
    "plain": {"channels": FORCES, "weights": [0.8, -0.6]},
    "box": {"channels": FORCES, "weights": [0.8, -0.6]} | MODE,
    "torque": {"channels": ["spring coupling fan"]},
    "encoder": {"channels": ["a.theta velocity"]},
}


def built(tables=BRANCHING, sensors=SENSORS):
    scene = scene_of("own.toml", copy.deepcopy(tables) | {"sensor": copy.deepcopy(sensors)})
    damage = {name: () for name in tables["pair"]}
    return scene, with_sensors(scene, gearbox(scene, dict.fromkeys(tables["pair"], WAVE), damage))


@pytest.fixture(scope="module")
def run():
    return recorded(built()[1], 0.2, 40_000.0)


def test_forces_torque_and_encoder(run):
    plain = 0.8 * run[FORCES[0]] - 0.6 * run[FORCES[1]]
    assert_allclose(run["sensor plain"], plain, atol=1e-9 * np.abs(plain).max())
    assert_allclose(run["sensor torque"], run["spring coupling fan"], rtol=1e-12)
    assert_allclose(run["sensor encoder"], run["a.theta velocity"], rtol=1e-12, atol=1e-15)
    assert [run.unit(f"sensor {name}") for name in SENSORS] == ["N", "m/s^2", "N m", "rad/s"]
    assert "sensor box" in run.names


def test_housing_modes_were_driven_before_the_record_starts(run):
    """Oscillators that the force of a longer record drives, by another integrator."""
    alone = built(sensors={"plain": SENSORS["plain"]})[1]
    lead = math.ceil(math.log(1000) / (2 * math.pi * 900.0 * 0.05) * 40_000.0)
    long = recorded(alone, 0.2 + lead / 40_000.0, 40_000.0)
    want = sum(accelerations(long, *mode) for mode in zip(*MODE.values(), strict=True))[lead:]
    assert np.abs(run["sensor box"] - want[: run.time.size]).max() < 3e-3 * np.ptp(want)


def accelerations(run, frequency, ratio, mass):
    force, omega = run["sensor plain"] - run["sensor plain"][0], 2 * math.pi * frequency

    def slope(t, u):
        return [u[1], np.interp(t, run.time, force) / mass - 2 * ratio * omega * u[1] - omega**2 * u[0]]

    ends = run.time[0], run.time[-1]
    x, v = solve_ivp(slope, ends, [0.0, 0.0], "DOP853", run.time, max_step=2.5e-5, rtol=1e-7, atol=1e-12).y
    return force / mass - 2 * ratio * omega * v - omega**2 * x


def test_a_measured_path_beside_the_scene_file(run, tmp_path):
    """The file holds the receptance times -omega**2 of the same modes: the same acceleration."""
    f = np.arange(0.0, 20_000.0, 4.0)
    modes = zip(*MODE.values(), strict=True)
    path = sum(-(f**2) / mass / (own**2 - f**2 + 2j * ratio * own * f) for own, ratio, mass in modes)
    rows = "".join(f"{at},{value.real},{value.imag}\n" for at, value in zip(f, path, strict=True))
    (tmp_path / "path.csv").write_text(f"Hz,real,imaginary\n{rows}", encoding="utf-8")
    row = {"channels": FORCES, "weights": [0.8, -0.6], "frf": "path.csv"}
    (tmp_path / "own.toml").write_text(toml(copy.deepcopy(BRANCHING) | {"sensor": {"box": row}}), encoding="utf-8")
    scene = gf.load_scene(tmp_path / "own.toml")
    machine = with_sensors(scene, replace(built()[1], sensors={}))
    got = recorded(machine, 0.2, 40_000.0).signal("sensor box")
    assert got.unit == "m/s^2"
    own, theirs = (gf.spectrum(one) for one in (got, run.signal("sensor box")))
    strong = theirs.values > 0.05 * theirs.values.max()
    assert_allclose(own.values[strong], theirs.values[strong], rtol=0.02)
    assert strong.sum() > 5
    os.mkfifo(tmp_path / "pipe.csv")
    for name, reason in (("nope.csv", "not readable as a table: cannot read"), ("pipe.csv", "it is no regular file")):
        row["frf"] = name
        (tmp_path / "own.toml").write_text(toml(copy.deepcopy(BRANCHING) | {"sensor": {"box": row}}), encoding="utf-8")
        with pytest.raises(ValueError, match=rf"own.toml \[sensor.box\] frf = '{name}'.*{reason}"):
            gf.load_scene(tmp_path / "own.toml")


def test_gain_is_the_amplitude_of_lines():
    """A harmonic force through the modes, sampled so often that lines between samples are the sine."""
    sensor, rate = gf.Sensor(("force left",), modes=tuple(zip(*MODE.values(), strict=True))), 400_000.0
    time, f = np.arange(200_000) / rate, np.array([500.0, 905.0, 2300.0])
    for at, factor in zip(f, gain(sensor, f), strict=True):
        heard = gf.through_modes(gf.Signal(np.sin(2 * math.pi * at * time), rate, "N"), sensor.modes).values[80_000:]
        assert_allclose(np.sqrt(2) * heard.std(), abs(factor), rtol=2e-4)  # (pi f / rate)**2 / 3 of the straight lines


def test_a_scene_with_sensors_reaches_the_machine_and_its_damaged_case():
    crack = [{"case": "hurt", "gear": "c", "tooth": 11, "level": 0.4}]
    scene = scene_of("own.toml", copy.deepcopy(BRANCHING) | {"sensor": copy.deepcopy(SENSORS), "crack": crack})
    check_scene(scene)
    machines = flat_machine(scene), gf.build_machine(scene, "hurt", phases=8)
    assert [list(one.sensors) for one in machines] == [list(SENSORS)] * 2


def test_the_analysis_has_the_channel_of_a_sensor(run):
    found = analysis({"healthy": run}, "sensor box")
    assert found.unit == "m/s^2"
    assert found.amplitudes["healthy"]["f_m"] > 0


@pytest.mark.parametrize(("row", "message"), [
    ({"channels": ["spring bearing down2 x", "spring coupling fan"]}, "channels of different units, N, N m"),
    ({"channels": ["spring coupling fan"]} | MODE, r"\[sensor.s\].*starts at a force, but 'spring coupling fan' is in N m"),
    ({"channels": ["nope"]}, "no channel 'nope'"),
    ({"housing": "inner"}, "no mesh has a name such as 'inner1'"),
    ({"channels": FORCES, "weights": [1.0]}, "give 2 numbers, one for each channel"),
    ({"channels": FORCES} | MODE | {"modes_kg": [1.0]}, "as many entries in each list"),
    ({"channels": FORCES, "modes_Hz": [1.0]}, "give modes_Hz and modes_ratio together"),
    ({"channels": FORCES, "frf": "a.csv"}, "read with a scene file only"),
    ({"channels": ["sensor plain"]}, "receives channels of the machine only"),
    ({}, "give channels .* or housing"),
])  # fmt: skip
def test_invalid_sensors(row, message):
    with pytest.raises(ValueError, match=message):
        check_scene(scene_of("own.toml", copy.deepcopy(BRANCHING) | {"sensor": {"s": row}}))
