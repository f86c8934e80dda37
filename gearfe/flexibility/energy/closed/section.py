"""Area and inertia of a tooth section ``2 h x b`` damaged by root cracks and pits.

Heights y are along the tooth centre-line and rise from root to tip (of a ring: minus its y). All areas and inertias are means
over the face width, so that a healthy section has ``2 h`` and ``2 h**3 / 3``.

Choices where the literature is ambiguous, or its words do not define a section:

1. A crack affects the sections from the height of its mouth upwards, as in beams that begin at the crack. Sections below are
   whole. Foundation and axial stiffness neglect the crack, since its faces still carry compression (F. Chaari, T. Fakhfakh, M.
   Haddar, Eur. J. Mech. A/Solids 28 (2009) 461-468; Z. Chen, Y. Shao, Eng. Fail. Anal. 18 (2011) 2149-2164). A crack on the
   unloaded side weakens the section as much as one on the loaded side, since section models neglect crack closure.
2. On the true fillet the crack has the corners of `geometry.damage.crack.crack_path`. Other models of the root have another
   thickness there. As in their sources the crack starts at the foot of their beam, with the same angle and `length`, or with its
   `level` as a part of the half thickness of that model.
3. Material does not carry load (is dead) between the crack and a limit line from its tip (x_t, y_t):
   ``constant``: ``x = x_t`` (the h_c of Chen and Shao 2011; X. Liang, M. J. Zuo, M. Pandey, Mech. Mach. Theory 76 (2014) 20-38);
   ``straight``: to the tip corner (x_a, y_a) of the cracked side; ``parabola``: ``x = x_t + (x_a - x_t) sqrt((y - y_t) /
   (y_a - y_t))``, with its vertex in the crack's tip and through the corner (after O. D. Mohammed, M. Rantatalo, J.-O.
   Aidanpaa, Eng. Fail. Anal. 34 (2013) 235-251, who describe it in words; the axis along the tooth is our reading). The flank
   beyond the same line drawn from the crack's mouth carries load. Otherwise a crack of zero length would weaken the tooth. On a
   true fillet, ``constant`` has no such part.
4. A pit reduces the half thickness by its depth over the width of its chord at that height. This is the convention of the
   literature; the true chord is ``depth / cos(load angle)``. Material that is dead because of a crack is not removed twice. The
   inertia is about the centroid of what is left, so it is positive; the bending moment stays about the tooth centre-line, as in
   the literature.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....geometry.damage.crack import crack_path
from ....geometry.damage.hollow import intervals
from ....geometry.tooth.profile import cartesian, flank

CRACK_MODELS = ("constant", "straight", "parabola")


@dataclass(frozen=True, slots=True)
class DamagedTooth:
    """Damage of one tooth (its tooth number is ignored), and the limit line `crack_model` of the load-carrying material."""

    cracks: tuple[Any, ...] = ()
    pits: tuple[Any, ...] = ()
    crack_model: str = "constant"

    def __bool__(self):
        return bool(self.cracks or self.pits)


@dataclass(frozen=True, slots=True)
class Limit:
    """Limit line of one crack: x (positive on the cracked side) and y of its tip, its mouth and the tip corner [mm]."""

    model: str
    side: str
    tip: tuple
    mouth: tuple
    corner: tuple

    def edge(self, h, y):
        """Return the edge of the load-carrying section on the cracked side [mm] for half thickness `h` at height `y`."""
        return np.where(y >= self.mouth[1], np.minimum(h, self._line(h, y)), h)

    def switches(self, h, y, depths):
        """Functions of (h, y) that change sign where the section's formula changes; shape (functions, *h.shape)."""
        line = self._line(h, y)
        return np.array([y - self.mouth[1], h - self._from(self.mouth, y), *(h - depth - line for depth in (0.0, *depths))])

    def _line(self, h, y):
        """Return the limit line from the tip, extended by the bulge of the flank beyond the line from the mouth."""
        return self._from(self.tip, y) + np.maximum(h - self._from(self.mouth, y), 0.0)

    def _from(self, start, y):
        if self.model == "constant":
            return np.full(np.shape(y), start[0])
        part = np.maximum((y - start[1]) / (self.corner[1] - start[1]), 0.0)
        return start[0] + (self.corner[0] - start[0]) * (np.sqrt(part) if self.model == "parabola" else part)


