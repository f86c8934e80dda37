"""Sparse symmetric positive definite systems: the best solver installed, and a refusal beforehand of what does not fit."""

import importlib.util
import math
import os
import weakref
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.sparse import csc_array, csc_matrix, csr_matrix, tril
from scipy.sparse.linalg import splu

SOLVERS = {"cholmod": "sksparse", "pardiso": "pypardiso", "superlu": "scipy"}  # in the order of preference, by package
GROUP = "/sys/fs/cgroup"  # of this process; version 2, then version 1
CONTROL_GROUP = (  # files with limit, use [bytes] and details, and the name of cached files in the last
    (f"{GROUP}/memory.max", f"{GROUP}/memory.current", f"{GROUP}/memory.stat", "inactive_file"),
    (f"{GROUP}/memory/memory.limit_in_bytes", f"{GROUP}/memory/memory.usage_in_bytes", f"{GROUP}/memory/memory.stat",
     "total_inactive_file"),
)  # fmt: skip
SUPERLU_LIMIT = 40_000  # unknowns: above, its fill makes it slower by an order of magnitude and its memory a gamble


@dataclass(frozen=True, slots=True)
class Plan:
    """What a factorisation will take.

    `solver` is its name, `unknowns` their number, `memory` the expected and `free` the available memory [bytes].
    """

    solver: str
    unknowns: int
    memory: float
    free: float

    def __str__(self):
        return f"{self.solver}, {self.unknowns} unknowns, about {self.memory / 1e9:.2g} GB of {self.free / 1e9:.3g} GB free"


def available():
    """Names of the solvers installed, the best first."""
    return [name for name, package in SOLVERS.items() if importlib.util.find_spec(package)]


def free_memory():
    """Memory [bytes] that can be had without swapping: what the machine has free, less if this process may use less."""
    return min(_machine_free(), _process_free(), _group_free())


