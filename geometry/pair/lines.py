"""Contact lines of spur, helical and herringbone pairs, with exact positions along the width.

All transverse sections of a helical pair are equal except for a rotation of ``tan(beta) / r`` per mm of height z. The pinion's
roll length of the contact points is therefore linear in z::

    roll(z) = roll(0) + tan(beta_b) z

with the sign of the pinion's beta: where it is positive, the far end z = b is ahead and touches first. In the plane of action
the line is inclined by beta_b to the axis, and its length is that along z over cos(beta_b). Heights are measured over the
common width of both gears, from the same end face as positions of a `Pit`. The mid-planes of both gears coincide.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..damage.hollow import rolls, union_length
from ..kept import keeping
from .gear_pair import GearPair

FACES = ("spur", "helical", "herringbone")


class Band(NamedTuple):
    """Part of the face with one hand of helix.

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
        Numbers of the tooth pairs, see `gearfe.geometry.pair.contacts.Contacts`.
    low, high : ndarray, shape (phases, pairs, bands)
        Heights [mm] of both ends of a contact line; equal without contact.
    roll_0 : ndarray, shape (phases, pairs, bands)
        The pinion's roll length [mm] of the line, extended to z = 0.
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
        """Inclination of the lines of each band to the axis [rad], in the plane of action."""
        return np.arctan([band.slope for band in self.bands])

    @property
    def length(self):
        """Lengths of the lines ``(phases, pairs, bands)`` [mm], neglecting pits."""
        return (self.high - self.low) / np.cos(self.beta_b)

    def rolls(self, z):
        """Roll lengths [mm] of pinion and wheel at heights `z` ``(..., phases, pairs, bands)`` [mm]."""
        roll_1 = self.roll_0 + np.array([band.slope for band in self.bands]) * z
        return roll_1, self.pair.mate_roll(roll_1)


@dataclass(frozen=True, slots=True)
class Removed:
    """Pieces of contact lines inside pits (n of them), which may overlap.

    `phase`, `column`, `band` are indices into the arrays of `Lines`, `low` and `high` heights [mm], `gear` 0 for a pit of the
    pinion and 1 for one of the wheel.
    """

    phase: np.ndarray
    column: np.ndarray
    band: np.ndarray
    low: np.ndarray
    high: np.ndarray
    gear: np.ndarray


def halves(pair, face, groove=0.0):
    """Return the parts of the common width of both gears with one hand of helix, each from its outer to its inner end.

    Parameters
    ----------
    pair : GearPair
    face : {"spur", "helical", "herringbone"}
        ``spur`` and ``helical``: one part, the whole width from z = 0. ``herringbone``: two mirrored ones of width
        ``(b - groove) / 2`` left and right of a relief groove in the middle.
    groove : float
        Its width [mm].

    Returns
    -------
    list of (float, float)
        Heights [mm].

    Raises
    ------
    ValueError
        If the face is none of these, or the groove is not that of a herringbone pair or leaves no width.
    """
    if face not in FACES:
        raise ValueError(f"face = {face!r}, but it must be one of {', '.join(FACES)}")
    if groove and face != "herringbone":
        raise ValueError(f"groove = {groove} mm, but only face = 'herringbone' has a relief groove")
    width = pair.b_w
    if not 0 <= groove < width:
        raise ValueError(f"groove = {groove} mm, but it must lie between 0 and the face width of {width:g} mm")
    if face != "herringbone":
        return [(0.0, width)]
    half = (width - groove) / 2
    return [(0.0, half), (width, width - half)]


def face_bands(pair, face="helical", groove=0.0):
    """Return the bands of the face width in contact, one `Band` for each helical half of a pair.

    The pinion's beta is that of the half at z = 0, and the phase is counted at z = 0, for a herringbone pair at both outer ends:
    with beta > 0 the inner ends touch first, with beta < 0 the outer ones. `halves` describes the parameters. A helical pair of
    beta = 0 is a spur one.

    Returns
    -------
    tuple of Band

    Raises
    ------
    ValueError
        For the reasons of `halves`, and if gears with a helix angle are called spur gears.
    """
    slope = math.tan(pair.gear_1.beta_b)
    if face == "spur" and slope:
        raise ValueError("face = 'spur', but the gears have a helix angle: give beta = 0, or face = 'helical'")
    parts = halves(pair, face, groove)
    return tuple(Band(*sorted(part), hand * slope, part[0]) for part, hand in zip(parts, (1, -1), strict=False))


def bands_of(pair, face, groove):
    """Return the bands of the face as (end that touches first, other end) [mm]. Herringbone bands start at the outer ends.

    Parameters and errors are those of `face_bands`.
    """
    bands = face_bands(pair, face, groove)
    if face != "herringbone" and pair.gear_1.beta > 0:
        return [(band.high, band.low) for band in bands]
    return halves(pair, face, groove)


