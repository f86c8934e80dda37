"""Teeth that modified flanks leave thinner, against whole bodies meshed with those flanks."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import RACK, STEEL

import gearfe as gf
from gearfe.contact.thinned import Thinning
from validation.shared.arbiter.pressing import pressed

PHASES = np.array([0.8, 0.9])  # a single pair
# deflection [um] under 200 N/mm at these phases by finite elements of whole bodies between whole outlines
KNOWN = {(0.08, False): (15.7753, 16.1072), (0.08, True): (15.8820, 16.1999), (0.03, True): (15.7627, 15.9914)}


def relieved(gear, amount, both):
    middle = (gear.roll_a + gear.roll_f) / 2
    return gf.Flank(root_relief=amount, root_start_roll=middle, both_sides=both)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["ritz", "fe"])
@pytest.mark.parametrize(("amount", "both"), list(KNOWN))
def test_root_relief_bends_more(pair, amount, both, method):
    """Without the thinner tooth both flanks of 80 um are 1.2 % too stiff, the loaded one 0.5 %."""
    flanks = {"wheel": relieved(pair.gear_2, amount, both)}
    curve = gf.mesh_stiffness(pair, 4000.0, STEEL, method=method, phases=PHASES, flanks=flanks, error=True)
    deflection, known = 4000.0 / curve.k * 1e6, np.array(KNOWN[amount, both])
    assert_allclose(deflection, known, rtol=2e-3)
    assert (np.abs(deflection - known) < curve.error / curve.k * known).all()


@pytest.mark.slow
def test_what_is_known_is_that_of_whole_bodies(pair):
    answer = pressed(pair, (None, relieved(pair.gear_2, 0.08, True)), 200.0, PHASES, (207e3, 0.3))
    assert_allclose(1e3 * (answer.approach - answer.least), KNOWN[0.08, True], rtol=1e-4)


@pytest.mark.parametrize("ring", [False, True])
def test_added_flexibility_is_symmetric_and_grows_with_what_is_removed(ring):
    held = (
        {"z": 84, "r_rim": 95.0, "x": -0.4617, "addendum": 0.859, "rack_tip_radius": 0.2} if ring else {"z": 31, "r_bore": 11.4}
    )
    gear = gf.Gear(**held, **RACK)
    roll = np.linspace(gear.roll_f, gear.roll_a, 7)
    once, both = (Thinning(relieved(gear, 0.03, way).on(gear), STEEL, "plane strain").between(roll, 0) for way in (False, True))
    assert_allclose(once, once.T, rtol=1e-12)
    assert np.linalg.eigvalsh(once).min() > -1e-9 * once.max()
    assert_allclose(np.diag(both), 2 * np.diag(once), rtol=0.05)
    assert (np.diff(np.diag(once)) > 0).all()
    assert_allclose(
        np.diag(once), Thinning(relieved(gear, 0.03, False).on(gear), STEEL, "plane strain").alone(roll[:, None], [0])[:, 0]
    )


@pytest.mark.slow
def test_three_dimensions_tell_what_they_leave_out(pair):
    """`ritz3d` solves full teeth: its estimate holds the whole difference of the section."""
    flanks = {"wheel": relieved(pair.gear_2, 0.08, True)}
    thick, plane = (
        gf.mesh_stiffness(pair, 4000.0, STEEL, method=method, phases=[0.8], flanks=flanks, error=True)
        for method in ("ritz3d", "ritz")
    )
    assert abs(thick.k[0] / plane.k[0] - 1) < thick.error[0] / thick.k[0] + 0.05  # plane strain is not its limit at b / m of 10
    assert thick.error[0] / thick.k[0] > 0.009
