"""Contact across a kink of a modified flank: pressure concentrates there, and no parabola of Hertz describes it."""

import numpy as np

from geometry.tooth.profile import arc_at, roll_at_arc
from geometry.tooth.side import on_fillet

from ..flexibility.hertz import half_width, hat_logarithm
from .rows import Row
from .sharing import share

REACH = 1.3  # a contact with a kink within so many half widths of the whole load is resolved hat by hat
HATS = 19
ZONE = 1.8  # half length of the row, in half widths of the whole load
STEEP = 0.3  # where a wedge with the kink's angle would touch over less than this part of the half width, the row is fitted
PARTS = 0.45, 0.95  # of its length, what of a fitted row is to be loaded at least and at most


def near_kink(contact, line_load):
    """For each phase and pair of a `gearfe.contact.plane.PairContact`: whether a kink lies within its contact."""
    found = contact.found
    out = np.zeros(found.gap.shape, dtype=bool)
    if contact.flanks is None:
        return out
    reach = REACH * half_width(line_load, contact.flat_radius, contact.modulus)
    for form, roll in zip(contact.flanks, (found.roll_1, found.roll_2), strict=True):
        for kink, _ in form.kinks:
            out |= np.abs(arc_at(form.gear, roll) - arc_at(form.gear, kink)) < reach
    return out & np.isfinite(found.gap)


def kink_rows(contact, where, line_load):
    """Unknowns of pairs as rows of hats around their touching points, as of `PairContact`.

    A row is as long as Hertz's contact under the whole load, with margins. Where kink and load make the contact much shorter, or
    a hollow kink makes it longer, it is fitted to what the whole load presses. One top stands on the kink; pressure ends at tip
    corners and form points.

    Parameters
    ----------
    contact : PairContact
    where : ndarray, shape (n, 2)
        Number of the phase and column of the pair.
    line_load : float
        [N/mm].

    Returns
    -------
    dict of (int, int) to gearfe.contact.rows.Row
        By phase and column.
    """
    if not len(where):
        return {}
    i, column = where.T
    gear, found = contact.pair.gear_1, contact.found
    middle = arc_at(gear, found.roll_1[i, column])
    width = half_width(line_load, contact.flat_radius[i, column], contact.modulus)
    arcs, slopes = _kinks(contact)
    nearest = np.argmin(np.abs(arcs - middle[:, None]), axis=1)
    kink, slope = arcs[nearest], slopes[nearest]
    rows = _hats(contact, i, column, _tops(middle, ZONE * width, kink))
    fit = (slope < 0) | (line_load < STEEP * width * contact.modulus * slope / 2)
    for n in np.flatnonzero(fit).tolist():
        rows[n] = _fitted(contact, where[n : n + 1], rows[n], line_load, middle[n], ZONE * width[n], kink[n])
    return {(int(a), int(b)): row for (a, b), row in zip(where, rows, strict=True)}


def _kinks(contact):
    """Arcs on the pinion [mm] of the kinks of both flanks, and by how much the flank turns there."""
    pair, (one, two) = contact.pair, contact.flanks
    rolls = [(roll, roll, step, one.gear) for roll, step in one.kinks]
    rolls += [(pair.outward * (pair.length - roll), roll, step, two.gear) for roll, step in two.kinks]
    arcs = np.array([arc_at(one.gear, max(roll, 0.0)) for roll, _, _, _ in rolls])
    return arcs, np.array([step * gear.r_b / max(own, 1e-3 * gear.r_b) for _, own, step, gear in rolls])


def _fitted(contact, where, row, line_load, middle, half, kink):
    gear = contact.pair.gear_1
    low, high = sorted(float(arc_at(gear, roll)) for roll in (gear.roll_f, gear.roll_a))
    for _ in range(8):
        pressed = row.roll_1[share(row.influence, row.gap, line_load)[0] > 0]
        ends = arc_at(gear, pressed[[0, -1]])
        used = np.abs(ends - middle).max() / half
        if used < PARTS[0] and pressed.size < HATS // 3:
            half *= max(1.6 * used, 0.2)
        elif used > PARTS[1] and ends[0] > low + half / HATS and ends[1] < high - half / HATS:
            half *= 1.6
        else:
            break
        row = _hats(contact, *where.T, _tops(np.array([middle]), np.array([half]), np.array([kink])))[0]
    return row


def _tops(middle, half, kink):
    """Tops of the hats ``(n, HATS)``, one on the kink, and their distance ``(n,)``."""
    step = 2 * half / (HATS + 1)
    first = kink + np.round((middle - half - kink) / step) * step
    return first[:, None] + np.arange(1, HATS + 1) * step[:, None], step


def _hats(contact, i, column, tops):
    """`Row` of each pair."""
    pair, found = contact.pair, contact.found
    (arc, step), order = tops, found.order[column]
    roll_1 = roll_at_arc(pair.gear_1, arc)
    own = {"start": found.gap[i, column][:, None], "flanks": contact.flanks, "order": order[:, None]}
    gap, roll_2 = pair.approach(roll_1, found.nominal[i, column][:, None], **own)
    there = np.isfinite(roll_2)
    for gear, roll in ((pair.gear_1, roll_1), (pair.gear_2, roll_2)):
        there &= gear.outward * (gear.roll_a - roll) > 0
    bulk = np.zeros((*arc.shape, HATS))
    for flexible, roll, sense in zip(contact.flexibility, (roll_1, roll_2), (1, -1), strict=True):
        place = arc_at(flexible.gear, np.where(there, roll, roll[there].mean()))
        smooth = np.zeros(arc.shape)
        for k in np.unique(order).tolist():
            own = order == k
            smooth[own] = flexible.matrix(roll_at_arc(flexible.gear, place[own])[..., None], [sense * k])[..., 0, 0]
        bulk += (smooth[:, :, None] + smooth[:, None, :]) / 2  # S at the middle of two places: it is straight over a contact
    unit = np.arange(HATS, dtype=float)
    even = sum(contact.coefficients) * hat_logarithm(np.array([unit - 1, unit, unit + 1]), np.array([unit - 1, unit, unit + 1]))
    rows = []
    for n in range(len(arc)):
        on = there[n]
        influence = bulk[n] + even - sum(contact.coefficients) * np.log(step[n])
        one = np.ones(on.sum())
        fillet = on_fillet(pair.gear_1, roll_1[n, on]) | on_fillet(pair.gear_2, roll_2[n, on])
        rows.append(Row(roll_1[n, on], roll_2[n, on], gap[n, on], influence[np.ix_(on, on)], one, one, fillet))
    return rows
