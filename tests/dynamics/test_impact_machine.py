"""Scenes under the impact law, and the errors and the play they state."""

from dataclasses import replace

import numpy as np
import pytest
from checks import ellipse_loss, pit_loss
from machines import stepped
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.machine.impact import pits_loss

STAGE, HELICAL = gf.load_scene("planetary_pitting"), gf.load_scene("helical_pitting")


def with_keys(scene, **keys):
    return replace(scene, machine=scene.machine | keys)


def test_pits_of_a_spur_tooth_take_their_chords():
    pair = STAGE.pairs["sun_planet"].pair
    pits = [gf.Pit(radius=21.0, z=z, axes=(0.5, 0.5), depth=0.2, tooth=5) for z in (3.0, 6.5, 10.0, 13.5, 17.0)]
    phase = np.linspace(0.01, pair.eps_alpha - 0.01, 101)
    want = 20 * pit_loss(pair, count=5, diameter=1.0, radius=21.0)(phase)
    assert want.max() > 4.5
    assert_allclose(pits_loss(pair, pits)(phase), want, atol=1e-9)


@pytest.mark.parametrize("hand", [1, -1])
def test_pits_of_a_helical_tooth_are_met_as_the_line_passes(hand):
    """Against the closed form for a straight line through an ellipse, which counts z from where contact enters."""
    gears = [replace(g, beta=hand * abs(g.beta)) for g in (HELICAL.pair().pair.gear_1, HELICAL.pair().pair.gear_2)]
    pair = gf.GearPair(*gears)
    width, radius = min(g.b for g in gears), pair.pitch_radius_1
    pit = gf.Pit(radius=radius, z=(gears[0].b - width) / 2 + 5.0, axes=(0.4, 1.5), depth=0.2)
    entry = 5.0 if hand < 0 else width - 5.0
    phase = np.linspace(0, pair.eps_alpha + pair.eps_beta_of(width), 400)
    want = ellipse_loss(pair, [(radius, entry, 3.0, 0.8)], width=width)(phase)
    got = pits_loss(pair, [pit])(phase)
    assert want.max() > 0.5
    assert_allclose(got.max(), want.max(), rtol=0.01)
    assert_allclose(got.sum(), want.sum(), rtol=0.02)  # there the profile is taken as straight
    assert_allclose(phase @ got / got.sum(), phase @ want / want.sum(), atol=0.015)


def test_the_article_s_stage_runs_from_its_scene():
    scene = with_keys(STAGE, contact="impact")
    machine = gf.build_machine(scene, "severe_rows")
    assert {mesh.power for mesh in machine.meshes} == {1.5}
    assert_allclose(machine.meshes[0].damping, 3.0459e5, rtol=1e-3, err_msg="S0: 0.1 % of K")
    load = next(one for one in machine.loads if one.name == "carrier torque")
    assert_allclose(load(np.array([0.1, 0.525, 0.7, 1.025])), [-500, -750, -500, -750])
    assert machine.meshes[0].friction
    hurt = machine.meshes[0].changes[0][2].cells[:, 0].min() / machine.meshes[0].cycle.mean
    assert -0.3 < hurt < -0.1  # a quarter of the width of one of two pairs
    got = stepped(machine, 0.004, dt=2e-6, every=10)
    assert got["force sun_planet1"].min() > 0


def test_play_and_errors_of_the_scene():
    machine = gf.build_machine(
        with_keys(STAGE, backlash_um=50.0, profile_error_um=2.0, runout_um=10.0, misplaced_um=5.0), phases=8
    )
    assert_allclose([mesh.backlash for mesh in machine.meshes], 5e-5, rtol=1e-12)
    first = machine.meshes[0]
    sizes = sorted((a, f) for a, f, _ in first.error)
    assert_allclose(
        max(a for a, f in sizes if abs(f - 280 / 21) < 1e-9), 10e-6, rtol=1e-9
    )  # the sun's axis, along the line of action
    assert_allclose([a for a, f in sizes if abs(f - 280) < 1e-9], 2e-6, rtol=1e-9)
    still = [a * np.sin(p) for a, f, p in first.error if f == 0]
    assert_allclose(still, [5e-6 * np.sin(first_angle(STAGE))], rtol=1e-9)  # outward opens the mesh with the sun


def test_the_helical_pair_has_the_law_of_its_scene():
    machine = gf.build_machine(with_keys(HELICAL, contact="impact"), "multi")
    assert machine.meshes[0].damping == 1e3


def first_angle(scene):
    return scene.pairs["sun_planet"].pair.alpha_wt


@pytest.mark.parametrize(
    ("scene", "keys", "message"),
    [
        (STAGE, {"contact": "hard"}, "must be one of linear, impact"),
        (gf.load_scene("herringbone"), {"contact": "impact"}, "linear contact only"),
        (HELICAL, {"contact": "impact", "impact": {"pulse_Nm": 3.0}}, "only the model 'planetary'"),
        (STAGE, {"contact": "impact", "impact": {"pulse_Nm": 3.0, "pulse_width_s": 2.0}}, "0 < width < period"),
        (STAGE, {"backlash_um": -1.0}, "backlash"),
    ],
)
def test_what_a_model_does_not_have_is_refused(scene, keys, message):
    with pytest.raises(ValueError, match=message):
        gf.build_machine(with_keys(scene, **keys), phases=8)


def test_the_impact_law_of_a_helical_pair_refuses_spur_gears(tmp_path):
    path = gf.new_scene(tmp_path / "my.toml", teeth=(17, 38), module=3.0)
    machine = '[machine]\nmodel = "helical_pair"\nspeed_rpm = 2400.0\ntorque_Nm = 40.0\ncontact = "impact"\n'
    path.write_text(f"{path.read_text()}\n{machine}")
    with pytest.raises(ValueError, match="needs a helix angle"):
        gf.build_machine(gf.load_scene(path))
