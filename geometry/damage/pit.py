"""`Pit`: an elliptic pit on a flank, and its intersections with lines."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from numbers import Integral
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ..aliases import Floats
from ..tooth.gear import Gear
from .given import settle_hollow
from .hollow import crossing, in_circle, profile, warning_of

MOST = 5000  # largest number of pits in a row
LEAST, LONGEST = 1e-50, 1e50  # limits of the semi-axes [mm]; a pit larger than the flank removes the whole flank


@dataclass(frozen=True, slots=True)
class Pit:
    """An elliptic cylinder of constant depth cut along the flank normal out of one flank.

    It is described on the flank by u, the arc of the transverse profile from its centre (towards the tip), and w, the axial
    distance from its centre along the tooth trace. With ``p = u cos(angle) + w sin(angle)`` and
    ``q = w cos(angle) - u sin(angle)`` its edge is ``(p / axes[0])**2 + (q / axes[1])**2 = 1``: This is exact on a spur
    gear. On a helical gear u and w are oblique by ``tan(beta_b) rho / r_b``, and the ellipse is sheared accordingly.

    Parameters
    ----------
    radius : float
        Radius of the flank point at its centre [mm], from the axis of the gear.
    z : float
        Distance of its centre [mm] from the end face at the back of the transverse section (x, y and z right-handed; the
        loaded flank is on the right), from 0 to b. Of two meshing gears both are counted from the same end.
    axes : (float, float)
        Semi-axes along the profile and along the width [mm].
    depth : float
        Depth along the flank normal [mm].
    angle : float
        Angle by which the axes are turned in the flank's tangent plane, the first one from the profile towards +z [rad].
    tooth : int
        Number of the tooth, counted as for a `Crack`.
    side : {"loaded", "unloaded"}
        Flank it lies on.

    Raises
    ------
    ValueError
        If the description is contradictory. A pit off its flank is rejected when it is used with its gear, see
        `gearfe.geometry.damage.hollow.check_hollows`.

    >>> Pit(radius=21.0, z=10.0, axes=(1.0, 2.0), depth=0.2).reach
    (1.0, 2.0)
    """

    radius: float
    z: float
    axes: tuple[float, float]
    depth: float
    angle: float = 0.0
    tooth: int = 0
    side: str = "loaded"

    kinks: ClassVar[tuple[tuple[float, ...], tuple[float, ...]]] = (), ()
    _nouns: ClassVar[tuple[str, str]] = ("pit", "pits")
    _adjective: ClassVar[str] = "pitted"
    _removes_contact: ClassVar[bool] = True
    through: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Raise ValueError for contradictory arguments."""
        settle_hollow(self, "axes", "semi-axes", "angle")
        if not (min(self.axes) >= LEAST and max(self.axes) <= LONGEST):
            raise ValueError(f"axes = {self.axes} mm, but each semi-axis must lie between {LEAST:g} and {LONGEST:g} mm")
        if not abs(self.angle) <= math.pi:
            raise ValueError(f"angle = {self.angle} rad, but it must lie between -pi and pi; angles are radians in Python")

    @property
    def form(self) -> tuple[float, float, float]:
        """Coefficients (A, B, C) of the edge ``A w**2 + 2 B u w + C u**2 = 1`` [1/mm**2]."""
        s, c = math.sin(self.angle), math.cos(self.angle)
        p, q = 1 / self.axes[0] ** 2, 1 / self.axes[1] ** 2
        return s * s * p + c * c * q, s * c * (p - q), c * c * p + s * s * q

    @property
    def reach(self) -> tuple[float, float]:
        """Half extents along the profile and along the width [mm]."""
        across, _, along = self.form
        area = self.axes[0] * self.axes[1]
        return math.sqrt(across) * area, math.sqrt(along) * area

    def outline(self, gear: Gear) -> Floats:
        """Return the line ``(2, n)`` [mm] that represents the pit in the transverse section, in the frame of its tooth."""
        return profile(gear, self)

    def _description(self, gear: Gear) -> str:
        """Return a description of the pit."""
        return "1 pit"

    def _warning(self, gear: Gear) -> str:
        """Return a warning for the pit on its gear. The result is empty if there is none."""
        return warning_of(gear, self, f"semi-axes {self.axes[0]:g} x {self.axes[1]:g}")

    def mirrored(self, b: float) -> Self:
        """Return the mirror image of the pit in the other half of a face of width `b` [mm]."""
        return replace(self, z=b - self.z, angle=-self.angle)

    def _contains(self, u: Floats, w: Floats) -> NDArray[np.bool_]:
        """Return whether places lie in the pit: `u` along the profile, `w` along the width from its centre [mm]."""
        across, mixed, along = self.form
        return across * w**2 + 2 * mixed * w * u + along * u**2 <= 1

    def span(self, u: Floats) -> tuple[Floats, Floats]:
        """Return the heights z [mm] of both ends of the pit at `u` along the profile from its centre [mm].

        The two heights are equal where the pit has no width.
        """
        across, mixed, along = self.form
        root = across - (across * along - mixed**2) * u**2
        half = np.sqrt(np.where(root > 0, root, 0.0)) / across
        middle = self.z - mixed * np.where(root > 0, u, 0.0) / across
        return middle - half, middle + half

    def _edge(self) -> tuple[Floats, Floats]:
        """Return the outline of the pit as places along the profile and along the width from its centre [mm]."""
        turn = np.linspace(0, 2 * np.pi, 90)
        p, q = self.axes[0] * np.cos(turn), self.axes[1] * np.sin(turn)
        c, s = np.cos(self.angle), np.sin(self.angle)
        return p * c - q * s, p * s + q * c

    def _contours(self, centre: Floats, axes: Floats) -> list[tuple[str, Floats]]:
        """Return the outline in space: centre and perpendicular half axes ``(3, 3)`` of the ellipse spanned by `axes`.

        The columns of `axes` ``(3, 2)`` need not be perpendicular.
        """
        turned, size, _ = np.linalg.svd(axes, full_matrices=False)
        return [("ellipse", np.column_stack([centre, turned * size]))]

    def _chord(self, p: Any, q: Any, dp: Any, dq: Any) -> tuple[Floats, Floats]:
        """Return the intervals (t0, t1) of scaled lines ``(p + t dp, q + t dq)`` in a pit (t0 == t1 outside)."""
        return in_circle(p, q, dp, dq, 1e-12 / min(self.axes) ** 2)

    def crossing(self, gear: Gear, roll: Sequence[float], z: Sequence[float]) -> list[tuple[float, float]]:
        """Return the ranges of t of a straight contact line inside the pit, at most two, see `hollow.crossing`."""
        across, mixed, along = self.form
        w = np.array([0.0, self.reach[1]])

        def edge(u):
            inside = along * np.convolve(u, u)
            inside[:3] += across * np.convolve(w, w) - [1.0, 0.0, 0.0]
            inside[:4] += 2 * mixed * np.convolve(u, w)
            return [inside]

        return crossing(gear, self, roll, z, edge)


def pit_row(count, first, last, **numbers):
    """Return `count` equal pits with centres evenly spaced from z = `first` to `last` [mm]. `Pit` describes `numbers`.

    Raises
    ------
    ValueError
        If `count` is not a whole number from 1 to `MOST`: contact lines are cut at every pit.
    """
    if isinstance(count, bool) or not isinstance(count, Integral) or not 1 <= count <= MOST:
        raise ValueError(f"count = {count!r} pits in a row, but give a whole number from 1 to {MOST}")
    return [Pit(z=float(z), **numbers) for z in np.linspace(first, last, count)]
