"""Sets of the tests, of 21/31/84 teeth."""

import math
from functools import cache

from usual import RACK, STEEL

import gearfe as gf
from gearfe.planetary_sets.case import PlanetaryCase

FORCE = 2000.0  # N


@cache
def gears(planets=3, rim=95.0):
    sun, planet = gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK)
    ring = gf.Gear(z=84, r_rim=rim, x=-0.4617, addendum=0.85, rack_tip_radius=0.3, **RACK)
    return gf.PlanetarySet(sun, planet, ring, planets)


def case(planets=3, rim=95.0, **options):
    return PlanetaryCase(gears(planets, rim), FORCE, STEEL, **options)


def unequal(*places, rim=95.0, **options):
    """Planets at so many hundred-and-fifths of a turn."""
    return PlanetaryCase(gears(1, rim), FORCE, STEEL, planet_angles=[2 * math.pi / 105 * k for k in places], **options)
