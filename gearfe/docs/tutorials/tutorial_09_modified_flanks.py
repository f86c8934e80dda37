"""
9. Modified flanks and the transmission error
=============================================

No gear that runs has perfect involutes. Designers relieve tips and crown flanks, and every gear has pitch errors and stands a
little askew. What excites the noise of a transmission is its transmission error: how far the driven gear lags.
"""

# %%
# Transmission error of involutes
# -------------------------------
# In single contact a tooth pair deflects more than in double contact:

from math import radians

import numpy as np

import gearfe as gf

rack = dict(m_n=3.0, alpha_n=radians(20), b=20.0)
pair = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **rack), gf.Gear(z=36, r_bore=20.0, **rack))
steel = gf.Material(E=207e3, nu=0.3)
loads = [1000.0, 2000.0, 3000.0, 4000.0]
plain = gf.transmission_error(pair, loads, steel)
print("peak-to-peak [um]:", np.round(1e6 * plain.peak_to_peak, 2))

# %%
# Tip relief
# ----------
# A ``Flank`` defines the removed material. Amounts are in mm along the line of action, and positive is material removed.
# Here both tips lose 10 um, in proportion over the last 4.7 mm of roll length:

flanks = {
    name: gf.Flank(tip_relief=0.010, tip_start_roll=gear.roll_a - 4.7)
    for name, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2))
}
relieved = gf.transmission_error(pair, loads, steel, flanks=flanks)
print(relieved.table())
relieved.plot("harris.png")

# %%
# At 3000 N the error is nearly constant, because the relief compensates the deflection. This holds at one load only. Without
# load, relieved gears have a larger error than involutes (S. L. Harris's map).
#
# Along the width
# ---------------
# Helix crowning, helix slope, end relief, twist and misaligned axes vary along the width. They require three dimensions, for
# which gearfe uses ``ritz3d``:

narrow = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **rack | {"b": 12.0}), gf.Gear(z=30, r_bore=18.0, **rack | {"b": 12.0}))
askew = gf.Misalignment(F_beta_x=0.015)  # 15 um more gap at z = b than at z = 0
crowned = {"pinion": gf.Flank(helix_crowning=0.006)}
cases = {"parallel": {}, "askew": {"misalignment": askew}, "crowned": {"misalignment": askew, "flanks": crowned}}
for name, given in cases.items():
    curve = gf.mesh_stiffness(narrow, 2000.0, steel, phases=8, method="ritz3d", **given)
    print(f"{name:8s} mean {curve.k.mean() / 1e6:6.1f} N/um, pressure {np.nanmax(curve.pressure) / 1e6:6.0f} MPa")

# %%
# Contact pattern
# ---------------
# The contact pattern shows all contact lines of a mesh cycle; edge contact is marked.

pattern = gf.contact_pattern(narrow, 2000.0, steel, misalignment=askew, phases=8)
gf.plot_contact(narrow, pattern, None, "pattern.png", title="askew")
print("phases with edge contact at an end face:", sum(bool(cells.at_ends(narrow)) for cells in pattern.cells), "of 8")

# %%
# Pitch errors
# ------------
# ``random_pitch`` draws the pitch errors of a gear at the limit of an ISO 1328-1 class. Phases of more than one cycle show its
# teeth one after another:

uneven = {"pinion": gf.Flank(pitch=gf.random_pitch(pair.gear_1, 6, seed=3))}
turn = gf.transmission_error(pair, [3000.0], steel, flanks=uneven, phases=np.arange(24 * 16) / 16)
print(f"over a revolution of the pinion: {1e6 * turn.peak_to_peak[0]:.1f} um, one cycle: {1e6 * plain.peak_to_peak[2]:.1f} um")

# %%
# Excitation of a dynamic model
# -----------------------------
# The mesh force is ``k(phase) (x - e(phase))``. With the secant stiffness, ``e`` is the *unloaded* error, because the loaded one
# would count the deflection twice. ``mesh_excitation`` returns both. At low speed, the machine follows the transmission error:

curve = relieved.curves[2]
stiffness, error = gf.mesh_excitation(curve)
machine = gf.single_mesh(0.5, stiffness, 5.0, force=3000.0, zeta=0.3)
machine = gf.with_errors(machine, profile={"mesh": error})
run = gf.simulate(machine, 0.4, rate=320.0, step=4e-5, error=False, filtered=False)
away = np.abs(run["pair.x"][64:128] - curve.te).max()
print(f"largest difference from the transmission error: {100 * away / np.ptp(plain.te[2]):.1f} % of the involutes' peak-to-peak")
