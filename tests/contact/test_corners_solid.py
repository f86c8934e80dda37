"""Corners in three dimensions: undercut pinions, whose path starts at the edge of their own flank, and the lightest loads."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.contact import pieces as lines3d
from gearfe.contact.corner import CornerLaw
from gearfe.geometry.pair.contacts import touching
from validation.shared.solid_pair import solid_contact


def pair_of(z, width, degrees=0.0):
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": width}
    beta = math.radians(degrees)
    return gf.GearPair(gf.Gear(z=z, r_bore=3.0, beta=beta, **rack), gf.Gear(z=30, r_bore=12.0, beta=-beta, **rack))


@pytest.mark.parametrize(("z", "line_load"), [(9, 10.0), pytest.param(12, 800.0, marks=pytest.mark.slow)])
def test_wide_undercut_spur_pair_is_that_of_the_plane(z, line_load):
    pair, phases = pair_of(z, 100.0), np.append(np.arange(8) / 8, [-0.02, 0.02])
    assert pair.path[0] == pair.gear_1.roll_f, "else the pinion is not undercut"
    plane = gf.mesh_stiffness(pair, 100.0 * line_load, STEEL, phases=phases, method="ritz").k
    solid = solid_contact(pair, 100.0 * line_load, STEEL, phases, axial=0, step=2.0).k
    print(np.round(100 * (solid / plane - 1), 2))
    # polynomials over the flank know less of the sharp edge at the form point: 0.58 % there, up to 0.4 % elsewhere
    assert_allclose(solid, plane, rtol=7e-3)
    assert_allclose(solid[1:8], plane[1:8], rtol=5e-3)


def test_the_edge_that_undercut_leaves_touches_from_the_start_of_the_path_on():
    pair = pair_of(10, 20.0)
    away, gap = lines3d.gaps(pair)[0]
    assert away[0] < 1e-5 * pair.p_bt
    assert gap[0] < 1e-6
    assert (np.diff(gap) >= 0).all()
    found = touching(pair, pair.path[0] - away[:3])
    assert (found.corner == 3).all()
    assert_allclose(lines3d.beyond(pair, gap[2])[0], away[2], rtol=1e-9)


@pytest.mark.slow
def test_loads_lighter_than_resolved_see_the_same_wedge_from_nearer():
    """Beyond the path's end the law of a load, asked for far less, gives what the law of a sixteenth, with finer hats, has."""
    pair = pair_of(18, 10.0)
    away = np.array([0.01, 0.02, 0.04])
    run = np.ones(3, dtype=int), pair.path[1] + away, np.full(3, 0.0125)
    coarse, fine = (CornerLaw(pair, (STEEL, STEEL), load, (0.3, 0.3))(*run) for load in (100.0, 100.0 / 16))
    print(coarse, fine)
    assert_allclose(coarse, fine, rtol=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [0.0, 16.0])
def test_the_lightest_loads_follow_the_logarithm(degrees):
    """Contact softens by the logarithm of the load and by nothing else: 1 / k is nearly straight over ln F, down to 0.001 N/mm.

    A tip corner whose contact is narrower than the hats it is resolved by gave a law of its own there, and no number in the end.
    """
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 12.0}
    beta = math.radians(degrees)
    pair = gf.GearPair(gf.Gear(z=18, r_bore=9.0, beta=beta, **rack), gf.Gear(z=27, r_bore=12.0, beta=-beta, **rack))
    loads = 12.0 * 10.0 ** np.arange(-3, 2)
    compliance = np.array([1 / curve.k for curve in gf.mesh_stiffness(pair, loads, STEEL, method="ritz3d", phases=2, refine=0.6)])
    slope = np.diff(compliance, axis=0)
    assert (slope < 0).all()
    assert_allclose(slope[:-1], slope[1:], rtol=0.1)  # by decade; shares of the pairs change, and with them the slope
