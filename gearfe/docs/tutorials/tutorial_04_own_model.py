"""
4. Your own model
=================

You have a formula, a program or a table for mesh stiffness. How far is it from a converged solution?
"""

# %%
# Three kinds of model
# --------------------
# - A function of the phase gives the whole mesh's stiffness [N/m].
# - A `gearfe.PairModel` gives the stiffness of one tooth pair as a function of the contact position. gearfe sums over the pairs.
# - A file has two columns, with units in its header.

import matplotlib.pyplot as plt
import numpy as np

import gearfe as gf

scene = gf.load_scene("planetary_pitting")
leaves = scene.pair().pair.eps_alpha - 1  # phase at which the older of two pairs leaves


def square_wave(phase):
    """Two values: two pairs in contact, and one."""
    return np.where(phase <= leaves, 4.0e8, 2.5e8)


def parabola(radius_1, radius_2):
    """One pair of teeth, by its contact radii [mm] on pinion and wheel."""
    return 2.6e8 - 1.0e7 * (radius_1 - 21.0) ** 2


phase = np.arange(100) / 100
k = 0.32 + 0.05 * np.cos(2 * np.pi * (phase - leaves / 2))
np.savetxt("cosine.csv", np.transpose([phase, k]), delimiter=",", header="phase,k [GN/m]")

# %%
# The table
# ---------
# ``compare`` computes the finite elements, the energy model and the closed forms of the literature for the same pair and load,
# and adds yours.

result = gf.compare(scene, models=[square_wave, gf.PairModel(parabola), "cosine.csv"])
for row in result.rows():
    if row.method == "fe":
        print(f"{row.zone:6s} fe {row.k / 1e6:.1f} N/um")
    else:
        print(f"       {row.method:12s} {100 * row.error:+6.1f} %")

figure, axes = plt.subplots(layout="constrained")
for name, curve in result.curves.items():
    axes.plot(curve.phase, curve.k / 1e6, label=name, linewidth=3 if name == "fe" else 1)
axes.set_xlabel("phase")
axes.set_ylabel("k [N/µm]")
axes.legend()
axes.set_title("planetary_pitting, sun_planet, healthy, 2000 N")
figure.savefig("compared.png")
plt.close(figure)

# %%
# On the command line the same is ``gearfe compare planetary_pitting --model cosine.csv --plot compared.png``.
#
# A model of the flexibility of one gear
# --------------------------------------
# A user-defined model can also be the flexibility matrix of one gear between its contacts. gearfe then adds the local contact
# and the load sharing, as for its own methods. Here, teeth are bars of constant thickness on rigid bodies:


def bar(gear, material, radius, tooth):
    """Displacement of contact i per unit line load at contact j [mm per N/mm]."""
    arm, thickness = radius - gear.r_f, 2 * gear.m_n
    bending = 4 * arm**3 / (material.E * thickness**3)
    return np.diag(bending + 1.2 * arm / (material.shear_modulus * thickness))


pair, steel = scene.pair().pair, scene.pair().materials
methods = {
    "two gears of bars": gf.OwnFlexibility(bar),
    "bars on a real wheel": gf.OwnFlexibility(bar, "ritz"),
    "two real gears": "ritz",
}
for name, method in methods.items():
    curve = gf.mesh_stiffness(pair, 2000.0, steel, method=method, extended=False)
    print(f"{name:21s} mean {curve.k.mean() / 1e6:6.1f} N/um")

# %%
# The second line has a pinion of bars and an elastic wheel. The zeros off the diagonal decouple the teeth. Together with the
# rigid bodies they nearly double the mesh stiffness.
