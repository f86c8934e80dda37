"""Chips in three dimensions beside CalculiX in nonlinear contact: its runs on file (`tests.chips_three`)."""

from dataclasses import replace

import numpy as np
import pytest

import gearfe as gf
from tests.chips_three import PAIR, STEEL, TABLE, cases, ours
from validation.shared.kept_rows import stored

COARSE = pytest.mark.xfail(
    strict=True,
    reason="0.65 and 0.78 % where a corner carries: beyond the estimate. A finer mesh (47018 nodes) gives 0.55 % for the rounded "
    "chip, and its forces on the two gears differ by 0.16 %. With a plane chip the same mesh differs by 0.67 %. Outlines of the "
    "section agree within 0.04 %, and a slice 2 mm wide within 0.03 % (last test). The deck of the rounded chip has two layers "
    "of elements over its 15 mm. Four layers (58140 nodes) leave 0.60 %. Without lateral contraction, a slice 2 mm wide with one "
    "layer (21922 nodes) differs by 0.96 %. Layers and width are therefore not the cause. "
    "The contact zones have 0.75 element edges per Hertzian half-width",
)


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(name, marks=COARSE if "corner in contact" in name else ()) for name in cases()])
def test_rounded_chips_and_those_of_a_part_of_the_width(name):
    """The mesh of CalculiX has the chip itself, and `ritz3d` adds the effect of its material at the contact."""
    found, row = ours(name), stored(TABLE)[name]
    apart = float(found.k[0]) / 1e6 / row["theirs"] - 1
    print(f"{apart:+.2%}, estimate {float(found.error[0] / found.k[0]):.2%}")
    assert abs(apart) < 2e-3


@pytest.mark.slow
def test_the_corner_of_a_rounded_chip_in_a_narrow_slice():
    """CalculiX on 2 mm of the width gives 222.67 N at 9.1778 um.

    The deck is that of `gf.write_contact_inp` with face spur, refine 0.5 and layers 2 (21360 nodes). The
    edges in the section are those of the wide deck, and the corner carries 8 % of the load.
    """
    pair = gf.GearPair(*(replace(gear, b=2.0) for gear in (PAIR.gear_1, PAIR.gear_2)))
    case = gf.Case(pair, 222.667, STEEL, damage={"pinion": [gf.Chip(depth=1.0, radius=2.0)]})
    found = gf.solve(case, gf.Solve("ritz3d", np.array([1.45])))
    assert found.force[0, found.order.tolist().index(0)] > 0.05 * 222.667
    assert abs(float(found.k[0]) / (222.667 / 9.1778e-6) - 1) < 1e-3
