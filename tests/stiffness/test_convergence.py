"""`gf.convergence`: the estimate next to the true difference."""

import math

import numpy as np
import pytest
from usual import PAIR

import gearfe as gf


@pytest.mark.slow
@pytest.mark.parametrize(("method", "orders", "solves"), [("ritz", (3, 4), 4), ("fe", None, 2)])
def test_estimates_cover_the_difference_from_the_finest(method, orders, solves, tmp_path):
    case = gf.Case(PAIR, force=2000.0, material=gf.Material())
    found = gf.convergence(case, gf.Solve(method=method, phases=4), refines=(0.7, 1.0), orders=orders)
    assert found.k.shape == found.error.shape == (solves, 4)
    assert (found.difference <= found.error).all()
    assert (found.difference[-1] == 0).all()
    alone = gf.solve(case, gf.Solve(method=method, phases=4, refine=0.7, order=orders and orders[0]))
    np.testing.assert_allclose(found.k[0], alone.k, rtol=1e-9)
    mean, said, away = (float(cell) for cell in found.table.rows[0][3:6])
    np.testing.assert_allclose(mean, 1e-6 * alone.k.mean(), rtol=1e-9)
    assert away <= said
    found.plot(tmp_path / "errors.png")
    assert (tmp_path / "errors.png").stat().st_size > 1000


def test_closed_forms_and_several_loads_are_refused():
    with pytest.raises(ValueError, match="converged method"):
        gf.convergence(gf.Case(PAIR, force=2000.0, material=gf.Material()), gf.Solve(method="coupled"))
    with pytest.raises(ValueError, match="one load"):
        gf.convergence(gf.Case(PAIR, force=[1000.0, 2000.0], material=gf.Material()), gf.Solve(method="ritz"))


def test_a_record_has_a_resolution_for_each_solve():
    """The border took `refine` of every public record for one number once the record's name had been read."""
    made = gf.Convergence("ritz", (0.7, 1.0), (3, 3), np.ones((2, 4)), np.zeros((2, 4)), (0.1, 0.2))
    assert made.refine == (0.7, 1.0)
    with pytest.raises(ValueError, match="refine"):
        gf.mesh_stiffness(PAIR, 2000.0, gf.Material(), refine=math.nan)
