"""What a notebook shows of objects, and tables of a curve."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import gearfe as gf
from gearfe.figures.stiffness_plots import closed
from gearfe.geometry.tooth.drawing import outline_points


@pytest.fixture(scope="module")
def curve(pair):
    return gf.mesh_stiffness(pair, 2000.0, gf.Material(E=207e3, nu=0.25), phases=8, error=True)


def test_gears_and_pairs_can_be_made_again_from_what_they_show(pair):
    shown = eval(repr(pair), {"Gear": gf.Gear, "GearPair": gf.GearPair})
    assert shown == pair
    assert "addendum" not in repr(pair)
    assert "addendum=0.9" in repr(replace(pair.gear_1, addendum=0.9)), "gears that differ show it: stored results are named by it"


def test_drawing_is_the_gear(pair):
    x, y = outline_points(pair.gear_1)
    radius = np.hypot(x, y)
    assert radius.max() == pytest.approx(pair.gear_1.r_a)
    assert radius.min() == pytest.approx(pair.gear_1.r_f)
    assert (np.diff(np.unwrap(np.arctan2(x, y))) > -0.02).all(), "around once"


def test_curve_shows_its_range(curve):
    assert f"{curve.k.min() / 1e6:.4g} to {curve.k.max() / 1e6:.4g} N/um" in repr(curve)
    assert "2000 N on 20 mm" in repr(curve)


def test_tables_hold_the_numbers(curve):
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    table, arrays = curve.to_pandas(), curve.to_xarray()
    assert_array_equal(table["k [N/m]"], curve.k)
    assert_array_equal(table.index, curve.phase)
    assert_array_equal(table["error [N/m]"], curve.error)
    assert_array_equal(arrays["force"].sel(order=0), curve.force[:, curve.order == 0][:, 0])
    assert arrays["k"].attrs == {"units": "N/m"}
    assert arrays.attrs["method"] == "ritz"


def test_jumps_are_drawn_where_pairs_enter_and_leave(pair):
    made = gf.mesh_stiffness(pair, 2000.0, gf.Material(E=207e3, nu=0.25), method="textbook", phases=16)
    phase, k = closed(made)
    steep = np.unique(phase[1:][np.diff(phase) == 0])
    np.testing.assert_allclose(steep, [pair.eps_alpha - 1, 1.0])
    assert np.abs(np.diff(k)[np.diff(phase) > 0]).max() < 0.1 * np.abs(np.diff(k)).max(), "no slope stands for a jump"


def test_machine_and_response_show_what_they_are():
    machine = gf.single_mesh(1.0, 1e8, 500.0)
    assert f"{len(machine.dofs)} degrees of freedom" in repr(machine)
    response = gf.simulate(machine, 0.01)
    assert f"{len(response.time)} samples" in repr(response)
