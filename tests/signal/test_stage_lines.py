"""Lines of a planetary stage at a sensor on its ring: a simulated stage has them where theory places them, and only there."""

import math
from dataclasses import replace

import numpy as np
import pytest
from machines import SHAPE, tooth
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.machine.tooth_damage import ToothDamage

MESH = 1000.0  # Hz
ANGLE = math.radians(20)


def stage(sun, ring, n, damaged=None, heavy=1.0):
    """A stage of synthetic bodies; phases as `gearfe.stage_phases` has them, -sun p / N, half a cycle later at the ring."""
    planet = (ring - sun) // 2
    curves = {"sun_planet": 3e8 * SHAPE, "planet_ring": 4e8 * SHAPE}
    members = {name: gf.Member(m, 0.5 * m * (1e-3 * z) ** 2, 1e8, 1e-3 * math.cos(ANGLE) * z) for name, m, z in (
        ("sun", 0.4, sun), ("ring", 2.0, ring))}  # fmt: skip
    members["sun"], members["ring"] = replace(members["sun"], torsion=1e4), replace(members["ring"], torsion=1e6)
    carrier = gf.Member(3.0, 3e-3, 1e8, 1e-3 * (sun + planet))
    planets = [gf.Member(heavy ** (i == 0) * 0.6, 3e-4, 1e8, 1e-3 * math.cos(ANGLE) * planet) for i in range(n)]

    def mesh(kind, i):
        teeth = {"sun_planet": (sun, planet), "planet_ring": (planet, ring)}[kind]
        where = {"sun": "sun_planet", "planet": "sun_planet", "ring": "planet_ring"}.get(damaged or "")
        hurt = kind == where and (damaged != "planet" or i == 0)
        curve = ToothDamage(int(damaged != "sun"), 0, tooth(curves[kind], 0.3, 1.5)) if hurt else None
        phase = -sun * i / n if kind == "sun_planet" else ring * i / n + 0.5
        return {"frequency": MESH, "phase": phase, "teeth": teeth, "zeta": 0.05, "damage": (curve,) if curve else ()}

    return gf.planetary(members["sun"], planets, members["ring"], carrier, n_planets=n, alpha=(ANGLE, ANGLE), stiffness=curves,
                        mesh=mesh, loads={"sun": 100.0, "carrier": -100.0 * (1 + ring / sun)}, zeta=0.05)  # fmt: skip


def heard(machine, ring, cycles):
    """Amplitudes of the sensor's signal by frequency, over whole turns of the carrier and of a damaged gear."""
    found = gf.steady_state(
        machine, period=cycles / MESH, dt=1 / (48 * MESH)
    ).response  # steps that thirds of a cycle are made of
    times = math.lcm(cycles, ring) // cycles
    count = len(found.time) - 1
    time = np.arange(times * count) * found.time[1]
    whole = replace(found, time=time, states=np.tile(found.states[:-1], (times, 1)))
    signal = gf.housing_signal(whole, carrier=MESH / ring)
    return np.fft.rfftfreq(time.size, found.time[1]), 2 * np.abs(np.fft.rfft(signal.values)) / time.size


@pytest.mark.slow
@pytest.mark.parametrize(("sun", "ring"), [(21, 81), (20, 82)])
@pytest.mark.parametrize("damaged", [None, "sun", "planet"])
def test_a_simulated_stage_has_these_lines_and_no_others(sun, ring, damaged):
    planet = (ring - sun) // 2
    cycles = {None: 1, "sun": sun, "planet": planet}[damaged]
    frequency, size = heard(stage(sun, ring, 3, damaged), ring, cycles)
    found = frequency[(size > 1e-7 * size[1:].max()) & (frequency > 0) & (frequency < 2.5 * MESH)]
    lines = gf.stage_lines(sun, ring, 3, MESH / ring, damaged=damaged, harmonics=3, turns=cycles)
    named = np.array(sorted(lines.values()))
    assert np.abs(found[:, None] - named).min(axis=1).max() < 1e-6 * MESH
    wanted = gf.stage_lines(sun, ring, 3, MESH / ring, damaged=damaged, harmonics=2, turns=2 if damaged else 0)
    sizes = np.interp(list(wanted.values()), frequency, size)
    assert (sizes > 1e-7 * size[1:].max()).all(), sizes / size[1:].max()
    assert len(wanted) >= (10 if damaged else 2)


def test_a_damaged_ring_tooth_has_lines_a_carrier_turn_apart():
    """Every planet meets it once a turn of the carrier: multiples of N f_c about the mesh lines, and no others."""
    sun, ring = 21, 81
    frequency, size = heard(stage(sun, ring, 3, "ring"), ring, ring)
    low = (frequency > 0) & (frequency < 1.3 * MESH)
    found = frequency[(size > 1e-6 * size[1:].max()) & low]
    lines = gf.stage_lines(sun, ring, 3, MESH / ring, damaged="ring", harmonics=1, turns=27)
    named = np.array(sorted(lines.values()))
    assert np.abs(found[:, None] - named).min(axis=1).max() < 1e-6 * MESH
    sizes = np.interp(named[named < 1.3 * MESH], frequency, size)
    assert (sizes > 1e-6 * size[1:].max()).all(), sizes / size[1:].max()
    healthy = np.interp(found, *heard(stage(sun, ring, 3), ring, 1))
    assert np.median(healthy) < 1e-6 * size[1:].max(), "lines of the damage, not of the stage"


