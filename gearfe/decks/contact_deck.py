"""A whole gear pair in nonlinear contact as a CalculiX deck: the second opinion on load sharing and corner contact."""

import math
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geometry.mesh.outline import stations
from geometry.mesh.relieved import relieved
from geometry.mesh.section_mesh import section
from geometry.pair.modified import flank_contacts
from geometry.tooth.profile import arc_at

from ..case import Case
from ..elements.elasticity import edge_nodes
from ..elements.fe import EDGES
from ..files import written
from ..flexibility.hertz import contact_modulus, half_width
from .deck import element_nodes, held_nodes
from .pressing import Pressing

TIP = 0.005  # longest edge at a tip corner that may touch [m_n]: pressure ends there steeply
SECTION = 8.0  # edges per Hertz half width


@dataclass(frozen=True, slots=True)
class ContactDeck:
    """What is needed to read the result, of both gears: held nodes (numbers), their places from the centre [mm], r_b [mm]."""

    held: tuple[NDArray[np.int64], NDArray[np.int64]]
    place: tuple[NDArray[np.float64], NDArray[np.float64]]
    r_b: tuple[float, float]

    def forces(self, path: str | os.PathLike[str]) -> tuple[float, float]:
        """``T1 / r_b1`` and ``T2 / r_b2`` per width [N/mm] from the reactions CalculiX printed to the ``.dat`` file `path`."""
        reaction = read_rows(path)
        pushed = [np.array([reaction[n] for n in held.tolist()]).T for held in self.held]
        moment = [float((f[0] * p[1] - f[1] * p[0]).sum()) for f, p in zip(pushed, self.place, strict=True)]
        return moment[0] / self.r_b[0], abs(moment[1]) / self.r_b[1]

    def force(self, path: str | os.PathLike[str]) -> float:
        """Force along the line of action per width [N/mm], the mean of `forces` (see `geometry.pair.contacts`)."""
        return sum(self.forces(path)) / 2


def read_rows(path: str | os.PathLike[str]) -> dict[int, tuple[float, float, float]]:
    """Three values of every node from the ``.dat`` file that CalculiX printed.

    Raises
    ------
    RuntimeError
        If the file is not there or has none: CalculiX did not get that far.
    """
    try:
        lines = Path(path).read_text(encoding="ascii").splitlines()
    except FileNotFoundError as error:
        raise RuntimeError(f"{path} is not there: run 'ccx -i NAME'; if it ran, its output says why it stopped") from error
    rows = [line.split() for line in lines]
    found = {int(r[0]): (float(r[1]), float(r[2]), float(r[3])) for r in rows if len(r) == 4 and r[0].isdigit()}
    if not found:
        raise RuntimeError(f"{path} holds no values: CalculiX found no equilibrium; its .sta and .cvg files say how far it came")
    return found


