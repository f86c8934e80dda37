import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sets import gears

from gearfe.geometry.tooth.profile import cartesian, flank, flank_normal
from gearfe.planetary_sets.standing import _turn_1, _turn_2, assembled, directions, standing

ANGLES = 2 * math.pi / 105 * np.array([0, 35, 70, 18])


def placed(gear, centre, angle, tooth, roll, side=1):
    """A place of a flank (side 1 right, -1 left) and its normal in the frame of the set, with tooth 0 turned by `angle`."""
    radius, away = flank(gear, roll)
    turn = angle + 2 * math.pi * tooth / gear.z
    x, y = flank_normal(gear, roll)
    normal = np.array([side * x, y])
    cos, sin = math.cos(turn), math.sin(turn)
    turned = np.array([cos * normal[0] + sin * normal[1], cos * normal[1] - sin * normal[0]])
    return centre + cartesian(radius, turn + side * away), turned


@pytest.mark.parametrize("position", [0.0, 0.37, 12.9])
@pytest.mark.quick
def test_flanks_touch_where_the_numbers_say(position):
    """Sun, planets and ring, each turned rigidly by one angle, touch with the teeth and at the places that `standing` names."""
    set_ = gears(1)
    one, two = set_.sun_planet, set_.planet_ring
    stand = standing(set_, ANGLES, [position])
    outer, inner = directions(set_, ANGLES)
    sun = ANGLES[0] + _turn_1(one, one.path[0] + stand.outer[0, 0] * one.p_bt)
    rings = []
    for i, angle in enumerate(ANGLES):
        centre = set_.a * np.array([math.sin(angle), math.cos(angle)])
        planet = angle + _turn_2(one, one.path[0] + (stand.outer[0, i] + stand.planet[i]) * one.p_bt)
        ring = angle - _turn_2(two, two.path[0] + stand.inner[0, i] * two.p_bt) - 2 * math.pi / 84 * stand.ring[i]
        rings.append(ring)
        for pair, phase, force in ((one, stand.outer[0, i], outer[:, i]), (two, stand.inner[0, i], inner[:, i])):
            whole = math.floor(phase)
            nominal = pair.path[0] + (phase - whole) * pair.p_bt
            j, mate = -whole, float(pair.mate_roll(nominal))
            if pair is one:
                first = placed(set_.sun, 0 * centre, sun, j, nominal)
                second = placed(set_.planet, centre, planet, stand.planet[i] - j, mate)
            else:
                first = placed(set_.planet, centre, planet, -j, nominal, side=-1)
                second = placed(two.gear_2, 0 * centre, ring, stand.ring[i] - j, mate)
            assert_allclose(first[0], second[0], atol=1e-8)
            assert_allclose(first[1], -second[1], atol=1e-9)
            on_planet = first[1] if pair is one else second[1]
            assert_allclose(on_planet, force, atol=1e-9)
    assert_allclose(np.cos(84 * (np.array(rings) - rings[0])), 1.0, atol=1e-12)
    assert stand.planet[0] == 0


def test_planets_that_do_not_fit_are_refused():
    with pytest.raises(ValueError, match=r"nearest: 0, 89\.1429, 178\.286, 270\.857"):
        assembled(gears(1), [k * math.pi / 2 for k in range(4)])
    with pytest.raises(ValueError, match="touch each other"):
        assembled(gears(1), 2 * math.pi / 105 * np.array([0, 5]))
    with pytest.raises(ValueError, match="finite angle"):
        assembled(gears(1), [math.nan])
