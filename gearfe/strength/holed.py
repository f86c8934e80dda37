"""Damaged tooth with pits as holes and a crack as a seam under the contact load of its pair, in second-order tets.

The load is that of `gearfe.contact.wide_contact` along the true contact lines, spread over a narrow strip to either side. The
sector of the gear is held at the bore (or the outside of a ring) and where it was cut off.
"""

import math
from dataclasses import astuple, dataclass, replace

import numpy as np

from ..contact.wide_contact import Contact3D, pair_stiffness3d
from ..core.steps import part
from ..flexibility.finite_elements.solid_assembly import assemble
from ..flexibility.finite_elements.solver import factor, plan
from ..flexibility.finite_elements.tetrahedron import EDGES, nodal_stress, nodes_of, second_order
from ..geometry.mesh.holes import Holed, holed_sector, skin
from ..geometry.pair.pit_lines import in_both_halves
from ..geometry.tooth.profile import arc_at, cartesian, flank, flank_normal, turned
from ..stiffness.supported import check_integral
from .fields import Field, von_mises

SPREAD = 0.15  # half-width of the load about its line [m_n]
BEND = math.radians(40)  # Edges with a larger change of the surface direction are drawn.
PARTS = 5  # number of divisions of each side of a loaded triangle


@dataclass(frozen=True, slots=True)
class Pressed:
    """Damaged tooth under load at p phases: `load` ``(p,)`` on tooth 0, at right angles to its flank [N].

    `nodes` ``(3, n)`` are vertices and edge middles of the `sector` [mm], `cells` ``(10, m)`` those of the gear with holes, in
    VTK's order. `moved` ``(p, 3, n)`` are displacements [mm], nan at nodes inside the pits. `stress` ``(p, 6, n)`` are xx, yy,
    zz, xy, yz, xz at the nodes [MPa], means of the adjacent tets weighted by their volume. `gear` is ``pinion`` or ``wheel``.
    """

    sector: Holed
    nodes: np.ndarray
    cells: np.ndarray
    contact: Contact3D
    gear: str
    load: np.ndarray
    moved: np.ndarray
    stress: np.ndarray


def _hurt_side(case):
    """Return the number of the gear with damage that can be solved in three dimensions."""
    which = [i for i in (0, 1) if case.cracks[i] or case.pits[i] or case.broken[i]] or [0]
    cracks, pits, broken = (kind[which[0]] for kind in (case.cracks, case.pits, case.broken))
    if len(which) > 1 or len(cracks) > 1 or (broken and len([*cracks, *pits, *broken]) > 1):
        raise ValueError("give damage of the flank, one crack or both, of one tooth of one gear: holes are cut into one tooth")
    return which[0]


