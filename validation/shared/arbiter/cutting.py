"""Teeth cut by brute force: at every radius the widest cut that any position of the tool makes there.

A circle of radius R about the gear's centre is cut by the tool's boundary in some place psi, counted from the line through the
pitch point; the tool's position at that moment follows from the tool's shape, the gear's turn from rolling. In the gear's own
frame the cut reaches the angle ``f(psi)`` from the middle of the tooth space, and the space is as wide as its largest value::

    rack:    f = psi - (R sin psi - w(R cos psi - r)) / r                w: half width of the rack's tooth over its height
    cutter:  f = psi - (chi(psi) - c(rho(psi))) z_cutter / z             c: half angle of the cutter's tooth over its radius

Undercut, fillets and form points come out by themselves. The tool's straight (involute) part and its rounded tip are kept apart,
because a form point is where one takes over from the other.
"""

import math

import numpy as np
from scipy.optimize import brentq

GRID, ZOOM, ZOOMS = 241, 17, 5  # points per search for a maximum, points per refinement, number of refinements
SAME = 1e-14  # angles with a smaller difference are equal [rad]


class ToothSpace:
    """The tooth space of `gear` (a `gearfe.Gear`, read for its numbers): half angles [rad] by radius [mm], arrays of n."""

    def __init__(self, gear):
        self.gear = gear
        self.r = gear.z * gear.m_n / math.cos(gear.beta) / 2
        self.r_f = self.r + (-gear.outward * gear.dedendum + gear.x) * gear.m_n
        self.r_a = self.r + (gear.outward * gear.addendum + gear.x) * gear.m_n
        self.r_b = self.r * math.cos(math.atan(math.tan(gear.alpha_n) / math.cos(gear.beta)))
        self._tool = Cutter(self) if gear.internal else Rack(self)

    def flank(self, radius):
        """Half angle of the tooth cut by the straight part of the rack. A ring takes that of an external gear with its z and x.

        The two are one where the cutter's involute reaches. Near a ring's tip it may not: what the end of the cutter's involute
        would take away there, a fraction of a micrometre, is left out, because a ring's flank is by definition an involute.
        """
        radius = np.atleast_1d(radius)
        if not self.gear.internal:
            return self._largest(radius, *self._tool.straight)
        alpha_t = math.acos(self.r_b / self.r)
        return math.pi / self.gear.z - self._largest(
            radius, lambda one: (0.0 * one, np.full(one.shape, alpha_t)), Rack(self).straight[1]
        )

    def fillet(self, radius):
        """Half angle cut by the tool's rounded tip."""
        return self._largest(np.atleast_1d(radius), *self._tool.rounded)

    def form_radius(self):
        """Radius at which the flank takes over from the fillet [mm], by bisection."""
        low, high = self.r_f, self.r_a
        for _ in range(60):
            middle = (low + high) / 2
            at = np.array([middle])
            flank = self._largest(at, *self._tool.straight) > self.fillet(at) + SAME
            low, high = (low, middle) if flank else (middle, high)
        if high == self.r_a:
            raise ValueError(f"z = {self.gear.z}: nothing is left of the flank")
        return high

    def _largest(self, radius, reach, function):
        """Largest value of `function` over the places ``reach(radius)`` = (nearest, furthest) on both sides of the middle."""
        near, far = reach(radius)
        best = np.full(radius.shape, -np.inf)
        for side in (1.0, -1.0):
            low, high = np.zeros(radius.shape), np.ones(radius.shape)
            count = GRID
            for _ in range(ZOOMS):
                part = low[:, None] + (high - low)[:, None] * np.linspace(0, 1, count)
                # Sine spacing removes the square-root behaviour at both ends of each tool segment.
                psi = side * (near[:, None] + (far - near)[:, None] * np.sin(part * math.pi / 2) ** 2)
                values = function(radius[:, None], psi)
                at = np.argmax(values, axis=1)
                rows = np.arange(radius.size)
                best = np.fmax(best, values[rows, at])
                low, high = part[rows, np.maximum(at - 1, 0)], part[rows, np.minimum(at + 1, count - 1)]
                count = ZOOM
        return best


