"""`Spall`: a spall of rectangular outline with rounded corners on a flank, and its intersections with lines."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ..aliases import Floats
from ..tooth.gear import Gear
from .given import settle_hollow
from .hollow import crossing, in_circle, profile, warning_of

LEAST, LONGEST = 1e-6, 1e6  # limits of the side lengths [mm]
QUARTER = 8  # straight segments of a drawn rounded corner
CORNERS = (1, 1), (-1, 1), (-1, -1), (1, -1)  # signs of the corners, counter-clockwise


@dataclass(frozen=True, slots=True)
class Spall:
    """Hollow of constant depth cut along the flank normal out of one flank, with a rounded rectangle as outline.

    It is the rectangle of the spalling literature: F. Chaari, W. Baccar, M. S. Abbes, M. Haddar, Eur. J. Mech. A/Solids 27 (2008)
    691-705; H. Ma, Z. Li, M. Feng, R. Feng, B. Wen, Eng. Fail. Anal. 66 (2016) 166-176. Its sides lie along the transverse
    profile and along the tooth trace, like the axes of a `Pit`.

    Parameters
    ----------
    radius : float
        Radius of the flank point at its centre [mm], from the axis of the gear.
    z : float
        Height of its centre [mm], counted as that of a `Pit`.
    sides : (float, float)
        Whole lengths along the profile and along the width [mm]: the literature's w_s and a_s.
    depth : float
        Depth along the flank normal [mm]: the literature's h_s.
    corner : float
        Radius of its corners [mm]; 0: sharp.
    tooth : int
        Number of the tooth, counted as for a `Crack`.
    side : {"loaded", "unloaded"}
        Flank it lies on.

    Raises
    ------
    ValueError
        If the description is contradictory. A spall off its flank is rejected when it is used with its gear, see
        `gearfe.geometry.damage.hollow.check_hollows`.

    >>> Spall(radius=21.0, z=10.0, sides=(1.5, 6.0), depth=0.2, corner=0.3).reach
    (0.75, 3.0)
    """

    radius: float
    z: float
    sides: tuple[float, float]
    depth: float
    corner: float = 0.0
    tooth: int = 0
    side: str = "loaded"

    _nouns: ClassVar[tuple[str, str]] = ("spall", "spalls")
    _adjective: ClassVar[str] = "spalled"
    _removes_contact: ClassVar[bool] = True
    through: ClassVar[bool] = False
    angle: ClassVar[float] = 0.0

    def __post_init__(self) -> None:
        """Raise ValueError for contradictory arguments."""
        settle_hollow(self, "sides", "lengths", "corner")
        if not (min(self.sides) >= LEAST and max(self.sides) <= LONGEST):
            raise ValueError(f"sides = {self.sides} mm, but a side is from {LEAST:g} to {LONGEST:g} mm long")
        if not 0 <= self.corner <= min(self.sides) / 2:
            raise ValueError(
                f"corner = {self.corner} mm, but a corner's radius is from 0 to half the shorter one of sides = {self.sides} mm"
            )

    @property
    def axes(self) -> tuple[float, float]:
        """Half extents along the profile and along the width [mm]."""
        return self.sides[0] / 2, self.sides[1] / 2

    reach = axes

    @property
    def kinks(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Breakpoints of the outline along the profile and along the width, relative to the centre of the spall [mm]."""
        along, across = (tuple(sorted({-half, self.corner - half, half - self.corner, half})) for half in self.axes)
        return along, across

    def outline(self, gear: Gear) -> Floats:
        """Return the line ``(2, n)`` [mm] that represents the spall in the transverse section, in the frame of its tooth."""
        return profile(gear, self)

    def _description(self, gear: Gear) -> str:
        """Return a description of the spall, with its size."""
        return f"{self.sides[0]:.3g} x {self.sides[1]:.3g} mm spall"

    def _warning(self, gear: Gear) -> str:
        """Return a warning for the spall on its gear. The result is empty if there is none."""
        return warning_of(gear, self, f"sides of {self.sides[0]:g} x {self.sides[1]:g}")

    def mirrored(self, b: float) -> Self:
        """Return the mirror image of the spall in the other half of a face of width `b` [mm]."""
        return replace(self, z=b - self.z)

    def _contains(self, u: Any, w: Any) -> NDArray[np.bool_]:
        """Return whether places lie in the spall: `u` along the profile, `w` along the width from its centre [mm]."""
        away = [np.abs(at) - half for at, half in zip((u, w), self.axes, strict=True)]
        beside = [np.maximum(distance + self.corner, 0.0) for distance in away]
        return (
            (away[0] <= 0) & (away[1] <= 0) & ((beside[0] ** 2 + beside[1] ** 2 <= self.corner**2) | (beside[0] * beside[1] == 0))
        )

    def span(self, u: Floats) -> tuple[Floats, Floats]:
        """Return the heights z [mm] of both ends of the spall at `u` along the profile from its centre [mm].

        The two heights are equal where the spall has no width.
        """
        beside = np.maximum(np.abs(u) - self.axes[0] + self.corner, 0.0)
        half = self.axes[1] - self.corner + np.sqrt(np.maximum(self.corner**2 - beside**2, 0.0))
        half = np.where(np.abs(u) <= self.axes[0], half, 0.0)
        return self.z - half, self.z + half

    def _edge(self) -> tuple[Floats, Floats]:
        """Return the outline of the spall as places along the profile and along the width from its centre [mm]."""
        turn = np.linspace(0, 2 * math.pi, 4 * QUARTER, endpoint=False) + math.pi / 4 / QUARTER
        unit = np.array([np.cos(turn), np.sin(turn)])
        out = np.sign(unit) * (np.array(self.axes) - self.corner)[:, None] + self.corner * unit
        u, w = np.column_stack([out, out[:, 0]])
        return u, w

    def _contours(self, centre: Floats, axes: Floats) -> list[tuple[str, Floats]]:
        """Return the outline in space, from the `centre` and half `axes` ``(3, 2)``: lines, and arcs by ends and centres."""
        inner = 1 - self.corner / np.array(self.axes)
        out = []
        for p, q in CORNERS:
            ends = np.array([[p, q * inner[1]], [p * inner[0], q]])[:: p * q]  # ends of the corner, counter-clockwise
            following = [-p * inner[0], q] if p * q > 0 else [p, -q * inner[1]]
            if self.corner:
                out.append(("arc", np.array([*ends, [p * inner[0], q * inner[1]]])))
            if not np.allclose(ends[1], following, atol=1e-9):
                out.append(("line", np.array([ends[1], following])))
        return [(kind, centre[:, None] + axes @ places.T) for kind, places in out]

    def _chord(self, p: Any, q: Any, dp: Any, dq: Any) -> tuple[Floats, Floats]:
        """Return the interval (t0, t1) of lines ``(p + t dp, q + t dq)``, scaled by half sides, inside (t0 == t1 outside)."""
        rounded = self.corner / np.array(self.axes)
        p, q, dp, dq = np.broadcast_arrays(p, q, dp, dq)
        parts = [_in_box(p, q, dp, dq, 1 - rounded[0], 1.0), _in_box(p, q, dp, dq, 1.0, 1 - rounded[1])]
        for i, j in CORNERS if self.corner else ():
            at = (p - i * (1 - rounded[0])) / rounded[0], (q - j * (1 - rounded[1])) / rounded[1]
            parts.append(in_circle(*at, dp / rounded[0], dq / rounded[1], 1e-24))
        low, high = np.array(parts).transpose(1, 0, 2, 3)
        hit = high > low
        low, high = np.where(hit, low, np.inf).min(axis=0), np.where(hit, high, -np.inf).max(axis=0)
        return np.where(high > low, low, 0.0), np.where(high > low, high, 0.0)

    def crossing(self, gear: Gear, roll: Sequence[float], z: Sequence[float]) -> list[tuple[float, float]]:
        """Return the ranges of t of a straight contact line inside the spall, see `hollow.crossing`."""
        inner, unit = [half - self.corner for half in self.axes], np.array([1.0, 0.0, 0.0])

        def edges(u):
            """Return the sides along the width, the lines on which the corners begin, and the circles of the corners."""
            out = [u - sign * half * unit for half in (self.axes[0], inner[0]) for sign in (-1, 1)]
            for i, j in CORNERS if self.corner else ():
                circle = _square(*(u - i * inner[0] * unit))
                circle[:3] += _square(-j * inner[1], self.axes[1]) - self.corner**2 * unit
                out.append(circle)
            return out

        return crossing(gear, self, roll, z, edges)


def _square(*coefficients):
    """Return the coefficients of the square of a polynomial."""
    return np.convolve(coefficients, coefficients)


def _in_box(p, q, dp, dq, wide, high):
    """Return the interval (t0, t1) of lines in the box ``|p| < wide, |q| < high``."""
    low, up = np.full(p.shape, -np.inf), np.full(p.shape, np.inf)
    for at, step, half in ((p, dp, wide), (q, dq, high)):
        still = np.abs(step) < 1e-12
        safe = np.where(still, 1.0, step)
        ends = np.sort([(-half - at) / safe, (half - at) / safe], axis=0)
        out = still & (np.abs(at) >= half)
        low = np.where(out, np.inf, np.where(still, low, np.maximum(low, ends[0])))
        up = np.where(out, -np.inf, np.where(still, up, np.minimum(up, ends[1])))
    return low, up
