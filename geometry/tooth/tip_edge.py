"""Rounded or chamfered edge between flank and tip circle, as material removed from the involute."""

import math

import numpy as np
import scipy
from numpy.typing import NDArray

from ..aliases import Floats
from .gear import Gear
from .profile import cartesian, flank, flank_normal

LARGEST = 0.3  # largest rounding or chamfer [m_n], which leaves enough of the flank
FROM_FLANK = math.pi / 4  # angle between a chamfer and the flank it cuts [rad]
SOFT = -1e-9  # This marks the start of a rounding as a kink without a bend. Its larger curvature requires a fine contact mesh.


class TipEdge:
    """Tip edge of a gear: a rounding tangent to flank and tip circle, or a chamfer under 45 degrees.

    Attributes
    ----------
    start : float
        Roll length at which it begins [mm].
    kink : float
        Jump of the derivative of the removed material by roll length at the start. For a rounding: `SOFT`.
    most : float
        Material removed at the intersection of edge and tip circle [mm].
    """

    def __init__(self, gear: Gear, rounding: float, chamfer: float) -> None:
        self.gear, self.rounding = gear, rounding
        name, size = ("tip_rounding", rounding) if rounding else ("tip_chamfer", chamfer)
        if not 0 < size <= LARGEST * gear.m_n:
            raise ValueError(
                f"{name} = {size:g} mm, but give one between 0 and {LARGEST * gear.m_n:g} mm ({LARGEST} m_n) of z = {gear.z}: "
                "a larger tip edge changes the tooth form; change the addendum instead"
            )
        if rounding:
            self.start = self._touching()
            first, normal = self._place(self.start)
            self._centre = gear.r_a - gear.outward * size, math.atan2(*(first - size * normal))
            self.kink = SOFT
        else:
            self.start = self._below(size)
            first, normal = self._place(self.start)
            upwards = np.array([-normal[1], normal[0]])
            upwards *= math.copysign(1.0, gear.outward * (upwards @ first))
            cut = math.cos(FROM_FLANK) * upwards - math.sin(FROM_FLANK) * normal
            self._line = first, cut
            radius, up = math.hypot(*first), first @ cut
            if gear.outward * up <= 0 or up**2 < radius**2 - gear.r_a**2:
                raise ValueError(f"tip_chamfer = {size:g} mm does not reach the tip circle of z = {gear.z}: give a smaller one")
            # dtheta/dR of the cut times R; the involute's value is -start / r_b
            across = (first[1] * cut[0] - first[0] * cut[1]) / up
            self.kink = abs(gear.r_b * across + gear.outward * self.start) * self.start / radius**2
        left = float(self._angle(np.array([gear.roll_a]))[0])
        if left <= 0:
            raise ValueError(f"{name} = {size:g} mm cuts beyond the centre-line of a tooth of z = {gear.z}: give a smaller one")
        self.most = gear.r_b * (float(flank(gear, gear.roll_a)[1]) - left)

    def _place(self, roll: float) -> tuple[Floats, Floats]:
        """Return a point of the flank [mm], and its normal out of the material."""
        return cartesian(*flank(self.gear, roll)), flank_normal(self.gear, roll)

    def _touching(self) -> float:
        """Return the roll length [mm] where the arc touches. Its centre is `rounding` inside (ring: outside) the tip circle."""
        gear, size = self.gear, self.rounding
        reach = gear.r_a - gear.outward * size

        def apart(roll: float) -> float:
            point, normal = self._place(roll)
            return gear.outward * (math.hypot(*(point - size * normal)) - reach)

        if apart(gear.roll_f) > 0 or apart(gear.roll_a) < 0:
            raise ValueError(f"tip_rounding = {size:g} mm does not fit on the flank of z = {gear.z}: give a smaller one")
        return float(scipy.optimize.brentq(apart, *gear.flank_rolls, xtol=1e-13 * gear.m_n, rtol=1e-14))

    def _below(self, size: float) -> float:
        """Return the roll length [mm] at a distance `size` below the tip circle."""
        gear = self.gear
        radius = gear.r_a - gear.outward * size
        if gear.outward * (radius - gear.r_form) <= 0 or radius <= gear.r_b:
            raise ValueError(f"tip_chamfer = {size:g} mm leaves no flank of z = {gear.z}: give a smaller one")
        return math.sqrt(radius**2 - gear.r_b**2)

    def _angle(self, roll: Floats) -> Floats:
        """Return the angle of the edge from the tooth centre-line [rad] at the radii of roll lengths.

        For a rounding, the gear's centre, the centre of the arc and the point form a triangle with the sides c, rounding and
        R. Its angle at the gear's centre is computed from ``d = |r_a - R|``, which is exact at the end of the arc. For a
        chamfer, ``|first + t cut| = R`` is solved.
        """
        gear = self.gear
        radius = np.hypot(roll, gear.r_b)
        if self.rounding:
            away, middle = self._centre
            d = np.maximum(gear.outward * (gear.roll_a**2 - roll**2) / (gear.r_a + radius), 0.0)
            return middle + 2 * np.arcsin(np.sqrt(d * np.maximum(2 * self.rounding - d, 0.0) / (4 * radius * away)))
        first, cut = self._line
        up, rise = first @ cut, roll**2 - self.start**2
        t = rise / (up + gear.outward * np.sqrt(np.maximum(up**2 + rise, 0.0)))
        return np.arctan2(first[0] + t * cut[0], first[1] + t * cut[1])

    def removed(self, roll: Floats) -> Floats:
        """Return the material removed at roll lengths [mm]. It is constant beyond the tip circle."""
        gear, on = self.gear, self.on(roll)
        low, high = sorted((self.start, gear.roll_a))
        at = np.clip(np.where(on, roll, self.start), low, high)
        return np.where(on, gear.r_b * (flank(gear, at)[1] - self._angle(at)), 0.0)

    def on(self, roll: Floats) -> NDArray[np.bool_]:
        """Return whether places of the flank lie on the edge."""
        return self.gear.outward * (roll - self.start) > 0

    def bend(self, roll: Floats) -> Floats:
        """Return the curvature of the tip edge minus that of the involute [1/mm]."""
        return (1 / self.rounding if self.rounding else 0.0) - self.gear.outward / roll
