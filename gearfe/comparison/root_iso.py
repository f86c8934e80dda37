"""Nominal root stress of external gears by ISO 6336-3, method B, for comparison with finite elements."""

import math
from dataclasses import dataclass
from typing import cast

from ..core.case import Case
from ..core.record import ranged
from ..geometry.pair.gear_pair import GearPair
from ..strength.loaded_tooth import root_stress


@dataclass(frozen=True, slots=True)
class IsoRootStress:
    """Nominal root stress of a gear by ISO 6336-3, method B.

    Attributes
    ----------
    stress : float
        ``F_t / (b m_n) Y_F Y_S Y_beta`` [MPa]: without the factors of application, dynamics, face load and life.
    Y_F, Y_S : float
        Form factor and stress correction factor. For helical gears: those of the virtual spur gear.
    radius : float
        Radius of the outer point of single pair contact, at which the whole load acts [mm]. For helical gears: on the virtual
        spur gear.
    Y_beta : float
        Helix angle factor, 1 for spur gears.
    """

    stress: float
    Y_F: float
    Y_S: float
    radius: float
    Y_beta: float = 1.0


def iso_root_stress(pair: GearPair, force: float, side: str = "pinion") -> IsoRootStress:
    """Nominal root stress of a gear of an external pair by ISO 6336-3, method B.

    The other factors of the standard are omitted. For spur gears the result is therefore comparable with `gearfe.root_stress`:
    one tooth under the whole load at its outer point of single pair contact. The standard gives 1 to 13 % more, most at sharp
    fillets.
    For a helical gear the standard uses the virtual spur gear of its normal section::

        z_n = z / (cos(beta_b)**2 cos(beta)),  eps_alpha_n = eps_alpha / cos(beta_b)**2
        Y_beta = 1 - min(eps_beta, 1) min(beta, 30 degrees) / 120 degrees

    Parameters
    ----------
    pair : GearPair
    force : float
        Along the transverse line of action [N], over the narrower width.
    side : {"pinion", "wheel"}

    Raises
    ------
    ValueError
        If the pair is no external pair with a contact ratio eps_alpha_n between 1 and 2.

    References
    ----------
    ISO 6336-3:2006, 6.2, 7.2 and clause 8 (edition 2019 divides Y_beta by cos(beta)**3).

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
    >>> nominal = gf.iso_root_stress(pair, 2000.0)
    >>> print(f"{nominal.stress:.1f} MPa, Y_F {nominal.Y_F:.3f}, Y_S {nominal.Y_S:.3f}")
    136.6 MPa, Y_F 1.599, Y_S 1.818
    """
    if side not in ("pinion", "wheel"):
        raise ValueError(f"side = {side!r}, but it must be 'pinion' or 'wheel'")
    force = ranged("force", force, " N", above=0.0)
    if why := _beyond(pair):
        raise ValueError(f"ISO 6336-3 is here for external pairs with a contact ratio between 1 and 2, but {why}")
    gear = pair.gear_1 if side == "pinion" else pair.gear_2
    alpha, dedendum, tip, m_n = gear.alpha_n, gear.dedendum, gear.rack_tip_radius, gear.m_n
    flat = math.cos(gear.beta_b) ** 2
    z = gear.z / (flat * math.cos(gear.beta))
    # auxiliary value E of ISO 6336-3 [m_n]; the lengths below have the same unit
    cut = math.pi / 4 - dedendum * math.tan(alpha) - (1 - math.sin(alpha)) * tip / math.cos(alpha)
    g, theta = tip - dedendum + gear.x_E, math.pi / 6
    for _ in range(50):
        theta = 2 * g / z * math.tan(theta) - (2 / z * (math.pi / 2 - cut) - math.pi / 3)
    chord = z * math.sin(math.pi / 3 - theta) + math.sqrt(3) * (g / math.cos(theta) - tip)
    rho = tip + 2 * g**2 / (math.cos(theta) * (z * math.cos(theta) ** 2 - 2 * g))
    base, top = m_n * z * math.cos(alpha) / 2, m_n * z / 2 + gear.r_a - gear.r
    roll = math.sqrt(top**2 - base**2) - (pair.eps_alpha / flat - 1) * math.pi * m_n * math.cos(alpha)
    radius = math.hypot(roll, base)
    at = math.acos(base / radius)
    gamma = (math.pi / 2 + 2 * math.tan(alpha) * gear.x_E) / z + math.tan(alpha) - alpha - (math.tan(at) - at)
    arm = (math.cos(gamma) - math.sin(gamma) * math.tan(at - gamma)) * radius / m_n
    arm += (tip - z * math.cos(math.pi / 3 - theta) - g / math.cos(theta)) / 2
    y_f = 6 * arm * math.cos(at - gamma) / (chord**2 * math.cos(alpha))
    y_s = (1.2 + 0.13 * chord / arm) * (chord / (2 * rho)) ** (1 / (1.21 + 2.3 * arm / chord))
    y_beta = 1 - min(pair.eps_beta, 1.0) * min(math.degrees(abs(gear.beta)), 30.0) / 120
    width = pair.b_w
    return IsoRootStress(force * math.cos(gear.alpha_t) / (width * m_n) * y_f * y_s * y_beta, y_f, y_s, radius, y_beta)


def _beyond(pair):
    """Reason why the formula does not apply to a pair. The result is empty if it applies."""
    if pair.gear_2.internal:
        return "this is a ring pair"
    ratio = pair.eps_alpha / math.cos(pair.gear_1.beta_b) ** 2
    return "" if 1 < ratio < 2 else f"this one has {ratio:.4g}" + " in its normal section" * bool(pair.gear_1.beta)


def told_root(case: Case) -> list[str]:
    """Return lines with the root stress of both healthy gears by ISO 6336-3 and, for spur gears, by finite elements."""
    if _beyond(case.pair):
        return []
    width = case.pair.b_w
    if case.pair.gear_1.beta:
        found = {side: iso_root_stress(case.pair, case.forces[0], side) for side in ("pinion", "wheel")}
        factors = "Y_F {0.Y_F:.3f}, Y_S {0.Y_S:.3f}, Y_beta {0.Y_beta:.3f}"
        lines = [f"  {side} {one.stress:.1f} MPa ({factors.format(one)})" for side, one in found.items()]
        return ["nominal root stress (largest principal stress) by ISO 6336-3, method B:", *lines]
    lines = ["root stress of one tooth under the whole force at its outer point of single contact, as ISO 6336-3 has it:"]
    for i, side in enumerate(("pinion", "wheel")):
        gear, norm = case.pair.gears[i], iso_root_stress(case.pair, case.forces[0], side)
        stress = cast(float, root_stress(gear, norm.radius, case.forces[0] / width, case.materials[i]))
        away, factors = 100 * (norm.stress / stress - 1), f"Y_F {norm.Y_F:.3f}, Y_S {norm.Y_S:.3f}"
        lines.append(f"  {side} {stress:.1f} MPa; method B of the standard {norm.stress:.1f} MPa ({away:+.1f} %; {factors})")
    return lines
