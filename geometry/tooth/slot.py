"""Slots through the web or the rim of a gear, bent around its axis with round ends, and round holes."""

import math
from dataclasses import dataclass

import numpy as np

from ..aliases import Floats
from ..checks import is_finite
from .gear import Gear
from .profile import cartesian

LEAST = 0.05  # least distance of a slot from teeth, held circle and other slots [m_n]
CAP = 12  # edges of a round end in a drawing or a mesh


@dataclass(frozen=True, slots=True)
class Slot:
    """Slot through a gear along an arc about its axis, with round ends.

    Parameters
    ----------
    radius : float
        Of its middle line, from the axis [mm].
    width : float
        In the radial direction [mm].
    start, stop : float
        Angles of the centres of its round ends [rad], from the centre line of a tooth, positive towards its loaded flank. With a
        growing crack it is the cracked tooth. Equal angles make a round hole.

    Raises
    ------
    ValueError
        If a number is not finite, a length is not positive, or the ends overlap.

    Examples
    --------
    >>> Slot(radius=20.0, width=2.0, start=-0.5, stop=0.5)
    Slot(radius=20.0, width=2.0, start=-0.5, stop=0.5)
    """

    radius: float
    width: float
    start: float
    stop: float

    def __post_init__(self) -> None:
        """Check the numbers."""
        for name in ("radius", "width", "start", "stop"):
            value = getattr(self, name)
            if not is_finite(value) or (name in ("radius", "width") and value <= 0):
                unit = "positive [mm]" if name in ("radius", "width") else "finite [rad]"
                raise ValueError(f"slot: {name} = {value!r}, but it must be {unit}")
        if not self.start <= self.stop:
            raise ValueError(f"slot: start = {self.start:g} rad is after stop = {self.stop:g} rad: exchange them")
        if self.radius <= self.width / 2 or (2 * math.pi - self.stop + self.start) * self.radius <= self.width:
            raise ValueError(
                f"slot: from {self.start:g} to {self.stop:g} rad, {self.width:g} mm wide at radius {self.radius:g} mm, its ends "
                "overlap: make it shorter or narrower"
            )

    def distance(self, points: Floats) -> Floats:
        """Return the distance of points ``(2, n)`` from the edge of the slot [mm], negative inside."""
        x, y = np.asarray(points, dtype=float)
        along = (np.arctan2(x, y) - self.start) % (2 * math.pi) <= self.stop - self.start
        ends = [np.hypot(x - a, y - b) for a, b in cartesian(self.radius, np.array([self.start, self.stop])).T]
        return np.where(along, np.abs(np.hypot(x, y) - self.radius), np.minimum(*ends)) - self.width / 2

    def ligament(self, gear: Gear) -> float:
        """Return the least width of the material between the slot and the root or held circle of a gear [mm]."""
        return min(abs(self.radius - radius) for radius in (gear.r_f, gear.held)) - self.width / 2

    def outline(self, size: float) -> Floats:
        """Return the closed outline ``(2, 2 n)``: vertices about `size` [mm] apart at even places, edge middles at odd ones."""
        shape = Clockwise(self)
        rounded = max(CAP, math.ceil(math.pi * self.width / 2 / size))
        at = shape.vertices(0.0, float(shape.bounds[-1]), size, rounded)
        return shape(np.interp(np.arange(2 * at.size - 2) / 2, np.arange(at.size), at))

    def cap(self, end: float, side: int, turn: Floats) -> Floats:
        """Return points of the round end at `end`, by their `turn` [rad] from the outer (`side` 1) or inner arc (-1)."""
        out, ahead = np.array([math.sin(end), math.cos(end)]), np.array([math.cos(end), -math.sin(end)])
        shape = (2,) + (1,) * np.ndim(turn)
        direction = np.cos(turn) * out.reshape(shape) + np.sin(turn) * ahead.reshape(shape)
        return self.radius * out.reshape(shape) + side * self.width / 2 * direction


