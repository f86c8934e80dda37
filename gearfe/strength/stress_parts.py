"""Parts of pictures of stress: the window with its colour bar and text, displaced bodies, their edges, a bar of length."""

import contextlib
import math

import numpy as np

from ..core.files import written
from .fields import MISES
from .window import plotting

COLOURS, ABOVE = "viridis", "#d55e00"  # perceptually uniform scale, suitable for colour-blind readers; colour above the scale
OPENING = 0.2  # drawn opening of a crack [m_n]
STEPS = (1, 2, 5)  # magnification factors of displacements, times powers of ten


def enlarged(opening, module):
    """Magnification of displacements that opens a crack by about `OPENING` modules, or 0 (not drawn) without a crack."""
    if opening <= 0:
        return 0
    power = math.floor(math.log10(OPENING * module / opening))
    return int(max(1, max(s * 10.0**power for s in STEPS if s * 10.0**power <= OPENING * module / opening * (1 + 1e-9))))


@contextlib.contextmanager
def picture(path, size, text, top):
    """Return a plotter and a function that draws stress.

    Text and colour bar are added, and the picture is written to `path`.
    """
    with plotting(window_size=list(size), lighting="none") as plotter:
        plotter.set_background("white")
        look = {"scalars": MISES, "clim": [0, top], "cmap": COLOURS, "above_color": ABOVE, "show_scalar_bar": False}
        yield plotter, look
        scale = (size[0] / 1400) ** 0.7  # Letters shrink less than the picture, so that small pictures are readable.
        mapper = next(actor.mapper for name, actor in plotter.actors.items() if name.startswith("stress"))
        fonts = {"title_font_size": round(26 * scale), "label_font_size": round(24 * scale), "color": "black", "fmt": "%.0f"}
        place = {"vertical": True, "position_x": 0.89, "position_y": 0.2, "width": 0.06, "height": 0.6, "n_labels": 6}
        plotter.add_scalar_bar(title="MPa", mapper=mapper, **fonts, **place)
        _label(plotter, f"von Mises stress\n{text}", (0.012, 0.985), 28 * scale).SetVerticalJustificationToTop()
        plotter.enable_anti_aliasing("ssaa")
        with written(path) as name:
            plotter.screenshot(name)


def _label(plotter, text, position, size):
    """Add a text on a white background."""
    plotter.add_text(text.encode(errors="replace").decode(), position=position, viewport=True, color="black", font_size=1)
    style = plotter.actors[next(reversed(plotter.actors))].prop
    style.SetFontSize(round(size))
    style.SetBackgroundColor(1.0, 1.0, 1.0)
    style.SetBackgroundOpacity(0.8)
    return style


def displaced(field, scale):
    """Pyvista grid of a field, displaced."""
    import pyvista

    kind = {"triangle6": pyvista.CellType.QUADRATIC_TRIANGLE, "tetra10": pyvista.CellType.QUADRATIC_TETRA}[field.kind]
    grid = pyvista.UnstructuredGrid({kind: field.cells.T}, (field.points + scale * field.moved).T)
    grid.point_data[MISES] = field.mises
    return grid


def outlines(field, scale, kept=None, lift=0.0):
    """Pyvista lines of a displaced field: all, or those between the nodes of the mask `kept`, raised by `lift` [mm]."""
    import pyvista

    pieces = field.lines if kept is None else field.lines[:, kept[field.lines].all(axis=0)]
    cells = np.hstack([np.full((pieces.shape[1], 1), 2), pieces.T]).ravel()
    return pyvista.PolyData((field.points + scale * field.moved).T + np.array([0, 0, lift]), lines=cells)


def length_scale(plotter, size, up, view):
    """Draw a bar of a round length at the lower left, in the plane of the picture, in front of everything."""
    import pyvista

    up, view, focus = np.array(up), np.array(view), np.array(plotter.camera.focal_point)
    right, half = np.cross(up, view), plotter.camera.parallel_scale
    wide = half * size[0] / size[1]
    target = 0.3 * wide
    power = 10.0 ** math.floor(math.log10(target))
    length = max(s * power for s in STEPS if s * power <= target)
    near = 0.15 * np.linalg.norm(np.array(plotter.camera.position) - focus)
    start = focus - 0.95 * wide * right - 0.93 * half * up + near * view
    middle = start + length / 2 * right - 0.1 * near * view
    corners = np.array([middle + i * 0.58 * length * right + j * 0.025 * half * up for j in (-1, 1) for i in (-1, 1)])
    sheet = pyvista.PolyData(corners, faces=[4, 0, 1, 3, 2])
    plotter.add_mesh(sheet, color="white", lighting=False)
    plotter.add_mesh(pyvista.Line(start, start + length * right), color="black", line_width=6, lighting=False)
    _label(plotter, f"{length:g} mm", (0.028, 0.045), 24 * (size[0] / 1400) ** 0.7)
