"""`FlankForm`: a `Flank` on its gear, by roll length, height and tooth."""

import math
from copy import copy
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ..aliases import Floats
from ..checks import shown
from .gear import Gear
from .lead import LeadForm
from .relief import relief_start
from .tables import covering, each_tooth
from .tip_edge import TipEdge

AMOUNTS = (  # fields of a `Flank` that remove material
    "tip_relief", "root_relief", "profile_crowning", "profile_slope", "helix_crowning", "helix_slope", "twist", "end_relief",
)  # fmt: skip
LARGEST = 0.1  # limit of removed material [m_n], because thinning changes the flexibility only by a beam correction
BENT = 0.1  # The start of a parabolic relief is a kink if the curvature jumps by more than this part of the flank's.
STEP = 1e-6  # roll length of the difference quotient for slopes [m_n]


class FlankForm:
    """Flank on its gear: material removed by roll length and, in the form of `at`, by height.

    `kinks` are the roll lengths [mm] at which the slope of the flank jumps, and the jump of the removed material per mm of roll
    length. The contact has no radius of curvature there. At the start of a parabolic relief the curvature jumps.
    """

    def __init__(self, flank: Any, gear: Gear) -> None:
        self.flank, self.gear = flank, gear
        self.low, self.high = gear.roll_f, gear.roll_a
        ends = (("tip", self.high), ("root", self.low))
        reliefs = [
            (relief_start(gear, end, *flank.start_of(end)), last, end) for end, last in ends if getattr(flank, f"{end}_relief")
        ]
        self.reliefs = [(s, e, getattr(flank, f"{end}_relief"), getattr(flank, f"{end}_exponent")) for s, e, end in reliefs]
        self.kinks = tuple(
            (start, amount / abs(end - start) if exponent == 1 else 0.0)
            for start, end, amount, exponent in self.reliefs
            if exponent < 2 or (exponent == 2 and _bends(gear, start, 2 * amount / (end - start) ** 2))
        )
        self.edge = TipEdge(gear, flank.tip_rounding, flank.tip_chamfer) if flank.tip_rounding or flank.tip_chamfer else None
        if self.edge is not None:
            self.kinks += ((self.edge.start, self.edge.kink),)
        self._worn = None if flank.wear is None else scipy.interpolate.PchipInterpolator(*flank.wear)
        self._spline = None
        if flank.table is not None:
            self._spline = scipy.interpolate.PchipInterpolator(*covering(flank.table, gear))
        self._shifts = each_tooth("pitch", flank.pitch, gear) * gear.r_b / gear.r
        self._scales = each_tooth("tooth_scale", flank.tooth_scale, gear)
        self._tooth: NDArray[np.int64] | None = None
        self.sense = 1
        self.tilt, self._lead = 0.0, LeadForm(flank, gear, self.low, self.high) if flank.wide else None
        self._z: Floats | None = None
        self._check_size()

    @property
    def wide(self) -> bool:
        """Whether the flank changes along the width or is inclined. `tilt` is the inclination [mm/mm]."""
        return self._lead is not None or bool(self.tilt)

    @property
    def differs(self) -> bool:
        """Whether the teeth of the gear differ from each other."""
        return bool(self.flank.eccentricity) or any(values.size and np.ptp(values) for values in (self._shifts, self._scales))

    @property
    def unlike(self) -> set[int]:
        """Numbers of teeth without the most frequent pitch deviation or scale. For an eccentric gear, all teeth."""
        found = set(range(self.gear.z)) if self.flank.eccentricity else set()
        for values in filter(np.size, (self._shifts, self._scales)):
            numbers, counts = np.unique(values, return_counts=True)
            found |= set(np.flatnonzero(values != numbers[np.argmax(counts)]).tolist())
        return found

    def of(self, tooth: ArrayLike) -> "FlankForm":
        """Return the same flank for teeth ``(...)``, which correspond to the leading axes of roll lengths."""
        if not (self._scales.size or self.flank.eccentricity):
            return self
        out = copy(self)
        out._tooth = np.asarray(tooth, dtype=int)
        return out

    def turned(self, sense: int) -> "FlankForm":
        """Return the flank of a gear whose tooth k lies k pitches clockwise (1) or counter-clockwise (-1) of tooth 0."""
        out = copy(self)
        out.sense = sense
        return out

    def at(self, z: ArrayLike | None) -> "FlankForm":
        """Return the flank at heights `z` [mm], which correspond to the leading axes of roll lengths.

        With None, changes along the width are neglected.
        """
        out = copy(self)
        out._z = None if z is None or not self.wide else np.asarray(z, dtype=float)
        return out

    def tilted(self, tilt: float) -> "FlankForm":
        """Return the same flank with an inclination [mm/mm] about the middle of the width."""
        out = copy(self)
        out.tilt = tilt
        return out

    def _check_size(self) -> None:
        roll = np.linspace(self.low, self.high, 65)
        most = LARGEST * self.gear.m_n
        sections = self.at(np.linspace(0, self.gear.b, 17))
        largest = max(1.0, float(np.abs(self._scales).max(initial=0.0)))
        given = {name: getattr(self.flank, name) for name in AMOUNTS}
        shape = ", ".join(f"{name} = {shown(amount)} mm" for name, amount in given.items() if np.any(amount))
        shaped = sections._shaped(roll[None, :], 0)
        if self._scales.size and not shaped.any():
            raise ValueError(
                f"tooth_scale of z = {self.gear.z} scales profile and helix modifications, but there are none; it does not scale "
                "wear, pitch, edges and eccentricity: leave it out, or give a modification"
            )
        for name, values in (
            (shape or "table", largest * shaped),
            ("pitch", self._shifts),
            (f"eccentricity = {self.flank.eccentricity:g} mm", np.array([self.flank.eccentricity])),
            ("wear", np.zeros(1) if self._worn is None else self._wear(roll, 0)),
        ):
            worst = float(np.abs(values).max(initial=0.0))
            if worst > most:
                raise ValueError(
                    f"{name}: the flank of z = {self.gear.z} deviates by {worst:.4g} mm, but a tenth of the module, "
                    f"{most:.4g} mm, is the limit: give smaller amounts"
                )

    def removed(self, roll: ArrayLike, derivative: int = 0) -> Floats:
        """Return the material removed at roll lengths [mm], or its derivative by the roll length, without pitch deviations.

        The derivatives exclude the edge of the tip (see `bend`). In the fillet, the material removed is that at the form
        point.
        """
        at = self._on_flank(roll)
        out = self._formed(at, derivative)
        if self.flank.eccentricity and self._tooth is not None:
            out = out + self._off_centre(at, derivative)
        return out

    def _on_flank(self, roll: ArrayLike) -> Floats:
        """Return roll lengths, with those in the fillet replaced by the form point."""
        rolls = np.asarray(roll, dtype=float)
        return np.maximum(rolls, self.low) if self.high > self.low else np.minimum(rolls, self.low)

    def _formed(self, at: NDArray, n: int) -> Floats:
        """Return the material removed by form, wear and tip edge, without eccentricity."""
        out = self._shaped(at, n)
        if self._scales.size:
            factor = self._scales[0] if self._tooth is None else _along(self._scales[self._tooth % self.gear.z], at)
            out = out * factor
        if self._worn is not None:
            out = out + self._wear(at, n)
        if self.edge is not None and n == 0:
            out = out + self.edge.removed(at)
        return out

    def thinned(self, roll: ArrayLike, tooth: int) -> Floats:
        """Return the removed material that makes a tooth thinner at roll lengths [mm]: no tip edge, position and pitch errors."""
        at = self.before_edge(self._on_flank(roll))
        return self.of(np.array([tooth]))._formed(at[None, :], 0)[0]

    def slope(self, roll: ArrayLike) -> Floats:
        """Return the slope of the flank towards the tip, its edge included: removed material by arc length [mm/mm].

        At a kink it is the mean of both sides.
        """
        at, step = np.asarray(roll, dtype=float), STEP * self.gear.m_n
        rise = (self.removed(at + step) - self.removed(at - step)) / (2 * step)
        return self.gear.outward * rise * self.gear.r_b / np.maximum(at, 1e-3 * self.gear.r_b)

    def _wear(self, roll: NDArray, derivative: int) -> Floats:
        return np.nan_to_num(self._worn(roll, derivative, extrapolate=False))  # type: ignore[misc]  # only called with wear

    def _off_centre(self, roll: NDArray, derivative: int) -> Floats:
        """Return the deviation of an eccentric gear's flank along its normal, whose direction changes with the roll length."""
        gear, flank = self.gear, self.flank
        teeth = self.sense * (_along(self._tooth, roll) - flank.eccentric_tooth)  # type: ignore[arg-type]  # tooth tables are present here
        turn = gear.base_half_angle - gear.outward * roll / gear.r_b + 2 * math.pi * teeth / gear.z
        rate = -gear.outward / gear.r_b
        return flank.eccentricity * (np.sin(turn), rate * np.cos(turn), -(rate**2) * np.sin(turn))[derivative]

    def _shaped(self, roll: NDArray, derivative: int) -> Floats:
        """Return the material removed by design, equal on all teeth except for their scales."""
        span, n = self.high - self.low, derivative
        out = np.zeros(roll.shape)
        for start, end, amount, exponent in self.reliefs:
            part = np.maximum((roll - start) / (end - start), 0.0)
            factor = amount * math.prod(exponent - i for i in range(n)) / (end - start) ** n
            if factor:
                out += np.where(part > 0, factor * np.where(part > 0, part, 1.0) ** (exponent - n), 0.0)
        if self.flank.profile_crowning:
            place, step = (2 * roll - self.low - self.high) / span, 2 / span
            out += self.flank.profile_crowning * (place**2, 2 * step * place, 2 * step**2)[n]
        if self.flank.profile_slope:
            out += self.flank.profile_slope * ((roll - self.low) / span, 1 / span, 0.0)[n]
        if self._spline is not None:
            out += self._spline(np.clip(roll, self._spline.x[0], self._spline.x[-1]), n)
        if self._lead is not None and self._z is not None:
            out = out + self._lead.removed(roll, _along(self._z, roll), n)
        return out

    def before_edge(self, roll: Floats) -> Floats:
        """Return roll lengths, with those on the tip edge replaced by its beginning."""
        if self.edge is None:
            return roll
        return np.minimum(roll, self.edge.start) if self.high > self.low else np.maximum(roll, self.edge.start)

    def bounds(self) -> tuple[float, float]:
        """Return the least and largest distance by which any point of any tooth lies behind the involute [mm]."""
        heights = np.linspace(0, self.gear.b, 33)
        form = self.at(heights)
        rolls = np.linspace(self.low, self.high, 65)[None, :]
        shape, rest = form._shaped(rolls, 0), form.shift(np.zeros((heights.size, 1), dtype=int)) - self._shifts[:1].sum()
        scales, shifts = (
            values if values.size else np.array([default]) for values, default in ((self._scales, 1.0), (self._shifts, 0.0))
        )
        worn = 0.0 if self._worn is None else self._wear(rolls, 0)
        low, high = (shape * scales.min() + worn + rest, shape * scales.max() + worn + rest)
        off, edge = abs(self.flank.eccentricity), 0.0 if self.edge is None else self.edge.most
        low, high = np.minimum(low, high), np.maximum(low, high)
        return float(low.min() + shifts.min()) - off, float(high.max() + shifts.max()) + off + edge

    def shift(self, tooth: ArrayLike) -> Floats:
        """Return the position error of the flanks of teeth, behind their nominal position along the line of action [mm]."""
        tooth = np.asarray(tooth, dtype=int)
        behind = self._shifts[tooth % self.gear.z] if self._shifts.size else np.zeros(tooth.shape)
        if self.tilt and self._z is not None:
            behind = behind + self.tilt * (_along(self._z, tooth) - self.gear.b / 2)
        return behind

    def bend(self, roll: ArrayLike) -> Floats:
        """Curvature that the modification adds to the flank, by its arc length [1/mm], without kinks.

        Eccentricity shifts the whole gear and does not change the curvature.
        """
        at = np.maximum(np.asarray(roll, dtype=float), 1e-3 * self.gear.r_b)  # The roll length is zero at the base circle.
        on = self._on_flank(at)
        out = (self.gear.r_b / at) ** 2 * (self._formed(on, 2) - self._formed(on, 1) / at)
        return out if self.edge is None else np.where(self.edge.on(at), self.edge.bend(at), out)


def _bends(gear: Gear, roll: float, jump: float) -> bool:
    """Whether a `jump` of the second derivative of the removed material [1/mm] exceeds `BENT`."""
    return jump * gear.r_b**2 / max(roll, 1e-3 * gear.r_b) > BENT


def _along(z: NDArray, places: NDArray) -> NDArray:
    """Return heights with as many trailing axes as `places` has in addition."""
    return z.reshape(z.shape + (1,) * max(places.ndim - z.ndim, 0))
