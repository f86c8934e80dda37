"""The loaded set as finite elements see it gear by gear, under the loads that the set's one contact gave: for pictures."""

import math
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.files import check_output
from ..core.record import ranged
from ..core.steps import steps
from ..figures.set_plot import draw_set
from ..flexibility.finite_elements.elasticity import Body
from ..geometry.aliases import Floats
from ..geometry.mesh.outline import stations
from ..geometry.tooth.profile import cartesian, turned
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

    place: Floats
    moved: Floats
    triangles: NDArray[np.int64]
    stress: Floats


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
        If the set cannot be meshed gear by gear, as of `planetary_sets.loaded_gears.drawable`, or an argument is out of range.
    """
    if path is not None:
        check_output(path, "picture")
    if magnified is not None:
        ranged("magnified", magnified, above=0.0)
    ((shapes, supports),) = loaded_shapes(curves, [at])
    return draw_set(shapes, supports, path, magnified=magnified, dpi=dpi)


def loaded_shapes(curves: SetCurves, positions: Sequence[int]) -> list[tuple[list[Shape], Floats | None]]:
    """At each of these positions, by their numbers: `Shape` of every gear, and where the ring is held ``(2, n)`` [mm].

    The latter is None if it is held all around; pads turn with the ring, since the carrier stands still. Each gear is meshed and
    factored once. ValueError as of `gearfe.planetary_sets.loaded_gears.drawable`.
    """
    sides, bodies = [], []
    for at in positions:
        case, stand = drawable(curves, at)
        sides.append([one for pair in touching(case, stand, curves, at) for one in pair])
        bodies.append(placed(case, stand, curves, at))
    made = []
    for k, same in enumerate(steps(list(zip(*bodies, strict=True)))):
        made.append(_shapes(case, same, [[side for side in one if side["body"] == k] for one in sides]))
    pads: list[Floats | None] = [None] * len(bodies)
    if case.ring != "held":
        pads = [cartesian(1.03 * case.ring_gear.r_rim, case.ring.middles + there[-1][3]) for there in bodies]
    return [(list(one), held) for one, held in zip(zip(*made, strict=True), pads, strict=True)]


def _shapes(case, bodies, sides):
    """`Shape` of one gear at each position, under the loads of its flanks there, held where it is."""
    gear, material, centre, *_ = bodies[0]
    size = {name: edge * gear.m_n for name, edge in EDGE.items()}
    rolls = {(side["tooth"], side["side"]): stations(gear, size["flank"]) for there in sides for side in there}
    made, held = meshed(case, gear, rolls, size["fillet"], size["near"], size["far"], 0.3 * gear.m_n)
    mesh = made.mesh
    facets = mesh.boundaries["held"]
    mesh = mesh.with_boundaries({"held": facets[np.isin(mesh.nvertices + facets, held)]})
    solver = Body(mesh, material)
    out = []
    for (*_, angle, _), there in zip(bodies, sides, strict=True):
        u = solver.solve(sum(_load(gear, made, rolls, side) for side in there))[:, 0]
        place, moved = (turned(one, angle) for one in (mesh.doflocs, u.reshape(-1, 2).T))
        out.append(Shape(place + centre[:, None], moved, solver.nodes, _mises(*solver.stress(u), material.nu)))
    return out


def _load(gear, made, rolls, side):
    """Nodal forces ``(2 n, 1)`` of the load of a flank."""
    at = side["tooth"], side["side"]
    unit = line_loads(gear, made.mesh, made.flank[at], rolls[at], np.array([side["roll"]]), side["side"])
    forces = turned(unit.reshape(-1, 2).T, 2 * math.pi * side["tooth"] / gear.z)
    return side["force"] * forces.T.reshape(-1, 1)


def _mises(xx, yy, xy, nu):
    """Von Mises stress in plane strain [MPa]."""
    zz = nu * (xx + yy)
    return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xy**2)
