"""Contact across a kink of a modified flank. The pressure has a peak there and differs from the Hertzian distribution."""

import numpy as np

from ..flexibility.hertz import half_width
from ..geometry.tooth.profile import arc_at
from .rows import hat_rows

REACH = 1.3  # Contacts within this distance of a kink are resolved by hat functions [half-widths at the whole load].
ZONE = 1.8  # half-length of the row [half-widths at the whole load]
FINEST, GROWTH = 5e-4, 0.5  # length of hat functions at a kink [m_n], and their growth per distance from it
WITHIN = 4.0  # hat functions per half width of the contact
STEEP = 20.0  # least number of hat functions over the contact width of a wedge with the kink's angle
SHALLOW = 1e-3  # kinks with a smaller slope need no shorter hat functions


def near_kink(contact, line_load):
    """Return whether a kink is within the contact, for each phase and pair of a `gearfe.contact.pair_contact.PairContact`."""
    points = contact.found
    out = np.zeros(points.gap.shape, dtype=bool)
    if contact.flanks is None:
        return out
    reach = REACH * half_width(line_load, contact.flat_radius, contact.modulus)
    for form, roll in zip(contact.flanks, points.rolls, strict=True):
        for kink, _ in form.kinks:
            out |= np.abs(arc_at(form.gear, roll) - arc_at(form.gear, kink)) < reach
    return out & np.isfinite(points.gap)


def kink_rows(contact, where, line_load):
    """`Row` of pairs of a `PairContact` around their touching points, by phase and column.

    A row is as long as Hertz's contact under the whole load, with margins. It stands on the flank that has the kink, one top on
    the kink itself, so that the other flank, which is smooth there, gives the normals. Pressure ends at the tip. `where`
    ``(n, 2)`` has the number of the phase and the column of each pair.
    """
    if not len(where):
        return {}
    i, column = where.T
    flat, touch = (half_width(line_load, radius[i, column], contact.modulus) for radius in (contact.flat_radius, contact.radius))
    host, middle, kink, slope = _nearest(contact, i, column)
    fine, out = min(flexible.fine for flexible in contact.flexibility), {}
    wedge = line_load / (contact.modulus * np.maximum(np.abs(slope), SHALLOW))  # approximate contact length of a ridge
    least = np.minimum(FINEST * contact.pair.gear_1.m_n, wedge / STEEP)
    for k, form in enumerate(contact.flanks):
        on_flank = np.flatnonzero(host == k)
        if on_flank.size:
            tip = float(arc_at(form.gear, form.gear.roll_a))
            cases = zip(kink[on_flank], middle[on_flank], touch[on_flank], flat[on_flank], least[on_flank], strict=True)
            knots = [_knots(*case, tip, fine) for case in cases]
            rows = hat_rows(contact, where[on_flank].tolist(), knots, [None] * on_flank.size, k, [(True, True)] * on_flank.size)
            out |= {(int(i[n]), int(column[n])): row for n, row in zip(on_flank, rows, strict=True)}
    return out


def _nearest(contact, i, column):
    """Return the kink nearest to each contact: gear, arcs of contact and kink [mm], and change of the flank direction."""
    out: list = []
    for host, form in enumerate(contact.flanks):
        gear, touch = form.gear, arc_at(form.gear, contact.found.rolls[host][i, column])
        for roll, step in form.kinks:
            turn = step * gear.r_b / max(roll, 1e-3 * gear.r_b)
            out.append(np.broadcast_arrays(host, touch, arc_at(gear, roll), turn))
    away = [np.abs(touch - kink) for _, touch, kink, _ in out]
    host, *rest = np.array(out)[np.argmin(away, axis=0), :, np.arange(i.size)].T
    return host.astype(int), *rest


def _knots(kink, middle, touch, flat, least, tip, fine):
    """Return start, top and end ``(3, n)`` of the hat functions [mm]. They are shortest at the kink.

    `touch` is the half width of the Hertzian contact where the flanks touch, `flat` the one next to it. `least` is the length of
    the shortest hat function. All hat functions are divided by `fine`.
    """
    ends, tops = (min(middle - ZONE * flat, kink), min(max(middle + ZONE * flat, kink), tip)), [kink]
    for sign, end in zip((-1, 1), ends, strict=True):
        at = kink
        while sign * (end - at) > least / 2:
            away = max(touch / WITHIN, GROWTH / 2 * (abs(at - middle) - touch))
            at += sign * min(least + GROWTH * abs(at - kink), away, flat / WITHIN) / fine
            tops.append(at)
    tops = np.sort(tops)
    tops = tops[tops < tip]
    return np.array([tops[:-2], tops[1:-1], tops[2:]])