@dataclass(frozen=True, slots=True)
class Clockwise:
    """Outline of a slot by its arc length: outer arc, end at `stop`, inner arc, end at `start`."""

    slot: Slot

    @property
    def bounds(self) -> Floats:
        """Return arc lengths at which the four parts begin, and the whole length [mm]."""
        slot, half = self.slot, self.slot.width / 2
        arc, end = slot.stop - slot.start, math.pi * half
        return np.cumsum([0.0, arc * (slot.radius + half), end, arc * (slot.radius - half), end])

    def __call__(self, at: Floats) -> Floats:
        """Return points ``(2, ...)`` [mm] at arc lengths [mm]."""
        slot, half, bounds = self.slot, self.slot.width / 2, self.bounds
        at = np.asarray(at) % bounds[-1]
        part = np.clip(np.searchsorted(bounds, at, side="right") - 1, 0, 3)
        on = at - bounds[part]
        return np.select(
            [part == 0, part == 1, part == 2],
            [
                cartesian(slot.radius + half, slot.start + on / (slot.radius + half)),
                slot.cap(slot.stop, 1, on / half),
                cartesian(slot.radius - half, slot.stop - on / (slot.radius - half)),
            ],
            slot.cap(slot.start, -1, on / half),
        )

    def crossings(self, angle: float) -> tuple[float, float] | None:
        """Return arc lengths [mm] at which a ray leaves the slot outwards and inwards, or None if they do not meet."""
        slot, half, bounds = self.slot, self.slot.width / 2, self.bounds
        after, before = angle - slot.stop, slot.start - angle
        if after <= 0 and before <= 0:
            return -before * (slot.radius + half), float(bounds[2]) - after * (slot.radius - half)
        away = max(after, before)
        if away >= math.pi / 2 or slot.radius * math.sin(away) >= half:
            return None
        turn = math.asin(slot.radius * math.sin(away) / half)
        if after > 0:
            return float(bounds[1]) + half * (away + turn), float(bounds[1]) + half * (away + math.pi - turn)
        return float(bounds[3]) + half * (math.pi - turn - away), float(bounds[3]) + half * (turn - away)

    def vertices(self, first: float, last: float, size: float, rounded: int) -> Floats:
        """Return arc lengths [mm] of vertices, at most `size` [mm] apart on the arcs, `rounded` of them on a round end."""
        bounds = self.bounds
        corners = np.concatenate([bounds[:-1], bounds[:-1] + bounds[-1]])
        ends = np.array([first, *corners[(corners > first + 1e-9) & (corners < last - 1e-9)], last])
        middles = (ends[1:] + ends[:-1]) / 2 % bounds[-1]
        round_end = np.searchsorted(bounds, middles, side="right") % 2 == 0
        largest = np.where(round_end, math.pi * self.slot.width / 2 / rounded, size)
        counts = np.ceil(np.diff(ends) / largest - 1e-9).astype(int)
        return np.concatenate([*map(np.linspace, ends[:-1], ends[1:], counts, [False] * counts.size), ends[-1:]])


def check_slots(gear: Gear, slots: tuple[Slot, ...]) -> None:
    """Raise ValueError for a slot that meets the teeth or the held circle of a gear, or another slot."""
    least, ends = LEAST * gear.m_n, sorted((gear.r_f, gear.held))
    for i, slot in enumerate(slots):
        low, high = slot.radius - slot.width / 2, slot.radius + slot.width / 2
        if low < ends[0] + least or high > ends[1] - least:
            raise ValueError(
                f"slot {i} lies between the radii {low:g} and {high:g} mm, but the body of z = {gear.z} reaches from {ends[0]:g} "
                f"to {ends[1]:g} mm, and {least:g} mm must remain"
            )
        for k, other in enumerate(slots[:i]):
            nearest = min(one.distance(two.outline(two.width / 4)).min() for one, two in ((slot, other), (other, slot)))
            if nearest < least:
                raise ValueError(f"slots {k} and {i} overlap, or less than {least:g} mm remains between them")
