"""Small line pictures (SVG) for notebooks, drawn without matplotlib to save time."""

import math
from html import escape

import numpy as np

SIZE = (340, 130)  # size of the picture [px]
FRAME = (44, 8, 8, 30)  # margins: left, right, top, bottom [px]


def line_svg(x, y, x_name, y_name, *, largest=800):
    """Return an ``<svg>`` element of one line, y over x ``(n,)``, with labels at the axis ends and at most `largest` points."""
    x, y = (np.asarray(values, dtype=float)[:: max(1, math.ceil(len(values) / largest))] for values in (x, y))
    (wide, tall), (left, right, top, bottom) = SIZE, FRAME
    across, up = (_scale(v, length) for v, length in ((x, wide - left - right), (y, tall - top - bottom)))
    points = " ".join(f"{left + a:.1f},{tall - bottom - b:.1f}" for a, b in zip(across, up, strict=True) if math.isfinite(a + b))
    texts = [
        (left - 4, tall - bottom, "end", f"{np.nanmin(y):.4g}"),
        (left - 4, top + 8, "end", f"{np.nanmax(y):.4g}"),
        (left, tall - bottom + 12, "start", f"{np.nanmin(x):.3g}"),
        (wide - right, tall - bottom + 12, "end", f"{np.nanmax(x):.3g}"),
        ((left + wide - right) / 2, tall - 4, "middle", f"{y_name} over {x_name}"),
    ]
    labels = "".join(f'<text x="{a:.0f}" y="{b:.0f}" text-anchor="{where}">{escape(text)}</text>' for a, b, where, text in texts)
    box = f'x="{left}" y="{top}" width="{wide - left - right}" height="{tall - top - bottom}" fill="none" stroke="#999"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide}" height="{tall}" role="img" aria-label="{escape(y_name)}" '
        f'font-size="10" font-family="sans-serif"><rect width="{wide}" height="{tall}" fill="white"/><rect {box}/>'
        f'<polyline points="{points}" fill="none" stroke="#0072b2" stroke-width="1.5"/>{labels}</svg>'
    )


def _scale(values, length):
    """Scale values to the range 0 to `length`. Constant values go to the middle."""
    low, high = np.nanmin(values), np.nanmax(values)
    return np.full(values.shape, length / 2) if high == low else (values - low) / (high - low) * length
