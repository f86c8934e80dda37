"""Pieces of the contact lines of one phase: parts outside pits (`geometry.pair.lines`), and parts where corners may touch.

On the path of contact a line runs across both flanks. Outside the path, a corner of
one gear may still touch the profile of the other. Its gap follows exactly from the kinematics of the section
 (`gearfe.geometry.pair.contacts.contacts`).
"""

import math
from itertools import product
from typing import NamedTuple

import numpy as np

from ..geometry.kept import keeping
from ..geometry.pair.broken import ToothPairs, touching_each
from ..geometry.pair.contacts import FORM, end_corners, near_pitches, touching
from ..geometry.pair.lines import covered

SAMPLES = 400  # samples of the gap beyond the path per base pitch
PARTS = 4  # straight segments of a line beyond the path, in each of which pits are searched


class Piece(NamedTuple):
    """Part of a contact line between two depths [mm].

    `roll` is the abscissa of its line at depth 0 [mm]. `ends` states for its first and last end whether the contact ends there,
    which raises the pressure. `Cells` describes `corner` and `floor`.
    """

    half: int
    order: int
    roll: float
    corner: int
    first: float
    last: float
    ends: tuple
    floor: float = 0.0


@keeping(64)
def gaps(pair):
    """Return distances beyond the path [mm], before its start and after its end, and the smallest gap from there outwards.

    If the flanks do not touch at the end of the path itself, gaps start where a corner first meets the mating gear.
    """
    start, end = pair.path
    out = []
    for sense, at, pitches in zip((-1, 1), (start, end), near_pitches(pair), strict=True):
        away = np.linspace(0.0, pitches * pair.p_bt, pitches * SAMPLES) + 1e-6 * pair.p_bt
        gap = touching(pair, at + sense * away)[2]
        met = np.flatnonzero(np.isfinite(gap))
        first = met[0] if met.size else gap.size
        # First contact lies between two samples, so the gap at the previous sample is an upper bound.
        if 0 < first < gap.size - 2:
            first -= 1
            gap[first] = max(2 * gap[first + 1] - gap[first + 2], 0.0)
        span = slice(first, met[-1] + 1 if met.size else gap.size)
        out.append((away[span], np.minimum.accumulate(gap[span][::-1])[::-1]))
    return out


@keeping(64)
def cut(pair):
    """Return the lengths at start and end of the path [mm] over which a tip cuts into the mating fillet, or 0."""
    start, end = pair.path
    nominal = np.linspace(start, end, max(2, math.ceil(pair.eps_alpha * SAMPLES)))
    met, step = touching(pair, nominal), nominal[1] - nominal[0]
    away = nominal - start, end - nominal
    return tuple(max((own[(met.gap < 0) & (own < (end - start) / 2)] + step).tolist(), default=0.0) for own in away)


def beyond(pair, reach):
    """Return the distances before the start and after the end of the path within which gaps are below `reach` [mm]."""
    return tuple(float(np.interp(reach, gap, away, left=0.0)) if reach > 0 and away.size else 0.0 for away, gap in gaps(pair))


def pieces_of(pair, phases, pits, bands, beta_b, reach=0.0, closing=0.0, pairs=None):
    """Return each `Piece` of the contact lines of some phases, on the path and where gaps beyond it are below `reach` [mm].

    Pits deeper than `closing` [mm] remove their pieces, because no contact reaches their floor. Shallower pits keep a piece on
    their floor. The order is line by line, from the end that touches first to the other.

    Parameters
    ----------
    phases : sequence of float
        `reach` and `closing` may have one number for each.
    pits : (sequence of Pit, sequence of Pit)
        In each gear's own frame.
    bands : list
        Of `gearfe.geometry.pair.lines.bands_of`.
    closing : float or sequence of float
        Normal approach [mm] that closes shallower pits.
    pairs : ToothPairs, optional
        The pair with missing teeth and chips.

    Returns
    -------
    list of lists of Piece
        One list for each phase.
    """
    pairs, slope = pairs or ToothPairs(pair), math.tan(beta_b)
    reach, closing = (np.broadcast_to(one, len(phases)) for one in (reach, closing))
    whole = [_lines(pairs, *at, bands, slope) for at in zip(phases, reach.tolist(), strict=True)]
    out = [[] for _ in phases]
    for depth in np.unique(closing).tolist():
        numbers = [(i, piece) for i in np.flatnonzero(closing == depth).tolist() for piece in whole[i]]
        pieces = [piece for _, piece in numbers]
        for (i, _), parts in zip(numbers, _outside(pairs, pieces, _by_depth(pits, depth), bands, slope), strict=True):
            out[i] += parts
    return out


