"""Division by a triangular factor, against scipy's."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import solve_triangular

from gearfe.flexibility.triangular import BLOCK, divide


@pytest.mark.parametrize("n", [1, BLOCK, BLOCK + 1, 5 * BLOCK - 3])
@pytest.mark.parametrize("rows", [1, 7])
def test_division_in_place_is_that_of_scipy(n, rows):
    rng = np.random.default_rng(n)
    root = rng.normal(size=(n, n))
    lower = np.linalg.cholesky(root @ root.T + n * np.eye(n))
    memory = np.full(rows * n + 5, 3.0)  # part of a larger piece, as in the elimination
    across = memory[: rows * n].reshape((rows, n), order="F")
    across[:] = rng.normal(size=(rows, n))
    want = solve_triangular(lower, across.T, lower=True).T
    divide(across, np.asfortranarray(lower + np.triu(rng.normal(size=(n, n)), 1)))
    assert_allclose(across, want, rtol=1e-12, atol=1e-13)
    assert_allclose(memory[rows * n :], 3.0, err_msg="what stands beside it is left alone")
