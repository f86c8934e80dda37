import numpy as np
import pytest
from numpy.testing import assert_allclose
from sets import STEEL, gears

from gearfe.flexibility.energy.ritz.plane import flexibility
from gearfe.geometry.tooth.profile import arc_at
from gearfe.planetary_sets.whole_gear import PLACES, carry, motion, whole_gear


def three():
    set_ = gears()
    return set_.sun, set_.planet, set_.planet_ring.gear_2


@pytest.mark.parametrize("gear", three(), ids=["sun", "planet", "ring"])
def test_other_teeth_yield_as_in_the_energy_model(gear):
    """Its sectors are joined otherwise, its elements are of order 4; what both share is the profile."""
    table, far = whole_gear(gear, STEEL).held(), flexibility(gear, STEEL, neighbours=6).far
    roll = gear.roll_f + (gear.roll_a - gear.roll_f) * np.linspace(0.1, 0.8, 5)
    rows, arc = carry(gear, roll), arc_at(gear, roll)
    for teeth in (1, 2, 3, 6):
        want = far[0, teeth](arc, arc).T
        assert_allclose(rows @ table[teeth, :PLACES, :PLACES] @ rows.T, want, atol=6e-4 * abs(far[0, 1](arc, arc)).max())


@pytest.mark.parametrize("gear", three(), ids=["sun", "planet", "ring"])
def test_work_is_mutual_and_flanks_are_mirrored(gear):
    table = whole_gear(gear, STEEL).held()
    back = table[-np.arange(gear.z) % gear.z]
    assert_allclose(table, back.transpose(0, 2, 1), atol=1e-12 * abs(table).max())
    left, right = table[:, PLACES:, PLACES:], table[:, :PLACES, :PLACES]
    away = [2, 5, gear.z // 2]  # the triangles of a sector are not quite mirrored
    assert_allclose(left[away], right[-np.array(away)], atol=2e-4 * abs(right[away]).max())


def test_loads_turn_the_gear_by_its_base_radius():
    for gear in three():
        turn = motion(gear)[2]
        assert_allclose(turn, np.repeat([-gear.r_b, gear.r_b], PLACES), rtol=1e-12)


def test_a_free_ring_is_the_limit_of_a_soft_bed():
    """Under loads in balance, on both flanks of three teeth; a stiff bed is the held rim."""
    ring = three()[2]
    whole, teeth = whole_gear(ring, STEEL), (0, 28, 56)
    load = np.zeros(2 * PLACES)
    load[[3, PLACES + 3]] = 1.0

    def work(table):
        return sum(load @ table[(i - j) % ring.z] @ load for i in teeth for j in teeth)

    free, held = work(whole.between(whole.loose_inverse()) - whole.held()), work(whole.held())
    for k in (1e-2, 1e-3):
        assert_allclose(work(whole.between(whole.bedded_inverse(np.full(2, k))) - whole.held()), free, rtol=0.2 * k)
    assert abs(work(whole.between(whole.bedded_inverse(np.full(2, 1e12))) - whole.held())) < 1e-6 * held
    assert free > held
