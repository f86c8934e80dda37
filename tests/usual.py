"""The steel, the racks and the gear pairs of many tests."""

import math

import gearfe as gf

STEEL = gf.Material(E=207e3, nu=0.3)
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
PAIR = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK))
RACK_3 = RACK | {"m_n": 3.0}
PAIR_24_36 = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **RACK_3), gf.Gear(z=36, r_bore=20.0, **RACK_3))
RACK_15 = RACK_3 | {"b": 15.0}
PAIR_17_38 = gf.GearPair(gf.Gear(z=17, r_bore=10.9, **RACK_15), gf.Gear(z=38, r_bore=26.6, **RACK_15))
