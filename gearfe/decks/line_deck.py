"""One gear of finite width under a line load as a CalculiX / Abaqus deck of hexahedra, as an independent reference."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..core.checks import check_length
from ..core.files import check_output
from ..core.material import Material
from ..flexibility.finite_elements.fe3d import Patches, mesh_patches, patch_loads
from ..flexibility.finite_elements.mesh_cost import check_hexahedra
from ..flexibility.finite_elements.one_tooth import check_line_load, load_at
from ..geometry.aliases import Floats, StrPath
from ..geometry.damage.crack import Crack
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import flank_arcs
from .pressed import read_rows, write_lines
from .solid_deck import DeckBody, element_lines, node_lines, part_of, set_lines

DENSITY = 500.0  # number of nodes for each tooth and module of width at refine 1


@dataclass(frozen=True, slots=True)
class LineDeck:
    """Data to read the result: the meshed gear, the nodal forces ``(nodes, 3)`` and the sum of the pressure [N]."""

    part: DeckBody
    load: Floats
    force: float

    def deflection(self, path: StrPath) -> float:
        """Return the displacement of the load along itself [mm], weighted like the load, from the ``.dat`` file of CalculiX."""
        moved = np.zeros(self.load.shape)
        for node, values in read_rows(path).items():
            moved[node - 1] = values
        return float((self.load * moved).sum() / self.force)


def write_line_inp(
    path: StrPath,
    gear: Gear,
    radius: float,
    line_load: float,
    material: Material,
    *,
    cracks: Sequence[Crack] = (),
    half_width: float | None = None,
    layer: float | None = None,
    refine: float = 1.0,
) -> LineDeck:
    """Write a static deck of a whole gear: twisted 20-node hexahedra, held bore or rim, a line load along tooth 0.

    The pressure is uniform over the width and a hat function of `half_width` to either side of the flank's points at `radius`,
    at right angles to the flank. The elements are integrated at 2 x 2 x 2 points (C3D20R). CalculiX: ``ccx -i NAME`` writes
    displacements to ``NAME.dat``.

    Parameters
    ----------
    path : path
        Ends in ``.inp``.
    gear : Gear
        Gear of any helix angle.
    radius : float
        Radius of the loaded points of tooth 0 [mm].
    line_load : float
        Load normal to the flank per face width [N/mm].
    material : Material
    cracks : sequence of Crack
        Cracks, whose faces have separate nodes and may pass through each other.
    half_width : float, optional
        Half width of the hat function [mm]; default 0.4 m_n.
    layer : float, optional
        Height of the element layers [mm]; default b / 12, at most a module.
    refine : float
        Divides all edge lengths, along the width too.

    Returns
    -------
    LineDeck

    Raises
    ------
    ValueError
        If an input is impossible, or the pressure leaves the flank.
    """
    check_output(path, "deck")
    check_line_load(line_load, gear, material)
    check_length("half_width", half_width)
    check_length("layer", layer)
    arc, reach = load_at(gear, radius), 0.4 * gear.m_n if half_width is None else half_width
    patches = Patches((0,), np.array([[arc - reach], [arc], [arc + reach]]), 1)
    low, high = flank_arcs(gear)
    if not (reach > 0 and low <= arc - reach and arc + reach <= high):
        raise ValueError(
            f"radius = {radius:g} mm, half_width = {reach:g} mm: the pressure from {arc - reach:.4g} to {arc + reach:.4g} mm "
            f"of arc length extends beyond the flank ({low:.4g} to {high:.4g} mm); load a middle radius or a narrower strip"
        )
    check_hexahedra(gear, refine, DENSITY, solved=False)
    mesh = mesh_patches(gear, patches, cracks=tuple(cracks), refine=refine, layer=layer)
    load = line_load * gear.b * patch_loads(mesh, patches, 0).reshape(-1, 3)
    part = part_of(mesh)
    write_lines(path, _text(part, material, load))
    return LineDeck(part, load, line_load * gear.b)


def _text(part, material, load):
    yield "** gearfe: one gear of finite width under a line load; mm, N, MPa"
    yield "*NODE, NSET=ALL"
    yield from node_lines(part, 0)
    yield from element_lines(part, 1, 0, 0, material)
    yield from set_lines("HELD", part.held)
    loaded = np.flatnonzero(load.any(axis=1))
    yield from set_lines("LOADED", loaded)
    yield "*BOUNDARY\nHELD, 1, 3"
    yield "*STEP\n*STATIC\n*CLOAD"
    for node in loaded.tolist():
        yield from (f"{node + 1}, {k + 1}, {value:.12e}" for k, value in enumerate(load[node].tolist()) if value)
    yield "*NODE PRINT, NSET=LOADED\nU\n*END STEP\n"
