"""Gyroscopic terms of a turning carrier: what whirls in space and is seen from a frame that turns, in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from machines import SHAPE
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.machine.pitted_planetary import pitted_planetary
from gearfe.machine.turning_frame import frame_terms
from gearfe.motion.step_control import difference
from validation.shared.reference import lin_parker

SPIN, MASS, STIFF, ZETA = 300.0, 2.0, 8e6, 0.05


def body(spin=SPIN, zeta=ZETA, **other):
    layout = gf.Layout([gf.Body("one", MASS, 1e-3)])
    springs = layout.springs("one", None, {"x": STIFF, "y": STIFF, "theta": 1e4} | other, zeta)
    loads = (gf.Load("none", layout.unit("one", "x"), 0.0),)
    return gf.Machine(layout.dofs, layout.mass, tuple(springs), (), loads, spin=spin)


def test_a_body_on_a_bearing_whirls_faster_and_slower_by_the_spin():
    omega = np.sqrt(STIFF / MASS)
    frequencies, modes = gf.natural_frequencies(body())
    assert_allclose(2 * np.pi * frequencies[[0, 1]], [omega - SPIN, omega + SPIN], rtol=1e-12)
    assert_allclose(np.abs(modes[:2, 0]), np.sqrt(0.5 / MASS), rtol=1e-9)  # on a circle


def test_free_motion_is_the_motion_in_space_seen_from_the_frame():
    """Damped by a bearing that stands still: without the circulatory term the decay would be wrong."""
    omega = np.sqrt(STIFF / MASS)
    start = 1e-4
    got = gf.simulate(body(), 0.01, step=1e-5, rate=1e5, initial=((start, 0, 0), (0, -SPIN * start, 0)), error=False).raw
    damped = omega * np.sqrt(1 - ZETA**2)
    t = got.time  # released from rest in space, so that its velocity in the frame is -spin across
    x = start * np.exp(-ZETA * omega * t) * (np.cos(damped * t) + ZETA / np.sqrt(1 - ZETA**2) * np.sin(damped * t))
    assert_allclose(got["one.x"], x * np.cos(SPIN * t), atol=1e-9 * start)
    assert_allclose(got["one.y"], -x * np.sin(SPIN * t), atol=1e-9 * start)


def test_pairs_of_translational_modes_split_as_perturbation_says():
    """Lin & Parker's stage: rotational modes stay to first order, pairs part by the spin times their gyroscopic coupling."""
    still, slow = lin_parker(), 5.0
    moving = replace(still, spin=slow)
    values, modes = gf.natural_frequencies(still)
    whirl = gf.natural_frequencies(moving)[0]
    gyroscopic = frame_terms(still.dofs, still.mass, still.springs, slow)[0]
    found, i = 0, 1
    while i < len(values):
        if i + 1 < len(values) and values[i + 1] - values[i] < 1e-6 * values[i]:
            split = abs(modes[:, i] @ gyroscopic @ modes[:, i + 1]) / (2 * np.pi)
            assert_allclose(whirl[i : i + 2] - values[i : i + 2], [-split / 2, split / 2], atol=2e-3)
            assert split > 0.02
            found, i = found + 1, i + 2
        else:
            assert_allclose(whirl[i], values[i], atol=2e-3)
            i += 1
    assert found == 6


def test_fast_path_and_reference_agree_on_a_turning_stage(spur_stage):
    curves = {"sun_planet": 3e8 * SHAPE, "planet_ring": 4e8 * SHAPE}
    machine = replace(pitted_planetary(spur_stage, curves, gyroscopic=True), spin=600.0)
    got = gf.simulate(machine, 0.002, rate=5e4)
    want = gf.simulate(machine, 0.002, dt=2e-5, method="DOP853", rtol=1e-8)
    assert max(difference(got, want)) < 1e-3
    plain = gf.simulate(replace(machine, spin=0.0), 0.002, rate=5e4)
    assert max(difference(plain, want)) > 5e-3


def test_what_a_turning_frame_cannot_hold_is_refused(herringbone_stage):
    with pytest.raises(ValueError, match="otherwise in x than in y"):
        body(x=2 * STIFF)
    layout = gf.Layout([gf.Body("one", 1.0, 1.0, "x y z tilt_x tilt_y theta", 1.0)])
    with pytest.raises(ValueError, match="tilt"):
        gf.Machine(layout.dofs, layout.mass, (), (), (), spin=1.0)
