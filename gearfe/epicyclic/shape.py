"""The loaded set as finite elements see it gear by gear, under the loads that the set's one contact gave: for pictures."""

import math
import os
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from geometry.mesh.both_flanks import both_flanks
from geometry.mesh.outline import stations
from geometry.tooth.profile import flank_normal

from ..elements.elasticity import Body, edge_nodes, edge_shapes
from ..pictures.set_plot import draw_set
from .curves import SetCurves
from .deck import placed, touching
from .rim import RimSupports
from .standing import standing, tooth_angles

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


def bent_shapes(curves: SetCurves, at: int) -> list[Shape]:
    """`Shape` of sun, planets and ring of one position, their own motions as whole gears left out.

    Parameters
    ----------
    curves : SetCurves
        Of a case with a held ring or one on rigid pads.
    at : int
        Number of the position.

    Raises
    ------
    ValueError
        If the ring is held otherwise.
    """
    case = curves.meta["case"]
    rigid = isinstance(case.ring, RimSupports) and math.isinf(case.ring.radial) and math.isinf(case.ring.tangential)
    if not (case.ring == "held" or rigid):
        raise ValueError("a picture of a ring that is neither held nor on rigid pads is not drawn: give one of these")
    stand = standing(case.gears, np.array(case.angles), [curves.position[at]])
    sides = [one for pair in touching(case, stand, curves, at) for one in pair]
    bodies = enumerate(placed(case, stand, curves, at))
    return [_shape(case, body, [one for one in sides if one["body"] == k]) for k, body in bodies]


def _shape(case, body, sides):
    gear, material, centre, angle, _ = body
    size = {name: edge * gear.m_n for name, edge in EDGE.items()}
    rolls = {(one["tooth"], one["side"]): stations(gear, size["flank"]) for one in sides}
    pads = gear.internal and case.ring != "held"
    ends = case.ring.ends(gear) if pads else ()
    made = both_flanks(
        gear, rolls, fillet_size=size["fillet"], size=size["near"], far_size=size["far"], marks=ends, mark_size=0.3 * gear.m_n
    )
    mesh = made.mesh
    if pads:
        facets = mesh.boundaries["held"]
        on = case.ring.covers(gear, mesh.doflocs[:, mesh.nvertices + facets])
        mesh = mesh.with_boundaries({"held": facets[on]})
    load = np.zeros((2 * mesh.doflocs.shape[1], 1))
    for one in sides:
        _push(load, gear, mesh, made.flank[one["tooth"], one["side"]], rolls[one["tooth"], one["side"]], one)
    solver = Body(mesh, material)
    u = solver.solve(load)[:, 0]
    xx, yy, xy = solver.stress(u)
    zz = material.nu * (xx + yy)
    mises = np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xy**2)
    cos, sin = math.cos(angle), math.sin(angle)
    turn = np.array([[cos, sin], [-sin, cos]])
    return Shape(turn @ mesh.doflocs + centre[:, None], turn @ u.reshape(-1, 2).T, solver.nodes, mises)


def _push(load, gear, mesh, vertices, rolls, one):
    """Put the load of one flank where it touches, into its normal."""
    rising = rolls * gear.outward
    at = one["roll"] * gear.outward
    edge = int(np.clip(np.searchsorted(rising, at) - 1, 0, rising.size - 2))
    shapes, _ = edge_shapes(np.clip(2 * (at - rising[edge]) / (rising[edge + 1] - rising[edge]) - 1, -1, 1))
    turn = 2 * math.pi * one["tooth"] / gear.z
    x, y = -flank_normal(gear, one["roll"]) * np.array([1 - 2 * one["side"], 1])
    cos, sin = math.cos(turn), math.sin(turn)
    for shape, node in zip(shapes, edge_nodes(mesh, vertices)[:, edge], strict=True):
        load[2 * node, 0] += one["force"] * shape * (cos * x + sin * y)
        load[2 * node + 1, 0] += one["force"] * shape * (cos * y - sin * x)


def plot_planetary_set(
    curves: SetCurves, at: int = 0, path: str | os.PathLike[str] | None = None, *, magnified: float | None = None, dpi: int = 150
) -> "Figure":
    """Draw one position of a loaded set, all gears bent and coloured by von Mises stress; save to `path` if given.

    Each gear is solved by finite elements of its own under the loads of the set's meshes; their motions as whole gears are left
    out. Loads stand on single nodes: close to them stress means nothing.

    Parameters
    ----------
    curves : SetCurves
        Of a case with a held ring or one on rigid pads.
    at : int
        Number of the position.
    path : path, optional
    magnified : float, optional
        How many times displacements are drawn; default: so that the largest is seen.
    dpi : int
        Dots per inch.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        If the ring is held otherwise.
    """
    shapes, case = bent_shapes(curves, at), curves.meta["case"]
    supports = None
    if isinstance(case.ring, RimSupports):
        angles = np.array(case.angles)
        angle = case.ring.middles + tooth_angles(case.gears, angles, standing(case.gears, angles, [curves.position[at]]))[2]
        supports = 1.03 * case.ring_gear.r_rim * np.array([np.sin(angle), np.cos(angle)])
    return draw_set(shapes, supports, path, magnified=magnified, dpi=dpi)
