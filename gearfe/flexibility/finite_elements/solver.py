"""Sparse symmetric positive definite systems: one factorisation, many solves, and a check of the memory beforehand.

CHOLMOD (of cvxopt) factors by dense blocks. Half solutions of bodies in three dimensions need no factor (`fronts`). METIS (of
pymetis) finds the order by nested dissection of the mesh's nodes. Without pymetis (Windows), CHOLMOD's minimum degree order is
used.
"""

import importlib.util
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array, issparse, tril

from ...core.memory import free_memory
from ...core.steps import reached
from ...core.time_limit import check_time
from .fronts import gram as gram_of_fronts
from .supernodes import factor_memory, gram

WHOLE = 0  # system that CHOLMOD solves: the whole matrix
# Size of right-hand sides given to cvxopt at once [bytes]. cvxopt counts bytes in 32 bits. From 2**31 on it accesses foreign
# memory, which mostly causes a segmentation fault (cvxopt 1.3.3, src/C/cholmod.c, `solve`).
BLOCK = 2**27
# Memory [bytes] per unknown during ordering, and per unknown in addition to the factor. Memory of the factor in n**(4/3) with
# and without METIS, see `plan`.
ORDERED, KEPT, FACTORED = 7700.0, 4700.0, {True: 131.0, False: 153.0}
HALF, FRONTS = 4700.0, 11.0  # memory of half solutions: per unknown, and of the fronts in n**(4/3) [bytes]
LIBRARIES = 0.25e9  # address space that CHOLMOD, METIS and BLAS reserve at their first use [bytes]; 0.21e9 measured
SOLVED = 100.0, 100.0  # memory per unknown of a solution, and per unknown and right-hand side [bytes]
PLANE = 8000.0  # memory per unknown of a factored plane body [bytes]; 7300 measured
# factors of n, n**2, and n**(4/3) per right-hand side, with and without METIS
SECONDS = {True: (5e-5, 1.9e-10, 2e-10), False: (5e-5, 3.2e-10, 3e-10)}


@dataclass(frozen=True, slots=True)
class SolveCost:
    """Expected cost of a factorisation.

    `unknowns` is their number, `memory` the expected and `free` the available memory [bytes], `seconds` the expected time.
    """

    unknowns: int
    memory: float
    seconds: float
    free: float

    def __str__(self):
        seconds = float(f"{self.seconds:.2g}")
        return f"{self.unknowns} unknowns, about {seconds:g} s and {self.memory / 1e9:.2g} GB of {self.free / 1e9:.3g} GB free"


def dissects():
    """Return True if METIS is installed to order unknowns."""
    return importlib.util.find_spec("pymetis") is not None


def plan(unknowns, *, columns=0, free=None):
    """Estimate memory and time of the factor of a three-dimensional body. Raises RuntimeError if it does not fit.

    The factor of a nested dissection of n unknowns of a body has about ``c n**(4/3)`` numbers, all of which are read for
    each right-hand side, and takes about ``c n**2`` operations; loads, matrix and order take ``c n``. The memory is that of
    the larger step: the order of elimination, or the factor with the memory that the allocator keeps from the steps before.
    Half solutions (`half_solved`) keep no factor, but the matrix and the fronts. The constants of time are measured on gears of
    20-node hexahedra with 41 000 to 464 000 unknowns, on one thread of a processor of 2.5 GHz, for half solutions. Those of
    memory are measured on whole gears with 75 000 to 236 000 unknowns. Teeth of tetrahedra, being slender, take less.

    Parameters
    ----------
    unknowns : int
    columns : int
        Right-hand sides of half solutions; 0 for solutions by a factor.
    free : float, optional
        Memory [bytes] that may be used; default `free_memory`.

    Returns
    -------
    Plan

    Raises
    ------
    RuntimeError
        If the system does not fit; the message has the numbers.

    References
    ----------
    A. George, J. W. H. Liu, Computer Solution of Large Sparse Positive Definite Systems, Prentice-Hall, 1981, ch. 8.
    """
    n, ordered, free = int(unknowns), dissects(), free_memory() if free is None else float(free)
    first, second, each = SECONDS[ordered]
    numbers = n ** (4 / 3)
    seconds = first * n + second * n**2 + each * columns * numbers
    memory = HALF * n + FRONTS * numbers if columns else max(ORDERED * n, KEPT * n + FACTORED[ordered] * numbers)
    memory += LIBRARIES
    cost = SolveCost(n, memory, seconds, free)
    if cost.memory > free:
        raise RuntimeError(
            f"{n} unknowns need about {cost.memory / 1e9:.3g} GB and {float(f'{cost.seconds:.2g}'):g} s, but {free / 1e9:.3g} GB "
            f"are free: coarsen the mesh (a smaller refine), or give more memory (the computer, `ulimit -v`)"
        )
    check_time(f"{n} unknowns", seconds, "coarsen the mesh (a smaller refine)")
    return cost


