"""`Gear`: the basic data of one gear, and the derived radii and angles."""

import math
import warnings
from dataclasses import dataclass, fields, replace
from functools import lru_cache

from ..checks import is_number
from ..renamed import renamed
from .involute import inv

LARGEST = 1e9  # upper limit of all dimensions (1 km is 1e6 mm)
MOST_TEETH = 10_000  # Larger gears are racks: their teeth deflect like those of this one.
SMALLEST_BORE, THICKEST_RIM = 0.01, 100  # limits of the held edge: bore radius [m_n], radius of the rim [root radii]


@lru_cache(maxsize=256)
def _base_radius(z: int, m_n: float, alpha_n: float, beta: float) -> float:
    """Return ``r cos(alpha_t)``. The value is cached, since all functions of an involute use it."""
    return z * (m_n / math.cos(beta)) / 2 * math.cos(math.atan(math.tan(alpha_n) / math.cos(beta)))


@renamed(tip_radius="rack_tip_radius")
@dataclass(frozen=True, slots=True)
class Gear:
    """Involute gear with the symbols of ISO 21771: external with `r_bore`, or internal (a ring) with `r_rim`.

    Helical gears are described in the normal section and used in the transverse one.

    Parameters
    ----------
    z : int
        Number of teeth, 5 to 10 000.
    m_n : float
        Normal module [mm].
    alpha_n : float
        Normal pressure angle [rad].
    beta : float
        Helix angle at the reference circle [rad]; only its magnitude matters in a transverse section.
    x : float
        Profile shift coefficient [m_n].
    b : float
        Face width [mm].
    r_bore : float
        Radius of an external gear's bore [mm], the inner edge of the body, which is held; at least 0.01 m_n.
    r_rim : float
        Outside radius of a ring [mm], the outer edge of the body, which is held; at most 100 root radii.
    addendum, dedendum, rack_tip_radius : float
        Addendum, dedendum and radius of the rounded tip of the basic rack [m_n]. A tip radius larger than the full
        rounding of the tool's tip cannot be cut: it is capped there, with a warning.
    E_sn : float
        Normal tooth thickness allowance at the reference circle [mm] (DIN 3967); negative: a thinner tooth, cut with the profile
        shift `x_E`. Tip circle and centre distance without backlash stay those of `x`.
    z_cutter : int
        For a ring: number of teeth of the pinion-type cutter that generates its fillet. The cutter has no profile shift and the
        same tip radius.

    A ring's tooth space is the tooth of an external gear with the same z and x: x > 0 moves the ring's profile outwards, like
    that of a gear.

    Raises
    ------
    ValueError
        If no such gear exists; the message states which number to change.

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
    r_bore: float | None = None
    beta: float = 0.0
    x: float = 0.0
    addendum: float = 1.0
    dedendum: float = 1.25
    rack_tip_radius: float = 0.38
    r_rim: float | None = None
    z_cutter: int = 20
    E_sn: float = 0.0

    def __post_init__(self) -> None:
        """Raise ValueError for gears that cannot be generated, and limit the rack tip radius."""
        self._check_numbers()
        self._check_body()
        if self.r_a <= self.r_b:
            raise ValueError(
                f"tip radius {self.r_a:.6g} mm is inside the base circle {self.r_b:.6g} mm: no involute there; "
                + ("lower the ring's addendum or raise x" if self.internal else "raise x or addendum")
            )
        if self.half_thickness(self.r_a) <= 0:
            raise ValueError(
                f"z = {self.z}, x = {self.x}: the tooth is pointed below its tip circle (thickness at r_a = "
                f"{2 * self.half_thickness(self.r_a) * self.r_a:.4g} mm); lower {'the' if self.internal else 'x or'} addendum"
            )
        # Imported here, because `tooth` imports `Gear`. This check rejects gears without an involute flank.
        from .profile import form_point

        self._cap_tip_radius()
        form_point(self)

    def __repr__(self):
        """Return all values that differ from the default, as Python code."""
        given = ((field.name, getattr(self, field.name)) for field in fields(self) if getattr(self, field.name) != field.default)
        return f"Gear({', '.join(f'{name}={value!r}' for name, value in given)})"

    def _check_angles(self):
        if not math.radians(5) <= self.alpha_n <= math.radians(45):
            raise ValueError(
                f"alpha_n = {self.alpha_n} rad, but it must lie between 5 and 45 degrees; angles are radians in Python"
            )
        if not abs(self.beta) < math.radians(60):
            raise ValueError(
                f"beta = {self.beta} rad, but helix angles of 60 degrees and more are not supported; angles are radians in Python"
            )

    def _check_numbers(self):
        if (self.r_bore is None) == (self.r_rim is None):
            found = "are both missing" if self.r_bore is None else f"= {self.r_bore} and {self.r_rim} are both given"
            raise ValueError(f"r_bore and r_rim {found}: give r_bore for an external gear or r_rim for a ring, in mm")
        for field in fields(self):
            value = getattr(self, field.name)
            if value is None and field.name in ("r_bore", "r_rim"):
                continue
            if not is_number(value) or not abs(value) < LARGEST:
                raise ValueError(f"{field.name} = {value!r}, but give a {'whole' if field.name == 'z' else 'finite'} number")
            object.__setattr__(self, field.name, float(value))
        if self.z != int(self.z):
            raise ValueError(f"z = {self.z:g}, but the number of teeth is an integer")
        object.__setattr__(self, "z", int(self.z))
        object.__setattr__(self, "z_cutter", int(self.z_cutter))
        if self.z < 5:
            raise ValueError(f"z = {self.z}, but a gear needs at least 5 teeth")
        if self.z > MOST_TEETH:
            raise ValueError(f"z = {self.z}, but gears have at most {MOST_TEETH} teeth: give the number of teeth")
        for name in ("m_n", "b", "addendum", "dedendum"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} = {getattr(self, name)}, but it must be positive")
        self._check_angles()
        if self.rack_tip_radius < 0:
            raise ValueError(f"rack_tip_radius = {self.rack_tip_radius}, but it must be at least 0")

    def _cap_tip_radius(self):
        from .profile import cutter_tip_radius

        cap = cutter_tip_radius(self) if self.internal else self.full_tip_radius
        if cap <= 0 and not self.internal:
            raise ValueError(
                f"dedendum = {self.dedendum} m_n at alpha_n = {math.degrees(self.alpha_n):.4g} degrees: the rack tooth "
                f"is pointed before its tip; give dedendum < {math.pi / 4 / math.tan(self.alpha_n):.4g}"
            )
        if self.rack_tip_radius > cap * (1 + 1e-12):
            warnings.warn(
                f"rack_tip_radius = {self.rack_tip_radius} m_n does not fit on the tool's tip at alpha_n = "
                f"{math.degrees(self.alpha_n):.4g} degrees; capped at the full tip radius {cap:.6g} m_n",
                stacklevel=4,
            )
            object.__setattr__(self, "rack_tip_radius", cap)

    def _check_body(self):
        if self.internal:
            if not self.r_rim > self.r_f:
                raise ValueError(
                    f"r_rim = {self.r_rim} mm, but the rim must lie outside the root circle: give r_rim > {self.r_f:.6g} mm"
                )
            if self.r_rim > THICKEST_RIM * self.r_f:
                limit = THICKEST_RIM * self.r_f
                raise ValueError(f"r_rim = {self.r_rim} mm, but a rim has at most {THICKEST_RIM} root radii: {limit:.6g} mm")
            if not 5 <= self.z_cutter < self.z:
                raise ValueError(f"z_cutter = {self.z_cutter}, but a pinion cutter for z = {self.z} has 5 to {self.z - 1} teeth")
        elif self.r_f <= 0:
            raise ValueError(
                f"x = {self.x}, dedendum = {self.dedendum}: the root circle of z = {self.z} has no radius ({self.r_f:.6g} mm); "
                "give another profile shift or dedendum"
            )
        elif not 0 < self.r_bore < self.r_f:
            raise ValueError(
                f"r_bore = {self.r_bore} mm, but the bore must lie inside the root circle: give 0 < r_bore < {self.r_f:.6g} mm"
            )
        elif self.r_bore < SMALLEST_BORE * self.m_n:
            raise ValueError(
                f"r_bore = {self.r_bore} mm, but its edge is held and must have a length: give r_bore >= "
                f"{SMALLEST_BORE * self.m_n:.3g} mm"
            )

    @property
    def internal(self) -> bool:
        """Whether the gear is a ring."""
        return self.r_rim is not None

    @property
    def outward(self) -> int:
        """+1 for an external gear, -1 for a ring: the direction in which its teeth point."""
        return -1 if self.internal else 1

    @property
    def held(self) -> float:
        """Radius of the held edge [mm]: the bore, or the outside of a ring."""
        return self.r_rim if self.internal else self.r_bore  # type: ignore[return-value]  # the other one is None

    @property
    def m_t(self) -> float:
        """Transverse module [mm]."""
        return self.m_n / math.cos(self.beta)

    @property
    def alpha_t(self) -> float:
        """Transverse pressure angle [rad]."""
        return math.atan(math.tan(self.alpha_n) / math.cos(self.beta))

    @property
    def beta_b(self) -> float:
        """Base helix angle [rad], with the sign of beta: ``sin(beta_b) = sin(beta) cos(alpha_n)``."""
        return math.asin(math.sin(self.beta) * math.cos(self.alpha_n))

    @property
    def twist_rate(self) -> float:
        """Clockwise rotation of the transverse section per height [rad/mm], ``tan(beta) / r``."""
        return math.tan(self.beta) / self.r

    @property
    def x_E(self) -> float:  # noqa: N802  # the symbol of ISO 21771
        """Generating profile shift coefficient [m_n]: `x` plus the shift of the tool for the tooth thickness allowance `E_sn`."""
        return self.x + self.outward * self.E_sn / (2 * self.m_n * math.tan(self.alpha_n))

    @property
    def r(self) -> float:
        """Reference radius [mm]."""
        return self.z * self.m_t / 2

    @property
    def r_b(self) -> float:
        """Base radius [mm]."""
        return _base_radius(self.z, self.m_n, self.alpha_n, self.beta)

    @property
    def r_a(self) -> float:
        """Tip radius [mm]."""
        return self.r + (self.outward * self.addendum + self.x) * self.m_n

    @property
    def r_f(self) -> float:
        """Root radius [mm]."""
        return self.r - (self.outward * self.dedendum - self.x_E) * self.m_n

    @property
    def p_bt(self) -> float:
        """Transverse base pitch [mm]: the distance of successive contacts along the line of action."""
        return 2 * math.pi * self.r_b / self.z

    @property
    def roll_a(self) -> float:
        """Roll length at the tip [mm]."""
        return math.sqrt(self.r_a**2 - self.r_b**2)

    @property
    def roll_f(self) -> float:
        """Roll length at the form radius [mm], where the involute ends and the fillet begins."""
        from .profile import form_point

        return form_point(self)[1]

    @property
    def flank_rolls(self) -> tuple[float, float]:
        """Roll lengths at form and tip radius [mm], the smaller one first."""
        return (self.roll_a, self.roll_f) if self.internal else (self.roll_f, self.roll_a)

    @property
    def r_form(self) -> float:
        """Form radius [mm]."""
        return math.hypot(self.r_b, self.roll_f)

    @property
    def full_tip_radius(self) -> float:
        """Largest possible rack tip radius [m_n], for which a single arc connects both flanks."""
        s, c = math.sin(self.alpha_n), math.cos(self.alpha_n)
        return (math.pi / 4 - self.dedendum * s / c) * c / (1 - s)

    @property
    def base_half_angle(self) -> float:
        """Half angle of the tooth on the base circle [rad]. For a ring the flanks are extended to this circle."""
        tooth = (math.pi / 2 + 2 * self.x_E * math.tan(self.alpha_n)) / self.z + inv(self.alpha_t)
        return math.pi / self.z - tooth if self.internal else tooth

    def half_thickness(self, radius: float) -> float:
        """Half angle of the involute tooth [rad] at `radius` [mm], r_b <= radius (ISO 21771:2007, eq. 33)."""
        return self.base_half_angle - self.outward * inv(math.acos(min(1.0, self.r_b / radius)))


def shortened(gear: Gear, roll: float) -> Gear:
    """Return the gear with its tip at a roll length [mm]."""
    if roll == gear.roll_a:
        return gear
    lost = gear.outward * (gear.r_a - math.hypot(roll, gear.r_b))
    return replace(gear, addendum=gear.addendum - lost / gear.m_n)
