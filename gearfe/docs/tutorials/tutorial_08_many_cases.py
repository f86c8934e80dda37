"""
8. Many cases
=============

A batch over all cores, and an error map over a sample of gears.
"""

# %%
# A batch
# -------
# Cases are dictionaries of arguments. The time of each case is recorded. An invalid case returns its error instead of a result,
# and the others continue.

from math import radians

import matplotlib.pyplot as plt

import gearfe as gf

steel = gf.Material(E=206e3, nu=0.3)


def pinion_and_wheel(shift, r_bore=10.0):
    """A pair with profile shifts of opposite sign."""
    rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
    return gf.GearPair(gf.Gear(z=20, r_bore=r_bore, x=shift, **rack), gf.Gear(z=40, r_bore=20.0, x=-shift, **rack))


shifts = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]
cases = [dict(pair=pinion_and_wheel(x), force=2000.0, material=steel, phases=32) for x in shifts]
done = gf.batch(cases, workers=1)  # leave `workers` out to use all cores
for shift, curve in zip(shifts, done.results, strict=True):
    print(f"x = {shift:.1f}: mean {curve.k.mean() / 1e6:6.1f}, largest {curve.k.max() / 1e6:6.1f} N/um")

# %%
figure, axes = plt.subplots(layout="constrained")
for shift, curve in zip(shifts, done.results, strict=True):
    axes.plot(curve.phase, curve.k / 1e6, label=f"x = {shift:.1f}")
axes.set_xlabel("phase")
axes.set_ylabel("k [N/µm]")
axes.legend()
axes.set_title("20/40 teeth, 2000 N on 20 mm, by profile shift")
figure.savefig("shifts.png")
plt.close(figure)

# %%
# An invalid case
# ---------------

(failed,) = gf.batch([dict(pair=cases[0]["pair"], force=-5.0, material=steel)], workers=1).results
print(f"{type(failed).__name__}: {failed}")

# %%
# Where may a formula be used?
# ----------------------------
# ``error_map`` draws random gears from a fixed seed and compares the closed forms with the converged energy model. Eight pairs
# are an example. The map in :doc:`/_made/validation/map` has many more.

found = gf.error_map(8, phases=12, workers=1)
for name in ("textbook", "herringbone_article", "coupled"):
    low, middle, high, _, rows = found.bands(name, crack=(0.0, 0.0))
    print(
        f"{name:10s} mean of k: {100 * low:+5.1f} / {100 * middle:+5.1f} / {100 * high:+5.1f} % at 5, 50 and 95 % of {rows} rows"
    )
