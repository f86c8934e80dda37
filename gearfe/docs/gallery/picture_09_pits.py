"""
Pits on a flank
===============

The contact line jumps over pits, and the load crowds at their edges. ``axes`` are half the length and half the width of the
ellipse, ``angle`` turns it.
"""

from math import radians

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
radius = pair.pitch_radius_1
pits = [
    gf.Pit(radius=radius, z=5.0, axes=(0.5, 1.5), depth=0.2),
    gf.Pit(radius=radius - 0.2, z=10.0, axes=(0.6, 0.6), depth=0.2),
    gf.Pit(radius=radius + 0.2, z=15.0, axes=(0.4, 2.0), depth=0.2, angle=radians(15)),
]
steel = gf.Material(E=206e3, nu=0.3)
contact = gf.contact_pattern(pair, 2000.0, steel, damage={"pinion": pits}, phases=[pair.pitch_phase])
gf.plot_contact(pair, contact, 0, "pits.png", pits, "three pits at the pitch circle")
