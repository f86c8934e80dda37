"""The solver of bodies against known solutions, with and without METIS; what does not fit is refused beforehand."""

import gc

import numpy as np
import pytest
from cvxopt import cholmod, spmatrix
from cvxopt import matrix as dense
from numpy.testing import assert_allclose
from scipy.sparse import block_diag, csc_array, csr_array, diags, eye, kron, tril

from gearfe.core.memory import free_memory
from gearfe.flexibility.finite_elements import solver
from gearfe.flexibility.finite_elements.supernodes import gram

LINE = diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(12, 12))
GRID = (kron(kron(LINE, eye(12)), eye(12)) + kron(kron(eye(12), LINE), eye(12)) + kron(eye(144), LINE)).tocsc()
BODY = kron(GRID, np.ones((3, 3)) + np.eye(3)).tocsc()[:1500, :1500]  # three unknowns of a node


@pytest.fixture(params=[True, False], ids=["nested dissection", "least degree"])
def ordered(request, monkeypatch):
    """With METIS, and as it is where it cannot be had."""
    monkeypatch.setattr(solver, "dissects", lambda: request.param)
    return request.param


def test_the_known_solution_is_found(ordered):
    want = np.random.default_rng(0).normal(size=(GRID.shape[0], 3))
    for matrix in (GRID, tril(GRID)):
        solve = solver.factor(matrix)
        assert_allclose(solve(GRID @ want), want, rtol=1e-10, atol=1e-11, err_msg="only the lower triangle is read")
        assert_allclose(solve.gram(GRID @ want), want.T @ GRID @ want, rtol=1e-10, atol=1e-8)
        assert_allclose(solve(GRID @ want[:, 0]), want[:, 0], rtol=1e-10, atol=1e-11)


def test_stored_zeros_of_right_hand_sides_are_zeros(ordered):
    """Inclined forces without a component are stored zeros: a front may get nothing else."""
    size = GRID.shape[0]
    sides = csr_array(([0.0, 1.0, 0.0], ([0, size - 1, 3], [0, 1, 1])), shape=(size, 2))
    want = np.linalg.inv(GRID.toarray())[-1, -1]
    assert_allclose(solver.factor(GRID).gram(sides), [[0.0, 0.0], [0.0, want]], rtol=1e-10)


