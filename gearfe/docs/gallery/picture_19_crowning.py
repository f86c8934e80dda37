"""
Choice of crowning
==================

The load along the width of a spur pair with a misalignment of 15 µm, in single contact. Crowning takes the load away from
the end, and too much of it concentrates the load in the middle.
"""

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
steel, askew = gf.Material(E=206e3, nu=0.3), gf.Misalignment(F_beta_x=0.015)
figure, axes = plt.subplots(layout="constrained")
for amount in (0, 5, 10, 20):
    flanks = {"pinion": gf.Flank(helix_crowning=amount / 1000)}
    (cells,) = gf.contact_pattern(pair, 2000.0, steel, flanks=flanks, misalignment=askew, phases=[pair.pitch_phase]).cells
    axes.plot(cells.z, cells.pressure, label=f"{amount} µm")
axes.set(xlabel="place along the width z [mm]", ylabel="Hertz's pressure [MPa]", ylim=(0, None))
axes.set_title("21/31 teeth, 2000 N on 20 mm, 15 µm askew, at the pitch point")
axes.legend(title="lead crowning")
figure.savefig("crowning.png")
plt.close(figure)
