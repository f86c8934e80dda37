"""`Flank`: modifications and deviations of the loaded flanks of a gear, and position errors of its teeth."""

from dataclasses import dataclass
from typing import Any

from ..checks import is_finite
from ..renamed import renamed
from .flank_form import FlankForm
from .gear import Gear
from .lead import checked_topography, two_ends
from .relief import STARTS
from .tables import numbers, table, worn

LISTS = ("table", "topography", "pitch", "wear", "tooth_scale")


@renamed(crowning="profile_crowning", slope="profile_slope", lead_crowning="helix_crowning", lead_slope="helix_slope")
@dataclass(frozen=True, slots=True)
class Flank:
    """Modifications and deviations of a gear's loaded flanks, from tip to root and from tooth to tooth.

    The unloaded flanks stay involutes unless `both_sides` is true, for a tool that relieves both.

    Amounts are in mm, normal to the involute in the transverse section (along the line of action), as ISO 1328-1 and ISO 21771
    measure them; **positive: material is removed**. L is the roll length, `roll_f` at the form point and `roll_a` at the tip. t
    is the relative distance from the start of a relief to the end of the flank. The removed material is::

        tip_relief t**tip_exponent  (t > 0)  +  root_relief t**root_exponent  (t > 0)
        + profile_crowning p**2  +  profile_slope (1 + p) / 2  +  table(L)            p = 2 (L - middle) / (roll_a - roll_f)
        + helix_crowning q**2  +  helix_slope (1 + q) / 2  +  twist p q   q = 2 z / b - 1, at height z of the width b
        + end_relief (part of the way to its end face)**end_exponent  +  topography(L, z)

    multiplied by `tooth_scale` of the tooth, plus

        + wear(L)  +  the edge of the tip  +  the eccentricity of the gear at this tooth

    Parameters
    ----------
    tip_relief, root_relief : float
        Amount at the tip (C_alpha a of ISO 21771) and at the form point (C_alpha f) [mm].
    tip_start_diameter, tip_start_roll, tip_start_angle : float, optional
        One of them: start of the tip relief, as a diameter [mm], a roll length [mm] or a roll angle [rad].
    tip_exponent : float
        1: linear, with a kink at its start; 2: parabolic; any number from 1 on.
    root_start_diameter, root_start_roll, root_start_angle, root_exponent
        The same for the root relief, which grows from its start down to the form point.
    profile_crowning : float
        Profile crowning C_alpha: a parabola, zero in the middle of the flank's roll lengths, with this amount at tip and form
        point [mm].
    profile_slope : float
        Amount at the tip of material removed in proportion up from the form point [mm]: a profile slope deviation f_Halpha of ISO
        1328-1 with the opposite sign (there, material at the tip counts positive).
    table : (sequence, sequence), optional
        Measured deviation: rising roll lengths [mm] that cover the flank, and the material removed there [mm]; cubic between them
        without overshoot. Noise bends the flank: smooth it over less than a contact's width.
    helix_crowning : float
        Helix crowning C_beta: a parabola along the width, zero in the middle, with this amount at both end faces [mm].
    helix_slope : float
        Amount at z = b of material removed in proportion up from z = 0 [mm]: a helix slope deviation f_Hbeta. Heights z are
        counted like those of a `Pit`.
    twist : float
        Amount removed at (tip, z = b) and (form point, z = 0), added at the other two corners of the flank, bilinear [mm].
    end_relief, end_length, end_exponent : float or (float, float)
        Amount at the end faces [mm], its length along the width [mm], and its exponent; two numbers: at z = 0, at z = b.
    topography : (sequence, sequence, sequence of sequences), optional
        Measured flank: rising roll lengths [mm] and heights z [mm] that cover it, and the material removed, a row for each roll
        length [mm]; bicubic between them.
    wear : (sequence, sequence), optional
        Rising roll lengths [mm] and the worn depths there [mm], 0 outside of them; interpolated like `table`.
    tip_rounding : float
        Radius of the arc, tangent to flank and tip circle, that replaces the tip's sharp corner in the transverse section [mm].
        Contact on it has the curvature of the arc.
    tip_chamfer : float
        Alternative: distance below the tip circle at which a straight cut begins, 45 degrees to the flank [mm].
    tooth_scale : sequence of float
        Factor of the modification (profile and helix) of each of the z teeth, for teeth with different forms. It does not apply
        to pitch, wear, edge and eccentricity. Default 1. Teeth are counted as for `pitch`.
    eccentricity : float
        Distance of the teeth's centre from the axis of rotation [mm]. It causes a radial runout of about twice as much, a
        sinusoidal cumulative pitch deviation, and no step from tooth to tooth.
    eccentric_tooth : float
        Number of the tooth towards which the centre lies; numbers between teeth are allowed.
    pitch : sequence of float
        Cumulative pitch deviation of each of the z teeth: distance of its loaded flank behind its nominal position (as if
        material were removed), along the reference circle [mm]. Teeth are counted like those of a `Crack`: tooth k is in pair k.

    both_sides : bool
        If True, the same profile is removed from the unloaded flanks. Teeth are then thinner and bend more; gaps do not change.

    Raises
    ------
    ValueError
        If the description is contradictory. Also, with its gear, if a relief starts outside the flank or more than a tenth of the
        module is removed.

    Examples
    --------
    >>> import math
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
    profile_crowning: float = 0.0
    profile_slope: float = 0.0
    table: Any = None
    helix_crowning: float = 0.0
    helix_slope: float = 0.0
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
    both_sides: bool = False

    def __post_init__(self) -> None:
        """Raise ValueError for contradictory arguments."""
        for name in self.__slots__:
            value = getattr(self, name)
            if name in (*LISTS, "both_sides") or (value is None and "_start_" in name) or name.startswith("end_"):
                continue
            if not is_finite(value):
                raise ValueError(f"{name} = {value!r}, but this value of a flank must be a finite number")
            object.__setattr__(self, name, float(value))
        if not isinstance(self.both_sides, bool):
            raise ValueError(f"both_sides = {self.both_sides!r}, but give True or False")
        self._check_relief("tip")
        self._check_relief("root")
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

    def _check_relief(self, end):
        starts = [f"{end}_start_{how}" for how in STARTS]
        given, size = sum(getattr(self, name) is not None for name in starts), getattr(self, f"{end}_relief")
        if given != (size != 0):
            one = "give one of" if size else "without it leave out"
            there = f"{given} of its starts" if given else "no start"
            raise ValueError(f"{end}_relief = {size:g} mm with {there}: {one} {', '.join(starts)}")
        if (exponent := getattr(self, f"{end}_exponent")) < 1:
            raise ValueError(f"{end}_exponent = {exponent:g}, but a relief needs an exponent >= 1")

    @property
    def wide(self) -> bool:
        """Whether the flank changes along the width, so that a transverse section is insufficient."""
        return bool(self.helix_crowning or self.helix_slope or self.twist or any(self.end_relief) or self.topography is not None)

    def start_of(self, end: str) -> tuple[str, float]:
        """Return the type of the start of a relief, one of `STARTS`, and its value."""
        return next((how, value) for how in STARTS if (value := getattr(self, f"{end}_start_{how}")) is not None)

    def on(self, gear: Gear) -> FlankForm:
        """Apply these modifications to `gear` and return the `FlankForm`."""
        return FlankForm(self, gear)
