"""Contact lines divided into short cells, with the gap of each cell (pieces: `gearfe.contact.pieces`)."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry.aliases import Floats
from ..geometry.mesh.outline import spaced
from ..geometry.pair.broken import ToothPairs, each_pair, touching_each
from ..geometry.pair.gear_pair import GearPair
from ..geometry.pair.modified import first_touch
from .pieces import cut

BESIDE = 0.25  # distance from an end face [m_n] within which edge contact matters
END = 0.25  # length of the cells at the ends of contact relative to the longest; the pressure rises there
GROWTH = 0.6  # growth of the cell length with the distance from the ends
BEYOND = 12  # minimum number of cells beyond the path of contact, where gaps open
CARRYING = 20  # minimum number of loaded cells in a phase if gaps change along the width
SETTLED = 0.7  # The search for the carrying part of a line ends when a step keeps at least this part of its length.
TIMES = 12  # maximum number of steps of that search


@dataclass(frozen=True, slots=True)
class Cells:
    """Parts of contact lines, usually of one phase, that may carry load, as arrays of n.

    `half` is 0, or 1 for the second half of a herringbone pair. `order` is the number of the tooth pair (as in
    `geometry.pair.contacts.Contacts`). `z` is the height of a cell's middle from the end z = 0 [mm], and `width` its extent
    along the face width [mm]. `depth` is the distance from the end that touches first [mm]. `nominal` is the abscissa on the
    line of action [mm], and `roll_1`, `roll_2` are the roll lengths of the contact [mm]. `gap` is the unloaded distance in the
    transverse section [mm]. `geometry.pair.contacts.Contacts` describes `corner`. `floor` is the depth of the pits above the
    cell [mm], which is contained in `gap`; 0 outside of pits. `radius` is the relative radius of curvature in the transverse
    section [mm] if flanks are modified, and 0 for involutes. `load` is the force normal to the flanks [N]. `pressure` is the
    largest Hertzian pressure [MPa], nan at a corner.
    """

    half: NDArray[np.int64]
    order: NDArray[np.int64]
    z: Floats
    width: Floats
    depth: Floats
    nominal: Floats
    roll_1: Floats
    roll_2: Floats
    gap: Floats
    corner: NDArray[np.int64]
    floor: Floats
    radius: Floats
    load: Floats = None  # type: ignore[assignment]  # None until the contact is solved
    pressure: Floats = None  # type: ignore[assignment]

    @property
    def rolls(self) -> tuple[Floats, Floats]:
        """Roll lengths of pinion and wheel."""
        return self.roll_1, self.roll_2

    def some(self, which: NDArray | slice) -> "Cells":
        """Return the cells that a mask, a slice or numbers select."""
        arrays = {name: getattr(self, name) for name in Cells.__slots__}
        return Cells(**{name: value[which] for name, value in arrays.items() if value is not None})

    def at_ends(self, pair: GearPair) -> list[tuple[float, float]]:
        """Return the highest line loads near end faces (edge contact) as (z, roll length of the pinion) [mm].

        A free end face is softer, so the load per width falls towards it in the last tenths of a module.
        """
        out, width = [], pair.b_w
        for order, half in sorted(set(zip(self.order.tolist(), self.half.tolist(), strict=True))):
            at = np.flatnonzero((self.order == order) & (self.half == half) & (self.load > 0))
            if not at.size:
                continue
            most = at[np.argmax(self.load[at] / self.width[at])]
            z, reach = float(self.z[most]), float(self.width[most]) / 2 + BESIDE * pair.gear_1.m_n
            out += [(end, float(self.roll_1[most])) for end in (0.0, width) if abs(z - end) < reach * (1 + 1e-6)]
        return out


def cells_of(pair, pieces, bands, slope, sizes, flanks=None, longer=1, fine=None, pairs=None):
    """Return the `Cells` of the `pieces` of some phases, and the index of the phase of each cell ``(n,)``.

    Parameters
    ----------
    bands : list
        Of `gearfe.geometry.pair.lines.bands_of`.
    slope : float
        Of the abscissa over the depth, ``tan(beta_b)``.
    sizes : list of (float, float)
        In each phase the shortest cell on the part of a line beyond the path and the longest cell of all along the width [mm].
    flanks : (FlankForm, FlankForm), optional
        Modifications of pinion and wheel.
    longer : int
        How many of these cells are taken for one: what k owes to their length.
    fine : dict of (int, int) to (float, float, float), optional
        By phase and piece: first depth, last depth, longest cell between them [mm].
    pairs : ToothPairs, optional
        See `gearfe.contact.pieces.pieces_of`.
    """
    rows, number = [], []
    for i, (group, size) in enumerate(zip(pieces, sizes, strict=True)):
        for k, piece in enumerate(group):
            edge = _edges(piece, *size, slope, (fine or {}).get((i, k)))
            edge = np.append(edge[:-1:longer], edge[-1])
            first, last = bands[piece.half]
            middle, width = (edge[1:] + edge[:-1]) / 2, np.diff(edge)
            z, nominal = first + math.copysign(1, last - first) * middle, piece.roll - slope * middle
            rows.append((middle, width, z, nominal))
            number.append((i, piece.half, piece.order, piece.corner, piece.floor, middle.size))
    pairs = pairs or ToothPairs(pair)
    depth, width, z, nominal = (np.concatenate(values) for values in zip(*rows, strict=True))
    *named, count = (np.array(values) for values in zip(*number, strict=True))
    phase, half, order, corner, floor = (np.repeat(values, count) for values in named)
    roll_1, roll_2, gap = nominal.copy(), pair.mate_roll(nominal), np.zeros(z.size)
    at_corner, radius = (corner > 0) | _cut(pair, nominal), np.zeros(z.size)
    if at_corner.any():
        met = touching_each(pairs, order[at_corner], z[at_corner], nominal[at_corner])
        roll_1[at_corner], roll_2[at_corner], gap[at_corner], corner[at_corner] = met[:4]
    if flanks is not None:
        met = each_pair(pairs, order, z, lambda one, on: first_touch(one, flanks, nominal[on], order[on], gap[on], z[on]))
        roll_1, roll_2, gap, radius, corner = met.roll_1, met.roll_2, met.gap, met.radius, met.corner
    gap = gap + floor * math.sqrt(1 + slope**2)  # Pit depths are measured along the normal.
    whole = Cells(half, order, z, width, depth, nominal, roll_1, roll_2, gap, corner, floor.astype(float), radius)
    kept = np.isfinite(gap)
    return (whole, phase) if kept.all() else (whole.some(kept), phase[kept])


def _cut(pair, nominal):
    """Return whether a tip may interfere with the mating fillet when flanks touch at `nominal` [mm], on or off the path."""
    after, before = cut(pair)
    out = np.zeros(nominal.size, dtype=bool)
    if after:
        out |= nominal < pair.path[0] + after
    return out | (nominal > pair.path[1] - before) if before else out


def carrying(cells, phase, pieces, force, bed):
    """Return the argument `fine` of `cells_of` for lines on which few cells carry load, from their gaps on an elastic foundation.

    With helix crowning, a light load closes the gap over a few hundredths of the width only. In longer cells the gap at the
    middle would remain open. `cells` and `phase` are results of `cells_of`. The cells of a phase carry the `force`
    together [N]. The foundation `bed` is the stiffness of both teeth per width [N/mm**2].
    """
    out = {}
    for i, group in enumerate(pieces):
        at = np.flatnonzero(phase == i)
        if not at.size:
            continue
        order = at[np.argsort(cells.gap[at])]
        gap, width = cells.gap[order], np.cumsum(cells.width[order])
        # approach at which this number of cells would carry load
        pressed = (force / bed + np.cumsum(cells.gap[order] * cells.width[order])) / width
        deep = pressed[np.flatnonzero(pressed >= gap)[-1]]
        loaded = at[cells.gap[at] < deep]
        for k, piece in enumerate(group if loaded.size < CARRYING else ()):
            inside = (cells.order[loaded] == piece.order) & (cells.half[loaded] == piece.half)
            on_piece = loaded[inside & (cells.depth[loaded] > piece.first) & (cells.depth[loaded] < piece.last)]
            if on_piece.size:
                first, last = on_piece[np.argmin(cells.depth[on_piece])], on_piece[np.argmax(cells.depth[on_piece])]
                low, high = cells.depth[first] - cells.width[first], cells.depth[last] + cells.width[last]
                low, high = max(low, piece.first), min(high, piece.last)
                out[i, k] = low, high, (high - low) / CARRYING
    return out


def _edges(piece, finest, step, slope, fine):
    """Return the depths of the borders between the cells of a piece [mm]."""
    a, b = piece.first, piece.last
    longest = min(step, max((b - a) / BEYOND, finest)) if piece.corner and slope > 1e-12 else step
    closer = [(at, at, END * step) for at, ends in zip((a, b), piece.ends, strict=True) if ends]
    return spaced(a, b, longest, closer + [fine] * (fine is not None), 1, GROWTH)
