"""`GearPair`: contact geometry of two gears, and gaps between their flanks."""

import math
import warnings
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from ..aliases import Floats
from ..checks import is_finite, shown
from ..renamed import renamed
from ..tooth.gear import Gear, shortened
from ..tooth.involute import inv, inverse_inv
from ..tooth.profile import flank
from .interference import overlap, radial_assembly

OVERLAP = 1e-3  # Deeper overlaps of the two outlines count as interference [m_n].


@renamed(alpha_w="alpha_wt")
@dataclass(frozen=True, slots=True)
class GearPair:
    """Two meshing gears. Gear 1 (the pinion, external) drives gear 2, an external gear or a ring.

    The line of action is measured from its tangent point on the pinion's base circle, so that the abscissa of a contact
    is the pinion's roll length. Phase 0 is a tooth pair entering at the start of the path of contact (lower end of the
    pinion's active flank); phase 1 is one transverse base pitch later.

    A ring whose tip would reach below the pinion's form point is trimmed to it, with a warning; `notes` states the change of the
    contact ratio.

    Parameters
    ----------
    gear_1, gear_2 : Gear
        Pinion and wheel or ring, of the same basic rack and helix angle.
    a : float, optional
        Centre distance [mm]; default: the one without backlash of teeth without allowance.

    Raises
    ------
    ValueError
        If the gears do not match, interfere, or cannot mesh continuously at this centre distance: transverse contact ratio and
        overlap ratio together below 1.

    Examples
    --------
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = GearPair(Gear(z=21, r_bore=7.4, **rack), Gear(z=31, r_bore=11.4, **rack))
    >>> round(pair.a, 9), round(pair.eps_alpha, 4)
    (52.0, 1.6149)
    """

    gear_1: Gear
    gear_2: Gear
    a: float = None  # type: ignore[assignment]  # None stands for the distance without backlash until __post_init__
    notes: tuple[str, ...] = field(default=(), init=False)

    def __post_init__(self) -> None:
        """Raise ValueError for gears that cannot mesh. Trim the tip of a ring where it interferes."""
        pinion, wheel = self.gears
        if not isinstance(pinion, Gear) or not isinstance(wheel, Gear):
            name, value = ("gear_1", pinion) if not isinstance(pinion, Gear) else ("gear_2", wheel)
            raise ValueError(f"{name} = {value!r}, but give a Gear: Gear(z, m_n, alpha_n, b, r_bore)")
        if pinion.internal:
            raise ValueError("gear_1 is a ring; give the external gear first and the ring as gear_2")
        self._check_rack()
        if wheel.internal and wheel.z <= pinion.z:
            raise ValueError(f"z = {pinion.z} does not fit into a ring of z = {wheel.z}: the ring needs more teeth")
        if self.a is None:
            object.__setattr__(self, "a", free_centre_distance(pinion, wheel))
        elif not is_finite(self.a):
            raise ValueError(f"a = {shown(self.a)}, but a centre distance is a finite length [mm]")
        object.__setattr__(self, "a", float(self.a))
        self._check_distance()
        if wheel.internal:
            self._trim_ring()
        self._check_mesh()

    def _check_rack(self):
        """Raise ValueError unless both gears have the same rack and helix angle."""
        for name, what in (("m_n", "module"), ("alpha_n", "pressure angle"), ("beta", "helix angle")):
            both = [abs(getattr(gear, name)) if name == "beta" else getattr(gear, name) for gear in self.gears]
            if not math.isclose(*both, rel_tol=1e-9, abs_tol=1e-12 if name == "beta" else 0.0):
                first, second = (value if name == "m_n" else math.degrees(value) for value in both)
                unit = "mm" if name == "m_n" else "degrees"
                raise ValueError(
                    f"{what} {name} of gear_1 is {first:.9g} {unit} and that of gear_2 {second:.9g} {unit}, but gears in "
                    "mesh need the same"
                )

    @property
    def gears(self) -> tuple[Gear, Gear]:
        """Pinion, and wheel or ring."""
        return self.gear_1, self.gear_2

    @property
    def b_w(self) -> float:
        """Common face width [mm]: that of the narrower gear."""
        return min(gear.b for gear in self.gears)

    def __repr__(self):
        """Return gears and centre distance as Python code."""
        return f"GearPair({self.gear_1!r}, {self.gear_2!r}, a={self.a!r})"

    def _check_distance(self):
        pinion, wheel = self.gears
        least = self.outward * pinion.r_b + wheel.r_b
        wrong = "large" if wheel.internal else "small"
        if self.a <= least:
            raise ValueError(f"a = {self.a} mm is too small: the line of action needs more than {least:.6g} mm")
        for tip, root in ((pinion, wheel), (wheel, pinion)):
            clearance = self._clearance(tip, root)
            if clearance <= 0:
                raise ValueError(
                    f"a = {self.a:.6g} mm is too {wrong}: the tip circle of z = {tip.z} reaches the root circle of z = {root.z} "
                    f"({-clearance:.4g} mm deep); change a or lower the addendum"
                )
        if self.backlash < -1e-4 * pinion.m_n:
            raise ValueError(
                f"a = {self.a:.6g} mm is too {wrong}: the teeth overlap by {-self.backlash:.4g} mm along the line "
                "of action; give a=None for the centre distance without backlash"
            )

    def _clearance(self, tip, root):
        """Radial distance [mm] between a tip circle and the mate's root circle."""
        if not self.gear_2.internal:
            return self.a - tip.r_a - root.r_f
        return root.r_f - self.a - tip.r_a if root.internal else tip.r_a - self.a - root.r_f

    def _trim_ring(self):
        pinion, wheel = self.gears
        lowest = pinion.roll_f + self.length
        if wheel.roll_a >= lowest:
            return
        before = self.eps_alpha_of(pinion.roll_a, wheel.roll_a)
        cut = math.hypot(wheel.r_b, lowest) - wheel.r_a
        object.__setattr__(self, "gear_2", replace(wheel, addendum=wheel.addendum - cut / wheel.m_n))
        note = (
            f"the ring's tip (z = {wheel.z}) was trimmed by {cut:.4g} mm, its addendum from {wheel.addendum:g} to "
            f"{self.gear_2.addendum:.4g} m_n: it would reach into the fillet of z = {pinion.z}; contact ratio {before:.4g} -> "
            f"{self.eps_alpha:.4g}"
        )
        object.__setattr__(self, "notes", (*self.notes, note))
        warnings.warn(note, stacklevel=4)

    def _check_mesh(self):
        if not (self.eps_alpha > 0 and self.eps_alpha + self.eps_beta >= 1):
            ratio = f"contact ratio {self.eps_alpha:.4g}"
            ratio += f" + overlap {self.eps_beta:.4g}" if self.gear_1.beta else ""
            raise ValueError(f"{ratio} < 1 at a = {self.a:.6g} mm: the teeth lose contact; change a, addendum or profile shift")
        start, _ = self.path
        depth = overlap(self, [start + k * self.p_bt / 8 for k in range(8)])
        if depth > OVERLAP * self.gear_1.m_n:
            raise ValueError(
                f"interference: the outlines of z = {self.gear_1.z} and {self.gear_2.z} cut {depth:.4g} mm into each other "
                "outside the path of contact; reduce an addendum, change a, or (rings) the difference of the tooth numbers"
            )

    @property
    def outward(self) -> int:
        """+1 for two external gears, -1 for a pair with a ring."""
        return self.gear_2.outward

    @property
    def centre_2(self) -> float:
        """Height of the centre of gear 2 above that of gear 1 [mm]. The pitch point is above gear 1."""
        return self.outward * self.a

    @property
    def radial_assembly(self) -> bool:
        """Whether the pinion can be inserted into its ring radially. It is always true without a ring."""
        return not self.gear_2.internal or radial_assembly(self)

    @property
    def alpha_wt(self) -> float:
        """Working transverse pressure angle [rad]."""
        return math.acos((self.gear_1.r_b * self.outward + self.gear_2.r_b) / self.a)

    @property
    def length(self) -> float:
        """Distance between the tangent points of the line of action on the two base circles [mm]."""
        return self.a * math.sin(self.alpha_wt)

    def mate_roll(self, roll_1: ArrayLike) -> Floats:
        """Roll length on gear 2 [mm] where the pinion touches at `roll_1`, on the line of action."""
        return self.length - self.outward * np.asarray(roll_1)

    def relative_radius(self, roll_1: Floats, roll_2: Floats) -> Floats:
        """Relative radius of curvature [mm]."""
        return roll_1 * roll_2 / (roll_2 + self.outward * roll_1)

    @property
    def pitch_relative_radius(self) -> float:
        """Relative radius of curvature at the pitch point [mm], also used where a contact has no valid local radius."""
        return abs(float(self.relative_radius(*self.curvature_radii(self.pitch_phase))))

    @property
    def backlash(self) -> float:
        """Normal backlash: distance of the back flanks along the line of action [mm]. It is negative if teeth overlap."""
        pinion, wheel = self.gears
        tooth_1 = 2 * (pinion.base_half_angle - inv(self.alpha_wt))
        tooth_2 = 2 * (wheel.base_half_angle - wheel.outward * inv(self.alpha_wt))
        return pinion.r_b * (2 * math.pi / pinion.z - tooth_1) - wheel.r_b * tooth_2

    @property
    def p_bt(self) -> float:
        """Transverse base pitch [mm]."""
        return self.gear_1.p_bt

    @property
    def path(self) -> tuple[float, float]:
        """Start and end of the path of contact as roll lengths of the pinion [mm]."""
        start, end = self._overlap(self.gear_1.roll_a, self.gear_2.roll_a)
        return max(start, self.gear_1.roll_f), end

    def _overlap(self, tip_1, tip_2):
        """Return the ends of contact of flanks that end at these roll lengths [mm], neglecting the pinion fillet."""
        first, last = sorted((self.outward * (self.length - tip_2), self.outward * (self.length - self.gear_2.roll_f)))
        return first, min(last, tip_1)

    def eps_alpha_of(self, tip_1: float, tip_2: float) -> float:
        """Contact ratio for flanks that end at these roll lengths [mm], neglecting the pinion fillet."""
        start, end = self._overlap(tip_1, tip_2)
        return (end - start) / self.p_bt

    @property
    def eps_alpha(self) -> float:
        """Transverse contact ratio of the existing flanks (tip circles, undercut)."""
        start, end = self.path
        return (end - start) / self.p_bt

    @property
    def eps_beta(self) -> float:
        """Overlap ratio of the width both gears have in common, ``b tan(beta_b) / p_bt``, or 0 for spur gears."""
        return self.eps_beta_of(self.b_w)

    def eps_beta_of(self, width: float) -> float:
        """Overlap ratio of a part of the face with `width` [mm], for example one half of a herringbone pair."""
        return width * math.tan(abs(self.gear_1.beta_b)) / self.p_bt

    @property
    def pitch_phase(self) -> float:
        """Phase of contact at the pitch point."""
        return (self.gear_1.r_b * math.tan(self.alpha_wt) - self.path[0]) / self.p_bt

    @property
    def pitch_radius_1(self) -> float:
        """Working pitch radius of the pinion [mm]."""
        return self.gear_1.r_b / math.cos(self.alpha_wt)

    @property
    def pitch_radius_2(self) -> float:
        """Working pitch radius of the wheel [mm]."""
        return self.gear_2.r_b / math.cos(self.alpha_wt)

    def curvature_radii(self, phase: ArrayLike) -> tuple[Floats, Floats]:
        """Radii of curvature [mm] of both flanks at the contact of the pair with `phase`."""
        roll = self.path[0] + np.asarray(phase) * self.p_bt
        return roll, self.mate_roll(roll)

    def turn(self, nominal: ArrayLike) -> tuple[Floats, Floats]:
        """Clockwise angles [rad] of tooth 0 of both gears for a contact at `nominal` [mm] on the line of action.

        Gear 1's centre is the origin, gear 2's at ``(0, centre_2)``. A ring's loaded flank faces the other way: its own
        frame (`gearfe.geometry.tooth.profile`) is mirrored in place.
        """
        along = np.asarray(nominal) - self.gear_1.r_b * math.tan(self.alpha_wt)
        x, y = along * math.cos(self.alpha_wt), self.pitch_radius_1 + along * math.sin(self.alpha_wt)
        turn_1 = np.arctan2(x, y) - flank(self.gear_1, nominal)[1]
        turn_2 = np.arctan2(x, y - self.centre_2) - self.outward * flank(self.gear_2, self.mate_roll(nominal))[1]
        return turn_1, turn_2


def with_tips(pair: GearPair, rolls: Sequence[float | None]) -> GearPair:
    """Return the pair with flanks that end at these roll lengths of pinion and wheel [mm] (None: unchanged).

    Its path may be shorter than a base pitch, because other teeth are whole.
    """
    out = copy(pair)
    for name, roll in zip(("gear_1", "gear_2"), rolls, strict=True):
        if roll is not None:
            object.__setattr__(out, name, shortened(getattr(pair, name), roll))
    return out


def free_centre_distance(one: Gear, two: Gear) -> float:
    """Centre distance without backlash [mm] (ISO 21771:2007, 7.3)."""
    teeth = one.z + two.outward * two.z
    shift = one.x + two.outward * two.x
    alpha_wt = inverse_inv(inv(one.alpha_t) + 2 * shift * math.tan(one.alpha_n) / teeth)
    return abs(one.r_b + two.outward * two.r_b) / math.cos(alpha_wt)
