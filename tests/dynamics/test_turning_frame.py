"""Gyroscopic terms of a turning carrier: what whirls in space and is seen from a frame that turns, in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from machines import SHAPE, difference, herringbone, stepped
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.dynamics.machine.pitted_planetary import pitted_planetary
from gearfe.dynamics.machine.turning_frame import frame_terms
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
    want = stepped(machine, 0.002, dt=2e-5, method="DOP853", rtol=1e-8)
    assert max(difference(got, want)) < 1e-3
    plain = gf.simulate(replace(machine, spin=0.0), 0.002, rate=5e4)
    assert max(difference(plain, want)) > 5e-3


ACROSS, ABOUT, STIFF_TILT, TURNS = 3e-3, 5e-3, 4e4, 2500.0


def rotor(spin=0.0, turns=TURNS, zeta=0.0):
    """A disc on a bearing that holds its tilt; it turns at `turns` against the ground."""
    layout = gf.Layout([gf.Body("disc", MASS, ABOUT, "x y tilt_x tilt_y theta", ACROSS)])
    held = {"x": STIFF, "y": STIFF, "tilt_x": STIFF_TILT, "tilt_y": STIFF_TILT, "theta": 1e4}
    springs = layout.springs("disc", None, held, zeta)
    loads = (gf.Load("none", layout.unit("disc", "x"), 0.0),)
    return gf.Machine(layout.dofs, layout.mass, tuple(springs), (), loads, spin=spin, rotors={"disc": turns})


def whirls():
    """Forward and backward whirl of a tilting disc: ``J_t w**2 -+ J_p W w - k = 0`` (G. Genta, 2005, eq. 2.79)."""
    half = ABOUT * TURNS / (2 * ACROSS)
    root = np.sqrt(half**2 + STIFF_TILT / ACROSS)
    return root + half, root - half


@pytest.mark.parametrize("spin", [0.0, SPIN])
def test_a_tilting_disc_whirls_forward_and_backward(spin):
    """Seen from a frame that turns the forward whirl is slower by it, the backward one faster."""
    forward, backward = whirls()
    assert forward > 1.5 * np.sqrt(STIFF_TILT / ACROSS) > 2 * backward
    frequencies, modes = gf.natural_frequencies(rotor(spin))
    for want, sense in ((forward - spin, 1), (backward + spin, -1)):
        place = int(np.argmin(np.abs(2 * np.pi * frequencies - want)))
        assert_allclose(2 * np.pi * frequencies[place], want, rtol=1e-10)
        assert_allclose(modes[3, place] / modes[2, place], -1j * sense, atol=1e-9)  # a quarter of a turn after tilt_x


def test_a_top_without_a_bearing_keeps_its_angular_momentum():
    """Free, it nutates about a line that stands still at ``J_p W / J_t``; in a frame that turns as on the ground."""
    layout = gf.Layout([gf.Body("disc", MASS, ABOUT, "tilt_x tilt_y theta", ACROSS)])
    loads = (gf.Load("none", layout.unit("disc", "theta"), 0.0),)
    for spin in (0.0, SPIN):
        top = gf.Machine(layout.dofs, layout.mass, (), (), loads, spin=spin, rotors={"disc": TURNS})
        start = (0.0, 0.0, 0.0), (0.2, 0.0, 0.0)
        got = gf.simulate(top, 0.01, step=1e-6, rate=1e5, initial=start, error=False).raw
        turn = np.exp(1j * spin * got.time)
        tilt = (got["disc.tilt_x"] + 1j * got["disc.tilt_y"]) * turn  # against the ground
        fast = ABOUT * TURNS / ACROSS
        assert_allclose(tilt, 0.2 / (1j * fast) * (np.exp(1j * fast * got.time) - 1), atol=1e-6 * 0.2 / fast)


def test_tilting_halves_of_a_herringbone_stage_have_their_gyroscopic_moments(herringbone_stage):
    still, moving = (herringbone(herringbone_stage, gyroscopic=turns) for turns in (False, True))
    driven, meshes = moving.stages[0], herringbone_stage
    assert_allclose(moving.rotors["sunL"], 2 * np.pi * driven.turning, rtol=1e-12)
    assert_allclose(moving.rotors["planet2R"], -2 * np.pi * driven.mesh / meshes.planet.z, rtol=1e-12)
    assert_allclose(moving.rotors["ring"], -2 * np.pi * driven.mesh / meshes.ring.z, rtol=1e-12)
    coupling, place = moving.C - still.C, moving.dofs.index("sunL.tilt_x")
    assert_allclose(coupling, -coupling.T, atol=1e-12)
    about = moving.mass[moving.dofs.index("sunL.theta")]
    assert_allclose(coupling[place, place + 1], about * moving.rotors["sunL"], rtol=1e-12)
    turn = 2 * np.pi * driven.carrier  # against the ground, in a frame that turns
    assert_allclose(
        about * (moving.rotors["sunL"] + turn) - 2 * moving.mass[place] * turn, coupling[place, place + 1], rtol=1e-12
    )
    slow, fast = (gf.natural_frequencies(one)[0] for one in (still, moving))
    assert 0 < np.abs(fast - slow).max() < 0.1 * slow.max()


def test_the_campbell_diagram_parts_the_whirls():
    found = gf.campbell(rotor(), [0.0, 0.5, 1.0], orders={"turn": TURNS / (2 * np.pi)})
    still = np.sqrt(STIFF_TILT / ACROSS) / (2 * np.pi)
    assert_allclose(np.sort(np.abs(found.natural[0] - still))[:2], 0, atol=1e-6 * still)
    for want in whirls():
        assert np.abs(2 * np.pi * found.natural[2] - want).min() < 1e-6 * want


def test_what_a_turning_frame_cannot_hold_is_refused(herringbone_stage):
    with pytest.raises(ValueError, match="different supports in x and y"):
        body(x=2 * STIFF)
    layout = gf.Layout([gf.Body("one", 1.0, 1.0, "x y z tilt_x tilt_y theta", 1.0)])
    with pytest.raises(ValueError, match="one tilts, so that its rotation speed matters: give the speed by rotors"):
        gf.Machine(layout.dofs, layout.mass, (), (), (), spin=1.0)
    with pytest.raises(ValueError, match="rotors: two is no body that moves in two directions; there are one"):
        gf.Machine(layout.dofs, layout.mass, (), (), (), rotors={"two": 1.0})
    bare = gf.Layout([gf.Body("one", 1.0, 1.0, "tilt_x tilt_y", 1.0)])
    with pytest.raises(ValueError, match="one has no moment of inertia about its axis"):
        gf.Machine(bare.dofs, bare.mass, (), (), (), rotors={"one": 1.0})
    with pytest.raises(ValueError, match="rotors: one = nan"):
        gf.Machine(layout.dofs, layout.mass, (), (), (), rotors={"one": float("nan")})
