"""Pitted helical pair and pitted stage: the impact law, places of pits, slices."""

import math

import numpy as np
from checks import ellipse_loss
from machines import SHAPE, herringbone, tooth
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.machine.contact_cycle import contact_line, line_cycle
from gearfe.dynamics.machine.helical_pair import pitted_helical


def test_every_carrier_of_a_damaged_tooth_returns_at_its_interval(herringbone_stage):
    """Sun teeth every 18 cycles of each mesh (planet to planet: 6), planet teeth every 27 in both meshes, half a turn apart."""
    both = {"sun_planet": tooth(6e8 * SHAPE, 0.3, 1.5), "planet_ring": tooth(7e8 * SHAPE, 0.3, 1.8)}
    machine = herringbone(herringbone_stage, {"sun": (4, both), "planet2": (3, both), "ring": (1, both)})
    seen = {m.name: [t * 480 for t in m.entries(0.5)] for m in machine.meshes}
    for i in (1, 2, 3):
        assert_allclose(np.diff(seen[f"sun_planet{i}L"][0]), 18, rtol=1e-9)
        assert_allclose(np.diff(seen[f"planet_ring{i}R"][-1]), 72, rtol=1e-9)
    firsts = np.sort([seen[f"sun_planet{i}L"][0][0] for i in (1, 2, 3)])
    assert_allclose(np.diff(firsts), 6, rtol=1e-9)  # 0.0125 s: 80 Hz
    assert_allclose(firsts[0], 4, rtol=1e-9)
    own, ring = seen["sun_planet2L"][1], seen["planet_ring2L"][0]
    assert_allclose(np.diff(own), 27, rtol=1e-9)
    assert_allclose(np.diff(ring), 27, rtol=1e-9)
    assert 12 < (ring[0] - own[0]) % 27 < 15  # half a turn of the planet
    assert_allclose(np.diff(np.sort([seen[f"planet_ring{i}L"][-1][0] for i in (1, 2, 3)])), 24, rtol=1e-9)
    assert not machine.meshes[[m.name for m in machine.meshes].index("sun_planet1L")].entries(0.5)[1:]


def test_helical_pair_of_the_article():
    rack = {"m_n": 2.1, "alpha_n": math.radians(17.5), "beta": math.radians(29)}
    pinion, wheel = gf.Gear(z=17, b=19.8, r_bore=6.0, **rack), gf.Gear(z=60, b=16.9, r_bore=24.0, **rack)
    pair, steel = gf.GearPair(pinion, wheel), (gf.Material(E=210e3, nu=0.278),) * 2
    phase = np.arange(2000) / 2000
    total = sum(contact_line(pair, phase + k) for k in range(4))
    assert_allclose([total.mean(), total.min(), total.max()], [28.10, 26.33, 30.06], atol=0.02, err_msg="S3: contact line [mm]")
    pits = [(pair.pitch_radius_1, 8.0, 10.0, 2.0)]
    machine = pitted_helical(pair, steel, pits=((0, ellipse_loss(pair, pits)),))
    assert_allclose(machine.notes["mesh frequency [Hz]"], 708.33, atol=0.01, err_msg="S3: f_m")
    assert_allclose(machine.notes["turning frequencies [Hz]"][0], 41.67, atol=0.01, err_msg="S3: f_r")
    mesh = machine.meshes[0]
    assert_allclose(mesh.cycles() / mesh.frequency, 0.024, rtol=1e-6, err_msg="S3: interval of impacts")
    loss = ellipse_loss(pair, pits)(np.arange(0, 2.8, 0.001))
    slope = math.tan(abs(pinion.beta_b)) * math.sqrt(pair.pitch_radius_1**2 - pinion.r_b**2) / pinion.r_b
    chord = 10.0 * 2.0 / math.hypot(10.0 * slope, 2.0) / math.cos(pinion.beta_b)  # through the centre
    assert_allclose(loss.max(), chord, rtol=1e-3)
    assert mesh.at_phase(np.arange(0, 3, 0.01)).min() < line_cycle(pair, 1.0).k.min() * mesh.stiffness.k.max()
