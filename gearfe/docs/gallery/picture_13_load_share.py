"""
Load sharing at different loads
===============================

The share of one pair of teeth over its engagement. Under load teeth bend, so that the next pair touches before its time: the
corners of the curve move outwards.
"""

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
loads = [200.0, 2000.0, 8000.0]
figure, axes = plt.subplots(layout="constrained")
for curve in gf.mesh_stiffness(pair, loads, gf.Material(E=206e3, nu=0.3), span="tooth", phases=128):
    axes.plot(curve.phase, 100 * curve.share[:, list(curve.order).index(0)], label=f"{curve.meta['force_N']:.0f} N")
axes.set(xlabel="phase of the tooth [mesh cycles]", ylabel="its share of the load [%]")
axes.set_title("21/31 teeth, 20 mm wide")
axes.legend()
figure.savefig("load_share.png")
plt.close(figure)
