"""
Choice of tip relief
====================

The peak-to-peak transmission error over the load, for several amounts. Each amount is best at one load.
"""

from math import radians

import matplotlib.pyplot as plt
import numpy as np

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
steel, loads = gf.Material(E=206e3, nu=0.3), np.linspace(200, 4000, 20)
figure, axes = plt.subplots(layout="constrained")
plain = gf.transmission_error(pair, loads, steel)
axes.plot(loads, 1e6 * plain.peak_to_peak, label="none")
for amount in (5, 10, 15, 20):
    flanks = {
        name: gf.Flank(tip_relief=amount / 1000, tip_start_roll=gear.roll_a - 2.6)
        for name, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2))
    }
    error = gf.transmission_error(pair, loads, steel, flanks=flanks)
    axes.plot(loads, 1e6 * error.peak_to_peak, label=f"{amount} µm")
axes.set(xlabel="load along the line of action [N]", ylabel="transmission error, peak-to-peak [µm]", ylim=(0, None))
axes.set_title("21/31 teeth of 2 mm, 20 mm wide, linear relief over 2.6 mm of roll")
axes.legend(title="relief of both tips")
figure.savefig("relief.png")
plt.close(figure)
