"""End of crack growth: arrest, fracture, or a boundary."""

import math

import numpy as np

from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import cartesian, fillet_length, root_curve

END = 0.25  # A tip has reached a boundary within this part of a step.


def stopped(values, law):
    """Return outcome and reason if the crack stops growing here, or None."""
    largest, _, least = values
    if largest <= 0:
        return "arrested", f"the crack is pressed shut: the largest K_I is {largest:.3g} MPa sqrt(mm)"
    if law is None:
        return None
    if largest >= law.K_Ic:
        return "fracture", f"K_I = {largest:.4g} reaches K_Ic = {law.K_Ic:.4g} MPa sqrt(mm)"
    swing = float(law.range(np.array(largest), np.array(least)))
    if swing <= law.threshold:
        return "arrested", f"dK = {swing:.4g} is below the threshold {law.threshold:.4g} MPa sqrt(mm)"
    return None


def reached(gear: Gear, ahead, step, slots=()):
    """Return outcome and reason if the next step reaches a boundary, or None."""
    for slot in slots:
        if slot.distance(ahead[:, None])[0] < END * step + 0.02 * gear.m_n:
            return "rim cut", f"the crack reaches a slot at {math.degrees(math.atan2(*ahead)):.3g} degrees from its tooth"
    if gear.outward * (np.hypot(*ahead) - gear.held) < END * step + 0.02 * gear.m_n:
        edge = "outside of the ring" if gear.internal else "bore"
        return "rim cut", f"the crack reaches the {edge} at {math.degrees(math.atan2(*ahead)):.3g} degrees from its tooth"
    arcs = np.linspace(0.0, fillet_length(gear), 200)
    right = cartesian(*root_curve(gear, arcs))
    for k in (-1, 0, 1):
        turn = 2 * math.pi * k / gear.z
        cos, sin = math.cos(turn), math.sin(turn)
        for sign, name in ((1, "loaded"), (-1, "unloaded")):
            if k == 0 and sign == 1:
                continue  # The crack's own fillet is not a boundary.
            x, y = right * [[sign], [1]]
            apart = np.hypot(cos * x + sin * y - ahead[0], cos * y - sin * x - ahead[1]).min()
            if apart < END * step + 0.03 * gear.m_n or (k == 0 and ahead[0] < -np.interp(ahead[1], right[1], right[0])):
                whose = "its tooth" if k == 0 else f"tooth {k}"
                return "tooth lost", f"the crack reaches the {name} fillet of {whose}"
    return None
