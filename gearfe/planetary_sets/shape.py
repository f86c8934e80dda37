"""Pictures of a loaded set. Each gear is solved by finite elements under the loads of the set's contact problem."""

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
from ..flexibility.finite_elements.elasticity import HeldSection
from ..geometry.aliases import Floats
from ..geometry.damage.chip import chip_of
from ..geometry.damage.crack import Crack
from ..geometry.mesh.both_flanks import SIDES
from ..geometry.mesh.outline import stations
from ..geometry.tooth.gear import shortened
from ..geometry.tooth.profile import cartesian, turned
from .curves import SetCurves
from .loaded_gears import drawable, meshed, placed, touching
from .meshes import broken_of
from .whole_gear import line_loads

if TYPE_CHECKING:
    from matplotlib.figure import Figure

EDGE = {"flank": 0.1, "fillet": 0.12, "near": 0.4, "far": 0.9}  # longest edges [m_n]


class Shape(NamedTuple):
    """Gear of a loaded set.

    The fields are positions ``(2, n)`` and displacements of its nodes [mm], triangles ``(6, m)`` by corners and edge middles,
    and the von Mises stress at the nodes [MPa].
    """

    place: Floats
    moved: Floats
    triangles: NDArray[np.int64]
    stress: Floats


def plot_planetary_set(
    curves: SetCurves, at: int = 0, path: str | os.PathLike[str] | None = None, *, magnified: float | None = None, dpi: int = 150
) -> "Figure":
    """Draw one position of a loaded set, with deformed gears coloured by von Mises stress. Save to `path` if given.

    Each gear is solved separately by finite elements under the loads of the set's meshes. Rigid rotations and shifts of sun and
    planets are not drawn. Each load acts on three nodes, so that the stress near it is not meaningful. Crack faces are free:
    faces that touch (``curves.meta["shut"]``) pass through each other in the picture. A missing tooth is drawn as root circle, a
    chipped tooth with its cut.

    Parameters
    ----------
    curves : SetCurves
        Of a case with a held ring or one on rigid pads, without modified flanks.
    at : int
        Number of the position, from 0.
    path : path, optional
    magnified : float, optional
        Magnification of displacements; default: the largest is visible.
    dpi : int
        Dots per inch.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        If the set cannot be meshed gear by gear (see `planetary_sets.loaded_gears.drawable`), or an argument is out of range.
    """
    if path is not None:
        check_output(path, "picture")
    if magnified is not None:
        ranged("magnified", magnified, above=0.0)
    ((shapes, supports),) = loaded_shapes(curves, [at])
    return draw_set(shapes, supports, path, magnified=magnified, dpi=dpi)


def loaded_shapes(curves: SetCurves, positions: Sequence[int]) -> list[tuple[list[Shape], Floats | None]]:
    """Return the `Shape` of every gear at some positions, and the held places of the ring ``(2, n)`` [mm].

    The latter is None if it is held all around. Pads rotate with the ring, since the carrier is fixed. Each gear is meshed and
    factored once. ValueError for the reasons of `gearfe.planetary_sets.loaded_gears.drawable`.
    """
    sides, bodies = [], []
    for at in positions:
        case, stand = drawable(curves, at)
        sides.append([one for pair in touching(case, stand, curves, at) for one in pair])
        bodies.append(placed(case, stand, curves, at))
    made = []
    for k, same in enumerate(steps(list(zip(*bodies, strict=True)))):
        name = ("sun", *(f"planet{i + 1}" for i in range(case.planets)), "ring")[k]
        loads = [[side for side in one if side["body"] == k] for one in sides]
        made.append(_shapes(case, same, loads, case.damage.get(name, ())))
    pads: list[Floats | None] = [None] * len(bodies)
    if case.ring != "held":
        pads = [cartesian(1.03 * case.ring_gear.r_rim, case.ring.middles + there[-1][3]) for there in bodies]
    return [(list(one), held) for one, held in zip(zip(*made, strict=True), pads, strict=True)]


def _shapes(case, bodies, sides, damage):
    """Return the `Shape` of one gear at each position, under the loads on its flanks and with its supports."""
    gear, material, centre, *_ = bodies[0]
    size = {name: edge * gear.m_n for name, edge in EDGE.items()}
    cracks, broken = [one for one in damage if isinstance(one, Crack)], broken_of(damage)
    rolls = {
        (tooth, side): stations(_left_of(gear, broken, tooth, side), size["flank"])
        for tooth, side in {(one["tooth"], one["side"]) for there in sides for one in there}
    }
    made, held = meshed(case, gear, rolls, size["fillet"], size["near"], size["far"], 0.3 * gear.m_n, cracks, broken)
    mesh = made.mesh
    facets = mesh.boundaries["held"]
    mesh = mesh.with_boundaries({"held": facets[np.isin(mesh.nvertices + facets, held)]})
    solver = HeldSection(mesh, material)
    out = []
    for (*_, angle, _), there in zip(bodies, sides, strict=True):
        load = sum((_load(gear, made, rolls, side) for side in there), np.zeros((2 * mesh.doflocs.shape[1], 1)))
        u = solver.solve(load)[:, 0]
        place, moved = (turned(one, angle) for one in (mesh.doflocs, u.reshape(-1, 2).T))
        out.append(
            Shape(place + centre[:, None], moved, solver.nodes, _mises(*solver.stress(u, 0.05 if cracks else 0.0), material.nu))
        )
    return out


def _left_of(gear, broken, tooth, side):
    """Return a gear whose flanks end where the flank of a `tooth` ends on one `side` (0 right, 1 left)."""
    chip = chip_of(gear, broken, tooth)
    return shortened(gear, chip.end_roll(gear, SIDES[side])) if chip else gear


def _load(gear, made, rolls, side):
    """Return the nodal forces ``(2 n, 1)`` of the load on a flank."""
    at = side["tooth"], side["side"]
    unit = line_loads(gear, made.mesh, made.flank[at], rolls[at], np.array([side["roll"]]), side["side"])
    forces = turned(unit.reshape(-1, 2).T, 2 * math.pi * side["tooth"] / gear.z)
    return side["force"] * forces.T.reshape(-1, 1)


def _mises(xx, yy, xy, nu):
    """Von Mises stress in plane strain [MPa]."""
    zz = nu * (xx + yy)
    return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xy**2)