def contact_lines(pair, phase, *, face="helical", groove=0.0):
    """Return the contact lines, at some phases, of all tooth pairs in contact on the path of contact.

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
    bands, (start, end) = face_bands(pair, face, groove), pair.path
    phase = np.atleast_1d(np.asarray(phase, dtype=float))
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
    """Return the heights between which the line lies on the path of contact."""
    if abs(band.slope) * (band.high - band.low) < 1e-12 * pitch:
        slack = 1e-9 * pitch
        inside = (roll_0 >= start - slack) & (roll_0 < end + slack)
        return np.full(roll_0.shape, band.low), np.where(inside, band.high, band.low)
    ends = np.sort([(start - roll_0) / band.slope, (end - roll_0) / band.slope], axis=0)
    low, high = np.clip(ends, band.low, band.high)
    return low, high


def removed(lines, pits):
    """Return the pieces of contact lines inside pits.

    Parameters
    ----------
    lines : Lines
    pits : (sequence of Pit, sequence of Pit)
        Pits of pinion and wheel with each gear's own tooth numbers; those on unloaded flanks are ignored.

    Returns
    -------
    Removed
    """
    pair, (i, j, k) = lines.pair, np.nonzero(lines.high > lines.low)
    z = np.stack([lines.low, lines.high], axis=-1)[i, j, k]
    roll_1 = lines.roll_0[i, j, k, None] + np.array([band.slope for band in lines.bands])[k, None] * z
    row, gear, first, last = covered(pair, pits, lines.order[j], (roll_1, pair.mate_roll(roll_1)), z)
    low, high = (z[row, 0] + (z[row, 1] - z[row, 0]) * part for part in (first, last))
    return Removed(i[row], j[row], k[row], low, high, gear)


def covered(pair, pits, order, rolls, z):
    """Return the pieces of straight contact lines inside pits of their tooth pairs.

    Parameters
    ----------
    pair : GearPair
    pits : (sequence of Pit, sequence of Pit)
        As in `removed`.
    order : ndarray, shape (n,)
        Number of the tooth pair each piece belongs to.
    rolls : (ndarray, ndarray), shape (n, 2)
        Roll lengths of pinion and wheel [mm] at the two ends.
    z : ndarray, shape (n, 2)
        Heights [mm] there.

    Returns
    -------
    piece, gear : ndarray, shape (m,)
        Number of the piece; 0 for a pit of the pinion, 1 for one of the wheel.
    first, last : ndarray, shape (m,)
        Part of the piece that a pit takes, 0 at its first end and 1 at the other; parts may overlap.
    """
    rows, common = [], pair.b_w
    for which, (gear, gear_pits) in enumerate(zip(pair.gears, pits, strict=True)):
        gear_pits = tuple(pit for pit in gear_pits if pit.side == "loaded")
        if not gear_pits or not order.size:
            continue
        tooth, near, far, bottom, top = _limits(gear, gear_pits)
        height = z + (gear.b - common) / 2  # The mid-planes of both gears coincide.
        meets = (tooth - (1 - 2 * which) * order[:, None]) % gear.z == 0
        meets &= (rolls[which].min(axis=1)[:, None] <= far) & (rolls[which].max(axis=1)[:, None] >= near)
        meets &= (height.min(axis=1)[:, None] < top) & (height.max(axis=1)[:, None] > bottom)
        for i, k in np.argwhere(meets).tolist():
            rows += [(i, which, s, t) for s, t in gear_pits[k].crossing(gear, rolls[which][i], height[i])]
    piece, gear, first, last = np.array(rows, dtype=float).reshape(-1, 4).T
    return piece.astype(int), gear.astype(int), first, last


@keeping(64)
def _limits(gear, pits):
    """Return the tooth numbers of pits, and the limits of their roll lengths and heights [mm] (five arrays ``(pits,)``)."""
    near, far = np.sort([rolls(gear, pit) for pit in pits], axis=1).T
    tooth, z, reach = np.array([(pit.tooth, pit.z, pit.reach[1]) for pit in pits]).T
    return tooth, near, far, z - reach, z + reach


def lost_length(lines, pits):
    """Return the lengths ``(phases, pairs, bands)`` [mm] of contact line that pits remove. Overlaps count once."""
    cut, out = removed(lines, pits), np.zeros(lines.low.shape)
    place = np.array([cut.phase, cut.column, cut.band])
    for index in np.unique(place, axis=1).T:
        at_place = (place == index[:, None]).all(axis=0)
        out[tuple(index)] = union_length(cut.low[at_place], cut.high[at_place])
    return out / np.cos(lines.beta_b)


def total_length(pair, phase, *, face="helical", groove=0.0, pits=((), ())):
    """Total length of all contact lines [mm] at some phases ``(phases,)``, excluding parts in pits.

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
