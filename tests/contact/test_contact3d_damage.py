"""Pairs of finite width with pits and cracks."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_contact3d import STEEL
from usual import pair_18_27 as pair_of

import gearfe as gf
from validation.shared.solid_pair import solid_contact


@pytest.mark.slow
def test_moving_pits_by_parts_of_a_cell():
    """A row on a spur gear's line; on a helical gear, where moving means another phase, the drop by cell size."""
    run = {"order": 2, "axial": 8, "phases": np.array([0.7])}
    pair, drops = pair_of(30.0, 0.0), []
    healthy = solid_contact(pair, 3800.0, STEEL, face="spur", **run).k[0]
    radius = math.hypot(pair.gear_1.r_b, pair.path[0] + 0.7 * pair.p_bt)
    for shift in (0.0, 0.1, 0.2, 0.3):
        pits = [gf.Pit(radius=radius, z=z + shift, axes=(1.0, 1.0), depth=0.1) for z in np.linspace(2.0, 27.7, 7)]
        drops.append(1 - solid_contact(pair, 3800.0, STEEL, face="spur", pits=(pits, ()), **run).k[0] / healthy)
    assert min(drops) > 0.03
    assert np.ptp(drops) < 0.02 * np.mean(drops)
    pair, drops = pair_of(30.0), []
    run["phases"] = np.array([1.1])
    pits = [gf.Pit(radius=18.2, z=z, axes=(1.0, 1.0), depth=0.1) for z in np.linspace(2.0, 27.7, 7)]
    for step in (0.4, 0.1):
        healthy, pitted = (solid_contact(pair, 3800.0, STEEL, pits=(own, ()), step=step, **run).k[0] for own in ((), pits))
        drops.append(1 - pitted / healthy)
    assert drops[0] > 0.02
    assert abs(drops[0] - drops[1]) < 0.02 * drops[1]


@pytest.mark.slow
@pytest.mark.parametrize("side", ["loaded", "unloaded"])
def test_faces_of_cracks_are_kept_apart_as_in_the_plane(side):
    """On a wide spur pair: the same phases as in the plane, and the same k within what wide spur pairs differ without cracks."""
    pair, phases = pair_of(200.0, 0.0), np.array([-0.2, 0.1, 0.9, 1.7])
    crack = gf.Crack(level=0.3, side=side)
    plane = gf.mesh_stiffness(pair, 3e4, STEEL, phases=phases, method="ritz", damage={"pinion": [crack]})
    solid = solid_contact(pair, 3e4, STEEL, phases, face="spur", axial=0, step=10.0, cracks=((crack,), ()))
    assert_allclose(solid.k, plane.k, rtol=4e-3)
    assert phases[list(solid.closed)].tolist() == plane.meta["crack_closed_phases"]
    healthy = solid_contact(pair, 3e4, STEEL, phases, face="spur", axial=0, step=10.0)
    assert (solid.k < 0.85 * healthy.k).any() == (side == "loaded")


@pytest.mark.slow
def test_crack_in_one_half_of_a_herringbone_pair():
    """Each half bears its share at one approach: k is the sum of a healthy and a cracked half's at their own loads."""
    pair, run = pair_of(24.0), {"order": 2, "axial": 6, "face": "herringbone", "phases": np.array([0.9])}
    crack = gf.Crack(level=0.5)
    cases = [(), (replace(crack, width=(0.0, 12.0)),), (replace(crack, width=(12.0, 24.0)),), (crack,)]
    healthy, first, second, both = (solid_contact(pair, 3000.0, STEEL, cracks=(own, ()), **run).k[0] for own in cases)
    assert_allclose(first, second, rtol=1e-9)
    assert both < 0.97 * first < 0.97 * 0.97 * healthy
    assert_allclose(first, (healthy + both) / 2, rtol=5e-3)
    part = solid_contact(pair, 3000.0, STEEL, cracks=((replace(crack, width=(0.0, 6.0)),), ()), **run).k[0]
    assert first < part < healthy
