"""
10. Damage that changes along the width
=======================================

A crack rarely starts over the whole width at once, and pits come in rows. Both need three dimensions.
"""

# %%
# Four cracks with the same largest depth
# ---------------------------------------
# Each crack extends half way to the centre-line of the tooth:
#
# - through the whole width;
# - over the first four of eight millimetres;
# - running out along the whole width (``ends=(1, 0)``: full depth at z = 0, none at z = b; ``rounded``: the parabolic front of
#   Chen and Shao);
# - a semi-ellipse around the middle.

from math import radians

import matplotlib.pyplot as plt
import numpy as np

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=8.0, beta=radians(12))
pair = gf.GearPair(gf.Gear(z=19, r_bore=8.0, **rack), gf.Gear(z=23, r_bore=10.0, **rack))
run = dict(force=1200.0, material=gf.Material(E=206e3, nu=0.3), method="ritz3d", phases=8, order=2)
cracks = {
    "whole width": gf.Crack(level=0.5),
    "half the width": gf.Crack(level=0.5, width=(0.0, 4.0)),
    "running out": gf.Crack(level=0.5, ends=(1, 0), rounded=True),
    "half ellipse": gf.Crack(level=0.5, width=(1.0, 7.0), ends=(0, 1, 0), rounded=True),
}
healthy = gf.mesh_stiffness(pair, span="tooth", **run)
fig, axes = plt.subplots()
for name, crack in cracks.items():
    cracked = gf.mesh_stiffness(pair, span="tooth", damage={"pinion": [crack]}, **run)
    loss = 100 * (1 - cracked.k / healthy.k)
    axes.plot(cracked.phase, loss, label=name)
    print(f"{name:15s} largest loss {loss.max():5.2f} %, mean {loss.mean():5.2f} %")
axes.set(xlabel="phase", ylabel="loss of mesh stiffness [%]", title="Cracks of one greatest depth, 19/23 teeth, 12 degrees")
axes.legend()
fig.savefig("cracks_along_the_width.png", dpi=120)
plt.close(fig)

# %%
# The crack over half the width causes a quarter of the loss of the full-width crack, and not half. The intact part of the tooth
# supports the cracked part, and the load moves to it.
#
# Crack growth along the front
# ----------------------------
# The stress intensity K_I measures the opening of the crack at each point of its front. Where a sloping front is
# shallow, K_I is larger, so that the front becomes more uniform as it grows.

gear, sloping = pair.gear_1, gf.Crack(level=0.5, ends=(1, 0.4))
front = gf.stress_intensity_along_front(gear, sloping, gear.r, 150.0, run["material"], refine=0.4)
for i in np.linspace(1, len(front.z) - 2, 4).round().astype(int):
    print(f"z = {front.z[i]:.1f} mm: {front.depth[i]:.2f} mm deep, K_I {front.K_I[i] / np.sqrt(1000):.1f} MPa sqrt(m)")
