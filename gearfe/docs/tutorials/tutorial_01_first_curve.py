"""
1. A first stiffness curve
==========================

The stiffness of a gear mesh over one mesh cycle at one load, with its estimated error.

**Mesh stiffness** is the force between two gears divided by the additional displacement of the driving gear, which is caused
by the deflection of teeth, bodies and contacts. Force and displacement are measured along the *line of action* of the
involute teeth. The stiffness varies over the mesh cycle, mainly because one or two tooth pairs carry the load.
"""

# %%
# Gears
# -----
# Lengths are in millimetres and angles in radians. A gear needs its number of teeth ``z``, its normal module ``m_n``, its normal
# pressure angle ``alpha_n``, its face width ``b`` and the radius of its bore, which is held.

from math import radians

import gearfe as gf

sun = gf.Gear(z=21, m_n=2.0, alpha_n=radians(20), b=20.0, r_bore=7.4)
planet = gf.Gear(z=31, m_n=2.0, alpha_n=radians(20), b=20.0, r_bore=11.4)
pair = gf.GearPair(sun, planet)  # on the centre distance at which they mesh without backlash
print(f"centre distance {pair.a:.3f} mm, contact ratio {pair.eps_alpha:.3f}")

# %%
# At a contact ratio of 1.6, two pairs of teeth carry the load for 60 % of the time, and one pair for the rest.
#
# The curve
# ---------
# The load is the force along the line of action over the whole width [N]. It must be given, because the contact between two teeth
# becomes stiffer under load.

steel = gf.Material(E=207e3, nu=0.25)  # MPa
curve = gf.mesh_stiffness(pair, force=2000.0, material=steel, error=True)
curve.plot("first_curve.png")

# %%
# The abscissa is the *phase*. A pair of teeth enters contact at 0, and the next pair at 1, where the curve repeats.
#
# Numbers
# -------
# The curve contains arrays in SI units. ``zones`` contains the means over single contact, double contact and the whole cycle, and
# the largest value.

for zone, k in curve.zones().items():
    print(f"{zone:7s} {k / 1e6:6.1f} N/um, estimated error {100 * curve.zone_errors()[zone]:.2f} %")

# %%
# The estimate is the discretisation error. It compares the curve with a coarser computation. It does not include friction,
# shafts, bearings and manufacturing errors.
#
# Which method was that?
# ----------------------
# The default for spur gears is ``ritz``, a converged energy model. Finite elements, ``fe``, are the independent check. The usual
# formulas of the literature are also available:

for method in ("ritz", "fe", "coupled", "textbook"):
    k = gf.mesh_stiffness(pair, force=2000.0, material=steel, method=method, extended=False).zones()
    print(f"{method:9s} one pair {k['single'] / 1e6:6.1f}   two pairs {k['double'] / 1e6:6.1f} N/um")

# %%
# The textbook formula is close with one pair in contact and far too stiff with two, because it assumes a separate body for each
# pair of teeth. (``extended=False`` leaves out contact of tip corners, which the formulas neglect.)
#
# Saving the curve
# ----------------
# The suffix determines the format: ``.csv``, ``.npz``, ``.mat`` or ``.json``. The file contains all data needed to repeat the
# curve.

curve.save("sun_planet.csv")
with open("sun_planet.csv", encoding="utf-8") as file:
    print(file.readline().strip())
