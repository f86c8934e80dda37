"""Pictures (matplotlib) of a planetary set: deformed under its load, and loads and stiffness of its meshes."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.files import save_figure
from ..core.units import NEWTON_PER_UM
from ..geometry.aliases import Floats, StrPath
from .look import COLOURS, DASHES, blank

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LARGEST = 0.03  # default size of the largest drawn displacement, relative to the set's radius
BRIGHT = 99.5  # percentile of the stress at the end of the colour scale, because the stress at point loads has no finite maximum


def draw_set(
    shapes: list[Any],
    supports: Floats | None,
    path: StrPath | None,
    *,
    magnified: float | None,
    dpi: int,
) -> "Figure":
    """Draw `shapes` of `gearfe.planetary_sets.shape.plot_planetary_set`, and mark supports at `supports` ``(2, n)`` [mm]."""
    from matplotlib.tri import Triangulation

    radius = max(float(np.abs(shape.place).max()) for shape in shapes)
    largest = max(float(np.hypot(*shape.moved).max()) for shape in shapes)
    times = magnified or 10 ** math.floor(math.log10(LARGEST * radius / largest)) * 2
    figure, axes = blank((8, 8))
    top = max(float(np.percentile(shape.stress, BRIGHT)) for shape in shapes)
    for body in shapes:
        x, y = body.place + times * body.moved
        corners = np.concatenate([body.triangles[[0, 3, 5]], body.triangles[[3, 1, 4]], body.triangles[[5, 4, 2]],
                                  body.triangles[[3, 4, 5]]], axis=1)  # fmt: skip
        mesh = Triangulation(x, y, corners.T)
        drawn = axes.tripcolor(mesh, body.stress, cmap="viridis", vmin=0, vmax=top, shading="gouraud", rasterized=True)
    if supports is not None:
        axes.plot(*supports, "^", color=COLOURS[1], markersize=9, label="held")
        axes.legend(loc="upper right", fontsize=9)
    figure.colorbar(drawn, ax=axes, label="von Mises stress [MPa]", shrink=0.7)
    axes.set(aspect="equal", title=f"displacements {times:g} times as large, at most {1e3 * largest:.3g} um")
    axes.set_axis_off()
    return save_figure(figure, path, dpi)


def draw_curves(curves: Any, path: StrPath | None, *, dpi: int) -> "Figure":
    """Draw the picture of `gearfe.planetary_sets.curves.SetCurves.plot`."""
    figure, (above, middle, below) = blank((9, 8), 3, sharex=True)
    for planet in range(curves.force.shape[2]):
        for inner, name in enumerate(("sun", "ring")):
            label = f"planet {planet + 1}, {name}"
            line = {"color": COLOURS[planet % len(COLOURS)], "linestyle": DASHES[inner]}
            above.plot(curves.position, curves.k[inner, :, planet] / NEWTON_PER_UM, label=label, **line)
            if not inner:
                middle.plot(curves.position, curves.share[inner, :, planet], label=f"planet {planet + 1}", **line)
    for inner in (0, 1):
        above.plot(curves.position, curves.k_alone[inner, :, 0] / NEWTON_PER_UM, color="gray", linestyle=DASHES[inner],
                   label=f"alone, {('sun', 'ring')[inner]}")  # fmt: skip
    below.plot(curves.position, 1e6 * curves.te, color=COLOURS[0])
    above.set(ylabel="k [N/um]")
    middle.set(ylabel="share of the load, times planets", ylim=(0, 1.1 * float(curves.share[0].max())))
    below.set(ylabel="transmission error [um]", xlabel="turn of the sun [pitches]")
    figure.legend(*above.get_legend_handles_labels(), fontsize=8, ncols=4, loc="outside upper center")
    return save_figure(figure, path, dpi)
