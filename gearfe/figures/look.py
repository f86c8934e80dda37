"""Line styles of all pictures, with dashes and colours for colour-blind readers, and an empty picture."""

import io
from functools import partial
from typing import Any

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#555555")
GEARS = ("#b9c7d6", "#d6cbb9")  # bodies of pinion and wheel
DASHES = ("-", (0, (6, 2)), (0, (1.5, 1.5)), (0, (6, 2, 1.5, 2)), (0, (3, 1)), (0, (8, 2, 1.5, 2, 1.5, 2)), (0, (1, 3)))
MARKS = ("o", "s", "^", "D", "v", "P", "X")
SQUASHED = 0.3  # ratio of the lowest to the largest value above which the axis does not start at zero


def look(number):
    """Return colour and dashes of the line of this number for matplotlib."""
    return {"color": COLOURS[number % len(COLOURS)], "linestyle": DASHES[number % len(DASHES)]}


def blank(size: tuple[float, float], *rows: int, **options: Any) -> tuple[Any, Any]:
    """Return an empty figure of a size [inch], and its axes from matplotlib's ``Figure.subplots``."""
    from matplotlib.figure import Figure

    figure: Any = Figure(figsize=size, layout="constrained")
    figure._repr_png_ = partial(_png, figure)  # Notebooks display this image as the value of a cell.
    return figure, figure.subplots(*rows, **options)


def _png(figure):
    """Bytes of a figure as PNG."""
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=100)
    return file.getvalue()
