"""Approach at which the gears of a pair of finite width first touch."""

import math

import numpy as np

from ..geometry.pair.broken import each_pair, touching_each
from ..geometry.pair.modified import first_touch

FINE, ROUNDS = 9, 2  # sample points along the cell with the least gap; number of refinements


def least_gap(contact, found):
    """Return the approach at which the gears first touch ``(phases,)`` [mm]: the smallest gap of the `Cells` of each phase.

    The depth of pits is included only where flanks are modified.
    """
    cos = math.cos(contact.beta_b)
    gaps = [cells.gap - (cells.floor / cos if contact.flanks is None else 0.0) for cells in found]
    best = [int(np.argmin(gap)) for gap in gaps]
    if contact.flanks is None and max(abs(gap[k]) for gap, k in zip(gaps, best, strict=True)) < 1e-12 * contact.pair.p_bt:
        return np.zeros(len(found))
    names = ("half", "order", "nominal", "z", "width", "floor")
    half, order, nominal, z, width, floor = (
        np.array([getattr(c, n)[k] for c, k in zip(found, best, strict=True)]) for n in names
    )
    # The abscissa decreases by `slope` per mm of z.
    slope = math.tan(contact.beta_b) * np.sign([last - first for first, last in contact.bands])[half]
    low, high, gap = -width / 2, width / 2, np.zeros(0)
    for _ in range(ROUNDS):
        steps = np.linspace(low, high, FINE, axis=1)
        at = (nominal[:, None] - slope[:, None] * steps).ravel()
        orders = np.repeat(order, FINE)
        middle = np.repeat(z, FINE)  # a chip covers whole cells
        gap = touching_each(contact.pairs, orders, middle, at).gap
        if contact.flanks is not None:
            gap = _modified(contact, orders, at, gap, middle, (z[:, None] + steps).ravel())
        gap, rows = gap.reshape(-1, FINE), np.arange(order.size)
        least = np.argmin(gap, axis=1)
        low, high = steps[rows, np.maximum(least - 1, 0)], steps[rows, np.minimum(least + 1, FINE - 1)]
    return gap.min(axis=1) + (0.0 if contact.flanks is None else floor / cos)


def _modified(contact, orders, at, gap, middle, z):
    """Return the gaps of modified flanks at abscissae `at` and heights `z` [mm], from those of unmodified flanks."""
    found = each_pair(
        contact.pairs, orders, middle, lambda pair, on: first_touch(pair, contact.flanks, at[on], orders[on], gap[on], z[on])
    )
    return found.gap
