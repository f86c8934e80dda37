"""Pitted helical pair and pitted stage: the impact law, places of pits, slices."""

import math

import numpy as np
import pytest
from checks import ellipse_loss, pit_loss
from machines import SHAPE, STEEL, herringbone, tooth
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.machine.contact_cycle import contact_line, impact_cycle, line_cycle
from gearfe.dynamics.machine.contact_law import hertz_coefficient
from gearfe.dynamics.machine.helical_pair import pitted_helical
from gearfe.dynamics.machine.loads import pulses
from gearfe.dynamics.machine.pitted_planetary import pitted_planetary
from gearfe.dynamics.motion.simulate import simulate


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


def pattern(teeth, order, z=17):
    """Amplitude of a line at ``order`` turns for equal impacts of those teeth over that of one tooth."""
    return abs(np.exp(2j * math.pi * order * np.asarray(teeth) / z).sum())


def test_which_places_of_three_teeth_could_give_twice_the_turning_frequency():
    """Equal impacts at teeth p_j of 17 multiply the line n f_r of one tooth by ``|sum exp(2 pi i n p_j / 17)|``.

    2 f_r gains most of all lines up to 8 f_r (beyond, the factors repeat backwards, also about f_m) in 15 of the 120 sets of
    three teeth with tooth 0: two of them within two teeth of each other, the third about half a turn away, with gaps of
    1, 8, 8; 1, 7, 9 or 2, 7, 8 teeth in any order. Neighbours give f_r, teeth at thirds of a turn 3 f_r.
    """
    dominant = []
    for a in range(1, 17):
        for b in range(a + 1, 17):
            gains = [pattern((0, a, b), n) for n in range(1, 9)]
            if gains[1] > (1 + 1e-9) * max(gains[:1] + gains[2:]):
                dominant.append((0, a, b))
    gaps = {tuple(sorted((a, b - a, 17 - b))) for _, a, b in dominant}
    assert len(dominant) == 15
    assert gaps == {(1, 8, 8), (1, 7, 9), (2, 7, 8)}
    assert_allclose([pattern((0, 8, 9), n) for n in (1, 2, 3, 4)], [0.966, 2.865, 0.700, 2.478], atol=1e-3)
    assert [1 + int(np.argmax([pattern(teeth, n) for n in range(1, 9)])) for teeth in ((0, 1, 2), (0, 6, 11))] == [1, 3]


@pytest.mark.slow
def test_impact_law_of_the_spur_stage_runs(spur_stage):
    """Hertz K of the article, pits on sun tooth 0, pulses on the carrier, friction: forces push, and the tooth is seen."""
    pair = spur_stage.sun_planet
    radii = (21 * math.sin(math.radians(20)), 31 * math.sin(math.radians(20)))
    assert_allclose(hertz_coefficient(*radii, (STEEL, STEEL)), 3.0459e5, rtol=1e-4, err_msg="S0: K [N/mm^1.5]")
    curves = impact_cycle(pair, (STEEL, STEEL)), impact_cycle(spur_stage.planet_ring, (STEEL, STEEL))
    single = curves[0].k[curves[0].phase > 0.62]
    assert_allclose(single / 1e3**1.5, 3.0459e5, rtol=0.04)
    hurt = impact_cycle(pair, (STEEL, STEEL), lost=pit_loss(pair, count=5, diameter=1.5))
    machine = pitted_planetary(
        spur_stage,
        dict(zip(("sun_planet", "planet_ring"), curves, strict=True)),
        damage={"sun": (0, {"sun_planet": hurt})},
        carrier_torque=pulses(500.0, 800.0, 0.05, 0.005, 3, start=0.003),
        friction={"static": 0.08, "dynamic": 0.05, "v_static": 1e-4, "v_dynamic": 1e-2},
        power=1.5,
        push=True,
        depth=1e-4,
        damping=9.6e3,
        backlash=1e-4,
    )
    got = simulate(machine, 0.01, dt=2e-5, every=5)
    force = got["force sun_planet1"]
    assert force.min() >= 0
    assert force.max() > 1.2 * force[0]
    want = simulate(machine, 0.01, dt=1e-4, method="RK45", rtol=1e-6)
    assert_allclose(got.q, want.q, atol=2e-3 * np.ptp(want.q))
