"""Finite-element model of one loaded gear as a CalculiX / Abaqus input deck, as an independent reference."""

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.sparse import spmatrix

from ..core.files import check_output, written
from ..core.material import Material, check_state
from ..flexibility.finite_elements.elasticity import HeldSection
from ..flexibility.finite_elements.fe import EDGES
from ..flexibility.finite_elements.one_tooth import (
    NARROW,
    check_cracks,
    check_line_load,
    check_one,
    edge_lengths,
    load_at,
    narrow_section,
)
from ..geometry.damage.crack import Crack
from ..geometry.tooth.gear import Gear


def write_inp(
    path: str | os.PathLike[str],
    gear: Gear,
    radius: float,
    line_load: float,
    material: Material,
    *,
    cracks: Sequence[Crack] = (),
    state: str = "plane strain",
    refine: float = 1.0,
) -> tuple[HeldSection, spmatrix]:
    """Write a static deck: second-order triangles, held edge, consistent nodal forces of the flank load.

    Cracks are seams: their faces have their own nodes at the same places. The load is spread as ``cos**2`` over 0.1 m_n of arc
    on tooth 0. CalculiX: ``ccx -i NAME`` writes displacements to ``NAME.dat``.

    Parameters
    ----------
    path : path
        Ends in ``.inp``.
    gear : Gear
    radius : float
        Radius of the loaded flank point of tooth 0 [mm].
    line_load : float
        Load normal to the flank, per face width [N/mm].
    material : Material
    cracks : sequence of Crack
    state : {"plane strain", "plane stress"}
    refine : float
        Divides the edge lengths.

    Returns
    -------
    body : Body
        The same model here.
    load : sparse matrix, shape (2 nodes, 1)
        Its nodal forces [N/mm].

    Raises
    ------
    ValueError
        If `path` has another suffix, is a folder or cannot be written; if `gear` is no `Gear`, `material` no `Material`, or
        `state` no plane state; if `refine` is not 0.2 to 64; if `radius` is not on the involute flank; if `line_load` is not
        positive and finite, or above ``E m_n / 20``; if `cracks` are no sequence of `Crack`, two are on one side of a tooth, one
        changes along the width, or one leaves its tooth.
    """
    check_output(path, "deck")
    check_state(state)
    check_one(gear, material, refine)
    check_line_load(line_load, gear, material)
    check_cracks(cracks)
    at = load_at(gear, radius), NARROW * gear.m_n, NARROW * gear.m_n / 4
    _, body, unit = narrow_section(gear, material, state, edge_lengths(gear, EDGES, refine), at, cracks=cracks)
    load = line_load * unit
    with written(path) as name:
        Path(name).write_text("\n".join(_lines(body, load)), encoding="ascii")
    return body, load


def _lines(body, load):
    mesh, points = body.mesh, body.mesh.doflocs
    yield f"** gearfe: one gear, {body.state}; mm, N, MPa; nodal forces per mm of width"
    yield "*NODE, NSET=ALL"
    yield from (f"{i}, {x:.12e}, {y:.12e}, 0." for i, (x, y) in enumerate(points.T.tolist(), 1))
    yield f"*ELEMENT, TYPE={'CPE6' if body.state == 'plane strain' else 'CPS6'}, ELSET=GEAR"
    nodes = element_nodes(mesh, points) + 1
    yield from (f"{i}, {', '.join(map(str, row))}" for i, row in enumerate(nodes.T.tolist(), 1))
    yield "*NSET, NSET=HELD"
    yield from (f"{node}," for node in (held_nodes(mesh) + 1).tolist())
    yield "*MATERIAL, NAME=M"
    yield f"*ELASTIC\n{body.material.E!r}, {body.material.nu!r}"
    yield "*SOLID SECTION, ELSET=GEAR, MATERIAL=M\n1."
    yield "*BOUNDARY\nHELD, 1, 2"
    yield "*STEP\n*STATIC\n*CLOAD"
    entries = load.tocoo()
    yield from (
        f"{row // 2 + 1}, {row % 2 + 1}, {value:.12e}"
        for row, value in zip(entries.row.tolist(), entries.data.tolist(), strict=True)
    )
    yield "*NODE PRINT, NSET=ALL\nU\n*END STEP\n"


def element_nodes(mesh, points):
    """Nodes ``(6, triangles)`` counter-clockwise for `points` (2, nodes): corners, then middles of 1-2, 2-3, 3-1."""
    nodes = np.vstack([mesh.t[:3], mesh.nvertices + mesh.t2f])
    a, b, c = points[:, nodes[:3]].transpose(1, 0, 2)
    clockwise = (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0] < 0
    return np.where(clockwise, nodes[[0, 2, 1, 5, 4, 3]], nodes)


def held_nodes(mesh):
    """Nodes of the held edge."""
    edges = mesh.boundaries["held"]
    return np.unique(np.concatenate([mesh.facets[:, edges].ravel(), mesh.nvertices + edges]))
