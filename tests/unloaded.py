"""Gaps of `gearfe.geometry.pair.contacts` without load compared with those of whole outlines, where either is near contact.

The rows of the frozen page `outlines_unloaded` and of its table are those of `one_pair`.
"""

import math
import warnings

import numpy as np

from gearfe.geometry.pair.modified import flank_contacts
from validation.shared.arbiter.cases import PHASES, random_pair
from validation.shared.arbiter.outline import Outline
from validation.shared.arbiter.touching import Press, orders, stand, touching
from validation.shared.places import TABLES

NEAR = 3e-3  # mm
TABLE = TABLES / "outlines_unloaded.csv"
FIELDS = ("seed", "pair", "rows", "largest_difference_um", "phase_48", "order", "gearfe_um", "arbiter_um", "touches", "refused")
LIMIT = 0.05  # um


def gaps(pair, flanks=None, phases=PHASES):
    """Gaps [mm] of all neighbouring tooth pairs, ``(phases, orders)``, the orders, and the `Touch` they come from."""
    flanks = flanks or (None, None)
    press = Press(pair, [Outline(gear, flank) for gear, flank in zip((pair.gear_1, pair.gear_2), flanks, strict=True)])
    order = np.unique(np.concatenate([orders(pair, min(phases)), orders(pair, max(phases))]))
    where, tooth = (axis.ravel() for axis in np.meshgrid(phases, order, indexing="ij"))
    touch = touching(press, stand(pair, where, tooth))
    return touch.gap.reshape(len(phases), order.size), order, touch


def compared(pair, flanks=None, phases=PHASES, near=NEAR):
    """Rows (phase, order, gap of gearfe, gap of the arbiter [um], whose piece touches) where either is below `near` [mm]."""
    truth, order, touch = gaps(pair, flanks, phases)
    forms = (
        None if flanks is None else tuple(flank.on(gear) for flank, gear in zip(flanks, (pair.gear_1, pair.gear_2), strict=True))
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        known = flank_contacts(pair, phases, flanks=forms)
    mine = np.full(truth.shape, np.inf)
    for i, number in enumerate(order):
        if number in known.order:
            mine[:, i] = known.gap[:, int(np.flatnonzero(known.order == number)[0])]
    best = np.argmin(touch.approach, axis=0).reshape(truth.shape)
    rows = []
    for i, j in zip(*np.nonzero((truth < near) | (mine < near)), strict=True):
        whose = f"{('pinion', 'wheel')[touch.gear[best[i, j]]]} {touch.piece[best[i, j]]}"
        rows.append((float(phases[i]), int(order[j]), 1e3 * float(mine[i, j]), 1e3 * float(truth[i, j]), whose))
    return rows


def unloaded(seeds, phases=PHASES):
    """Rows ``(seed, pair, phase, order, gap of gearfe, gap of the arbiter [um], touching piece)`` of the pairs of `seeds`.

    Seeds whose gears do not exist are left out; one row with phase nan and the reason says that gearfe refused a pair's contacts.
    """
    for seed in seeds:
        try:
            pair, flanks = random_pair(seed)
            Outline(pair.gear_1, None if flanks is None else flanks[0])
            Outline(pair.gear_2, None if flanks is None else flanks[1])
        except ValueError:
            continue
        name = f"{pair.gear_1.z}/{pair.gear_2.z}{' ring' if pair.gear_2.internal else ''}"
        try:
            yield from ((seed, name, *row) for row in compared(pair, flanks, phases))
        except ValueError as error:
            yield seed, name, math.nan, 0, math.nan, math.nan, str(error)


def one_pair(rows):
    """Row of the table from all of one pair, as `unloaded` gives them."""
    seed, name, phase, *_, last = rows[0]
    if math.isnan(phase):
        return dict(zip(FIELDS, [seed, name, 0, *[""] * 6, last], strict=True))
    apart = [0.0 if row[4] == row[5] else abs(row[4] - row[5]) for row in rows]
    _, _, phase, order, mine, truth, piece = rows[int(np.argmax(apart))]
    numbers = [f"{max(apart):.3g}", round(48 * phase), order, f"{mine:.6g}", f"{truth:.6g}"]
    return dict(zip(FIELDS, [seed, name, len(rows), *numbers, piece, ""], strict=True))
