"""Spur gears: symmetric and antisymmetric motions about the middle plane, eliminated separately.

If all sections of a gear are equal, polynomials along the width couple by parity only. Motions of one parity in the section
couple with axial motions of the other parity, since ``d/dz`` changes the parity, and with loads of their parity. This gives two
problems with half the unknowns. Each takes an eighth of the work of the coupled problem.
"""

from dataclasses import replace

import numpy as np

from .elimination import carried_out, planned, starts


def front_by_parity(body, tree):
    """Return `elimination.front` of a body without twist whose functions along the width are Legendre polynomials."""
    plan, turn = planned(body, tree)
    ids = np.flatnonzero(body.stays & body.there)
    total = np.zeros((int(body.size[ids].sum()),) * 2)
    for parity in (0, 1):
        numbers, matrix = carried_out(_half(body, parity), plan, turn)
        at, real = _places(body, numbers, ids, parity)
        total[at[:, None], at] = matrix[np.ix_(real, real)]
    return ids, total


def _functions(count, parity):
    """Return the degrees below `count` along the width, of section and axial components. A missing degree is `count`."""
    out = np.full((2, (count + 1) // 2), count)
    for row, first in zip(out, (parity, 1 - parity), strict=True):
        degrees = np.arange(first, count, 2)
        row[: degrees.size] = degrees
    return out


def _half(body, parity):
    """Return the part of a body that has one parity in the section.

    All components must have the same number of functions. A component with one function less gets a dummy function of unit
    mass that is coupled to no other.
    """
    nodes = set(body.kind[: body.first_load].tolist())
    factors = {}
    for (row_kind, column_kind), factor in body.factors.items():
        padded = np.zeros((4, factor.shape[1] + 1, factor.shape[2] + 1))
        padded[:, :-1, :-1] = factor
        padded[0, -1, -1] = row_kind in nodes and column_kind in nodes
        (flat, axial), (flat_2, axial_2) = (_functions(n, parity) for n in factor.shape[1:])
        terms = ((0, flat, flat_2), (0, axial, axial_2), (1, flat, axial_2), (1, axial, flat_2))
        terms += ((2, flat, axial_2), (2, axial, flat_2), (3, flat, flat_2), (3, axial, axial_2))
        factors[row_kind, column_kind] = np.array([padded[k][np.ix_(rows, columns)] for k, rows, columns in terms])
    components = np.where(np.arange(body.size.size) < body.first_load, 3, 1)
    return replace(body, factors=factors, size=components * ((body.size // components + 1) // 2), parted=True)


def _places(body, found, ids, parity):
    """Return the indices of the unknowns of one parity (`found`) among those of `ids`, and a mask of existing ones."""
    start, at, real = starts(body, ids), [], []
    for number in found.tolist():
        node = number < body.first_load
        count = int(body.size[number]) // (3 if node else 1)
        flat, axial = _functions(count, parity)
        for k, functions in enumerate((flat, flat, axial) if node else (flat,)):
            at.append((start[number] + k * count + functions)[functions < count])
            real.append(functions < count)
    return np.concatenate(at), np.concatenate(real)
