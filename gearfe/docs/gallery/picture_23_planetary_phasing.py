"""
Phase differences of the planets
================================

Stiffness of the three meshes of the sun over time, and their sum. If the number of the sun's teeth is a multiple of the number of
planets, all swing together, and the sum swings most.
"""

from math import radians

import matplotlib.pyplot as plt
import numpy as np

import gearfe as gf

rack, steel = dict(m_n=2.0, alpha_n=radians(20), b=20.0), gf.Material(E=206e3, nu=0.3)
time = np.linspace(0, 2, 400)  # mesh cycles
figure, rows = plt.subplots(2, sharex=True, layout="constrained", figsize=(6.4, 5.6))
for axes, (z_sun, z_planet, z_ring) in zip(rows, ((21, 31, 84), (22, 31, 86)), strict=True):
    sun, planet = gf.Gear(z=z_sun, r_bore=9.2, **rack), gf.Gear(z=z_planet, r_bore=14.2, **rack)
    ring = gf.Gear(z=z_ring, r_rim=98.0, x=-0.4, addendum=0.85, rack_tip_radius=0.2, **rack)
    pairs = gf.GearPair(sun, planet), gf.GearPair(planet, ring)
    curve = gf.mesh_stiffness(pairs[0], 2000.0, steel)
    running = gf.stage_phases(pairs, 3)
    meshes = [curve((time + mesh["phase"]) % 1) / 1e6 for name, mesh in running.items() if "sun" in name]
    for number, k in enumerate(meshes, start=1):
        axes.plot(time, k, label=f"planet {number}")
    axes.plot(time, np.mean(meshes, axis=0), color="black", linewidth=2, linestyle="-", label="mean of the three")
    axes.set(ylabel="k [N/µm]", title=f"sun of {z_sun}, planets of {z_planet}, ring of {z_ring} teeth")
rows[-1].set_xlabel("time [mesh cycles]")
rows[0].legend(loc="upper left", bbox_to_anchor=(1, 1))
figure.savefig("phasing.png")
plt.close(figure)
