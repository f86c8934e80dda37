"""From a scene to the vibration of its machine."""

import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison import simulated
from gearfe.comparison.machine_vibration import analysis
from gearfe.comparison.settled import recorded, slowest_decay
from gearfe.comparison.simulated import responses
from gearfe.comparison.vibration import analyse, in_words
from gearfe.dynamics.machine.of_scene import flat_machine
from gearfe.dynamics.motion import run_checks
from gearfe.dynamics.motion.propagator import cycle_rate, default_step
from gearfe.reports import findings

SCENE = gf.load_scene("compound_planetary")


def alarms(found):
    """Lines of the fault that stand out of spectrum or envelope of the last case; empty if it shows nothing."""
    lines = [name for name in found.standing() if "f_fault" in name]
    return [*lines, *(f"{name} of the envelope" for name in found._demodulated()[1])] if found.fault else []


@pytest.fixture(scope="module")
def found():
    return responses(SCENE, "crack50", duration=1.0, phases=32)


def test_frequencies_of_the_scenes():
    notes = gf.build_machine(SCENE, phases=8).notes
    assert_allclose(notes["mesh frequencies [Hz]"], (168.0, 182.0), rtol=1e-12)
    assert_allclose(notes["fault frequencies of sun teeth [Hz]"], (16.8, 18.2), rtol=1e-12)
    notes = gf.build_machine(gf.load_scene("planetary_pitting"), phases=8).notes
    assert_allclose(notes["mesh frequency [Hz]"], 280.0, rtol=1e-12)
    assert_allclose(notes["fault frequency of a sun tooth [Hz]"], 40.0, rtol=1e-12)


@pytest.mark.slow
def test_the_crack_shows_at_its_sidebands_only(found):
    report = analysis(found)
    assert report.channel == "force sun2_b1"
    assert_allclose(report.lines["f_m"], 182.0, rtol=1e-12)
    healthy, hurt = (report.amplitudes[case] for case in ("healthy", "crack50"))
    for name in ("f_m - f_r", "f_m + f_r", "f_r"):
        assert hurt[name] > 1000 * healthy[name], name
    doubt = found["healthy"].stats["error"] * np.ptp(found["healthy"][report.channel])
    assert max(hurt["f_m - f_fault"], healthy["f_m - f_fault"]) < doubt, "three planets in phase: below the error of integration"
    assert_allclose(hurt["2 f_m"], healthy["2 f_m"], rtol=0.1)
    assert report.indicators["crack50"]["sideband index"][0] > report.indicators["healthy"]["sideband index"][0]
    assert "| mesh frequency | 182.00 |" in report.lines_table().markdown()
    assert {"f_m - f_r", "f_m + f_r", "f_r"} <= set(report.standing())
    assert "f_m - f_fault" not in report.standing(), "as weak as what is between the lines"
    assert "times healthy" in report.envelope()[1]


def test_a_healthy_machine_is_told_without_a_fault(found):
    report = analysis({"healthy": found["healthy"]})
    assert report.fault is None
    assert not [name for name in report.lines if "f_fault" in name or "f_r" in name]
    assert "fault" not in report.lines_table().markdown()
    assert "%" not in report.indicators_table().markdown()
    twice = analysis({"healthy": found["healthy"], "the same": found["healthy"]})
    assert not [name for name in twice.standing() if "f_fault" in name or "f_r" in name]
    assert "fewer than 2 lines of the fault have" in twice.envelope()[1]
    assert alarms(twice) == []


def _noisy(seed, sideband=0.0):
    """Two seconds of a mesh line at 200 Hz in white noise, with sidebands at 13 Hz."""
    time = np.arange(8192) / 4096
    clean = np.cos(2 * np.pi * 200 * time) * (1 + 2 * sideband * np.cos(2 * np.pi * 13 * time))
    return gf.Signal(clean + 0.3 * np.random.default_rng(seed).standard_normal(time.size), 4096.0, "m/s^2")


def test_noise_alone_is_no_fault_line():
    """Of 50 pairs of healthy records, each with 10 lines looked for, none shows one; all show a clear fault."""
    false, seen = 0, 0
    for seed in range(50):
        pair = {"healthy": _noisy(seed), "other": _noisy(1000 + seed)}
        false += analyse(pair, 200.0, 13.0).standing() != ["f_m", "2 f_m"]
        hurt = analyse(pair | {"other": _noisy(1000 + seed, 0.1)}, 200.0, 13.0).standing()
        seen += {"f_m - f_fault", "f_m + f_fault"} <= set(hurt)
    assert false == 0
    assert seen == 50


def test_run_out_is_no_fault_but_pulses_are():
    """One line of the envelope is the modulation of something that turns; pulses of a tooth have harmonics alike."""
    time, random = np.arange(25600) / 12800, np.random.default_rng(1)

    def heard(rise):
        """Rough teeth, louder where `rise` says so."""
        rough = {name: own * random.standard_normal(time.size) for name, own in (("healthy", 1.0), ("now", 1 + rise))}
        return {name: gf.Signal(values, 12800.0, "m/s^2") for name, values in rough.items()}

    turning = 0.4 * np.cos(2 * np.pi * 36 * time)
    pulses = 2.0 * (time * 36 % 1 < 0.1)
    one, many = (alarms(analyse(heard(rise), 252.0, 36.0)) for rise in (turning, pulses))
    assert one == []
    assert {"f_fault of the envelope", "2 f_fault of the envelope", "3 f_fault of the envelope"} <= set(many)


def test_words_for_lines():
    assert in_words("f_m + 2 f_carrier") == "mesh frequency + 2 x carrier frequency"


