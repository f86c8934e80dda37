"""Contact laws and tables over the mesh phase."""

import math

import numpy as np
import pytest
from machines import WAVE
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.machine.contact_cycle import SI, friction_weights, impact_cycle
from gearfe.dynamics.machine.contact_law import force, friction_coefficient, parameters, slopes, step
from gearfe.dynamics.machine.gear_mesh import GearMesh
from gearfe.dynamics.machine.mesh_curves import Samples, cycle_table
from gearfe.dynamics.machine.phase_table import table
from gearfe.dynamics.machine.tooth_damage import ToothDamage

pytestmark = pytest.mark.quick


def test_step_and_friction_at_their_corners():
    assert_allclose(step([-1, 0, 0.25, 0.5, 1, 2], 0, 1.0, 1, 3.0), [1, 1, 1.3125, 2, 3, 3])
    slip = np.array([-1.0, -1e-4, -5e-5, 0.0, 5e-5, 1e-4, 5.05e-3, 1e-2, 1.0])
    got = friction_coefficient(slip, static=0.08, dynamic=0.05, v_static=1e-4, v_dynamic=1e-2)
    assert_allclose(got, [-0.05, -0.08, -0.055, 0, 0.055, 0.08, 0.065, 0.05, 0.05], atol=1e-12)


def law_of_meshes(*fields):
    return parameters([GearMesh("m", np.ones(1), 1e8, **one) for one in fields])


def test_slopes_are_derivatives_of_the_force():
    law = law_of_meshes(
        {"damping": 50.0},
        {"damping": 30.0, "damping_per_stiffness": 1e-6, "backlash": 2e-5, "film": 0.3},
        {"power": 1.5, "damping": 80.0, "depth": 1e-4, "backlash": math.inf, "push": True},
        {"power": 1.5, "damping": 80.0, "depth": 1e-4, "backlash": 3e-5, "push": True, "film": 0.0},
        {"power": 1.2, "damping": 80.0, "depth": 1e-4, "backlash": 3e-5},
    )
    rng = np.random.default_rng(3)
    k, h = np.array([1e8, 2e8, 3e9, 3e9, 3e8]), 1e-9
    for _ in range(200):
        x, v = rng.uniform(-1e-4, 1e-4, 5), rng.uniform(-0.2, 0.2, 5)
        near = np.minimum(np.abs(x), np.abs(x + law["backlash"])) < 1e-6
        by_x, by_v = slopes(x, v, k, law)
        numeric = (force(x + h, v, k, law) - force(x - h, v, k, law)) / (2 * h)
        ok = ~near & (np.sign(force(x - h, v, k, law)) == np.sign(force(x + h, v, k, law)))
        assert_allclose(by_x[ok], numeric[ok], rtol=1e-3, atol=1e-2)
        numeric = (force(x, v + 1e-6, k, law) - force(x, v - 1e-6, k, law)) / 2e-6
        assert_allclose(by_v[ok], numeric[ok], rtol=1e-5, atol=1e-4)


@pytest.mark.parametrize("power", [1.0, 1.5, 1.2])
def test_the_back_flank_pushes_as_the_front_flank_does(power):
    """Seen from the middle of the play both are alike; flanks that only push never pull."""
    law = law_of_meshes({"power": power, "damping": 200.0, "depth": 1e-4, "backlash": 3e-5, "film": 0.0, "push": True})
    rng = np.random.default_rng(4)
    for x, v in zip(rng.uniform(0, 1e-4, 50), rng.uniform(-2, 2, 50), strict=True):
        front, back = force(np.array([x]), v, 1e8, law), force(np.array([-3e-5 - x]), -v, 1e8, law)
        assert front >= 0
        assert_allclose(back, -front, rtol=1e-9)


def pair_of(scale=1.0):
    rack = {"m_n": 2.0 * scale, "alpha_n": math.radians(20), "b": 20.0}
    return gf.GearPair(gf.Gear(z=21, r_bore=7.4 * scale, **rack), gf.Gear(z=31, r_bore=11.4 * scale, **rack))


