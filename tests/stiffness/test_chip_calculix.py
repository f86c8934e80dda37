"""Chips in three dimensions beside CalculiX in nonlinear contact: its runs on file (`tests.chips_three`)."""

import pytest

from tests.chips_three import TABLE, cases, ours
from validation.shared.kept_rows import stored

COARSE = pytest.mark.xfail(
    strict=True,
    reason="0.65 and 0.78 % where a corner carries: beyond the estimate. A finer mesh (47018 nodes) gives 0.55 % for the rounded "
    "chip, and its forces on the two gears differ by 0.16 %. With a plane chip the same mesh differs by 0.67 %. Outlines of the "
    "section agree within 0.04 %",
)


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(name, marks=COARSE if "corner in contact" in name else ()) for name in cases()])
def test_rounded_chips_and_those_of_a_part_of_the_width(name):
    """The mesh of CalculiX has the chip itself, and `ritz3d` adds the effect of its material at the contact."""
    found, row = ours(name), stored(TABLE)[name]
    apart = float(found.k[0]) / 1e6 / row["theirs"] - 1
    print(f"{apart:+.2%}, estimate {float(found.error[0] / found.k[0]):.2%}")
    assert abs(apart) < 2e-3