def test_mesh_forces_carry_the_torque(found):
    """Three sun-planet meshes of stage 2 balance the drive on the average."""
    one = found["healthy"]
    arm = 1e-3 * SCENE.pairs["sun_planet"].pair.gear_1.r_b
    mean = sum(one[f"force sun2_b{i}"].mean() for i in (1, 2, 3)) * arm
    drive = next(load for load in one.machine.loads if load.name == "drive")
    assert_allclose(mean, drive.value, rtol=1e-3)


def test_what_cannot_run_is_refused():
    with pytest.raises(ValueError, match="has no \\[machine\\] table"):
        gf.build_machine(replace(SCENE, machine={}))
    with pytest.raises(ValueError, match="no case 'x'; it has broken, crack10"):
        gf.build_machine(SCENE, "x")
    with pytest.raises(ValueError, match="must be one of planetary"):
        gf.build_machine(replace(SCENE, machine=SCENE.machine | {"model": "turbine"}))
    with pytest.raises(ValueError, match="duration = 0"):
        responses(SCENE, duration=0)


@pytest.mark.parametrize("duration", [1e6, 1e12, 1e308])
@pytest.mark.parametrize("compute", [responses, gf.report])
def test_a_record_without_end_is_refused_before_its_curves(compute, duration, tmp_path, monkeypatch):
    monkeypatch.setattr(simulated, "build_machine", lambda *given, **options: pytest.fail("curves"))
    monkeypatch.setattr(findings, "compare", lambda *given, **options: pytest.fail("curves"))
    monkeypatch.setattr(run_checks, "free_memory", lambda: 1e11)
    given = [tmp_path / "x.html"] if compute is gf.report else []
    with pytest.raises(ValueError, match=r"duration = 1e\+.* give a shorter duration"):
        compute(SCENE, *given, duration=duration)


def test_a_first_check_counts_no_more_steps_than_a_run():
    """Otherwise a record that fits would be rejected, first of all that of soft gears."""
    soft = gf.single_mesh(1.0, 1.0, 100.0)
    assert cycle_rate(soft) <= 1 / default_step(soft)
    assert cycle_rate(flat_machine(SCENE)) <= 1 / default_step(gf.build_machine(SCENE, phases=8))


@pytest.mark.slow
def test_command_line(tmp_path, capsys):
    out, plot = tmp_path / "r.npz", tmp_path / "s.png"
    command = ["dynamics", "compound_planetary", "--case", "crack50", "--duration", "0.3"]
    assert main([*command, "-o", str(out), "--plot", str(plot)]) == 0
    text = capsys.readouterr().out
    assert "mesh frequencies [Hz]: 168, 182" in text
    assert "| mean amplitude of the first sidebands " in text
    assert "0.3 s cannot resolve the fault sidebands: record at least 2.86 s" in text
    assert "\nlonger: --duration 2.86\n" in text
    assert out.stat().st_size > 1000
    assert plot.stat().st_size > 10000
    assert main(["dynamics", "compound_planetary", "--case", "none"]) == 1
    assert "it has broken, crack10" in capsys.readouterr().err


def test_a_short_record_says_how_long_it_should_be():
    """A sun tooth at 40 Hz, its gear at 13.3 Hz: in 0.2 s lines fill all bins; so long as is asked for, the fault stands out."""
    rng = np.random.default_rng(1)
    turn, carrier, rate = 40 / 3, 10 / 3, 4096.0

    def found(seconds):
        time = np.arange(round(seconds * rate)) / rate
        mesh = np.cos(2 * np.pi * 280 * time) + 1e-3 * rng.standard_normal(time.size)
        lines = sum(0.02 * (1 + (k % 3 == 0)) * np.cos(2 * np.pi * k * turn * time + k**2) for k in range(1, 100))
        signals = {"healthy": gf.Signal(mesh, rate, "N"), "worn": gf.Signal(mesh + lines, rate, "N")}
        return analyse(signals, 280.0, 40.0, turning=turn, carrier=carrier)

    short = found(0.2)
    assert short.standing() == ["f_m", "2 f_m"]
    needed = float(re.search(r"0.2 s cannot resolve .* record at least ([\d.]+) s", short.hidden_lines())[1])
    enough = found(needed)
    assert {"f_fault", "f_m - f_fault", "f_m + f_fault"} <= set(enough.standing())
    assert enough.too_short == ""


def test_a_record_begins_when_free_vibrations_have_died_out():
    """One mass on its mesh at 100 Hz, damped so that half a record is a sixth of what it needs; nothing but the mesh is left."""
    mass, stiff, damping = 1.0, (200 * np.pi) ** 2, 6.0
    curve = stiff * (1 + 0.05 * np.cos(2 * np.pi * np.arange(64) / 64))
    machine = gf.single_mesh(mass, curve, 37.0, force=100.0, damping=damping)
    assert_allclose(slowest_decay(machine), damping / 2 / mass, rtol=1e-9)
    got = recorded(machine, 1.0, 2000.0)
    assert_allclose(got.stats["free"], 1e-3, rtol=1e-9)
    assert len(got.time) == 2001
    signal = gf.Signal(got["force mesh"][:-1], 2000.0, "N")
    found = gf.find_lines(gf.spectrum(signal), {"mesh": 37.0, "free": 100.0})
    assert found["free"][1] < 2e-3 * found["mesh"][1]


def test_a_record_of_what_never_settles_says_so():
    machine = gf.single_mesh(1.0, 4e5, 37.0, force=100.0)
    got = recorded(machine, 0.1, 2000.0)
    assert got.stats["free"] == 1.0
    assert_allclose(got.stats["settled"], 0.05, rtol=1e-12)


def test_an_unknown_channel_is_rejected_before_the_run():
    with pytest.raises(ValueError, match="no channel 'nonsense'"):
        responses(SCENE, channel="nonsense")