def factor(matrix, plan_=None, *, node=3):
    """Factor a symmetric positive definite matrix.

    Parameters
    ----------
    matrix : sparse matrix, shape (n, n)
        Only its lower triangle is read.
    plan_ : Plan, optional
        Of a body in three dimensions; default: `plan` of its size. `gearfe.core.steps` receives it.
    node : int
        Unknowns of a node, which follow each other: 3, or 2 in the plane. METIS orders those of a node in space together.

    Returns
    -------
    callable
        From right-hand sides ``(n,)`` or ``(n, k)``, which may be sparse, to solutions of the same shape. Its attribute ``gram``
        maps right-hand sides F ``(n, k)`` to ``F' K^-1 F`` by half a solution (`supernodes.gram`).

    Raises
    ------
    RuntimeError
        If it does not fit, or is not positive definite: the body is not held.
    """
    cholmod, spmatrix, dense = _cvxopt()
    if node == 3:
        reached(f"solving {plan_ or plan(matrix.shape[0])}", 0.0)
    else:
        _check_free(matrix.shape[0], PLANE * matrix.shape[0])
    lower = _lower(matrix)
    n = lower.shape[0]
    del matrix  # It takes about a fifth of the memory of the factor.
    rows, columns = lower.indices.astype(np.int64), np.repeat(np.arange(n), np.diff(lower.indptr))
    held = spmatrix(dense(lower.data), dense(rows), dense(columns), lower.shape)
    # In the plane, an order by least degree takes less time than that of METIS. A pair takes 0.54 s instead of 0.65 s.
    ordered = node == 3 and dissects()
    factored = cholmod.symbolic(held, p=dense(dissection(rows, columns))) if ordered else cholmod.symbolic(held)
    del rows, columns, lower
    _check_free(n, factor_memory(factored))
    try:
        cholmod.numeric(held, factored)
    except ArithmeticError as error:
        raise RuntimeError("the stiffness matrix is not positive definite: the body is not held") from error

    def solve(rhs):
        from cvxopt import sparse

        sides = csc_array(rhs) if issparse(rhs) else np.reshape(rhs, (n, -1))
        out, width = np.empty(sides.shape, order="F"), max(1, BLOCK // (8 * n))
        _check_free(n, (SOLVED[0] + SOLVED[1] * min(width, sides.shape[1])) * n)
        for start in range(0, sides.shape[1], width):
            span = slice(start, start + width)
            columns = sides[:, span].toarray() if issparse(rhs) else sides[:, span]
            block = dense(np.asfortranarray(columns, dtype=float))
            # For sparse columns CHOLMOD solves several at once and reads the factor less often, which halves the time.
            out[:, span] = np.asarray(dense(cholmod.spsolve(factored, sparse(block), sys=WHOLE)))
        return out.reshape(rhs.shape if issparse(rhs) else np.shape(rhs))

    solve.gram = lambda rhs: gram(factored, csr_array(rhs))
    return solve


def half_solved(matrix, rhs, plan_=None, *, node=3):
    """Return ``F' K^-1 F`` of a body in three dimensions for right-hand sides F ``(n, k)``, without keeping the factor of K.

    Parameters and errors are those of `factor`. The right-hand sides are sparse. `fronts.gram` is the method.
    """
    cholmod, spmatrix, dense = _cvxopt()
    reached(f"solving {plan_ or plan(matrix.shape[0], columns=rhs.shape[1])}", 0.0)
    lower = _lower(matrix)
    del matrix
    columns = np.repeat(np.arange(lower.shape[0], dtype=lower.indices.dtype), np.diff(lower.indptr)) // node
    shape = (lower.shape[0] // node,) * 2
    graph = coo_array((np.ones(columns.size, dtype=bool), (lower.indices // node, columns)), shape=shape).tocsc()
    del columns
    rows, columns = graph.indices.astype(np.int64), np.repeat(np.arange(shape[0]), np.diff(graph.indptr))
    held = spmatrix(1.0, dense(rows), dense(columns), shape)
    analysed = cholmod.symbolic(held, p=dense(dissection(rows, columns, 1))) if dissects() else cholmod.symbolic(held)
    del held, rows, columns, graph
    return gram_of_fronts(analysed, lower, csr_array(rhs), node)


def _cvxopt():
    """Import the parts of cvxopt: `cholmod`, `spmatrix` and `matrix`. RuntimeError if it does not load."""
    try:
        from cvxopt import cholmod, matrix, spmatrix
    except ImportError as error:  # Its libraries may exceed the limit of memory.
        raise RuntimeError(f"cvxopt does not load ({error}): install it, or raise the limit of memory (`ulimit -v`)") from error
    return cholmod, spmatrix, matrix


def _lower(matrix):
    """Return the lower triangle of a matrix. RuntimeError if its diagonal is not positive."""
    lower = csc_array(matrix, dtype=float)
    lower.sum_duplicates()
    if (lower.indices < np.repeat(np.arange(lower.shape[0]), np.diff(lower.indptr))).any():
        lower = tril(lower, format="csc")
    if not (lower.diagonal() > 0).all():
        raise RuntimeError("the stiffness matrix has an empty or negative diagonal: the body is not held")
    return lower


def _check_free(unknowns, memory):
    """Raise RuntimeError if less than `memory` [bytes] is free. Without memory, CHOLMOD and cvxopt can end the process."""
    if (free := free_memory()) < memory:
        raise RuntimeError(
            f"{unknowns} unknowns need about {memory / 1e9:.2g} GB more, but {free / 1e9:.2g} GB are free: raise the limit of "
            "memory (`ulimit -v`), or give a smaller refine"
        )


def dissection(rows, columns, node=3):
    """Elimination order by nested dissection of nodes of `node` unknowns. `rows`, `columns` are the lower triangle's entries.

    References
    ----------
    G. Karypis, V. Kumar, SIAM J. Sci. Comput. 20 (1998) 359-392.
    """
    import pymetis

    n, i, j = int(rows[-1]) + 1, rows // node, columns // node
    apart = i != j
    shape = (int(i[-1]) + 1,) * 2
    half = coo_array((np.ones(np.count_nonzero(apart), dtype=bool), (i[apart], j[apart])), shape=shape).tocsr()
    graph = half + half.T
    _, rank = pymetis.nested_dissection(pymetis.CSRAdjacency(graph.indptr, graph.indices))
    return np.argsort(np.asarray(rank)[np.arange(n) // node], kind="stable")
