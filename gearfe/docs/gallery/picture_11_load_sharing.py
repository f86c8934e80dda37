"""
Load sharing of a cracked tooth
===============================

Load shares of the pairs of teeth over one mesh cycle, healthy and with a crack in the pinion.
"""

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=18, r_bore=9.0, **rack), gf.Gear(z=27, r_bore=12.0, **rack))
run = dict(force=2500.0, material=gf.Material(E=207e3, nu=0.3), span="tooth")
cases = {"healthy": None, "crack 60 %": {"pinion": [gf.Crack(level=0.6)]}}

figure, axes = plt.subplots(layout="constrained")
for (name, damage), style in zip(cases.items(), ("-", "--"), strict=True):
    curve = gf.mesh_stiffness(pair, damage=damage, **run)
    own = list(curve.order).index(0)  # column of the pair with the damaged tooth
    axes.plot(curve.phase, 100 * curve.share[:, own], style, label=name)
axes.set_xlabel("phase of the damaged tooth [mesh cycles]")
axes.set_ylabel("its share of the load [%]")
axes.legend()
axes.set_title("18/27 teeth, 2500 N on 20 mm, pinion")
figure.savefig("share.png")
plt.close(figure)
