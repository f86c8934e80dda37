"""Contact across a kink of a modified flank: pressure concentrates there, and no parabola of Hertz describes it."""

import numpy as np

from geometry.pair.contacts import approach
from geometry.tooth.profile import arc_at, roll_at_arc
from geometry.tooth.side import on_fillet

from ..flexibility.hertz import half_width, hat_logarithm
from ..flexibility.plane import towards
from .rows import Row, along_and_across
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
    kink, slope, driver = arcs[nearest], slopes[nearest], nearest < len(contact.flanks[0].kinks)
    rows = _hats(contact, i, column, _tops(middle, ZONE * width, kink), driver)
    fit = (slope < 0) | (line_load < STEEP * width * contact.modulus * slope / 2)
    for n in np.flatnonzero(fit).tolist():
        rows[n] = _fitted(contact, where[n : n + 1], rows[n], line_load, middle[n], ZONE * width[n], kink[n], driver[n : n + 1])
    return {(int(a), int(b)): row for (a, b), row in zip(where, rows, strict=True)}


def _kinks(contact):
    """Arcs on the pinion [mm] of the kinks of both flanks, and by how much the flank turns there."""
    pair, (one, two) = contact.pair, contact.flanks
    rolls = [(roll, roll, step, one.gear) for roll, step in one.kinks]
    rolls += [(pair.outward * (pair.length - roll), roll, step, two.gear) for roll, step in two.kinks]
    arcs = np.array([arc_at(one.gear, max(roll, 0.0)) for roll, _, _, _ in rolls])
    return arcs, np.array([step * gear.r_b / max(own, 1e-3 * gear.r_b) for _, own, step, gear in rolls])


def _fitted(contact, where, row, line_load, middle, half, kink, driver):
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
        row = _hats(contact, *where.T, _tops(np.array([middle]), np.array([half]), np.array([kink])), driver)[0]
    return row


def _tops(middle, half, kink):
    """Tops of the hats ``(n, HATS)``, one on the kink, and their distance ``(n,)``."""
    step = 2 * half / (HATS + 1)
    first = kink + np.round((middle - half - kink) / step) * step
    return first[:, None] + np.arange(1, HATS + 1) * step[:, None], step


def _hats(contact, i, column, tops, driver):
    """`Row` of each pair; `driver` (n,) says whether its kink is on the pinion, whose points then meet the wheel's flank."""
    pair, found = contact.pair, contact.found
    (arc, step), order = tops, found.order[column]
    roll_1 = roll_at_arc(pair.gear_1, arc)
    own = {"start": found.gap[i, column][:, None], "flanks": contact.flanks, "order": order[:, None]}
    gap, roll_2, *directions = approach(pair, roll_1, found.nominal[i, column][:, None], **own)
    if not driver.all():
        back = approach(pair, roll_2, found.nominal[i, column][:, None], driver=False, **own | {"start": gap})[2:]
        directions = [np.where(driver[:, None], *both) for both in zip(directions, (back[k] for k in (1, 0, 3, 2)), strict=True)]
    there = np.isfinite(roll_2) & np.isfinite(directions[0])
    for gear, roll in ((pair.gear_1, roll_1), (pair.gear_2, roll_2)):
        there &= gear.outward * (gear.roll_a - roll) > 0
    unit = np.arange(HATS, dtype=float)
    even = hat_logarithm(np.array([unit - 1, unit, unit + 1]), np.array([unit - 1, unit, unit + 1]))
    log, rows = np.log(pair.gear_1.m_n), []  # local is what happens within about a module
    for n, on in enumerate(there):
        arms, out = (np.array(directions[k : k + 2])[:, n, on] for k in (0, 2))
        rate, rolls = arms.mean(axis=0), (roll_1[n, on], roll_2[n, on])
        influence = sum(contact.coefficients) * (even[np.ix_(on, on)] - np.log(step[n]) + log) / np.outer(rate, rate)
        cases = zip(contact.flexibility, contact.coefficients, rolls, (1, -1), arms, out, strict=True)
        for flexible, coefficient, roll, sense, arm, away in cases:
            tooth = sense * int(order[n])
            smooth = flexible.matrix(roll[:, None], [tooth])[:, 0, 0]
            between = (smooth[:, None] + smooth) / 2  # S at the middle of two places: it is straight over a contact
            force = along_and_across(flexible.gear, roll, arm, away) / rate
            influence = influence + towards(flexible, between, roll, tooth, force, arm / rate, coefficient * log)
        fillet = on_fillet(pair.gear_1, rolls[0]) | on_fillet(pair.gear_2, rolls[1])
        rows.append(Row(*rolls, gap[n, on], influence, *(arms / rate), fillet))
    return rows
