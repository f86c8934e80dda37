"""Pictures of sweeps: percentile bands of curves, and how two states of a gear lie over each other."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..files import save_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = ("#0072b2", "#e69f00", "#cc3311", "#009e73")  # told apart by the colour-blind, too


def plot_states(
    curves: dict[str, tuple[NDArray, NDArray]],
    values: dict[str, NDArray],
    path: str | Path | None = None,
    *,
    labels: tuple[str, str, str] = ("mesh phase", "k [N/um]", "mean k [N/um]"),
) -> "Figure":
    """Bands of curves beside histograms of a number, by state of the gear.

    Parameters
    ----------
    curves : dict of str to (ndarray, ndarray)
        By state: places ``(n,)``, and low, middle and high percentile ``(3, n)``.
    values : dict of str to ndarray
        By state: a number of each machine.
    path : str or path, optional
    labels : (str, str, str)
        Of the places, the curves and the number.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for (state, (place, low_middle_high)), colour in zip(curves.items(), COLOURS, strict=False):
        low, middle, high = low_middle_high
        left.fill_between(place, low, high, color=colour, alpha=0.3, linewidth=0)
        left.plot(place, middle, color=colour, label=state)
    edges = np.histogram_bin_edges(np.concatenate(list(values.values())), 40)
    for (state, own), colour in zip(values.items(), COLOURS, strict=False):
        right.hist(own, edges, color=colour, alpha=0.5, label=state, density=True)
    left.set(xlabel=labels[0], ylabel=labels[1])
    right.set(xlabel=labels[2], yticks=[], ylabel="machines")
    left.legend(frameon=False)
    right.legend(frameon=False)
    return save_figure(figure, path, 150)