def _lines(pairs, phase, reach, bands, slope):
    """Return the pieces of the lines of a phase without pits."""
    pair, pieces = pairs.pair, []
    (start, end), further = pair.path, beyond(pair, reach)
    width = abs(bands[0][1] - bands[0][0])
    first = math.ceil((start - further[0] - end) / pair.p_bt - phase - 1e-9)
    last = math.floor((end + further[1] - start + slope * width) / pair.p_bt - phase + 1e-9)
    for (half, band), order in product(enumerate(bands), range(first, last + 1)):
        roll = start + (phase + order) * pair.p_bt
        for own, *ends in pairs.along(order, band):
            if own is not None:
                found = _along(roll, slope, width, _limits(own, reach), ends, 1e-9 * pair.p_bt)
                pieces += [Piece(half, order, roll, *one, rises if any(further) else (True, True)) for *one, rises in found]
    return pieces


def _outside(pairs, pieces, pits, bands, slope):
    """Return the parts that pits leave of each piece. `pits` is the result of `_by_depth`."""
    (deep, *shallow), width = pits, abs(bands[0][1] - bands[0][0])
    taken = _taken(pairs, deep, bands, pieces, slope)
    out = [_left(piece, pitted, width) for piece, pitted in zip(pieces, taken, strict=True)]
    if not shallow:
        return out
    left = [part for parts in out for part in parts]
    floors = [(*at, _taken(pairs, pitted, bands, left, slope)) for *at, pitted in shallow]
    divided = iter(_with_floors(left, floors, width))
    return [[own for _ in parts for own in next(divided)] for parts in out]


@keeping(64)
def _limits(pair, reach):
    """Return the abscissae [mm] for `_parts`, and the numbers of pieces whose first or last end lies at an undercut edge."""
    (start, end), further = pair.path, beyond(pair, reach)
    # distance of the first contact of a corner and a flank
    before, after = (away[0] if away.size else 0.0 for away, _ in gaps(pair))
    limits = (end + further[1], end + min(after, further[1]), end, start, start - min(before, further[0]), start - further[0])
    at_start, at_end = (number in FORM for number in end_corners(pair))
    return limits, (
        [number for number, edge in ((2, at_start), (0, at_end)) if edge],
        [number for number, edge in ((1, at_end), (0, at_start)) if edge],
    )


def _along(roll, slope, width, limits, ends, slack):
    """Yield the parts of a line within `ends` of the width: corner, two depths, and whether the pressure rises at each end."""
    limits, rising = limits
    for corner, *part in _parts(roll, slope, width, limits, slack):
        low, high = np.clip(part, *ends).tolist()
        if high - low > 1e-6 * width:
            yield corner, low, high, (low == ends[0] or corner in rising[0], high == ends[1] or corner in rising[1])


def _with_floors(pieces, floors, width):
    """Divide each contact line segment at the ends of shallow pits, given as (gear, depth, intervals of each segment)."""
    above = [[(gear, depth, *part) for gear, depth, intervals in floors for part in intervals[k]] for k in range(len(pieces))]
    return [_on_floors(piece, own, width) for piece, own in zip(pieces, above, strict=True)]


def _by_depth(pits, closing):
    """Yield the pits of both gears deeper than `closing` [mm], then (gear, depth, pits of both gears) for each smaller depth."""
    out = [tuple(tuple(pit for pit in gear_pits if pit.depth > closing) for gear_pits in pits)]
    for gear, gear_pits in enumerate(pits):
        for depth in sorted({pit.depth for pit in gear_pits if pit.depth <= closing}):
            alike = tuple(pit for pit in gear_pits if pit.depth == depth)
            out.append((gear, depth, ((), alike) if gear else (alike, ())))
    return out