def pressed_tooth(case, *, phases=None, refine=1.0, teeth=3, sizes=None, strip=None, spread=SPREAD):
    """Solve the damaged tooth of a pair with its pits as holes, for contact on the path of contact.

    Only one tooth of one gear may be damaged. Pits of a herringbone gear are in one half, or equal in both. Without damage, tooth
    0 of the pinion is solved. Next to a missing tooth, the tooth that carries alone before the gap is solved. The default of
    `phases` is that of 16 phases at which the tooth has the largest load. `geometry.mesh.holes.holed_sector` describes `refine`,
    `teeth` and `sizes`. `strip` is the edge length along the loaded contact lines of the damaged tooth [modules], default that of
    the flank. `spread` is the half width of the load about its line, as a hat function [modules]. A hat function of 1.2 Hertzian
    half widths is as wide as the Hertzian pressure.

    ValueError if the damage is not that of one tooth, or is impossible. RuntimeError if a hole was not cut correctly, or the
    system does not fit into memory.
    """
    if not spread > 0:
        raise ValueError(f"spread = {spread}, but the distance to either side of the contact line must be positive [mm]")
    pair, materials, face, cracks, pits = case.pair, case.materials, case.runs, case.cracks, case.pits
    side = _hurt_side(case)
    broken = case.broken[side]
    gear, half, own_pits = _own(pair, side, face, case.groove, pits[side])
    crack = next(iter(cracks[side]), None)
    tooth = next((one.tooth for one in (*pits[side], *cracks[side], *broken)), 0) + (1, -1)[side] * case.missing
    broken, order = [replace(one, tooth=one.tooth - tooth) for one in broken], (1, -1)[side] * tooth
    with part("contact", 0.0, 0.2):
        contact = contact_of(case, phases, order, extended=False)
    lines = [_lines(pair, of_phase, side, tooth, half) for of_phase in contact.cells]
    spread *= gear.m_n
    strips = () if strip is None else _strips(gear, lines, strip * gear.m_n / refine, spread)
    with part("mesh", 0.2, 0.5):
        sector = holed_sector(gear, own_pits, crack, broken=broken, teeth=teeth, refine=refine, sizes=sizes, strips=strips)
    nodes, cells, number = second_order(sector.points, sector.cells)
    kept = cells[:, sector.plug < 0]
    loads = np.column_stack([_pressure(sector, nodes, number, of_phase, spread) for of_phase in lines])
    held = nodes_of(np.hstack([sector.faces["held"], sector.faces["sides"]]), number)
    with part("stress", 0.5, 1.0):
        moved = _moved(nodes, kept, materials[side], held, loads)
    moved = moved.reshape(-1, 3, len(lines)).transpose(2, 1, 0)
    load = np.array([sum(one[3].sum() for one in of_phase.get(0, ())) for of_phase in lines])
    stress = np.array([nodal_stress(nodes, kept, one, materials[side]) for one in moved])
    return Pressed(sector, nodes, kept, contact, ("pinion", "wheel")[side], load, moved, stress)


def tooth_field(pressed, phase=0):
    """Return the `gearfe.strength.fields.Field` of the gear with holes at one phase, without nodes inside the pits."""
    sector = pressed.sector
    used, cells = np.unique(pressed.cells, return_inverse=True)
    cells = cells.reshape(pressed.cells.shape)
    place = np.full(pressed.nodes.shape[1], -1)
    place[used] = np.arange(used.size)
    points, moved = pressed.nodes[:, used], pressed.moved[phase][:, used]
    body, tooth = (place[sector.faces.get(f"crack {name}", np.zeros((3, 0), dtype=int))] for name in ("body", "tooth"))
    opening = np.linalg.norm(moved[:, tooth] - moved[:, body], axis=0).max(initial=0.0)
    made = points, "tetra10", cells, moved, pressed.stress[phase][:, used], _edges(points, cells)
    field = Field(*made, 0.0, float(opening))
    return replace(field, root=float(field.mises[place[sector.faces["fillets 0"]]].max()))


def root_error(pressed, material, phase=0):
    """Estimate the error of the largest von Mises stress on the fillets [MPa], for a `Pressed` of a material.

    It is the largest difference between the tets that meet at this point and their mean, which is the stated stress.

    References
    ----------
    O. C. Zienkiewicz, J. Z. Zhu, Int. J. Numer. Methods Eng. 24 (1987) 337-357.
    """
    mean = von_mises(pressed.stress[phase])
    fillet = np.unique(pressed.sector.faces["fillets 0"])
    place = fillet[np.argmax(mean[fillet])]
    own = pressed.cells[:, (pressed.cells == place).any(axis=0)]
    apart = np.arange(own.size).reshape(own.shape)
    stress = nodal_stress(pressed.nodes[:, own].reshape(3, -1), apart, pressed.moved[phase][:, own].reshape(3, -1), material)
    return float(np.abs(von_mises(stress[:, apart[own == place]]) - mean[place]).max())


def _edges(points, cells):
    """Return pieces ``(2, k)`` of edges at which the surface of tets bends by more than `BEND`."""
    faces = skin(cells[:4])
    a, b, c = points[:, faces].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a, axis=0)
    normal /= np.linalg.norm(normal, axis=0)
    sides = np.hstack([faces[[0, 1]], faces[[1, 2]], faces[[0, 2]]])
    order = np.lexsort(sides)
    first, second = order[::2] % faces.shape[1], order[1::2] % faces.shape[1]
    sharp = sides[:, order[::2]][:, np.abs((normal[:, first] * normal[:, second]).sum(axis=0)) < math.cos(BEND)]
    middle = {}
    for k, (i, j) in enumerate(EDGES):
        middle |= dict(zip(map(tuple, np.sort(cells[[i, j]], axis=0).T.tolist()), cells[4 + k].tolist(), strict=True))
    half = np.array([middle[tuple(side)] for side in sharp.T.tolist()], dtype=int)
    return np.hstack([[sharp[0], half], [half, sharp[1]]])


