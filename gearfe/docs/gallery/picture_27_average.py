"""
Which tooth is cracked?
=======================

The average over the turns of the pinion, without the lines that a healthy gear has: what is left rings from where the cracked
tooth carries alone, 0.7 mesh cycles after it enters.
"""

from math import radians

import matplotlib.pyplot as plt
import numpy as np

import gearfe as gf

rack, steel = dict(m_n=2.0, alpha_n=radians(20), b=20.0), gf.Material(E=206e3, nu=0.3)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
curve = gf.mesh_stiffness(pair, 2000.0, steel)
cracked = gf.mesh_stiffness(pair, 2000.0, steel, span="tooth", damage={"pinion": [gf.Crack(level=0.3)]})
hurt = (gf.ToothDamage(body=0, tooth=21 - 8, curve=cracked),)  # tooth 8 is the 13th to enter after tooth 0
machine = gf.single_mesh(0.2, curve, 1050.0, force=2000.0, zeta=0.07, teeth=(21, 31), damage=hurt)
response = gf.simulate(machine, 0.6, rate=52500.0)
late = response["pair.x acceleration"][response.time >= 0.1]
noisy = late + np.random.default_rng(1).normal(0, 30, late.size)
average, turns = gf.synchronous_average(gf.Signal(noisy, 52500.0, "m/s^2", shaft_frequency=50.0))
cycles = 21 * np.arange(average.size) / average.size
figure, axes = plt.subplots(layout="constrained")
axes.plot(cycles, average - average.mean(), color="0.7", linestyle="-", label=f"average of {turns} turns")
axes.plot(cycles, gf.residual_signal(average, 21), label="without mesh lines and shaft orders")
axes.set(xlabel="tooth of the pinion that enters", ylabel="acceleration [m/s²]", ylim=(-5000, 6500))
axes.set_xticks(range(0, 22, 2), [str(-cycle % 21) for cycle in range(0, 22, 2)])
axes.set_title("30 % crack in tooth 8, noise of 30 m/s²")
axes.legend()
figure.savefig("average.png")
plt.close(figure)
