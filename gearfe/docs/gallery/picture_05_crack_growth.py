"""
Will the crack grow?
====================

The stress intensity of a crack by its length, with the whole load at the outer point of single contact. A crack grows where the
swing of :math:`K_I` is above the threshold of its steel.
"""

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
pinion, steel = pair.gear_1, gf.Material(E=206e3, nu=0.3)
roll = pinion.roll_a - (pair.eps_alpha - 1) * pair.p_bt  # outer point of single contact
radius = (roll**2 + pinion.r_b**2) ** 0.5
lengths = [0.2, 0.5, 1.0, 1.5, 2.0, 2.5]
found = [gf.stress_intensity(pinion, gf.Crack(length=length), radius, 2000.0 / pinion.b, steel) for length in lengths]
figure, axes = plt.subplots(layout="constrained")
for name, label in (("K_I", "$K_I$, opens the crack"), ("K_II", "$K_{II}$, shears it")):
    axes.plot(lengths, [getattr(each, name) / 1000**0.5 for each in found], marker="o", markersize=4, label=label)
axes.set(xlabel="length of the crack [mm]", ylabel=r"stress intensity [MPa $\sqrt{\mathrm{m}}$]", xlim=(0, None), ylim=(0, None))
axes.set_title("pinion of 21 teeth, 2000 N on 20 mm, crack at 45 degrees")
axes.legend()
figure.savefig("growth.png")
plt.close(figure)
