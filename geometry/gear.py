"""`Gear`: the numbers that define one gear, and the radii and angles that follow from them."""

import math
import warnings
from dataclasses import dataclass, fields
from numbers import Real

from .involute import inv


@dataclass(frozen=True, slots=True)
class Gear:
    """An external involute gear cut by a basic rack (symbols of ISO 21771; rack of ISO 53).

    Helical gears are described in the normal section and used in the transverse one.

    Parameters
    ----------
    z : int
        Number of teeth, at least 5.
    m_n : float
        Normal module [mm].
    alpha_n : float
        Normal pressure angle [rad].
    beta : float
        Helix angle at the reference circle [rad]; only its size matters in a transverse section.
    x : float
        Profile shift coefficient [m_n].
    b : float
        Face width [mm].
    r_bore : float
        Radius of the bore [mm], the held inner edge of the body.
    addendum, dedendum, tip_radius : float
        Of the rack [m_n]: addendum, dedendum, radius of its rounded tip. A tip radius larger than the full
        rounding of the rack tip cannot be cut: it is capped there, with a warning.

    Raises
    ------
    ValueError
        If no such gear exists; the message says which number to change.

    Examples
    --------
    >>> sun = Gear(z=21, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=7.4)
    >>> round(sun.r_b, 4), sun.r_f
    (19.7335, 18.5)
    """

    z: int
    m_n: float
    alpha_n: float
    b: float
    r_bore: float
    beta: float = 0.0
    x: float = 0.0
    addendum: float = 1.0
    dedendum: float = 1.25
    tip_radius: float = 0.38

    def __post_init__(self):
        """Refuse what cannot be cut, and cap the rack tip radius."""
        self._check_numbers()
        cap = self.full_tip_radius
        if cap <= 0:
            raise ValueError(
                f"dedendum = {self.dedendum} m_n at alpha_n = {math.degrees(self.alpha_n):.4g} degrees: the rack tooth "
                f"is pointed before its tip; give dedendum < {math.pi / 4 / math.tan(self.alpha_n):.4g}"
            )
        if self.tip_radius > cap:
            warnings.warn(
                f"tip_radius = {self.tip_radius} m_n does not fit on the rack tip at alpha_n = "
                f"{math.degrees(self.alpha_n):.4g} degrees; capped at the full tip radius {cap:.6g} m_n",
                stacklevel=3,
            )
            object.__setattr__(self, "tip_radius", cap)
        if not 0 < self.r_bore < self.r_f:
            raise ValueError(
                f"r_bore = {self.r_bore} mm, but the bore must lie inside the root circle: give 0 < r_bore < {self.r_f:.6g} mm"
            )
        if self.r_a <= self.r_b:
            raise ValueError(
                f"tip radius {self.r_a:.6g} mm is inside the base circle {self.r_b:.6g} mm: no involute is left; "
                "raise x or addendum"
            )
        if self.half_thickness(self.r_a) <= 0:
            raise ValueError(
                f"z = {self.z}, x = {self.x}: the tooth is pointed below its tip circle (thickness at r_a = "
                f"{2 * self.half_thickness(self.r_a) * self.r_a:.4g} mm); lower x or addendum"
            )
        from .tooth import form_point  # here: tooth needs a Gear, and a Gear without a flank must not exist

        form_point(self)

    def _check_numbers(self):
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
                raise ValueError(f"{field.name} = {value!r}, but a gear needs a finite number here")
        if self.z != int(self.z):
            raise ValueError(f"z = {self.z}, but the number of teeth is an integer")
        object.__setattr__(self, "z", int(self.z))
        if self.z < 5:
            raise ValueError(f"z = {self.z}, but a gear needs at least 5 teeth")
        for name in ("m_n", "b", "addendum", "dedendum"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} = {getattr(self, name)}, but it must be positive")
        if not math.radians(5) <= self.alpha_n <= math.radians(45):
            raise ValueError(
                f"alpha_n = {self.alpha_n} rad, but it must lie between 5 and 45 degrees; angles are radians in Python"
            )
        if not abs(self.beta) < math.radians(60):
            raise ValueError(
                f"beta = {self.beta} rad, but helix angles of 60 degrees and more are not supported; angles are radians in Python"
            )
        if self.tip_radius < 0:
            raise ValueError(f"tip_radius = {self.tip_radius}, but it cannot be negative")

    @property
    def m_t(self):
        """Transverse module [mm]."""
        return self.m_n / math.cos(self.beta)

    @property
    def alpha_t(self):
        """Transverse pressure angle [rad]."""
        return math.atan(math.tan(self.alpha_n) / math.cos(self.beta))

    @property
    def beta_b(self):
        """Base helix angle [rad]."""
        return math.asin(math.sin(self.beta) * math.cos(self.alpha_n))

    @property
    def r(self):
        """Reference radius [mm]."""
        return self.z * self.m_t / 2

    @property
    def r_b(self):
        """Base radius [mm]."""
        return self.r * math.cos(self.alpha_t)

    @property
    def r_a(self):
        """Tip radius [mm]."""
        return self.r + (self.addendum + self.x) * self.m_n

    @property
    def r_f(self):
        """Root radius [mm]."""
        return self.r - (self.dedendum - self.x) * self.m_n

    @property
    def p_bt(self):
        """Transverse base pitch [mm]: the distance of successive contacts along the line of action."""
        return 2 * math.pi * self.r_b / self.z

    @property
    def roll_a(self):
        """Roll length at the tip [mm]."""
        return math.sqrt(self.r_a**2 - self.r_b**2)

    @property
    def roll_f(self):
        """Roll length at the form radius [mm], where the involute ends and the fillet begins."""
        from .tooth import form_point

        return form_point(self)[1]

    @property
    def r_form(self):
        """Form radius [mm]."""
        return math.hypot(self.r_b, self.roll_f)

    @property
    def full_tip_radius(self):
        """Largest rack tip radius that fits [m_n]: one arc from flank to flank."""
        s, c = math.sin(self.alpha_n), math.cos(self.alpha_n)
        return (math.pi / 4 - self.dedendum * s / c) * c / (1 - s)

    @property
    def base_half_angle(self):
        """Half angle of the tooth on the base circle [rad]."""
        return (math.pi / 2 + 2 * self.x * math.tan(self.alpha_n)) / self.z + inv(self.alpha_t)

    def half_thickness(self, radius):
        """Half angle of the involute tooth [rad] at `radius` [mm], r_b <= radius (ISO 21771:2007, eq. 33)."""
        return self.base_half_angle - inv(math.acos(min(1.0, self.r_b / radius)))