def _process_free():
    """What is left of the limit of this process (``ulimit -v``, ``ulimit -d``)."""
    try:
        import resource
    except ImportError:  # no such limits on this system
        return math.inf
    soft = [resource.getrlimit(kind)[0] for kind in (resource.RLIMIT_AS, resource.RLIMIT_DATA)]
    least = min((float(one) for one in soft if one != resource.RLIM_INFINITY), default=math.inf)
    if least == math.inf:
        return least
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            used = float(file.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        used = 0.0
    return max(least - used, 0.0)


def _group_free():
    """What is left to the control group of this process (a container); version 2 has two files, version 1 others."""
    left = math.inf
    for limit, used, told, cached in CONTROL_GROUP:
        try:
            most, taken, lines = (Path(name).read_text(encoding="ascii").strip() for name in (limit, used, told))
        except OSError:
            continue
        files = next((float(line.split()[1]) for line in lines.splitlines() if line.startswith(f"{cached} ")), 0.0)
        if most.isdigit() and taken.isdigit():  # files that nobody reads now make room when asked
            left = min(left, max(float(most) - float(taken) + files, 0.0))
    return left


def _machine_free():
    try:
        with open("/proc/meminfo", encoding="ascii") as lines:
            for line in lines:
                if line.startswith("MemAvailable"):
                    return 1024.0 * int(line.split()[1])
    except OSError:
        pass
    return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")) if hasattr(os, "sysconf") else math.inf


def plan(unknowns, *, columns=0, solver=None, free=None):
    """Choose a solver for a three-dimensional body and see whether it fits.

    The factor of a nested dissection of n unknowns of a body has about ``c n**(4/3)`` numbers.

    Parameters
    ----------
    unknowns : int
    columns : int
        Right-hand sides solved for at once; three copies of them are held.
    solver : {"cholmod", "pardiso", "superlu"}, optional
        Default: the best that is installed.
    free : float, optional
        Memory [bytes] that may be used; default `free_memory`.

    Returns
    -------
    Plan

    Raises
    ------
    ValueError
        If the solver is not known or not installed.
    RuntimeError
        If the system does not fit; the message has the numbers.

    References
    ----------
    A. George, J. W. H. Liu, Computer Solution of Large Sparse Positive Definite Systems, Prentice-Hall, 1981, ch. 8.
    """
    found = available()
    if solver is not None and solver not in found:
        raise ValueError(f"solver = {solver!r}, but this machine has {', '.join(found)}")
    name = solver or found[0]
    free = free_memory() if free is None else float(free)
    made = Plan(name, int(unknowns), expected_memory(unknowns, name) + 24.0 * columns * unknowns, free)
    if name == "superlu" and unknowns > SUPERLU_LIMIT:
        raise RuntimeError(
            f"{unknowns} unknowns are too many for SuperLU (limit {SUPERLU_LIMIT}, about {made.memory / 1e9:.2g} GB): install "
            "pypardiso (pip install 'gearfe[fast]') or scikit-sparse, or coarsen the mesh"
        )
    if made.memory > free:
        raise RuntimeError(
            f"{unknowns} unknowns need about {made.memory / 1e9:.3g} GB with {name}, but {free / 1e9:.3g} GB are free: "
            "coarsen the mesh"
        )
    return made


def expected_memory(unknowns, solver):
    """Expected memory [bytes] of matrix and factor; the constants are measured on gears of 20-node hexahedra."""
    matrix, factor = MEMORY[solver]
    return matrix * unknowns + factor * unknowns ** (4 / 3)


MEMORY = {"cholmod": (3600.0, 240.0), "pardiso": (2400.0, 200.0), "superlu": (4800.0, 450.0)}  # [bytes], see expected_memory


def factor(matrix, plan_=None):
    """Factor a symmetric positive definite matrix.

    Parameters
    ----------
    matrix : sparse matrix, shape (n, n)
        Only its lower triangle is read.
    plan_ : Plan, optional
        Default: `plan` of its size.

    Returns
    -------
    callable
        From right-hand sides ``(n,)`` or ``(n, k)`` to solutions of the same shape. Its attribute ``gram`` maps right-hand sides
        F ``(n, k)`` to ``F' K^-1 F``, where the solver can by half a solution: with ``K = L L'`` it is that of ``L^-1 F``.

    Raises
    ------
    RuntimeError
        If it does not fit, or is not positive definite: the body is not held.
    """
    made = plan_ or plan(matrix.shape[0])
    lower = csc_matrix(tril(matrix, format="csc"), dtype=float)
    lower.sum_duplicates()
    if not (lower.diagonal() > 0).all():
        raise RuntimeError("the stiffness matrix has an empty or negative diagonal: the body is not held")
    solve = {"cholmod": _cholmod, "pardiso": _pardiso, "superlu": _superlu}[made.solver](lower)
    if not hasattr(solve, "gram"):
        solve.gram = lambda rhs: rhs.T @ solve(rhs)
    return solve


def _cholmod(lower):
    from sksparse import cholmod

    if hasattr(cholmod, "cho_factor"):
        return _cholmod_05(lower, cholmod)
    try:
        factored = cholmod.cholesky(_full(lower), mode="supernodal", ordering_method="metis")
    except cholmod.CholmodNotPositiveDefiniteError as error:
        raise RuntimeError("the stiffness matrix is not positive definite: the body is not held") from error

    def solve(rhs):
        return factored(np.ascontiguousarray(rhs))

    def gram(rhs):
        moved = factored.solve_L(factored.apply_P(np.ascontiguousarray(rhs)), use_LDLt_decomposition=False)
        return moved.T @ moved

    solve.gram = gram
    return solve


def _cholmod_05(lower, cholmod):
    """By scikit-sparse 0.5, whose functions have other names; `factor` adds ``gram`` by whole solutions."""
    try:
        factored = cholmod.cho_factor(csc_array(lower), lower=True, order="metis")
    except cholmod.CholmodNotPositiveDefiniteError as error:
        raise RuntimeError("the stiffness matrix is not positive definite: the body is not held") from error
    return lambda rhs: factored.solve(np.asfortranarray(rhs, dtype=float))


def _pardiso(lower):
    from pypardiso import PyPardisoSolver
    from pypardiso.pardiso_wrapper import PyPardisoError

    solver = PyPardisoSolver(mtype=2, size_limit_storage=0)
    # the lower triangle by columns is the upper one by rows, which PARDISO wants
    upper = csr_matrix((lower.data, lower.indices, lower.indptr), shape=lower.shape)
    try:
        solver.factorize(upper)
    except PyPardisoError as error:
        raise RuntimeError(f"PARDISO failed ({error}): the body is not held, or memory is short") from error

    def half(rhs, phase):
        solver.set_phase(phase)
        return solver._call_pardiso(upper, np.asfortranarray(rhs, dtype=float))

    def solve(rhs):
        return half(half(rhs, 331), 333)  # phase 33 would refine the solution, at five times the cost

    def gram(rhs):
        moved = half(rhs, 331)
        return moved.T @ moved

    solve.gram = gram
    weakref.finalize(half, solver.free_memory, everything=True)  # PARDISO keeps its factor until told; `gram` may outlive `solve`
    return solve


def _superlu(lower):
    factored = splu(_full(lower), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    if (factored.U.diagonal() <= 0).any():
        raise RuntimeError("the stiffness matrix is not positive definite: the body is not held")
    return lambda rhs: factored.solve(np.asarray(rhs, dtype=float))


def _full(lower):
    return csc_matrix(lower + tril(lower, -1).T)
