"""Section of a whole gear whose teeth may be loaded on either flank, with prescribed vertices on the held circle."""

import math

import numpy as np

from ..damage.chip import chip_of
from ..damage.missing import missing_teeth
from ..tooth.profile import cartesian
from .outline import around, bare, chipped_half, doubled, half, held_circle, spaced, stations
from .section_mesh import Seam, Section, crack_chains, crack_lines, fill

GROWTH = 0.3  # growth of the edge length of the held circle per length, away from its marks
SIDES = "loaded", "unloaded"  # flanks 0 and 1: right and left side of a tooth


def both_flanks(gear, rolls, *, fillet_size, size, far_size, marks=(), mark_size=0.0, held_size=math.inf, cracks=(), broken=()):
    """Mesh the whole section of `gear`.

    Parameters
    ----------
    gear : Gear
    rolls : dict of (int, int) to ndarray
        Roll lengths of flank vertices from root to tip [mm], by tooth and side (0 right, 1 left).
    fillet_size, size, far_size : float
        Edge lengths of the loaded teeth's fillets, of adjacent teeth and of all others [mm].
    marks : sequence of float
        Angles on the held circle with a vertex [rad], with edges of `mark_size` there and of at most `held_size` elsewhere [mm].
    cracks : sequence of Crack
        Their loaded side is side 0.
    broken : sequence of (MissingTooth or Chip)
        Teeth that become root circle, or lose their tips. The loaded side of a chip is side 0.

    Returns
    -------
    Section
        Its `flank` and `roll` by tooth and side, without fillets.
    """
    cuts, lines = crack_lines(gear, cracks, fillet_size)
    coarse, far = (half(gear, stations(gear, s), s, s) for s in (size, far_size))
    missing, gone = missing_teeth(gear, broken), bare(gear, size)
    loaded = {tooth for tooth, _ in (*rolls, *cuts)}
    beside = {(tooth + k) % gear.z for tooth in loaded for k in (-1, 1)}

    def choose(tooth, side):
        chip = chip_of(gear, broken, tooth)
        if tooth in missing:
            return gone
        if chip is not None:
            return chipped_half(gear, chip, side, fillet_size, size, roll=rolls.get((tooth, SIDES.index(side))))
        if tooth in loaded:
            roll = rolls.get((tooth, SIDES.index(side)), stations(gear, size))
            return half(gear, roll, fillet_size, size, mark=cuts.get((tooth, side)))
        return coarse if tooth in beside else far

    rim, places = around(gear, choose)
    flanks = {}
    for tooth, side in rolls:
        piece, first, sense = places[tooth, SIDES[side]]
        flanks[tooth, side] = (first + sense * piece.flank)[::-1]
    held = _marked(gear, marks, mark_size, held_size) if len(marks) else held_circle(gear)
    starts = {place: first + sense * piece.mark for place, (piece, first, sense) in places.items() if place in lines}
    mesh, faces = fill(rim, held, crack_chains(gear, cracks, lines, rim, starts), ring=gear.internal)
    return Section(gear, mesh, flanks, rolls, {}, tuple(map(Seam, faces)))


def _marked(gear, marks, fine, longest):
    """Return the held circle with vertices at `marks`, finer next to them; vertices at even indices, edge middles at odd."""
    at, out = np.unique(np.asarray(marks) % (2 * math.pi)), []
    size = min(0.35 * abs(gear.r_f - gear.held), 2 * math.pi * gear.held / 16, longest)
    for first, last in zip(at, np.append(at[1:], at[0] + 2 * math.pi), strict=True):
        length = (last - first) * gear.held
        place = spaced(0.0, length, min(size, length / 2), [(0.0, 0.0, fine), (length, length, fine)], 1, GROWTH) / gear.held
        out.append(first + doubled(place)[:-1])
    return cartesian(gear.held, np.concatenate(out))