def write_contact_section(path: str | os.PathLike[str], case: Case, phase: float, approach: float, how: Pressing) -> ContactDeck:
    """The deck of `gearfe.decks.contact_inp.write_contact_inp` in plane strain; TIP edges at the tip corner that touches."""
    pair, materials, forms = case.pair, case.materials, case.forms
    gears, line_load = (pair.gear_1, pair.gear_2), case.forces[0] / min(pair.gear_1.b, pair.gear_2.b)
    found = flank_contacts(pair, [phase], flanks=forms)
    near = np.flatnonzero(found.gap[0] < 1.5 * approach)
    order = found.order[near]
    rolls = found.roll_1[0, near], found.roll_2[0, near]
    widths = half_width(line_load, found.radius[0, near], contact_modulus(materials))
    bodies = [
        _meshed(gear, sense * order, arc_at(gear, roll), widths, how.per_width or SECTION, how.refine)
        for gear, roll, sense in zip(gears, rolls, (1, -1), strict=True)
    ]
    if forms is not None:
        bodies = [relieved(body, form, order, sense) for body, form, sense in zip(bodies, forms, (1, -1), strict=True)]
    turned = how.turned(pair, approach)
    turns = pair.turn(found.nominal[0, near[0]] - order[0] * pair.p_bt)
    lines = ["** gearfe: gear pair in contact, plane strain; mm, N, MPa, per mm of width", "*NODE, NSET=ALL"]
    blocks, ends, held, place, first, element = [], [], [], [], 0, 0
    for number, (body, material, angle) in enumerate(zip(bodies, materials, turned, strict=True), 1):
        x, y = posed(body.mesh.doflocs, turns[number - 1], (1, pair.outward)[number - 1])
        centre = (0.0, pair.centre_2)[number - 1]
        lines += [f"{first + i}, {u:.12e}, {v:.12e}, 0." for i, (u, v) in enumerate(zip(x, y + centre, strict=True), 1)]
        nodes = element_nodes(body.mesh, np.array([x, y]))
        blocks += [f"*ELEMENT, TYPE=CPE6, ELSET=G{number}"]
        blocks += [f"{element + j}, {', '.join(map(str, row))}" for j, row in enumerate((nodes + first + 1).T.tolist(), 1)]
        blocks += [f"*MATERIAL, NAME=M{number}\n*ELASTIC\n{material.E!r}, {material.nu!r}"]
        blocks += [f"*SOLID SECTION, ELSET=G{number}, MATERIAL=M{number}\n1."]
        for k, tooth in enumerate(((1, -1)[number - 1] * order % body.gear.z).tolist()):
            blocks += [f"*SURFACE, NAME=C{number}P{k}, TYPE=ELEMENT"]
            blocks += [f"{element + j}, S{face}" for j, face in flank_faces(body, nodes, tooth)]
        fixed = held_nodes(body.mesh)
        held.append(fixed + first + 1)
        place.append(np.array([x[fixed], y[fixed]]))
        blocks += [f"*NSET, NSET=H{number}", *(f"{n}," for n in held[-1].tolist())]
        moved = np.array(posed(place[-1], angle, 1)) - place[-1]
        for n, u, v in zip(held[-1], *moved, strict=True):
            ends += [f"{n}, 1, 1, {u:.10e}", f"{n}, 2, 2, {v:.10e}"]
        first, element = first + x.size, element + nodes.shape[1]
    stiff = how.penalty * max(m.E for m in materials)
    contact = [f"*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiff:.6e}"]
    for k in range(order.size):
        pinion_slave = abs(rolls[1][k] - pair.gear_2.roll_a) > 1e-9 * pair.gear_2.m_n
        sides = (f"C1P{k}, C2P{k}", f"C2P{k}, C1P{k}")[not pinion_slave]
        contact += ["*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE", sides]
    step = ["*STEP, INC=200, NLGEOM\n*STATIC\n1., 1.", "*BOUNDARY", *ends]
    text = [*lines, *blocks, *contact, *step, "*NODE PRINT, NSET=H1\nRF\n*NODE PRINT, NSET=H2\nRF\n*END STEP\n"]
    with written(path) as name:
        Path(name).write_text("\n".join(text), encoding="ascii")
    return ContactDeck((held[0], held[1]), (place[0], place[1]), (pair.gear_1.r_b, pair.gear_2.r_b))


def _meshed(gear, teeth, arcs, widths, per_width, refine):
    """Section of `gear` with its flanks refined around the contacts at `arcs` [mm] of half `widths` [mm]."""
    edge = {name: size * gear.m_n / refine for name, size in EDGES.items()}
    top, rolls = arc_at(gear, gear.roll_a), {}
    for tooth, arc, a in zip(teeth, arcs, widths, strict=True):
        patch = (arc - 3 * a, arc + 3 * a, a / per_width)
        tip = min(a / per_width / 2, TIP * gear.m_n) if top - arc < 2 * a else a / per_width / 2
        rolls[int(tooth)] = stations(gear, edge["flank"], tip=tip, low=edge["low"], patches=[patch])
    return section(gear, rolls, fillet_size=edge["fillet"], size=edge["near"], far_size=edge["far"])


def posed(points, turn, mirror):
    """Points `(2, n)` of a gear's frame turned clockwise by an angle [rad]; `mirror` -1: seen in the mirror first."""
    x, y = mirror * points[0], points[1]
    return math.cos(turn) * x + math.sin(turn) * y, math.cos(turn) * y - math.sin(turn) * x


def flank_faces(body, nodes, tooth):
    """(element, face) of the loaded flank of `tooth`, numbered from 1; CalculiX counts the faces 1-2, 2-3, 3-1."""
    middles = edge_nodes(body.mesh, body.flank[tooth])[2]
    for face in range(3):
        for j in np.flatnonzero(np.isin(nodes[3 + face], middles)).tolist():
            yield j + 1, face + 1
