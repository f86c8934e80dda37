"""Contacts and gaps of the tooth pairs of a gear pair: one function for every contact model.

**Pose.** An approach delta of the gears along the line of action is a rotation of both. Unless stated otherwise the pinion
rotates forward by ``delta / (2 r_b1)`` and the wheel backward by ``delta / (2 r_b2)``, from the unloaded position of a phase. In
this *mean pose* no gear is preferred. By symmetry, the contact of conjugate flanks stays where it is without load.

**Gap.** Let the pinion's flank cross the line of action at the abscissa n1 and the wheel's at n2; unloaded conjugate flanks
have ``n1 = n2 = n``, the nominal abscissa of their pair, and after an approach ``n1 = n + delta / 2``, ``n2 = n - delta / 2``.
A point of the pinion (its tip corner, after the end of the path) is at a distance D(n1) from the wheel's flank: the rotation of
the wheel that closes it, times r_b2. It touches when ``n1 - n2 = D(n1)``, so its gap is the approach that solves::

    delta = D(n + delta / 2)

For a point of the wheel (its tip corner, before the start), which the pinion's rotation E(n2) closes, it is ``delta = E(n - delta
/ 2)``. With ``delta = D(n)`` only the wheel would rotate, with ``delta = E(n)`` only the pinion: two conventions, one at each
end.

**Force.** Off the line of action the contact normal is that of the profile touched by the corner. The normal of a flank passes
its gear's centre at r_b, and the centre of the gear whose corner touches at ``q r_b`` (q is 0.96 at a gap of 6 um). In the
general case its distances from both centres are ``q_1 r_b1`` and ``q_2 r_b2``. A normal force N then gives torques with ``T1 /
r_b1 = q_1 N`` and ``T2 / r_b2 = q_2 N``, and a shared approach closes the pair by ``rate = (q_1 + q_2) / 2`` times the
approach. The work of the tooth forces in a shared approach is ``F d delta`` with ``F = (T1 / r_b1 + T2 / r_b2) / 2 = rate N``.
This F is the force of a contact. A tooth deflects along and across its own involute normal under both parts of N
(`gearfe.flexibility.plane.towards`). Other teeth deflect by its torque, ``(q / rate) F``. All deflections count as an approach
larger by ``1 / rate`` (`gearfe.contact.rows`; ``tests/contact/test_pose.py``).

**Other poses.** If only the pinion or only the wheel rotates: ``n1 = n + delta, n2 = n`` or ``n1 = n, n2 = n - delta``. That is
the mean pose of the nominal abscissa ``n + delta / 2`` or ``n - delta / 2``: a shift of the phase by half the approach.
"""

import math
from dataclasses import dataclass, fields
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..aliases import Floats
from ..kept import seal
from ..tooth.side import form_corner
from .approach import approach
from .gear_pair import GearPair

PITCHES = 8  # search range beyond the path [base pitches], for ring gears with few more teeth than their pinion
CLOSE = 0.02  # gap that no load closes [m_n]
ROUNDING = 1e-7  # rounding tolerance for overlaps of corners on the path of contact [m_n]
TIP, FORM = (1, 2), (3, 4)  # corner numbers: tips (pinion, wheel), form points (pinion, wheel)


