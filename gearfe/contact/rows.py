"""Contact of a tooth pair at corners of the outlines. The pressure is a row of hat functions with the exact gap at each.

At a tip corner, or at the edge of an undercut (form point), the pressure is not Hertzian. Hat functions are placed along the
profile of one gear, fillet included, and are shortest at every corner in contact. Corners of the other gear are placed where they
touch that profile. One row therefore also covers a tip in the mating fillet and the adjacent flank contact. The profile is that
of the gear with the first of the corners.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..flexibility.hats import TIP_ZONE
from ..flexibility.hertz import hat_logarithm
from ..flexibility.plane import towards
from ..geometry.aliases import Floats
from ..geometry.kept import keeping
from ..geometry.pair.contacts import TIP
from ..geometry.tooth.profile import arc_at, roll_at_arc
from ..geometry.tooth.side import on_fillet
from .directions import met

FINEST, LONGEST, GROWTH = 5e-4, 0.1, 0.5  # hat functions: length at a corner, largest length [m_n], growth per distance
RESOLVED = 4.0  # least number of hat functions per half-width at a corner; narrower contacts are not resolved
SHARP = 100.0  # hat functions at a corner per half-width of a smooth contact, because edge contact is narrower
LEAST = 7.5e-6  # length of the shortest hat function, if a half-width spans `RESOLVED` of them [m_n]
WITHIN = 4.0  # hat functions per Hertzian half-width where a Hertzian contact and a corner share a row


class HatRow(NamedTuple):
    """Hat functions of one row: positions on both gears [mm], gaps [mm] and mutual displacements [mm per N/mm].

    `turn_1`, `turn_2`: torque of a hat function's force on either gear, divided by the torque of the same force along the line
    of action.
    `fillet`: whether a hat function is in a fillet into which the mating tip presses.
    """

    roll_1: Floats
    roll_2: Floats
    gap: Floats
    influence: Floats
    turn_1: Floats
    turn_2: Floats
    fillet: NDArray[np.bool_]


class Wanted(NamedTuple):
    """Specification of a row of hat functions: phase number, column of the pair, its corners (bit n - 1: corner n of `Contacts`).

    `zone` is the length of the row beyond its corners [mm]. `finest` is the length of the hat functions next to these [mm], 0
    for the default. `width` is the half width [mm] of a Hertzian contact of the same pair away from the corners, 0 without one.
    """

    phase: int
    column: int
    corners: int
    zone: float
    finest: float = 0.0
    width: float = 0.0


@keeping(256)
def _offsets(m_n, fine, zone, finest=0.0):
    """Return distances ``(n,)`` [mm] of the tops of the hat functions from a corner, increasing from 0 to the end of its zone."""
    least, out = FINEST * m_n / fine, [0.0]
    least, growth = min(least, finest or least), GROWTH / fine
    while out[-1] < zone:
        out.append(out[-1] + min(least + growth * (out[-1] + least / 2), LONGEST * m_n / fine))
    return np.array(out)


def finest_hat(m_n, fine):
    """Length of the hat function next to a corner [mm]."""
    return float(_offsets(m_n, fine, TIP_ZONE * m_n)[1])


def _side_of(offsets, length):
    """Return offsets [mm] scaled so that the last one is half of `length`."""
    half = length / 2
    count = int(np.searchsorted(offsets, half))
    if count >= offsets.size:  # Outside the zone the steps are equal.
        step = offsets[-1] - offsets[-2]
        number = np.arange(1, max(2, int(np.ceil((half - offsets[-1]) / step)) + 1))
        offsets = np.append(offsets, offsets[-1] + number * (half - offsets[-1]) / number[-1])
        return offsets
    count = max(count, 1)
    return offsets[: count + 1] * half / offsets[count]


def _tops(marks, ends, offsets):
    """Return the tops of hat functions along increasing `marks` [mm]. Zones extend beyond marks that do not end the contact."""
    out = [marks[0] - offsets[:0:-1]] if not ends[0] else []
    out.append(marks[:1])
    for low, high in zip(marks[:-1], marks[1:], strict=True):
        away = _side_of(offsets, high - low)
        out += [low + away[1:], (high - away[-2::-1])]
    if not ends[1]:
        out.append(marks[-1] + offsets[1:])
    return np.concatenate(out)


def _apart(places, least, last):
    """Return increasing places without those closer than `least` [mm] to the previous one (with `last`: to the next one)."""
    away = np.diff(places) >= least * (1 - 1e-9)
    return places[np.append(away, True) if last else np.append(True, away)]


def _knots(tops, ends):
    """Return start, top and end ``(3, n)`` of the hat functions [mm]. Hat functions at an end of contact are one-sided."""
    start, stop = np.append(tops[0], tops[:-1]), np.append(tops[1:], tops[-1])
    knots = np.array([start, tops, stop])
    return knots[:, slice(None if ends[0] else 1, None if ends[1] else -1)]


def corner_rows(contact, wanted):
    """Return the `HatRow` of each `Wanted` of a `gearfe.contact.pair_contact.PairContact`."""
    out = [None] * len(wanted)
    for host in (0, 1):
        numbers = [k for k, request in enumerate(wanted) if _host(request) == host]
        if numbers:
            for k, row in zip(numbers, _on_side(contact, [wanted[k] for k in numbers], host), strict=True):
                out[k] = row
    return out


def _numbers(one):
    return [n for n in (1, 2, 3, 4) if one.corners >> (n - 1) & 1]


def _host(one):
    """Gear on which the hat functions of a row are defined: 0 for the pinion, 1 for the wheel."""
    return (_numbers(one)[0] - 1) % 2


def _on_side(contact, wanted, host):
    """Return the rows of hat functions on the side of gear `host`."""
    knots = [_placed(contact, request, host) for request in wanted]
    at = [(request.phase, request.column) for request in wanted]
    kernels = [_standing(contact, request, host)[1] if _alone(request) else None for request in wanted]
    tips = [[tip in _numbers(request) for tip in TIP] for request in wanted]
    return hat_rows(contact, at, knots, kernels, host, tips)


def hat_rows(contact, at, knots, kernels, host, tips):
    """Return the rows of hat functions of a `gearfe.contact.pair_contact.PairContact` on the profile of one gear.

    Parameters
    ----------
    at : sequence of (int, int)
        Number of the phase and column of the pair of each row.
    knots : sequence of ndarray, shape (3, n)
        Start, top and end of the hat functions on the arc of the side [mm].
    kernels : sequence of (ndarray, shape (n, n), or None)
        `gearfe.flexibility.hertz.hat_logarithm` of the knots, if it is known.
    host : int
        Whose side it is: 0 the pinion's, 1 the wheel's.
    tips : sequence of (bool, bool)
        Whether the tips of pinion and wheel may press into the mate's fillet.
    """
    points, pair = contact.found, contact.pair
    gear = pair.gears[host]
    count = [row.shape[1] for row in knots]
    at_hats = tuple(np.repeat(values, count) for values in np.array(at).T)
    roll = roll_at_arc(gear, np.concatenate([row.mean(axis=0) for row in knots]))
    gap, other, way = met(contact, at_hats, roll, host)
    values = np.array([*(roll, other)[:: (1, -1)[host]], gap, *way.turns, way.rate, *np.concatenate(way.parts)])
    cuts = np.cumsum(count)[:-1]
    meets = np.split(np.isfinite(gap), cuts)
    parts = [row[:, on] for row, on in zip(np.split(values, cuts, axis=1), meets, strict=True)]
    order = points.order[np.array(at)[:, 1]]
    sides = enumerate(zip(contact.flexibility, (1, -1), strict=True))
    bodies = [flexible.within([part[k] for part in parts], (sign * order).tolist()) for k, (flexible, sign) in sides]
    made, alike = [None] * len(parts), {}
    for k, tooth in enumerate(order.tolist()):
        alike.setdefault((tooth, parts[k].shape[1]), []).append(k)
    for (tooth, _), rows in alike.items():  # Rows with the same number of hat functions on one tooth are processed together.
        values = np.array([parts[k] for k in rows]).swapaxes(0, 1)
        kernel = np.array([_between(knots[k], kernels[k], meets[k]) for k in rows])
        smooth = [np.array([within[k] for k in rows]) for within in bodies]
        fields = _fields(contact, tooth, values, kernel, smooth, np.array([tips[k] for k in rows])[:, :, None], np.log(gear.m_n))
        for k, *row in zip(rows, *fields, strict=True):
            made[k] = HatRow(*row)
    return made


def _fields(contact, tooth, values, kernel, smooth, reach, size):
    """Return the fields of `HatRow` for rows on one tooth. `size` is the log range of the local field, about a module."""
    (roll_1, roll_2, gaps, *turns, rate), forces = values[:6], values[6:].reshape(2, 2, *values[0].shape)
    influence = sum(contact.coefficients) * (kernel + size) / (rate[:, :, None] * rate[:, None])
    for thin, placed in zip(contact.thinning, (roll_1, roll_2), strict=False):
        influence = influence + np.array([thin.between(one, tooth) for one in placed])
    leaning = zip(contact.flexibility, smooth, (roll_1, roll_2), (tooth, -tooth), forces, turns, strict=True)
    for coefficient, row in zip(contact.coefficients, leaning, strict=True):
        influence = influence + towards(*row, coefficient * size)
    gear_1, gear_2 = contact.pair.gears
    fillet = reach[:, 0] & on_fillet(gear_2, roll_2) | reach[:, 1] & on_fillet(gear_1, roll_1)
    return roll_1, roll_2, gaps, influence, *turns, fillet


def _between(knots, kernel, on):
    """Compute `gearfe.flexibility.hertz.hat_logarithm` between the knots selected by the mask `on`.

    `kernel` is the result for all knots, if it is known.
    """
    if kernel is None:
        return _logarithm(knots[:, on].tobytes())
    return kernel if on.all() else kernel[np.ix_(on, on)]


@keeping(512)
def _logarithm(data):
    """Return `gearfe.flexibility.hertz.hat_logarithm` of knots given as bytes. Gears that differ only by a crack share it."""
    knots = np.frombuffer(data).reshape(3, -1)
    return hat_logarithm(knots, knots)


def _alone(one):
    """Return whether a row has a single corner and no other contact, so that its hat functions have the standard arrangement."""
    return len(_numbers(one)) == 1 and not one.width


def _standing(contact, one, host):
    """Return the knots of a row that is `_alone`, measured from its corner, and the local influence between its hat functions."""
    (gear, fine), ends = _scale(contact, host), _ends(_numbers(one), host)
    return _alone_hats(gear.m_n, fine, one.zone, one.finest, ends)


@keeping(16)
def _alone_hats(m_n, fine, zone, finest, ends):
    knots = _knots(_tops(np.zeros(1), ends, _offsets(m_n, fine, zone, finest)), ends)
    return knots, hat_logarithm(knots, knots)


def _scale(contact, host):
    """Return the gear on whose profile a row is placed, and the factor by which its hat functions are shortened."""
    return contact.pair.gears[host], min(flexible.fine for flexible in contact.flexibility)


def _ends(numbers, host):
    """Return whether a row ends at its first corner, and whether it ends at its last corner.

    The gear's own tip is the upper end of a profile. The mating tip touches the lowest place in contact.
    """
    return 2 - host in numbers, 1 + host in numbers


def _placed(contact, one, host):
    """Return the knots ``(3, n)`` of the hat functions of a row, as arc lengths of the profile [mm]."""
    points, at = contact.found, (one.phase, one.column)
    gear, fine = _scale(contact, host)
    marks = {n: float(arc_at(gear, points.corner_roll[(host, n - 1, *at)])) for n in _numbers(one)}
    if _alone(one):
        return next(iter(marks.values())) + _standing(contact, one, host)[0]
    offsets, ends = _offsets(gear.m_n, fine, one.zone, one.finest), _ends(marks, host)
    low, high = marks.get(2 - host, -np.inf), marks.get(1 + host, np.inf)
    if low > high:  # Both tips overlap, so contact is at one of them.
        low = high = marks[1 + host]
    places = np.unique([min(max(mark, low), high) for mark in marks.values()])
    places = _apart(places, offsets[1], ends[1])
    if not one.width:
        return _knots(_tops(places, ends, offsets), ends)
    flanks = (points.roll_1[at], points.roll_2[at])
    if points.corner[at]:
        flanks = (points.nominal[at], contact.pair.mate_roll(points.nominal[at]))
    middle = float(arc_at(gear, flanks[host]))
    steps = middle + one.width / WITHIN * np.arange(-2 * WITHIN, 2 * WITHIN + 1)
    tops = _tops(np.unique([*places, middle]), ends, offsets)
    tops = np.append(tops[np.abs(tops - middle) > steps[-1] - middle], steps)
    least, most = places[0] if ends[0] else -np.inf, places[-1] if ends[1] else np.inf
    tops = np.sort(tops[(tops >= least) & (tops <= most)])
    return _knots(_apart(tops, offsets[1], ends[1]), ends)
