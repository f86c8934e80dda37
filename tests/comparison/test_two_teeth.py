"""Two cracked teeth of a gear: each is named, with what it takes."""

import math
from dataclasses import replace

import pytest
from numpy.testing import assert_allclose
from usual import PAIR_17_38 as PAIR

import gearfe as gf

pytestmark = pytest.mark.quick
CRACKS = [gf.Crack(length=length, angle=math.radians(60), tooth=tooth) for length, tooth in ((2.0, 0), (3.0, 5))]


def test_each_tooth_takes_what_it_takes_alone():
    case = gf.Case(PAIR, 1669.3, gf.Material(E=206e3, nu=0.3), damage={"pinion": CRACKS})
    how = gf.Solve("ritz", 16, "tooth")
    both = gf.solve(case, how)
    for crack in CRACKS:
        alone = gf.solve(replace(case, damage={"pinion": [crack]}), how)
        at = [abs(both.phase - phase).argmin() for phase in alone.phase]
        assert_allclose(both.k[at], alone.k, rtol=1e-3)
    said = gf.compare(case, phases=32, refine=0.5).headline
    assert "tooth 0 of the pinion: 2 mm crack at 60 degrees: the mesh is 15" in said
    assert "tooth 5 of the pinion: 3 mm crack at 60 degrees: the mesh is 26" in said
