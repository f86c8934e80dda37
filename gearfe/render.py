"""Pictures: stiffness curves (matplotlib) and stress fields (pyvista), both without a screen."""

import ctypes
import math
import os
import sys

import numpy as np

from geometry.mesher import section
from geometry.outline import stations
from geometry.tooth import arc_at

from .elasticity import Body, von_mises
from .export import written
from .fe import EDGES, flank_load
from .hertz import contact_modulus, half_width
from .stiffness import mesh_stiffness

STRESS = "von Mises stress [MPa]"
RENDERER_HELP = (
    "rendering needs pyvista and, without a screen, EGL or OSMesa: "
    "'pip install pyvista' and, on Debian, 'apt-get install libegl1'"
)
OFFSCREEN = {"libEGL.so.1": "vtkEGLRenderWindow", "libOSMesa.so.8": "vtkOSOpenGLRenderWindow"}


def plot_curves(curves, path=None):
    """Draw stiffness curves over the phase, each with the load share below; save to `path` if given.

    Parameters
    ----------
    curves : dict of str to StiffnessCurve
    path : path, optional
        Picture file; its suffix decides (png, svg, pdf).

    Returns
    -------
    matplotlib.figure.Figure
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 5), layout="constrained")
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=[2, 1])
    for name, curve in curves.items():
        phase, order = curve.phase, np.arange(curve.phase.size)
        if phase.size > 1 and (np.diff(phase) > 0).all() and phase[-1] < phase[0] + 1:  # one cycle: close it
            phase, order = np.append(phase, phase[0] + 1), np.append(order, 0)
        style = "-" if name == next(iter(curves)) else "--"
        top.plot(phase, curve.k[order] / 1e9, style, label=name)
        if style == "-":
            share = np.where(curve.force > 0, curve.share, np.nan)
            bottom.plot(curve.phase, share, label=[f"pair {k:+d}" for k in curve.order])
    top.set_ylabel("mesh stiffness k [GN/m]")
    top.set_ylim(bottom=0)
    top.legend()
    bottom.set_ylabel(f"load share ({next(iter(curves))})")
    bottom.set_xlabel("mesh phase (0: a pair enters, 1: one base pitch later)")
    bottom.set_ylim(0, 1.05)
    bottom.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    if path is not None:
        with written(path) as name:
            figure.savefig(name, dpi=120)
    return figure


def plot_map(found, formulations, x, y, zone, path=None, bins=8):
    """Heat maps of the median error over two columns of an `gearfe.errormap.ErrorMap`, one for each formulation.

    Columns with few different values (loads) get one bin each, others `bins` of equal width.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(3.4 * len(formulations) + 1, 3.4), layout="constrained")
    row = figure.subplots(1, len(formulations), sharex=True, sharey=True, squeeze=False)[0]
    (place_x, names_x), (place_y, names_y) = (_binned(found.columns[name], bins) for name in (x, y))
    for axes, name in zip(row, formulations, strict=True):
        error = 100 * found.columns[f"{name} {zone}"]
        table = np.full((len(names_y), len(names_x)), np.nan)
        for i in range(len(names_y)):
            for j in range(len(names_x)):
                here = error[(place_x == j) & (place_y == i) & np.isfinite(error)]
                table[i, j] = np.median(here) if here.size else np.nan
                if here.size:
                    axes.text(j, i, f"{table[i, j]:+.0f}", ha="center", va="center", fontsize=7)
        image = axes.imshow(table, cmap="RdBu_r", vmin=-30, vmax=30, origin="lower", aspect="auto")
        axes.set_title(name, fontsize=9)
        axes.set_xlabel(x)
        axes.set_xticks(range(len(names_x)), names_x, fontsize=7)
        axes.set_yticks(range(len(names_y)), names_y, fontsize=7)
    row[0].set_ylabel(y)
    figure.colorbar(image, ax=row, label=f"median error of k, {zone} [%]")
    if path is not None:
        with written(path) as name:
            figure.savefig(name, dpi=100)
    return figure


def _binned(values, bins):
    """Bin of every value, and the names of the bins."""
    few = np.unique(values)
    if few.size <= bins:
        return np.searchsorted(few, values), [f"{v:g}" for v in few]
    edges = np.linspace(values.min(), values.max(), bins + 1)
    return np.clip(np.digitize(values, edges) - 1, 0, bins - 1), [f"{v:.3g}" for v in (edges[1:] + edges[:-1]) / 2]


