"""Pictures of stress fields (pyvista), without a screen."""

import math
import os
from typing import Any

import numpy as np

from ..core.case import Case
from ..core.checks import checked_refine
from ..core.files import suffix_of
from ..core.steps import part
from ..core.threads import single
from ..figures.contact_plot import plot_contact
from ..flexibility.finite_elements.mesh_cost import check_mesh
from ..scene.scene_pair import ScenePair
from ..stiffness.limits import check_section
from .fields import MISES, loaded_phase, rounded_up, stressed_gears, write_vtu
from .holed import contact_of, pressed_tooth, root_error, tooth_field
from .stress_parts import displaced, enlarged, length_scale, outlines, picture
from .window import aim, drawing_library

# least number of unknowns of a tooth in three dimensions at refine 1; it grows with the power 2.5 to 3 of refine
LEAST = 40_000
DEEP = 1.6  # shown depth of the body below the root circle [m_n]
# edge lengths of such a picture, see gearfe.geometry.mesh.holes.SIZES
FINE = {"tooth": 0.5, "flank": 0.18, "fillet": 0.22, "tip": 0.1, "rim": 0.3}
STRIP = 0.08  # edge length along the contact lines [m_n], about half the width of the distributed load
# corners and middles of a second-order tet (VTK's order) to eight tets
EIGHT = ((0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3), (4, 5, 6, 8), (4, 6, 7, 8), (6, 5, 9, 8), (6, 9, 7, 8))


@single
def render_stress(
    pair: Case | ScenePair,
    path: str | os.PathLike[str],
    *,
    case: str | None = None,
    phase: float | None = None,
    size: tuple[int, int] = (1400, 1050),
    refine: float = 1.0,
    title: str = "",
    top: float | None = None,
) -> dict[str, Any]:
    """Draw the von Mises stress of loaded gears to a picture file (needs no display), or write it as a VTK file.

    Spur gears without pits: both gears in their transverse section, under Hertzian pressure on a refined surface. Helical and
    herringbone gears, pits, and loads that change along the width (crowning, misalignment, shafts that tilt): the damaged tooth
    in three dimensions, pits as holes, with the load of the pair along its contact lines (`gearfe.strength.holed`). Displacements
    are magnified if there is a crack, so that it opens; the picture states the magnification.

    Parameters
    ----------
    pair : Case or ScenePair
        Loaded pair; for a scene's pair, `case` is its case of damage, default healthy.
    path : path
        A ``.png`` file, or ``.vtu``: mesh, displacement and stress.
    case : str, optional
    phase : float, optional
        Mesh phase; default: maximum load on the damaged tooth, 0 for healthy spur gears.
    size : tuple of int
        Pixels.
    refine : float
        Divides the edge lengths.
    title : str
        First line of the text in the picture.
    top : float, optional
        End of the colour scale [MPa]; default: the largest stress on the fillets, rounded up.

    Returns
    -------
    dict
        Contents of the picture: ``phase``, ``top`` (end of the colour scale [MPa]),
        ``largest`` and ``root`` (von Mises stress anywhere and on the loaded fillets) [MPa],
        ``root_error`` (its estimated error [MPa], in three dimensions only: `gearfe.strength.holed.root_error`),
        ``enlarged`` (magnification of displacements), ``load`` [N] (on the tooth shown; in a plane on the pair), ``text``.

    Raises
    ------
    RuntimeError
        If pyvista or a renderer is missing (the message states the package), or the solve does not fit into memory.
    """
    refine = checked_refine(refine)
    if suffix_of(path, "stress") == ".png":
        drawing_library()
    shown = pair.case(case) if isinstance(pair, ScenePair) else pair
    _check_size(shows_tooth(shown), refine)
    with part("", 0.0, 0.85):
        fields, told = (_tooth if shows_tooth(shown) else _gears)(shown, phase, refine)
    return _drawn(shown, fields, told, path, size, title or (case or ""), top)


