"""One side of a tooth as a single curve from root circle to tip circle, fillet and flank included.

A place on the flank is given by its roll length. In the fillet, the parameter is continued so that
`geometry.tooth.profile.arc_at` remains an arc length, measured from the form point downwards. It is then no geometric roll
length and may be negative.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..aliases import Floats
from ..cubic import Cubic
from .gear import Gear
from .profile import arc_at, cartesian, fillet, fillet_length, flank, form_point, lengths, roll_at_arc, root_curve

POINTS = 200  # points of the fillet between root circle and form point
SHARPEST = 1e-3  # Form points with a smaller change of direction [rad] are no corners. It is zero at the limit of undercut.


class Place(NamedTuple):
    """Places of a tooth side: roll length [mm], angle from the centre-line [rad], and direction of the outward normal.

    The normal passes the gear's centre at the distance `arm` [mm] (r_b on the flank). The foot of the perpendicular from the
    centre to the normal is `lean` [mm] away from the place (the roll length on the flank).
    """

    roll: Floats
    angle: Floats
    arm: Floats
    lean: Floats


@lru_cache(maxsize=256)
def _fillet(gear):
    """Return a spline of angle [rad] and arc length to the form point [mm] over the square root of the relative fillet height."""
    phi = np.linspace(np.pi / 2, form_point(gear)[0], POINTS)
    radius, angle = fillet(gear, phi)
    height = np.sqrt(np.abs(radius - gear.r_f) / abs(radius[-1] - gear.r_f))
    length = lengths(cartesian(radius, angle))
    return Cubic(height, np.array([angle, length - length[-1]]).T)


def on_fillet(gear: Gear, roll: ArrayLike) -> NDArray[np.bool_]:
    """Return whether places lie in the fillet."""
    return gear.outward * (np.asarray(roll) - gear.roll_f) < 0


def side(gear: Gear, roll: ArrayLike) -> tuple[Floats, Floats]:
    """Radius [mm] and angle [rad] of places on the loaded side of a tooth, including the fillet."""
    roll = np.asarray(roll, dtype=float)
    low = on_fillet(gear, roll)
    if not low.any():
        return flank(gear, roll)
    length = fillet_length(gear) + arc_at(gear, roll) - arc_at(gear, gear.roll_f)
    down, up = root_curve(gear, length), flank(gear, roll)
    return np.where(low, down[0], up[0]), np.where(low, down[1], up[1])


def place(gear: Gear, radius: ArrayLike) -> Place:
    """Return the `Place` of the loaded side at some radii [mm]. Beyond tip and root circle its entries except `roll` are nan."""
    shape, radius = np.shape(radius), np.atleast_1d(radius)
    roll = np.sqrt(np.maximum(radius**2 - gear.r_b**2, 0.0))
    angle, arm, lean = flank(gear, roll)[1], np.full(radius.shape, gear.r_b), roll.copy()
    low = gear.outward * (radius - gear.r_form) < 0
    if low.any():
        down, whole = radius[low], abs(gear.r_form - gear.r_f)
        height = np.sqrt(np.maximum(gear.outward * (down - gear.r_f), 0.0) / whole)
        curve = _fillet(gear)
        angle[low], length = curve(height).T
        slope = down * gear.outward * curve(height, 1)[:, 0] / (2 * np.maximum(height, 1e-9) * whole)
        arm[low] = down / np.hypot(1.0, slope)
        lean[low] = -gear.outward * slope * arm[low]
        roll[low] = roll_at_arc(gear, arc_at(gear, gear.roll_f) + length)
    least, most = sorted((gear.r_f, gear.r_a))
    slack = 1e-9 * gear.m_n
    outside = ~((radius >= least - slack) & (radius <= most + slack))
    for values in (angle, arm, lean):
        values[outside] = np.nan
    return Place(*(values.reshape(shape) for values in (roll, angle, arm, lean)))


@lru_cache(maxsize=256)
def form_corner(gear: Gear) -> bool:
    """Return whether flank and fillet meet in an edge (by undercut) without a common tangent."""
    x, y = cartesian(*fillet(gear, form_point(gear)[0] + np.array([0.0, 1e-6])))
    # direction up the fillet, whose normal has the distance `arm` from the centre; the flank's has r_b
    step = x[0] - x[1], y[0] - y[1]
    arm = gear.outward * (x[0] * step[0] + y[0] * step[1]) / np.hypot(*step)
    return bool(abs(np.arccos(min(arm / gear.r_form, 1.0)) - np.arccos(gear.r_b / gear.r_form)) > SHARPEST)
