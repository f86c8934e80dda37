"""Tips that cut into their mate's fillets, in three dimensions: a wide spur pair is that of the plane."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.contact.pieces import cut
from gearfe.geometry.pair.contacts import contacts
from validation.shared.solid_pair import solid_contact


def pair_of(width, degrees=0.0):
    """The wheel's tips cut into the pinion's fillets in the first seventh of a base pitch of the path, by up to 2.1 um."""
    rack, beta = {"m_n": 2.0, "alpha_n": math.radians(20), "b": width}, math.radians(degrees)
    first = gf.Gear(z=20, x=0.8, r_bore=8.0, beta=beta, **rack)
    return gf.GearPair(first, gf.Gear(z=55, x=0.32, r_bore=33.0, beta=-beta, **rack))


def test_the_tip_cuts_into_the_fillet_at_the_start_of_the_path():
    pair = pair_of(100.0)
    found = contacts(pair, np.arange(48) / 48)
    on = (found.gap < 0) & (found.nominal > pair.path[0])
    assert on.any()
    after, before = cut(pair)
    assert before == 0
    assert_allclose(after, (found.nominal[on] - pair.path[0]).max(), atol=pair.p_bt / 48)


@pytest.mark.parametrize("line_load", [pytest.param(10.0, marks=pytest.mark.slow), 600.0])
def test_a_wide_spur_pair_whose_tips_cut_into_fillets_is_that_of_the_plane(line_load):
    pair, phases = pair_of(100.0), np.arange(12) / 24
    plane = gf.mesh_stiffness(pair, 100.0 * line_load, STEEL, phases=phases, method="ritz")
    solid = solid_contact(pair, 100.0 * line_load, STEEL, phases, axial=0, step=2.0)
    print(np.round(100 * (solid.k / plane.k - 1), 2))
    assert solid.unloaded.min() < -2e-3
    assert_allclose(1e-3 * solid.unloaded, plane.unloaded, atol=1e-12)
    assert_allclose(solid.k, plane.k, rtol=5e-3)
    assert set(solid.fillet) >= {0, 1, 2, 3}, "the wheel's tip presses into the pinion's fillet"


@pytest.mark.slow
def test_the_curve_of_a_helical_pair_says_where_tips_press_into_fillets():
    run = {"phases": [0.05, 0.5], "refine": 0.6}
    curve = gf.mesh_stiffness(pair_of(8.0, 4.0), 800.0, STEEL, method="ritz3d", **run)
    spur = gf.mesh_stiffness(pair_of(8.0), 800.0, STEEL, method="ritz3d", **run)
    for one in (curve, spur):
        assert one.meta["tip_in_fillet_phases"] == [0.05]
        assert_allclose(one.k, one.meta["force_N"] / one.deflection, rtol=1e-12)
        assert one.unloaded[0] < -1e-6
        assert one.unloaded[1] == 0
    away = gf.mesh_stiffness(pair_of(8.0), 800.0, STEEL, method="ritz3d", phases=[0.5], refine=0.6)
    assert "tip_in_fillet_phases" not in away.meta
