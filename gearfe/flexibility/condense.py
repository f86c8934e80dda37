"""Static condensation of bodies of many elements to a few unknowns, by nested halves of the elements.

With unknowns u to be eliminated, unknowns b that stay, and columns F of loads, the result is::

    [[K_bb, F_b], [F_b', 0]] - [[K_bu], [F_u']] K_uu^-1 [[K_ub, F_u]]

The block of the loads is minus their displacements under each other, with b held. The method is Cholesky factorisation of small
dense matrices with forward substitution only, so that no displacement field is computed.

A *front* contains the unknowns that a set of elements shares with the rest, in the order of elimination, and a lower triangle.
The unknowns eliminated first come first, so lower triangles add up to lower triangles.
"""

import math

import numpy as np
from scipy.linalg.blas import dsyrk, dtrsm
from scipy.linalg.lapack import dpotrf


def condense(local, dofs, centre, load, stays, held=(), *, leaf):
    """Reduce a body of elements to the kept unknowns and its loads.

    Parameters
    ----------
    local : ndarray, shape (m, k, k)
        Symmetric stiffness matrices of the elements.
    dofs : ndarray of int, shape (m, k)
        Their unknowns.
    centre : ndarray, shape (2, m)
        Where the elements are, in coordinates in which to halve them.
    load : scipy.sparse.coo_array, shape (n, loads)
        Forces on the n unknowns, by column.
    stays, held : ndarray of int
        Unknowns that stay, in the order wanted, and unknowns that are zero.
    leaf : int
        Least number of elements assembled at once, at least 2; at most twice as many are.

    Returns
    -------
    ndarray, shape (stays + loads, stays + loads)
        See the module.

    Raises
    ------
    RuntimeError
        If the body deforms without force, because its elements fold.

    References
    ----------
    A. George, SIAM J. Numer. Anal. 10 (1973) 345-363, on nested dissection.
    """
    n, columns = load.shape
    sets = _halved(centre, leaf)
    height = len(sets).bit_length() - 1
    part = np.empty(dofs.shape[0], dtype=np.int64)
    part[np.concatenate(sets)] = np.repeat(np.arange(len(sets)), [elements.size for elements in sets])
    number, first, turns = _numbered(dofs, part, n, stays, held, height)
    total = n + 1 + columns  # number of all indices: unknowns, loads, and n for those that are held
    of_part = first[load.coords[0]].astype(np.min_scalar_type(len(sets)))  # Short integers are sorted several times as fast.
    by_part = np.argsort(of_part, kind="stable")
    at, column, force = number[load.coords[0][by_part]], n + 1 + load.coords[1][by_part], load.data[by_part]
    ends = np.append(0, np.cumsum(np.bincount(of_part, minlength=len(sets))))
    place = np.empty(total, dtype=np.int64)
    stop = np.searchsorted(turns, np.arange((height + 1) << height), side="right").tolist()  # last number of each turn
    fronts = []
    for k, elements in enumerate(sets):
        brought = slice(ends[k], ends[k + 1])
        made = _put_together(local[elements], number[dofs[elements]], (at[brought], column[brought], force[brought]), n, place)
        fronts.append(_eliminated(*made, stop[k]))
    for level in range(1, height + 1):
        pairs = zip(fronts[::2], fronts[1::2], strict=True)
        fronts = [_eliminated(*_joined(*pair), stop[(level << height) + k]) for k, pair in enumerate(pairs)]
    return _filled(*fronts[0], np.concatenate([number[stays], n + 1 + np.arange(columns)]), place)


