"""Plots (matplotlib) of stiffness: curves, error maps, contact lines."""

import math
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from geometry.damage.pit import Pit, centre_arc
from geometry.pair.gear_pair import GearPair
from geometry.tooth.profile import roll_at_arc

from ..files import save_figure
from ..units import NEWTON_PER_UM

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..contact.solid import Contact3D


COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#555555")  # apart for the colour-blind
DASHES = ("-", (0, (6, 2)), (0, (1.5, 1.5)), (0, (6, 2, 1.5, 2)), (0, (3, 1)), (0, (8, 2, 1.5, 2, 1.5, 2)), (0, (1, 3)))
SQUASHED = 0.3  # lowest over largest stiffness from which on an axis from zero would waste the picture
COLUMNS = {  # of an error map
    "load": "load F / (b m_n) [MPa]",
    "bore_1": "pinion bore / root radius",
    "bore_2": "wheel bore / root radius",
    "z_1": "teeth of the pinion",
    "z_2": "teeth of the wheel",
    "crack": "crack level",
}


def plot_curves(curves, path=None, title=None):
    """Draw stiffness curves over the phase [N/um], the load shares of the first below; save to `path` if given.

    Curves differ by colour and by dashes. A jump, where a curve without contact off the path of contact gains or loses a pair,
    is drawn at its phase. The axis of stiffness starts at zero unless that would squash the curves.

    Parameters
    ----------
    curves : dict of str to StiffnessCurve
    path : path, optional
        Picture file; its suffix decides (png, svg, pdf).
    title : str, optional
        Default: teeth, damage and load of the first curve, see `told`.

    Returns
    -------
    matplotlib.figure.Figure
        Its ``axes`` are two.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.5, 5.4), layout="constrained")
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=[2, 1])
    for number, (name, curve) in enumerate(curves.items()):
        look = {"color": COLOURS[number % len(COLOURS)], "linestyle": DASHES[number % len(DASHES)]}
        top.plot(*closed(curve), label=name, linewidth=1.8 if number == 0 else 1.4, **look)
    first = next(iter(curves.values()))
    share = np.where(first.force > 0, first.share, np.nan)
    for column, order in enumerate(first.order):
        look = {"color": COLOURS[column % len(COLOURS)], "linestyle": DASHES[column % len(DASHES)]}
        bottom.plot(first.phase, share[:, column], label=f"pair {order:+d}", **look)
    k = np.concatenate([curve.k for curve in curves.values()]) / NEWTON_PER_UM
    if k.min() < SQUASHED * k.max():
        top.set_ylim(0, 1.06 * k.max())
    top.set_title(told(first) if title is None else title, fontsize=10)
    top.set_ylabel("mesh stiffness k [N/µm]")
    top.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    bottom.set_ylabel(f"load share ({next(iter(curves))})")
    bottom.set_xlabel("mesh phase (0: a pair enters, 1: one base pitch later)")
    bottom.set_ylim(0, 1.05)
    bottom.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    return save_figure(figure, path, dpi=120)


def told(curve):
    """Teeth, damage, load and width of a curve in one line, as far as its `meta` has them."""
    meta = curve.meta
    parts = []
    if "gear_1" in meta and "gear_2" in meta:
        parts.append(f"z = {meta['gear_1']['z']} / {meta['gear_2']['z']}")
    hurt = {side: len(found) for side, found in meta.get("damage", {}).items() if found}
    parts += [f"{number} damage{'s' if number > 1 else ''} of the {side}" for side, number in hurt.items()]
    if "force_N" in meta and "width_mm" in meta:
        parts.append(f"{meta['force_N']:g} N on {meta['width_mm']:g} mm")
    return ", ".join(parts)


def closed(curve):
    """Phases and stiffness [N/um] as they are drawn: one cycle closed, jumps upright.

    Returns
    -------
    phase, k : ndarray, shape (m,)
    """
    phase, k, order = curve.phase, curve.k / NEWTON_PER_UM, np.arange(curve.phase.size)
    rises = phase.size > 1 and bool((np.diff(phase) > 0).all())
    if rises and phase[-1] < phase[0] + 1 and phase[-1] - phase[0] > 0.75:  # one cycle: close it
        phase, order = np.append(phase, phase[0] + 1), np.append(order, 0)
    k = k[order]
    meta = curve.meta
    smooth = meta.get("extended", not np.isfinite(curve.force).all()) or meta.get("face") in ("helical", "herringbone")
    if not rises or smooth or "eps_alpha" not in meta or phase.size < 4:
        return phase, k
    whole = np.arange(math.floor(phase[0]), math.ceil(phase[-1]) + 1)
    places = np.concatenate([whole, whole + meta["eps_alpha"] % 1])  # a pair enters, a pair leaves
    for place in np.sort(places[(places > phase[0]) & (places <= phase[-1])])[::-1]:
        after = int(np.searchsorted(phase, place - 1e-9))
        if after < phase.size - 1 and abs(phase[after] - place) < 1e-9:  # a pair that enters is there, one that leaves still is
            after += int(place not in whole)
        before = after - 1
        left = _extended(phase, k, (before - 1, before), place)
        right = _extended(phase, k, (after, after + 1), place)
        phase, k = np.insert(phase, after, [place, place]), np.insert(k, after, [left, right])
    return phase, k


def _extended(phase, k, rows, place):
    """Straight line through two samples at `place`; beside the ends of the curve the nearer sample."""
    a, b = rows
    if a < 0 or b >= phase.size or phase[a] == phase[b]:
        return k[min(max(a, 0), phase.size - 1)] if a >= 0 else k[b]
    return k[a] + (k[b] - k[a]) / (phase[b] - phase[a]) * (place - phase[a])


def plot_map(found, formulations, x, y, zone, path=None, bins=8):
    """Heat maps of the median error over two columns of an `gearfe.studies.errormap.ErrorMap`, one for each formulation.

    Columns with few different values (loads) get one bin each, others `bins` of equal width.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(3.4 * len(formulations) + 1, 3.4), layout="constrained")
    row = figure.subplots(1, len(formulations), sharex=True, sharey=True, squeeze=False)[0]
    (place_x, names_x), (place_y, names_y) = (_binned(found.columns[name], bins) for name in (x, y))
    for axes, name in zip(row, formulations, strict=True):
        error = 100 * found.columns[f"{name} {zone}"]
        table = np.full((len(names_y), len(names_x)), np.nan)
        for i in range(len(names_y)):
            for j in range(len(names_x)):
                here = error[(place_x == j) & (place_y == i) & np.isfinite(error)]
                table[i, j] = np.median(here) if here.size else np.nan
                if here.size:
                    color = "white" if abs(table[i, j]) > 20 else "black"
                    axes.text(j, i, f"{table[i, j]:+.0f}", ha="center", va="center", fontsize=7, color=color)
        image = axes.imshow(table, cmap="RdBu_r", vmin=-30, vmax=30, origin="lower", aspect="auto")
        axes.set_title(name, fontsize=9)
        axes.set_xlabel(COLUMNS.get(x, x), fontsize=9)
        axes.set_xticks(range(len(names_x)), names_x, fontsize=7)
        axes.set_yticks(range(len(names_y)), names_y, fontsize=7)
    row[0].set_ylabel(COLUMNS.get(y, y), fontsize=9)
    figure.colorbar(image, ax=row, label=f"median error of k, {zone} [%]")
    return save_figure(figure, path, dpi=100)


