"""`Chip`: a tooth tip broken off along a plane or a hollow surface."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import scipy

from ..aliases import Floats
from ..tooth.gear import Gear, shortened
from ..tooth.profile import arc_at, cartesian, flank
from .given import finite, tooth_and_side
from .spall import Spall

DEEPEST = 0.9  # largest depth of a chip over part of the width, relative to half the tooth height
LEFT = 0.5  # shortest remaining arc of the flank [m_n]
DRAWN = 17  # points of the line that shows a rounded cut
FLAT = 1e-3  # smallest angle between the cut and the chord of the removed flank [rad]

Piece = tuple[float, Callable[[Floats], Floats]]


@dataclass(frozen=True, slots=True)
class Chip:
    r"""A chipped tip: a plane or rounded cut parallel to the tooth, through the whole face width or a part of it.

    The cut leaves a new corner on one flank. That corner carries load as a tip corner does::

              ____ tip circle
             /   /|
            /   / |  depth
           /   /__|__ corner on the flank of `side`
          /  angle \
         /          \

    A rounded cut is a hollow arc between the same two ends, as the shell-shaped surfaces of brittle fracture are.

    Parameters
    ----------
    depth : float
        Height of the tooth that is lost on the flank, from the tip circle to the corner, along the radius [mm].
    angle : float
        Angle from the tooth's centre line of the plane, or of the chord of a rounded cut [rad]. At pi/2 the whole tip is cut off.
    tooth : int
        Number of the tooth: tooth k is in the pair that is k base pitches ahead of pair 0.
    side : {"loaded", "unloaded"}
        Flank that ends at the corner.
    radius : float, optional
        Radius of a rounded cut [mm], at least the length of its chord; default: a plane.
    width : (float, float), optional
        Heights between which the tip is lost [mm], counted as that of a `Pit`; default: the whole face width. A part of the width
        needs three dimensions. Plain sums replace it by a spall from the corner to the tip.

    Raises
    ------
    ValueError
        If a number is not finite or out of range.

    >>> Chip(depth=1.0)._description(Gear(z=21, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=7.4))
    'chip 1 mm deep at 45 degrees'
    """

    depth: float
    angle: float = math.pi / 4
    tooth: int = 0
    side: str = "loaded"
    radius: float | None = None
    width: tuple[float, float] | None = None

    _nouns: ClassVar[tuple[str, str]] = ("chip", "chips")
    _adjective: ClassVar[str] = "chipped"
    _removes_contact: ClassVar[None] = None  # a chip shortens the flank and adds a corner

    def __post_init__(self) -> None:
        """Raise ValueError for invalid numbers."""
        for name in ("depth", "angle", *(["radius"] if self.radius is not None else [])):
            object.__setattr__(self, name, finite("chip", name, getattr(self, name)))
        if not self.depth > 0:
            raise ValueError(f"depth = {self.depth}, but it must be positive [mm]")
        if self.radius is not None and not self.radius > 0:
            raise ValueError(f"radius = {self.radius}, but it must be positive [mm]")
        if not 0 < self.angle <= math.pi / 2:
            raise ValueError(f"angle = {self.angle} rad, but it must lie between 0 and pi/2; angles are radians in Python")
        object.__setattr__(self, "tooth", tooth_and_side(self.tooth, self.side))
        if self.width is not None:
            width = tuple(finite("chip", "width", end) for end in self.width)
            if len(width) != 2 or not 0 <= width[0] < width[1]:
                raise ValueError(f"width = {self.width!r}, but give two increasing heights (start, end) from 0 on [mm]")
            object.__setattr__(self, "width", width)

    @property
    def through(self) -> bool:
        """Whether the chip is equal in all transverse sections."""
        return self.width is None

    def recesses(self, gear: Gear) -> "tuple[Chip | Spall, ...]":
        """Return the recesses in the flanks that are equivalent to the chip. A chip of the whole width is returned itself.

        The depth of a recess is that of the cut at the tip, limited to nearly half the tooth. ValueError if it extends beyond the
        face.
        """
        if self.width is None:
            return (self,)
        if self.width[1] > gear.b * (1 + 1e-9):
            raise ValueError(
                f"width = ({self.width[0]:g}, {self.width[1]:g}) mm: the chip goes beyond the face, which ends at {gear.b:g} mm"
            )
        roll, where, other = self.cut(gear)
        half = gear.half_thickness(gear.r_a)
        edge = gear.r_a * np.array([math.sin(half), math.cos(half)])
        away = (edge[:, None] - self._face(gear)[1](np.linspace(0, 1, 65))).T @ self._directions(gear)[1]
        depth = min(float(away.max()), DEEPEST * half * gear.r_a)
        ends = {self.side: roll} | ({"unloaded" if self.side == "loaded" else "loaded": other} if where == "flank" else {})
        middle, length = sum(self.width) / 2, self.width[1] - self.width[0]
        return tuple(
            Recess(
                gear.r_a,
                middle,
                (2 * abs(float(arc_at(gear, gear.roll_a) - arc_at(gear, end))), length),
                depth,
                0.0,
                self.tooth,
                side,
            )
            for side, end in ends.items()
        )

    def cut(self, gear: Gear) -> tuple[float, str, float]:
        """Return the roll length of the corner [mm], and the end of the cut as an angle on the tip [rad] or a roll length.

        The roll length is that of the other flank, if the cut ends there. Angles are positive towards the flank of the corner.
        ValueError if there is no such cut.
        """
        radius = gear.r_a - gear.outward * self.depth
        roll = math.sqrt(max(radius**2 - gear.r_b**2, 0.0))
        left = float(arc_at(gear, roll) - arc_at(gear, gear.roll_f))
        if radius < gear.r_b or left < LEFT * gear.m_n:
            raise ValueError(f"depth = {self.depth:g} mm: the chip leaves less than {LEFT:g} modules of the flank (z = {gear.z})")
        (x, y), half = cartesian(*flank(gear, roll)), gear.half_thickness(gear.r_a)
        edge = gear.r_a * np.array([math.sin(half), math.cos(half)])
        chord = math.atan2(x - edge[0], gear.outward * (edge[1] - y))
        if self.angle < chord + FLAT:
            raise ValueError(
                f"angle = {self.angle:.4g} rad: the cut of a chip lies in the tooth of z = {gear.z} only above "
                f"{math.degrees(chord):.4g} degrees: give a larger angle"
            )
        along = self._directions(gear)[0]
        middle, rest = x * along[0] + y * along[1], x * x + y * y - gear.r_a**2
        reach = middle**2 - rest
        if reach >= 0:
            far = -middle + gear.outward * math.sqrt(reach)
            angle = math.atan2(x + far * along[0], y + far * along[1])
            if far > 0 and angle > -half:
                return roll, "tip", angle

        def off(other):
            there = cartesian(*flank(gear, other)) * np.array([-1, 1]) - np.array([x, y])
            return float(there[0] * along[1] - there[1] * along[0])

        if abs(off(roll)) < 1e-12 * gear.m_n:
            return roll, "flank", roll
        return roll, "flank", float(scipy.optimize.brentq(off, roll, gear.roll_a))

    def end_roll(self, gear: Gear, side: str) -> float:
        """Return the roll length [mm] at which the flank of a side ends."""
        roll, where, other = self.cut(gear)
        if side == self.side:
            return roll
        return other if where == "flank" else gear.roll_a

    def _directions(self, gear: Gear) -> Floats:
        """Return unit vectors along the chord of the cut and away from the tooth, as rows ``(2, 2)``."""
        along = np.array([-math.sin(self.angle), gear.outward * math.cos(self.angle)])
        return np.array([along, gear.outward * along[::-1] * [1, -1]])

    def _face(self, gear: Gear) -> Piece:
        """Return the line of the cut from the new corner to its other end. The flank of the corner is at positive x."""
        roll, where, other = self.cut(gear)
        start = cartesian(*flank(gear, roll))
        stop = cartesian(gear.r_a, other) if where == "tip" else cartesian(*flank(gear, other)) * [-1, 1]
        if self.radius is None:
            return _line(start, stop)
        length, radius = float(np.hypot(*(stop - start))), self.radius
        if radius < length:
            raise ValueError(f"radius = {radius:g} mm: the cut of the chip is {length:.4g} mm long; give at least this length")
        half = math.asin(length / 2 / radius)
        along, away = self._directions(gear)

        def place(t):
            turn, shape = half * (2 * np.asarray(t) - 1), (2, *(1,) * np.ndim(t))
            ahead, deep = radius * np.sin(turn), 2 * radius * np.sin((half + turn) / 2) * np.sin((half - turn) / 2)
            return ((start + stop) / 2).reshape(shape) + along.reshape(shape) * ahead - away.reshape(shape) * deep

        return 2 * half * radius, place

    def top(self, gear: Gear, side: str) -> list[Piece]:
        """Return the outline from the tooth centre-line to the flank of a side: length [mm], and points ``(2, ...)`` over [0, 1].

        The flank is at positive x.
        """
        _, where, other = self.cut(gear)
        half, own, face = gear.half_thickness(gear.r_a), side == self.side, self._face(gear)
        if where == "tip" and other >= 0:
            tip = _arc(gear.r_a, 0.0, other if own else half)
            return ([tip] if tip[0] > 0 else []) + ([_part(face, 1.0, 0.0)] if own else [])
        middle = float(scipy.optimize.brentq(lambda t: face[1](t)[0], 0.0, 1.0, xtol=1e-15))
        if own:
            return [_part(face, middle, 0.0)]
        return [_part(face, middle, 1.0, -1), *([_arc(gear.r_a, -other, half)] if where == "tip" else [])]

    def outline(self, gear: Gear) -> Floats:
        """Line ``(2, n)`` [mm] of the cut, in the frame of its tooth."""
        points = self._face(gear)[1](np.linspace(0, 1, 2 if self.radius is None else DRAWN))
        return points * ([[1], [1]] if self.side == "loaded" else [[-1], [1]])

    def _description(self, gear: Gear) -> str:
        """Return a description."""
        part = f" from z = {self.width[0]:g} to {self.width[1]:g} mm" if self.width else ""
        rounded = f" with a radius of {self.radius:.3g} mm" if self.radius else ""
        return f"chip {self.depth:.3g} mm deep at {math.degrees(self.angle):.3g} degrees{rounded}{part}"

    def _warning(self, gear: Gear) -> str:
        """Return no warning."""
        return ""


class Recess(Spall):
    """Recess in a flank that represents a chip over a part of the face width."""

    __slots__ = ()
    _nouns: ClassVar[tuple[str, str]] = ("chip", "chips")
    _adjective: ClassVar[str] = "chipped"


def _line(start, stop):
    away = stop - start

    def place(t):
        shape = (2, *(1,) * np.ndim(t))
        return start.reshape(shape) + away.reshape(shape) * t

    return float(np.hypot(*away)), place


def _part(face, first, last, sign=1):
    """Return the piece of a cut between two of its parameters, mirrored for a negative `sign`."""
    length, place = face

    def of(t):
        points = place(first + (last - first) * t)
        return points * np.reshape([sign, 1], (2,) + (1,) * (points.ndim - 1))

    return length * abs(last - first), of


def _arc(radius, first, last):
    return radius * abs(last - first), lambda t: cartesian(radius, first + (last - first) * t)


def chip_of(gear: Gear, broken: Iterable[Any], tooth: int) -> Chip | None:
    """Return the chip of a tooth among damage, or None."""
    return next((one for one in broken if isinstance(one, Chip) and (one.tooth - tooth) % gear.z == 0), None)


def loaded_side(gear: Gear, broken: Iterable[Any], tooth: int) -> Gear:
    """Return a gear whose loaded flanks end at the same height as the loaded flank of a damaged tooth."""
    chip = chip_of(gear, broken, tooth)
    return gear if chip is None else shortened(gear, chip.end_roll(gear, "loaded"))