def render_stress(scene_pair, path, *, phase=0.0, size=(1400, 1050), refine=1.0):
    """Render von Mises stress of both gears around the loaded teeth to a PNG, without a screen.

    The contact forces are those of `mesh_stiffness` at `phase`; each presses with Hertz's ellipse on a surface meshed for
    it.

    Parameters
    ----------
    scene_pair : ScenePair
    path : path
        A ``.png`` file.
    phase : float
    size : tuple of int
        Pixels.

    Returns
    -------
    float
        Largest von Mises stress in the picture [MPa].

    Raises
    ------
    RuntimeError
        If pyvista or a renderer is missing; the message names what to install.
    """
    try:
        import pyvista
    except ImportError as error:
        raise RuntimeError(f"{RENDERER_HELP} ({error})") from error
    _choose_window()
    grids, outlines, root = stressed_gears(scene_pair, phase, refine)
    largest = max(float(grid.point_data[STRESS].max()) for grid in grids)
    plotter = pyvista.Plotter(off_screen=True, window_size=list(size))
    try:
        plotter.set_background("white")
        for grid, outline in zip(grids, outlines, strict=True):
            actor = plotter.add_mesh(grid, scalars=STRESS, clim=[0, 1.1 * root], cmap="turbo", show_scalar_bar=False)
            plotter.add_mesh(outline, color="black", line_width=2)
        bar = {"color": "black", "background_color": "white", "fill": True, "position_x": 0.2, "width": 0.6, "fmt": "%.0f"}
        plotter.add_scalar_bar(title=STRESS, mapper=actor.mapper, n_labels=6, title_font_size=22, label_font_size=20, **bar)
        pair = scene_pair.pair
        focus = (0.5 * pair.gear_1.m_n, pair.pitch_radius_1, 0)
        plotter.view_xy()
        plotter.camera.focal_point = focus
        plotter.camera.position = (*focus[:2], 1)
        plotter.camera.parallel_projection = True
        plotter.camera.parallel_scale = 3.6 * pair.gear_1.m_n
        with written(path) as name:
            plotter.screenshot(name)
    finally:
        plotter.close()
    return largest


def _choose_window():
    """Without a display, pick the offscreen window this machine can open: VTK itself ends the process if there is none."""
    if sys.platform != "linux" or os.environ.get("DISPLAY") or os.environ.get("VTK_DEFAULT_OPENGL_WINDOW"):
        return
    for library, window in OFFSCREEN.items():
        try:
            ctypes.CDLL(library)
        except OSError:
            continue
        os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = window
        return
    raise RuntimeError(f"no display, and neither of {', '.join(OFFSCREEN)} can be loaded: {RENDERER_HELP}")


def stressed_gears(scene_pair, phase=0.0, refine=1.0):
    """Both gears in mesh at `phase` as pyvista grids with nodal displacement [mm] and von Mises stress [MPa].

    Returns
    -------
    grids, outlines : lists of pyvista data sets, pinion first
    root : float
        Largest von Mises stress on the loaded fillets [MPa].
    """
    import pyvista

    pair, materials = scene_pair.pair, scene_pair.materials
    curve = mesh_stiffness(pair, scene_pair.force, materials, method="ritz", phases=[phase])
    found = pair.contacts([phase])
    forces = dict(zip(curve.order.tolist(), curve.force[0] / curve.meta["width_mm"], strict=True))
    carrying = [(i, k) for i, k in enumerate(found.order.tolist()) if forces.get(k, 0.0) > 0]
    nominal = found.nominal[0, carrying[0][0]] - carrying[0][1] * pair.p_bt
    modulus = contact_modulus(materials)
    grids, outlines, root = [], [], 0.0
    rolls = found.roll_1[0], found.roll_2[0]
    mirrors, centres = (1, pair.outward), (0.0, pair.centre_2)
    for gear, material, roll, turn, centre, mirror, ahead in zip(
        (pair.gear_1, pair.gear_2), materials, rolls, pair.turn(nominal), centres, mirrors, (1, -1), strict=True
    ):
        loads = {}
        for i, k in carrying:
            radius = pair.relative_radius(found.roll_1[0, i], found.roll_2[0, i])
            loads[ahead * k] = (roll[i], forces[k], float(half_width(forces[k], radius, modulus)))
        mesh, moved, stress = _loaded_gear(gear, material, loads, refine)
        shape = mesh.mesh.doflocs
        cos, sin = math.cos(turn), math.sin(turn)
        x, y = mirror * shape[0], shape[1]
        points = np.array([cos * x + sin * y, cos * y - sin * x + centre, 0 * x]).T
        cells = np.vstack([mesh.mesh.t[:3], mesh.mesh.nvertices + mesh.mesh.t2f]).T
        grid = pyvista.UnstructuredGrid({pyvista.CellType.QUADRATIC_TRIANGLE: cells}, points)
        mises = von_mises(stress, material.nu, "plane strain")
        grid.point_data[STRESS] = mises
        u = moved.reshape(-1, 2) * [mirror, 1]
        grid.point_data["displacement [mm]"] = np.array(
            [cos * u[:, 0] + sin * u[:, 1], cos * u[:, 1] - sin * u[:, 0], 0 * u[:, 0]]
        ).T
        edges = np.concatenate([mesh.mesh.boundaries["rim"], mesh.mesh.boundaries["held"]])
        start, stop = mesh.mesh.facets[:, edges]
        middle = mesh.mesh.nvertices + edges
        pieces = np.vstack([np.array([start, middle]).T, np.array([middle, stop]).T])
        lines = np.hstack([np.full((pieces.shape[0], 1), 2), pieces]).ravel()
        outlines.append(pyvista.PolyData(points + np.array([0, 0, 0.01]), lines=lines))
        root = max(root, *(float(mises[chain].max()) for chain in mesh.fillet.values()))
        grids.append(grid)
    return grids, outlines, root


