"""Picture (matplotlib) of the contact of a pair on its flank: lines of one phase, or the pattern of a whole cycle."""

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..core.files import save_figure
from ..geometry.damage.hollow import flank_edge
from ..geometry.damage.pit import Pit
from ..geometry.pair.gear_pair import GearPair
from .look import blank

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..contact.wide_contact import Contact3D

PLACES = 400  # number of places along the width for the load of a cycle


def plot_contact(
    pair: GearPair,
    contact: "Contact3D",
    phase: int | None = 0,
    path: str | os.PathLike[str] | None = None,
    pits: Sequence[Pit] = (),
    title: str = "",
) -> "Figure":
    """Draw the contact lines on the unrolled flank, coloured by Hertzian pressure, and the load along the width below.

    A tip corner or an end face with the largest load is marked as edge contact, whose pressure is beyond Hertz's theory.

    Parameters
    ----------
    pair : GearPair
    contact : gearfe.contact.wide_contact.Contact3D
        Result of `gearfe.contact_pattern`.
    phase : int, optional
        Number of the phase; None: all of them together, the contact pattern.
    path : path, optional
        Picture file; its suffix decides (png, svg, pdf).
    pits : sequence of Pit
        Pits of the pinion; they interrupt only the line of their tooth pair.
    title : str
        Title: scene, pair, case.
    """
    if phase is not None and not -len(contact.cells) <= phase < len(contact.cells):
        raise ValueError(f"phase = {phase}, but there are {len(contact.cells)} phases, numbered from 0")
    figure, (top, bottom) = blank((9, 5.5), 2, 1, sharex=True, height_ratios=[3, 2])
    shown = range(len(contact.cells)) if phase is None else [phase]
    drawn = _draw_lines(top, pair, [contact.cells[i] for i in shown])
    offset = (pair.gear_1.b - pair.b_w) / 2
    for pit in pits:
        z, radius = flank_edge(pair.gear_1, pit)
        nouns = " and ".join(dict.fromkeys(hollow._nouns[1] for hollow in pits))
        label = {"label": f"{nouns}, on pair {pit.tooth:+d} only"} if pit is pits[0] else {}
        top.fill(z - offset, radius, facecolor="0.85", edgecolor="black", linewidth=0.9, zorder=1, **label)
    for limit, name in ((pair.gear_1.r_form, "form circle"), (pair.gear_1.r_a, "tip circle")):
        top.axhline(limit, color="gray", linewidth=0.8)
        top.annotate(name, (0.005, limit), xycoords=("axes fraction", "data"), fontsize=7, color="gray", va="bottom")
    top.set_ylabel("contact radius on the pinion [mm]")
    force = contact.load[shown[0]].sum()
    subject = (
        f"contact pattern of {len(contact.cells)} phases" if phase is None else f"contact lines, phase {contact.phase[phase]:.3g}"
    )
    where = f"{subject}, {force:.0f} N in the transverse plane"
    top.set_title(f"{title}: {where}" if title else where, fontsize=10)
    figure.colorbar(drawn, ax=top, label="Hertz pressure [MPa]")
    if phase is None:
        _draw_envelope(bottom, contact.cells)
    else:
        _draw_loads(bottom, contact.cells[phase])
    bottom.set_ylim(0, 1.08 * bottom.dataLim.ymax)
    bottom.set_xlabel("along the width [mm]")
    figure.legend(fontsize=8, loc="outside lower center", ncol=6)
    return save_figure(figure, path, dpi=110)


def _draw_lines(axes, pair, shown):
    """Draw loaded pieces of contact lines coloured by pressure, unloaded ones grey, and edges with the largest load."""
    from matplotlib.collections import LineCollection

    segments, pressures, edges = [], [], {"tip corner": [], "end face": []}
    for cells in shown:
        for at in _lines_of(cells):
            z, radius = cells.z[at], np.hypot(pair.gear_1.r_b, cells.roll_1[at])
            ends = np.array([z - cells.width[at] / 2, z + cells.width[at] / 2])
            along = np.interp(ends, z, radius)
            segments += [[(a, r), (b, s)] for a, b, r, s in zip(*ends, *along, strict=True)]
            loaded = cells.load[at] > 0
            pressures.append(np.where(loaded, cells.pressure[at], -1.0))
            corner = loaded & (cells.corner[at] > 0)
            edges["tip corner"] += list(zip(z[corner], radius[corner], strict=True))
        edges["end face"] += [(z, float(np.hypot(pair.gear_1.r_b, roll))) for z, roll in cells.at_ends(pair)]
    thick, pressure = 5 if len(shown) == 1 else 2, np.concatenate(pressures)
    idle = LineCollection([segments[i] for i in np.flatnonzero(pressure < 0)], color="0.85", linewidths=thick, zorder=1)
    drawn = LineCollection(segments, cmap="viridis", linewidths=thick, zorder=2)
    drawn.set_array(np.where(pressure < 0, np.nan, pressure))
    drawn.set_clim(0.0, max(np.nanmax(pressure), 1.0))
    axes.add_collection(idle)
    axes.add_collection(drawn)
    if idle.get_segments():
        axes.plot([], [], color="0.85", linewidth=thick, label="without load")
    for (name, places), (mark, colour) in zip(edges.items(), ((".", "#d55e00"), ("s", "#cc79a7")), strict=True):
        if places:
            axes.plot(*np.array(places).T, mark, color=colour, markersize=3, zorder=3, label=f"edge contact: {name}")
    axes.autoscale_view()
    return drawn


def _draw_loads(axes, cells):
    colours = [f"C{k}" for k in range(10)]
    for at in (line for line in _lines_of(cells) if cells.load[line].any()):
        order = int(cells.order[at[0]])
        z, load = _stairs(cells.z[at], cells.width[at], cells.load[at] / cells.width[at])
        named = f"pair {order:+d}" if f"pair {order:+d}" not in axes.get_legend_handles_labels()[1] else None
        axes.plot(z, load, color=colours[order % 10], linewidth=1.3, label=named)
    axes.set_ylabel("load [N/mm]")


def _draw_envelope(axes, shown):
    """Draw the largest load along the width over all lines and phases."""
    edges = [(c.z - c.width / 2, c.z + c.width / 2, c.load / c.width) for c in shown]
    low, high, line = (np.concatenate(part) for part in zip(*edges, strict=True))
    z = np.linspace(low.min(), high.max(), PLACES)
    largest = [float(line[(low <= at) & (high >= at)].max(initial=0.0)) for at in z]
    axes.plot(z, largest, color="C0", linewidth=1.3)
    axes.set_ylabel("largest load [N/mm]")


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
