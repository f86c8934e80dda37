"""Hat function pressures along a loaded flank: their lengths, and the lengths next to the tip corner.

Finite elements load all of a flank by them, the energy model only the part next to the tip corner, where contact is resolved
hat function by hat function (`gearfe.contact.pair_contact`).
"""

import numpy as np
from numpy.typing import NDArray

SPAN = 2  # element edges on either side of a hat function's peak; its kinks coincide with edge ends
TIP_ZONE = 0.35  # arc below the tip corner [m_n] in which single hat functions can resolve a contact


def hat_knots(arc: NDArray, *, corner: bool = False) -> NDArray:
    """Start, top and end ``(3, n)`` [mm] of hat functions over the edges of a flank, with a top on every `SPAN`-th inner node.

    Parameters
    ----------
    arc : ndarray, shape (m,)
        Ends of the edges along the flank, from root to tip [mm].
    corner : bool
        Add a last, one-sided hat function with its top at the tip corner.
    """
    knots = np.array([arc[: -2 * SPAN : SPAN], arc[SPAN:-SPAN:SPAN], arc[2 * SPAN :: SPAN]])
    return np.column_stack([knots, [arc[-1 - SPAN], arc[-1], arc[-1]]]) if corner else knots


def wider(knots: NDArray) -> NDArray:
    """Weights ``(n, n)`` that combine hat functions of unit resultant ``(3, n)`` into hat functions twice as wide.

    The first and the last stay.

    A hat function whose top is at knot i, and whose ends are two knots away, is a sum of the three hat functions between. Each
    hat function must start at the top of the previous one and end at the top of the next one.
    """
    start, top, stop = knots
    rise, fall = (start[1:-1] - start[:-2]) / (top[1:-1] - start[:-2]), (stop[2:] - stop[1:-1]) / (stop[2:] - top[1:-1])
    area, inner = (stop - start) / 2, np.arange(1, top.size - 1)
    weights = np.diag(area)
    weights[inner, inner - 1], weights[inner, inner + 1] = rise * area[:-2], fall * area[2:]
    return weights / weights.sum(axis=1, keepdims=True)