@dataclass(frozen=True, slots=True)
class Contacts:
    """Tooth pairs in contact, or nearly so, at some phases (arrays of shape (phases, pairs)).

    `roll_1`, `roll_2` are the roll lengths [mm] of the touching points (in a fillet: names of places, `geometry.tooth.side`).
    `gap` is the approach of the gears along the line of action [mm], shared by both, at which the pair first touches. It is 0 on
    the path of contact, less where a tip cuts into its mate's fillet, and inf if the teeth cannot meet. `radius` is the relative
    radius of curvature there [mm] (1 where flanks cannot meet). `order` (pairs,) is the number of each pair: pair 0 enters at
    phase 0, and pair k is k base pitches ahead of it. `nominal` is the abscissa of the pair on the line of action [mm]. `corner`
    is the touching element: 0 both flanks, 1 or 2 the tip corner of pinion or wheel, 3 or 4 the form corner of an undercut pinion
    or wheel. `corner_gap` (4, phases, pairs) is the approach at which each of these corners touches (inf: never), `corner_roll`
    (2, 4, phases, pairs) the places of both gears there [mm]. Pair k is formed by the pinion's k-th tooth after tooth 0 towards
    the loaded side and the wheel's k-th towards the other side.
    """

    order: NDArray[np.int64]
    nominal: Floats
    roll_1: Floats
    roll_2: Floats
    gap: Floats
    corner: NDArray[np.int64]
    corner_gap: Floats
    corner_roll: Floats
    radius: Floats

    @property
    def rolls(self) -> tuple[Floats, Floats]:
        """Roll lengths of pinion and wheel."""
        return self.roll_1, self.roll_2

    @property
    def teeth(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Numbers of the teeth of pinion and wheel in each pair, counted towards their loaded sides."""
        return self.order, -self.order


class Touch(NamedTuple):
    """First contact of sections: roll lengths, gaps [mm], corners and relative radii of curvature [mm] (see `Contacts`)."""

    roll_1: Floats
    roll_2: Floats
    gap: Floats
    corner: NDArray[np.int64]
    corner_gap: Floats
    corner_roll: Floats
    radius: Floats

    @property
    def rolls(self) -> tuple[Floats, Floats]:
        """Roll lengths of pinion and wheel."""
        return self.roll_1, self.roll_2


def contacts(pair: GearPair, phase: ArrayLike, *, extended: bool = True) -> Contacts:
    """Return the contacts of all tooth pairs of a `GearPair` with unmodified flanks (others: `modified.flank_contacts`).

    On the path of contact the gap is zero, unless a tip cuts into its mate's fillet at the same time. Off the path a corner of
    one tooth touches the other's whole outline: a tip corner on the flank, on the edge of the other tip or in the fillet, or
    the form corner that undercut leaves on a flank, with the exact gap in the mean pose (see the module). Phases ``(phases,)``
    are any numbers: at 1.3 pair 0 is 1.3 base pitches into its engagement. Without `extended` pairs off the path never touch.
    """
    return _contacts(pair, np.atleast_1d(np.asarray(phase, dtype=float)).tobytes(), bool(extended))


@lru_cache(maxsize=8)
def _contacts(pair, phases, extended):
    """Return the read-only result of `contacts`. It is shared by pairs that differ only in cracks or loads."""
    phase, (start, end) = np.frombuffer(phases), pair.path
    before, after = near_pitches(pair) if extended else (1, 1)
    first, last = -before - math.floor(phase.max()), math.ceil((end - start) / pair.p_bt) - 1 + after - math.floor(phase.min())
    order = np.arange(first, last + 1)
    nominal = start + (phase[:, None] + order) * pair.p_bt
    out = Contacts(order, nominal, *touching(pair, nominal, extended=extended))
    seal([getattr(out, one.name) for one in fields(out)])
    return out


@lru_cache(maxsize=256)
def near_pitches(pair: GearPair) -> tuple[int, int]:
    """Return the base pitches before the start and after the end of the path within which teeth may touch, at least 1.

    Teeth of external gears move apart quickly. Those of a ring with hardly more teeth than its pinion stay close.
    """
    if not pair.gear_2.internal:
        return 1, 1
    start, end = pair.path
    out = []
    for sense, from_ in ((-1, start), (1, end)):
        away = np.arange(PITCHES)[:, None] + (np.arange(32) + 0.5) / 32
        gap = _corners(pair, from_ + sense * away * pair.p_bt)[2].min(axis=0)
        close = np.flatnonzero((gap < CLOSE * pair.gear_1.m_n).any(axis=1))
        out.append(max(1, int(close[-1]) + 1) if close.size else 1)
    return out[0], out[1]


def neighbours_of(pair: GearPair) -> int:
    """Return how many teeth after a tooth may be in contact with it, corners off the path of contact included."""
    return math.ceil(pair.eps_alpha) + sum(near_pitches(pair)) - 2


def touching(pair: GearPair, nominal: NDArray, *, extended: bool = True) -> Touch:
    """Return the first contact of sections of unmodified teeth, see `contacts`, at any abscissae `nominal` [mm]."""
    start, end = pair.path
    slack = 1e-9 * pair.p_bt
    path = (nominal >= start - slack) & (nominal < end + slack)
    roll_1, roll_2 = nominal.copy(), pair.mate_roll(nominal)
    gap, corner = np.where(path, 0.0, np.inf), np.zeros(nominal.shape, dtype=int)
    corner_gap, corner_roll = np.full((4, *nominal.shape), np.inf), np.full((2, 4, *nominal.shape), np.nan)
    before, after = near_pitches(pair) if extended else (0, 0)
    near = (nominal > start - before * pair.p_bt) & (nominal < end + after * pair.p_bt)
    if extended and near.any():
        rolls_1, rolls_2, gaps = _corners(pair, nominal[near])
        corner_gap[:, near], corner_roll[:, :, near] = gaps, np.array([rolls_1, rolls_2])
        nearest = (least := np.argmin(gaps, axis=0), np.arange(least.size))
        first = gaps[nearest] < np.where(path[near], -ROUNDING * pair.gear_1.m_n, np.inf)
        at_corner, chosen = near.copy(), tuple(index[first] for index in nearest)
        at_corner[near] = first
        roll_1[at_corner], roll_2[at_corner], corner[at_corner] = rolls_1[chosen], rolls_2[chosen], chosen[0] + 1
        gap[at_corner] = np.where(np.abs(gaps[chosen]) < ROUNDING * pair.gear_1.m_n, 0.0, gaps[chosen])
    radius = pair.relative_radius(roll_1, roll_2)
    radius = np.where(np.isfinite(gap) & (radius > 0), radius, pair.pitch_relative_radius)
    return Touch(roll_1, roll_2, gap, corner, corner_gap, corner_roll, radius)


def corners_of(pair: GearPair) -> list[tuple[int, float, bool]]:
    """Return the corners that may touch: number as in `Contacts`, roll length [mm], and whether it belongs to the pinion."""
    gears = pair.gears
    tips = [(number, gear.roll_a, number == 1) for number, gear in zip(TIP, gears, strict=True)]
    return tips + [(number, gear.roll_f, number == 3) for number, gear in zip(FORM, gears, strict=True) if form_corner(gear)]


def end_corners(pair: GearPair) -> tuple[int, int]:
    """Numbers of the corners (as in `Contacts`) that end the path: at its start, at its end.

    They are the tip corners of wheel and pinion, unless the mate's flank ends before, at the edge that undercut leaves.
    """
    pinion, wheel = pair.gears
    first = pair.outward * (pair.length - wheel.roll_a)
    return (
        3 if form_corner(pinion) and pinion.roll_f > first else 2,
        4 if form_corner(wheel) and pair.outward * (pair.length - wheel.roll_f) < pinion.roll_a else 1,
    )


def _corners(pair, nominal):
    """Roll lengths of both gears and gaps ``(4, ...)`` of the four corners, or inf where a corner does not touch."""
    rolls_1, rolls_2 = (np.tile(values, (4, *(1,) * nominal.ndim)) for values in (nominal, pair.mate_roll(nominal)))
    gaps, middle = np.full(rolls_1.shape, np.inf), sum(pair.path) / 2
    for number, roll, driver in corners_of(pair):
        # Each corner touches in its own half of the mesh cycle.
        half = nominal < middle if number in (2, 3) else nominal > middle
        half |= pair.gear_2.internal  # Tips of a ring gear and its pinion may also meet in the other half.
        distance, met = approach(pair, roll, nominal[half], driver=driver)[:2]
        host, other = (rolls_1, rolls_2) if driver else (rolls_2, rolls_1)
        host[number - 1], other[number - 1, half] = roll, np.where(np.isnan(met), other[number - 1, half], met)
        gaps[number - 1, half] = np.where(np.isnan(distance), np.inf, distance)
    return rolls_1, rolls_2, gaps
