"""One side of a gear's teeth as curves between corners: fillet, flank, edge of the tip, tip circle.

Angles [rad] are counted clockwise from the tooth's centre-line towards the loaded flank, radii [mm] from the gear's centre. The
material C(L) removed by a `gearfe.Flank` is by definition a rotation of the flank's points by C(L) / r_b, with L^2 = R^2 -
r_b^2. A pitch deviation rotates a tooth. The fillet is moved like the form point, so that the outline has no step.
"""

import math
import re
from dataclasses import fields
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from .cutting import ToothSpace

FILLET, FLANK = 260, 90  # nodes of the splines through cut points
KNOWN = re.compile(
    "(tip|root)_(relief|exponent|start_.*)|profile_(crowning|slope)|pitch|tip_(rounding|chamfer)|both_sides|end_(exponent|length)"
)


class Outline:
    """Loaded side of the teeth of `gear`, with the modifications of `flank` (a `gearfe.Flank` or None).

    `pieces` are (low, high, place). The function `place` returns radius and angle at parameters between `low` and `high`,
    ordered from root to tip. `half(radius)` is the inverse: the angle of fillet, flank and tip edge at given radii.
    """

    def __init__(self, gear, flank=None):
        _check(flank)
        self.gear, self.outward = gear, gear.outward
        self._space, self.r_form, self._fillet, self._flank = _cut(gear)
        self.r_b, self.r_f, self.r_a = self._space.r_b, self._space.r_f, self._space.r_a
        self.flank = flank
        self._reliefs, self._pitch = [], np.zeros(gear.z)
        roll_a, roll_f = self.roll(self.r_a), self.roll(self.r_form)
        self._ends = roll_f, roll_a
        self.r_edge = self.r_a
        starts = []
        if flank is not None:
            for end, last in (("tip", roll_a), ("root", roll_f)):
                if getattr(flank, f"{end}_relief"):
                    start = _start(self, end)
                    starts.append(math.hypot(start, self.r_b))
                    self._reliefs.append((start, last, getattr(flank, f"{end}_relief"), getattr(flank, f"{end}_exponent")))
            if len(flank.pitch):
                self._pitch = np.asarray(flank.pitch) / self._space.r
        self._edge = None
        if flank is not None and flank.tip_rounding:
            self._edge = _Rounding(self, flank.tip_rounding)
        elif flank is not None and flank.tip_chamfer:
            self._edge = _Chamfer(self, flank.tip_chamfer)
        if self._edge is not None:
            self.r_edge = self._edge.start
        self.corners = self._corners()
        self.pieces = self._pieces(starts)

    def roll(self, radius):
        """Roll length at radii [mm], 0 inside of the base circle."""
        return np.sqrt(np.maximum(np.square(radius) - self.r_b**2, 0.0))

    def pitch(self, tooth):
        """Return the angle by which teeth are behind their nominal positions [rad]."""
        return self._pitch[np.asarray(tooth) % self.gear.z]

    def removed(self, radius):
        """Return the material removed at radii [mm], along the line of action [mm], without tip edge and pitch."""
        radius = np.asarray(radius, dtype=float)
        out = np.zeros(radius.shape)
        if self.flank is None:
            return out
        (low, high), roll = self._ends, self.roll(radius)
        roll = np.maximum(roll, low) if self.outward > 0 else np.minimum(roll, low)
        for start, end, amount, exponent in self._reliefs:
            out += amount * np.maximum((roll - start) / (end - start), 0.0) ** exponent
        place = 2 * (roll - (low + high) / 2) / (high - low)
        return out + self.flank.profile_crowning * place**2 + self.flank.profile_slope * (1 + place) / 2

    def cut(self, radius):
        """Half angle of the generated tooth without tip edge and modifications [rad]."""
        radius = np.asarray(radius, dtype=float)
        below = self.outward * (self.r_form - radius) > 0
        depth = np.sqrt(np.maximum(self.outward * (radius - self.r_f), 0.0))
        return np.where(below, self._fillet(depth), self._flank(self.roll(radius)))

    def half(self, radius):
        """Angle of the loaded side [rad] at radii [mm], constant beyond tip and root circle."""
        radius = np.clip(radius, *sorted((self.r_f, self.r_a)))
        angle = self.cut(radius)
        if self._edge is not None:
            on = self.outward * (radius - self.r_edge) > 0
            angle = np.where(on, self._edge.half(np.where(on, radius, self.r_edge)), angle)
        return angle - self.removed(radius) / self.r_b

    def unloaded(self, radius):
        """Return the angle of the unloaded flank [rad], which is negative.

        It is the flank as cut, or with the modifications of the loaded flank if they are on both sides.
        """
        radius = np.clip(radius, *sorted((self.r_f, self.r_a)))
        removed = self.removed(radius) / self.r_b if self.flank is not None and self.flank.both_sides else 0.0
        return removed - self.cut(radius)

    def _pieces(self, starts):
        fillet = 0.0, math.sqrt(self.outward * (self.r_form - self.r_f)), lambda t: self.r_f + self.outward * t**2
        bounds = [
            self.r_form,
            *sorted((r for r in starts if self.outward * (self.r_edge - r) > 0), key=lambda r: self.outward * r),
        ]
        bounds = [self.roll(r) for r in (*bounds, self.r_edge)]
        flanks = [(low, high, lambda t: np.hypot(t, self.r_b)) for low, high in zip(bounds[:-1], bounds[1:], strict=True)]

        def side(radii):
            return lambda t: (radii(t), self.half(radii(t)))

        pieces = [(low, high, side(radii)) for low, high, radii in [fillet, *flanks]]
        if self._edge is not None:
            last = self._edge.last

            def edge(t):
                radius, angle = self._edge.place(t)
                return radius, angle - self.removed(radius) / self.r_b

            pieces.append((0.0, last, edge))
        tip = float(pieces[-1][2](pieces[-1][1])[1])
        if tip <= 0:
            raise ValueError(f"z = {self.gear.z}: the edge of the tip crosses the tooth's centre-line: make it smaller")
        return [*pieces, (tip, 0.5 * tip, lambda t: (np.full(np.shape(t), self.r_a), np.asarray(t)))]

    def _corners(self):
        """Return the radii of convex corners: form point of an undercut flank, tip, start of a chamfer."""
        step = 1e-4 * self.gear.m_n
        turn = self._slope(self.r_form + self.outward * step) - self._slope(self.r_form - self.outward * step)
        convex = [self.r_form] if abs(turn) > 0.02 and self.outward > 0 else []
        if self._edge is None:
            return [*convex, self.r_a]
        return convex if isinstance(self._edge, _Rounding) else [*convex, self.r_edge, self.r_a]

    def _slope(self, radius):
        """Return the angle between outline and radius [rad]."""
        step = 1e-6 * self.gear.m_n
        return math.atan(radius * float(self.cut(radius + step) - self.cut(radius - step)) / (2 * step))


