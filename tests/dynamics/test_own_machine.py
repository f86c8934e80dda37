"""Machines of a user's own, from `gearfe` alone, and what no machine can have."""

import numpy as np
import pytest
from machines import stepped
from numpy.testing import assert_allclose

import gearfe as gf


def two_discs(load=10.0, **mesh):
    layout = gf.Layout([gf.Body("one", 1.0, 1e-3, "theta"), gf.Body("two", 2.0, 4e-3, "theta")])
    row = layout.mesh("one", "two", angle=0.0, alpha=0.35, radii=(0.04, 0.08))
    one = gf.GearMesh("mesh", row, 1e8, 200.0, **mesh)
    springs = layout.springs("two", None, {"theta": 1e4}, 0.02)
    stage = gf.Stage("pair", ("one",), ("two",), 200.0, 10.0)
    loads = (gf.Load("drive", layout.unit("one", "theta"), load),)
    return gf.Machine(layout.dofs, layout.mass, tuple(springs), (one,), loads, stages=(stage,))


def test_an_own_machine_rests_where_its_torques_balance():
    machine = two_discs()
    q = dict(zip(machine.dofs, machine.rest(), strict=True))
    assert_allclose(abs(q["two.theta"]), 10.0 * 2 / 1e4, rtol=1e-9)  # twice the torque at twice the radius
    assert_allclose(machine.G @ machine.rest() * 1e8, 10.0 / 0.04, rtol=1e-9)


@pytest.mark.parametrize(
    ("load", "told"),
    [
        (float("nan"), "load drive: value = nan, but it needs a number"),
        ((np.array([0.0, 1.0]), np.array([1.0, np.nan])), "not finite"),
        ((np.array([0.0, 2.0, 1.0]), np.ones(3)), "time 1 s follows 2 s"),
        ((np.array([0.0, 1.0]), np.ones(3)), "as many times as values"),
    ],
)
def test_loads_that_cannot_be_are_refused(load, told):
    with pytest.raises(ValueError, match=told):
        two_discs(load)


def test_a_function_that_gives_nan_is_refused_as_input():
    with pytest.raises(ValueError, match="its function gives a value that is not finite"):
        stepped(two_discs(lambda t: np.where(np.asarray(t) > 5e-4, np.nan, 10.0)), 1e-3, dt=1e-5)


def test_errors_that_are_no_numbers_are_refused():
    with pytest.raises(ValueError, match="mesh mesh: error"):
        two_discs(error=((float("nan"), 200.0, 0.0),))
