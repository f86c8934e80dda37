"""
A crack in its mesh
===================

Half an ellipse, in the elements that ``export_mesh`` writes for other programs. The orange line is the rim of the crack.
"""

from math import radians

import gearfe as gf

gear = gf.Gear(z=21, r_bore=9.2, m_n=2.0, alpha_n=radians(20), b=20.0)
crack = gf.Crack(level=0.5, width=(4.0, 16.0), ends=(0, 1, 0), rounded=True)
part = gf.export_mesh("cracked.msh", gear, [crack], cells="hexahedra")
gf.render_mesh(part, "front.png", close_up="crack")
