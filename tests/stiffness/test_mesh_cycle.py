"""Every tooth has its identity: curves of teeth that differ against contact solved over the whole hunting period."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import RACK_15 as RACK

import gearfe as gf
from gearfe.stiffness.finer import BENT, HALVINGS

pytestmark = pytest.mark.quick
PAIR = gf.GearPair(gf.Gear(z=11, x=0.45, r_bore=5.5, **RACK), gf.Gear(z=13, x=0.35, r_bore=7.0, **RACK))
CASE = gf.Case(PAIR, 1000.0, gf.Material(E=206e3, nu=0.3))
PHASES = 4
PITCH = (0.0,) * 3 + (0.02,)


def crack(tooth, length=2.0):
    """A root crack."""
    return gf.Crack(length=length, angle=math.radians(60), tooth=tooth)


def with_pitch(z):
    """Pitch deviation of tooth 3 of z teeth."""
    return gf.Flank(pitch=(*PITCH, *(0.0,) * (z - 4)))


CASES = {
    "tooth 5 of the pinion": {"damage": {"pinion": [crack(5)]}},
    "tooth 7 of the wheel": {"damage": {"wheel": [crack(7)]}},
    "two teeth apart": {"damage": {"pinion": [crack(0), crack(5, 3.0)]}},
    "two teeth side by side": {"damage": {"pinion": [crack(2), crack(3)]}},
    "three teeth of both gears": {"damage": {"pinion": [crack(0), crack(5, 3.0)], "wheel": [crack(4)]}},
    "pitch of one tooth": {"flanks": {"pinion": with_pitch(11)}},
    "pitch of one, a crack in another": {"flanks": {"pinion": with_pitch(11)}, "damage": {"pinion": [crack(9)]}},
    "pitch of both gears": {"flanks": {"pinion": with_pitch(11), "wheel": with_pitch(13)}},
    "a missing tooth of the wheel": {"damage": {"wheel": [gf.MissingTooth(tooth=7)]}},
    "a chip of the pinion": {"damage": {"pinion": [gf.Chip(depth=0.8, tooth=4)]}},
    "an eccentric pinion, a cracked wheel": {
        "flanks": {"pinion": gf.Flank(eccentricity=0.01, eccentric_tooth=2.0)},
        "damage": {"wheel": [crack(1)]},
    },
    "teeth of several scales": {"flanks": {"wheel": gf.Flank(profile_slope=0.01, tooth_scale=(1.0,) * 6 + (1.6,) + (1.0,) * 6)}},
}


COSTLY = ("pitch of both gears", "three teeth of both gears", "an eccentric pinion, a cracked wheel")


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow if name in COSTLY else ()) for name in CASES])
def test_every_cycle_of_the_hunting_period_is_that_of_the_teeth_that_meet(name):
    """Brute force: the contact of the teeth that really meet, at every phase of the hunting period of 143 cycles."""
    case = replace(CASE, **CASES[name])
    cycle = gf.mesh_cycle(case, gf.Solve(phases=PHASES))
    period = 143 if len({side for part in cycle.parts for side in part.gears}) == 2 else cycle.cycles
    assert cycle.cycles == period
    span = "revolution" if period == 11 else "hunting"
    want = gf.solve(case, gf.Solve(phases=PHASES, span=span))
    again = want.k.size // cycle.sampled().size
    assert_allclose(np.tile(cycle.sampled(), again), want.k, rtol=1e-7)
    unloaded = 0.0 if want.unloaded is None else want.unloaded
    assert_allclose(np.tile(cycle.sampled("unloaded"), again), unloaded + 0 * want.k, atol=1e-12)
    te = cycle.sampled("deflection") + cycle.sampled("unloaded")
    assert_allclose(np.tile(te, again), want.te, atol=1e-12)


@pytest.mark.parametrize(("side", "tooth"), [("pinion", 5), ("pinion", 10), ("wheel", 8)])
def test_a_tooth_is_tooth_0_at_another_time(side, tooth):
    """The curve of tooth n is that of tooth 0, n mesh cycles earlier."""
    one, other = (gf.mesh_cycle(replace(CASE, damage={side: [crack(k)]}), gf.Solve(phases=PHASES)) for k in (0, tooth))
    assert_allclose(np.roll(one.sampled(), -tooth * PHASES), other.sampled(), rtol=1e-12)
    assert np.ptp(one.sampled() - np.roll(one.sampled(), PHASES)) > 0


def test_further_phases_have_the_stiffness_of_the_teeth_that_meet():
    """A cracked tooth of the wheel: at phases added to 16, k over the revolution is that of contact solved there."""
    case, how = replace(CASE, damage={"wheel": [crack(4)]}), gf.Solve(phases=16)
    even, cycle = (gf.mesh_cycle(case, how, fine=fine) for fine in (False, True))
    assert_allclose(cycle.sampled(), even.sampled(), rtol=1e-9)
    added = np.setdiff1d(cycle.solved, even.solved)
    assert cycle.healthy.phase.size < 8 * 16 < added.size
    phase = np.sort(np.random.default_rng(1).permutation(added)[:200])
    want = gf.solve(case, replace(how, phases=phase, span="tooth")).k
    off, off_even = (np.abs(one.sampled("k", phase) - want) / np.ptp(want) for one in (cycle, even))
    assert off.max() < BENT * 2**HALVINGS < off_even.max() / 5
    assert np.median(off) < 1e-4


def test_teeth_that_all_differ_need_one_load_and_few_phases():
    """What cannot be held is refused with the reason."""
    flanks = {side: gf.Flank(eccentricity=0.01) for side in ("pinion", "wheel")}
    with pytest.raises(ValueError, match="fewer phases"):
        gf.mesh_cycle(replace(CASE, flanks=flanks), gf.Solve(phases=8192))
    with pytest.raises(ValueError, match="phases"):
        gf.mesh_cycle(CASE, gf.Solve(phases=np.arange(4) / 4))
