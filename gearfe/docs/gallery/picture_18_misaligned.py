"""
A misaligned helical pair
=========================

All contact lines of a mesh cycle on the flank of the pinion, with axes 20 µm askew over the width: one end carries.
"""

from math import radians

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=16.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, beta=radians(15), **rack), gf.Gear(z=31, r_bore=14.2, beta=-radians(15), **rack))
askew = gf.Misalignment(F_beta_x=0.020)  # 20 um more gap at z = b than at z = 0
pattern = gf.contact_pattern(pair, 2000.0, gf.Material(E=206e3, nu=0.3), misalignment=askew, phases=12)
gf.plot_contact(pair, pattern, None, "askew.png", title="21/31 teeth, 15 degrees, 20 µm askew")
