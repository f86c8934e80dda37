"""
Stiffness over load
===================

The contact of two teeth becomes stiffer under load, and the tip corners begin to touch earlier.
"""

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
figure, axes = plt.subplots(layout="constrained")
for curve in gf.mesh_stiffness(pair, [200.0, 1000.0, 5000.0, 20000.0], gf.Material(E=207e3, nu=0.3)):
    axes.plot(curve.phase, curve.k / 1e6, label=f"{curve.meta['force_N']:.0f} N")
axes.set_xlabel("phase")
axes.set_ylabel("k [N/µm]")
axes.legend()
axes.set_title("21/31 teeth, 20 mm wide")
figure.savefig("load.png")
plt.close(figure)
