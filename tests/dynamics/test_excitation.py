"""Transmission errors in machines: tabulated, exact at the curve's load, counted once."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import PAIR_24_36 as PAIR
from usual import STEEL

import gearfe as gf

FORCE = 3000.0
FLANKS = {
    name: gf.Flank(tip_relief=0.015, tip_exponent=2, tip_start_roll=gear.roll_a - 5.0)
    for name, gear in (("pinion", PAIR.gear_1), ("wheel", PAIR.gear_2))
}


@pytest.fixture(scope="module")
def curve():
    return gf.mesh_stiffness(PAIR, FORCE, STEEL, method="ritz", flanks=FLANKS)


def machine(stiffness, phase=0.0, frequency=5.0):
    return gf.single_mesh(0.5, stiffness, frequency, force=FORCE, zeta=0.3, phase=phase)


@pytest.mark.parametrize("about", ["rest", "load"])
def test_a_slow_mesh_follows_the_transmission_error(curve, about):
    stiffness, error = gf.mesh_excitation(curve, about)
    run = gf.with_errors(machine(stiffness), profile={"mesh": error})
    options = {"rate": 320.0, "step": 4e-5, "error": False, "filtered": False}  # at the phases of the curve
    found, plain = (gf.simulate(one, 0.4, **options)["pair.x"][64:128] for one in (run, machine(stiffness)))
    assert np.ptp(curve.te) > 1e-6
    assert_allclose(found, curve.te, atol=0.02 * np.ptp(curve.te))
    assert np.abs(plain - curve.te).max() > 0.2 * np.ptp(curve.te)  # without it something is missing


def test_samples_are_met_whatever_the_phase_of_the_mesh_and_the_number_of_cycles():
    rng = np.random.default_rng(1)
    for cycles, first, phase, n in ((1, 0.0, 0.3, 16), (3, -1.0, 7.25, 45)):
        places = first + np.arange(n) * cycles / n
        values = 1e-6 * rng.standard_normal(n)
        made = gf.with_errors(machine(1e8, phase, 5.0), profile=gf.Samples(places, values)).meshes[0]
        times = (places + 4 * cycles - phase) / 5.0
        assert_allclose(made.e(times)[0], values, atol=1e-17)
    made = gf.with_errors(machine(1e8, 0.25, 5.0), profile=values[:8]).meshes[0]
    assert_allclose(made.e((np.arange(8) / 8 - 0.25) / 5.0)[0], values[:8], atol=1e-17)


@pytest.mark.parametrize(
    ("profile", "message"),
    [
        ({"mush": 1e-6}, "no mesh 'mush'; there are mesh"),
        ([[1e-6, 2e-6]], "give a row of finite numbers"),
        ([1e-6, float("nan")], "give a row of finite numbers"),
        (gf.Samples(np.linspace(0, 1, 9), np.zeros(9)), "the last one a step before the end"),
        ("flat", "give an amplitude"),
        (["a", "b"], "needs numbers"),
    ],
)
def test_errors_that_are_none_are_refused(profile, message):
    with pytest.raises(ValueError, match=message):
        gf.with_errors(machine(1e8), profile=profile)


def test_about_what_is_said(curve):
    with pytest.raises(ValueError, match="must be one of rest, load"):
        gf.mesh_excitation(curve, "both")
