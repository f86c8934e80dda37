"""The steel, the racks, the gear pairs and the planetary set of many tests."""

import math

import gearfe as gf

STEEL = gf.Material(E=207e3, nu=0.3)
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
PAIR = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK))
RACK_3 = RACK | {"m_n": 3.0}
PAIR_24_36 = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **RACK_3), gf.Gear(z=36, r_bore=20.0, **RACK_3))
RACK_15 = RACK_3 | {"b": 15.0}
PAIR_17_38 = gf.GearPair(gf.Gear(z=17, r_bore=10.9, **RACK_15), gf.Gear(z=38, r_bore=26.6, **RACK_15))
BETA = math.radians(16)
_SLOPED = RACK | {"b": 30.0, "beta": BETA}
HERRINGBONE = gf.PlanetarySet(
    gf.Gear(z=18, r_bore=8.0, **_SLOPED), gf.Gear(z=27, r_bore=12.0, **_SLOPED),
    gf.Gear(z=72, r_rim=90.0, addendum=0.8, rack_tip_radius=0.2, **_SLOPED), 3,
)  # fmt: skip


def pair_18_27(width=12.0, beta=BETA):
    """Return a helical pair of 2 mm module."""
    rack = RACK | {"b": width}
    return gf.GearPair(gf.Gear(z=18, r_bore=9.0, beta=beta, **rack), gf.Gear(z=27, r_bore=12.0, beta=-beta, **rack))


def pair_24_30(hand, degrees, **more):
    """Return a helical pair of 3 mm module; of hand 1 the pinion's helix angle is negative."""
    rack, beta = RACK_15 | more, hand * math.radians(degrees)
    return gf.GearPair(gf.Gear(z=24, r_bore=15.0, beta=-beta, **rack), gf.Gear(z=30, r_bore=18.0, beta=beta, **rack))
