"""
3. Cracks and pits
==================

Stiffness with a crack, pits or a spall of one tooth.
"""

# %%
# A root crack
# ------------
# A crack begins on the fillet and extends into the tooth. At ``level`` 0.5 a straight crack reaches the tooth's centre-line. The
# literature has several definitions of "30 %", whose effects differ by a factor of two. The options ``angle``, ``start``,
# ``side``, ``turning`` and ``length`` represent all of them.

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=10.0)
pair = gf.GearPair(gf.Gear(z=18, r_bore=9.0, **rack), gf.Gear(z=27, r_bore=12.0, **rack))
steel = gf.Material(E=207e3, nu=0.3)
run = dict(force=1250.0, material=steel, span="tooth")  # the whole time in which the damaged tooth is in mesh

healthy = gf.mesh_stiffness(pair, **run)
figure, axes = plt.subplots(layout="constrained")
axes.plot(healthy.phase, healthy.k / 1e6, color="black", label="healthy")
for level in (0.1, 0.3, 0.6):
    cracked = gf.mesh_stiffness(pair, damage={"pinion": [gf.Crack(level=level)]}, **run)
    axes.plot(cracked.phase, cracked.k / 1e6, label=f"crack {100 * level:.0f} %")
    print(f"crack of {100 * level:2.0f} %: largest loss of stiffness {100 * (1 - cracked.k / healthy.k).max():4.1f} %")
axes.set_xlabel("phase of the damaged tooth [mesh cycles]")
axes.set_ylabel("k [N/µm]")
axes.legend()
axes.set_title("18/27 teeth, 1250 N on 10 mm, cracks of the pinion")
figure.savefig("cracks.png")
plt.close(figure)

# %%
# Stress intensity
# ----------------
# The stress intensity factors measure the opening (I) and shear (II) at the crack tip.

crack = gf.Crack(level=0.3)
tip = gf.stress_intensity(pair.gear_1, crack, radius=18.5, line_load=125.0, material=steel)
print(f"K_I {tip.K_I:.0f}, K_II {tip.K_II:.0f} MPa sqrt(mm) at 125 N/mm")

# %%
# Pits
# ----
# A pit is an elliptic hole of constant depth in the flank. A transverse section cannot represent it, so gearfe uses the energy
# model in three dimensions, ``ritz3d``. The healthy curve must be computed by the same method.

pits = [gf.Pit(radius=18.0, z=z, axes=(0.8, 0.8), depth=0.2) for z in (2.0, 5.0, 8.0)]
phases = {"phases": [0.5, 0.75, 0.95], "method": "ritz3d", "force": 1250.0, "material": steel}
whole = gf.mesh_stiffness(pair, **phases)
pitted = gf.mesh_stiffness(pair, damage={"pinion": pits}, **phases)
for phase, before, after in zip(whole.phase, whole.k, pitted.k, strict=True):
    print(f"phase {phase:.2f}: {before / 1e6:6.1f} -> {after / 1e6:6.1f} N/um ({100 * (after / before - 1):+.1f} %)")

# %%
# Nearly all of this loss is lost contact, because the flank does not touch at a pit. The missing material itself changes the
# stiffness by less than half a percent, and the depth of a pit has little effect.
#
# Spalls
# ------
# A spall is a larger hole, a rectangle with rounded corners. Here it has 1.2 mm along the profile and 5 mm along the width.

spall = gf.Spall(radius=18.0, z=5.0, sides=(1.2, 5.0), depth=0.3, corner=0.3)
spalled = gf.mesh_stiffness(pair, damage={"pinion": [spall]}, **phases)
for phase, before, after in zip(whole.phase, whole.k, spalled.k, strict=True):
    print(f"phase {phase:.2f}: {before / 1e6:6.1f} -> {after / 1e6:6.1f} N/um ({100 * (after / before - 1):+.1f} %)")

# %%
# Several kinds of damage
# -----------------------
# A list may hold all kinds, on any teeth of both gears: ``damage={"pinion": [crack, *pits], "wheel": [...]}``. Tooth 0 is
# the one that enters contact at phase 0. ``tooth=1`` is the adjacent one.
