"""
The root's stress while a tooth is in mesh
==========================================

The largest tension on a fillet of the pinion, under the share that contact gives the tooth, and under the whole load as ISO
6336-3 has it at the outer point of single contact.
"""

from math import radians

import matplotlib.pyplot as plt
import numpy as np
from scipy.interpolate import CubicSpline

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
pinion, steel = pair.gear_1, gf.Material(E=206e3, nu=0.3)
rolls = np.linspace(*pair.path, 7)[1:-1]  # roll lengths of the loads along the active flank
alone = [gf.root_stress(pinion, (roll**2 + pinion.r_b**2) ** 0.5, 2000.0 / pinion.b, steel) for roll in rolls]
stress = CubicSpline((rolls - pair.path[0]) / pair.p_bt, alone)
phase = np.linspace(0, pair.eps_alpha, 100)
curve = gf.mesh_stiffness(pair, 2000.0, steel, phases=phase)
share = curve.share[:, list(curve.order).index(0)]
figure, axes = plt.subplots(layout="constrained")
axes.plot(phase, share * stress(phase), label="under its share of the load")
axes.plot(phase, stress(phase), label="under the whole load")
axes.plot(1.0, stress(1.0), "o", color="black", label="outer point of single contact")
axes.set(xlabel="phase of the tooth [mesh cycles]", ylabel="largest principal stress [MPa]", ylim=(0, None))
axes.set_title("pinion of 21 teeth, 2000 N on 20 mm")
axes.legend()
figure.savefig("root.png")
plt.close(figure)