def _binned(values, bins):
    """Bin of every value, and the names of the bins."""
    few = np.unique(values)
    if few.size <= bins:
        return np.searchsorted(few, values), [f"{v:g}" for v in few]
    edges = np.linspace(values.min(), values.max(), bins + 1)
    return np.clip(np.digitize(values, edges) - 1, 0, bins - 1), [f"{v:.3g}" for v in (edges[1:] + edges[:-1]) / 2]


def plot_errors(errors, rows, columns, path=None, largest=30.0):
    """Heat maps of errors in percent, one below the other, each with its numbers in it.

    Parameters
    ----------
    errors : dict of str to ndarray, shape (len(rows), len(columns))
        By title [-].
    rows, columns : sequence of str
    path : path, optional
    largest : float
        Error of the darkest colours [%].
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(2.5 + 0.62 * len(columns), len(errors) * (1.1 + 0.24 * len(rows))), layout="constrained")
    for axes, (title, values) in zip(figure.subplots(len(errors), 1, squeeze=False)[:, 0], errors.items(), strict=True):
        image = axes.imshow(100 * values, cmap="RdBu_r", vmin=-largest, vmax=largest, aspect="auto")
        for (i, j), value in np.ndenumerate(100 * values):
            color = "white" if abs(value) > 0.7 * largest else "black"
            axes.text(j, i, f"{value:+.1f}", ha="center", va="center", fontsize=7, color=color)
        axes.set_title(title, fontsize=9)
        axes.set_yticks(range(len(rows)), rows, fontsize=7)
        axes.set_xticks(range(len(columns)), columns, fontsize=7, rotation=30, ha="right")
        figure.colorbar(image, ax=axes, label="error [%]")
    return save_figure(figure, path, dpi=100)


def plot_lengths(phase, lengths, others=None, path=None):
    """Lengths of contact lines [mm] over the phase, by case; `others` dashed in the same colours."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 3.5), layout="constrained")
    axes = figure.subplots()
    for name, length in lengths.items():
        (drawn,) = axes.plot(phase, length, label=name)
        if name in (others or {}):
            axes.plot(phase, others[name], "--", color=drawn.get_color(), linewidth=0.8)
    axes.set_xlabel("mesh phase (0: the pitted tooth enters)")
    axes.set_ylabel("contact line [mm]")
    axes.set_ylim(bottom=0)
    axes.legend(fontsize=8)
    return save_figure(figure, path, dpi=100)