class Rack:
    """A rack's tooth in the transverse section: `straight` and `rounded` are (reach, function) as of `ToothSpace._largest`."""

    def __init__(self, space):
        gear = space.gear
        m, slope, rho, r = gear.m_n, math.cos(gear.beta), gear.rack_tip_radius * gear.m_n, space.r
        tan = math.tan(gear.alpha_n)
        centre = (gear.x - gear.dedendum) * m + rho  # height of the centre of the tip rounding above the pitch line
        across = math.pi * m / 4 + (centre - gear.x * m) * tan - rho / math.cos(gear.alpha_n)
        across = max(across, 0.0)
        joint, tip = centre - rho * math.sin(gear.alpha_n), centre - rho

        def cut(radius, psi, width):
            return psi - (radius * np.sin(psi) - width / slope) / r

        def straight(radius, psi):
            height = radius * np.cos(psi) - r
            return cut(radius, psi, math.pi * m / 4 + (height - gear.x * m) * tan)

        def rounded(radius, psi):
            height = np.clip(radius * np.cos(psi) - r - centre, -rho, 0.0)
            return cut(radius, psi, across + np.sqrt(rho**2 - height**2))

        def place(radius, height):
            return np.arccos(np.clip((r + height) / radius, -1.0, 1.0))

        def off_flank(radius):
            return np.where(radius > r + joint, 0.0, np.nan), place(radius, joint)

        self.straight = off_flank, straight
        self.rounded = lambda radius: (place(radius, joint), place(radius, tip)), rounded


class Cutter:
    """A pinion cutter's tooth, without profile shift: `straight` is its involute, `rounded` the arc at its tip.

    Its distance from the ring's centre is the one at which it cuts, on the ring's reference circle, as wide a space as the tooth
    of the external gear with the ring's z and x.
    """

    def __init__(self, space):
        gear = space.gear
        ratio = gear.z_cutter / gear.z
        self.base = space.r_b * ratio
        alpha_t = math.atan(math.tan(gear.alpha_n) / math.cos(gear.beta))
        self.half = math.pi / (2 * gear.z_cutter) + math.tan(alpha_t) - alpha_t
        self.distance = 0.0
        rho = gear.rack_tip_radius * gear.m_n
        wanted = (math.pi / 2 + 2 * gear.x * math.tan(gear.alpha_n)) / gear.z

        def involute(radius):
            turn = np.sqrt(np.maximum((radius / self.base) ** 2 - 1, 0.0))
            return self.half - turn + np.arctan(turn)

        def seen(radius, psi):
            x, y = radius * np.sin(psi), radius * np.cos(psi) - self.distance
            return np.hypot(x, y), np.arctan2(x, y)

        def straight(radius, psi):
            away, angle = seen(radius, psi)
            return psi - (angle - involute(away)) * ratio

        def place(radius, away):
            """Where the cutter's circle of radius `away` crosses the ring's."""
            far = (radius**2 + self.distance**2 - away**2) / (2 * radius * self.distance)
            return np.arccos(np.clip(far, -1.0, 1.0))

        def set_at(distance):
            """Place the cutter; where its rounding touches its involute: the centre lies rho inside of the flank's tangent."""
            self.distance, self.tip = distance, space.r_f - distance
            self.centre = self.tip - rho
            self.roll = math.sqrt(max(self.centre**2 - self.base**2, 0.0)) + rho
            self.joint = math.hypot(self.roll, self.base)

        def excess(distance):
            set_at(distance)
            at = np.array([space.r])
            return float(space._largest(at, *self.straight)[0]) - wanted

        self.straight = lambda radius: (place(radius, self.base), place(radius, self.joint)), straight
        least = (1 - ratio) * space.r_b
        set_at(
            brentq(excess, least * (1 + 1e-9), min(least / math.cos(math.radians(50)), space.r_f - self.base - rho), xtol=1e-13)
        )
        turned = float(involute(self.joint)) - math.atan2(self.roll, self.base) + math.atan2(self.roll - rho, self.base)
        tip, centre = self.tip, self.centre

        def rounded(radius, psi):
            away, angle = seen(radius, psi)
            away = np.clip(away, None, tip)
            cosine = np.clip((away**2 + centre**2 - rho**2) / (2 * away * centre), -1.0, 1.0)
            return psi - (angle - turned - np.arccos(cosine)) * ratio

        self.rounded = lambda radius: (place(radius, self.joint), place(radius, tip)), rounded
