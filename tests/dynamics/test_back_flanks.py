"""Back flanks of their own: where they meet, that they push as before where nothing tells them apart, and what they change."""

import math
from functools import cache

import numpy as np
import pytest
from machines import worst
from numpy.testing import assert_allclose
from scipy.optimize import brentq
from usual import RACK

import gearfe as gf

STEEL = gf.Material(E=207e3, nu=0.25)
PLAY = 1e-4
WAVE = 3e8 * (1 + 0.1 * np.cos(2 * np.pi * np.arange(64) / 64) + 0.05 * np.sin(4 * np.pi * np.arange(64) / 64))


@cache
def pair(x=0.0):
    return gf.GearPair(gf.Gear(z=21, r_bore=7.4, x=x, **RACK), gf.Gear(z=31, r_bore=11.4, x=-0.7 * x, **RACK))


def shaken(stiffness=WAVE, **mesh):
    """Thrown from flank to flank."""
    shake = {"error": ((60e-6, 1130.0, 0.4),), "backlash": PLAY, "damping": 300.0, "phase": 0.3}
    return gf.single_mesh(0.15, stiffness, 700.0, force=300.0, **(shake | mesh))


@pytest.mark.parametrize("x", [0.0, 0.3])
def test_they_meet_where_the_mirrored_teeth_do(x):
    """A tooth of the pinion turned back by as much as it is turned forward shows its other flank; the wheel's is the next one."""
    gears = pair(x)
    for phase in (0.1, 0.6, 1.2):
        nominal = gears.path[0] + phase * gears.p_bt
        one, two = gears.turn(nominal)
        other = brentq(lambda n, one=one: gears.turn(n)[0] + one, nominal - 20, nominal + 20)
        assert_allclose((other - gears.path[0]) / gears.p_bt, gf.back_phase(gears) - phase, atol=1e-9)
        turned = (gears.turn(other)[1] + two) / (2 * math.pi) % 1  # of a whole turn
        assert_allclose(turned, 1 - 1 / gears.gear_2.z, atol=1e-9)


@pytest.mark.parametrize("mesh", [{}, {"film": 0.3}, {"push": True}, {"push": True, "depth": 1e-5}], ids=str)
def test_alike_on_both_sides_they_push_as_a_mesh_with_play_does(mesh):
    """Its stiffness at the moment, told the back flanks as what they are: the same run backwards from half a cycle."""
    plain = shaken(**mesh)
    two = gf.with_back_flanks(plain, {"mesh": gf.BackFlanks(0.0, stiffness=WAVE[-np.arange(64)])})
    one, other = (gf.simulate(made, 0.004, rate=1e5, filtered=False) for made in (plain, two))
    force = one["force mesh"]
    assert force.min() < -100 < 100 < force.max(), "both flanks carry"
    assert_allclose(other["force mesh"] - other["force mesh back"], force, atol=2e-3 * np.ptp(force))
    assert_allclose(other.q, one.q, atol=1e-3 * np.ptp(one.q))


def test_the_fast_path_is_the_reference():
    made = gf.with_back_flanks(shaken(), {"mesh": gf.BackFlanks(0.4, stiffness=1.3 * WAVE)})
    got = gf.simulate(made, 0.004, rate=5e4)
    want = gf.simulate(made, 0.004, rate=5e4, method="DOP853", rtol=1e-8)
    assert got["force mesh back"].max() > 100
    assert list(gf.dynamic_factors(got)) == ["mesh"], "at rest the back flanks carry nothing"
    assert worst(got, want) < got.stats["error"] < 1e-2


