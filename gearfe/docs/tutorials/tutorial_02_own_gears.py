"""
2. Your own gears
=================

The data of a gear, invalid data, and the dimensions that determine its stiffness.
"""

# %%
# A rack, two gears
# -----------------
# ``addendum``, ``dedendum`` and ``rack_tip_radius`` belong to the rack, in modules. The defaults are profile A of ISO 53. ``x``
# is the profile shift coefficient.

from dataclasses import replace
from math import radians

import gearfe as gf

rack = dict(m_n=3.0, alpha_n=radians(20), b=30.0, addendum=1.0, dedendum=1.25, rack_tip_radius=0.38)
pinion = gf.Gear(z=19, r_bore=12.0, x=0.3, **rack)
wheel = gf.Gear(z=43, r_bore=30.0, x=0.1, **rack)
pair = gf.GearPair(pinion, wheel)
steel = gf.Material(E=206e3, nu=0.3)
print(f"tip {pinion.r_a:.3f}, reference {pinion.r:.3f}, base {pinion.r_b:.3f}, root {pinion.r_f:.3f} mm; a = {pair.a:.3f} mm")

# %%
# Invalid gears
# -------------
# A message contains the value, the reason why it is invalid, and the remedy.

try:
    gf.Gear(z=19, r_bore=27.5, **rack)
except ValueError as error:
    print(error)

# %%
# Load and bore
# -------------
# The stiffness depends on the load and on the bore, so both must be stated with every value. Several loads take little more time
# than one.

curves = gf.mesh_stiffness(pair, force=[500.0, 2000.0, 8000.0], material=steel)
for curve in curves:
    print(f"{curve.meta['force_N']:6.0f} N: mean {curve.k.mean() / 1e6:6.1f} N/um")

# %%
for r_bore in (6.0, 12.0, 20.0):
    bored = gf.GearPair(replace(pinion, r_bore=r_bore), wheel)
    k = gf.mesh_stiffness(bored, force=2000.0, material=steel).k
    print(f"pinion bore of {r_bore:4.1f} mm: mean {k.mean() / 1e6:6.1f} N/um")

# %%
# Rings
# -----
# A ring gear is held at its outer radius ``r_rim`` instead of a bore. Its teeth are often shortened, because their tips would
# otherwise reach into the planet's fillet. A warning states the amount.

ring = gf.Gear(z=84, m_n=2.0, alpha_n=radians(20), b=20.0, r_rim=95.0, x=-0.4617, addendum=0.859, rack_tip_radius=0.2)
planet = gf.Gear(z=31, m_n=2.0, alpha_n=radians(20), b=20.0, r_bore=11.4)
inner = gf.GearPair(planet, ring, a=52.0)
curve = gf.mesh_stiffness(inner, force=2000.0, material=steel)
curve.plot("planet_in_ring.png")
print(f"planet in ring: contact ratio {inner.eps_alpha:.3f}, mean {curve.k.mean() / 1e6:.1f} N/um")

# %%
# A scene file
# ------------
# A *scene* is a text file with gears, pairs, damage, a machine and assumptions. Every command reads scenes
# (``gearfe stiffness my.toml``) and reports unknown keys.

SCENE = """
title = "My pair"
source = "drawing 4711"

[material.steel]
E_MPa = 206000.0
nu = 0.3

[gear.pinion]
z = 19
m_n_mm = 3.0
alpha_n_deg = 20.0
b_mm = 30.0
r_bore_mm = 12.0
x = 0.3
material = "steel"

[gear.wheel]
z = 43
m_n_mm = 3.0
alpha_n_deg = 20.0
b_mm = 30.0
r_bore_mm = 30.0
x = 0.1
material = "steel"

[pair.mine]
gear_1 = "pinion"
gear_2 = "wheel"
force_N = 2000.0
"""
with open("my.toml", "w", encoding="utf-8") as file:
    file.write(SCENE)
mine = gf.load_scene("my.toml").pair("mine")
k = gf.mesh_stiffness(mine.pair, mine.force, mine.materials).k
print(f"from the scene: mean {k.mean() / 1e6:.1f} N/um")
