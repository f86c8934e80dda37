"""Whole planetary set in contact as a CalculiX deck, as an independent reference for `planetary_stiffness`.

Sun and planets are rotated by the solution of `planetary_stiffness`, and the ring is held on its pads. CalculiX then computes the
contact forces.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.checks import checked_refine
from ..core.files import check_output
from ..core.record import ranged
from ..decks.contact_deck import TIP
from ..decks.pressed import pressing, read_rows, write_lines
from ..decks.solid_deck import Assembly, held_nodes, plane_part, set_lines
from ..flexibility.finite_elements.fe import EDGES
from ..flexibility.finite_elements.one_tooth import edge_lengths
from ..geometry.aliases import Floats, StrPath
from ..geometry.mesh.outline import stations
from ..geometry.tooth.profile import arc_at, turned
from .case import PlanetaryCase
from .curves import SetCurves
from .loaded_gears import drawable, meshed, placed, touching
from .standing import directions

MOST = 200  # largest number of element edges across half a contact


@dataclass(frozen=True, slots=True)
class SetDeck:
    """Data to read the result of a deck of a whole set.

    `held` and `place` are the numbers ``(n,)`` of the held nodes of sun, planets and ring, and their positions ``(2, n)`` from
    the gear's centre [mm]. `rim` and `around` are those of the nodes of the ring's outer edge. `angle` is that of the ring's
    tooth 0, clockwise [rad].
    """

    case: PlanetaryCase
    held: list[NDArray[np.int64]]
    place: list[Floats]
    rim: NDArray[np.int64]
    around: Floats
    angle: float

    def forces(self, path: StrPath) -> dict[str, Any]:
        """Read the forces that CalculiX printed to the ``.dat`` file `path`, per width [N/mm].

        ``"sun"``, ``"ring"``: torque over the base radius. ``"outer"``, ``"inner"`` ``(planets,)``: forces of the meshes of each
        planet with sun and ring, from its pin's force and torque. RuntimeError if the file is not there, or holds no forces.
        """
        reaction = read_rows(path, "forces")
        moments, sums = [], []
        for nodes, place in zip(self.held, self.place, strict=True):
            f = np.array([reaction[n] for n in nodes.tolist()])[:, :2].T
            moments.append(float((place[1] * f[0] - place[0] * f[1]).sum()))
            sums.append(f.sum(axis=1))
        gears, n = self.case.gears, self.case.planets
        outer, inner = directions(gears, np.array(self.case.planet_angles))
        meshes = []
        for i in range(n):  # The pin carries the loads of both meshes: a force and a clockwise torque.
            rows = np.column_stack([np.append(outer[:, i], -1.0), np.append(inner[:, i], 1.0)])
            right = -np.append(sums[1 + i], moments[1 + i] / gears.planet.r_b)
            meshes.append(np.linalg.lstsq(rows, right, rcond=None)[0])
        loads = np.array(meshes).T
        return {
            "sun": moments[0] / gears.sun.r_b,
            "ring": moments[-1] / gears.ring.r_b,
            "outer": loads[0],
            "inner": loads[1],
        }

    def moved(self, path: StrPath) -> tuple[NDArray, NDArray]:
        """Read angles ``(n,)`` of the rim's nodes from the ring's tooth 0 [rad], and their displacements.

        The displacements ``(n, 2)`` are outwards and clockwise [mm].
        """
        displacements = read_rows(path, "displacements")
        u = np.array([displacements[n] for n in self.rim.tolist()])[:, :2]
        angle = np.arctan2(*self.around)
        sin, cos = np.sin(angle), np.cos(angle)
        out = np.column_stack([sin * u[:, 0] + cos * u[:, 1], cos * u[:, 0] - sin * u[:, 1]])
        return (angle - self.angle) % (2 * math.pi), out


def write_set_inp(
    path: StrPath,
    curves: SetCurves,
    at: int,
    *,
    per_width: float = 6.0,
    penalty: float = 500.0,
    refine: float = 1.0,
) -> SetDeck:
    """Write a CalculiX deck of one position of a set: all teeth of all gears in second-order triangles, plane strain.

    Sun and planets are rotated at their held edges by the solution of `planetary_stiffness`. The deck has small displacements and
    frictionless surface-to-surface contact of all flanks that may touch. ``ccx -i NAME`` writes ``NAME.dat``, which
    `SetDeck.forces` and `SetDeck.moved` read.

    Parameters
    ----------
    path : path
        Ends in ``.inp``.
    curves : SetCurves
        Of a case with a held ring or one on rigid pads, without modified flanks and damage.
    at : int
        Number of the position, from 0.
    per_width : float
        Element edges per Hertz half width of each contact.
    penalty : float
        Stiffness of the contact springs: pressure per overlap, over E [1/mm].
    refine : float
        Divides the other edge lengths.

    Returns
    -------
    SetDeck

    Raises
    ------
    ValueError
        If the set cannot be meshed gear by gear (see `planetary_sets.loaded_gears.drawable`) or has damage. If a mesh is
        unloaded, or an argument is out of range.
    """
    check_output(path, "deck")
    case, stand = drawable(curves, at)
    if case.damage:
        raise ValueError("damage of a set is not in its deck: give curves of a case without it")
    without = np.flatnonzero((curves.force[:, at] == 0).any(axis=0)).tolist()
    if without:
        raise ValueError(f"planet {without[0] + 1} is unloaded at position {at}, so its place is undefined: choose another")
    for name, value in (("per_width", per_width), ("penalty", penalty)):
        ranged(name, value, above=0.0)
    if per_width > MOST:
        raise ValueError(f"per_width = {per_width:g} edges across half a contact, but give at most {MOST}")
    refine = checked_refine(refine)
    pressed, bodies = touching(case, stand, curves, at), placed(case, stand, curves, at)
    assembly, places = Assembly(), []
    for number, (gear, material, centre, angle, (turn, shift)) in enumerate(bodies):
        rolls = _rolls(gear, [side for pair in pressed for side in pair if side["body"] == number], per_width, refine)
        edge = edge_lengths(gear, EDGES, refine)
        section, fixed = meshed(case, gear, rolls, edge["fillet"], edge["near"], edge["far"], 0.05 / refine)
        points = turned(section.mesh.doflocs, angle)
        part = plane_part(section.mesh, points, section.flank, fixed)
        surfaces = {_surface(number, *flank): faces for flank, faces in part.faces.items()}
        places.append(points[:, fixed])
        part.points[:2] += np.reshape(centre, (2, 1))
        moved = np.array([[0.0, turn], [-turn, 0.0]]) @ places[-1] + np.reshape(shift, (2, 1))
        assembly.add(number, part, material, surfaces, moved)
    edge_of_ring = held_nodes(section.mesh)
    rim, around = edge_of_ring + assembly.count - points.shape[1] + 1, points[:, edge_of_ring]
    title = "** gearfe: planetary set, plane strain; mm, N, MPa, per mm of width"
    step = pressing(penalty * max(m.E for m in case.material), _contacts(pressed), assembly.motions, "*STEP, INC=200")
    prints = [*(f"*NODE PRINT, NSET=H{k}\nRF" for k in range(len(bodies))), "*NODE PRINT, NSET=RIM\nU"]
    lines = [title, *assembly.nodes, *assembly.blocks, *set_lines("RIM", rim - 1), *step, *prints, "*END STEP\n"]
    write_lines(path, lines)
    return SetDeck(case, assembly.held, places, rim, around, bodies[-1][3])


def _contacts(pressed):
    """Return the surfaces in contact as (slave, master). The slave has the tip corner and finer edges."""
    for sides in pressed:
        pinion, wheel = (_surface(side["body"], side["tooth"], side["side"]) for side in sides)
        yield (wheel, pinion) if sides[1]["tip"] else (pinion, wheel)


def _surface(body, tooth, side):
    return f"C{body}T{tooth}S{side}"


def _rolls(gear, sides, per_width, refine):
    """Return roll lengths of the vertices of loaded flanks, by tooth and side."""
    edge, top, out = edge_lengths(gear, EDGES, refine), arc_at(gear, gear.roll_a), {}
    for side in sides:
        arc, a = side["arc"], side["width"]
        tip = min(a / per_width / 2, TIP * gear.m_n) if top - arc < 2 * a else 0.05 * gear.m_n
        patch = (arc - 3 * a, arc + 3 * a, a / per_width)
        out[side["tooth"], side["side"]] = stations(gear, 2 * edge["flank"], tip=tip, low=edge["flank"], patches=[patch])
    return out