def _own(pair, side, face, groove, pits):
    """Return the drawn gear, its half (0 or 1), and the pits in this half. Half 1 is drawn as a mirror image."""
    gear, sense = pair.gears[side], (1, -1)[side]
    if face != "herringbone":
        return replace(gear, beta=sense * pair.gear_1.beta), 0, pits
    width = (gear.b - groove) / 2
    parts = [tuple(pit for pit in pits if (pit.z > gear.b / 2) is upper) for upper in (False, True)]
    if all(parts) and not _mirrored(gear, *parts):
        raise ValueError(
            "the holes in both halves of a herringbone gear are no mirror images, but only one half is drawn: give the "
            "holes of one half"
        )
    half = int(not parts[0] and bool(parts[1]))
    pits = parts[half]
    if half:
        pits = tuple(in_both_halves(gear, pits, face))
    return replace(gear, beta=-sense * abs(gear.beta), b=width), half, pits


def _mirrored(gear, lower, upper):
    """Return whether the pits of one half are the mirror images of those in the other half."""

    def rounded(pit):
        return pit._adjective, [value if isinstance(value, str) else np.round(value, 9).tolist() for value in astuple(pit)]

    return sorted(map(rounded, lower)) == sorted(map(rounded, in_both_halves(gear, upper, "herringbone")))


