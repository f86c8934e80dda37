"""`Flank`: what the loaded flanks of a gear have less (or more) than the involute, and how far each tooth is from its place."""

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

LARGEST = 0.1  # m_n: the tooth's flexibility is that of the unmodified tooth
STARTS = ("diameter", "roll", "angle")  # how the start of a relief can be given


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

    def __post_init__(self) -> None:
        """Refuse contradictory descriptions."""
        for name in self.__slots__:
            value = getattr(self, name)
            if name in ("table", "topography", "pitch") or (value is None and "_start_" in name) or name.startswith("end_"):
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
        object.__setattr__(self, "pitch", tuple(_numbers("pitch", self.pitch)))
        if self.table is not None:
            object.__setattr__(self, "table", _table(self.table))
        for name, value in zip(("end_relief", "end_length", "end_exponent"), two_ends(self), strict=True):
            object.__setattr__(self, name, value)
        if self.topography is not None:
            object.__setattr__(self, "topography", checked_topography(self.topography))

    @property
    def wide(self) -> bool:
        """Whether anything changes along the width, so that no transverse section is the whole truth."""
        return bool(self.lead_crowning or self.lead_slope or self.twist or any(self.end_relief) or self.topography is not None)

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
        reliefs = [(self._start(end), last, end) for end, last in ends if getattr(flank, f"{end}_relief")]
        self.reliefs = [(s, e, getattr(flank, f"{end}_relief"), getattr(flank, f"{end}_exponent")) for s, e, end in reliefs]
        self.kinks = tuple(
            (start, amount / abs(end - start) if exponent == 1 else 0.0)
            for start, end, amount, exponent in self.reliefs
            if exponent < 2
        )
        self._spline = None
        if flank.table is not None:
            rolls, amounts = np.array(flank.table)
            least, most = sorted((self.low, self.high))
            if rolls[0] > least + 1e-6 * gear.m_n or rolls[-1] < most - 1e-6 * gear.m_n:
                raise ValueError(
                    f"table from {rolls[0]:.5g} to {rolls[-1]:.5g} mm of roll length does not cover the flank of z = {gear.z}: "
                    f"{least:.5g} to {most:.5g} mm"
                )
            self._spline = PchipInterpolator(rolls, amounts)
        if len(flank.pitch) not in (0, gear.z):
            raise ValueError(f"pitch has {len(flank.pitch)} values, but z = {gear.z}: give one for each tooth")
        self._shifts = np.array(flank.pitch) * gear.r_b / gear.r
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
        return bool(np.ptp(self._shifts)) if self._shifts.size else False

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

    def _start(self, end: str) -> float:
        """Roll length [mm] at which a relief starts."""
        gear = self.gear
        how, value = next((how, v) for how in STARTS if (v := getattr(self.flank, f"{end}_start_{how}")) is not None)
        square = (value / 2) ** 2 - gear.r_b**2
        roll = {"diameter": math.sqrt(square) if square > 0 else math.nan, "roll": value, "angle": value * gear.r_b}[how]
        least, most = sorted((self.low, self.high))
        if not (least <= roll <= most and abs(roll - (self.high if end == "tip" else self.low)) > 1e-6 * gear.m_n):
            limits = {"roll": (least, most, "mm"), "angle": (least / gear.r_b, most / gear.r_b, "rad")}
            radii = math.hypot(least, gear.r_b), math.hypot(most, gear.r_b)
            low, high, unit = (limits | {"diameter": (2 * radii[0], 2 * radii[1], "mm")})[how]
            raise ValueError(
                f"{end}_start_{how} = {value:g} {unit} is not inside the flank of z = {gear.z}, {low:.5g} to {high:.5g} {unit}"
            )
        return roll

    def _check_size(self) -> None:
        roll = np.linspace(self.low, self.high, 65)
        most = LARGEST * self.gear.m_n
        here = self.at(np.linspace(0, self.gear.b, 17))
        for what, values in (("removed from the flank", here.removed(roll[None, :])), ("of pitch deviation", self._shifts)):
            worst = float(np.abs(values).max(initial=0.0))
            if worst > most:
                raise ValueError(
                    f"{worst:.4g} mm {what} of z = {self.gear.z}: more than a tenth of the module, {most:.4g} mm, so that the "
                    "tooth would be another one; amounts are in mm (20 um are 0.02)"
                )

    def removed(self, roll: ArrayLike, derivative: int = 0) -> NDArray[np.float64]:
        """Material removed at roll lengths [mm], or its derivative by the roll length; pitch deviations left out."""
        roll = np.asarray(roll, dtype=float)
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

    def bounds(self) -> tuple[float, float]:
        """Least and most that any place of any tooth lies behind the involute [mm]."""
        heights = np.linspace(0, self.gear.b, 33)
        form = self.at(heights)
        values = form.removed(np.linspace(self.low, self.high, 65)[None, :]) + form.shift(np.zeros((heights.size, 1), dtype=int))
        values = values - self._shifts[:1].sum()
        shifts = self._shifts if self._shifts.size else np.zeros(1)
        return float(values.min() + shifts.min()), float(values.max() + shifts.max())

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
        return (self.gear.r_b / at) ** 2 * (self.removed(at, 2) - self.removed(at, 1) / at)


def _along(z: NDArray, places: NDArray) -> NDArray:
    """Heights with the trailing axes that places have more."""
    return z.reshape(z.shape + (1,) * max(places.ndim - z.ndim, 0))


def _numbers(name: str, values: Any) -> list[float]:
    try:
        out = np.asarray(values, dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} = {values!r}, but give a sequence of numbers [mm]") from error
    if out.ndim != 1 or not np.isfinite(out).all():
        raise ValueError(f"{name} needs one row of finite numbers [mm], without holes")
    return out.tolist()


def _table(table: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    try:
        rolls, amounts = table
    except (TypeError, ValueError) as error:
        raise ValueError("table needs two rows: roll lengths and the material removed there [mm]") from error
    rolls, amounts = _numbers("table: roll lengths", rolls), _numbers("table: amounts", amounts)
    if len(rolls) != len(amounts) or len(rolls) < 2 or not (np.diff(rolls) > 0).all():
        raise ValueError(f"table has {len(rolls)} roll lengths and {len(amounts)} amounts: give as many, the roll lengths rising")
    return tuple(rolls), tuple(amounts)
