"""Gear pair in nonlinear contact as a CalculiX deck in plane strain: an independent reference."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.case import Case
from ..flexibility.finite_elements.fe import EDGES
from ..flexibility.finite_elements.one_tooth import edge_lengths
from ..flexibility.hertz import contact_modulus, half_width
from ..geometry.aliases import Floats, StrPath
from ..geometry.mesh.outline import stations
from ..geometry.mesh.relieved import relieved
from ..geometry.mesh.section_mesh import section
from ..geometry.pair.modified import flank_contacts
from ..geometry.tooth.profile import arc_at, turned
from .pressed import pressing, read_rows, write_lines
from .pressing import Pressing
from .solid_deck import Assembly, plane_part

TIP = 0.005  # longest edge at a touching tip corner, where the pressure gradient is steep [m_n]
SECTION = 8.0  # element edges per Hertzian half-width


@dataclass(frozen=True, slots=True)
class ContactDeck:
    """Data that are required to read the result: held nodes of both gears, their positions from the centre [mm], and r_b [mm]."""

    held: tuple[NDArray[np.int64], NDArray[np.int64]]
    place: tuple[Floats, Floats]
    r_b: tuple[float, float]

    def forces(self, path: StrPath) -> tuple[float, float]:
        """Return ``T1 / r_b1`` and ``T2 / r_b2`` per width [N/mm] from the reactions in the ``.dat`` file `path` of CalculiX."""
        reaction = read_rows(path)
        pushed = [np.array([reaction[n] for n in held.tolist()]).T for held in self.held]
        moment = [float((f[0] * p[1] - f[1] * p[0]).sum()) for f, p in zip(pushed, self.place, strict=True)]
        return moment[0] / self.r_b[0], abs(moment[1]) / self.r_b[1]

    def force(self, path: StrPath) -> float:
        """Return the force along the line of action per width [N/mm]: mean of `forces` (see `gearfe.geometry.pair.contacts`)."""
        return sum(self.forces(path)) / 2


def write_contact_section(path: StrPath, case: Case, phase: float, approach: float, how: Pressing) -> ContactDeck:
    """Write the deck of `gearfe.decks.contact_inp.write_contact_inp` in plane strain, with TIP edges at a touching tip corner."""
    pair, materials, forms = case.pair, case.materials, case.forms
    gears, line_load = pair.gears, case.forces[0] / pair.b_w
    candidates = flank_contacts(pair, [phase], flanks=forms)
    near = np.flatnonzero(candidates.gap[0] < 1.5 * approach)
    order = candidates.order[near]
    rolls = candidates.roll_1[0, near], candidates.roll_2[0, near]
    widths = half_width(line_load, candidates.radius[0, near], contact_modulus(materials))
    bodies = [
        _meshed(gear, sense * order, arc_at(gear, roll), widths, how.per_width or SECTION, how.refine)
        for gear, roll, sense in zip(gears, rolls, (1, -1), strict=True)
    ]
    if forms is not None:
        bodies = [relieved(body, form, order, sense) for body, form, sense in zip(bodies, forms, (1, -1), strict=True)]
    pressed = how.turned(pair, approach)
    turns = pair.turn(candidates.nominal[0, near[0]] - order[0] * pair.p_bt)
    assembly, places = Assembly(), []
    for i, (body, material) in enumerate(zip(bodies, materials, strict=True)):
        points = turned(body.mesh.doflocs * [[(1, pair.outward)[i]], [1]], turns[i])
        part = plane_part(body.mesh, points, body.flank)
        surfaces = {f"C{i + 1}P{k}": part.faces[int(tooth)] for k, tooth in enumerate((1, -1)[i] * order % body.gear.z)}
        places.append(points[:, part.held])
        part.points[1] += (0.0, pair.centre_2)[i]
        assembly.add(i + 1, part, material, surfaces, turned(places[i], pressed[i]) - places[i])
    corners = np.abs(rolls[1] - pair.gear_2.roll_a) <= 1e-9 * pair.gear_2.m_n
    contacts = [(f"C2P{k}", f"C1P{k}") if corner else (f"C1P{k}", f"C2P{k}") for k, corner in enumerate(corners)]
    stiff = how.penalty * max(m.E for m in materials)
    step = [*pressing(stiff, contacts, assembly.motions), "*NODE PRINT, NSET=H1\nRF\n*NODE PRINT, NSET=H2\nRF\n*END STEP\n"]
    title = "** gearfe: gear pair in contact, plane strain; mm, N, MPa, per mm of width"
    write_lines(path, [title, *assembly.nodes, *assembly.blocks, *step])
    return ContactDeck((assembly.held[0], assembly.held[1]), (places[0], places[1]), (pair.gear_1.r_b, pair.gear_2.r_b))


def _meshed(gear, teeth, arcs, widths, per_width, refine):
    """Mesh the section of `gear`, refined around the contacts at `arcs` [mm] with half `widths` [mm]."""
    edge = edge_lengths(gear, EDGES, refine)
    top, rolls = arc_at(gear, gear.roll_a), {}
    for tooth, arc, a in zip(teeth, arcs, widths, strict=True):
        patch = (arc - 3 * a, arc + 3 * a, a / per_width)
        tip = min(a / per_width / 2, TIP * gear.m_n) if top - arc < 2 * a else a / per_width / 2
        rolls[int(tooth)] = stations(gear, edge["flank"], tip=tip, low=edge["low"], patches=[patch])
    return section(gear, rolls, fillet_size=edge["fillet"], size=edge["near"], far_size=edge["far"])