def test_pressed_on_its_back_flanks_a_pair_has_the_static_transmission_error_of_these():
    law = gf.force_law(pair(), [200.0 * 2**i for i in range(4)], STEEL, phases=64)
    frequency, load = 2.0, 900.0
    made = gf.single_mesh(0.15, law, frequency, force=-load, backlash=PLAY, damping=1e4)
    made = gf.with_back_flanks(made, {"mesh": gf.BackFlanks(gf.back_phase(pair()))})
    response = gf.simulate(made, 1 / frequency, rate=128 * frequency, filtered=False)
    phase = (gf.back_phase(pair()) - frequency * response.time) % 1
    want = gf.mesh_stiffness(pair(), load, STEEL, phases=np.sort(phase[:-1])).deflection[np.argsort(np.argsort(phase[:-1]))]
    got = -PLAY - response["pair.x"][:-1]
    assert_allclose(got[8:], want[8:], rtol=1e-2)
    assert np.ptp(want) > 0.2 * want.mean(), "the phase matters"


@pytest.mark.parametrize("stiffness", [3e8, "law"])
@pytest.mark.parametrize("load", [900.0, -900.0])
def test_at_rest_the_flanks_that_carry_are_those_of_the_load_and_the_others_count_for_nothing(stiffness, load):
    law = gf.force_law(pair(), [200.0 * 2**i for i in range(4)], STEEL, phases=32) if stiffness == "law" else stiffness
    one = gf.single_mesh(0.15, law, 500.0, force=abs(load), backlash=PLAY, zeta=0.02)
    made = gf.with_back_flanks(
        gf.single_mesh(0.15, law, 500.0, force=load, backlash=PLAY, zeta=0.02), {"mesh": gf.BackFlanks(0.3)}
    )
    q = one.rest()[0]
    assert_allclose(made.rest()[0], q if load > 0 else -PLAY - q, rtol=1e-9)
    assert_allclose(gf.natural_frequencies(made)[0], gf.natural_frequencies(one)[0], rtol=1e-9)
    run = gf.simulate(made, 0.02, rate=5e4)
    assert run.stats["losses"] == 0
    assert list(gf.dynamic_factors(run)) == ["mesh" if load > 0 else "mesh back"]
    assert gf.steady_state(made).stable


def test_a_tooth_damaged_on_its_back_flank_shows_once_a_turn_when_that_flank_carries():
    phase = np.arange(-16, 116) / 64
    healthy = np.interp(phase % 1, np.arange(65) / 64, np.append(WAVE, WAVE[0]))
    hurt = gf.ToothDamage(0, 3, gf.Samples(phase, 0.5 * healthy))
    made = shaken(teeth=(21, 31), first=(2, 0), phase=0.0)
    start = gf.back_phase(pair())
    back = gf.with_back_flanks(made, {"mesh": gf.BackFlanks(start, damage=(hurt,))}).meshes[1]
    enters = 1  # tooth 3 comes into mesh at phase 1, and its back flank is at phase 0 to 1.6 of its own
    running = np.linspace(0, 21, 2101)
    part = back.at_phase(start - running) / back.cycle((start - running) % 1)
    low = running[part < 0.99]
    assert_allclose((low.min(), low.max()), (start + enters - phase[-1], start + enters - phase[0]), atol=0.03)


def test_what_has_no_back_flanks_is_refused():
    one = gf.BackFlanks(0.5)
    with pytest.raises(ValueError, match="no mesh 'ring'; there are mesh"):
        gf.with_back_flanks(shaken(), {"ring": one})
    for play in (0.0, math.inf):
        with pytest.raises(ValueError, match="require a finite backlash > 0"):
            gf.with_back_flanks(shaken(backlash=play), {"mesh": one})
    pitch = gf.Case(pair(), 2000.0, STEEL, flanks={"pinion": gf.Flank(pitch=[20e-3] + 20 * [0.0])})
    off = gf.ToothDamage(0, 0, gf.solve(pitch, gf.Solve(phases=16, span="tooth")))
    with pytest.raises(ValueError, match="it has pitch deviations or an eccentricity"):
        gf.with_back_flanks(shaken(teeth=(21, 31), damage=(off,)), {"mesh": one})
    one, two = (gf.Gear(z=z, r_bore=7.4, beta=beta, **RACK) for z, beta in ((21, 0.2), (31, -0.2)))
    with pytest.raises(ValueError, match="spur"):
        gf.back_phase(gf.GearPair(one, two))