def render_pressed(case, pressed, path, *, size, title):
    """Draw the stress of a tooth solved by `gearfe.strength.holed.pressed_tooth` with `FINE` and `STRIP`, as `render_stress`."""
    drawing_library()
    fields, told = _of_tooth(case, pressed)
    return _drawn(case, fields, told, path, size, title, None)


def shows_tooth(case):
    """Return True if `render_stress` draws one tooth in three dimensions, or False for both gears in their section."""
    return bool(case.pair.gear_1.beta or case.why_wide)


def _drawn(shown, fields, told, path, size, title, top):
    """Draw stress fields or write them to a file. Return a description of the picture as a dict."""
    told |= {"root": max(field.root for field in fields), "largest": max(float(field.mises.max()) for field in fields)}
    told["top"] = top or rounded_up(max(field.root for field in fields if field.opening > 0 or not told["enlarged"]))
    told["text"] = _text(title, told)
    if suffix_of(path, "stress") == ".vtu":
        write_vtu(path, fields)
    else:
        with part("picture", 0.85, 1.0):
            (_draw_tooth if shows_tooth(shown) else _draw_gears)(shown.pair, fields, told, path, size)
    return told


def render_contact(case, path, *, phase=None, title=""):
    """Draw contact lines with pressure on the flank, and the load over the width (`gearfe.plot_contact`).

    The default phase is that of the largest load on the damaged tooth pair (or pair 0). The result contains ``phase``, ``k``
    [N/m], ``pressure`` (largest Hertzian pressure [MPa]), and whether a ``corner`` touches. The pressure at a tip corner is
    unbounded and therefore excluded. It is nan if only corners touch.
    """
    contact = contact_of(case, None if phase is None else [phase], case.first_tooth or 0)
    plot_contact(case.pair, contact, path=path, pits=case.pits[0], title=title)
    pressure = contact.cells[0].pressure
    corner = np.isnan(pressure)
    largest = math.nan if corner.all() else float(pressure[~corner].max())
    return {"phase": float(contact.phase[0]), "k": float(contact.k[0]), "pressure": largest, "corner": bool(corner.any())}


def _check_size(wide, refine):
    """Reject a picture whose solution exceeds the limits of memory and time, before meshing. A slow one is announced."""
    if not wide:
        check_section(refine)
    elif refine > 1:
        check_mesh(LEAST / 3 * refine**2.5, refine)


def _gears(case, phase, refine):
    phase = loaded_phase(case) if phase is None else phase
    fields = stressed_gears(case, phase, refine)
    scale = enlarged(max(field.opening for field in fields), case.pair.gear_1.m_n)
    return fields, {"phase": phase, "load": case.force, "enlarged": scale, "where": "on the pair"}


def _tooth(case, phase, refine):
    phases = None if phase is None else [phase]
    return _of_tooth(case, pressed_tooth(case, phases=phases, refine=refine, sizes=FINE, strip=STRIP))


def _of_tooth(case, pressed):
    """Return the field of a solved tooth in a list, and a description of the picture."""
    field = tooth_field(pressed)
    told = {
        "phase": float(pressed.contact.phase[0]),
        "load": float(pressed.load[0]),
        "where": "on this tooth",
        "sector": pressed.sector,
        "root_error": root_error(pressed, case.materials[pressed.gear == "wheel"]),
    }
    return [field], told | {"enlarged": enlarged(field.opening, pressed.sector.gear.m_n)}


def _text(title, told):
    lines = [title, f"phase {told['phase']:.4g}, {told['load']:.0f} N {told['where']}"]
    if told["enlarged"]:
        lines.append(f"displacements x {told['enlarged']}, which opens the crack")
    return "\n".join(line for line in lines if line)


