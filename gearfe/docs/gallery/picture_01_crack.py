"""
Stiffness loss by a crack, and error of textbook formulas
=========================================================

The pair of the first page while the cracked tooth is in mesh. Plain sums of tooth pairs are too stiff where two carry.
"""

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
run = dict(force=2000.0, material=gf.Material(E=206e3, nu=0.3), span="tooth")
crack = {"pinion": [gf.Crack(length=2.0, angle=radians(60))]}
curves = {
    "healthy": gf.mesh_stiffness(pair, **run),
    "2 mm crack at 60 degrees": gf.mesh_stiffness(pair, damage=crack, **run),
    "healthy, textbook": gf.mesh_stiffness(pair, method="textbook", **run),
}
figure, axes = plt.subplots(layout="constrained")
for name, curve in curves.items():
    axes.plot(curve.phase, curve.k / 1e6, label=name)
axes.set(xlabel="phase of the cracked tooth [mesh cycles]", ylabel="mesh stiffness k [N/µm]", ylim=(0, None))
axes.set_title("21/31 teeth of 2 mm, 2000 N on 20 mm")
axes.legend()
figure.savefig("crack.png")
plt.close(figure)