def test_a_pair_at_its_pitch_point_is_hertzs_sphere():
    """F = 4/3 E' sqrt(R) d**1.5, with the radii of curvature r_w sin(alpha_wt) and 1 / E' twice (1 - nu**2) / E of steel."""
    pair, steel = pair_of(), gf.Material(E=207e3, nu=0.3)
    one, two = (math.sin(pair.alpha_wt) * r for r in (pair.pitch_radius_1, pair.a - pair.pitch_radius_1))
    want = 4 / 3 * 207e3 / (2 * (1 - 0.3**2)) * math.sqrt(one * two / (one + two))
    found = impact_cycle(pair, (steel, steel))
    assert pair.eps_alpha - 1 < pair.pitch_phase % 1.0 < 1, "one pair alone"
    assert_allclose(np.interp(pair.pitch_phase, found.phase, found.k), SI * want, rtol=1e-4)


def test_friction_turns_round_at_the_pitch_point():
    """There the flanks roll: they slide the one way before and the other way after."""
    pair = pair_of()
    speeds = 100.0, -100.0 * 21 / 31
    weight, *_ = friction_weights(pair, speeds, static=0.1, dynamic=0.1, v_static=1e-6, v_dynamic=1e-5)
    assert pair.eps_alpha - 1 < pair.pitch_phase < 1, "one pair alone"
    assert_allclose(weight(np.array([pair.pitch_phase - 0.02, pair.pitch_phase + 0.02])), [-0.1, 0.1], rtol=1e-9)


def test_table_passes_through_its_samples_without_overshoot():
    rng = np.random.default_rng(1)
    values = rng.uniform(0, 1, 40)
    made = table(values, 0.0, 1 / 40, periodic=True)
    assert_allclose(made(np.arange(40) / 40), values, rtol=1e-12)
    fine = made(np.linspace(0, 1, 4001)[:-1])
    assert values.min() - 1e-12 <= fine.min()
    assert fine.max() <= values.max() + 1e-12
    assert_allclose(made.mean, fine.mean(), rtol=1e-6)


def test_samples_of_a_smooth_stiffness_are_known_between_them_to_fourth_order():
    """A third harmonic: of 64 samples cubics that keep between them are 8e-3 of its amplitude off, at the tops."""
    fine = np.random.default_rng(0).random(4000)

    def off(count):
        wave = 1 + np.cos(6 * np.pi * np.arange(count) / count + 0.3) / 2
        return np.abs(cycle_table(wave)(fine) - 1 - np.cos(6 * np.pi * fine + 0.3) / 2).max()

    errors = [off(count) for count in (64, 128, 256)]
    print("largest error:", *(f"{one:.1e}" for one in errors))
    assert errors[0] < 2e-4
    assert errors[1] < errors[0] / 14
    assert errors[2] < errors[1] / 14
    assert_allclose(np.mean(cycle_table(np.full(64, 2.0))(fine)), 2.0, rtol=1e-15)


def test_samples_with_steps_make_no_staircase_and_none_falls_below_zero():
    steps = np.repeat([1.0, 0.0, 2.0, 1.5], 8)
    fine = cycle_table(steps)(np.linspace(0, 1, 3201)[:-1]).reshape(32, 100)
    low, high = np.minimum(steps, np.roll(steps, -1)), np.maximum(steps, np.roll(steps, -1))
    assert (fine >= low[:, None] - 1e-12).all()
    assert (fine <= high[:, None] + 1e-12).all()
    rough = np.maximum(np.random.default_rng(2).uniform(-1, 1, 200), 0.0)
    assert cycle_table(rough)(np.linspace(0, 1, 8001)).min() > -1e-12


def test_damaged_tooth_replaces_the_healthy_curve_once_in_z_cycles():
    phase = np.arange(-16, 116) / 64
    hurt = Samples(phase, 0.7 * cycle_table(WAVE)(phase % 1.0))
    mesh = GearMesh("m", np.ones(1), WAVE, 100.0, phase=-3.0, teeth=(5, 7), damage=(ToothDamage(0, 2, hurt),))
    inside = np.linspace(-0.2, 1.75, 300)
    for cycle in (2, 7, 12, -3):
        assert_allclose(mesh.at_phase(cycle + inside), 0.7 * mesh.cycle(inside % 1.0), rtol=2e-4)
    assert_allclose(mesh.at_phase(4.2 + np.linspace(0, 2.4, 50)), mesh.cycle((4.2 + np.linspace(0, 2.4, 50)) % 1.0), rtol=1e-12)
    assert_allclose(mesh.entries(0.2), [[0, 0.05, 0.1, 0.15, 0.2]], atol=1e-12)
    assert_allclose(mesh.k(0.05 + 0.007), mesh.at_phase(2.7))
