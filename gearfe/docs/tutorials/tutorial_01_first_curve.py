"""
1. A first stiffness curve
==========================

Two gears, one load, one curve: how stiff the mesh is while the teeth roll through it, and how wrong that number may be.

**Mesh stiffness** is the force between two gears divided by how much further the driving gear turns because teeth, bodies and
contacts give way. Force and displacement are both measured along the line on which involute teeth push each other, the *line of
action*. It changes while the gears turn, mostly because one pair of teeth carries the load at some times and two at others.
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
# A contact ratio of 1.6 says that two pairs of teeth carry the load for 60 % of the time, and one pair for the rest.
#
# The curve
# ---------
# The load is the force along the line of action over the whole width [N]. Stiffness depends on it, since the contact between two
# teeth becomes stiffer under load; therefore it has to be given.

steel = gf.Material(E=207e3, nu=0.25)  # MPa
curve = gf.mesh_stiffness(pair, force=2000.0, material=steel, error=True)
curve.plot("first_curve.png")

# %%
# The abscissa is the *phase*: at 0 a pair of teeth begins to touch, at 1 the next one does. From then on everything repeats.
#
# Numbers
# -------
# The curve holds arrays in SI units. ``zones`` gives means over the phases in which one pair carries, in which two carry, and
# over the whole cycle, and the largest value.

for zone, k in curve.zones().items():
    print(f"{zone:7s} {k / 1e6:6.1f} N/um, estimated error {100 * curve.zone_errors()[zone]:.2f} %")

# %%
# The estimate is that of the computation: the same curve is computed more coarsely, and compared. Friction, shafts, bearings and
# manufacturing are not in it.
#
# Which method was that?
# ----------------------
# The default for spur gears is ``ritz``, an energy model that is refined until it no longer changes. The independent check are
# finite elements, ``fe``. The usual formulas of the literature are there as well:

for method in ("ritz", "fe", "coupled", "textbook"):
    k = gf.mesh_stiffness(pair, force=2000.0, material=steel, method=method, extended=False).zones()
    print(f"{method:9s} one pair {k['single'] / 1e6:6.1f}   two pairs {k['double'] / 1e6:6.1f} N/um")

# %%
# The textbook formula is close with one pair in contact and far too stiff with two: it adds up pairs of teeth as if each stood on
# a separate body. (``extended=False`` leaves out contact of tip corners, which the formulas neglect.)
#
# Keep it
# -------
# The suffix is the kind of file: ``.csv``, ``.npz``, ``.mat`` or ``.json``. Everything needed to repeat the curve is in it.

curve.save("sun_planet.csv")
with open("sun_planet.csv", encoding="utf-8") as file:
    print(file.readline().strip())
