"""The error estimate covers the true error, and random gears and cracks behave."""

import math
from dataclasses import replace

import numpy as np
import pytest

import gearfe as gf
from gearfe.stiffness.estimate import estimate


def test_the_estimate_by_hand():
    """The coarser solve differs at a fixed phase alone, a sixteenth of a pitch before phase 0, over the cycle's end.

    Of finite elements, with edges twice as long and order 2, the difference is three times the error, and the safety is 3. The
    largest and the mean over a base pitch are added; of the energy model that mean is the least. Finer hats add twice their
    difference at the phase.
    """
    phase, k, coarse, hats = np.array([0.0, 0.5]), *np.zeros((3, 2 + 16))
    coarse[-1], hats[1], hats[-1] = 3.0, 1.0, 1.0
    found = estimate(phase, True, k, coarse, hats, energy=False)
    np.testing.assert_allclose(found, [3.0 + 3.0 / 16, 3.0 + 3.0 / 16 + 2.0], rtol=1e-12)
    larger = 3 * 3.0 / (0.7**-4 - 1)
    found = estimate(phase, True, k, coarse, hats, energy=True)
    np.testing.assert_allclose(found, [larger, larger / 16 + 2.0], rtol=1e-12)


@pytest.mark.parametrize("damage", [None, {"pinion": [gf.Crack(level=0.4)]}])
def test_the_estimate_of_a_phase_is_the_same_in_any_company(damage):
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    run = {"method": "ritz", "damage": damage, "error": True}
    alone, few, many = (
        gf.mesh_stiffness(pair, 3000.0, gf.Material(), phases=p, **run) for p in ([0.3], [0.9, 0.3, 0.1], np.arange(-20, 90) / 50)
    )
    assert few.error[1] == pytest.approx(alone.error[0], rel=1e-6)
    assert many.error[35] == pytest.approx(alone.error[0], rel=1e-6)
    assert alone.error[0] > 0


def test_a_crack_that_closes_leaves_contacts_where_they_are():
    """Contacts slide to where a pair yields less, which with its crack open would be far away: a closed one costs ever more k."""
    rack = {"m_n": 1.0, "alpha_n": math.radians(20), "beta": math.radians(15), "b": 10.0, "rack_tip_radius": 0.1}
    pair = gf.GearPair(gf.Gear(z=45, x=0.195577, r_bore=15.3976, **rack), gf.Gear(z=78, r_bore=12.9692, **rack))
    crack, force = gf.Crack(level=0.7, angle=1.0627, start="middle", turning=True, side="unloaded"), 143.18
    run = {"phases": np.array([0.9375]), "span": "tooth", "cache": False, "method": "ritz"}
    found = [
        gf.mesh_stiffness(pair, force, gf.Material(), damage={"wheel": [replace(crack, level=level)]}, **run)
        for level in (0.7, 0.8, 0.86, 0.9)
    ]
    k = np.array([one.k[0] for one in found])
    assert all(one.meta["crack_closed_phases"] for one in found)
    assert (np.diff(k) < -4e-3 * k[0]).all()