def _on_floors(piece, above, width):
    """Divide a piece under pits `above` (gear, depth, first, last). The depths of the deepest pits of both gears are added."""
    edges = np.unique(np.clip([piece.first, piece.last, *(at for pit in above for at in pit[2:])], piece.first, piece.last))
    edges = edges[np.concatenate([[True], np.diff(edges) > 1e-6 * width])]
    edges[-1] = piece.last
    middles = (edges[1:] + edges[:-1]) / 2
    floors = [
        sum(max((depth for gear, depth, a, b in above if gear == side and a < at < b), default=0.0) for side in (0, 1))
        for at in middles.tolist()
    ]
    kept = [0, *(k for k in range(1, len(floors)) if floors[k] != floors[k - 1])]
    out = []
    for k, after in zip(kept, [*kept[1:], len(floors)], strict=True):
        ends = piece.ends[0] if k == 0 else True, piece.ends[1] if after == len(floors) else True
        out.append(piece._replace(first=float(edges[k]), last=float(edges[after]), ends=ends, floor=floors[k]))
    return out


def _parts(roll, slope, width, limits, slack):
    """Return the depth ranges in which a line lies after the end of the path, on it, and before its start: corner, low, high.

    There is no contact between the end of the path and the place where a corner first meets a flank.
    """
    corners = (1, None, 0, None, 2)
    if slope > 1e-12:
        at = np.clip([(roll - limit) / slope for limit in limits], 0.0, width)
        ranges = zip(corners, at[:-1].tolist(), at[1:].tolist(), strict=True)
        return [(corner, low, high) for corner, low, high in ranges if corner is not None and high - low > 1e-6 * width]
    top, after, end, start, before, bottom = limits
    if start - slack <= roll < end + slack:
        return [(0, 0.0, width)]
    if after < roll < top:
        return [(1, 0.0, width)]
    return [(2, 0.0, width)] if bottom < roll < before else []


def _left(piece, taken, width):
    """Return the parts of a segment outside the intervals `taken` (first, last)."""
    out, at, fine = [], piece.first, piece.ends[0]
    for a, b in sorted(taken):
        if a > at:
            out.append((at, min(a, piece.last), (fine, True)))
        if b > at:
            at, fine = b, True
    out.append((at, piece.last, (fine, piece.ends[1])))
    return [piece._replace(first=a, last=b, ends=ends) for a, b, ends in out if b - a > 1e-6 * width]


def _near(teeth, pits, z):
    return np.isin(teeth % z, [pit.tooth % z for pit in pits])


def _taken(pairs, pits, bands, pieces, slope):
    """Return the intervals in which pits remove contact from each segment.

    Beyond the path a line is curved, so it is divided into `PARTS` parts.
    """
    out = [[] for _ in pieces]
    if not (any(pits) and pieces):
        return out
    pair, order = pairs.pair, np.array([piece.order for piece in pieces])
    near = [_near(order, pits[0], pair.gear_1.z), _near(-order, pits[1], pair.gear_2.z)]
    pitted = np.flatnonzero(near[0] | near[1]).tolist()
    if not pitted:
        return out
    depths = [np.linspace(pieces[k].first, pieces[k].last, PARTS + 1 if pieces[k].corner else 2) for k in pitted]
    which = np.concatenate([np.full(depth.size - 1, k) for k, depth in zip(pitted, depths, strict=True)])
    depth = np.concatenate([np.stack([depth[:-1], depth[1:]], axis=1) for depth in depths])
    half, order, roll, corner = (np.array(values)[which] for values in list(zip(*pieces, strict=True))[:4])
    nominal, ends = roll[:, None] - slope * depth, np.array(bands)[half]
    z = ends[:, :1] + np.sign(ends[:, 1:] - ends[:, :1]) * depth
    rolls = nominal.copy(), pair.mate_roll(nominal)
    if (beyond_it := np.flatnonzero(corner)).size:
        met_each = touching_each(
            pairs, np.repeat(order[beyond_it], 2), np.repeat(z[beyond_it].mean(axis=1), 2), nominal[beyond_it].ravel()
        )
        for gear_rolls, met in zip(rolls, met_each, strict=False):
            gear_rolls[beyond_it] = met.reshape(-1, 2)
    row, _, first, last = covered(pair, pits, order, rolls, z)
    step = depth[row, 1] - depth[row, 0]
    for k, a, b in zip(which[row].tolist(), depth[row, 0] + first * step, depth[row, 0] + last * step, strict=True):
        out[k].append((float(a), float(b)))
    return out