class _Rounding:
    """Rounding: an arc tangent to flank and tip circle in place of the tip corner."""

    def __init__(self, outline, size):
        self.size, self.outline = size, outline
        sign = outline.outward

        def centre(radius):
            angle, normal = float(outline.cut(radius)), _normal(outline, radius)
            return radius * np.array([math.sin(angle), math.cos(angle)]) - size * normal

        def apart(radius):
            return math.hypot(*centre(radius)) - (outline.r_a - sign * size)

        self.start = brentq(apart, *sorted((outline.r_form, outline.r_a)), xtol=1e-12)
        self.centre = centre(self.start)
        self.away, self.turned = math.hypot(*self.centre), math.atan2(*self.centre)
        first, out = _normal(outline, self.start), sign * self.centre / self.away
        self.first, last = math.atan2(*first), math.atan2(*out)
        self.turn = (last - self.first + math.pi) % (2 * math.pi) - math.pi
        self.last = abs(self.turn)

    def place(self, t):
        direction = self.first + math.copysign(1.0, self.turn) * np.asarray(t)
        x, y = self.centre[0] + self.size * np.sin(direction), self.centre[1] + self.size * np.cos(direction)
        return np.hypot(x, y), np.arctan2(x, y)

    def half(self, radius):
        cosine = (radius**2 + self.away**2 - self.size**2) / (2 * radius * self.away)
        return self.turned + np.arccos(np.clip(cosine, -1.0, 1.0))


