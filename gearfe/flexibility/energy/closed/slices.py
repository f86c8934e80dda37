"""Slices of the tooth pairs along their contact lines: positions and weights for an integral over the width."""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.polynomial.legendre import leggauss

from ....core.checks import one_of
from ....geometry.pair.contacts import contacts
from ....geometry.pair.lines import covered, halves
from ....geometry.pair.modified import first_touch, flank_contacts

LOST = ("hertz", "slices", "summed")
RULES = {False: leggauss(1), True: leggauss(24)}
SHORT = leggauss(10)  # Gauss points for panels shorter than a quarter of a base pitch


@dataclass(frozen=True, slots=True)
class Stations:
    """Slices of the tooth pairs that carry load, as flat arrays of n slices.

    `phase` and `column` are indices of the phase and of the pair in `order` (pairs,), see `Contacts` of a pair. `roll_1` and
    `roll_2` are the roll lengths [mm]. `weight` is the part of the face width of a station, `touching` the part of its contact
    that pits have left. `gap` is the approach at which it first touches [mm], None for involutes.
    """

    order: np.ndarray
    phase: np.ndarray
    column: np.ndarray
    roll_1: np.ndarray
    roll_2: np.ndarray
    weight: np.ndarray
    touching: np.ndarray
    gap: np.ndarray | None = None


def faces(pair, face, groove=0.0):
    """Bands of the face width as ``(first end, last end, lag)``: axial positions [mm] and phase lag of the last end.

    A slice of a helical gear at distance s from the end that touches first is a spur gear whose phase is
    ``s tan(beta_b) / p_bt`` behind; over the whole band the lag is its overlap ratio.

    ``spur``: one band without lag, whatever the helix angle. ``helical``: the end z = 0 touches first. ``herringbone``: two
    mirrored halves left and right of a relief groove of width `groove` [mm] in the middle, whose outer ends touch first; each
    is a helical gear of width ``(b - groove) / 2``.
    """
    twist = 0.0 if face == "spur" else abs(np.tan(pair.gear_1.beta_b)) / pair.p_bt
    return [(first, last, twist * abs(last - first)) for first, last in halves(pair, face, groove)]


def faces_of(case):
    """Return the `faces` of a `Case`. Teeth are assumed straight if the case has no `face`."""
    return faces(case.pair, case.face or "spur", case.groove)


def stations(case, phase, *, lost="hertz", edges=None):
    """Return the `Stations` on the contact lines of a `Case` at some phases.

    Each contact line is divided at the borders of pits and at `edges`, with 24 Gauss points along the width between them. The
    sum is therefore a smooth function of the phase wherever the exact integral is.

    Parameters
    ----------
    lost : {"hertz", "slices", "summed"}
        What pits take from a pair, see `gearfe.flexibility.energy.closed.plain_sum.plain_sum`.
    edges : callable, optional
        From the pair orders to a dict by order: roll lengths of the pinion [mm] at which that pair's stiffness is not smooth.
    """
    pair, pits, flanks, bands = case.pair, case.pits, case.forms, faces_of(case)
    one_of("lost", lost, LOST)
    lag = max(band[2] for band in bands)
    order = contacts(pair, [phase.min() - lag, phase.max()], extended=False).order
    edges = edges(order) if edges and lag > 0 else {}
    pitted = any(pit.side == "loaded" for pit in (*pits[0], *pits[1]))
    if lag == 0 and not pitted:  # Each pair on the path of contact has one station.
        return _on_path(pair, phase, flanks, bands)
    summed = lost == "summed"
    taken = {} if summed else _taken(pair, phase, order, pits, bands)
    left = 1 - (_summed(pair, order, pits, bands) if summed else np.zeros((order.size, len(bands))))
    rows = [np.zeros((0, 6))]
    for (i, p), (j, number), (k, band) in product(enumerate(phase), enumerate(order), enumerate(bands)):
        for found in _line(pair, p + number, taken.get((i, j, k), ()), band, lost, edges.get(number, ()), left[j, k]):
            rows.append(np.column_stack([np.full((len(found), 2), (i, j)), found]))
    table = np.concatenate(rows)
    (i, j), (roll, weight, touching) = table[:, :2].astype(int).T, table[:, 2:5].T
    roll_2, gap = pair.mate_roll(roll), None
    if flanks is not None:
        backwards = len(bands) == 1 and lag > 0 and pair.gear_1.beta > 0  # In this case the end z = b enters contact first.
        z = bands[0][1] - table[:, 5] if backwards else table[:, 5]
        met = first_touch(pair, flanks, roll, order[j], np.zeros(roll.size), z)
        roll, roll_2, gap = met.roll_1, met.roll_2, met.gap
    return Stations(order, i, j, roll, roll_2, weight, touching, gap)


