"""Checks of the supports of a pair's hubs: they must carry the gears and keep the teeth in mesh."""

import math

import numpy as np

from ...geometry.checks import by_gear
from .shaft import Shaft
from .support import UNITS, Support

TWIST = 0.1  # limit of the twist [rad]; round steel at 300 N/mm2 reaches it at a length of 13 diameters
REFUSE = 0.25  # limit of the approach [modules], see `gearfe.stiffness.plausible`
FITS = 0.01  # relative excess of a shaft over its bore that is accepted (press fits, rounded values)


def supports_of(pair, supports, forces=(), face=None):
    """Return the supports of the hubs of pinion and wheel. A rigid hub is None, and two rigid hubs give None.

    ValueError for other types, if a shaft does not carry its gear, or if the teeth lose contact by the deflection of a hub under
    one of the `forces` [N].
    """
    if supports is None:
        return None
    both = by_gear("supports", supports, "{'pinion': Support(...), 'wheel': Shaft(...)}")
    for name, gear, held in zip(("pinion", "wheel"), pair.gears, both, strict=True):
        if held is None:
            continue
        if not isinstance(held, (Support, Shaft)):
            raise ValueError(f"supports of the {name}: {held!r} is neither a Support nor a Shaft")
        _check_fit(name, gear, held)
        beta_b = 0.0 if face == "herringbone" else abs(gear.beta_b)  # The axial forces of both halves cancel.
        _check_way(name, gear, held, max(forces, default=0.0), beta_b)
    return both if any(both) else None


def _check_fit(name, gear, held):
    """Raise ValueError for a shaft that does not fit its gear's bore."""
    if not isinstance(held, Shaft) or held.integral or gear.internal:
        return
    if gear.b > held.length * (1 + 1e-9):
        raise ValueError(
            f"the {name}'s shaft is {held.length:g} mm long, but its gear is {gear.b:g} mm wide: give lengths in mm "
            f"({held.length:g} m are {1e3 * held.length:g} mm)"
        )
    thick, bore = held.diameter, 2 * gear.r_bore
    if thick > bore * (1 + FITS):
        raise ValueError(
            f"the {name}'s shaft is {thick:g} mm thick at the gear, but the bore is {bore:g} mm wide (r_bore = {gear.r_bore:g} "
            "mm): give diameters of the shaft and the radius of the bore in mm, or a gear that is one piece with its shaft "
            "(integral)"
        )


def _check_way(name, gear, held, force, beta_b):
    """Raise ValueError for springs on which a hub deflects by more than a part of the module under a force on its teeth.

    The force is off the middle of the width by at most a quarter of it, plus the effect of the axial force of helical teeth.
    """
    hub, axial = held.hub(), force * math.tan(beta_b)
    arm = gear.b / 4 + gear.r_b * math.tan(beta_b)
    (soft, cross), (_, tilt) = np.abs(hub.bending).tolist()
    ways = {
        "radial": force * soft,
        "tilt": force * (cross * (arm + gear.b / 2) + tilt * arm * gear.b / 2),
        "axial": axial * hub.axial,
    }
    worst, twist, limit = max(ways, key=lambda way: ways[way]), force * gear.r_b * hub.torsion, REFUSE * gear.m_n
    if ways["radial"] + ways["tilt"] > limit or ways["axial"] > limit:
        problem = f"its teeth move by {ways[worst]:.3g} mm, but beyond {limit:g} mm ({100 * REFUSE:g} % of the module) they leave"
        raise ValueError(
            f"the {name}'s {_springs(held, worst)}: under {force:g} N {problem} those of the other gear: {_units(held, worst)}"
        )
    if twist > TWIST:
        problem = f"it twists by {twist:.3g} rad, but shafts twist by less than {TWIST:g} rad"
        raise ValueError(f"the {name}'s {_springs(held, 'torsion')}: under {force:g} N {problem}: {_units(held, 'torsion')}")


def _springs(held, what):
    """Return the values of a support that are too soft, as the user gave them."""
    if isinstance(held, Support):
        return f"support has {what} = {getattr(held, what):g} {UNITS[what]}"
    thin, thick = (pick(segment.diameter for segment in held.segments) for pick in (min, max))
    return f"shaft is {held.length:g} mm long and {thin:g} to {thick:g} mm thick, its bearings {held.bearing_stiffness} N/mm"


def _units(held, what):
    """Return the remedy for a soft support."""
    if isinstance(held, Support):
        value, larger = getattr(held, what), "N/um" if what in ("radial", "axial") else "N m/rad"
        return f"give {what} in {UNITS[what]} ({value:g} {larger} are {1e3 * value:g} {UNITS[what]}), or a smaller force"
    return "give lengths and diameters in mm, stiffnesses of bearings in N/mm (1 N/um is 1000 N/mm), E in MPa, or a smaller force"
