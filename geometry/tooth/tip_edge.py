"""The rounded or chamfered edge between flank and tip circle, as material removed from the involute."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from .gear import Gear
from .profile import cartesian, flank, flank_normal, roll_at_arc

POINTS = 400  # of the profile between flank and tip circle
LARGEST = 0.3  # m_n: what is left of the flank must still be one
FROM_FLANK = math.pi / 4  # between a chamfer and the flank it cuts
SOFT = -1e-9  # "kink" at the start of a rounding: no sudden bend, but a curvature so much larger that contact is resolved there


class TipEdge:
    """A rounding tangent to flank and tip circle, or a chamfer under 45 degrees, of a gear's tip.

    Attributes
    ----------
    start : float
        Roll length at which it begins [mm].
    kink : float
        By how much the material removed rises there by mm of roll length; of a rounding `SOFT`.
    most : float
        Removed where the edge meets the tip circle [mm].
    """

    def __init__(self, gear: Gear, rounding: float, chamfer: float) -> None:
        self.gear, self.rounding = gear, rounding
        name, size = ("tip_rounding", rounding) if rounding else ("tip_chamfer", chamfer)
        if not 0 < size <= LARGEST * gear.m_n:
            raise ValueError(
                f"{name} = {size:g} mm, but give one between 0 and {LARGEST * gear.m_n:g} mm ({LARGEST} m_n) of z = {gear.z}: "
                "larger ones are another tooth; change the addendum"
            )
        points = self._rounded() if rounding else self._chamfered(chamfer)
        radius, angle = np.hypot(*points), np.arctan2(*points)
        roll = np.sqrt(radius**2 - gear.r_b**2)
        removed = gear.r_b * (flank(gear, roll)[1] - angle)
        order = np.argsort(roll)
        self._spline = PchipInterpolator(roll[order], removed[order], extrapolate=False)
        self.most = float(removed.max())
        self.start = float(roll[0])
        rise = abs(float((removed[1] - removed[0]) / (roll[1] - roll[0])))
        self.kink = SOFT if rounding else rise

    def _rounded(self) -> NDArray[np.float64]:
        """Points of the arc whose centre lies inside the flank and inside (a ring: outside) the tip circle by its radius."""
        gear, size = self.gear, self.rounding
        reach = gear.r_a - gear.outward * size

        def centre(roll: float) -> NDArray[np.float64]:
            return cartesian(*flank(gear, roll)) - size * flank_normal(gear, roll)

        def apart(roll: float) -> float:
            return gear.outward * (float(np.hypot(*centre(roll))) - reach)

        low = gear.roll_f
        if apart(low) > 0 or apart(gear.roll_a) < 0:
            raise ValueError(f"tip_rounding = {size:g} mm does not fit on the flank of z = {gear.z}: give a smaller one")
        start = brentq(apart, *sorted((low, gear.roll_a)), xtol=1e-12 * gear.m_n)
        middle = centre(start)
        first = math.atan2(*flank_normal(gear, start)[::-1])
        out = gear.outward * middle
        last = math.atan2(out[1], out[0])
        turn = (last - first + math.pi) % (2 * math.pi) - math.pi
        angle = first + turn * np.linspace(0.0, 1.0, POINTS)[:-1]
        return middle[:, None] + size * np.array([np.cos(angle), np.sin(angle)])

    def _chamfered(self, size: float) -> NDArray[np.float64]:
        """Points of the straight cut, which begins `size` below the tip circle."""
        gear = self.gear
        radius = gear.r_a - gear.outward * size
        least = gear.r_form
        if gear.outward * (radius - least) <= 0 or radius <= gear.r_b:
            raise ValueError(f"tip_chamfer = {size:g} mm leaves no flank of z = {gear.z}: give a smaller one")
        roll = math.sqrt(radius**2 - gear.r_b**2)
        start, normal = cartesian(*flank(gear, roll)), flank_normal(gear, roll)
        step = cartesian(*flank(gear, roll_at_arc(gear, gear.outward * roll**2 / (2 * gear.r_b) + 1e-6 * gear.m_n))) - start
        tangent = step - (step @ normal) * normal
        tangent /= np.hypot(*tangent)
        cut = math.cos(FROM_FLANK) * tangent - math.sin(FROM_FLANK) * normal
        points = start[:, None] + cut[:, None] * np.linspace(0.0, 4 * size, 8 * POINTS)
        inside = gear.outward * (np.hypot(*points) - gear.r_a) <= 0
        return points[:, : int(np.argmin(inside)) or None]

    def removed(self, roll: NDArray[np.float64], derivative: int) -> NDArray[np.float64]:
        """Material removed at roll lengths [mm], or its derivative by the roll length."""
        ends = self._spline.x[[0, -1]]
        inside = (roll >= ends[0]) & (roll <= ends[1])
        beyond = self.gear.outward * (roll - self.start) > 0
        out = np.where(beyond & ~inside, self.most if derivative == 0 else 0.0, 0.0)
        out[inside] = self._spline(roll[inside], derivative)
        return out

    def on(self, roll: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether places of the flank are on the edge."""
        return self.gear.outward * (roll - self.start) > 0

    def bend(self, roll: NDArray[np.float64]) -> NDArray[np.float64]:
        """Curvature of the edge more than that of the involute it replaces [1/mm]."""
        return (1 / self.rounding if self.rounding else 0.0) - self.gear.outward / roll