def _halved(centre, leaf):
    """Bisect the elements repeatedly across their longer extent, into 2**n sets of nearly equal size."""
    sets = [np.arange(centre.shape[1])]
    for _ in range(max(0, math.floor(math.log2(centre.shape[1] / leaf)))):
        halves = []
        for elements in sets:
            spread = centre[:, elements]
            ranked = elements[np.argsort(spread[np.argmax(spread.max(axis=1) - spread.min(axis=1))], kind="stable")]
            halves += [ranked[: elements.size // 2], ranked[elements.size // 2 :]]
        sets = halves
    return sets


def _numbered(dofs, part, n, stays, held, height):
    """Return the new numbers of the unknowns (n if held), the first set that contains each, and the ascending elimination order.

    The sets of elements form a binary tree. An unknown belongs to the smallest node of the tree that contains all its
    elements. Its position in the order is the level of that node, then the number of the node on this level.
    """
    first, last = np.full(n, part.max(initial=0) + 1), np.zeros(n, dtype=np.int64)
    part_of = np.broadcast_to(part[:, None], dofs.shape)
    np.minimum.at(first, dofs, part_of)
    np.maximum.at(last, dofs, part_of)
    level = np.ceil(np.log2((np.minimum(first, last) ^ last) + 1)).astype(np.int64)
    turn = (level << height) + (first >> level)
    turn[stays] = (height + 1) << height
    order = np.argsort(turn.astype(np.min_scalar_type((height + 1) << height)), kind="stable")
    turns = turn[order]
    number = np.empty(n, dtype=np.int64)
    number[order] = np.arange(n)
    number[np.asarray(held, dtype=np.int64)] = n
    return number, first, turns


def _put_together(local, numbers, loads, n, place):
    """Assemble the stiffness of a few elements and the loads ``(unknown, load, force)``. Return unknowns and dense matrix."""
    at, column, force = loads
    present = np.zeros(place.size, dtype=bool)
    present[numbers], present[column], present[n] = True, True, False
    ids = present.nonzero()[0]
    size = ids.size + 1  # Held unknowns are put into a last row and column, which are dropped.
    place[ids], place[n] = np.arange(ids.size), ids.size
    rows = place[numbers]
    where = [(rows[:, :, None] * size + rows[:, None, :]).ravel(), place[at] * size + place[column]]
    summed = np.bincount(np.concatenate(where), np.append(local.ravel(), force), minlength=size**2)
    return ids, summed.reshape(size, size)[:-1, :-1].T


def _joined(one, two):
    """Assemble the fronts of two adjacent sets of elements."""
    ids = np.concatenate([one[0], two[0]])
    ids.sort()
    ids = ids[np.append(True, ids[1:] > ids[:-1])]  # For few values `numpy.unique` takes five times as long.
    total = np.zeros((ids.size,) * 2)
    for numbers, matrix in (one, two):
        at = np.searchsorted(ids, numbers)
        total[at] += _widened(matrix, at, ids.size)
    return ids, total.T


def _widened(matrix, at, size):
    """Return the transpose of a square matrix, with its columns placed `at` their positions among `size` columns."""
    out = np.zeros((matrix.shape[0], size))
    out.T[at] = matrix
    return out


def _eliminated(ids, matrix, stop):
    """Eliminate the unknowns with numbers below `stop` from a front, and return the rest."""
    gone = int(ids.searchsorted(stop))
    if not gone:
        return ids, matrix
    parts = (np.array(part, order="F") for part in (matrix[:gone, :gone], matrix[gone:, :gone], matrix[gone:, gone:]))
    return ids[gone:], without(*parts)


def without(inside, across, rest):
    """Return ``rest - across inside**-1 across'``, lower triangles, by Cholesky and forward substitution.

    The arrays are in Fortran order and are overwritten. RuntimeError if `inside` is not positive definite.
    """
    lower, failed = dpotrf(inside, lower=1, clean=0, overwrite_a=1)
    if failed:
        raise RuntimeError("the triangles of the section fold or nearly do, or are unsupported: change refine slightly")
    if not rest.size:
        return rest
    across = dtrsm(1.0, lower, across, side=1, lower=1, trans_a=1, overwrite_b=1)
    return dsyrk(-1.0, across, beta=1.0, c=rest, lower=1, overwrite_c=1)


def _filled(ids, matrix, wanted, place):
    """Return the matrix of a front between the numbers `wanted`, with zeros for missing numbers."""
    out = np.zeros((wanted.size,) * 2)
    place[wanted] = np.arange(wanted.size)
    whole, at = np.where(np.tri(*matrix.shape, dtype=bool), matrix, matrix.T), place[ids]
    out[at] = _widened(whole, at, wanted.size)
    return out
