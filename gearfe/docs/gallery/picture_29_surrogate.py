"""
Thousands of curves at once
===========================

The smallest stiffness over load and crack, from a surrogate fitted to 24 curves. A curve takes microseconds.
"""

from math import radians

import matplotlib.pyplot as plt
import numpy as np

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
ranges = {"force": (500.0, 4000.0), "level": (0.1, 0.5)}
made = gf.fit_surrogate(pair, gf.Material(E=206e3, nu=0.3), ranges, cases=24, held_back=16, workers=1)
forces, levels, phase = np.linspace(500, 4000, 60), np.linspace(0.1, 0.5, 60), np.linspace(0, 1, 200)
k = [[made.k(phase, force=force, level=level).min() / 1e6 for force in forces] for level in levels]
figure, axes = plt.subplots(layout="constrained")
shown = axes.contourf(forces, 100 * levels, k, 16, cmap="cividis")
figure.colorbar(shown, label="smallest mesh stiffness k [N/µm]")
axes.set(xlabel="load along the line of action [N]", ylabel="level of the crack [%]")
axes.set_title(f"21/31 teeth; largest error of any k: {100 * made.error['worst']:.2f} %")
figure.savefig("surrogate.png")
plt.close(figure)
