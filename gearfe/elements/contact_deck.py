"""A whole gear pair in nonlinear contact as a CalculiX deck: the second opinion on load sharing and corner contact."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geometry.mesh.outline import stations
from geometry.mesh.section_mesh import section
from geometry.tooth.profile import arc_at

from ..files import written
from ..flexibility.hertz import contact_modulus, half_width
from .deck import element_nodes, held_nodes
from .elasticity import edge_nodes
from .fe import EDGES


@dataclass(frozen=True, slots=True)
class ContactDeck:
    """What is needed to read the result: the pinion's held nodes (numbers and places [mm]) and its base radius [mm]."""

    held: np.ndarray
    place: np.ndarray
    r_b: float

    def force(self, path):
        """Force along the line of action per width [N/mm] from the reactions CalculiX printed to the ``.dat`` file `path`."""
        rows = [line.split() for line in Path(path).read_text().splitlines()]
        reaction = {int(r[0]): (float(r[1]), float(r[2])) for r in rows if len(r) == 4 and r[0].isdigit()}
        pushed = np.array([reaction[n] for n in self.held.tolist()]).T
        return float((pushed[0] * self.place[1] - pushed[1] * self.place[0]).sum() / self.r_b)


def write_contact_inp(path, pair, phase, approach, line_load, materials, *, per_width=8, penalty=500.0, refine=1.0):
    """Write a deck that turns the pinion's bore by ``approach / r_b1`` against the held wheel.

    Frictionless surface-to-surface contact of all flanks that may touch, with a linear pressure-overclosure of `penalty` times
    E (50 is 0.8 % too soft, 500 is not distinguishable from more); small displacements. ``ccx -i NAME`` prints the reactions of
    the pinion's bore, from which `ContactDeck.force` gives the load.

    Parameters
    ----------
    path : path
    pair : GearPair
    phase : float
    approach : float
        Rotation of the pinion as a length on the line of action [mm].
    line_load : float
        Expected load [N/mm]; decides where the flanks are refined.
    materials : (Material, Material)
    per_width : int
        Edges per Hertz half width in the contact zones.
    penalty : float
    refine : float
        Divides the other edge lengths.

    Returns
    -------
    ContactDeck
    """
    found = pair.contacts([phase])
    near = np.flatnonzero(found.gap[0] < 1.5 * approach)
    order = found.order[near]
    turns = pair.turn(found.nominal[0, near[0]] - order[0] * pair.p_bt)
    radius = pair.relative_radius(found.roll_1[0, near], found.roll_2[0, near])
    widths = half_width(line_load, radius, contact_modulus(materials))
    bodies = []
    for gear, roll, sense in ((pair.gear_1, found.roll_1[0, near], 1), (pair.gear_2, found.roll_2[0, near], -1)):
        edge = {name: size * gear.m_n / refine for name, size in EDGES.items()}
        rolls = {}
        for tooth, arc, a in zip(sense * order, arc_at(gear, roll), widths, strict=True):
            patch = (arc - 3 * a, arc + 3 * a, a / per_width)
            rolls[int(tooth)] = stations(gear, edge["flank"], tip=a / per_width / 2, low=edge["low"], patches=[patch])
        sizes = {"fillet_size": edge["fillet"], "size": edge["near"], "far_size": edge["far"]}
        bodies.append(section(gear, rolls, **sizes))
    lines = ["** gearfe: gear pair in contact, plane strain; mm, N, MPa, per mm of width", "*NODE, NSET=ALL"]
    ends, held, first, element = ["*STEP, INC=200\n*STATIC\n1., 1.", "*BOUNDARY"], None, 0, 0
    blocks = []
    for number, (body, turn, centre, mirror, material) in enumerate(
        zip(bodies, turns, (0.0, pair.centre_2), (1, pair.outward), materials, strict=True), 1
    ):
        x, y = _posed(body.mesh.doflocs, turn, centre, mirror)
        lines += [f"{first + i}, {u:.12e}, {v:.12e}, 0." for i, (u, v) in enumerate(zip(x, y, strict=True), 1)]
        nodes = element_nodes(body.mesh, np.array([x, y]))
        blocks += [f"*ELEMENT, TYPE=CPE6, ELSET=G{number}"]
        blocks += [f"{element + j}, {', '.join(map(str, row))}" for j, row in enumerate((nodes + first + 1).T.tolist(), 1)]
        blocks += [f"*MATERIAL, NAME=M{number}\n*ELASTIC\n{material.E!r}, {material.nu!r}"]
        blocks += [f"*SOLID SECTION, ELSET=G{number}, MATERIAL=M{number}\n1.", f"*SURFACE, NAME=C{number}, TYPE=ELEMENT"]
        blocks += [f"{element + j}, S{face}" for j, face in _flank_faces(body, nodes)]
        fixed = held_nodes(body.mesh)
        blocks += [f"*NSET, NSET=H{number}", *(f"{n}," for n in (fixed + first + 1).tolist())]
        if number == 1:
            held, turned = ContactDeck(fixed + 1, np.array([x[fixed], y[fixed]]), pair.gear_1.r_b), approach / pair.gear_1.r_b
            for n, u, v in zip(held.held, *held.place, strict=True):
                ends += [f"{n}, 1, 1, {turned * v:.10e}", f"{n}, 2, 2, {-turned * u:.10e}"]
        first, element = first + x.size, element + nodes.shape[1]
    stiff = penalty * max(m.E for m in materials)
    contact = f"*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiff:.6e}"
    pairing = "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nC1, C2"
    text = [*lines, *blocks, contact, pairing, *ends, "H2, 1, 2", "*NODE PRINT, NSET=H1\nRF\n*END STEP\n"]
    with written(path) as name:
        Path(name).write_text("\n".join(text), encoding="ascii")
    return held


def _posed(points, turn, centre, mirror):
    x, y = mirror * points[0], points[1]
    return math.cos(turn) * x + math.sin(turn) * y, math.cos(turn) * y - math.sin(turn) * x + centre


def _flank_faces(body, nodes):
    """(element, face) of the loaded flanks, numbered from 1; CalculiX counts the faces 1-2, 2-3, 3-1."""
    middles = np.concatenate([edge_nodes(body.mesh, chain)[2] for chain in body.flank.values()])
    for face in range(3):
        for j in np.flatnonzero(np.isin(nodes[3 + face], middles)).tolist():
            yield j + 1, face + 1
