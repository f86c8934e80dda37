"""Approach at which a point of one gear's side meets the other gear, as `geometry.pair.contacts` defines it."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..aliases import Floats
from ..tooth.flank_form import FlankForm
from ..tooth.profile import cartesian
from ..tooth.side import place, side
from .gear_pair import GearPair

STEPS = 10  # limit of Newton steps; each doubles the correct digits, or adds three digits if a modified flank has a slope
SETTLED = 1e-7  # tolerance of the last Newton step [base pitches]
EXACT = 1e-13  # tighter tolerance for light loads, whose approach is small
SQUARED = 1e-9  # tolerance for unmodified flanks, whose convergence is quadratic


class Met(NamedTuple):
    """First contact of points with the other side: approach `gap`, and roll length `roll` of the touched point [mm].

    `arm` and `met_arm` are the distances of the contact normal from the centres of the point's own gear and of the other gear,
    divided by their base radii. `out` and `met_out` are the components of a unit contact force away from these centres, each
    on its own gear.
    """

    gap: Floats
    roll: Floats
    arm: Floats
    met_arm: Floats
    out: Floats
    met_out: Floats


def approach(
    pair: GearPair,
    roll: ArrayLike,
    nominal: ArrayLike,
    *,
    driver: bool = True,
    start: ArrayLike = 0.0,
    flanks: tuple[FlankForm, FlankForm] | None = None,
    order: ArrayLike = 0,
) -> Met:
    """Return the shared approach of both gears at which a point of one side touches the other side.

    Parameters
    ----------
    pair : GearPair
    roll : float or ndarray
        Place on the pinion's side (``driver=True``) or the wheel's, flank or fillet [mm], see `gearfe.geometry.tooth.side`.
    nominal : ndarray
        Abscissa of the pair's contact on the line of action [mm]; off the path of contact, where it would be.
    driver : bool
    start : float or ndarray
        First guess of the approach [mm].
    flanks : (FlankForm, FlankForm), optional
        Modifications of pinion and wheel (`gearfe.geometry.tooth.modified`); the point is then one of the modified flank.
    order : int or ndarray
        Number of the pair, whose teeth have their own pitch deviations.

    Returns
    -------
    Met
        nan where the two never touch (more than a base pitch apart, or beyond the tip or the root circle).
    """
    sense = 1 if driver else -1
    roll, nominal = np.broadcast_arrays(np.asarray(roll, dtype=float), np.asarray(nominal, dtype=float))
    gap, distances = np.array(np.broadcast_to(start, nominal.shape), dtype=float), facing(pair, roll, nominal, driver)
    back: Floats | float = 0.0
    mate = None
    if flanks is not None:
        host, mate = (form.of(order) for form in (flanks if driver else flanks[::-1]))
        back, behind = host.removed(roll) + host.shift(order), mate.shift(order)
    for _ in range(STEPS):
        distance, met, *arms = distances(sense * (gap / 2 - back))
        if mate is not None:
            distance = distance + back + mate.removed(met) + behind
        step = 2 * (distance - gap) / (1 + arms[0] / arms[1])
        facing_it = (np.abs(distance) < pair.p_bt) & (arms[0] > 0) & (arms[1] > 0)
        gap = gap + np.where(facing_it, step, np.nan)  # Otherwise the flanks face away from each other and cannot touch.
        if not (np.abs(step) >= (SQUARED if mate is None else EXACT) * pair.p_bt).any():
            break
    if mate is not None:
        arms = distances(sense * (gap / 2 - back), mate.slope(met))[2:]
    settled = np.abs(step) < SETTLED * pair.p_bt
    return Met(*(np.where(settled, values, np.nan) for values in (gap, met, *arms)))


def facing(pair, roll, nominal, driver, turns=None):
    """Return the contact geometry for points of one side, with both gears moved from `nominal` along the line of action [mm].

    The result is a function of that motion [mm]. It returns the distance [mm] along the line of action: the rotation of the
    *other gear alone* that closes it times its base radius. The roll length of the place met there [mm] follows, nan beyond the
    tip or root circle. Four values follow. Two are the lever arms of the normal about the centre of the
    point's gear and of the other gear, divided by their base radii (1 on the line of action). Two are the radial components of a
    unit force on either gear, positive outwards.
    `turns` is ``pair.turn(nominal)``, if known.
    """
    gears, centres, mirror = pair.gears, (0.0, pair.centre_2), (1, pair.outward)
    pushes = (1, -pair.outward)  # sign of the moment of the contact force about each centre
    host, other, sense = (0, 1, -1) if driver else (1, 0, 1)  # The force acts on the wheel and its reaction on the pinion.
    turns, mate = pair.turn(nominal) if turns is None else turns, gears[other]
    radius, angle = side(gears[host], roll)
    ahead, apart = turns[host] + mirror[host] * angle, centres[host] - centres[other]
    r_b, base = gears[host].r_b, mate.r_b

    def distances(moved, slope=0.0):
        x, y = cartesian(radius, ahead + pushes[host] * moved / r_b)
        y = y + apart
        away, seen = np.hypot(x, y), np.arctan2(x, y)
        met = place(mate, away)
        behind = mirror[other] * (seen - turns[other] - pushes[other] * moved / base) - met.angle
        # The normal of a modified flank is rotated by its slope.
        met_arm, lean = met.arm - slope * met.lean, met.lean + slope * met.arm
        across = pushes[other] * (met_arm * y + lean * x) / away**2  # component of the mate's normal across the centre line
        arm = pushes[host] * (pushes[other] * met_arm - apart * across) / r_b
        up = pushes[other] * (lean * y - met_arm * x) / away**2  # component along the centre line
        out = sense * (across * x + up * (y - apart)) / radius
        gap = base * ((behind + math.pi) % (2 * math.pi) - math.pi)
        return gap, met.roll, arm, met_arm / base, out, -sense * pushes[other] * lean / away

    return distances
