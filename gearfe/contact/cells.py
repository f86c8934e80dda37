"""Contact lines of one phase as cells: what pits leave of them (`geometry.pair.lines`), and where tip corners may touch beyond.

On the path of contact a line runs across both flanks. Where the plane of action has left it, sections may still touch: a tip
corner of one gear on the other flank, with a gap that is exact kinematics of the section (`gearfe.GearPair.contacts`).
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from geometry.mesh.outline import spaced
from geometry.pair.gear_pair import GearPair
from geometry.pair.lines import covered
from geometry.pair.modified import first_touch

END = 0.25  # length of the cells at the ends of contact, where the pressure rises, against that of the longest
GROWTH = 0.6  # of their length per length
BEYOND = 8  # cells at least on the part of a line that is beyond the path of contact
SAMPLES = 400  # of the gap beyond the path, over a base pitch
PARTS = 4  # straight parts of a line beyond the path, where pits are looked for


@dataclass(frozen=True, slots=True)
class Cells:
    """Pieces of the contact lines of one phase that may carry load, as arrays of n.

    `half` 0, or 1 for the second half of a herringbone pair; `order` of the tooth pair (as in
    `geometry.pair.gear_pair.Contacts`); `z` their middles along the width from the end at z = 0 [mm], `width` their extent along
    it [mm]; `depth` the distance from the end that touches first [mm]; `nominal` the abscissa on the line of action [mm],
    `roll_1`, `roll_2` roll lengths where they touch [mm], `gap` the unloaded distance in the transverse section [mm]; `corner` 0,
    or 1 or 2 for the gear whose tip corner touches; `load` force at right angles to the flanks [N]; `pressure` largest of Hertz's
    [MPa], nan at a corner; `floor` how deep the pits above the cell are [mm], 0 outside of pits (it is in `gap`); `radius`
    relative radius of curvature in the transverse section [mm] where flanks are modified, otherwise 0: that of the involutes.
    """

    half: NDArray[np.int64]
    order: NDArray[np.int64]
    z: NDArray[np.float64]
    width: NDArray[np.float64]
    depth: NDArray[np.float64]
    nominal: NDArray[np.float64]
    roll_1: NDArray[np.float64]
    roll_2: NDArray[np.float64]
    gap: NDArray[np.float64]
    corner: NDArray[np.int64]
    floor: NDArray[np.float64]
    radius: NDArray[np.float64]
    load: NDArray[np.float64] = None  # type: ignore[assignment]  # None until the contact is solved
    pressure: NDArray[np.float64] = None  # type: ignore[assignment]

    def at_ends(self, pair: GearPair) -> list[tuple[float, float]]:
        """Where a contact line carries the most at an end face of the common width: (z, roll length of the pinion) [mm]."""
        out, width = [], min(pair.gear_1.b, pair.gear_2.b)
        for order, half in sorted(set(zip(self.order.tolist(), self.half.tolist(), strict=True))):
            at = np.flatnonzero((self.order == order) & (self.half == half) & (self.load > 0))
            if not at.size:
                continue
            most = at[np.argmax(self.load[at] / self.width[at])]
            z, reach = float(self.z[most]), float(self.width[most]) / 2
            out += [(end, float(self.roll_1[most])) for end in (0.0, width) if abs(z - end) < reach * (1 + 1e-6)]
        return out


class Piece(NamedTuple):
    """A part of a contact line between two depths [mm].

    `roll` is the abscissa of its line at depth 0 [mm], `corner` as of `Cells`; `ends` says which of its ends (first, last) end
    contact, so that the pressure rises there; `floor` as of `Cells`.
    """

    half: int
    order: int
    roll: float
    corner: int
    first: float
    last: float
    ends: tuple
    floor: float = 0.0


def touching(pair, nominal):
    """Roll lengths of both gears and gap at abscissae `nominal` [mm]; gap inf where flanks cannot meet.

    On the path of contact the gap is zero, before its start the wheel's tip corner touches, after its end the pinion's.
    """
    start, _ = pair.path
    nominal = np.asarray(nominal, dtype=float)
    found = pair.contacts((nominal - start) / pair.p_bt)
    own = found.order == 0
    return found.roll_1[:, own].ravel(), found.roll_2[:, own].ravel(), found.gap[:, own].ravel()


@lru_cache(maxsize=64)
def gaps(pair):
    """Return how far beyond the path (before its start, after its end) [mm], and the gaps there, up to where no flank is met.

    Where the path ends at a form point the corner first meets nothing; its gaps count from where it meets the flank.
    """
    start, end = pair.path
    away = np.linspace(0.0, pair.p_bt, SAMPLES) + 1e-6 * pair.p_bt
    out = []
    for nominal in (start - away, end + away):
        gap = touching(pair, nominal)[2]
        met = np.flatnonzero(np.isfinite(gap))
        first = met[0] if met.size else gap.size
        lost = first + np.flatnonzero(~np.isfinite(gap[first:]))
        if 0 < first < gap.size - 1:  # it meets the flank between two samples: what the gap is at the one before, at least
            first -= 1
            gap[first] = max(2 * gap[first + 1] - gap[first + 2], 0.0)
        own = slice(first, lost[0] if lost.size else gap.size)
        out.append((away[own], np.maximum.accumulate(gap[own])))
    return out


def beyond(pair, reach):
    """How far before the start and after the end of the path [mm] the gap is below `reach` [mm]."""
    return tuple(float(np.interp(reach, gap, away, left=0.0)) if reach > 0 and away.size else 0.0 for away, gap in gaps(pair))


def pieces_of(pair, phase, pits, bands, beta_b, further=(0.0, 0.0), closing=0.0):
    """`Piece` of all contact lines of one phase that pits leave, up to so far beyond the path [mm].

    Pits deeper than `closing` take their pieces away: nothing can reach their floor. Those of others stay, on the floor.

    Parameters
    ----------
    pair : GearPair
    phase : float
    pits : (sequence of Pit, sequence of Pit)
        In each gear's own frame.
    bands : list
        Of `geometry.pair.lines.bands_of`.
    beta_b : float
    further : (float, float)
        Of `beyond`.
    closing : float
        Normal approach [mm] that closes shallower pits.

    Returns
    -------
    list of Piece
        From the end that touches first to the other, line by line.
    """
    start, end = pair.path
    slope, width = math.tan(beta_b), abs(bands[0][1] - bands[0][0])
    first = math.ceil((start - further[0] - end) / pair.p_bt - phase - 1e-9)
    last = math.floor((end + further[1] - start + slope * width) / pair.p_bt - phase + 1e-9)
    limits = (end + further[1], end, start, start - further[0])
    pieces = []
    for half in range(len(bands)):
        for order in range(first, last + 1):
            roll = start + (phase + order) * pair.p_bt
            for corner, low, high in _parts(roll, slope, width, limits, 1e-9 * pair.p_bt):
                ends = (low == 0, high == width) if any(further) else (True, True)
                pieces.append(Piece(half, order, roll, corner, low, high, ends))
    deep, *shallow = _by_depth(pits, closing)
    taken = _taken(pair, deep, bands, pieces, slope)
    pieces = [part for piece, own in zip(pieces, taken, strict=True) for part in _left(piece, own, width)]
    if not shallow:
        return pieces
    floors = [(gear, depth, _taken(pair, own, bands, pieces, slope)) for gear, depth, own in shallow]
    own = [[(gear, depth, *part) for gear, depth, found in floors for part in found[k]] for k in range(len(pieces))]
    return [part for piece, above in zip(pieces, own, strict=True) for part in _on_floors(piece, above, width)]


def _by_depth(pits, closing):
    """Pits of both gears deeper than `closing`; then (gear, depth, pits of both gears) of each depth that is not."""
    out = [tuple(tuple(pit for pit in own if pit.depth > closing) for own in pits)]
    for gear, own in enumerate(pits):
        for depth in sorted({pit.depth for pit in own if pit.depth <= closing}):
            alike = tuple(pit for pit in own if pit.depth == depth)
            out.append((gear, depth, ((), alike) if gear else (alike, ())))
    return out


def _on_floors(piece, above, width):
    """Parts of a piece under pits `above` (gear, depth, first, last): of one gear the deepest counts, of both their sum."""
    edges = np.unique(np.clip([piece.first, piece.last, *(at for one in above for at in one[2:])], piece.first, piece.last))
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
    """Depths at which a line is after the end of the path, on it, and before its start: corner, low, high."""
    if slope > 1e-12:
        at = np.clip([(roll - limit) / slope for limit in limits], 0.0, width)
        found = zip((1, 0, 2), at[:-1].tolist(), at[1:].tolist(), strict=True)
        return [(corner, low, high) for corner, low, high in found if high - low > 1e-6 * width]
    top, end, start, bottom = limits
    if start - slack <= roll < end + slack:
        return [(0, 0.0, width)]
    if end < roll < top:
        return [(1, 0.0, width)]
    return [(2, 0.0, width)] if bottom < roll < start else []


def _left(piece, taken, width):
    """Pieces that the intervals `taken` (first, last) leave of one."""
    out, at, fine = [], piece.first, piece.ends[0]
    for a, b in sorted(taken):
        if a > at:
            out.append((at, min(a, piece.last), (fine, True)))
        if b > at:
            at, fine = b, True
    out.append((at, piece.last, (fine, piece.ends[1])))
    return [piece._replace(first=a, last=b, ends=ends) for a, b, ends in out if b - a > 1e-6 * width]


def _taken(pair, pits, bands, pieces, slope):
    """Intervals of depth that pits take from each piece; beyond the path a line is bent, so it is looked at in `PARTS`."""
    out, (one, two) = [[] for _ in pieces], (pair.gear_1.z, pair.gear_2.z)
    teeth_1, teeth_2 = {pit.tooth % one for pit in pits[0]}, {pit.tooth % two for pit in pits[1]}
    found = [k for k, piece in enumerate(pieces) if piece.order % one in teeth_1 or -piece.order % two in teeth_2]
    if not found:
        return out
    depths = [np.linspace(pieces[k].first, pieces[k].last, PARTS + 1 if pieces[k].corner else 2) for k in found]
    which = np.concatenate([np.full(depth.size - 1, k) for k, depth in zip(found, depths, strict=True)])
    depth = np.concatenate([np.stack([depth[:-1], depth[1:]], axis=1) for depth in depths])
    half, order, roll, corner = (np.array(values)[which] for values in list(zip(*pieces, strict=True))[:4])
    nominal = roll[:, None] - slope * depth
    rolls = nominal.copy(), pair.mate_roll(nominal)
    beyond_it = np.flatnonzero(corner)
    if beyond_it.size:
        for own, met in zip(rolls, touching(pair, nominal[beyond_it].ravel()), strict=False):
            own[beyond_it] = met.reshape(-1, 2)
    ends = np.array(bands)[half]
    z = ends[:, :1] + np.sign(ends[:, 1:] - ends[:, :1]) * depth
    row, _, first, last = covered(pair, pits, order, rolls, z)
    step = depth[row, 1] - depth[row, 0]
    for k, a, b in zip(which[row].tolist(), depth[row, 0] + first * step, depth[row, 0] + last * step, strict=True):
        out[k].append((float(a), float(b)))
    return out


def cells_of(pair, pieces, bands, slope, step, flanks=None):
    """`Cells` of the pieces of one phase, at most `step` [mm] along the width; of modified `flanks`, if given."""
    rows = []
    for piece in pieces:
        a, b = piece.first, piece.last
        longest = min(step, max((b - a) / BEYOND, END * step)) if piece.corner and slope > 1e-12 else step
        fine = [(at, at, END * step) for at, ends in zip((a, b), piece.ends, strict=True) if ends]
        edge = spaced(a, b, longest, fine, 1, GROWTH)
        middle, width = (edge[1:] + edge[:-1]) / 2, np.diff(edge)
        first, last = bands[piece.half]
        z = first + math.copysign(1, last - first) * middle
        same = np.ones(z.size)
        rows.append(
            np.array(
                [
                    piece.half * same,
                    piece.order * same,
                    z,
                    width,
                    middle,
                    piece.roll - slope * middle,
                    piece.corner * same,
                    piece.floor * same,
                ]
            )
        )
    half, order, z, width, depth, nominal, corner, floor = np.hstack(rows)
    roll_1, roll_2, gap = nominal.copy(), pair.mate_roll(nominal), np.zeros(z.size)
    there, radius = corner > 0, np.zeros(z.size)
    if there.any():
        roll_1[there], roll_2[there], gap[there] = touching(pair, nominal[there])
    if flanks is not None:
        met = first_touch(pair, flanks, nominal, order.astype(int), gap, z)
        roll_1, roll_2, gap, radius, corner = met.roll_1, met.roll_2, met.gap, met.radius, met.corner
    gap = gap + floor * math.sqrt(1 + slope**2)  # pits are measured along the normal
    whole = (half.astype(int), order.astype(int), z, width, depth, nominal, roll_1, roll_2, gap, corner.astype(int), floor)
    whole = (*whole, radius)
    kept = np.isfinite(gap)
    return Cells(*(values[kept] for values in whole)) if not kept.all() else Cells(*whole)
