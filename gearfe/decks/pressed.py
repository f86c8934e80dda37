"""Text of CalculiX decks of bodies that are pressed together: sections body by body, the contacts between them, the step."""

from pathlib import Path

import numpy as np

from ..core.files import written
from ..flexibility.finite_elements.elasticity import edge_nodes
from .deck import element_nodes


class Sections:
    """Sections of several gears as lines of a deck: second-order triangles, nodes and elements numbered through.

    `held` and `place` are by gear the numbers of the held nodes and their places ``(2, n)`` from the gear's centre [mm].
    """

    def __init__(self):
        self.nodes, self.blocks, self.motions = [], [], []
        self.held, self.place = [], []
        self.count = self.elements = 0

    def add(self, number, body, material, points, centre, fixed, surfaces, moved):
        """Add a gear: its `body`, with ``mesh`` and ``flank``, at `points` ``(2, n)`` about its `centre` ``(2,)`` [mm].

        The nodes `fixed` are held and move by ``moved(places)`` [mm], both ``(2, k)``; `surfaces` are keys of ``body.flank`` by
        the names of surfaces in contact.
        """
        first, element, nodes = self.count, self.elements, element_nodes(body.mesh, points)
        in_place = (points + np.reshape(centre, (2, 1))).T.tolist()
        self.nodes += [f"{first + i}, {x:.12e}, {y:.12e}, 0." for i, (x, y) in enumerate(in_place, 1)]
        self.blocks += [f"*ELEMENT, TYPE=CPE6, ELSET=G{number}"]
        self.blocks += [f"{element + j}, {', '.join(map(str, row))}" for j, row in enumerate((nodes + first + 1).T.tolist(), 1)]
        self.blocks += [f"*MATERIAL, NAME=M{number}\n*ELASTIC\n{material.E!r}, {material.nu!r}"]
        self.blocks += [f"*SOLID SECTION, ELSET=G{number}, MATERIAL=M{number}\n1."]
        for name, key in surfaces.items():
            self.blocks += [f"*SURFACE, NAME={name}, TYPE=ELEMENT"]
            self.blocks += [f"{element + j}, S{face}" for j, face in _flank_faces(body, nodes, key)]
        held, place = fixed + first + 1, points[:, fixed]
        self.blocks += [f"*NSET, NSET=H{number}", *(f"{n}," for n in held.tolist())]
        for n, u, v in zip(held.tolist(), *moved(place).tolist(), strict=True):
            self.motions += [f"{n}, 1, 1, {u:.10e}", f"{n}, 2, 2, {v:.10e}"]
        self.held.append(held)
        self.place.append(place)
        self.count, self.elements = first + points.shape[1], element + nodes.shape[1]


def _flank_faces(body, nodes, key):
    """(element, face) of the loaded flank `key`, numbered from 1; CalculiX counts the faces 1-2, 2-3, 3-1."""
    middles = edge_nodes(body.mesh, body.flank[key])[2]
    for face in range(3):
        for j in np.flatnonzero(np.isin(nodes[3 + face], middles)).tolist():
            yield j + 1, face + 1


def pressing(stiffness, contacts, motions, step="*STEP, INC=200, NLGEOM"):
    """Contacts between surfaces (slave, master) of a stiffness, pressure over overlap [N/mm^3], and the step with the motions."""
    yield f"*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiffness:.6e}"
    for surfaces in contacts:
        yield from ("*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE", ", ".join(surfaces))
    yield from (f"{step}\n*STATIC\n1., 1.", "*BOUNDARY", *motions)


def write_lines(path, lines):
    """Write the lines of a deck."""
    with written(path) as name:
        Path(name).write_text("\n".join(lines), encoding="ascii")


def read_rows(path, heading=None):
    """Three values of every node from the ``.dat`` file that CalculiX printed.

    Only those under lines that begin with the word `heading`, default all. RuntimeError if the file is not there or has none:
    CalculiX did not get that far.
    """
    try:
        lines = Path(path).read_text(encoding="ascii").splitlines()
    except FileNotFoundError as error:
        raise RuntimeError(
            f"{path} does not exist: run 'ccx -i NAME'; if CalculiX has run, its output states the reason"
        ) from error
    out, in_part = {}, heading is None
    for row in map(str.split, lines):
        if row and not row[0].isdigit():
            in_part = heading in (None, row[0])
        elif in_part and len(row) == 4:
            out[int(row[0])] = tuple(map(float, row[1:]))
    if not out:
        noun = heading or "values"
        raise RuntimeError(f"{path} holds no {noun}: CalculiX found no equilibrium; see its .sta and .cvg files")
    return out