def plot_contact(
    pair: GearPair,
    contact: "Contact3D",
    phase: int = 0,
    path: str | os.PathLike[str] | None = None,
    pits: Sequence[Pit] = (),
    title: str = "",
) -> "Figure":
    """Contact lines of one phase on the unrolled flank, coloured by Hertz's pressure, and the load along the width below.

    Parameters
    ----------
    pair : GearPair
    contact : gearfe.contact.solid.Contact3D
    phase : int
        Which of its phases.
    path : path, optional
        Picture file; its suffix decides (png, svg, pdf).
    pits : sequence of Pit
        Of the pinion, to be drawn; only the line of their own tooth pair is cut by them.
    title : str
        What is shown: scene, pair, case.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure

    cells, gear = contact.cells[phase], pair.gear_1
    offset = (gear.b - min(gear.b, pair.gear_2.b)) / 2
    figure = Figure(figsize=(9, 5.5), layout="constrained")
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=[3, 2])
    segments, colours = [], [f"C{k}" for k in range(10)]
    for at in _lines_of(cells):
        z, radius = cells.z[at], np.hypot(gear.r_b, cells.roll_1[at])
        ends = np.array([z - cells.width[at] / 2, z + cells.width[at] / 2])
        along = np.interp(ends, z, radius)
        segments += [[(a, r), (b, s)] for a, b, r, s in zip(*ends, *along, strict=True)]
    drawn = LineCollection(segments, cmap="viridis", linewidths=5, zorder=2)
    drawn.set_array(np.concatenate([cells.pressure[at] for at in _lines_of(cells)]))
    top.add_collection(drawn)
    for pit in pits:
        z, radius = _pit_edge(gear, pit)
        label = {"label": f"pits, on pair {pit.tooth:+d} only"} if pit is pits[0] else {}
        top.fill(z - offset, radius, facecolor="0.85", edgecolor="black", linewidth=0.9, zorder=1, **label)
    for limit, name in ((gear.r_form, "form circle"), (gear.r_a, "tip circle")):
        top.axhline(limit, color="gray", linewidth=0.8)
        top.annotate(name, (0.005, limit), xycoords=("axes fraction", "data"), fontsize=7, color="gray", va="bottom")
    top.set_ylabel("contact radius on the pinion [mm]")
    force = contact.load[phase].sum()
    where = f"contact lines, phase {contact.phase[phase]:.3g}, {force:.0f} N in the transverse plane"
    top.set_title(f"{title}: {where}" if title else where, fontsize=10)
    figure.colorbar(drawn, ax=top, label="Hertz pressure [MPa]")
    for at in _lines_of(cells):
        order = int(cells.order[at[0]])
        z, load = _stairs(cells.z[at], cells.width[at], cells.load[at] / cells.width[at])
        named = f"pair {order:+d}" if f"pair {order:+d}" not in bottom.get_legend_handles_labels()[1] else None
        bottom.plot(z, load, color=colours[order % 10], linewidth=1.3, label=named)
    bottom.set_ylabel("load [N/mm]")
    bottom.set_ylim(bottom=0)
    bottom.set_xlabel("along the width [mm]")
    figure.legend(fontsize=8, loc="outside lower center", ncol=6)
    return save_figure(figure, path, dpi=110)


def _lines_of(cells):
    """Cells of each contact line along the width."""
    keys = [(order, half) for order in np.unique(cells.order) for half in np.unique(cells.half)]
    lines = [np.flatnonzero((cells.order == order) & (cells.half == half)) for order, half in keys]
    return [at[np.argsort(cells.z[at])] for at in lines if at.size]


def _stairs(z, width, value):
    """Corners of a function that is constant on intervals and zero between them."""
    low, high = z - width / 2, z + width / 2
    place, height = [low[0]], [0.0]
    for k in range(z.size):
        if k and low[k] - high[k - 1] > 1e-6 * width[k]:
            place += [high[k - 1], low[k]]
            height += [0.0, 0.0]
        place += [low[k], high[k]]
        height += [value[k], value[k]]
    return np.array([*place, high[-1]]), np.array([*height, 0.0])


def _pit_edge(gear, pit):
    """Heights [mm] and radii [mm] of a pit's edge."""
    turn = np.linspace(0, 2 * np.pi, 90)
    p, q = pit.axes[0] * np.cos(turn), pit.axes[1] * np.sin(turn)
    u = p * np.cos(pit.angle) - q * np.sin(pit.angle)
    w = p * np.sin(pit.angle) + q * np.cos(pit.angle)
    return pit.z + w, np.hypot(gear.r_b, roll_at_arc(gear, centre_arc(gear, pit) + u))
