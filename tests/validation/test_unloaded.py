"""Gaps without load and tip edges beside whole outlines: recomputed for a few pairs, so that the page's table can fail."""

import csv
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.geometry.tooth.profile import cartesian, flank
from validation.shared.arbiter.cases import random_pair
from validation.shared.arbiter.outline import Outline
from validation.shared.arbiter.unloaded import unloaded
from validation.shared.arbiter.unloaded_table import LIMIT, TABLE, one_pair

RACK = {"m_n": 2.5, "alpha_n": math.radians(20), "b": 1.0}


@pytest.mark.parametrize("edge", [{"tip_rounding": 0.25}, {"tip_chamfer": 0.1}], ids=["rounding", "chamfer"])
@pytest.mark.parametrize(
    "held", [{"z": 24, "r_bore": 18.0}, {"z": 17, "r_bore": 8.0}, {"z": 60, "r_rim": 95.0, "tip_radius": 0.2}]
)
def test_tip_edges_are_those_of_whole_outlines(held, edge):
    gear = gf.Gear(**held, **RACK)
    form, other = gf.Flank(**edge).on(gear), Outline(gear, gf.Flank(**edge))._edge
    roll = form.edge.start + (gear.roll_a - form.edge.start) * np.linspace(0, 1, 40)
    radius, angle = flank(gear, roll)
    points = cartesian(radius, angle - form.removed(roll) / gear.r_b)
    if "tip_rounding" in edge:
        apart = np.hypot(*(points - other.centre[:, None])) - other.size
    else:
        arm = points - other.first[:, None]
        apart = arm[0] * other.along[1] - arm[1] * other.along[0]
    assert_allclose(1e3 * apart, 0.0, atol=4e-6)  # um; the other's normals are central differences
    assert_allclose(math.hypot(form.edge.start, gear.r_b), other.start, rtol=1e-9)


@pytest.mark.parametrize("seed", [260000, 260005, 260062, 260281, 260556])
def test_gaps_are_those_of_whole_outlines(seed):
    """The last three were refused as conforming, at the very start of a chamfer, or stand on edges that a spline missed."""
    row = one_pair(list(unloaded([seed])))
    assert not row["refused"]
    assert row["rows"] > 20
    assert float(row["largest_difference_um"]) < 1e-3


def test_the_table_is_of_the_pairs_that_seeds_draw():
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 1000
    pair, _ = random_pair(int(rows[5]["seed"]))
    assert rows[5]["pair"].split()[0] == f"{pair.gear_1.z}/{pair.gear_2.z}"
    assert max(float(row["largest_difference_um"]) for row in rows if not row["refused"]) < LIMIT
