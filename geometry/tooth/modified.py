"""`Flank`: what the loaded flanks of a gear have less (or more) than the involute, and how far each tooth is from its place.

`FlankForm`: the same on its gear, by roll length, height and tooth.
"""

import math
from copy import copy
from dataclasses import dataclass
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from .gear import Gear
from .lead import LeadForm, checked_topography, two_ends
from .relief import STARTS, relief_start
from .tables import covering, each_tooth, numbers, table, worn
from .tip_edge import TipEdge

LISTS = ("table", "topography", "pitch", "wear", "tooth_scale")
LARGEST = 0.1  # m_n: the tooth's flexibility is that of the unmodified tooth
STEP = 1e-6  # m_n: over which a slope is taken


@dataclass(frozen=True, slots=True)
class Flank:
    """Modifications and deviations of a gear's loaded flanks, from tip to root and from tooth to tooth.

    Amounts are in mm, normal to the involute in the transverse section (along the line of action), as ISO 1328-1 and ISO 21771
    measure them; **positive: material is removed**. With L the roll length, `roll_f` at the form point and `roll_a` at the tip,
    and t the part of the way from the start of a relief to the end of the flank, a place of the flank has less by::

        tip_relief t**tip_exponent  (t > 0)  +  root_relief t**root_exponent  (t > 0)
        + crowning p**2  +  slope (1 + p) / 2  +  table(L)            p = 2 (L - middle) / (roll_a - roll_f)
        + lead_crowning q**2  +  lead_slope (1 + q) / 2  +  twist p q   q = 2 z / b - 1, at height z of the width b
        + end_relief (part of the way to its end face)**end_exponent  +  topography(L, z)

    all of it times `tooth_scale` of the tooth, and besides

        + wear(L)  +  the edge of the tip  +  what an eccentric gear lacks at this place of this tooth

    Parameters
    ----------
    tip_relief, root_relief : float
        Amount at the tip (C_alpha a of ISO 21771) and at the form point (C_alpha f) [mm].
    tip_start_diameter, tip_start_roll, tip_start_angle : float, optional
        One of them: where the tip relief starts, as a diameter [mm], a roll length [mm] or a roll angle [rad].
    tip_exponent : float
        1: linear, with a kink at its start; 2: parabolic; any number from 1 on.
    root_start_diameter, root_start_roll, root_start_angle, root_exponent
        The same for the root relief, which grows from its start down to the form point.
    crowning : float
        Profile crowning C_alpha: a parabola, zero in the middle of the flank's roll lengths, so much at tip and form point [mm].
    slope : float
        Removed at the tip if the rest is removed in proportion up from the form point [mm]: a profile slope deviation f_Halpha of
        ISO 1328-1 with the opposite sign (there, material at the tip counts positive).
    table : (sequence, sequence), optional
        Measured deviation: rising roll lengths [mm] that cover the flank, and the material removed there [mm]; cubic between them
        without overshoot. Noise bends the flank: smooth it over less than a contact's width.
    lead_crowning : float
        Flank line (helix) crowning C_beta: a parabola along the width, zero in the middle, so much at both end faces [mm].
    lead_slope : float
        Removed at z = b if the rest is removed in proportion up from z = 0 [mm]: a helix slope deviation f_Hbeta. Heights z
        are counted as those of a `Pit`.
    twist : float
        Removed at (tip, z = b) and (form point, z = 0), added at the other two corners of the flank, bilinear between them [mm].
    end_relief, end_length, end_exponent : float or (float, float)
        Amount at the end faces [mm], over what length of the width [mm], and with what exponent; two numbers: at z = 0, at z = b.
    topography : (sequence, sequence, sequence of sequences), optional
        Measured flank: rising roll lengths [mm] and heights z [mm] that cover it, and the material removed, a row for each roll
        length [mm]; bicubic between them. `gearfe.read_topography` reads one from a file.
    wear : (sequence, sequence), optional
        Rising roll lengths [mm] and the depths worn off there [mm], 0 outside of them; as `table` in between.
    tip_rounding : float
        Radius of the arc, tangent to flank and tip circle, that replaces the tip's sharp corner in the transverse section [mm].
        Contact on it is that of its own curvature.
    tip_chamfer : float
        Instead: how far below the tip circle a straight cut begins, 45 degrees to the flank [mm].
    tooth_scale : sequence of float
        For each of the z teeth the factor of its modification, profile and lead: teeth whose forms differ. Not of pitch, wear,
        edge and eccentricity. Default 1. Teeth are counted as for `pitch`.
    eccentricity : float
        Distance of the teeth's own centre from the axis it turns about [mm]: a radial runout of about twice as much, a
        cumulative pitch deviation that goes round once, and no step from tooth to tooth.
    eccentric_tooth : float
        Number of the tooth towards which the centre lies; numbers between teeth are allowed.
    pitch : sequence of float
        For each of the z teeth, how far its loaded flank lies behind its place (as if material were removed), along the reference
        circle [mm]: cumulative pitch deviations. Teeth are counted as those of a `Crack`: tooth k is in pair k.

    Raises
    ------
    ValueError
        If the description is contradictory, or, when it meets its gear, if a relief starts outside the flank or more is removed
        than a tenth of the module: the tooth's own flexibility is taken from the unmodified one.

    Examples
    --------
    >>> gear = Gear(z=21, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=7.4)
    >>> form = Flank(tip_relief=0.02, tip_start_diameter=44.0).on(gear)
    >>> [round(float(form.removed(roll)), 4) for roll in (form.kinks[0][0], gear.roll_a)]
    [0.0, 0.02]
    """

    tip_relief: float = 0.0
    tip_start_diameter: float | None = None
    tip_start_roll: float | None = None
    tip_start_angle: float | None = None
    tip_exponent: float = 1.0
    root_relief: float = 0.0
    root_start_diameter: float | None = None
    root_start_roll: float | None = None
    root_start_angle: float | None = None
    root_exponent: float = 1.0
    crowning: float = 0.0
    slope: float = 0.0
    table: Any = None
    lead_crowning: float = 0.0
    lead_slope: float = 0.0
    twist: float = 0.0
    end_relief: Any = 0.0
    end_length: Any = None
    end_exponent: Any = 2.0
    topography: Any = None
    pitch: Any = ()
    wear: Any = None
    tip_rounding: float = 0.0
    tip_chamfer: float = 0.0
    tooth_scale: Any = ()
    eccentricity: float = 0.0
    eccentric_tooth: float = 0.0

    def __post_init__(self) -> None:
        """Refuse contradictory descriptions."""
        for name in self.__slots__:
            value = getattr(self, name)
            if name in LISTS or (value is None and "_start_" in name) or name.startswith("end_"):
                continue
            if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
                raise ValueError(f"{name} = {value!r}, but a flank needs a finite number here")
            object.__setattr__(self, name, float(value))
        for end in ("tip", "root"):
            given = [how for how in STARTS if getattr(self, f"{end}_start_{how}") is not None]
            needed = getattr(self, f"{end}_relief") != 0
            if len(given) != needed and (needed or given):
                names = ", ".join(f"{end}_start_{how}" for how in STARTS)
                raise ValueError(
                    f"{end}_relief = {getattr(self, f'{end}_relief'):g} mm with {len(given)} starts: give one of {names}, "
                    "and none without relief"
                )
            if getattr(self, f"{end}_exponent") < 1:
                raise ValueError(f"{end}_exponent = {getattr(self, f'{end}_exponent'):g}, but a relief needs an exponent >= 1")
        for name in ("pitch", "tooth_scale"):
            object.__setattr__(self, name, tuple(numbers(name, getattr(self, name))))
        for name, checked in (("table", lambda given: table("table", given)), ("wear", worn)):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, checked(getattr(self, name)))
        if self.tip_rounding and self.tip_chamfer:
            raise ValueError(
                f"tip_rounding = {self.tip_rounding:g} mm and tip_chamfer = {self.tip_chamfer:g} mm: a tip has one edge, give one"
            )
        for name, value in zip(("end_relief", "end_length", "end_exponent"), two_ends(self), strict=True):
            object.__setattr__(self, name, value)
        if self.topography is not None:
            object.__setattr__(self, "topography", checked_topography(self.topography))

    @property
    def wide(self) -> bool:
        """Whether anything changes along the width, so that no transverse section is the whole truth."""
        return bool(self.lead_crowning or self.lead_slope or self.twist or any(self.end_relief) or self.topography is not None)

    def start_of(self, end: str) -> tuple[str, float]:
        """How the start of a relief is given, one of `STARTS`, and its value."""
        return next((how, value) for how in STARTS if (value := getattr(self, f"{end}_start_{how}")) is not None)

    def on(self, gear: Gear) -> "FlankForm":
        """The modification of the flanks of `gear`."""
        return FlankForm(self, gear)


