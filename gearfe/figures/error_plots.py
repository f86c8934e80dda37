"""Plots (matplotlib) of the transmission error over the phase at several loads, and of its peak-to-peak value over load."""

import numpy as np

from ..core.files import save_figure
from .look import COLOURS, blank
from .stiffness_plots import periodic, told


def plot_transmission_error(found, path=None, title=None, plain=None):
    """Draw a `gearfe.stiffness.transmission_error.TransmissionError`. Save to `path` (png, svg, pdf) if given.

    Each curve is drawn without its mean, which the legend states.
    The `title` is by default teeth, damage and width, see `gearfe.figures.stiffness_plots.told`. `plain` is the
    transmission error of the same pair with unmodified involutes. Its peak-to-peak value is drawn too.
    """
    from matplotlib import colormaps

    figure, (top, bottom) = blank((8, 6.5), 2, 1, height_ratios=[2, 1])
    order = np.argsort(found.force)[::-1]
    # The restricted colour range keeps lines of light loads visible on white.
    colours = colormaps["plasma"](np.linspace(0.0, 0.62, order.size))
    for i, colour in zip(order.tolist(), colours, strict=True):
        phase, te = _closed(found, found.te[i])
        mean = 1e6 * found.te[i].mean()
        top.plot(phase, 1e6 * te - mean, color=colour, label=f"{found.force[i]:g} N (mean {mean:.3g} µm)")
    phase, te = _closed(found, found.unloaded)
    top.plot(phase, 1e6 * (te - found.unloaded.mean()), color="black", linestyle=":", label="unloaded")
    top.set_title(told(found.curves[0], load=False) if title is None else title, fontsize=10)
    top.set_xlabel("mesh phase (0: a pair enters, 1: one base pitch later)")
    top.set_ylabel("transmission error less its mean [µm]")
    top.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    rising, swing = order[::-1], 1e6 * found.peak_to_peak
    bottom.plot(
        found.force[rising], swing[rising], "o-", color=COLOURS[0], label="under load" if plain is None else "modified flanks"
    )
    if plain is not None:
        bottom.plot(plain.force[rising], 1e6 * plain.peak_to_peak[rising], "s--", color=COLOURS[1], label="plain involutes")
    bottom.axhline(1e6 * np.ptp(found.unloaded), color="black", linestyle=":", label="unloaded")
    bottom.set(xlim=(0, None), ylim=(0, None))
    bottom.set(xlabel="force along the line of action [N]", ylabel="peak-to-peak [µm]")
    bottom.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    return save_figure(figure, path, dpi=120)


def _closed(found, values):
    """Return one mesh cycle with its first point repeated at the end. Other phases and unequal teeth are unchanged."""
    phase = found.phase
    if all(map(periodic, found.curves)) and phase.size > 1 and (np.diff(phase) > 0).all() and phase[-1] < phase[0] + 1:
        return np.append(phase, phase[0] + 1), np.append(values, values[0])
    return phase, values
