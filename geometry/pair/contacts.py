"""Where the tooth pairs of a gear pair touch, and how far they are from touching: one function for every contact model.

**Pose.** An approach delta of the gears along the line of action is a turn of both: unless said otherwise the pinion turns
forward by ``delta / (2 r_b1)`` and the wheel backward by ``delta / (2 r_b2)``, from the unloaded position that a phase names.
In this *mean pose* no gear is preferred and, by symmetry, the contact of conjugate flanks stays where it is without load.

**Gap.** Let the pinion's flank cross the line of action at the abscissa n1 and the wheel's at n2; unloaded conjugate flanks
have ``n1 = n2 = n``, the nominal abscissa of their pair, and after an approach ``n1 = n + delta / 2``, ``n2 = n - delta / 2``.
A point of the pinion (its tip corner, after the end of the path) lies D(n1) from the wheel's flank: the turn of the wheel that
closes it, times r_b2. It touches when ``n1 - n2 = D(n1)``, so its gap is the approach that solves::

    delta = D(n + delta / 2)

and for a point of the wheel (its tip corner, before the start), which the pinion's turn E(n2) closes,
``delta = E(n - delta / 2)``. With ``delta = D(n)`` the wheel would have turned alone, with ``delta = E(n)`` the pinion: two
conventions, one at each end.

**Force.** Off the line of action the contact normal is the met flank's: tangent to that gear's base circle, it passes the centre
of the gear whose tip touches at ``q r_b`` instead of r_b (q is 0.96 at a gap of 6 um). That gear feels less torque from the same
normal force, ``T1 / r_b1`` and ``T2 / r_b2`` differ, and a shared approach closes the pair by ``rate = (1 + q) / 2`` of itself
(Newton's method for delta divides by it). The work of the tooth forces in a shared approach is ``F d delta`` with
``F = (T1 / r_b1 + T2 / r_b2) / 2``: this is the force meant. A tooth bends by torque: its deflection as a turn of the flank times
r_b is that of a force along its own involute normal with the same torque. Contact models therefore put the part of F that a pair
carries on both flanks along their own involute normals, without rate; what this neglects is of the order of ``1 - rate`` of the
local, not the bending deflection of the pair at the corner (see ``tests/contact/test_pose.py`` for its size against CalculiX).

**Other poses.** Let the pinion alone turn, or the wheel: ``n1 = n + delta, n2 = n`` or ``n1 = n, n2 = n - delta``. That is the
mean pose of the nominal abscissa ``n + delta / 2`` or ``n - delta / 2``: a shift of the phase by half the approach.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..tooth.profile import cartesian, flank

if TYPE_CHECKING:
    from ..tooth.flank_form import FlankForm
    from .gear_pair import GearPair

STEPS = 8  # of Newton's method at most: each doubles the correct digits, or adds three where a modified flank slopes
SETTLED = 1e-7  # last step, in base pitches
EXACT = 1e-13  # the same, where no further step is needed: light loads close by less than any larger


@dataclass(frozen=True, slots=True)
class Contacts:
    """The tooth pairs that touch, or nearly do, at some phases (arrays of shape (phases, pairs)).

    `roll_1`, `roll_2` are the roll lengths [mm] of the touching points, `gap` the approach of the gears along the line of action
    [mm], shared by both, at which the pair first touches (0 on the path of contact; inf: the flanks cannot meet), `radius` the
    relative radius of curvature there [mm] (1 where flanks cannot meet), `order` (pairs,) the number of each pair: pair 0 enters
    at phase 0 and pair k is k base pitches ahead of it, `nominal` the abscissa of the pair on the line of action [mm]. Pair k is
    formed by the pinion's k-th tooth beside tooth 0 on the loaded side and the wheel's k-th on the other.
    """

    order: NDArray[np.int64]
    nominal: NDArray[np.float64]
    roll_1: NDArray[np.float64]
    roll_2: NDArray[np.float64]
    gap: NDArray[np.float64]
    radius: NDArray[np.float64]


def contacts(pair: "GearPair", phase: ArrayLike, *, extended: bool = True) -> Contacts:
    """Contacts of all tooth pairs of a `GearPair`.

    On the path of contact the gap is zero. Beyond it one tip corner slides on the other flank: the pinion's after the end, the
    wheel's before the start, with the exact gap in the mean pose (see the module).

    Parameters
    ----------
    pair : GearPair
    phase : ndarray, shape (phases,)
        Any numbers: at phase 1.3 pair 0 is 1.3 base pitches into its engagement.
    extended : bool
        With False pairs off the path of contact never touch.

    Returns
    -------
    Contacts
    """
    phase = np.atleast_1d(np.asarray(phase, dtype=float))
    start, end = pair.path
    first, last = -1 - math.floor(phase.max()), math.ceil((end - start) / pair.p_bt) - math.floor(phase.min())
    order = np.arange(first, last + 1)
    nominal = start + (phase[:, None] + order) * pair.p_bt
    roll_1, roll_2, gap = touching(pair, nominal, extended=extended)
    radius = pair.relative_radius(roll_1, roll_2)
    return Contacts(order, nominal, roll_1, roll_2, gap, np.where(np.isfinite(gap) & (radius > 0), radius, 1.0))


def touching(pair: "GearPair", nominal: NDArray, *, extended: bool = True) -> tuple[NDArray, NDArray, NDArray]:
    """Roll lengths of both gears where sections touch, and their gaps [mm], as of `contacts`, at any abscissae `nominal` [mm]."""
    start, end = pair.path
    slack = 1e-9 * pair.p_bt
    before, after = nominal < start - slack, nominal >= end + slack
    roll_1, roll_2 = nominal.copy(), pair.mate_roll(nominal)
    gap = np.where(before | after, np.inf, 0.0)
    if extended:  # a base pitch away teeth are turned out of each other's reach, until the same tooth comes round again
        near = (nominal > start - pair.p_bt) & (nominal < end + pair.p_bt)
        for where, driver in ((after & near, True), (before & near, False)):
            tip, other = (pair.gear_1, pair.gear_2) if driver else (pair.gear_2, pair.gear_1)
            own, met = (roll_1, roll_2) if driver else (roll_2, roll_1)
            distance, roll = approach(pair, tip.roll_a, nominal[where], driver=driver)
            low, high = sorted((other.roll_f, other.roll_a))
            meets = (roll >= low) & (roll <= high)
            there = tuple(index[meets] for index in np.nonzero(where))
            own[there], met[there] = tip.roll_a, roll[meets]
            gap[there] = np.maximum(distance[meets], 0.0)
    return roll_1, roll_2, gap


def approach(
    pair: "GearPair",
    roll: ArrayLike,
    nominal: ArrayLike,
    *,
    driver: bool = True,
    start: ArrayLike = 0.0,
    flanks: "tuple[FlankForm, FlankForm] | None" = None,
    order: ArrayLike = 0,
) -> tuple[NDArray, NDArray]:
    """Approach, shared by both gears, at which a flank point touches the other flank (see the module).

    Parameters
    ----------
    pair : GearPair
    roll : float or ndarray
        Roll length of a point on the pinion's flank (``driver=True``) or the wheel's [mm].
    nominal : ndarray
        Abscissa of the pair's contact on the line of action [mm]; off the path of contact, where it would be.
    driver : bool
    start : float or ndarray
        First guess of the approach [mm].
    flanks : (FlankForm, FlankForm), optional
        Modifications of pinion and wheel (`geometry.tooth.modified`); the point is then one of the modified flank.
    order : int or ndarray
        Number of the pair, whose teeth have their own pitch deviations.

    Returns
    -------
    gap, met : ndarray
        The approach [mm] and the roll length of the point met on the other flank [mm]; nan where the two never touch (more than a
        base pitch apart, or inside the base circle).
    """
    sense = 1 if driver else -1
    roll, nominal = np.broadcast_arrays(np.asarray(roll, dtype=float), np.asarray(nominal, dtype=float))
    gap, distances = np.array(np.broadcast_to(start, nominal.shape), dtype=float), facing(pair, roll, nominal, driver)
    back: NDArray[np.float64] | float = 0.0
    mate = None
    if flanks is not None:
        own, mate = (form.of(order) for form in (flanks if driver else flanks[::-1]))
        back, behind = own.removed(roll) + own.shift(order), mate.shift(order)
    for _ in range(STEPS):
        distance, met, arm = distances(sense * (gap / 2 - back))
        if mate is not None:
            distance = distance + back + mate.removed(met) + behind
        step = (distance - gap) / ((1 + arm) / 2)
        gap = gap + np.where((np.abs(distance) < pair.p_bt) & (arm > 0), step, np.nan)  # else the flanks face away: no contact
        if not (np.abs(step) >= EXACT * pair.p_bt).any():
            break
    there = np.abs(step) < SETTLED * pair.p_bt
    return np.where(there, gap, np.nan), np.where(there, met, np.nan)


def opposite(pair: "GearPair", roll: ArrayLike, nominal: ArrayLike, *, driver: bool = True) -> tuple[NDArray, NDArray]:
    """What a flank point faces when both gears stand as their contact at `nominal` has them.

    Parameters
    ----------
    pair, roll, nominal, driver
        As in `approach`.

    Returns
    -------
    gap, roll : ndarray
        Distance to the other flank along the line of action, i.e. the turn of the *other gear alone* that closes it times its
        base radius [mm], and the roll length of the point met there [mm]; nan where the point lies inside the base circle.
    """
    return facing(pair, np.asarray(roll, dtype=float), np.asarray(nominal, dtype=float), driver)(0.0)[:2]


def facing(pair, roll, nominal, driver, turns=None):
    """What flank points face with both gears moved on from `nominal` by a length on the line of action [mm].

    Gives `opposite`, and the distance at which the met normal passes the point's own centre, over its base radius. `turns` is
    ``pair.turn(nominal)``, if it is known.
    """
    gears, centres, mirror = (pair.gear_1, pair.gear_2), (0.0, pair.centre_2), (1, pair.outward)
    pushes = (1, -pair.outward)  # sense of a force along the line of action around the two centres
    own, other = (0, 1) if driver else (1, 0)
    turns, mate = pair.turn(nominal) if turns is None else turns, gears[other]
    radius, angle = flank(gears[own], roll)
    ahead, apart = turns[own] + mirror[own] * angle, centres[own] - centres[other]
    r_b, base = gears[own].r_b, mate.r_b

    def distances(moved):
        x, y = cartesian(radius, ahead + pushes[own] * moved / r_b)
        y = y + apart
        away, seen = np.hypot(x, y), np.arctan2(x, y)
        met = np.sqrt(np.where(away >= base, away**2 - base**2, np.nan))
        behind = mirror[other] * (seen - turns[other] - pushes[other] * moved / base) - flank(mate, met)[1]
        across = pushes[other] * (base * y + met * x) / away**2  # of the met flank's unit normal, across the centre line
        arm = pushes[own] * (pushes[other] * base - apart * across) / r_b
        return base * ((behind + math.pi) % (2 * math.pi) - math.pi), met, arm

    return distances
