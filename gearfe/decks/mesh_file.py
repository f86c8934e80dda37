"""`export_mesh`: the undeformed mesh of a damaged tooth or a whole gear as a file that other programs read."""

import os
from collections.abc import Sequence

import numpy as np

from ..core.checks import checked_refine
from ..core.cost import Cost, check_cost
from ..core.files import check_output, suffix_of, written
from ..flexibility.finite_elements.folds import check_folds
from ..flexibility.finite_elements.mesh_cost import check_hexahedra
from ..geometry.damage.kinds import BROKEN, NAMES, Damage, are, parts_of, split
from ..geometry.damage.missing import missing_teeth
from ..geometry.mesh.holes import holed_sector
from ..geometry.mesh.solid import solid
from ..geometry.tooth.gear import Gear
from .pressed import write_lines
from .solid_deck import DeckBody, cell_lines, holed_part, node_lines, part_of, set_lines

KINDS = {"tetrahedra": "tetra10", "hexahedra": "hexahedron20"}
# nodes for each tooth and module of width at refine 1; memory [bytes] and time [s] of a node of tetrahedra; measured at 0.5 to 2
NODES = {"hexahedra": 450.0, "tetrahedra": 160.0}
TETRAHEDRA = 2000.0, 7e-5
LAYER = 1.0  # height of the layers of hexahedra [m_n]


def export_mesh(
    path: str | os.PathLike[str],
    gear: Gear,
    damage: Sequence[Damage] = (),
    *,
    cells: str | None = None,
    teeth: int | None = None,
    refine: float = 1.0,
) -> DeckBody:
    """Write the mesh of a gear with its cracks opened and its pits cut out, without any load.

    Hexahedra (20 nodes): the whole gear, cracks of the whole width or a part of it, missing teeth, chips, no pits. Tetrahedra
    (10 nodes): a sector or the whole gear, pits of one tooth as holes, at most one crack through the whole width, in the same
    tooth. Elements are of second order. Faces of a crack have separate nodes at the same places.

    Parameters
    ----------
    path : path
        ``.msh`` (Gmsh), ``.vtu`` (ParaView) or ``.inp`` (CalculiX, Abaqus). The named boundaries are ``held``, ``flank 0``,
        ``pits``, ``crack 0 body`` and so on. In ``.inp`` they are node sets (``HELD``, ``FLANK_0``, ...), and all elements are
        the set ``GEAR`` of type C3D20R or C3D10. In the other formats they are point data of 0 and 1.
    gear : Gear
    damage : sequence of damage
        Damage of this gear with its own tooth numbers.
    cells : {"hexahedra", "tetrahedra"}, optional
        Default: tetrahedra if there are pits, or `teeth` is given.
    teeth : int, optional
        Of tetrahedra: an odd number of teeth around the damaged one, which becomes tooth 0; default all.
    refine : float
        Divides all edge lengths.

    Returns
    -------
    gearfe.decks.solid_deck.Part
        The written mesh.

    Raises
    ------
    ValueError
        If the damage cannot be meshed with these options, the mesh does not fit into memory, or the suffix is unknown.
    """
    check_output(path, "mesh")
    refine, suffix = checked_refine(refine), suffix_of(path, "mesh")
    if not are(damage):
        raise ValueError(f"damage = {damage!r}, but give a list of {' and '.join(NAMES)} of this gear, [] for none")
    damage = parts_of(gear, damage)
    cracks, pits = split(damage)
    broken = tuple(one for one in damage if isinstance(one, BROKEN))
    cells = cells or ("tetrahedra" if pits or teeth is not None else "hexahedra")
    if cells not in KINDS:
        raise ValueError(f"cells = {cells!r}, but it must be one of {', '.join(KINDS)}")
    _check_size(gear, cells, teeth or gear.z, refine)
    part = (_tets if cells == "tetrahedra" else _hexes)(gear, pits, (cracks, broken), teeth, refine)
    _write(path, suffix, part, KINDS[cells])
    return part


def _check_size(gear, cells, teeth, refine):
    """Raise ValueError for a mesh above the limits of memory and time, before it is made."""
    if cells == "hexahedra":
        return check_hexahedra(gear, refine, NODES[cells], solved=False)
    count, (size, each) = NODES[cells] * teeth * max(gear.b / gear.m_n, 1.0) * refine**2, TETRAHEDRA
    check_cost(f"refine = {refine:g}: a mesh of {count:.2g} nodes", Cost(each * count, size * count), "give a smaller refine")


def _tets(gear, pits, seams, teeth, refine):
    cracks, broken = seams
    for one in broken:
        raise ValueError(f"tetrahedra have no {one._nouns[0]}: use cells = 'hexahedra', without holes")
    if len(cracks) > 1 or not all(crack.through for crack in cracks):
        raise ValueError("tetrahedra have at most one crack, through the whole width: use cells = 'hexahedra', without holes")
    return holed_part(holed_sector(gear, pits, *cracks, teeth=teeth, refine=refine))


def _hexes(gear, pits, seams, teeth, refine):
    if pits:
        noun = pits[0]._nouns[1]
        raise ValueError(f"damage has {noun}, but only meshes of tetrahedra can have {noun}: use cells = 'tetrahedra'")
    if teeth is not None:
        raise ValueError(f"teeth = {teeth}, but a mesh of hexahedra contains the whole gear: use cells = 'tetrahedra'")
    cracks, broken = seams
    gone = missing_teeth(gear, broken)
    loaded = sorted({one.tooth % gear.z for one in (*cracks, *broken)} - {*gone}) or [1 if 0 in gone else 0]
    options = {"layer": min(LAYER * gear.m_n, gear.b / 4), "loaded": loaded, "cracks": cracks, "broken": broken}
    return part_of(solid(gear, refine=refine, **options))


def _write(path, suffix, part, kind):
    sets = {name.replace(" ", "_"): np.unique(faces) for name, faces in part.faces.items() if faces.size}
    sets["held"] = part.held
    if suffix == ".inp":
        return write_lines(path, _deck(part, sets))
    import meshio

    check_folds(part.points, part.cells)
    marks = {name: np.isin(np.arange(part.points.shape[1]), nodes).astype(np.int32) for name, nodes in sets.items()}
    mesh = meshio.Mesh(part.points.T, [(kind, part.cells.T)], point_data=marks)
    with written(path) as name:
        meshio.write(name, mesh, file_format={".msh": "gmsh", ".vtu": "vtu"}[suffix])


def _deck(part, sets):
    """Lines of a deck. Meshio 5.3.5 writes elements, numbers and lines that CalculiX rejects."""
    yield "** gearfe: mesh of one gear, in mm, to be used by *INCLUDE"
    yield "*NODE, NSET=ALL"
    yield from node_lines(part, 0)
    yield from cell_lines(part, "GEAR")
    for name, nodes in sets.items():
        yield from set_lines(name.upper(), nodes)
