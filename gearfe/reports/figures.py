"""Interactive figures of a report, made with plotly."""

import numpy as np

from ..core.units import NEWTON_PER_UM
from ..figures.look import COLOURS
from ..figures.stiffness_plots import closed
from ..stiffness.methods import NAMES
from .tooth import shown_tooth, towards_flank

DASH = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")
LOOK = {
    "template": "plotly_white",
    "font": {"size": 13, "family": "system-ui, sans-serif"},
    "margin": {"l": 60, "r": 15, "t": 15, "b": 55},
    "legend": {"orientation": "h", "y": -0.22, "x": 0},
    "hovermode": "x unified",
}
CLEAR = "rgba(0,0,0,0)"  # transparent, to keep the page's dark or light background
POINTS = 4000  # largest number of drawn points of a spectrum
K = "mesh stiffness k [N/µm]"


CONFIG = {"responsive": True, "displaylogo": False}
# style of the area between two curves
BAND = {"fill": "toself", "fillcolor": "rgba(0,114,178,0.25)", "line": {"width": 0}, "hoverinfo": "skip"}


def blank(x=None, y=None, **layout):
    """Return an empty figure with axis titles `x` and `y`."""
    from plotly.graph_objects import Figure

    titles = {name: {"title": title} for name, title in (("xaxis", x), ("yaxis", y)) if title}
    return Figure(layout=LOOK | titles | layout)


def part_of_page(figure, name):
    """Return a figure with this name as an element of a page. The page itself contains plotly."""
    return figure.to_html(include_plotlyjs=False, full_html=False, config=CONFIG, div_id=name)


def style(number):
    """Return colour, dashes and width of the line with this number."""
    return {"color": COLOURS[number % len(COLOURS)], "dash": DASH[number % len(DASH)], "width": 2.4 if number == 0 else 1.8}


def curves_figure(curves):
    """Plot the stiffness by method over the phase [N/um], with the error estimate of the first method as a band."""
    figure, first = blank("mesh phase", K, height=400), next(iter(curves.values()))
    if first.error is not None:
        low, high = ((first.k + sign * first.error) / NEWTON_PER_UM for sign in (-1, 1))
        band = {"x": np.concatenate([first.phase, first.phase[::-1]]), "y": np.concatenate([high, low[::-1]])}
        figure.add_scatter(**band, **BAND, name=f"estimate of {next(iter(curves))}")
    return _with_curves(figure, curves)


def cases_figure(curves):
    """Plot the stiffness of one method by case."""
    return _with_curves(blank("mesh phase", K, height=360), curves)


def _with_curves(figure, curves):
    for place, (name, curve) in enumerate(curves.items()):
        phase, k = closed(curve)
        number = NAMES.index(name) if name in NAMES else place  # Each method has the same colour in all figures.
        figure.add_scatter(x=phase, y=k, name=name, line=style(number), hovertemplate="%{y:.4g} N/µm")
    return figure


def share_figure(curve):
    """Plot the load share of each tooth pair over the phase."""
    figure = blank("mesh phase", "load share", height=320)
    figure.update_yaxes(range=[0, 1.05])
    share = np.where(curve.force > 0, curve.share, np.nan)
    for number, order in enumerate(curve.order):
        if np.isfinite(share[:, number]).any():
            line = {"name": f"pair {order:+d}", "line": style(number), "hovertemplate": "%{y:.3f}"}
            figure.add_scatter(x=curve.phase, y=share[:, number], connectgaps=False, **line)
    return figure


def spectra_figure(found):
    """Plot the spectra of an `Analysis` by case. Expected lines are marked and named."""
    figure = blank("frequency [Hz]", height=485, hovermode="closest", margin=LOOK["margin"] | {"t": 95})
    end = 1.15 * max(found.lines.values()) if found.lines else None
    for number, (name, spectrum) in enumerate(found.spectra.items()):
        last = spectrum.frequency.size if end is None else int(np.searchsorted(spectrum.frequency, end)) + 1
        rows = slice(1, min(last, POINTS))
        figure.add_scatter(
            x=spectrum.frequency[rows], y=spectrum.values[rows], name=name, line=style(number) | {"width": 1.3},
            hovertemplate="%{x:.2f} Hz: %{y:.3g} " + spectrum.unit,
        )  # fmt: skip
    names = {}
    for name, value in found.lines.items():
        names.setdefault(round(value, 3), []).append(name)
    for value, together in names.items():
        figure.add_vline(x=value, line={"color": "#777777", "dash": "dot", "width": 1})
        label = {"text": ", ".join(together), "textangle": -90, "font": {"size": 10}, "showarrow": False}
        figure.add_annotation(x=value, y=1, yref="paper", yanchor="bottom", **label)
    largest = max(spectrum.values[1:].max() for spectrum in found.spectra.values())
    figure.update_yaxes(title=f"amplitude [{found.unit}]", type="log", range=[np.log10(largest) - 5, np.log10(largest) + 0.2])
    figure.update_xaxes(range=None if end is None else [0, end])
    return figure


def tooth_figure(pressed, field, scale, largest):
    """Draw the loaded tooth in three dimensions, coloured by von Mises stress up to `largest` [MPa]."""
    points, faces, mises = shown_tooth(pressed, field, scale)
    figure = blank(height=560, margin={"l": 0, "r": 0, "t": 0, "b": 0}, hovermode="closest", dragmode="orbit")
    x, y, z = points.astype(np.float32)
    i, j, k = faces.astype(np.int32)
    bar = {"title": {"text": "von Mises<br>[MPa]"}, "len": 0.7, "thickness": 14}
    figure.add_mesh3d(
        x=x, y=y, z=z, i=i, j=j, k=k, intensity=mises.astype(np.float32), cmin=0, cmax=largest, colorscale="Viridis",
        colorbar=bar, lighting={"ambient": 0.6, "diffuse": 0.6, "specular": 0.05, "roughness": 0.9}, flatshading=False,
        hovertemplate="%{intensity:.0f} MPa<extra></extra>",
    )  # fmt: skip
    view, up = towards_flank(pressed.sector.gear)
    camera = {"eye": dict(zip("xyz", 1.15 * view, strict=True)), "up": dict(zip("xyz", up, strict=True))}
    camera["projection"] = {"type": "orthographic"}
    axes = {f"{name}axis": {"visible": False} for name in "xyz"}
    figure.update_layout(scene={"aspectmode": "data", "camera": camera, "bgcolor": CLEAR, **axes})
    return figure