def _on_path(pair, phase, flanks, bands):
    """Return the `Stations` of a spur pair without pits."""
    found = flank_contacts(pair, phase, extended=False, flanks=flanks)
    i, j = np.nonzero(np.isfinite(found.gap))
    whole = np.full(i.size, sum(abs(last - first) for first, last, _ in bands) / pair.b_w)
    gap = None if flanks is None else found.gap[i, j]
    return Stations(found.order, i, j, found.roll_1[i, j], found.roll_2[i, j], whole, np.ones(i.size), gap)


def _taken(pair, phase, order, pits, bands):
    """Return the parts of the bands that pits remove from the contact line, by phase, tooth pair and band."""
    i, j, k = (index.ravel() for index in np.indices((phase.size, order.size, len(bands))))
    first, last, lag = np.array(bands).T
    place = phase[i] + order[j]
    roll = pair.path[0] + np.stack([place, place - lag[k]], axis=1) * pair.p_bt
    z = np.stack([first, last], axis=1)[k]
    piece, _, start, end = covered(pair, pits, order[j], (roll, pair.mate_roll(roll)), z)
    out = {}
    for n, s, e in zip(piece.tolist(), start.tolist(), end.tolist(), strict=True):
        out.setdefault((int(i[n]), int(j[n]), int(k[n])), []).append((s, e))
    return out


def _summed(pair, order, pits, bands):
    """Return the parts of the width of each band removed by the pits of both teeth, summed: ``(pairs, bands)``."""
    out = np.zeros((order.size, len(bands)))
    common = pair.b_w
    for gear, gear_pits, sense in ((pair.gear_1, pits[0], 1), (pair.gear_2, pits[1], -1)):
        for pit in gear_pits:
            z = pit.z - (gear.b - common) / 2
            ends = [(max(min(a, b), z - pit.reach[1]), min(max(a, b), z + pit.reach[1])) for a, b, _ in bands]
            width = [max(high - low, 0.0) / abs(b - a) for (low, high), (a, b, _) in zip(ends, bands, strict=True)]
            out[(order - sense * pit.tooth) % gear.z == 0] += width if pit.side == "loaded" else 0.0
    if (out >= 1).any():
        raise ValueError(
            f"the damaged widths add up to {out.max():.3g} times the width of a part of the face and leave no contact: give "
            "fewer or smaller pits, or lost = 'hertz'"
        )
    return out


def _line(pair, place, taken, band, lost, edges, kept_part=1.0):
    """Return slices (pinion roll, weight, touching, height) of one pair. The slice at the first end has the phase `place`."""
    first, last, lag = band
    low, high = (max((place - pair.eps_alpha) / lag, 0.0), min(place / lag, 1.0)) if lag > 0 else (0.0, 1.0)
    if high <= low or (lag == 0 and not -1e-9 <= place < pair.eps_alpha + 1e-9):
        return []
    roll = pair.path[0] + np.array([place, place - lag]) * pair.p_bt
    taken = np.clip(np.reshape(taken, (-1, 2)), low, high)
    kinks = (roll[0] - np.array(edges if lag > 0 else ())) / (roll[0] - roll[1])
    places = np.unique([low, high, *kinks[(kinks > low) & (kinks < high)], *taken.ravel()])
    s, e = places[:-1], places[1:]
    middle = (s + e)[:, None] / 2
    gone = ((taken[:, 0] <= middle) & (middle <= taken[:, 1])).any(axis=1)
    left = (e - s)[~gone].sum() / (high - low)
    if left < 1e-12:
        return []
    out, share = [], abs(last - first) / pair.b_w
    for start, length in np.column_stack([s, e - s])[~gone if lost == "slices" else slice(None)].tolist():
        points, weights = SHORT if 0 < lag * length < 0.25 else RULES[lag > 0]
        t = start + length * (1 + points) / 2
        kept, z = np.full(t.size, left if lost == "hertz" else kept_part), first + (last - first) * t
        out.append(np.column_stack([roll[0] + (roll[1] - roll[0]) * t, share * length / 2 * weights, kept, z]))
    return out
