"""
How deep is the crack?
======================

The loss of stiffness over the engagement of the cracked tooth. At a level of 50 % the crack reaches the tooth's centre-line.
"""

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
run = dict(force=2000.0, material=gf.Material(E=206e3, nu=0.3), span="tooth")
healthy = gf.mesh_stiffness(pair, **run)
figure, axes = plt.subplots(layout="constrained")
for level in (0.1, 0.2, 0.3, 0.4, 0.5):
    cracked = gf.mesh_stiffness(pair, damage={"pinion": [gf.Crack(level=level)]}, **run)
    axes.plot(cracked.phase, 100 * (1 - cracked.k / healthy.k), label=f"level {100 * level:.0f} %")
axes.set(xlabel="phase of the cracked tooth [mesh cycles]", ylabel="loss of mesh stiffness [%]")
axes.set_title("21/31 teeth, 2000 N on 20 mm, crack of the pinion at 45 degrees")
axes.legend()
figure.savefig("depth.png")
plt.close(figure)
