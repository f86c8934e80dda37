"""
Direction of the crack
======================

Cracks of one length, from the 30-degree point and from the root circle. The angle is that to the centre-line of the tooth: at 60
degrees a crack cuts under the tooth, at 30 it dives into the rim.
"""

from math import radians

import matplotlib.pyplot as plt
import numpy as np

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
run = dict(force=2000.0, material=gf.Material(E=206e3, nu=0.3), span="tooth")
healthy = gf.mesh_stiffness(pair, phases=24, **run).k
angles = np.linspace(25, 75, 11)
figure, axes = plt.subplots(layout="constrained")
for start, name in (("30deg", "from the 30-degree point"), ("root", "from the root circle")):
    cracks = [gf.Crack(length=2.0, angle=radians(angle), start=start) for angle in angles]
    losses = [100 * (1 - gf.mesh_stiffness(pair, phases=24, damage={"pinion": [c]}, **run).k / healthy).max() for c in cracks]
    axes.plot(angles, losses, marker="o", markersize=4, label=name)
axes.set(xlabel="angle to the centre-line [degrees]", ylabel="largest loss of stiffness [%]", ylim=(0, None))
axes.set_title("21/31 teeth, 2000 N on 20 mm, crack of 2 mm in the pinion")
axes.legend()
figure.savefig("angle.png")
plt.close(figure)
