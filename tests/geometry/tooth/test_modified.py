"""Modified flanks: what they remove, and what is refused."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import RACK

import gearfe as gf
from gearfe.geometry.pair.flanks import flank_forms

GEAR = gf.Gear(z=21, r_bore=7.4, **RACK)
RING = gf.Gear(z=72, r_rim=90.0, rack_tip_radius=0.2, **RACK)


@pytest.mark.parametrize("gear", [GEAR, RING], ids=["gear", "ring"])
def test_reliefs_start_where_they_should_and_end_with_their_amount(gear):
    start = 0.6 * gear.roll_a + 0.4 * gear.roll_f
    ways = {"roll": start, "diameter": 2 * math.hypot(start, gear.r_b), "angle": start / gear.r_b}
    roll = np.linspace(gear.roll_f, gear.roll_a, 50)
    found = [
        gf.Flank(tip_relief=0.02, tip_exponent=2, **{f"tip_start_{how}": at}).on(gear).removed(roll) for how, at in ways.items()
    ]
    expected = 0.02 * np.clip((roll - start) / (gear.roll_a - start), 0, None) ** 2
    assert_allclose(found, [expected] * 3, atol=1e-15)
    low = gf.Flank(root_relief=0.01, root_start_roll=start).on(gear)
    assert_allclose(low.removed([gear.roll_f, start, gear.roll_a]), [0.01, 0, 0], atol=1e-15)


def test_crowning_slope_and_table_by_hand():
    roll = np.linspace(GEAR.roll_f, GEAR.roll_a, 21)
    part = np.linspace(0, 1, 21)
    assert_allclose(gf.Flank(profile_crowning=0.008).on(GEAR).removed(roll), 0.008 * (2 * part - 1) ** 2, atol=1e-16)
    assert_allclose(gf.Flank(profile_slope=-0.005).on(GEAR).removed(roll), -0.005 * part, atol=1e-16)
    measured = gf.Flank(table=(roll, 0.01 * part)).on(GEAR)
    assert_allclose(measured.removed(roll), 0.01 * part, atol=1e-16)


def test_derivatives_are_those_of_the_amount():
    form = gf.Flank(tip_relief=0.02, tip_start_diameter=43.0, tip_exponent=2.5, profile_crowning=0.01, profile_slope=0.003).on(
        GEAR
    )
    roll, h = np.linspace(GEAR.roll_f + 0.1, GEAR.roll_a - 0.1, 40), 1e-4
    first = (form.removed(roll + h) - form.removed(roll - h)) / (2 * h)
    assert_allclose(form.removed(roll, 1), first, atol=1e-8)
    ends = [form.removed(np.sqrt(roll**2 + 2 * GEAR.r_b * d)) for d in (-1e-3, 0, 1e-3)]  # places 1e-3 mm of arc apart
    assert_allclose(form.bend(roll), (ends[0] - 2 * ends[1] + ends[2]) / 1e-6, rtol=3e-4, atol=1e-6)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"tip_relief": 0.02}, "with no start: give one of tip_start_diameter, tip_start_roll, tip_start_angle"),
        ({"tip_relief": 0.02, "tip_start_roll": 9.0, "tip_start_angle": 0.4}, "with 2 of its starts"),
        ({"tip_start_roll": 9.0}, "tip_relief = 0 mm with 1 of its starts"),
        ({"tip_relief": 20.0, "tip_start_diameter": 44.0}, "tip_relief = 20.0 mm: the flank of z = 21 deviates by 20 mm"),
        ({"tip_relief": 0.02, "tip_start_diameter": 22.0}, "tip_start_diameter = 22 mm is not inside the flank of z = 21"),
        ({"root_relief": 0.02, "root_start_roll": 2.0, "root_exponent": 0.5}, "an exponent >= 1"),
        ({"table": ([5.0, 6.0], [0.0, 0.01])}, "does not cover the flank"),
        ({"table": ([5.0, 4.0], [0.0, 0.01])}, "the roll lengths rising"),
        ({"pitch": [0.001, 0.002]}, r"pitch = \(0\.001, 0\.002\): 2 values, but z = 21"),
        ({"pitch": [5.0] * 21}, "pitch: the flank of z = 21 deviates"),
    ],
)
def test_impossible_flanks_are_refused(given, text):
    with pytest.raises(ValueError, match=text):
        gf.Flank(**given).on(GEAR)


def test_flanks_are_given_by_gear():
    pair = gf.GearPair(GEAR, gf.Gear(z=31, r_bore=11.4, **RACK))
    assert flank_forms(pair, None) is None
    assert flank_forms(pair, {"pinion": gf.Flank()}) is None
    for given, text in (
        (gf.Flank(), "give flanks by gear"),
        ({"sun": gf.Flank()}, "flanks of 'sun'"),
        ({"wheel": 0.02}, "is no Flank"),
    ):
        with pytest.raises(ValueError, match=text):
            flank_forms(pair, given)


def test_scales_without_a_modification_are_refused():
    """Wear is not scaled: a scale of one tooth would not confine it to that tooth."""
    worn = gf.Flank(wear=([0.0, 20.0], [0.02, 0.02]), tooth_scale=[1.0] + [0.0] * 20)
    with pytest.raises(ValueError, match="does not scale wear"):
        worn.on(GEAR)