def limits(gear, damage, foot=None):
    """Return the limit lines of the cracks of a `DamagedTooth`.

    `foot` is where the modelled beam begins if that is not the true fillet.
    """
    if damage.crack_model not in CRACK_MODELS:
        raise ValueError(f"crack_model = {damage.crack_model!r}, but it must be one of {', '.join(CRACK_MODELS)}")
    x, y = cartesian(*flank(gear, gear.roll_a))
    corner = (float(x), float(gear.outward * y))
    out = []
    for crack in damage.cracks:
        path = crack_path(gear, crack)
        sign = 1 if crack.side == "loaded" else -1
        path = path * [[sign], [gear.outward]] if foot is None else _moved(crack, np.asarray(foot))
        out.append(Limit(damage.crack_model, crack.side, tuple(path[:, -1].tolist()), tuple(path[:, 0].tolist()), corner))
    return out


def _moved(crack, foot):
    """Corners of the crack if it starts at `foot`."""
    heading = np.array([-math.sin(crack.angle), -math.cos(crack.angle)])
    level = min(crack.level, 0.5 if crack.turning else 1.0) if crack.level is not None else None
    length = crack.length if level is None else 2 * foot[0] / math.sin(crack.angle) * level
    corners = [foot, foot + heading * length]
    if crack.turning and crack.level > 0.5:
        corners.append(corners[1] + (foot * [-1, 1] - corners[1]) * (2 * crack.level - 1))
    return np.array(corners).T


def section(gear, h, y, arc, found, pits):
    """Area and inertia of the sections at heights `y`.

    Parameters
    ----------
    gear : Gear
    h, y, arc : ndarray, shape (n,)
        Half thickness, height and flank arc (nan off the flank) of each section [mm].
    found : list of Limit
        Of the cracks, see `limits`.
    pits : sequence of Pit

    Returns
    -------
    area, inertia, uncracked : ndarray, shape (n,)
        [mm], [mm**3] about the centroid of what is left, and the area without the cracks, for axial compression [mm]: means
        over the face width.

    Raises
    ------
    ValueError
        If cracks and pits leave nothing somewhere.
    """
    edges = {"loaded": h, "unloaded": h}
    for limit in found:
        edges[limit.side] = limit.edge(h, y)
    area, inertia = _left_of(gear, h, y, arc, edges, pits)
    uncracked = _left_of(gear, h, y, arc, {"loaded": h, "unloaded": h}, pits)[0] if found and pits else area
    return area, inertia, 2 * h if found and not pits else uncracked


def _left_of(gear, h, y, arc, edges, pits):
    """Return area and inertia between the edges of the load-carrying material, after removal of the pits."""
    right, left = edges["loaded"], -edges["unloaded"]
    area = _positive(gear, right - left, y)
    inertia = area**3 / 12
    if not pits:
        return area, inertia
    low, high = intervals(gear, pits, arc)
    hit = np.flatnonzero((high > low).any(axis=0))
    if hit.size == 0:
        return area, inertia
    low, high, h, y = low[:, hit], high[:, hit], h[hit], y[hit]
    ends = np.sort(np.vstack([np.zeros(hit.size), low, high, np.full(hit.size, gear.b)]), axis=0)
    part, middle = np.diff(ends, axis=0) / gear.b, (ends[1:] + ends[:-1]) / 2
    depth = {"loaded": np.zeros(part.shape), "unloaded": np.zeros(part.shape)}
    for pit, start, stop in zip(pits, low, high, strict=True):
        under = (start < middle) & (middle < stop)
        depth[pit.side] = np.where(under, np.maximum(depth[pit.side], pit.depth), depth[pit.side])
    top = np.minimum(right[hit], h - depth["loaded"])
    bottom = np.maximum(left[hit], depth["unloaded"] - h)
    _positive(gear, np.where(part > 0, top - bottom, 1.0), np.broadcast_to(y, part.shape))
    area, inertia = area.copy(), inertia.copy()
    area[hit] = (part * (top - bottom)).sum(axis=0)
    centre = (part * (top**2 - bottom**2)).sum(axis=0) / (2 * area[hit])
    inertia[hit] = (part * ((top - centre) ** 3 - (bottom - centre) ** 3)).sum(axis=0) / 3
    return area, inertia


def _positive(gear, thickness, y):
    """Return `thickness` [mm]. Raises ValueError where no material is left."""
    if (thickness <= 0).any():
        height = abs(y[thickness <= 0].flat[0])
        raise ValueError(
            f"cracks and other damage leave no section of the tooth of z = {gear.z} at height {height:.5g} mm from the "
            "gear's axis: make them smaller, or past the centre-line use crack_model = 'straight' or 'parabola'"
        )
    return thickness