@pytest.mark.parametrize("size", [1, 2, 3, 5, 700])
def test_any_size_and_any_pattern_is_solved(ordered, size):
    """Not only nodes of three unknowns; bodies apart from each other, too."""
    random = np.random.default_rng(size)
    one = diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(size, size)).toarray() + np.diag(random.uniform(0.1, 1, size))
    matrix = block_diag([one, one[: size // 2 + 1, : size // 2 + 1]]).tocsc()
    want = random.normal(size=matrix.shape[0])
    assert_allclose(solver.factor(matrix)(matrix @ want), want, rtol=1e-9, atol=1e-10)


def test_the_right_hand_sides_stay_as_they_are(ordered):
    given = np.asfortranarray(np.random.default_rng(0).normal(size=(GRID.shape[0], 2)))
    kept, solve = given.copy(), solver.factor(GRID)
    solve(given), solve.gram(given)
    assert np.array_equal(given, kept)


@pytest.mark.parametrize(
    "most", [1, 8 * GRID.shape[0], 20 * GRID.shape[0], solver.BLOCK], ids=["a byte", "a column", "two columns", "as it is"]
)
def test_right_hand_sides_are_given_in_blocks(monkeypatch, most):
    """cvxopt reads and writes memory that is not its own from 2**31 bytes on: of fewer at once the numbers are the same."""
    given, sizes, solve = [], [], cholmod.spsolve
    want = np.random.default_rng(0).normal(size=(GRID.shape[0], 5))
    factored = solver.factor(GRID)
    whole = factored(want)

    def spied(factor, block, sys=0):
        sizes.append(8 * block.size[0] * block.size[1])
        given.append(sys)
        return solve(factor, block, sys=sys)

    monkeypatch.setattr(cholmod, "spsolve", spied)
    monkeypatch.setattr(solver, "BLOCK", most)
    parts = factored(want)
    assert max(sizes) <= max(most, 8 * GRID.shape[0]) < 2**31
    assert given.count(solver.WHOLE) == -(-5 // max(1, min(5, most // (8 * GRID.shape[0]))))
    # sums are rounded by their largest terms: small entries have no digits of their own
    assert_allclose(whole, parts, rtol=0, atol=1e-13 * abs(parts).max())


def test_half_solutions_skip_what_no_load_reaches(ordered):
    """Loads on few unknowns, in any order of the columns, against whole solutions."""
    loads = np.zeros((GRID.shape[0], 6))
    loads[[3, 5, 400, 401, 3, 7], [4, 4, 0, 2, 1, 5]] = [1.0, -2.0, 3.0, 0.5, 7.0, 1e-3]
    factored = solver.factor(GRID)
    want = loads.T @ factored(loads)
    assert_allclose(factored.gram(csc_array(loads)), want, rtol=1e-12, atol=1e-14 * want.max())


def test_half_solutions_without_a_factor_are_those_with_one(ordered):
    """Loads on some and on all unknowns; bodies apart from each other; only the lower triangle is read."""
    some = np.zeros((BODY.shape[0], 3))
    some[[3, 900, 901], [0, 1, 1]] = [1.0, 2.0, -0.5]
    every = np.random.default_rng(0).normal(size=(BODY.shape[0], 4))
    apart = block_diag([BODY, BODY[:600, :600]]).tocsc()
    cases = (BODY, some), (tril(BODY), every), (apart, np.vstack([some, every[:600, :3]]))
    for matrix, loads in cases:
        whole = matrix if matrix is not cases[1][0] else BODY
        given = loads.copy()
        want = loads.T @ np.linalg.solve(whole.toarray(), loads)
        assert_allclose(solver.half_solved(matrix, csc_array(loads), "given"), want, rtol=1e-10, atol=1e-12 * np.abs(want).max())
        assert np.array_equal(given, loads)


def test_half_solutions_of_indefinite_matrices_are_refused(ordered):
    with pytest.raises(RuntimeError, match="not held"):
        solver.half_solved(BODY - 2 * eye(BODY.shape[0]), csc_array(np.ones((BODY.shape[0], 1))), "given")


def test_half_solutions_need_supernodes():
    cholmod.options["supernodal"] = 0
    try:
        with pytest.raises(RuntimeError, match="no supernodes"):
            solver.half_solved(BODY, csc_array(np.ones((BODY.shape[0], 1))), "given")
    finally:
        cholmod.options.pop("supernodal")


def test_factors_without_supernodes_are_refused():
    with pytest.raises(RuntimeError, match="no supernodes"):
        gram(simplicial(GRID), csr_array(np.ones((GRID.shape[0], 1))))


def simplicial(matrix):
    """Factor that cvxopt computes column by column."""
    rows, columns = (part.astype(np.int64) for part in tril(matrix).nonzero())
    values = np.asarray(matrix[rows, columns]).ravel()
    held, former = spmatrix(dense(values), dense(rows), dense(columns), matrix.shape), dict(cholmod.options)
    cholmod.options["supernodal"] = 0
    try:
        factored = cholmod.symbolic(held)
        cholmod.numeric(held, factored)
    finally:
        cholmod.options.clear()
        cholmod.options.update(former)
    return factored


def test_the_factor_lives_as_long_as_it_is_used(ordered):
    gram = solver.factor(GRID).gram
    gc.collect()
    want = np.ones((GRID.shape[0], 2))
    assert_allclose(gram(GRID @ want), want.T @ GRID @ want, rtol=1e-10)


def test_indefinite_matrices_are_refused(ordered):
    with pytest.raises(RuntimeError, match="not held"):
        solver.factor(GRID - 2 * eye(GRID.shape[0]))


def test_nested_dissection_orders_nodes_and_keeps_their_unknowns_together():
    """And fills in less than the order as it stands: the numbers of a factor are counted by its elimination."""
    rows, columns = tril(BODY).tocoo().coords
    by_column = np.lexsort((rows, columns))
    order = solver.dissection(rows[by_column], columns[by_column])
    assert np.array_equal(np.sort(order), np.arange(BODY.shape[0]))
    assert (order.reshape(-1, 3) // 3 == order[::3, None] // 3).all()
    as_it_is, moved = (np.linalg.cholesky(one.toarray()) for one in (BODY, BODY[order][:, order]))
    assert np.count_nonzero(np.abs(moved) > 1e-14) < 0.6 * np.count_nonzero(np.abs(as_it_is) > 1e-14)


def test_the_plan_says_what_it_takes(ordered):
    made = solver.plan(30_000, free=8e9)
    assert 0 < made.memory < 8e9
    assert str(made).startswith("30000 unknowns, about ")
    assert str(made).endswith(" GB of 8 GB free")
    twice = solver.plan(400_000, free=1e12)
    assert twice.memory > 2 * solver.plan(200_000, free=1e12).memory
    assert twice.seconds > 2 * solver.plan(200_000, free=1e12).seconds
    more = solver.plan(400_000, columns=100, free=1e12)
    assert 8 * 400_000 < more.memory < twice.memory / 2, "half solutions keep no factor"
    assert twice.seconds < more.seconds < 1.1 * twice.seconds, "all columns are solved at once"


def test_what_does_not_fit_is_refused_with_memory_time_and_remedy(ordered):
    with pytest.raises(RuntimeError, match=r"3000000 unknowns need about [\d.]+ GB and \d+ s, but 1 GB are free: coarsen"):
        solver.plan(3_000_000, free=1e9)


@pytest.mark.parametrize("sides", [1, 50])
def test_memory_is_checked_before_the_factor_and_before_the_solution(ordered, sides, monkeypatch):
    """The analysis gives the size of the factor exactly. CHOLMOD would end the process if memory ran out."""
    seen = []
    numeric, analysed = cholmod.numeric, solver.factor_memory
    monkeypatch.setattr(solver, "factor_memory", lambda factored: seen.append(analysed(factored)) or seen[-1])
    monkeypatch.setattr(cholmod, "numeric", lambda held, factored: (numeric(held, factored), seen.append(analysed(factored))))
    solve = solver.factor(BODY)
    assert seen[0] == seen[1] > 8 * BODY.shape[0]
    monkeypatch.setattr(solver, "free_memory", lambda: 100.0 * BODY.shape[0] * (1 + sides) - 1)
    with pytest.raises(RuntimeError, match=r"1500 unknowns need about [\d.e-]+ GB more, but .* are free: raise the limit"):
        solve(np.ones((BODY.shape[0], sides)))
    monkeypatch.setattr(solver, "free_memory", lambda: seen[0] - 1.0)
    monkeypatch.setattr(cholmod, "numeric", lambda *_: pytest.fail("factored"))
    with pytest.raises(RuntimeError, match=r"1500 unknowns need about .* GB more"):
        solver.factor(BODY, "given")


def test_free_memory_is_that_of_this_machine():
    assert 1e7 < free_memory() < 1e15