class FlankForm:
    """A `Flank` on its gear: material removed by roll length; by height, too, in the form that `at` gives.

    `kinks` are the roll lengths [mm] at which the flank bends suddenly, and by how much the material removed then rises by mm of
    roll length: there, contact has no radius of curvature.
    """

    def __init__(self, flank: Flank, gear: Gear) -> None:
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
            if exponent < 2
        )
        self.edge = TipEdge(gear, flank.tip_rounding, flank.tip_chamfer) if flank.tip_rounding or flank.tip_chamfer else None
        if self.edge is not None:
            self.kinks += ((self.edge.start, self.edge.kink),)
        self._worn = None if flank.wear is None else PchipInterpolator(*flank.wear)
        self._spline = None
        if flank.table is not None:
            self._spline = PchipInterpolator(*covering(flank.table, gear))
        self._shifts = each_tooth("pitch", flank.pitch, gear) * gear.r_b / gear.r
        self._scales = each_tooth("tooth_scale", flank.tooth_scale, gear)
        self._tooth: NDArray[np.int64] | None = None
        self.sense = 1
        self.tilt, self._lead = 0.0, LeadForm(flank, gear, self.low, self.high) if flank.wide else None
        self._z: NDArray[np.float64] | None = None
        self._check_size()

    @property
    def wide(self) -> bool:
        """Whether the flank changes along the width, or lies askew: `tilt`, how much further back it lies by height [mm/mm]."""
        return self._lead is not None or bool(self.tilt)

    @property
    def differs(self) -> bool:
        """Whether the teeth of the gear differ from each other."""
        return bool(self.flank.eccentricity) or any(values.size and np.ptp(values) for values in (self._shifts, self._scales))

    def of(self, tooth: ArrayLike) -> "FlankForm":
        """The same flank of teeth ``(...)``, which go with the leading axes of roll lengths."""
        if not (self._scales.size or self.flank.eccentricity):
            return self
        out = copy(self)
        out._tooth = np.asarray(tooth, dtype=int)
        return out

    def turned(self, sense: int) -> "FlankForm":
        """The same flank of a gear whose tooth k stands k pitches clockwise (1) or counter-clockwise (-1) of tooth 0."""
        out = copy(self)
        out.sense = sense
        return out

    def at(self, z: ArrayLike | None) -> "FlankForm":
        """The same flank at heights `z` [mm], which go with the leading axes of roll lengths; None: what changes is left out."""
        out = copy(self)
        out._z = None if z is None or not self.wide else np.asarray(z, dtype=float)
        return out

    def tilted(self, tilt: float) -> "FlankForm":
        """The same flank, so much further back by height [mm/mm], none in the middle of the width."""
        out = copy(self)
        out.tilt = tilt
        return out

    def _check_size(self) -> None:
        roll = np.linspace(self.low, self.high, 65)
        most = LARGEST * self.gear.m_n
        here = self.at(np.linspace(0, self.gear.b, 17))
        largest = max(1.0, float(np.abs(self._scales).max(initial=0.0)))
        eccentric = np.array([self.flank.eccentricity])
        for what, values in (
            ("removed from the flank", largest * here._shaped(roll[None, :], 0)),
            ("of pitch deviation", self._shifts),
            ("of eccentricity", eccentric),
            ("of wear", np.zeros(1) if self._worn is None else self._wear(roll, 0)),
        ):
            worst = float(np.abs(values).max(initial=0.0))
            if worst > most:
                raise ValueError(
                    f"{worst:.4g} mm {what} of z = {self.gear.z}: more than a tenth of the module, {most:.4g} mm, so that the "
                    "tooth would be another one; amounts are in mm (20 um are 0.02)"
                )

    def removed(self, roll: ArrayLike, derivative: int = 0) -> NDArray[np.float64]:
        """Material removed at roll lengths [mm], or its derivative by the roll length; pitch deviations left out.

        Derivatives are those of the flank without the edge of its tip (for that see `bend`).
        The fillet goes on with what is removed at the form point.
        """
        given, n = np.asarray(roll, dtype=float), derivative
        at = np.maximum(given, self.low) if self.high > self.low else np.minimum(given, self.low)
        out = self._shaped(at, n)
        if self._scales.size:
            own = self._scales[0] if self._tooth is None else _along(self._scales[self._tooth % self.gear.z], at)
            out = out * own
        if self._worn is not None:
            out = out + self._wear(at, n)
        if self.edge is not None and n == 0:
            out = out + self.edge.removed(at)
        if self.flank.eccentricity and self._tooth is not None:
            out = out + self._off_centre(at, n)
        return out

    def slope(self, roll: ArrayLike) -> NDArray[np.float64]:
        """How far the flank leans towards its gear's tip, the tip's edge included: what is removed by arc length [mm/mm].

        At a kink it is the mean of both sides.
        """
        at, step = np.asarray(roll, dtype=float), STEP * self.gear.m_n
        rise = (self.removed(at + step) - self.removed(at - step)) / (2 * step)
        return self.gear.outward * rise * self.gear.r_b / np.maximum(at, 1e-3 * self.gear.r_b)

    def _wear(self, roll: NDArray, derivative: int) -> NDArray[np.float64]:
        return np.nan_to_num(self._worn(roll, derivative, extrapolate=False))  # type: ignore[misc]  # asked for only if there is any

    def _off_centre(self, roll: NDArray, derivative: int) -> NDArray[np.float64]:
        """What an eccentric gear lacks along the flank's normal, which turns with the roll length."""
        gear, flank = self.gear, self.flank
        teeth = self.sense * (_along(self._tooth, roll) - flank.eccentric_tooth)  # type: ignore[arg-type]  # there are some here
        turn = gear.base_half_angle - gear.outward * roll / gear.r_b + 2 * math.pi * teeth / gear.z
        rate = -gear.outward / gear.r_b
        return flank.eccentricity * (np.sin(turn), rate * np.cos(turn), -(rate**2) * np.sin(turn))[derivative]

    def _shaped(self, roll: NDArray, derivative: int) -> NDArray[np.float64]:
        """What is removed by design, alike on all teeth but for their scales."""
        span, n = self.high - self.low, derivative
        out = np.zeros(roll.shape)
        for start, end, amount, exponent in self.reliefs:
            part = np.maximum((roll - start) / (end - start), 0.0)
            factor = amount * math.prod(exponent - i for i in range(n)) / (end - start) ** n
            if factor:
                out += np.where(part > 0, factor * np.where(part > 0, part, 1.0) ** (exponent - n), 0.0)
        if self.flank.crowning:
            place, step = (2 * roll - self.low - self.high) / span, 2 / span
            out += self.flank.crowning * (place**2, 2 * step * place, 2 * step**2)[n]
        if self.flank.slope:
            out += self.flank.slope * ((roll - self.low) / span, 1 / span, 0.0)[n]
        if self._spline is not None:
            out += self._spline(np.clip(roll, self._spline.x[0], self._spline.x[-1]), n)
        if self._lead is not None and self._z is not None:
            out = out + self._lead.removed(roll, _along(self._z, roll), n)
        return out

    def before_edge(self, roll: NDArray[np.float64]) -> NDArray[np.float64]:
        """Roll lengths, those on the edge of the tip moved to its beginning."""
        if self.edge is None:
            return roll
        return np.minimum(roll, self.edge.start) if self.high > self.low else np.maximum(roll, self.edge.start)

    def bounds(self) -> tuple[float, float]:
        """Least and most that any place of any tooth lies behind the involute [mm]."""
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

    def shift(self, tooth: ArrayLike) -> NDArray[np.float64]:
        """How far the flanks of teeth lie behind their places, along the line of action [mm]."""
        tooth = np.asarray(tooth, dtype=int)
        behind = self._shifts[tooth % self.gear.z] if self._shifts.size else np.zeros(tooth.shape)
        if self.tilt and self._z is not None:
            behind = behind + self.tilt * (_along(self._z, tooth) - self.gear.b / 2)
        return behind

    def bend(self, roll: ArrayLike) -> NDArray[np.float64]:
        """Curvature that the modification adds to the flank, by its arc [1/mm] (kinks left out)."""
        at = np.maximum(np.asarray(roll, dtype=float), 1e-3 * self.gear.r_b)  # an arc has no roll length at the base circle
        out = (self.gear.r_b / at) ** 2 * (self.removed(at, 2) - self.removed(at, 1) / at)
        return out if self.edge is None else np.where(self.edge.on(at), self.edge.bend(at), out)


def _along(z: NDArray, places: NDArray) -> NDArray:
    """Heights with the trailing axes that places have more."""
    return z.reshape(z.shape + (1,) * max(places.ndim - z.ndim, 0))
