"""Pictures of stress fields (pyvista), without a screen."""

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
