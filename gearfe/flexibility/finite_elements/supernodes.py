"""Forward solutions for many right-hand sides, by the dense blocks of a CHOLMOD factor.

cvxopt gives CHOLMOD four columns at once, so that the whole factor is read for every four right-hand sides. Here each supernode,
a dense block of columns of the factor, is read once. Supernodes that no right-hand side reaches are skipped.
"""

import ctypes

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.sparse import csr_array

SIZES, POINTERS = ctypes.c_size_t, ctypes.c_void_p
LONG, REAL = 2, 1  # CHOLMOD's codes of 64-bit integers and of real numbers


class _Factor(ctypes.Structure):
    """``cholmod_factor`` of SuiteSparse (CHOLMOD/Include/cholmod_core.h), the same since version 1.7."""

    _fields_ = [
        *((name, SIZES) for name in ("n", "minor")),
        *((name, POINTERS) for name in ("perm", "count", "inverse")),
        ("nzmax", SIZES),
        *((name, POINTERS) for name in ("p", "i", "x", "z", "nz", "next", "prev")),
        *((name, SIZES) for name in ("nsuper", "ssize", "xsize", "maxcsize", "maxesize")),
        *((name, POINTERS) for name in ("super", "pi", "px", "s")),
        *((name, ctypes.c_int) for name in ("ordering", "is_ll", "is_super", "is_monotonic", "itype", "xtype", "dtype")),
    ]


def gram(factored: object, rhs: csr_array) -> NDArray:
    """Return ``F' K^-1 F`` for sparse right-hand sides F ``(n, k)``, from cvxopt's factor of K.

    With ``K = L L'`` it is the product of ``L^-1 F`` with itself, summed up supernode by supernode.

    Raises
    ------
    RuntimeError
        If the factor does not consist of supernodes of real numbers.

    References
    ----------
    Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, ACM Trans. Math. Softw. 35(3) (2008) 22.
    """
    found = _structure(factored)
    if (found.n, found.is_ll, found.is_super, found.itype, found.xtype, found.dtype) != (rhs.shape[0], 1, 1, LONG, REAL, 0):
        raise RuntimeError("the factor of CHOLMOD has no supernodes of real numbers: install cvxopt from its wheels")
    begin, row, place = (_numbers(getattr(found, name), found.nsuper + 1) for name in ("super", "pi", "px"))
    rows, values = _numbers(found.s, found.ssize), _numbers(found.x, found.xsize, ctypes.c_double)
    half, place_of = _reached(rhs[_numbers(found.perm, found.n)], begin, row, rows)
    out = np.zeros((rhs.shape[1],) * 2)
    for k in np.flatnonzero(place_of[begin[:-1]] >= 0):
        width, below = begin[k + 1] - begin[k], rows[row[k] : row[k + 1]]
        own = half[place_of[begin[k]] :][:width]
        reached = np.flatnonzero(own.any(axis=0))
        if not reached.size:  # Stored numbers of F may be zero.
            continue
        columns = slice(reached[0], reached[-1] + 1)
        block = values[place[k] : place[k] + width * below.size].reshape(width, below.size).T
        solved = solve_triangular(block[:width], own[:, columns], lower=True, check_finite=False)
        out[columns, columns] += solved.T @ solved
        half[place_of[below[width:]], columns] -= block[width:] @ solved
    return out


def factor_memory(factored: object) -> int:
    """Return the memory [bytes] for the numbers of a factor that is only analysed, or 0 without supernodes."""
    found = _structure(factored)
    return 8 * (found.xsize + found.maxcsize) if found.is_super else 0


def structure(analysed: object) -> tuple[NDArray, list[NDArray], NDArray]:
    """Return the supernodes of a factor that is only analysed: first columns, members of each block, and the elimination order.

    Raises RuntimeError if the factor has no supernodes.
    """
    found = _structure(analysed)
    if not found.is_super or found.itype != LONG:
        raise RuntimeError("the factor of CHOLMOD has no supernodes: install cvxopt from its wheels")
    begin, row = (_numbers(getattr(found, name), found.nsuper + 1).copy() for name in ("super", "pi"))
    return begin, np.split(_numbers(found.s, found.ssize).copy(), row[1:-1]), _numbers(found.perm, found.n).copy()


def _reached(rhs, begin, row, rows):
    """Return the right-hand sides restricted to unknowns that loads reach, and the row of each unknown in them (-1: absent).

    A reached supernode reaches all rows of its block. The other arguments are supernodes' first columns, their first entry in
    `rows`, and the rows of all blocks.
    """
    reached = np.diff(rhs.indptr) > 0
    for k in range(begin.size - 1):
        if reached[begin[k] : begin[k + 1]].any():
            reached[rows[row[k] : row[k + 1]]] = True
    return rhs[reached].toarray(), np.where(reached, np.cumsum(reached) - 1, -1)


def _structure(factored):
    """Return the CHOLMOD `_Factor` to which the capsule of cvxopt points."""
    name, pointer = ctypes.pythonapi.PyCapsule_GetName, ctypes.pythonapi.PyCapsule_GetPointer
    name.restype, name.argtypes = ctypes.c_char_p, [ctypes.py_object]
    pointer.restype, pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    return _Factor.from_address(pointer(factored, name(factored)))


def _numbers(address, count, kind=ctypes.c_int64):
    """Return an array of `count` numbers at an address, without a copy."""
    return np.ctypeslib.as_array(ctypes.cast(address, ctypes.POINTER(kind)), shape=(count,))
