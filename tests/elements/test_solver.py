"""The solver ladder: every installed solver agrees, and what cannot be is refused beforehand."""

import gc
import sys
from types import ModuleType

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.sparse import csc_array, diags, eye, kron, tril

from gearfe.elements import solver

LINE = diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(12, 12))
GRID = (kron(kron(LINE, eye(12)), eye(12)) + kron(kron(eye(12), LINE), eye(12)) + kron(eye(144), LINE)).tocsc()


@pytest.mark.parametrize("name", solver.available())
def test_solvers_agree_with_the_known_solution(name):
    want = np.random.default_rng(0).normal(size=(GRID.shape[0], 3))
    for matrix in (GRID, tril(GRID)):
        solve = solver.factor(matrix, solver.plan(GRID.shape[0], solver=name))
        assert_allclose(solve(GRID @ want), want, rtol=1e-10, atol=1e-11, err_msg="only the lower triangle is read")
        assert_allclose(solve.gram(GRID @ want), want.T @ GRID @ want, rtol=1e-10, atol=1e-8)
        assert_allclose(solve(GRID @ want[:, 0]), want[:, 0], rtol=1e-10, atol=1e-11)


@pytest.mark.parametrize("name", solver.available())
def test_the_factor_lives_as_long_as_it_is_used(name):
    gram = solver.factor(GRID, solver.plan(GRID.shape[0], solver=name)).gram
    gc.collect()
    want = np.ones((GRID.shape[0], 2))
    assert_allclose(gram(GRID @ want), want.T @ GRID @ want, rtol=1e-10)


@pytest.mark.parametrize("name", solver.available())
def test_indefinite_matrices_are_refused(name):
    with pytest.raises(RuntimeError, match="not held"):
        solver.factor(GRID - 2 * eye(GRID.shape[0]), solver.plan(GRID.shape[0], solver=name))


class NotPositiveDefiniteError(Exception):
    """Stands for that of scikit-sparse."""


class Factored:
    """Dense stand-in for the factor of scikit-sparse, old and new."""

    def __init__(self, matrix):
        try:
            self.lower = np.linalg.cholesky(matrix)
        except np.linalg.LinAlgError as error:
            raise NotPositiveDefiniteError from error

    def solve(self, b):
        return np.linalg.solve(self.lower.T, np.linalg.solve(self.lower, b))

    __call__ = solve

    def apply_P(self, b):  # noqa: N802
        return b

    def solve_L(self, b, use_LDLt_decomposition=True):  # noqa: N802
        assert not use_LDLt_decomposition
        return np.linalg.solve(self.lower, b)


def cho_factor(A, *, lower=False, order=None):
    """Signature of scikit-sparse 0.5: reads one triangle."""
    assert isinstance(A, csc_array)
    assert order == "metis"
    half = tril(A).toarray() if lower else tril(A.T).toarray()
    return Factored(half + np.tril(half, -1).T)


def cholesky_04(A, beta=0, mode="auto", ordering_method="default", use_long=None):
    """Signature of scikit-sparse 0.4."""
    return Factored(A.toarray())


def cholesky_05(A, *, lower=False, order=None):
    """Signature of scikit-sparse 0.5: gives a matrix."""
    raise AssertionError("this gives no factor to solve with")


@pytest.mark.parametrize("functions", [{"cholesky": cholesky_04}, {"cholesky": cholesky_05, "cho_factor": cho_factor}])
def test_scikit_sparse_old_and_new(monkeypatch, functions):
    """By its signatures; with the package itself the tests above run it."""
    cholmod = ModuleType("sksparse.cholmod")
    vars(cholmod).update(functions, CholmodNotPositiveDefiniteError=NotPositiveDefiniteError)
    package = ModuleType("sksparse")
    package.cholmod = cholmod
    monkeypatch.setitem(sys.modules, "sksparse", package)
    monkeypatch.setitem(sys.modules, "sksparse.cholmod", cholmod)
    small = (kron(LINE, eye(12)) + kron(eye(12), LINE)).tocsc()
    want = np.random.default_rng(1).normal(size=(small.shape[0], 3))
    plan = solver.Plan("cholmod", small.shape[0], 0.0, 1.0)
    solve = solver.factor(tril(small), plan)
    assert_allclose(solve(small @ want), want, rtol=1e-10, atol=1e-12)
    assert_allclose(solve(small @ want[:, 0]), want[:, 0], rtol=1e-10, atol=1e-12)
    assert_allclose(solve.gram(small @ want), want.T @ small @ want, rtol=1e-10, atol=1e-9)
    with pytest.raises(RuntimeError, match="not held"):
        solver.factor(small - 2 * eye(small.shape[0]), plan)


def test_an_empty_diagonal_is_refused():
    with pytest.raises(RuntimeError, match="empty or negative diagonal"):
        solver.factor(diags([1.0, 0.0]))


def test_the_best_solver_is_chosen_and_the_plan_says_what_it_takes():
    made = solver.plan(30_000, free=8e9)
    assert made.solver == solver.available()[0]
    assert 0 < made.memory < 8e9
    assert str(made).startswith(f"{made.solver}, 30000 unknowns, about ")
    assert str(made).endswith("of 8 GB free")
    assert solver.expected_memory(400_000, "pardiso") > 2 * solver.expected_memory(200_000, "pardiso")


def test_what_does_not_fit_is_refused_with_the_numbers():
    with pytest.raises(RuntimeError, match=r"3000000 unknowns are too many for SuperLU .*GB"):
        solver.plan(3_000_000, solver="superlu", free=1e9)
    with pytest.raises(RuntimeError, match=r"30000 unknowns need about .* GB with superlu, but 0\.1 GB are free"):
        solver.plan(30_000, solver="superlu", free=1e8)
    with pytest.raises(ValueError, match="solver = 'lapack'"):
        solver.plan(10, solver="lapack")


def test_without_the_fast_solvers_superlu_is_left(monkeypatch):
    found = solver.importlib.util.find_spec
    monkeypatch.setattr(
        solver.importlib.util, "find_spec", lambda name: None if name in ("sksparse", "pypardiso") else found(name)
    )
    assert solver.available() == ["superlu"]
    assert solver.plan(1000).solver == "superlu"
    with pytest.raises(RuntimeError, match="pip install"):
        solver.plan(100_000)


def test_free_memory_is_that_of_this_machine():
    assert 1e7 < solver.free_memory() < 1e15
