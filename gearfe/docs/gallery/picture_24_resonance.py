"""
Resonances of the mesh
======================

The largest and smallest mesh force over the mesh frequency. The stiffness swings, and drives the mesh not only at its natural
frequency but at parts of it. Below zero the flanks would part: give the mesh a ``backlash``.
"""

from math import radians

import matplotlib.pyplot as plt
import numpy as np

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
curve = gf.mesh_stiffness(pair, 2000.0, gf.Material(E=206e3, nu=0.3))
natural = gf.natural_frequencies(gf.single_mesh(0.2, curve, 1.0, force=2000.0))[0][0]
speeds = np.linspace(0.15, 1.4, 60)
swings = []
for speed in speeds:
    machine = gf.single_mesh(0.2, curve, speed * natural, force=2000.0, zeta=0.07)
    swings.append(gf.steady_state(machine).response["force mesh"])
figure, axes = plt.subplots(layout="constrained")
axes.plot(speeds, [force.max() for force in swings], label="largest")
axes.plot(speeds, [force.min() for force in swings], label="smallest")
axes.axhline(2000, color="0.4", linewidth=0.8, linestyle="-")
axes.set(xlabel="mesh frequency / natural frequency", ylabel="mesh force [N]")
axes.set_title(f"21/31 teeth, 2000 N, 0.2 kg: {natural:.0f} Hz, damping ratio 0.07")
axes.legend()
figure.savefig("resonance.png")
plt.close(figure)
