"""`GearPair`: where two gears touch, and how far apart their flanks are where they do not."""

import math
from dataclasses import dataclass

import numpy as np

from .gear import Gear
from .involute import inv, inverse_inv
from .tooth import cartesian, fillet, flank, form_point


@dataclass(frozen=True, slots=True)
class Contacts:
    """The tooth pairs that touch, or nearly do, at some phases (arrays of shape (phases, pairs)).

    `roll_1`, `roll_2` are the roll lengths [mm] of the touching points, `gap` the unloaded distance along the line of
    action [mm] (inf: the flanks cannot meet), `order` (pairs,) the number of each pair: pair 0 enters at phase 0 and pair k
    is k base pitches ahead of it, `nominal` the abscissa of the pair on the line of action [mm]. Pair k is formed by the
    pinion's k-th tooth beside tooth 0 on the loaded side and the wheel's k-th on the other.
    """

    order: np.ndarray
    nominal: np.ndarray
    roll_1: np.ndarray
    roll_2: np.ndarray
    gap: np.ndarray


@dataclass(frozen=True, slots=True)
class GearPair:
    """Two meshing external gears; gear 1 (the pinion) drives.

    The line of action is measured from its tangent point on the pinion's base circle, so that the abscissa of a contact
    is the pinion's roll length. Phase 0 is a tooth pair entering at the start of the path of contact (lower end of the
    pinion's active flank); phase 1 is one transverse base pitch later.

    Parameters
    ----------
    gear_1, gear_2 : Gear
        Pinion and wheel, of the same basic rack and helix angle.
    a : float, optional
        Centre distance [mm]; default: the one without backlash.

    Raises
    ------
    ValueError
        If the gears do not match, or cannot mesh continuously (contact ratio < 1) at this centre distance.

    Examples
    --------
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = GearPair(Gear(z=21, r_bore=7.4, **rack), Gear(z=31, r_bore=11.4, **rack))
    >>> round(pair.a, 9), round(pair.eps_alpha, 4)
    (52.0, 1.6149)
    """

    gear_1: Gear
    gear_2: Gear
    a: float | None = None

    def __post_init__(self):
        """Refuse gears that cannot mesh."""
        one, two = self.gear_1, self.gear_2
        for name, unit in (("m_n", "mm"), ("alpha_n", "rad")):
            first, second = getattr(one, name), getattr(two, name)
            if not math.isclose(first, second, rel_tol=1e-9):
                raise ValueError(f"{name} = {first} and {second} {unit}: gears in mesh need the same one")
        if not math.isclose(abs(one.beta), abs(two.beta), rel_tol=1e-9, abs_tol=1e-12):
            raise ValueError(f"beta = {one.beta} and {two.beta} rad: gears in mesh need the same helix angle")
        if self.a is None:
            shift = (one.x + two.x) * math.tan(one.alpha_n)
            alpha_w = inverse_inv(inv(one.alpha_t) + 2 * shift / (one.z + two.z))
            object.__setattr__(self, "a", (one.r_b + two.r_b) / math.cos(alpha_w))
        elif not math.isfinite(self.a):
            raise ValueError(f"a = {self.a}, but a centre distance is a finite length [mm]")
        self._check_mesh()

    def _check_mesh(self):
        one, two = self.gear_1, self.gear_2
        if self.a <= one.r_b + two.r_b:
            raise ValueError(f"a = {self.a} mm is too small: the base circles touch at {one.r_b + two.r_b:.6g} mm")
        for tip, root in ((one, two), (two, one)):
            if tip.r_a + root.r_f >= self.a:
                raise ValueError(
                    f"a = {self.a:.6g} mm is too small: the tip circle of z = {tip.z} reaches the root circle of "
                    f"z = {root.z} at a = {tip.r_a + root.r_f:.6g} mm; increase a or lower the addendum"
                )
        if self.backlash < -1e-9 * self.a:
            raise ValueError(
                f"a = {self.a:.6g} mm is too small: the teeth overlap by {-self.backlash:.4g} mm along the line of action; "
                "give a=None for the centre distance without backlash"
            )
        if not self.eps_alpha >= 1:
            raise ValueError(
                f"contact ratio {self.eps_alpha:.4g} < 1 at a = {self.a:.6g} mm: the teeth lose contact; "
                "reduce a, or change addendum and profile shift"
            )
        for tip, root, tip_name in ((two, one, "gear 2"), (one, two, "gear 1")):
            overlap = _tip_overlap(tip, root, self.a)
            if overlap > 1e-3 * root.m_n:
                raise ValueError(
                    f"interference: the tip of {tip_name} (z = {tip.z}) cuts {overlap:.4g} mm into the fillet of z = {root.z}; "
                    "increase a, or reduce the addendum"
                )

    @property
    def alpha_w(self):
        """Working transverse pressure angle [rad]."""
        return math.acos((self.gear_1.r_b + self.gear_2.r_b) / self.a)

    @property
    def length(self):
        """Distance between the tangent points of the line of action on the two base circles [mm]."""
        return self.a * math.sin(self.alpha_w)

    @property
    def backlash(self):
        """Normal backlash: play along the line of action [mm] (negative: the teeth overlap)."""
        one, two = self.gear_1, self.gear_2
        free = 2 * math.pi / one.z - 2 * (one.base_half_angle - inv(self.alpha_w))
        used = 2 * (two.base_half_angle - inv(self.alpha_w))
        return one.r_b * free - two.r_b * used

    @property
    def p_bt(self):
        """Transverse base pitch [mm]."""
        return self.gear_1.p_bt

    @property
    def path(self):
        """Start and end of the path of contact as roll lengths of the pinion [mm]."""
        one, two = self.gear_1, self.gear_2
        start = max(self.length - two.roll_a, one.roll_f)
        end = min(one.roll_a, self.length - two.roll_f)
        return start, end

    @property
    def eps_alpha(self):
        """Transverse contact ratio, of the flanks that exist (tip circles, undercut)."""
        start, end = self.path
        return (end - start) / self.p_bt

    @property
    def pitch_phase(self):
        """Phase at which the contact is at the pitch point."""
        return (self.gear_1.r_b * math.tan(self.alpha_w) - self.path[0]) / self.p_bt

    @property
    def pitch_radius_1(self):
        """Working pitch radius of the pinion [mm]: where its flank touches at the pitch point."""
        return self.gear_1.r_b / math.cos(self.alpha_w)

    @property
    def pitch_radius_2(self):
        """Working pitch radius of the wheel [mm]."""
        return self.gear_2.r_b / math.cos(self.alpha_w)

    def curvature_radii(self, phase):
        """Radii of curvature [mm] of both flanks where the pair of `phase` touches."""
        roll = self.path[0] + np.asarray(phase) * self.p_bt
        return roll, self.length - roll

    def turn(self, nominal):
        """Clockwise angles [rad] of tooth 0 of both gears (centres at 0 and +y a) for a contact at `nominal` [mm]."""
        point = self._point(nominal)
        turns = []
        for gear, centre, roll in ((self.gear_1, 0.0, nominal), (self.gear_2, self.a, self.length - nominal)):
            seen = np.arctan2(point[0], point[1] - centre)
            turns.append(seen - flank(gear, roll)[1])
        return tuple(turns)

    def _point(self, nominal):
        along = np.asarray(nominal) - self.gear_1.r_b * math.tan(self.alpha_w)
        return np.array([along * math.cos(self.alpha_w), self.pitch_radius_1 + along * math.sin(self.alpha_w)])

    def contacts(self, phase, *, extended=True):
        """Contacts of all tooth pairs at `phase` (array), see `Contacts`.

        On the path of contact the gap is zero. Beyond it one tip corner slides on the other flank, and the gap is exact
        kinematics: the rotation that closes it, times the base radius. With ``extended=False`` such pairs never touch.
        Phases may be any numbers: at phase 1.3 pair 0 is 1.3 base pitches into its engagement.
        """
        phase = np.atleast_1d(np.asarray(phase, dtype=float))
        start, end = self.path
        first, last = -1 - math.floor(phase.max()), math.ceil((end - start) / self.p_bt) - math.floor(phase.min())
        order = np.arange(first, last + 1)
        nominal = start + (phase[:, None] + order) * self.p_bt
        slack = 1e-9 * self.p_bt
        inside = (nominal >= start - slack) & (nominal < end + slack)
        roll_1, roll_2 = nominal.copy(), self.length - nominal
        gap = np.where(inside, 0.0, np.inf)
        if extended:
            self._corner(nominal, nominal > end + slack, roll_1, roll_2, gap, driver=True)
            self._corner(nominal, nominal < start - slack, roll_2, roll_1, gap, driver=False)
        return Contacts(order, nominal, roll_1, roll_2, gap)

    def _corner(self, nominal, where, roll_tip, roll_flank, gap, *, driver):
        """Fill in the pairs `where` a tip corner touches: the pinion's after the end, the wheel's before the start."""
        tip, other = (self.gear_1, self.gear_2) if driver else (self.gear_2, self.gear_1)
        distance, roll = self.opposite(np.full(nominal.shape, tip.roll_a), nominal, driver=driver)
        meets = where & (roll <= other.roll_a) & (roll >= other.roll_f)
        roll_tip[meets] = tip.roll_a
        roll_flank[meets] = roll[meets]
        gap[meets] = np.maximum(distance[meets], 0.0)

    def opposite(self, roll, nominal, *, driver=True):
        """What a flank point faces when its pair is at `nominal` on the line of action.

        Parameters
        ----------
        roll : ndarray
            Roll length of a point on the pinion's flank (``driver=True``) or the wheel's [mm].
        nominal : ndarray
            Abscissa of the pair's contact on the line of action [mm]; off the path of contact, where it would be.

        Returns
        -------
        gap, roll : ndarray
            Distance to the other flank along the line of action, i.e. the rotation that closes it times the base radius
            [mm], and the roll length of the point met there [mm]; nan where the point lies inside the base circle.
        """
        tip, other = (self.gear_1, self.gear_2) if driver else (self.gear_2, self.gear_1)
        shift = -self.a if driver else self.a
        own, turned = self.turn(nominal) if driver else self.turn(nominal)[::-1]
        radius, angle = flank(tip, roll)
        x, y = cartesian(radius, own + angle)
        away, seen = np.hypot(x, y + shift), np.arctan2(x, y + shift)
        met = np.sqrt(np.where(away >= other.r_b, away**2 - other.r_b**2, np.nan))
        behind = seen - turned - flank(other, met)[1]
        return other.r_b * ((behind + math.pi) % (2 * math.pi) - math.pi), met


