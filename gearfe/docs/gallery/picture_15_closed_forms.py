"""
Valid range of closed forms
===========================

Errors of the mean mesh stiffness by closed forms, by the number of teeth of both gears, bores of half the root radius.
"""

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

run = dict(force=2000.0, material=gf.Material(E=206e3, nu=0.3), phases=32)
rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
teeth, errors = [18, 24, 32, 44, 60, 90], {"textbook": [], "herringbone_article": [], "coupled": []}
for z in teeth:
    gear = gf.Gear(z=z, r_bore=0.5 * (z - 2.5), **rack)
    truth = gf.mesh_stiffness(gf.GearPair(gear, gear), **run).k.mean()
    for method, found in errors.items():
        found.append(100 * (gf.mesh_stiffness(gf.GearPair(gear, gear), method=method, **run).k.mean() / truth - 1))
figure, axes = plt.subplots(layout="constrained")
for method, found in errors.items():
    axes.plot(teeth, found, marker="o", markersize=4, label=method)
axes.axhline(0, color="0.4", linewidth=0.8, linestyle="-")
axes.set(xlabel="teeth of both gears", ylabel="error of the mean of k [%]")
axes.set_title("module 2 mm, 2000 N on 20 mm, against the converged solution")
axes.legend()
figure.savefig("closed_forms.png")
plt.close(figure)
