"""Contact lines of spur, helical and herringbone pairs: where along the width the tooth pairs touch, exactly.

All transverse sections of a helical pair are alike, only turned: the section at height z is turned with the pinion by
``tan(beta) / r`` per mm, so that the pinion's roll length of the touching points is linear in z::

    roll(z) = roll(0) + tan(beta_b) z

with the sign of the pinion's beta: where it is positive, the far end z = b is ahead and touches first. In the plane of action
the line is inclined by beta_b to the axis, and its length is that along z over cos(beta_b). Heights are counted over the common
width of both gears (the narrower one's), from the end face their `Pit` positions are counted from; gears of different width lie
centred on each other.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..damage.pit import crossing, rolls, union_length
from .gear_pair import GearPair

FACES = ("helical", "herringbone")


class Band(NamedTuple):
    """A part of the face with one hand of helix.

    Heights `low` to `high` [mm], `slope` of the pinion's roll length over z, `origin` the end [mm] where the phase is counted.
    """

    low: float
    high: float
    slope: float
    origin: float


@dataclass(frozen=True, slots=True)
class Lines:
    """Contact lines at some phases.

    Attributes
    ----------
    pair : GearPair
    bands : tuple of Band
    phase : ndarray, shape (phases,)
    order : ndarray, shape (pairs,)
        Numbers of the tooth pairs, as of `geometry.pair.gear_pair.Contacts`.
    low, high : ndarray, shape (phases, pairs, bands)
        Heights [mm] between which a pair touches; equal where it does not.
    roll_0 : ndarray, shape (phases, pairs, bands)
        The pinion's roll length [mm] that the line, prolonged, has at z = 0.
    """

    pair: GearPair
    bands: tuple
    phase: np.ndarray
    order: np.ndarray
    low: np.ndarray
    high: np.ndarray
    roll_0: np.ndarray

    @property
    def beta_b(self):
        """Inclination to the axis [rad] in the plane of action, of each band."""
        return np.arctan([band.slope for band in self.bands])

    @property
    def length(self):
        """Lengths ``(phases, pairs, bands)`` [mm] of the lines, pits disregarded."""
        return (self.high - self.low) / np.cos(self.beta_b)

    def rolls(self, z):
        """Roll lengths [mm] of pinion and wheel at heights `z` ``(..., phases, pairs, bands)`` [mm]."""
        roll_1 = self.roll_0 + np.array([band.slope for band in self.bands]) * z
        return roll_1, self.pair.mate_roll(roll_1)


@dataclass(frozen=True, slots=True)
class Removed:
    """Pieces of contact lines that pits take away, n of them; they may overlap.

    `phase`, `column`, `band` are indices into the arrays of `Lines`, `low` and `high` heights [mm], `gear` 0 for a pit of the
    pinion and 1 for one of the wheel.
    """

    phase: np.ndarray
    column: np.ndarray
    band: np.ndarray
    low: np.ndarray
    high: np.ndarray
    gear: np.ndarray


def common_width(pair, face, groove, faces):
    """Width [mm] in which both gears of a pair touch.

    Raises
    ------
    ValueError
        If `face` is none of `faces`, or if `groove` [mm] is not that of a herringbone pair or leaves no width.
    """
    if face not in faces:
        raise ValueError(f"face = {face!r}, but it must be one of {', '.join(faces)}")
    if groove and face != "herringbone":
        raise ValueError(f"groove = {groove} mm, but only face = 'herringbone' has a relief groove")
    width = min(pair.gear_1.b, pair.gear_2.b)
    if not 0 <= groove < width:
        raise ValueError(f"groove = {groove} mm, but it must lie between 0 and the face width of {width:g} mm")
    return width


def face_bands(pair, face="helical", groove=0.0):
    """Bands of the face.

    ``helical``: one, which for beta = 0 is a spur gear's. ``herringbone``: two mirrored halves of width ``(b - groove) / 2`` left
    and right of a relief groove in the middle; the pinion's beta is that of the half at z = 0, and the phase is counted at both
    outer ends: with beta > 0 the inner ends touch first, with beta < 0 the outer ones.

    Parameters
    ----------
    pair : GearPair
    face : {"helical", "herringbone"}
    groove : float
        Its width [mm].

    Returns
    -------
    tuple of Band
    """
    width = common_width(pair, face, groove, FACES)
    slope = math.tan(pair.gear_1.beta_b)
    if face == "helical":
        return (Band(0.0, width, slope, 0.0),)
    half = (width - groove) / 2
    return Band(0.0, half, slope, 0.0), Band(width - half, width, -slope, width)


def contact_lines(pair, phase, *, face="helical", groove=0.0):
    """Contact lines of all tooth pairs that touch anywhere at some phases, on the path of contact.

    Parameters
    ----------
    pair : GearPair
    phase : float or ndarray, shape (phases,)
        Of the section the phase is counted at, see `face_bands`; any numbers.
    face, groove
        As in `face_bands`.

    Returns
    -------
    Lines
    """
    bands = face_bands(pair, face, groove)
    phase = np.atleast_1d(np.asarray(phase, dtype=float))
    start, end = pair.path
    ahead = [band.slope * (side - band.origin) / pair.p_bt for band in bands for side in band[:2]]
    first = -1 - math.floor(phase.max() + max(ahead))
    last = math.ceil((end - start) / pair.p_bt - phase.min() - min(ahead))
    order = np.arange(first, last + 1)
    low, high, roll_0 = np.zeros((3, phase.size, order.size, len(bands)))
    nominal = start + (phase[:, None] + order) * pair.p_bt
    for k, band in enumerate(bands):
        roll_0[..., k] = nominal - band.slope * band.origin
        low[..., k], high[..., k] = _touching(band, roll_0[..., k], start, end, pair.p_bt)
    return Lines(pair, bands, phase, order, low, high, roll_0)


def _touching(band, roll_0, start, end, pitch):
    """Heights between which the line lies on the path of contact."""
    if abs(band.slope) * (band.high - band.low) < 1e-12 * pitch:
        slack = 1e-9 * pitch
        inside = (roll_0 >= start - slack) & (roll_0 < end + slack)
        return np.full(roll_0.shape, band.low), np.where(inside, band.high, band.low)
    ends = np.sort([(start - roll_0) / band.slope, (end - roll_0) / band.slope], axis=0)
    low, high = np.clip(ends, band.low, band.high)
    return low, high


def removed(lines, pits):
    """What pits take from contact lines.

    Parameters
    ----------
    lines : Lines
    pits : (sequence of Pit, sequence of Pit)
        Of pinion and wheel, teeth numbered in each gear's own frame; those on unloaded flanks take nothing.

    Returns
    -------
    Removed
    """
    pair, rows = lines.pair, []
    width = min(pair.gear_1.b, pair.gear_2.b)
    for which, (gear, found) in enumerate(zip((pair.gear_1, pair.gear_2), pits, strict=True)):
        offset = (gear.b - width) / 2
        at_low, at_high = lines.rolls(lines.low)[which], lines.rolls(lines.high)[which]
        for pit in found:
            if pit.side != "loaded":
                continue
            own = (pit.tooth - (1 - 2 * which) * lines.order) % gear.z == 0
            near, far = rolls(gear, pit)[:: gear.outward]
            meets = (np.minimum(at_low, at_high) <= far) & (np.maximum(at_low, at_high) >= near) & own[:, None]
            meets &= (lines.low < pit.z + pit.reach[1] - offset) & (lines.high > pit.z - pit.reach[1] - offset)
            meets &= lines.high > lines.low
            for i, j, k in np.argwhere(meets).tolist():
                z = lines.low[i, j, k], lines.high[i, j, k]
                at = at_low[i, j, k], at_high[i, j, k]
                parts = crossing(gear, pit, at, (z[0] + offset, z[1] + offset))
                rows += [(i, j, k, z[0] + (z[1] - z[0]) * s, z[0] + (z[1] - z[0]) * t, which) for s, t in parts]
    table = np.array(rows).reshape(-1, 6).T
    return Removed(*table[:3].astype(int), *table[3:5], table[5].astype(int))


def lost_length(lines, pits):
    """Lengths ``(phases, pairs, bands)`` [mm] of contact line that pits take, overlaps counted once."""
    found, out = removed(lines, pits), np.zeros(lines.low.shape)
    place = np.array([found.phase, found.column, found.band])
    for index in np.unique(place, axis=1).T:
        own = (place == index[:, None]).all(axis=0)
        out[tuple(index)] = union_length(found.low[own], found.high[own])
    return out / np.cos(lines.beta_b)


def total_length(pair, phase, *, face="helical", groove=0.0, pits=((), ())):
    """Total length of all contact lines [mm] at some phases ``(phases,)``, without what pits take.

    Without pits its mean over a cycle is ``eps_alpha b / cos(beta_b)``, b without the groove; it is constant when eps_alpha
    or the overlap ratio ``b tan(beta_b) / p_bt`` (of each half) is a whole number.

    Parameters
    ----------
    pair, phase, face, groove
        As in `contact_lines`.
    pits : (sequence of Pit, sequence of Pit)
        As in `removed`.

    Returns
    -------
    ndarray, shape (phases,)
    """
    lines = contact_lines(pair, phase, face=face, groove=groove)
    return (lines.length - lost_length(lines, pits)).sum(axis=(1, 2))
