"""A whole planetary set in contact as a CalculiX deck: the second opinion on `planetary_stiffness`.

Sun and planets are turned by what was found here, the ring is held on its pads; what the bodies then push is CalculiX's own.
"""

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.mesh.outline import stations
from geometry.tooth.profile import arc_at

from ..checks import checked_refine, is_number
from ..decks.contact_deck import TIP, flank_faces, posed
from ..decks.deck import element_nodes, held_nodes
from ..elements.fe import EDGES
from ..files import check_output, written
from .case import PlanetaryCase
from .curves import SetCurves
from .loaded_gears import drawable, meshed, placed, touching
from .standing import directions


@dataclass(frozen=True, slots=True)
class SetDeck:
    """What is needed to read the result.

    Attributes
    ----------
    case : PlanetaryCase
    held, place : list of ndarray, shape (n,) and (2, n)
        Numbers of the held nodes of sun, planets and ring, and their places from the gear's centre [mm].
    rim, around : ndarray, shape (n,) and (2, n)
        Numbers and places [mm] of the nodes of the ring's outer edge.
    angle : float
        Clockwise angle of the ring's tooth 0 [rad].
    """

    case: PlanetaryCase
    held: list[NDArray[np.int64]]
    place: list[NDArray[np.float64]]
    rim: NDArray[np.int64]
    around: NDArray[np.float64]
    angle: float

    def forces(self, path: str | os.PathLike[str]) -> dict[str, Any]:
        """What CalculiX printed to the ``.dat`` file `path`, per width [N/mm].

        ``"sun"``, ``"ring"``: torque over the base radius. ``"outer"``, ``"inner"`` ``(planets,)``: forces of the meshes of each
        planet with sun and ring, from its pin's force and torque.

        Raises
        ------
        RuntimeError
            If the file is not there, or holds no forces.
        """
        reaction = _printed(path, "forces")
        moments, sums = [], []
        for nodes, place in zip(self.held, self.place, strict=True):
            f = np.array([reaction[n] for n in nodes.tolist()])[:, :2].T
            moments.append(float((place[1] * f[0] - place[0] * f[1]).sum()))
            sums.append(f.sum(axis=1))
        gears, n = self.case.gears, self.case.planets
        outer, inner = directions(gears, np.array(self.case.angles))
        meshes = []
        for i in range(n):  # the pin holds against both meshes: force and clockwise torque
            rows = np.column_stack([np.append(outer[:, i], -1.0), np.append(inner[:, i], 1.0)])
            right = -np.append(sums[1 + i], moments[1 + i] / gears.planet.r_b)
            meshes.append(np.linalg.lstsq(rows, right, rcond=None)[0])
        found = np.array(meshes).T
        return {"sun": moments[0] / gears.sun.r_b, "ring": moments[-1] / gears.ring.r_b, "outer": found[0], "inner": found[1]}

    def moved(self, path: str | os.PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Angles ``(n,)`` of the rim's nodes from the ring's tooth 0 [rad]; how they move outwards, clockwise ``(n, 2)`` [mm]."""
        found = _printed(path, "displacements")
        u = np.array([found[n] for n in self.rim.tolist()])[:, :2]
        angle = np.arctan2(*self.around)
        sin, cos = np.sin(angle), np.cos(angle)
        out = np.column_stack([sin * u[:, 0] + cos * u[:, 1], cos * u[:, 0] - sin * u[:, 1]])
        return (angle - self.angle) % (2 * math.pi), out


def _printed(path, what):
    """Rows of each node from the parts of a ``.dat`` file whose heading begins with `what`."""
    try:
        lines = Path(path).read_text(encoding="ascii").splitlines()
    except FileNotFoundError as error:
        raise RuntimeError(f"{path} is not there: run 'ccx -i NAME'; if it ran, its output says why it stopped") from error
    out, on = {}, False
    for line in lines:
        row = line.split()
        if row and not row[0].isdigit():
            on = row[0] == what
        elif on and len(row) == 4:
            out[int(row[0])] = tuple(map(float, row[1:]))
    if not out:
        raise RuntimeError(f"{path} holds no {what}: CalculiX found no equilibrium; its .sta and .cvg files say how far it came")
    return out


def write_set_inp(
    path: str | os.PathLike[str],
    curves: SetCurves,
    at: int,
    *,
    per_width: float = 6.0,
    penalty: float = 500.0,
    refine: float = 1.0,
) -> SetDeck:
    """Write a CalculiX deck of one position of a set: all gears with all teeth in second-order triangles, plane strain.

    Sun and planets are turned, at the edges where they are held, by what `planetary_stiffness` found. Small displacements;
    frictionless surface-to-surface contact of all flanks that may touch. ``ccx -i NAME`` writes ``NAME.dat``, which
    `SetDeck.forces` and `SetDeck.moved` read.

    Parameters
    ----------
    path : path
        Ends in ``.inp``.
    curves : SetCurves
        Of a case with a held ring or one on rigid pads, without modified flanks and cracks.
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
        If the set cannot be meshed gear by gear, as of `gearfe.epicyclic.loaded_gears.drawable`, or an argument is out of range.
    """
    check_output(path, "deck")
    case, stand = drawable(curves, at)
    for name, value in (("per_width", per_width), ("penalty", penalty)):
        if not (is_number(value) and 0 < value < math.inf):
            raise ValueError(f"{name} = {value!r}, but give a finite number > 0")
    refine = checked_refine(refine)
    pressed, bodies = touching(case, stand, curves, at), placed(case, stand, curves, at)
    lines = ["** gearfe: planetary set, plane strain; mm, N, MPa, per mm of width", "*NODE, NSET=ALL"]
    blocks, ends, held, place, first, element = [], [], [], [], 0, 0
    for number, (gear, material, centre, angle, moved) in enumerate(bodies):
        rolls = _rolls(gear, [one for pair in pressed for one in pair if one["body"] == number], per_width, refine)
        edge = {name: size * gear.m_n / refine for name, size in EDGES.items()}
        made, fixed = meshed(case, gear, rolls, edge["fillet"], edge["near"], edge["far"], 0.05 / refine)
        own = np.array(posed(made.mesh.doflocs, angle, 1))
        lines += [f"{first + k}, {u:.12e}, {v:.12e}, 0." for k, (u, v) in enumerate((own.T + centre).tolist(), 1)]
        nodes = element_nodes(made.mesh, own)
        blocks += _body_lines(number, material, made, nodes, first, element)
        held.append(fixed + first + 1)
        place.append(own[:, fixed])
        blocks += [f"*NSET, NSET=H{number}", *(f"{n}," for n in held[-1].tolist())]
        turn, shift = moved
        u = np.array([place[-1][1] * turn, -place[-1][0] * turn]) + np.reshape(shift, (2, 1))
        for n, (ux, uy) in zip(held[-1].tolist(), u.T.tolist(), strict=True):
            ends += [f"{n}, 1, 1, {ux:.10e}", f"{n}, 2, 2, {uy:.10e}"]
        edge_of_last, first, element = held_nodes(made.mesh), first + own.shape[1], element + nodes.shape[1]
    rim, around = edge_of_last + first - own.shape[1] + 1, own[:, edge_of_last]
    blocks += ["*NSET, NSET=RIM", *(f"{n}," for n in rim.tolist())]
    stiff = penalty * max(m.E for m in case.material)
    law = f"*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiff:.6e}"
    step = ["*STEP, INC=200\n*STATIC\n1., 1.", "*BOUNDARY", *ends]
    prints = [*(f"*NODE PRINT, NSET=H{k}\nRF" for k in range(len(bodies))), "*NODE PRINT, NSET=RIM\nU"]
    text = [*lines, *blocks, law, *_contact_lines(pressed), *step, *prints, "*END STEP\n"]
    with written(path) as name:
        Path(name).write_text("\n".join(text), encoding="ascii")
    return SetDeck(case, held, place, rim, around, bodies[-1][3])


def _body_lines(number, material, made, nodes, first, element):
    """Elements, material and loaded flanks of one gear, its nodes and elements counted after `first` and `element`."""
    yield f"*ELEMENT, TYPE=CPE6, ELSET=G{number}"
    yield from (f"{element + j}, {', '.join(map(str, row))}" for j, row in enumerate((nodes + first + 1).T.tolist(), 1))
    yield f"*MATERIAL, NAME=M{number}\n*ELASTIC\n{material.E!r}, {material.nu!r}"
    yield f"*SOLID SECTION, ELSET=G{number}, MATERIAL=M{number}\n1."
    for tooth, side in made.flank:
        yield f"*SURFACE, NAME={_surface(number, tooth, side)}, TYPE=ELEMENT"
        yield from (f"{element + j}, S{face}" for j, face in flank_faces(made, nodes, (tooth, side)))


def _contact_lines(pressed):
    for one, two in pressed:
        pinion, wheel = (_surface(side["body"], side["tooth"], side["side"]) for side in (one, two))
        yield "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE"
        yield ", ".join((wheel, pinion) if two["tip"] else (pinion, wheel))


def _surface(body, tooth, side):
    return f"C{body}T{tooth}S{side}"


def _rolls(gear, sides, per_width, refine):
    """Roll lengths of the vertices of loaded flanks, by tooth and side."""
    edge, top, out = {name: size * gear.m_n / refine for name, size in EDGES.items()}, arc_at(gear, gear.roll_a), {}
    for one in sides:
        arc, a = one["arc"], one["width"]
        tip = min(a / per_width / 2, TIP * gear.m_n) if top - arc < 2 * a else 0.05 * gear.m_n
        patch = (arc - 3 * a, arc + 3 * a, a / per_width)
        out[one["tooth"], one["side"]] = stations(gear, 2 * edge["flank"], tip=tip, low=edge["flank"], patches=[patch])
    return out
