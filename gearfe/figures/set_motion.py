"""Animation (matplotlib) of a planetary set, deformed under its load while it rotates."""

import math
import os
from pathlib import Path
from typing import Any

import numpy as np

from ..core.files import checked_dpi, new_file, written
from ..core.steps import steps
from ..geometry.aliases import Floats, StrPath
from .set_plot import BRIGHT, LARGEST, draw_set

SUFFIX = ".gif"
AROUND = 1.08  # size of the frames relative to the set's radius


def check_moving(path: Any) -> None:
    """Raise ValueError if an animation cannot be written to `path`. Call it before work begins."""
    if not isinstance(path, (str, os.PathLike)) or Path(path).suffix.lower() != SUFFIX:
        raise ValueError(f"{path!r} is no animation file: give a name that ends in {SUFFIX}")
    if os.path.isdir(path):
        raise ValueError(f"cannot write {path}: it is a folder; give the name of a file")
    os.unlink(new_file(path))  # The check raises an error if the file cannot be created.


def draw_motion(
    positions: list[tuple[list[Any], Floats | None]],
    path: StrPath,
    *,
    magnified: float | None,
    rate: int,
    dpi: int,
) -> None:
    """Draw the animation of `gearfe.planetary_sets.animation.animate_planetary_set` from `positions` of `loaded_shapes`.

    `rate` is in frames per second. Magnification, colours and the visible range are the same in all frames.
    """
    from matplotlib.animation import PillowWriter

    every = [shape for shapes, _ in positions for shape in shapes]
    radius = max(float(np.hypot(*one.place).max()) for one in every)
    largest = max(float(np.hypot(*one.moved).max()) for one in every)
    top = max(float(np.percentile(one.stress, BRIGHT)) for one in every)
    times = magnified or 10 ** math.floor(math.log10(LARGEST * radius / largest)) * 2
    reach = AROUND * (radius + times * largest)
    writer, dpi = PillowWriter(fps=rate), checked_dpi(dpi)
    with written(path) as name:
        for i, (shapes, supports) in enumerate(steps(positions)):
            figure = draw_set(shapes, supports, None, magnified=times, dpi=dpi)
            (axes, _) = figure.axes
            axes.set(xlim=(-reach, reach), ylim=(-reach, reach), title=f"displacements {times:g} times as large")
            for drawn in axes.collections:
                drawn.set_clim(0, top)
            if not i:
                writer.setup(figure, name, dpi)
            writer.fig = figure
            writer.grab_frame()
        writer.finish()
