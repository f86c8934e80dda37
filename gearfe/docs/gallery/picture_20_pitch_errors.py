"""
Pitch errors of all teeth
=========================

The transmission error over a revolution of a pinion with random pitch errors of two ISO 1328-1 classes.
"""

from math import radians

import matplotlib.pyplot as plt
import numpy as np

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
turn = np.arange(21 * 16) / 16  # mesh cycles
figure, axes = plt.subplots(layout="constrained")
for grade in (8, 5):
    flanks = {"pinion": gf.Flank(pitch=gf.random_pitch(pair.gear_1, grade, seed=3))}
    error = gf.transmission_error(pair, [2000.0], gf.Material(E=206e3, nu=0.3), flanks=flanks, phases=turn)
    axes.plot(turn / 21, 1e6 * error.te[0], label=f"class {grade}")
axes.set(xlabel="turns of the pinion", ylabel="transmission error [µm]")
axes.set_title("21/31 teeth, 2000 N on 20 mm")
axes.legend()
figure.savefig("pitch.png")
plt.close(figure)
