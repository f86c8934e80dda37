"""What a force law says of its own error, against contacts solved between its loads and phases."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import PAIR

import gearfe as gf

STEEL = gf.Material(E=207e3, nu=0.25)


def true(law, loads, phases):
    """Error over the force at loads and phases solved anew."""
    curves = gf.mesh_stiffness(PAIR, list(loads), STEEL, phases=list(phases))
    return np.array([np.abs(law(one.deflection, one.phase) / load - 1) for one, load in zip(curves, loads, strict=True)])


@pytest.mark.parametrize(("ratio", "phases"), [(2.0, 32), (2.0**0.5, 64)])
def test_it_covers_what_is_solved_between(ratio, phases):
    loads = 100.0 * ratio ** np.arange(6)
    law = gf.force_law(PAIR, loads, STEEL, phases=phases)
    found = gf.law_error(law)
    between = true(law, np.sqrt(loads[:-1] * loads[1:]), law.phase)
    across = true(law, loads[::2], np.sort(np.random.default_rng(0).random(100)))
    for own, rms, most in ((between, found.loads_rms, found.loads), (across, found.phases_rms, found.phases)):
        assert 0.05 * rms < np.sqrt((own**2).mean()) < rms
        assert own.max() < 1.5 * most


def test_two_loads_tell_nothing():
    with pytest.raises(ValueError, match="three loads and four phases"):
        gf.law_error(gf.force_law(PAIR, [100.0, 200.0], STEEL, phases=8))


def test_a_law_takes_the_loads_and_phases_that_it_needs():
    rough, fine = (gf.converged_force_law(PAIR, 100.0, 3200.0, STEEL, force=800.0, error=one) for one in (1e-2, 4e-3))
    assert rough.load.size < fine.load.size or rough.phase.size < fine.phase.size
    assert (fine.load[0], fine.force) == (100.0, 800.0)
    assert_allclose(fine.load[-1], 3200.0)
    for law, wanted in ((rough, 1e-2), (fine, 4e-3)):
        own = true(law, [130.0, 470.0, 1300.0, 2900.0], np.sort(np.random.default_rng(1).random(150)))
        assert np.sqrt((own**2).mean()) < wanted


def test_no_law_is_within_nothing():
    for given in ((0.0, 100.0), (200.0, 100.0)):
        with pytest.raises(ValueError, match="0 < smallest < largest"):
            gf.converged_force_law(PAIR, *given, STEEL)
    with pytest.raises(ValueError, match="leave out phases"):
        gf.converged_force_law(PAIR, 100.0, 200.0, STEEL, phases=64)
