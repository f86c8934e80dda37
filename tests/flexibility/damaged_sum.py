"""The pair 21/31 and the plain sum of its damaged teeth, for tests of the closed forms."""

from functools import lru_cache

import numpy as np
from usual import RACK, STEEL

import gearfe as gf
from gearfe.flexibility.energy.closed import textbook
from gearfe.flexibility.energy.closed.plain_sum import plain_sum
from gearfe.geometry.damage.pit import pit_row

BOTH = (STEEL, STEEL)
GEAR = gf.Gear(z=21, r_bore=7.4, **RACK)
PHASE = np.arange(-4, 30) / 16 + 0.003


@lru_cache
def pair(beta=0.0, b=20.0):
    rack = RACK | {"beta": beta, "b": b}
    return gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))


def seven(**numbers):
    return pit_row(7, 2.0, 18.0, **{"radius": pair().pitch_radius_1, "axes": (1.0, 1.0), "depth": 0.2} | numbers)


def stiffness(*damage, on=None, formulas=textbook, load=100.0, phase=PHASE, **options):
    """K [N/mm per mm] with cracks and pits on the pinion."""
    of_case = {name: options.pop(name) for name in ("face", "groove") if name in options}
    solve, _ = plain_sum(gf.Case(on or pair(), load, STEEL, damage={"pinion": damage}, **of_case), phase, formulas, **options)
    return load / solve(load).closing
