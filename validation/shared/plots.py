"""Pictures used only by validation pages: waves, phase portraits side by side, contact lines."""

import numpy as np
from matplotlib.figure import Figure

from gearfe.core.files import save_figure
from gearfe.figures.look import COLOURS, SQUASHED, look


def plot_waves(signals, path, *, title=""):
    """Draw the first quarter of a second of signals by name, below each other with one scale."""
    figure = Figure(figsize=(9, 1.7 * len(signals) + 0.4), layout="constrained")
    for axes, (name, one) in zip(
        np.atleast_1d(figure.subplots(len(signals), sharex=True, sharey=True)), signals.items(), strict=True
    ):
        values = one.values[: round(0.25 * one.rate)]
        axes.plot(np.arange(values.size) / one.rate, values, linewidth=0.7, color=COLOURS[0])
        axes.set_title(name, fontsize=9)
        axes.set_ylabel(one.unit)
    axes.set_xlabel("time [s]")
    figure.suptitle(title, fontsize=10)
    return save_figure(figure, path, dpi=60)


def plot_phases(portraits, unit="m", path=None, *, title=""):
    """Draw phase portraits with their Poincare points side by side, on common axes.

    Parameters
    ----------
    portraits : dict of str to ((ndarray, ndarray), ndarray)
        By case what `plot_phase` takes as portrait and section.
    unit : str
        Of the displacement.
    path : path, optional
    title : str
        What is shown: scene, channel.

    Returns
    -------
    matplotlib.figure.Figure
    """
    columns = min(3, len(portraits))
    rows = -(-len(portraits) // columns)
    figure = Figure(figsize=(3 * columns, 2.6 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for place, (name, ((x, v), points)) in zip(axes.flat, portraits.items(), strict=False):
        place.plot(x, v, linewidth=0.3, color=COLOURS[0])
        place.plot(*np.transpose(points), ".", color=COLOURS[1], markersize=4)
        place.set_title(name, fontsize=8)
        place.tick_params(labelsize=7)
        place.ticklabel_format(scilimits=(-2, 3))
        place.locator_params(axis="x", nbins=4)
        place.xaxis.get_offset_text().set_size(7)
    for place in axes.flat[len(portraits) :]:
        place.set_visible(False)
    figure.suptitle(title, fontsize=9)
    figure.supxlabel(f"displacement [{unit}]", fontsize=8)
    figure.supylabel(f"velocity [{unit}/s]", fontsize=8)
    return save_figure(figure, path, dpi=80)


def plot_lengths(phase, lengths, others=None, path=None, *, title="", told="otherwise"):
    """Plot lengths of contact lines [mm] over the phase by case. `others` are thin lines, which `told` describes."""
    figure = Figure(figsize=(7.5, 3.7), layout="constrained")
    axes = figure.subplots()
    for number, (name, length) in enumerate(lengths.items()):
        axes.plot(phase, length, label=name, **look(number))
        if name in (others or {}):
            axes.plot(phase, others[name], label=f"{name}, {told}", linewidth=0.7, **look(number))
    axes.set_xlabel("mesh phase (0: the pitted tooth enters)")
    axes.set_ylabel("contact line [mm]")
    axes.set_title(title, fontsize=10)
    if min(length.min() for length in lengths.values()) < SQUASHED * max(length.max() for length in lengths.values()):
        axes.set_ylim(bottom=0)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    return save_figure(figure, path, dpi=100)