def contact_of(case, phases, order, *, extended=True):
    """Return the `Contact3D` of a case at `phases`, by default at that of 16 phases where pair `order` carries most."""
    check_integral(case, "ritz3d")
    given = phases is not None
    # Phases are rounded, so that a printed phase gives the same mesh and stress if it is entered again.
    at = phases if given else np.round(-order + (case.pair.eps_alpha + case.overlap()) * (np.arange(16) + 0.5) / 16, 2)
    contact = pair_stiffness3d(case, at, extended=extended)
    if given:
        return contact
    carried = contact.load[:, contact.order == order].sum(axis=1)
    # A pair that carries the whole load has the same load at several phases.
    alike = np.flatnonzero(carried > (1 - 1e-9) * carried.max())
    best = int(alike[alike.size // 2])
    numbers = {name: getattr(contact, name)[[best]] for name in ("phase", "k", "approach", "load", "unloaded")}
    return replace(contact, cells=(contact.cells[best],), **numbers)


def _lines(pair, cells, side, tooth, half):
    """Return contact lines by tooth of the sector: lists of (z [mm], width [mm], roll length [mm], load [N]) of their cells."""
    gear, sense = pair.gears[side], (1, -1)[side]
    offset = (gear.b - pair.b_w) / 2
    out = {}
    for order in np.unique(cells.order):
        line = np.flatnonzero((cells.order == order) & (cells.half == half))
        z = cells.z[line] + offset
        z = gear.b - z if half else z
        line, z = line[np.argsort(z)], np.sort(z)
        place = (sense * int(order) - tooth + gear.z // 2) % gear.z - gear.z // 2
        roll = cells.rolls[side][line]
        out.setdefault(place, []).append((z, cells.width[line], roll, cells.load[line]))
    return out


def _strips(gear, lines, edge, spread):
    """Return the loaded contact lines of tooth 0 in the frame of the helix, for a mesh with this edge length [mm] there."""
    out = []
    for of_phase in lines:
        for z, _, roll, load in of_phase.get(0, ()):
            if (load > 0).sum() > 1:
                radius, angle = flank(gear, roll[load > 0])
                out.append((np.array([*cartesian(radius, angle), z[load > 0]]), 1.5 * spread, edge))
    return out


def _moved(nodes, cells, material, held, loads):
    """Solve for the displacements ``(3 nodes, phases)`` [mm] under `loads`; nan for nodes outside the `cells`."""
    used = np.unique(cells)
    free = np.setdiff1d(used, held)
    cost = plan(3 * free.size)
    rows = (3 * free[:, None] + np.arange(3)).ravel()
    solve = factor(assemble(nodes, cells, material, free), cost)
    moved = np.full(loads.shape, np.nan)
    moved[(3 * used[:, None] + np.arange(3)).ravel()] = 0.0
    moved[rows] = solve(loads[rows])
    if not np.isfinite(moved[rows]).all():
        raise RuntimeError("the FE solve gave no finite displacement: the body is not held, or nu is too close to 0.5")
    return moved


def _pressure(sector, nodes, number, lines, spread):
    """Nodal forces ``(3 n,)`` [N] of contact lines on the flanks of a sector, x, y, z of every node together.

    On each line the pressure is its line load times a hat function of `spread` [mm] along the profile, evaluated at small
    triangles of the flank. It is scaled to the load of the line, so that no load is lost where a hat function leaves the flank
    or meets a pit. A line that contains the middle of none of these triangles, such as a short one at a corner of the flank, is
    a force at the nearest triangle.
    """
    gear, rate = sector.gear, sector.gear.twist_rate
    force = np.zeros((nodes.shape[1], 3))
    bary = _thirds()
    shape = np.vstack([bary * (2 * bary - 1), 4 * bary[[0, 1, 0]] * bary[[1, 2, 2]]])
    for tooth, on_tooth in lines.items():
        faces = sector.faces.get(f"flank {tooth}")
        if faces is None or not faces.size:
            continue
        a, b, c = faces
        six = np.array([a, b, c, number(a, b), number(b, c), number(a, c)])
        x, y, z = np.einsum("dkf,kq->dfq", nodes[:, six[:3]], bary)
        area = np.linalg.norm(np.cross((nodes[:, b] - nodes[:, a]).T, (nodes[:, c] - nodes[:, a]).T), axis=1)
        roll = np.sqrt(np.maximum(np.hypot(x, y) ** 2 - gear.r_b**2, 0.0))
        normal = _normal(gear, roll, 2 * math.pi * tooth / gear.z + rate * z)
        for heights, width, rolls, load in on_tooth:
            if load.sum() <= 0:
                continue
            cell = np.clip(np.searchsorted(heights + width / 2, z), 0, heights.size - 1)
            inside = np.abs(z - heights[cell]) <= width[cell] / 2 * (1 + 1e-9)
            away = np.abs(arc_at(gear, roll) - arc_at(gear, np.interp(z, heights, rolls)))
            press = np.where(inside, load[cell] / width[cell] * np.maximum(1 - away / spread, 0.0), 0.0) * area[:, None]
            if press.sum() <= 0:
                near = np.hypot(z - heights[cell], away)
                face = np.unravel_index(near.argmin(), near.shape)
                if near[face] > math.sqrt(area[face[0]]):  # The point is not within the size of a triangle.
                    raise RuntimeError("the mesh is too coarse to carry the load of a contact line: raise refine")
                press[face] = 1.0
            press *= load.sum() / press.sum()
            np.add.at(force, six.T, -np.einsum("kq,dfq,fq->fkd", shape, normal, press))
    return force.ravel()


def _thirds():
    """Return barycentric centres ``(3, q)`` of the small triangles into which a triangle is divided."""
    i, j = np.meshgrid(np.arange(PARTS), np.arange(PARTS), indexing="ij")
    up, down = i + j < PARTS, i + j < PARTS - 1
    first = np.concatenate([i[up] + 1 / 3, i[down] + 2 / 3]) / PARTS
    second = np.concatenate([j[up] + 1 / 3, j[down] + 2 / 3]) / PARTS
    return np.array([first, second, 1 - first - second])


def _normal(gear, roll, turn):
    """Return unit normals out of the loaded flank at `roll` on a section rotated clockwise by `turn`."""
    plane = math.cos(gear.beta_b) * flank_normal(gear, roll)
    return turned((*plane, np.full(roll.shape, -math.sin(gear.beta_b))), turn)