def _tip_overlap(tip, root, a):
    """How deep [mm] the tip corner of one gear cuts into the fillet of the other, at worst.

    The tip corner's path in the root gear's frame is compared with the fillet at equal radii.
    """
    pair_turn = tip.r_b / root.r_b
    alpha_w = math.acos((tip.r_b + root.r_b) / a)
    turn = np.linspace(-0.9, 0.9, 721) * 2 * math.pi / tip.z
    # both gears meshing at the pitch point at turn = 0; flanks in touch there
    tip_angle = flank(tip, tip.roll_a)[1] - flank(tip, tip.r_b * math.tan(alpha_w))[1]
    x, y = cartesian(tip.r_a, tip_angle + turn)
    seen = np.arctan2(x, a - y)
    radius = np.hypot(x, a - y)
    # the contact flanks face each other: mirror the root gear's frame, which turns the other way
    place = -seen + pair_turn * turn
    phi = np.linspace(form_point(root)[0], math.pi / 2, 300)
    depth_r, depth_angle = fillet(root, phi)
    keep = (radius > depth_r.min()) & (radius < depth_r.max())
    if not keep.any():
        return 0.0
    order = np.argsort(depth_r)
    solid = np.interp(radius[keep], depth_r[order], depth_angle[order])
    free = place[keep] + flank(root, root.r_b * math.tan(alpha_w))[1]
    return float(np.max((solid - free) * radius[keep], initial=0.0))
