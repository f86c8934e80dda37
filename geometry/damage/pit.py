"""`Pit`: an elliptic pit on a flank, the width it takes away, and where a contact line crosses it."""

import math
from dataclasses import dataclass
from numbers import Integral, Real

import numpy as np

from ..tooth.profile import arc_at, flank, roll_at_arc

MOST = 5000  # pits in a row
LEAST, LONGEST = 1e-50, 1e50  # semi-axes [mm]: a pit larger than its flank takes all of it, however large


@dataclass(frozen=True, slots=True)
class Pit:
    """An elliptic cylinder of constant depth cut along the flank normal out of one flank.

    It is described on the flank by u, the arc of the transverse profile from its centre (towards the tip), and w, the axial
    distance from its centre along the tooth trace. With ``p = u cos(angle) + w sin(angle)`` and
    ``q = w cos(angle) - u sin(angle)`` its edge is ``(p / axes[0])**2 + (q / axes[1])**2 = 1``: exact on a spur gear; on a
    helical one u and w are oblique by ``tan(beta_b) rho / r_b`` and the ellipse is sheared by as much.

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
        If the description is contradictory; a pit beside its flank is refused when it meets its gear, see `check_pits`.

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

    def __post_init__(self) -> None:
        """Refuse contradictory descriptions."""
        for name in ("radius", "z", "depth", "angle"):
            object.__setattr__(self, name, _number(name, getattr(self, name)))
        try:
            axes = tuple(self.axes)
        except TypeError:
            axes = ()
        if len(axes) != 2:
            raise ValueError(f"axes = {self.axes!r}, but give two semi-axes [mm]: along the profile, along the width")
        object.__setattr__(self, "axes", tuple(_number("axes", value) for value in axes))
        if isinstance(self.tooth, bool) or not isinstance(self.tooth, Integral):
            raise ValueError(f"tooth = {self.tooth!r}, but it is a whole number")
        object.__setattr__(self, "tooth", int(self.tooth))
        for name, value in (("radius", self.radius), ("depth", self.depth), ("axes", min(self.axes))):
            if not value > 0:
                raise ValueError(f"{name} = {getattr(self, name)}, but it must be positive [mm]")
        if not (min(self.axes) >= LEAST and max(self.axes) <= LONGEST):
            raise ValueError(f"axes = {self.axes} mm, but a semi-axis lies between {LEAST:g} and {LONGEST:g} mm: it is squared")
        if not abs(self.angle) <= math.pi:
            raise ValueError(f"angle = {self.angle} rad, but it must lie between -pi and pi; angles are radians in Python")
        if self.side not in ("loaded", "unloaded"):
            raise ValueError(f"side = {self.side!r}, but it must be 'loaded' or 'unloaded'")

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


def _number(name, value):
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
        raise ValueError(f"{name} = {value!r}, but a pit needs a finite number here")
    return float(value)


def centre_arc(gear, pit):
    """Arc of the pit's centre [mm], as `geometry.tooth.profile.arc_at` counts it."""
    return gear.outward * (pit.radius**2 - gear.r_b**2) / (2 * gear.r_b)


def rolls(gear, pit):
    """Roll lengths [mm] of the pit's ends nearest the root and nearest the tip, on the involute between form and tip circle."""
    middle, reach = centre_arc(gear, pit), pit.reach[0]
    low, high = arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a)
    return roll_at_arc(gear, np.clip([middle - reach, middle + reach], low, high))


def takes_all(gear, pit):
    """Whether a pit takes its whole flank: all four corners of it lie within the ellipse."""
    u = arc_at(gear, np.array([gear.roll_f, gear.roll_a])) - centre_arc(gear, pit)
    w = np.array([0.0, gear.b]) - pit.z
    across, mixed, along = pit.form
    return bool((across * w[:, None] ** 2 + 2 * mixed * w[:, None] * u + along * u**2 <= 1).all())


def check_pits(gear, pits):
    """Raise ValueError for a pit whose centre is off the flank, or that is as deep as half the tooth where it lies.

    Pits may cross the tip edge and the end faces, and may overlap; what reaches below the form circle is not on the flank and
    is left out.
    """
    for pit in pits:
        if not isinstance(pit, Pit):
            raise ValueError(f"{pit!r} is not a Pit")
        low, high = sorted((gear.r_form, gear.r_a))
        if not low <= pit.radius <= high:
            raise ValueError(
                f"pit at radius = {pit.radius:.6g} mm, but the flank of z = {gear.z} runs from {low:.6g} to {high:.6g} mm: "
                "put the pit's centre there"
            )
        if not 0 <= pit.z <= gear.b:
            raise ValueError(f"pit at z = {pit.z:.6g} mm, but the face is {gear.b:.6g} mm wide: give 0 <= z <= b")
        radius, angle = flank(gear, rolls(gear, pit)[1])
        half = float(radius * math.sin(angle))
        if pit.depth >= half:
            raise ValueError(
                f"pit of depth = {pit.depth:.6g} mm, but half the tooth of z = {gear.z} is only {half:.6g} mm thick at its "
                "upper end: make it shallower or put it nearer the root"
            )


