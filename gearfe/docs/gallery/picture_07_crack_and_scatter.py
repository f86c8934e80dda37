"""
A small crack among tolerances
==============================

Sixty machines of one drawing, whose profiles slope by chance, each healthy and with a crack of 10 %. Bands hold nine of ten.
Where one pair carries alone slopes do not matter, and only there the bands are apart.
"""

from math import radians

import matplotlib.pyplot as plt
import numpy as np

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
run = dict(force=2000.0, material=gf.Material(E=206e3, nu=0.3), span="tooth")
slopes = np.random.default_rng(1).normal(0, 0.003, (60, 2))  # mm, standard deviation 3 um
figure, axes = plt.subplots(layout="constrained")
for name, damage in {"healthy": None, "crack of 10 %": {"pinion": [gf.Crack(level=0.1)]}}.items():
    flanks = [{"pinion": gf.Flank(profile_slope=one), "wheel": gf.Flank(profile_slope=two)} for one, two in slopes]
    curves = [gf.mesh_stiffness(pair, damage=damage, flanks=each, phases=32, **run) for each in flanks]
    low, middle, high = np.percentile([curve.k / 1e6 for curve in curves], (5, 50, 95), axis=0)
    (line,) = axes.plot(curves[0].phase, middle, label=name)
    axes.fill_between(curves[0].phase, low, high, color=line.get_color(), alpha=0.25, linewidth=0)
axes.set(xlabel="phase of the cracked tooth [mesh cycles]", ylabel="mesh stiffness k [N/µm]")
axes.set_title("21/31 teeth, 2000 N on 20 mm; 5, 50 and 95 % of 60 draws")
axes.legend()
figure.savefig("scatter.png")
plt.close(figure)
