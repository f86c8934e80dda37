"""
5. A helical pair
=================

Teeth at an angle touch along sloping lines, and several of them at once. That takes three dimensions.
"""

# %%
# Helix angle
# -----------
# For gears with a helix angle ``beta`` gearfe uses ``ritz3d``, the converged energy model in three dimensions. It takes seconds
# instead of milliseconds.

from math import radians

import numpy as np

import gearfe as gf

rack = dict(m_n=2.0, alpha_n=radians(20), b=12.0, beta=radians(15))
pair = gf.GearPair(gf.Gear(z=21, r_bore=8.0, **rack), gf.Gear(z=31, r_bore=12.0, **rack))
steel = gf.Material(E=206e3, nu=0.3)
print(f"contact ratio {pair.eps_alpha:.3f} in the transverse section and {pair.eps_beta:.3f} by the helix")
curve = gf.mesh_stiffness(pair, force=1200.0, material=steel, phases=12)
curve.plot("helical.png")
print(curve.meta["why"])
print(f"mean {curve.k.mean() / 1e6:.1f} N/um, from {curve.k.min() / 1e6:.1f} to {curve.k.max() / 1e6:.1f}")

# %%
# Compared with spur gears
# ------------------------
# The stiffness of spur gears jumps where a pair enters or leaves. Helical pairs enter gradually, so the variation, which excites
# vibration, is smaller:

straight = dict(rack, beta=0.0)
spur = gf.GearPair(gf.Gear(z=21, r_bore=8.0, **straight), gf.Gear(z=31, r_bore=12.0, **straight))
for name, found in (("helical", curve), ("spur", gf.mesh_stiffness(spur, 1200.0, steel, phases=12))):
    print(f"{name:8s} peak to peak {100 * np.ptp(found.k) / found.k.mean():5.1f} % of the mean")

# %%
# Load sharing
# ------------
# ``curve.share`` has one column for each pair of teeth; the rows sum to 1.

print(np.array2string(curve.share[::3], precision=3, suppress_small=True))

# %%
# Herringbone gears are two helical halves: ``face="herringbone"``, with ``groove`` as the width of the gap between the halves.
# Formulas of the literature divide helical gears into independent slices:

for method in ("textbook", "herringbone_article"):
    found = gf.mesh_stiffness(pair, 1200.0, steel, method=method, face="helical", phases=12)
    print(f"{method:10s} mean {100 * (found.k.mean() / curve.k.mean() - 1):+5.1f} %")
