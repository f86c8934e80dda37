"""Contact lines of spur, helical and herringbone pairs at a phase, cut into the cells a contact solve needs."""

import math
from dataclasses import dataclass

import numpy as np

from geometry.outline import spaced
from geometry.pit import crossing

from .energy.slices import FACES

END = 0.25  # length of the cells at the ends of contact, where the pressure rises, against that of the longest
GROWTH = 0.6  # of their length per length


@dataclass(frozen=True, slots=True)
class Cells:
    """Pieces of the contact lines of one phase that carry load, as arrays of n.

    `half` 0, or 1 for the second half of a herringbone pair; `order` of the tooth pair (as in `geometry.pair.Contacts`); `z`
    their middles along the width from the end at z = 0 [mm], `width` their extent along it [mm]; `depth` the distance from the
    end that touches first [mm]; `roll_1`, `roll_2` roll lengths [mm]; `load` force at right angles to the flanks [N];
    `pressure` largest of Hertz's [MPa].
    """

    half: np.ndarray
    order: np.ndarray
    z: np.ndarray
    width: np.ndarray
    depth: np.ndarray
    roll_1: np.ndarray
    roll_2: np.ndarray
    load: np.ndarray | None = None
    pressure: np.ndarray | None = None


def bands_of(pair, face, groove):
    """Bands of the width as (end that touches first, other end) [mm]."""
    if face not in FACES:
        raise ValueError(f"face = {face!r}, but it must be one of {', '.join(FACES)}")
    if face == "spur" and pair.gear_1.beta != 0:
        raise ValueError("face = 'spur', but the gears have a helix angle: give beta = 0, or face = 'helical'")
    if groove and face != "herringbone":
        raise ValueError(f"groove = {groove} mm, but only face = 'herringbone' has a relief groove")
    width = min(pair.gear_1.b, pair.gear_2.b)
    if not 0 <= groove < width:
        raise ValueError(f"groove = {groove} mm, but it must lie between 0 and the face width of {width:g} mm")
    if face == "herringbone":
        half = (width - groove) / 2
        return [(0.0, half), (width, width - half)]
    return [(width, 0.0) if pair.gear_1.beta > 0 else (0.0, width)]


def lines_of(pair, phase, pits, bands, beta_b):
    """Contact lines of one phase: half, pair order, roll of the pinion at the first end [mm], intervals of depth left by pits.

    Raises
    ------
    RuntimeError
        If none is left; the message says at which phase.
    """
    start, end = pair.path
    slope, width = math.tan(beta_b), abs(bands[0][1] - bands[0][0])
    first = math.ceil((start - end) / pair.p_bt - phase)
    last = math.floor((end - start + slope * width) / pair.p_bt - phase + 1e-9)
    out = []
    for order in range(first, last + 1):
        roll = start + (phase + order) * pair.p_bt
        slack = 1e-9 * pair.p_bt
        if slope > 1e-12:
            low, high = max((roll - end) / slope, 0.0), min((roll - start) / slope, width)
        else:
            low, high = (0.0, width) if start - slack <= roll < end + slack else (0.0, 0.0)
        for half, band in enumerate(bands):
            if high - low > 1e-6 * width:
                left = _left(pair, order, roll, slope, pits, band, (low, high))
                out.append((half, order, roll, left))
    if not any(left for *_, left in out):
        raise RuntimeError(f"no contact at phase {phase:g}: pits cover it all, or the pair has left its path of contact")
    return out


def _left(pair, order, roll, slope, pits, band, limits):
    """Intervals of depth that the pits of both gears leave between `limits`."""
    width = abs(band[1] - band[0])
    ends = np.array([roll, roll - slope * width])
    covered = []
    for gear, found, number, at in (
        (pair.gear_1, pits[0], order, ends), (pair.gear_2, pits[1], -order, pair.mate_roll(ends))
    ):  # fmt: skip
        offset = (gear.b - min(pair.gear_1.b, pair.gear_2.b)) / 2
        for pit in found:
            if pit.side == "loaded" and (pit.tooth - number) % gear.z == 0:
                covered += [(a * width, b * width) for a, b in crossing(gear, pit, at, np.array(band) + offset)]
    out, at = [], limits[0]
    for a, b in sorted(covered):
        if a > at:
            out.append((at, min(a, limits[1])))
        at = max(at, b)
    out.append((at, limits[1]))
    return [(a, b) for a, b in out if b - a > 1e-6 * width]


def cells_of(pair, found, bands, slope, step):
    """`Cells` of the lines of one phase, at most `step` [mm] along the width."""
    rows = []
    for half, order, roll, left in found:
        for a, b in left:
            size = END * step
            edge = spaced(a, b, step, [(a, a, size), (b, b, size)], 1, GROWTH)
            middle, width = (edge[1:] + edge[:-1]) / 2, np.diff(edge)
            first, last = bands[half]
            z = first + math.copysign(1, last - first) * middle
            rows.append(np.array([np.full(z.size, half), np.full(z.size, order), z, width, middle, roll - slope * middle]))
    half, order, z, width, depth, roll_1 = np.hstack(rows)
    return Cells(half.astype(int), order.astype(int), z, width, depth, roll_1, pair.mate_roll(roll_1))