def _loaded_gear(gear, material, loads, refine):
    """Mesh a gear for contacts ``{tooth: (roll, line load, half width)}`` and solve it."""
    edge = {name: size * gear.m_n / refine for name, size in EDGES.items()}
    rolls, arcs = {}, {}
    for tooth, (roll, _, a) in loads.items():
        top = arc_at(gear, gear.roll_a)
        arcs[tooth] = min(arc_at(gear, roll), top - a)
        rolls[tooth] = stations(gear, edge["flank"], patches=[(arcs[tooth] - 1.5 * a, arcs[tooth] + 1.5 * a, a / 6)])
    mesh = section(gear, rolls, fillet_size=edge["fillet"] / 2, size=edge["near"] / 2, far_size=edge["far"])
    body = Body(mesh.mesh, material)
    force = 0.0
    for tooth, (_, line_load, a) in loads.items():

        def pressure(s, arc=arcs[tooth], a=a, line_load=line_load):
            return 2 * line_load / (math.pi * a) * np.sqrt(np.maximum(1 - ((s - arc) / a) ** 2, 0.0))

        force = force + flank_load(mesh, tooth, pressure, np.array([0]), rolls[tooth].size - 1)
    moved = body.solve(force)[:, 0]
    return mesh, moved, body.stress(moved)


def plot_spectra(spectra, lines=None, path=None, top=None):
    """Draw spectra of one unit below each other, expected lines dotted and named; save to `path` if given.

    Parameters
    ----------
    spectra : dict of str to gearfe.signals.Spectrum
    lines : dict of str to float, optional
        See `gearfe.spectral_lines.expected_lines`.
    path : path, optional
    top : float, optional
        Largest frequency or order; default 1.2 times the last line.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 1 + 2 * len(spectra)), layout="constrained")
    rows = figure.subplots(len(spectra), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for axes, (name, found) in zip(rows, spectra.items(), strict=True):
        axes.semilogy(found.frequency, found.values, linewidth=0.8)
        axes.set_ylim(bottom=1e-6 * max(one.values.max() for one in spectra.values()))
        axes.set_ylabel(f"{name} [{found.unit}]")
        for value in (lines or {}).values():
            axes.axvline(value, linestyle=":", linewidth=0.7, color="gray", zorder=0)
    for name, value in (lines or {}).items():
        rows[0].annotate(name, (value, 1), xycoords=("data", "axes fraction"), rotation=90, fontsize=7, ha="center", va="bottom")
    end = 1.2 * max(lines.values()) if lines and top is None else top
    rows[-1].set_xlim(0, end if end is not None else found.frequency[-1])
    rows[-1].set_xlabel("order" if found.axis == "order" else f"frequency [{found.axis}]")
    if path is not None:
        with written(path) as name:
            figure.savefig(name, dpi=120)
    return figure


def plot_phase(portrait, section=None, unit="m", path=None):
    """Draw a phase portrait, `gearfe.portrait.phase_portrait`, with the points of a Poincare section; save to `path` if given."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5, 4), layout="constrained")
    axes = figure.subplots()
    axes.plot(*portrait, linewidth=0.4)
    if section is not None:
        axes.plot(*np.transpose(section), "k.", markersize=4)
    axes.set_xlabel(f"displacement [{unit}]")
    axes.set_ylabel(f"velocity [{unit}/s]")
    if path is not None:
        with written(path) as name:
            figure.savefig(name, dpi=120)
    return figure
