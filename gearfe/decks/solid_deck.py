"""Bodies of a CalculiX or Abaqus deck: triangles, hexahedra or tets, outer faces, materials, held and moved nodes."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..flexibility.finite_elements.folds import check_folds, unfolded
from ..flexibility.finite_elements.hexahedron import ORDER, TWENTY
from ..flexibility.finite_elements.tetrahedron import nodes_of, second_order
from ..geometry.aliases import Floats
from ..geometry.mesh.holed_drawing import on_outline
from ..geometry.mesh.holes import Holed
from ..geometry.mesh.solid import Solid
from ..geometry.tooth.profile import cartesian, flank

MIRROR = np.array([ORDER.index((node, 2 - level)) for node, level in ORDER])  # node order with bottom and top exchanged
MIRRORED = {20: MIRROR, 10: np.array([0, 2, 1, 3, 6, 5, 4, 7, 9, 8])}
FACES = {  # corners of the faces in CalculiX's order
    20: ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
    10: ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    6: ((0, 1), (1, 2), (2, 0)),
}
KINDS = {20: "C3D20R", 10: "C3D10", 6: "CPE6"}
ROW = 15  # numbers per line; CalculiX reads at most 16


@dataclass(frozen=True, slots=True)
class DeckBody:
    """A meshed body: `points` (3, n) [mm], `cells` (20, 10 or 6, m) in CalculiX's order, `held` nodes, `faces` by name.

    Every face of `faces` is named by its corners ``(4, 3 or 2, k)``. The triangles of a section are in plane strain, 1 mm thick.
    """

    points: Floats
    cells: NDArray[np.int64]
    held: NDArray[np.int64]
    faces: dict[Any, NDArray[np.int64]]  # faces of a section by the names of its flanks


def plane_part(mesh, points, flank=None, held=None) -> DeckBody:
    """Return second-order triangles of a section at `points` ``(2, n)`` [mm], with faces by name from vertices in `flank`."""
    nodes = np.vstack([mesh.t[:3], mesh.nvertices + mesh.t2f])
    a, b, c = points[:, nodes[:3]].transpose(1, 0, 2)
    clockwise = (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0] < 0
    cells = np.where(clockwise, nodes[[0, 2, 1, 5, 4, 3]], nodes)
    faces = {name: np.array([line[:-1], line[1:]]) for name, line in (flank or {}).items()}
    return DeckBody(np.vstack([points, 0 * points[:1]]), cells, held_nodes(mesh) if held is None else held, faces)


def held_nodes(mesh):
    """Return the nodes of the held edge of a section."""
    edges = mesh.boundaries["held"]
    return np.unique(np.concatenate([mesh.facets[:, edges].ravel(), mesh.nvertices + edges]))


def part_of(mesh: Solid) -> DeckBody:
    """Return the hexahedra of a gear in its own frame."""
    return DeckBody(mesh.points, mesh.cells[TWENTY], mesh.held, {name: nodes[:4] for name, nodes in mesh.faces.items()})


def holed_part(mesh: Holed, strips=()) -> DeckBody:
    """Return the second-order tets of a gear with its pits cut out, in its own frame.

    Nodes on flanks lie on the involute helicoid, those on the rest of the outline and on the bore on these surfaces. Nodes in the
    middle of edges whose tets would fold are nearer to their chords (`folds.unfolded`). RuntimeError if one of these is in one of
    the `strips` (see `holed_sector`), where the gear touches.
    """
    nodes, cells, number = second_order(mesh.points, mesh.cells[:, mesh.plug < 0])
    gear = mesh.gear
    for name in sorted(mesh.faces, reverse=True):  # Flanks come last, so that shared nodes keep the coordinates of the flank.
        if name.startswith(("outline", "held", "flank ")) and mesh.faces[name].size:
            on_surface = nodes_of(mesh.faces[name], number)
            x, y, z = nodes[:, on_surface]
            radius, angle = _on_surface(gear, name, np.hypot(x, y), np.arctan2(x, y) - gear.twist_rate * z)
            nodes[:2, on_surface] = cartesian(radius, angle + gear.twist_rate * z)
    bent, nodes = nodes, unfolded(nodes, cells)
    _check_strips(gear, nodes[:, (nodes != bent).any(axis=0)], strips)
    held = nodes_of(mesh.faces["held"], number)
    used, kept = np.unique(cells, return_inverse=True)
    place = np.full(nodes.shape[1], -1)
    place[used] = np.arange(used.size)
    faces = {name: place[corners] for name, corners in mesh.faces.items()}
    return DeckBody(nodes[:, used], kept.reshape(cells.shape), place[held], faces)


def _on_surface(gear, name, radius, angle):
    """Return places (radius [mm], angle [rad]) on the nearest point of the surface `name` of a section."""
    if name == "held":
        return gear.held, angle
    if name == "outline":
        return on_outline(gear, radius, angle)
    radius = np.clip(radius, *sorted((gear.r_form, gear.r_a)))
    turn = 2 * np.pi * int(name.split()[1]) / gear.z
    return radius, flank(gear, np.sqrt(np.maximum(radius**2 - gear.r_b**2, 0.0)))[1] + turn


def _check_strips(gear, off, strips):
    """Raise RuntimeError if nodes ``(3, n)`` in the contact strips are not on the flank."""
    x, y, z = off
    radius, angle = np.hypot(x, y), np.arctan2(x, y) - gear.twist_rate * z
    flat = np.array([*cartesian(radius, angle), z])
    for line, reach, _ in strips:
        if (np.linalg.norm(flat[:, :, None] - line[:, None, :], axis=0) < reach).any():
            raise RuntimeError(
                f"tets in the contact zone of z = {gear.z} cannot follow the flank without folding: change refine or per_width"
            )


def placed(part: DeckBody, points: Floats, *, mirrored: bool = False) -> DeckBody:
    """Return a body with nodes at `points`. With `mirrored`, the points are those of its mirror image."""
    cells = part.cells[MIRRORED[len(part.cells)]] if mirrored else part.cells
    return replace(part, points=points, cells=cells)


def sides_of(cells, faces):
    """Return element and side ``(2, k)`` of outer faces given by their corners ``(corners, k)``, counted from 0."""
    corners = np.array(FACES[len(cells)])
    sides = np.sort(cells[corners].transpose(1, 0, 2).reshape(corners.shape[1], -1), axis=0)
    outer = np.sort(faces, axis=0)
    place = np.unique(np.hstack([sides, outer]), axis=1, return_inverse=True)[1]
    side, element = np.divmod(np.flatnonzero(np.isin(place[: sides.shape[1]], place[sides.shape[1] :])), cells.shape[1])
    return np.array([element, side])


def node_lines(part, first=0):
    """Return deck lines of the nodes, numbered from `first` + 1."""
    return [f"{first + i}, {x:.12e}, {y:.12e}, {z:.12e}" for i, (x, y, z) in enumerate(part.points.T.tolist(), 1)]


def cell_lines(part, name, first=0, element=0):
    """Return deck lines of the elements in the set `name`, numbered from `element` + 1. RuntimeError if an element folds."""
    if len(part.cells) > 6:
        check_folds(part.points, part.cells)
    out = [f"*ELEMENT, TYPE={KINDS[len(part.cells)]}, ELSET={name}"]
    for j, row in enumerate((part.cells + first + 1).T.tolist(), 1):
        row = [element + j, *row]
        out += [",".join(map(str, row[k : k + ROW])) + ("," if k + ROW < len(row) else "") for k in range(0, len(row), ROW)]
    return out


def element_lines(part, number, first, element, material):
    """Return deck lines of elements, numbered from `element` + 1, and of material and section of body `number`."""
    out = [f"*MATERIAL, NAME=M{number}\n*ELASTIC\n{material.E!r}, {material.nu!r}"]
    out += [f"*SOLID SECTION, ELSET=G{number}, MATERIAL=M{number}", *(["1."] if len(part.cells) == 6 else [])]
    return [*cell_lines(part, f"G{number}", first, element), *out]


def set_lines(name, nodes):
    """Return deck lines of the node set `name` with `nodes` ``(n,)``, counted from 0."""
    return [f"*NSET, NSET={name}", *(f"{node + 1}," for node in nodes.tolist())]


def surface_lines(part, name, faces, element):
    """Return deck lines of the surface `name` made of outer faces ``(corners, k)``."""
    sides = sides_of(part.cells, faces)
    return [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(f"{element + j + 1}, S{s + 1}" for j, s in sides.T.tolist())]


class Assembly:
    """Bodies as lines of a deck, with consecutive numbers of nodes and elements from 1.

    `nodes`, `blocks` and `motions` are lines; `held` are by body the numbers ``(n,)`` of its held nodes.
    """

    def __init__(self):
        self.nodes, self.blocks, self.motions, self.held = ["*NODE, NSET=ALL"], [], [], []
        self.count = self.elements = 0

    def add(self, number, part, material, surfaces, moved):
        """Add body `number`. `surfaces` are its faces by name. Its held nodes move by `moved` ``(2, k)`` [mm]."""
        self.nodes += node_lines(part, self.count)
        self.blocks += element_lines(part, number, self.count, self.elements, material)
        for name, faces in surfaces.items():
            self.blocks += surface_lines(part, name, faces, self.elements)
        self.blocks += set_lines(f"H{number}", part.held + self.count)
        self.held.append(part.held + self.count + 1)
        for n, u, v in zip(self.held[-1].tolist(), *moved.tolist(), strict=True):
            self.motions += [f"{n}, 1, 1, {u:.10e}", f"{n}, 2, 2, {v:.10e}", *([f"{n}, 3, 3"] if len(part.cells) > 6 else [])]
        self.count, self.elements = self.count + part.points.shape[1], self.elements + part.cells.shape[1]