def test_unequal_planets_bring_the_lines_that_cancelled():
    frequency, size = heard(stage(20, 82, 3, heavy=1.3), 82, 1)
    lines = gf.stage_lines(20, 82, 3, MESH / 82, equal=False)
    assert {"f_m", "f_m - f_c", "f_m + f_c"} <= set(lines)
    sizes = np.interp([lines["f_m"], lines["f_m + f_c"]], frequency, size)
    assert (sizes > 1e-4 * size[1:].max()).all()


def test_names_and_places():
    assert gf.stage_lines(21, 84, 3, 10 / 3) == pytest.approx({"f_m": 280.0})
    wide = {"3 f_c": 10, "f_m - 3 f_c": 270, "f_m": 280, "f_m + 3 f_c": 290}  # 3 f_c: planets pass the sensor
    assert gf.stage_lines(21, 84, 3, 10 / 3, window=3) == pytest.approx(wide)
    sun = gf.stage_lines(21, 84, 3, 10 / 3, damaged="sun", turns=3)
    assert sun["3 f_t"] == pytest.approx(40.0)  # three planets in a turn of the sun: the fault of S0
    assert sun["f_m + f_t + f_c"] == pytest.approx(280 + 40 / 3 + 10 / 3)  # once a turn of the sun in space
    ring = gf.stage_lines(21, 84, 3, 10 / 3, damaged="ring", turns=2, harmonics=0)
    assert ring == pytest.approx({"3 f_c": 10.0, "6 f_c": 20.0})
    refused = ({"sun": 22}, "cannot be assembled"), ({"damaged": "carrier"}, "must be"), ({"carrier": 0.0}, "positive")
    for wrong, message in refused:
        with pytest.raises(ValueError, match=message):
            gf.stage_lines(**({"sun": 21, "ring": 84, "n_planets": 3, "carrier": 10 / 3} | wrong))


def test_a_stiff_ring_moves_as_a_whole_and_a_soft_one_as_a_beam_on_its_foundation():
    angle = np.linspace(-np.pi, np.pi, 21)
    assert_allclose(gf.ring_window(0.1, 1e9, 1e6)(angle), np.cos(angle), atol=1e-4)
    soft = np.linspace(0, 0.1, 11)
    bending, foundation = 1e-2, 4e8  # of a straight beam: exp(-s) (cos s + sin s)
    s = soft * 0.1 * (foundation / (4 * bending)) ** 0.25
    assert_allclose(gf.ring_window(0.1, bending, foundation)(soft), np.exp(-s) * (np.cos(s) + np.sin(s)), atol=0.02)


@pytest.mark.parametrize("damaged", [None, "sun", "planet"])
def test_planets_at_given_angles_leave_the_lines_of_their_summed_records(damaged):
    """Brute force: the record of each planet as a series of pulses at its own times, heard through its window."""
    sun, ring, carrier = 20, 82, 5.0
    teeth = np.array([0, 31, 68])  # places where a planet can be put in, of 102
    angles = 2 * math.pi * teeth / (sun + ring)
    lines = gf.stage_lines(sun, ring, 3, carrier, damaged=damaged, angles=angles, harmonics=1, turns=2)
    rate, planet = 4096, 31
    t = np.arange(rate * 2 * planet) / rate  # whole periods of everything, carrier turns included
    turn = {"sun": ring * carrier / sun, "planet": ring * carrier / planet}.get(damaged, 0.0)
    heard = np.zeros(t.size)
    for p, angle in enumerate(angles / (2 * math.pi)):
        mesh = np.cos(2 * math.pi * ring * (carrier * t + angle))
        own = angle if damaged == "sun" else 0.37 * p  # the damaged tooth of the sun comes later to a planet ahead
        knock = 1 + (0.5 * np.cos(2 * math.pi * (turn * t - own)) if turn and (damaged == "sun" or p == 0) else 0.0)
        heard += (1 + np.cos(2 * math.pi * (carrier * t + angle))) * knock * mesh
    spectrum = 2 * np.abs(np.fft.rfft(heard)) / t.size
    frequency = np.fft.rfftfreq(t.size, 1 / rate)
    strong = frequency[spectrum > 1e-3]
    assert strong.size
    assert all(min(abs(line - value) for value in lines.values()) < 1e-6 for line in strong)


def test_angles_at_which_no_planet_fits_are_refused():
    with pytest.raises(ValueError, match=r"planets can be assembled where \(20 \+ 82\) angle"):
        gf.stage_lines(20, 82, 2, 5.0, angles=[0.0, 3.0])
    with pytest.raises(ValueError, match="angles has 2 values, but there are 3 planets"):
        gf.stage_lines(20, 82, 3, 5.0, angles=[0.0, 2 * math.pi / 3])
