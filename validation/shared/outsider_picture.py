"""The picture of contact pressure beside that of CalculiX, from the tables of `validation.shared.outsider`."""

import math

import numpy as np

from gearfe.contact.solid import pair_stiffness3d
from gearfe.files import written
from geometry.tooth.profile import arc_at

from .outsider import LOAD, PRESSURE, SHOWN, STEEL, cases

SHOWN_PART = 0.95  # of the places under pressure: one at the tip corner would hide all others


def picture(path):
    """Contact pressure on the unrolled flank of the pinion, all its teeth laid over each other: CalculiX left, `ritz3d` right.

    Each scale ends where `SHOWN_PART` of the places under pressure are below; the titles say both.
    """
    from matplotlib.figure import Figure

    case = cases()[SHOWN]
    gear, b = case.pair.gear_1, case.pair.gear_1.b
    place = np.meshgrid(np.linspace(0.0, b, 241), np.linspace(arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a), 321))
    both = theirs_at(*place), ours_at(case, *place)
    figure = Figure(figsize=(10, 4.2), layout="constrained")
    for axes, values, name in zip(figure.subplots(1, 2, sharey=True), both, ("CalculiX, at its nodes", "ritz3d"), strict=True):
        end = np.quantile(values[values > 0], SHOWN_PART)
        drawn = axes.pcolormesh(*place, values, vmin=0.0, vmax=end, cmap="viridis", rasterized=True)
        figure.colorbar(drawn, ax=axes, label="contact pressure [MPa]", extend="max")
        axes.set_title(f"{name}: up to {values.max():.0f} MPa, scale to {end:.0f}", fontsize=10)
        axes.set_xlabel("along the width [mm]")
    figure.axes[0].set_ylabel("arc along the pinion's flank [mm]")
    with written(path) as name:
        figure.savefig(name, dpi=130)


def theirs_at(z, arc):
    """CalculiX's pressure [MPa] at places of the pinion's flank, linear between nodes."""
    from scipy.interpolate import LinearNDInterpolator

    _, order, at, height, pressure = np.loadtxt(PRESSURE, delimiter=",", skiprows=1, unpack=True)
    found = [LinearNDInterpolator(np.array([height, at]).T[order == k], pressure[order == k])(z, arc) for k in np.unique(order)]
    return np.nan_to_num(np.array(found)).max(axis=0)


def ours_at(case, z, arc):
    """Pressure of `ritz3d` [MPa] at the same places: Hertz's ellipse across each cell of the contact lines."""
    found = pair_stiffness3d(case.pair, LOAD * case.pair.gear_1.b, STEEL, [case.phase]).cells[0]
    depth, out = found.z, np.zeros(z.shape)
    for order in np.unique(found.order):
        own = np.flatnonzero((found.order == order) & (found.load > 0) & np.isfinite(found.pressure))
        if not own.size:
            continue
        near = own[np.abs(depth[own, None] - z[0]).argmin(axis=0)]
        inside = np.abs(depth[near] - z[0]) <= found.width[near]
        half = 2 * found.load[near] * math.cos(case.pair.gear_1.beta_b) / found.width[near] / (math.pi * found.pressure[near])
        away = (arc - arc_at(case.pair.gear_1, found.roll_1[near])) / half
        height = np.where(inside, found.pressure[near], 0.0)
        out = np.maximum(out, height * np.sqrt(np.maximum(1 - away**2, 0.0)))
    return out