def pit_row(count, first, last, **numbers):
    """Return `count` equal pits with centres evenly from z = `first` to `last` [mm]; `numbers` as of `Pit`.

    Raises
    ------
    ValueError
        If `count` is not a whole number from 1 to `MOST`: contact lines are cut at every pit.
    """
    if isinstance(count, bool) or not isinstance(count, Integral) or not 1 <= count <= MOST:
        raise ValueError(f"count = {count!r} pits in a row, but give a whole number from 1 to {MOST}")
    return [Pit(z=float(z), **numbers) for z in np.linspace(first, last, count)]


def intervals(gear, pits, arc):
    """Axial intervals the pits take from the flank at profile arcs `arc`.

    Parameters
    ----------
    gear : Gear
    pits : sequence of Pit
    arc : ndarray
        As of `geometry.tooth.profile.arc_at` [mm]; nan is off the flank.

    Returns
    -------
    low, high : ndarray, shape (pits, *arc.shape)
        Ends [mm] within 0..b, equal where the pit takes nothing.
    """
    arc = np.asarray(arc, dtype=float)
    low, high = np.zeros((2, len(pits), *arc.shape))
    for k, pit in enumerate(pits):
        across, mixed, along = pit.form
        u = arc - centre_arc(gear, pit)
        root = across - (across * along - mixed**2) * u**2
        half = np.sqrt(np.where(root > 0, root, 0.0)) / across
        middle = pit.z - mixed * np.where(root > 0, u, 0.0) / across
        low[k], high[k] = np.clip(middle - half, 0, gear.b), np.clip(middle + half, 0, gear.b)
    return low, high


def union_length(low, high):
    """Length covered by intervals ``[low, high]`` along the first axis, overlaps counted once; ``low <= high``."""
    if len(low) == 0:
        return np.zeros(np.shape(low)[1:])
    order = np.argsort(low, axis=0, kind="stable")
    low, high = np.take_along_axis(low, order, axis=0), np.take_along_axis(high, order, axis=0)
    before = np.concatenate([low[:1], np.maximum.accumulate(high, axis=0)[:-1]])
    return np.maximum(high - np.maximum(low, before), 0.0).sum(axis=0)


def lost_width(gear, pits, arc):
    """Width [mm] the pits of one flank take away at profile arcs `arc` [mm]: length of the union of `intervals`."""
    return union_length(*intervals(gear, pits, arc))


def crossing(gear, pit, roll, z):
    """Where a straight contact line runs through a pit.

    Parameters
    ----------
    gear : Gear
    pit : Pit
    roll, z : (float, float)
        Roll lengths [mm] and axial positions [mm] at the line's ends, t = 0 and t = 1.

    Returns
    -------
    list of (float, float)
        Ranges of t inside the pit; at most two, because the profile arc is quadratic in t.
    """
    across, mixed, along = pit.form
    slope = z[1] - z[0]
    reach = pit.reach[1]
    # in v = (z - pit.z) / reach, which is between -1 and 1 in the pit, whatever the line's length
    change = (roll[1] - roll[0]) / slope
    at = roll[0] + change * (pit.z - z[0])
    sign = gear.outward / (2 * gear.r_b)
    u = np.array([sign * at**2 - centre_arc(gear, pit), 2 * sign * at * change * reach, sign * (change * reach) ** 2])
    w = np.array([0.0, reach])
    inside = across * _times(w, w, 5) + 2 * mixed * _times(u, w, 5) + along * _times(u, u, 5)
    inside[0] -= 1.0
    inside = inside[: np.flatnonzero(np.abs(inside) > 1e-15 * np.abs(inside).max())[-1] + 1]
    found = np.polynomial.polynomial.polyroots(inside)
    found = found.real[np.abs(found.imag) < 1e-9]
    places = np.sort(np.concatenate([[-1.0, 1.0], found[np.abs(found) < 1]]))
    kept = [
        (a, b) for a, b in zip(places[:-1], places[1:], strict=True) if np.polynomial.polynomial.polyval((a + b) / 2, inside) < 0
    ]
    ends = [np.clip((pit.z + reach * np.array(part) - z[0]) / slope, 0.0, 1.0) for part in kept]
    return [(float(t.min()), float(t.max())) for t in ends if t.max() > t.min()]


def _times(a, b, size):
    """Product of two polynomials, padded."""
    out = np.convolve(a, b)
    return np.append(out, np.zeros(size - out.size))
