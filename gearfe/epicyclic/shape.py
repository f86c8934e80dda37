"""The loaded set as finite elements see it gear by gear, under the loads that the set's one contact gave: for pictures."""

import math
import os
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from geometry.mesh.outline import stations
from geometry.tooth.profile import cartesian

from ..checks import is_number
from ..decks.contact_deck import posed
from ..elements.elasticity import Body
from ..files import check_output
from ..pictures.set_plot import draw_set
from .curves import SetCurves
from .loaded_gears import drawable, meshed, placed, touching
from .whole_gear import line_loads

if TYPE_CHECKING:
    from matplotlib.figure import Figure

EDGE = {"flank": 0.1, "fillet": 0.12, "near": 0.4, "far": 0.9}  # longest edges [m_n]


class Shape(NamedTuple):
    """A gear of a loaded set.

    Places of its nodes in the set ``(2, n)`` and how they move [mm], triangles ``(6, m)`` by corners and edge middles, von Mises
    stress at the nodes [MPa].
    """

    place: NDArray[np.float64]
    moved: NDArray[np.float64]
    triangles: NDArray[np.int64]
    stress: NDArray[np.float64]


def plot_planetary_set(
    curves: SetCurves, at: int = 0, path: str | os.PathLike[str] | None = None, *, magnified: float | None = None, dpi: int = 150
) -> "Figure":
    """Draw one position of a loaded set, all gears bent and coloured by von Mises stress; save to `path` if given.

    Each gear is solved by finite elements of its own under the loads of the set's meshes. That sun and planets turn and shift as
    whole gears is left out. Each load stands on three nodes: close to it stress means nothing.

    Parameters
    ----------
    curves : SetCurves
        Of a case with a held ring or one on rigid pads, without modified flanks and cracks.
    at : int
        Number of the position, from 0.
    path : path, optional
    magnified : float, optional
        How many times as large displacements are drawn; default: so that the largest is seen.
    dpi : int
        Dots per inch.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        If the set cannot be meshed gear by gear, as of `gearfe.epicyclic.loaded_gears.drawable`, or an argument is out of range.
    """
    if path is not None:
        check_output(path, "picture")
    if magnified is not None and not (is_number(magnified) and 0 < magnified < math.inf):
        raise ValueError(f"magnified = {magnified!r}, but give a finite number > 0, or leave it out")
    case, stand = drawable(curves, at)
    sides = [one for pair in touching(case, stand, curves, at) for one in pair]
    bodies = placed(case, stand, curves, at)
    shapes = [_shape(case, body, [side for side in sides if side["body"] == k]) for k, body in enumerate(bodies)]
    supports = None
    if case.ring != "held":
        supports = cartesian(1.03 * case.ring_gear.r_rim, case.ring.middles + bodies[-1][3])
    return draw_set(shapes, supports, path, magnified=magnified, dpi=dpi)


def _shape(case, body, sides):
    """`Shape` of one gear under the loads of its flanks, held where it is."""
    gear, material, centre, angle, _ = body
    size = {name: edge * gear.m_n for name, edge in EDGE.items()}
    rolls = {(side["tooth"], side["side"]): stations(gear, size["flank"]) for side in sides}
    made, held = meshed(case, gear, rolls, size["fillet"], size["near"], size["far"], 0.3 * gear.m_n)
    mesh = made.mesh
    facets = mesh.boundaries["held"]
    mesh = mesh.with_boundaries({"held": facets[np.isin(mesh.nvertices + facets, held)]})
    load = np.zeros((2 * mesh.doflocs.shape[1], 1))
    for one in sides:
        at = one["tooth"], one["side"]
        unit = line_loads(gear, mesh, made.flank[at], rolls[at], np.array([one["roll"]]), one["side"])
        turned = posed(unit.reshape(-1, 2).T, 2 * math.pi * one["tooth"] / gear.z, 1)
        load += one["force"] * np.array(turned).T.reshape(-1, 1)
    solver = Body(mesh, material)
    u = solver.solve(load)[:, 0]
    xx, yy, xy = solver.stress(u)
    zz = material.nu * (xx + yy)
    mises = np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xy**2)
    place, moved = (np.array(posed(one, angle, 1)) for one in (mesh.doflocs, u.reshape(-1, 2).T))
    return Shape(place + centre[:, None], moved, solver.nodes, mises)
