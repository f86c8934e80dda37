"""Plot (matplotlib) of a Campbell diagram."""

import os
from typing import TYPE_CHECKING

import numpy as np

from ..core.files import save_figure
from .look import COLOURS, blank

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..dynamics.machine.campbell import Campbell


def plot_campbell(
    found: "Campbell", path: str | os.PathLike[str] | None = None, *, top: float | None = None, dpi: int = 120
) -> "Figure":
    """Draw natural frequencies, orders and their crossings over the speed. Save to `path` if given.

    Parameters
    ----------
    found : Campbell
    path : path, optional
    top : float, optional
        Largest frequency [Hz]; default: that of the highest order at the highest speed.
    dpi : int
        Dots per inch of the picture.
    """
    figure, axes = blank((9, 5))
    end = top or max(found.orders.values()) * found.speed[-1]
    axes.plot(found.speed, np.where(found.natural > 0, found.natural, np.nan), color=COLOURS[0], linewidth=1.0)
    for name, value in found.orders.items():
        axes.plot(found.speed, value * found.speed, color="gray", linewidth=0.8, linestyle="--")
        axes.annotate(name, (found.speed[-1], min(value * found.speed[-1], end)), fontsize=8, xytext=(3, 0),
                      textcoords="offset points", va="center", annotation_clip=False)  # fmt: skip
    met = [crossing for crossing in found.crossings if crossing.frequency <= end]
    axes.plot([point.speed for point in met], [point.frequency for point in met], "o", color=COLOURS[1], markersize=4)
    axes.set(xlabel="speed over that of the machine", ylabel="frequency [Hz]")
    axes.set(ylim=(0, end), xlim=(found.speed[0], found.speed[-1]))
    return save_figure(figure, path, dpi)
