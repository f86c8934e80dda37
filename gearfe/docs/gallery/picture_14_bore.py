"""
Influence of the bore
=====================

The bore is held, and the body between bore and teeth deflects. Without the bore, k of an article is undefined.
"""

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
steel, parts = gf.Material(E=206e3, nu=0.3), [0.2, 0.33, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85]  # bore radii relative to the root radius
zones = {"single": [], "mean": [], "max": []}
for part in parts:
    pair = gf.GearPair(gf.Gear(z=21, r_bore=part * 18.5, **rack), gf.Gear(z=31, r_bore=part * 28.5, **rack))
    found = gf.mesh_stiffness(pair, 2000.0, steel, phases=32).zones()
    for name, values in zones.items():
        values.append(found[name] / 1e6)
figure, axes = plt.subplots(layout="constrained")
for name, values in zones.items():
    axes.plot(parts, values, marker="o", markersize=4, label=name)
axes.set(xlabel="radius of both bores / root radius", ylabel="mesh stiffness k [N/µm]", ylim=(0, None))
axes.set_title("21/31 teeth, 2000 N on 20 mm")
axes.legend()
figure.savefig("bore.png")
plt.close(figure)
