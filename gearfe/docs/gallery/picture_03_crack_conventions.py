"""
Definitions of "a crack of 30 %"
================================

The largest loss of stiffness over the level of a crack, by several definitions that are in use.
"""

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=18, r_bore=9.0, **rack), gf.Gear(z=27, r_bore=12.0, **rack))
run = dict(force=2500.0, material=gf.Material(E=207e3, nu=0.3), span="tooth", phases=24)
conventions = {
    "at 45 degrees from the 30-degree point": {},
    "at 30 degrees": {"angle": radians(30)},
    "at 60 degrees": {"angle": radians(60)},
    "from the root circle": {"start": "root"},
    "turning at the centre-line": {"turning": True},
    "on the unloaded side": {"side": "unloaded"},
}
levels = (0.1, 0.2, 0.3, 0.4)
healthy = gf.mesh_stiffness(pair, **run).k
figure, axes = plt.subplots(layout="constrained")
for name, options in conventions.items():
    cracks = [gf.Crack(level=level, **options) for level in levels]
    losses = [100 * (1 - gf.mesh_stiffness(pair, damage={"pinion": [c]}, **run).k / healthy).max() for c in cracks]
    axes.plot([100 * level for level in levels], losses, marker="o", markersize=4, label=name)
axes.set_xlabel("level [%]")
axes.set_ylabel("largest loss of stiffness [%]")
axes.legend()
axes.set_title("18/27 teeth, 2500 N on 20 mm, crack of the pinion")
figure.savefig("conventions.png")
plt.close(figure)