def _draw_gears(pair, fields, told, path, size):
    """Draw both gears. With magnified displacements, draw the cracked gear, and both unloaded gears in grey."""
    import pyvista

    scale, shown, focus = told["enlarged"], fields, (0.9 * pair.gear_1.m_n, pair.pitch_radius_1)
    if scale:
        shown = [field for field in fields if field.opening > 0]
    with picture(path, size, told["text"], told["top"]) as (plotter, look):
        for k, field in enumerate(shown):
            plotter.add_mesh(displaced(field, scale), name=f"stress {k}", lighting=False, **look)
            plotter.add_mesh(outlines(field, scale, lift=0.02), color="black", line_width=2, lighting=False)
        for field in fields if scale else ():
            plotter.add_mesh(outlines(field, 0, lift=0.01), color="#9a9a9a", line_width=1.5, lighting=False)
        half = (2.6 if scale else 3.6) * pair.gear_1.m_n
        wide = half * size[0] / size[1]
        middle = (focus[0] + 0.83 * wide, focus[1], 0.1)
        # background of the colour bar
        strip = pyvista.Plane(center=middle, direction=(0, 0, 1), i_size=0.36 * wide, j_size=3 * half)
        plotter.add_mesh(strip, color="white", lighting=False)
        plotter.view_xy()
        aim(plotter, (*focus, 0), (*focus, 1), half)
        length_scale(plotter, size, (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def _draw_tooth(pair, fields, told, path, size):
    """Draw the loaded flank of tooth 0. The tooth in front of it is cut away, because it would hide the flank."""
    import pyvista

    (field,), gear, scale = fields, told["sector"].gear, told["enlarged"]
    x, y, z = field.points
    rate = gear.twist_rate
    angle = (np.arctan2(x, y) - rate * z) * gear.z / (2 * math.pi)  # position relative to tooth 0 [pitches]
    deep = gear.outward * (np.hypot(x, y) - gear.r_f) / gear.m_n
    linear = np.hstack([field.cells[list(corners)] for corners in EIGHT])
    grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: linear.T}, (field.points + scale * field.moved).T)
    for name, values in ((MISES, field.mises), ("pitch", angle), ("deep", deep)):
        grid.point_data[name] = values
    for name, value, invert in (("pitch", 0.5, True), ("pitch", -0.5, False), ("deep", -DEEP, False)):
        grid = grid.clip_scalar(scalars=name, value=value, invert=invert)
    surface = grid.extract_surface(algorithm="dataset_surface").compute_normals(feature_angle=50, split_vertices=True)
    turn = rate * gear.b / 2
    out = np.array([math.cos(turn), -math.sin(turn), 0.0])
    up = gear.outward * np.array([math.sin(turn), math.cos(turn), 0.0])
    view = out + 0.45 * up + np.array([0, 0, 0.6])
    view /= np.linalg.norm(view)
    right = np.cross(up, view) / np.linalg.norm(np.cross(up, view))
    plane = np.array([right, np.cross(view, right)])  # plane of the picture
    low, high = (edge((plane @ surface.points.T).T, axis=0) for edge in (np.min, np.max))
    focus = plane.T @ ((low + high) / 2)
    wide, tall = (high - low) / (0.76, 0.76)  # space for the text above and the colour bar on the right
    size = size[0], round(size[0] * min(max(tall / wide, 0.5), size[1] / size[0]))
    with picture(path, size, told["text"], told["top"]) as (plotter, look):
        plotter.add_mesh(surface, name="stress", smooth_shading=True, ambient=0.55, diffuse=0.5, specular=0.0, **look)
        kept = (np.abs(angle) < 0.5) & (deep > -DEEP)
        plotter.add_mesh(outlines(field, scale, kept), color="black", line_width=2, lighting=False)
        half = max(tall, wide * size[1] / size[0]) / 2
        focus = focus + plane.T @ np.array([0.08 * half * size[0] / size[1], 0.18 * half])
        aim(plotter, focus, focus + 200 * gear.m_n * view, half, plane[1])
        light = focus + 200 * gear.m_n * (view + 0.7 * up)
        plotter.add_light(pyvista.Light(position=light, focal_point=focus, intensity=1.0))
        plotter.camera.clipping_range = (10 * gear.m_n, 500 * gear.m_n)
        length_scale(plotter, size, plane[1], view)
