"""Finite-element model of one loaded gear as a CalculiX / Abaqus input deck, as an independent reference."""

import os
from collections.abc import Sequence

from scipy.sparse import spmatrix

from ..core.files import check_output
from ..core.material import Material, check_state
from ..flexibility.finite_elements.elasticity import HeldSection
from ..flexibility.finite_elements.fe import EDGES
from ..flexibility.finite_elements.one_tooth import (
    NARROW,
    check_line_load,
    edge_lengths,
    load_at,
    narrow_section,
)
from ..geometry.damage.crack import Crack
from ..geometry.tooth.gear import Gear
from .pressed import write_lines
from .solid_deck import element_lines, node_lines, plane_part, set_lines


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

    Crack faces have separate nodes at the same positions. The load is spread as ``cos**2`` over 0.1 m_n of arc
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
    check_line_load(line_load, gear, material)
    at = load_at(gear, radius), NARROW * gear.m_n, NARROW * gear.m_n / 4
    _, body, unit = narrow_section(gear, material, state, edge_lengths(gear, EDGES, refine), at, cracks=cracks)
    load = line_load * unit
    write_lines(path, _lines(body, load))
    return body, load


def _lines(body, load):
    part = plane_part(body.mesh, body.mesh.doflocs)
    yield f"** gearfe: one gear, {body.state}; mm, N, MPa; nodal forces per mm of width"
    yield from ("*NODE, NSET=ALL", *node_lines(part))
    for line in element_lines(part, 1, 0, 0, body.material):
        yield line if body.state == "plane strain" else line.replace("CPE6", "CPS6")
    yield from (*set_lines("HELD", part.held), "*BOUNDARY\nHELD, 1, 2", "*STEP\n*STATIC\n*CLOAD")
    entries = load.tocoo()
    for row, value in zip(entries.row.tolist(), entries.data.tolist(), strict=True):
        yield f"{row // 2 + 1}, {row % 2 + 1}, {value:.12e}"
    yield "*NODE PRINT, NSET=ALL\nU\n*END STEP\n"
