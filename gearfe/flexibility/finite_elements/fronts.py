"""Forward solutions by a multifrontal factorisation that keeps no factor.

CHOLMOD analyses the graph of the nodes and gives the supernodes. Each supernode is eliminated from a dense front, at once
for the matrix and for all right-hand sides. Its block of the factor is then dropped. The memory is that of the matrix and
of the fronts that wait for their parent. Sections keep their factor, because `supernodes.gram` takes 0.84 of the time there.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dsyrk, dtrsm
from scipy.linalg.lapack import dpotrf
from scipy.sparse import coo_array, csc_array, csr_array

from .supernodes import structure

CHUNK = 64  # columns of a front that are added together


def gram(analysed: object, lower: csc_array, rhs: csr_array, node: int) -> NDArray:
    """Return ``F' K^-1 F`` for sparse right-hand sides F ``(n, k)``.

    Parameters
    ----------
    analysed
        Symbolic factor of cvxopt of the graph of the nodes.
    lower : csc_array, shape (n, n)
        Lower triangle of K.
    node : int
        Number of unknowns of a node, which follow each other.

    Raises
    ------
    RuntimeError
        If the matrix is not positive definite.

    References
    ----------
    I. S. Duff, J. K. Reid, ACM Trans. Math. Softw. 9 (1983) 302-325.
    """
    begin, members, permutation = structure(analysed)
    order = (node * permutation[:, None] + np.arange(node)).ravel()
    matrix = _permuted(lower, order)
    half, place_of = _reached(rhs[order], begin, members, node)
    waiting: dict[int, list] = {}
    owner = np.repeat(np.arange(len(members)), np.diff(begin))  # supernode of each node
    where, out = np.zeros(permutation.size, dtype=np.int64), np.zeros((rhs.shape[1],) * 2)
    for k, nodes in enumerate(members):
        width = int(begin[k + 1] - begin[k])
        where[nodes] = np.arange(nodes.size)
        first, left = node * width, node * (nodes.size - width)
        blocks = tuple(np.zeros(shape, order="F") for shape in ((first, first), (left, first), (left, left)))
        children = sorted(waiting.pop(k, ()), key=lambda one: -one[0].size)
        for i, (others, part) in enumerate(children):
            _add(blocks, part, (node * where[others][:, None] + np.arange(node)).ravel(), i == 0)
        _add_matrix(blocks, matrix, slice(node * begin[k], node * begin[k + 1]), where, node)
        own, across, rest = blocks
        own, failed = dpotrf(own, lower=1, clean=0, overwrite_a=1)
        if failed:
            raise RuntimeError("the stiffness matrix is not positive definite: the body is not held")
        if nodes.size > width:
            across = dtrsm(1.0, own, across, side=1, lower=1, trans_a=1, overwrite_b=1)
            rest = dsyrk(-1.0, across, beta=1.0, c=rest, lower=1, overwrite_c=1)
            waiting.setdefault(int(owner[nodes[width]]), []).append((nodes[width:], rest))
        if (first := place_of[nodes[0]]) >= 0:
            _forward(own, across, half[first : first + own.shape[0]], half, place_of[nodes[width:]], out)
    return out


def _permuted(lower, order):
    """Return the lower triangle of the matrix in another order of its unknowns."""
    number = np.empty(order.size, dtype=lower.indices.dtype)
    number[order] = np.arange(order.size, dtype=number.dtype)
    row, column = number[lower.indices], np.repeat(number, np.diff(lower.indptr))
    turned = row < column
    row[turned], column[turned] = column[turned], row[turned]
    return coo_array((lower.data, (row, column)), shape=lower.shape).tocsc()


def _reached(rhs, begin, members, node):
    """Return the right-hand sides at the nodes that loads reach, and the first row of each node in them (-1: absent)."""
    reached = (np.diff(rhs.indptr) > 0).reshape(-1, node).any(axis=1)
    for k, nodes in enumerate(members):
        if reached[begin[k] : begin[k + 1]].any():
            reached[nodes] = True
    return rhs[np.repeat(reached, node)].toarray(), np.where(reached, node * (np.cumsum(reached) - 1), -1)


def _add_matrix(blocks, matrix, columns, where, node):
    """Add the columns of a supernode to its own block of the front and to the coupling with its other unknowns."""
    span, (own, across, _) = slice(matrix.indptr[columns.start], matrix.indptr[columns.stop]), blocks
    first, rows, values = own.shape[0], matrix.indices[span], matrix.data[span]
    column = np.repeat(np.arange(first), np.diff(matrix.indptr[columns.start : columns.stop + 1]))
    place = node * where[rows // node] + rows % node
    inside = place < first
    own[place[inside], column[inside]] += values[inside]
    across[place[~inside] - first, column[~inside]] += values[~inside]


def _add(blocks, part, at, empty):
    """Add the lower triangle of `part` at the rows and columns `at` of a front, which increase. The front may be `empty`."""
    own, across, rest = blocks
    cut = int(np.searchsorted(at, own.shape[0]))
    inner, outer = at[:cut], at[cut:] - own.shape[0]
    for target, rows, columns, values in (
        (own, inner, inner, part[:cut, :cut]), (across, outer, inner, part[cut:, :cut]), (rest, outer, outer, part[cut:, cut:])
    ):  # fmt: skip
        if values.size:
            _scatter(target, rows, columns, values, empty)


def _scatter(target, rows, columns, values, empty):
    """Add `values` at rows and columns of `target`. If these are the same, only the lower triangle is needed."""
    for start in range(0, columns.size, CHUNK):
        part, first = slice(start, start + CHUNK), start if rows is columns else 0
        if empty:  # faster than a sum
            target.T[columns[part, None], rows[first:]] = values[first:, part].T
        else:
            target.T[columns[part, None], rows[first:]] += values[first:, part].T


def _forward(own, across, side, half, others, out):
    """Solve the forward substitution of a supernode for its right-hand sides `side`, and pass it on to the nodes `others`."""
    reached = np.flatnonzero(side.any(axis=0))
    if not reached.size:
        return
    columns = slice(reached[0], reached[-1] + 1)
    solved = dtrsm(1.0, own, np.asfortranarray(side[:, columns]), lower=1, overwrite_b=1)
    out[columns, columns] += solved.T @ solved
    if others.size:
        node = across.shape[0] // others.size
        rows = (others[:, None] + np.arange(node)).ravel()
        half[rows, columns] -= across @ solved