class _Chamfer:
    """Chamfer: a straight cut under 45 degrees to the flank that begins `size` below the tip circle."""

    def __init__(self, outline, size):
        self.outline = outline
        sign = outline.outward
        self.start = outline.r_a - sign * size
        angle, normal = float(outline.cut(self.start)), _normal(outline, self.start)
        self.first = self.start * np.array([math.sin(angle), math.cos(angle)])
        tangent = np.array([-normal[1], normal[0]])
        tangent *= math.copysign(1.0, sign * (tangent @ self.first))  # The tangent points towards the tip.
        self.along = (tangent - normal) / math.sqrt(2)
        self.last = self._length(np.array(outline.r_a)).item()

    def _length(self, radius):
        """Return the length of the cut up to given radii, by the first root towards the tip."""
        b, c = self.first @ self.along, self.start**2 - np.square(radius)
        root = np.sqrt(np.maximum(b**2 - c, 0.0))
        return -b + root if self.outline.outward > 0 else -b - root

    def place(self, t):
        x, y = (self.first[i] + self.along[i] * np.asarray(t) for i in (0, 1))
        return np.hypot(x, y), np.arctan2(x, y)

    def half(self, radius):
        return self.place(self._length(radius))[1]


def _normal(outline, radius, step=1e-5):
    """Return the unit vector (x, y) normal to the generated flank, out of the material, by central differences."""
    radii = radius + step * np.array([-1.0, 1.0])
    angles = outline._flank(outline.roll(radii))
    x, y = radii * np.sin(angles), radii * np.cos(angles)
    tangent = np.array([x[1] - x[0], y[1] - y[0]])
    return np.array([tangent[1], -tangent[0]]) / math.hypot(*tangent)


@lru_cache(maxsize=64)
def _cut(gear):
    """Return tool, form radius, and splines of fillet (over the root of depth) and flank (over roll length)."""
    space = ToothSpace(gear)
    form, sign = space.form_radius(), gear.outward
    deep = math.sqrt(sign * (form - space.r_f))
    depth = deep * np.linspace(0, 1, FILLET)
    fillet = CubicSpline(depth, math.pi / gear.z - space.fillet(space.r_f + sign * depth**2))
    rolls = [math.sqrt(max(r**2 - space.r_b**2, 0.0)) for r in sorted((form, space.r_a))]
    margin = 0.02 * (rolls[1] - rolls[0])
    ends = (
        (rolls[0], rolls[1] + margin) if sign > 0 else (max(rolls[0] - margin, 0.0), rolls[1])
    )  # The point lies beyond the tip, never at the form point.
    roll = np.linspace(*ends, FLANK)
    flank = CubicSpline(roll, math.pi / gear.z - space.flank(np.hypot(roll, space.r_b)))
    return space, form, fillet, flank


def _start(outline, end):
    """Return the roll length at which a relief starts [mm]."""
    flank = outline.flank
    if (value := getattr(flank, f"{end}_start_roll")) is not None:
        return value
    if (value := getattr(flank, f"{end}_start_angle")) is not None:
        return value * outline.r_b
    return float(outline.roll(getattr(flank, f"{end}_start_diameter") / 2))


def _check(flank):
    """Raise ValueError for modifications that this solver does not support."""
    for one in () if flank is None else fields(flank):
        value = getattr(flank, one.name)
        if not KNOWN.fullmatch(one.name) and value != one.default and np.any(value):
            raise ValueError(f"Flank.{one.name} = {value!r}, but the arbiter knows only {KNOWN.pattern}")
