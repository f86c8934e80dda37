"""Pictures of meshes without load: gears as `gearfe.export_mesh` and `gearfe.write_contact_inp` make them."""

import os
from collections.abc import Sequence

import numpy as np

from ..core.files import suffix_of, written
from ..decks.solid_deck import FACES, DeckBody
from ..figures.look import GEARS
from .window import aim, plotting

HURT = "#d55e00"  # colours of pits and of the rims of crack faces
IN_FRONT = -1e5  # depth offset that draws crack rims in front of surfaces that hide them
NEAR = 1.6  # half height of a close-up relative to the size of the damage


def render_mesh(
    parts: DeckBody | Sequence[DeckBody],
    path: str | os.PathLike[str],
    *,
    close_up: str | None = None,
    size: tuple[int, int] = (1400, 1050),
) -> None:
    """Draw the surface of one or several meshed gears with the edges of their elements, without a screen.

    Pits are orange. The rim of crack faces is orange too and drawn in front, because the faces lie on each other.

    Parameters
    ----------
    parts : Part or sequence of Part
        What `gearfe.export_mesh` returns, or ``parts`` of a deck of `gearfe.write_contact_inp`: both gears in their place.
    path : path
        ``.png``.
    close_up : {"crack", "pits"}, optional
        Show what is around the crack or the pits of the first gear that has them; default everything.
    size : tuple of int
        Pixels.

    Raises
    ------
    ValueError
        If there is no such damage to look at.
    RuntimeError
        If pyvista or a renderer is missing; the message names what to install.
    """
    if suffix_of(path, "picture") != ".png":
        raise ValueError(f"{path}: meshes are drawn as .png only; give a name that ends in .png")
    parts = (parts,) if isinstance(parts, DeckBody) else tuple(parts)
    focus, view, half = _camera(parts, close_up)
    with plotting(window_size=list(size)) as plotter:
        plotter.set_background("white")
        for part, colour in zip(parts, GEARS * len(parts), strict=False):
            plotter.add_mesh(_surface(part), color=colour, show_edges=True, edge_color="#404040", line_width=1)
            for name, faces in part.faces.items():
                if name == "pits" and faces.size:
                    plotter.add_mesh(_faces(part, faces), color=HURT, show_edges=True, edge_color="#404040")
                elif name.startswith("crack") and name.endswith("body"):
                    rim = _faces(part, faces).extract_feature_edges(feature_edges=False, manifold_edges=False)
                    line = plotter.add_mesh(rim, color=HURT, line_width=6, lighting=False)
                    line.mapper.SetResolveCoincidentTopologyToPolygonOffset()
                    line.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, IN_FRONT)
        # The close camera hides the far side of a ring.
        aim(plotter, focus, focus + (3 if close_up == "pits" else 50) * half * view, half, (0.0, 1.0, 0.0))
        plotter.renderer.ResetCameraClippingRange()
        with written(path) as name:
            plotter.screenshot(name)


def _camera(parts, close_up):
    """Return focus, viewing direction and half height [mm] of the picture."""
    if not len(parts):
        raise ValueError("parts: give at least one")
    if close_up is None:
        points = np.hstack([part.points for part in parts])
        low, high = points.min(axis=1), points.max(axis=1)
        view = np.array([0.35, 0.3, 1.0])
        return (low + high) / 2, view / np.linalg.norm(view), 0.6 * max(high[:2] - low[:2])
    if close_up not in ("crack", "pits"):
        raise ValueError(f"close_up = {close_up!r}, but it must be 'crack' or 'pits'")
    for part in parts:
        for name, faces in part.faces.items():
            if faces.size and (name == "pits" if close_up == "pits" else name.startswith("crack") and name.endswith("body")):
                points = part.points[:, np.unique(faces)]
                low, high = points.min(axis=1), points.max(axis=1)
                if close_up == "crack":
                    return _at_crack(points)
                return (low + high) / 2, _into_pits(part, faces), NEAR * np.linalg.norm(high - low) / 2
    raise ValueError(
        f"close_up = {close_up!r}, but these meshes have no damage to show: give the damage when the meshes are made"
    )


def _into_pits(part, faces):
    """Return the viewing direction into the pits over the next tooth: outwards from the flank, away from the held edge."""
    edges = np.sort(np.hstack([faces[[0, 1]], faces[[1, 2]], faces[[0, 2]]]), axis=0)
    sides, count = np.unique(edges, axis=1, return_counts=True)
    middle = part.points[:, np.unique(faces)].mean(axis=1)
    out = part.points[:, np.unique(sides[:, count == 1])].mean(axis=1) - middle  # separates the rim from floor and walls
    held = part.points[:2, part.held]
    away = middle[:2] - held[:, np.hypot(*(held - middle[:2, None])).argmin()]
    view = out / np.linalg.norm(out) + [*away / np.hypot(*away), 0.35]
    return view / np.linalg.norm(view)


def _at_crack(points):
    """Return the camera for a crack: at the end face with the longer crack, with the fillet along the mouth in view."""
    upper = points[2] > (points[2].min() + points[2].max()) / 2
    above, below = (np.linalg.norm(np.ptp(points[:2, half], axis=1)) for half in (upper, ~upper))
    side, length = (1.0 if above >= 0.999 * below else -1.0), np.ptp(points[2])
    x, y, _ = points.mean(axis=1)
    end = points[2].max() if side > 0 else points[2].min()
    view = np.array([1.0, 0.5, 1.2 * side])
    return np.array([x, y, end - 0.2 * side * length]), view / np.linalg.norm(view), max(2 * max(above, below), 0.35 * length)


def _surface(part):
    """Return outer faces by their corners, except those of pits."""
    corners = np.array(FACES[len(part.cells)])
    sides = part.cells[corners].transpose(1, 0, 2).reshape(corners.shape[1], -1)
    pits = part.faces.get("pits", sides[:, :0])
    doubled = np.sort(np.hstack([sides, pits]), axis=0)  # Faces of pits then occur twice.
    _, first, count = np.unique(doubled, axis=1, return_index=True, return_counts=True)
    return _faces(part, sides[:, first[count == 1]])


def _faces(part, faces):
    import pyvista

    table = np.vstack([np.full(faces.shape[1], faces.shape[0]), faces]).T
    return pyvista.PolyData(part.points.T, faces=table.ravel()).clean()
