"""The gears of the arbiter in CalculiX with large displacements, which the arbiter neglects.

The decks have the meshes of the arbiter. The held edges of both gears are rotated by its approach, and CalculiX prints their
reactions. Faces of
cracks may touch. The two share outlines and meshes. Contact, normals and strains are those of CalculiX.
"""

import subprocess
import tempfile
from pathlib import Path

import numpy as np

from gearfe.decks.pressed import pressing, read_rows, write_lines

from .pressing import pressed
from .touching import Press, stand

PENALTY = 2500.0  # contact pressure per overlap [E/mm]
BESIDE = 0.6  # length of the contact surfaces beyond either end of the pressed zones [m_n]
FACES = (0, 1), (1, 2), (2, 0)


def large_k(pair, flanks, load, phase, material, *, cracks, refines):
    """Return k by CalculiX on the last of the meshes `refines` [N/mm by mm of width]; the arguments are those of `pressed`.

    Raises
    ------
    RuntimeError
        If CalculiX gives no reactions.
    """
    found = pressed(pair, flanks, load, [phase], material, cracks=cracks, refines=refines)
    closing = found.approach[0] - found.least[0]
    orders = [order for order, part in found.force[0].items() if part > 1e-6]
    text = _Text(pair, found, phase, orders)
    contacts = [*text.faces, *((f"S1P{order % 1000}", f"S0P{order % 1000}") for order in orders)]
    solid = f"*MATERIAL, NAME=M\n*ELASTIC\n{material[0]!r}, {material[1]!r}\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1."
    prints = "".join(f"*NODE PRINT, NSET=R{gear}\nRF\n" for gear in (0, 1))
    step = pressing(PENALTY * material[0], contacts, text.motions)
    reaction = _run(["*NODE, NSET=ALL", *text.nodes, *text.blocks, solid, *step, f"{prints}*END STEP\n"])
    radii = pair.gear_1.r_b, pair.gear_2.r_b
    forces = [_torque([reaction[n] for n in nodes], at) / r_b for (nodes, at), r_b in zip(text.held, radii, strict=True)]
    return float(np.mean(forces) / closing)


class _Text:
    """Parts of a deck: nodes, blocks of elements and surfaces, names of the faces of cracks, motions, held nodes and places.

    Of the `Result` `found` at a `phase`, whose tooth pairs `orders` carry.
    """

    def __init__(self, pair, found, phase, orders):
        self.nodes, self.blocks, self.faces, self.motions, self.held, self.elements = [], [], [], [], [], 0
        press, turns = Press(pair, [body.outline for body in found.bodies]), stand(pair, phase, np.array([0]))
        for gear, turn in enumerate((turns.turn_1[0], turns.turn_2[0])):
            x, y = found.bodies[gear].nodes
            angle, radius = press.mirror[gear] * np.arctan2(x, y) + turn, np.hypot(x, y)
            further = angle + found.approach[0] * press.rates[gear]
            place, aim = (radius * np.array([np.sin(at), np.cos(at)]) for at in (angle, further))
            self._add(gear, found, place, press.centres[gear], aim, {o: _beside(pair, found, gear, o) for o in orders})

    def _add(self, gear, found, place, centre, aim, pressed_edges):
        body, first, start = found.bodies[gear], len(self.nodes), self.elements
        self.nodes += [f"{first + i}, {x:.12e}, {y + centre:.12e}, 0." for i, (x, y) in enumerate(place.T.tolist(), 1)]
        elements = _turned(body.triangles, place)
        self.blocks.append("*ELEMENT, TYPE=CPE6, ELSET=E")
        rows = (elements + first + 1).T.tolist()
        self.blocks += [f"{start + j}, {', '.join(map(str, row))}" for j, row in enumerate(rows, 1)]
        for order, edges in pressed_edges.items():
            self.blocks += _surface(f"S{gear}P{order % 1000}", elements, edges, start)
        for number, (left, right, _) in enumerate(body.seams):
            names = tuple(f"K{gear}Q{number}{side}" for side in "LR")
            for name, nodes in zip(names, (left, right), strict=True):
                self.blocks += _surface(name, elements, _edges(nodes[: nodes.size // 2]), start)
            self.faces.append(names)
        fixed, numbers = body.fixed, (body.fixed + first + 1).tolist()
        for n, u, v in zip(numbers, *(aim - place)[:, fixed].tolist(), strict=True):
            self.motions.append(f"{n}, 1, 1, {u:.12e}\n{n}, 2, 2, {v:.12e}")
        self.blocks += [f"*NSET, NSET=R{gear}", *(f"{n}," for n in numbers)]
        self.held.append((numbers, aim[:, fixed]))
        self.elements += len(rows)


def _turned(triangles, place):
    """Return the triangles ``(6, n)`` with their corners counter-clockwise, as CalculiX numbers them."""
    (ax, ay), (bx, by) = (place[:, triangles[k]] - place[:, triangles[0]] for k in (1, 2))
    return np.where(ax * by > ay * bx, triangles, triangles[[0, 2, 1, 5, 4, 3]])


def _edges(chain):
    """Edges ``(2, n)`` along a chain of nodes."""
    return np.sort([chain[:-1], chain[1:]], axis=0)


def _beside(pair, found, gear, order):
    """Edges ``(2, n)`` of the loaded side of a tooth near its pressed zones."""
    places, numbers = found.bodies[gear].vertices[order % pair.gears[gear].z]
    pushed = [zone for zone, p, *_ in found.zones[0][1].pressed if zone.order == order and p.max() > 0]
    met = np.concatenate([zone.s if zone.own == gear else zone.met[np.isfinite(zone.met)] for zone in pushed])
    more = BESIDE * pair.gear_1.m_n
    return _edges(numbers[(places >= met.min() - more) & (places <= met.max() + more)])


def _surface(name, elements, edges, start):
    """Lines of a surface of element faces that are these edges; the first element has the number after `start`."""
    wanted, lines = set(map(tuple, edges.T.tolist())), [f"*SURFACE, NAME={name}, TYPE=ELEMENT"]
    for face, ends in enumerate(FACES, 1):
        rows = np.sort(elements[list(ends)], axis=0).T.tolist()
        lines += [f"{start + j}, S{face}" for j, row in enumerate(rows, 1) if tuple(row) in wanted]
    return lines


def _torque(reactions, place):
    (fx, fy), (x, y) = np.array(reactions).T[:2], place
    return abs(float((x * fy - y * fx).sum()))


def _run(lines):
    """Return the reactions that CalculiX prints for a deck, by node."""
    with tempfile.TemporaryDirectory() as folder:
        write_lines(Path(folder) / "p.inp", lines)
        told = subprocess.run(["ccx", "-i", "p"], cwd=folder, capture_output=True, text=True, check=False)
        printed = Path(folder) / "p.dat"
        if not printed.is_file() or not printed.stat().st_size:
            raise RuntimeError(f"CalculiX gives no reactions: {told.stdout[-300:]}")
        return read_rows(printed)
