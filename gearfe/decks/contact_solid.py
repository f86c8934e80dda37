"""Gear pair of finite width in nonlinear contact as a CalculiX deck: an independent reference in three dimensions."""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..core.case import Case
from ..flexibility.finite_elements.mesh_cost import check_mesh
from ..flexibility.hertz import contact_modulus, half_width
from ..geometry.aliases import Floats, StrPath
from ..geometry.damage.kinds import split
from ..geometry.mesh.holes import SIZES as HOLES
from ..geometry.mesh.holes import filled, holed_sector
from ..geometry.mesh.relieved_solid import relieved_points
from ..geometry.mesh.solid import solid
from ..geometry.pair.broken import ToothPairs
from ..geometry.pair.contacts import FORM, Contacts, contacts
from ..geometry.pair.contacts import touching as touching_sections
from ..geometry.pair.gear_pair import GearPair
from ..geometry.pair.modified import first_touch
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import arc_at, cartesian, flank, turned
from ..geometry.tooth.side import on_fillet
from .contact_deck import ContactDeck
from .pressed import pressing, write_lines
from .pressing import Pressing
from .solid_deck import Assembly, DeckBody, holed_part, part_of, placed

# edge lengths in modules, see `gearfe.geometry.mesh.quads.SIZES`
SIZES = {"flank": 0.5, "corner": 0.3, "fillet": 0.5, "root": 0.8, "near": 1.0, "far": 3.0, "crack": 0.3, "crack tip": 0.08}
TETS = {"far": 1.4, "tooth": 0.7, "flank": 0.6, "fillet": 0.25}  # see `gearfe.geometry.mesh.holes.SIZES`
STRETCH = 2.0  # length of the tetrahedra along the width relative to the section
RIM = 0.6  # edge length at the rims of pits, relative to that along the contact lines
SECTIONS = 33  # transverse sections in which contacts are searched
REACH = 1.5  # largest gap that may close under load, relative to the approach
STRIP = 2.5  # refined half-width around the contact line [Hertzian half-widths]
SOLID = 1.5  # element edges per Hertzian half-width
DENSITY = 500.0  # number of nodes for each tooth and layer at refine 1
END = 1.0  # height of the layers at the end faces, relative to the other layers


@dataclass(frozen=True, slots=True)
class SolidDeck(ContactDeck):
    """`ContactDeck` of a pair of finite width, with forces in N, both positioned meshes, and the slave flanks by pair.

    `parts` are pinion and wheel. `slaves` maps the number of a tooth pair to the gear of its slave flank (0 or 1) and to its
    faces ``(corners, k)``.
    """

    parts: tuple[DeckBody, DeckBody]
    slaves: dict[int, tuple[int, NDArray[np.int64]]]

    def carried(self, path: StrPath) -> dict[int, tuple[float, float]]:
        """Return force [N] and height z of the line of action [mm] of each tooth pair, from the ``.dat`` file `path`.

        CalculiX prints force F and moment M about the origin. The line is ``F x M / |F|**2 + t F``, and the height is that of its
        point nearest to the middle of the contact area, which is printed too. Pairs without contact are omitted.
        """
        sums = contact_sums(path)
        out = {}
        for k, (order, (side, _)) in enumerate(self.slaves.items()):
            if f"C{side + 1}P{k}" in sums:
                force, moment, middle = sums[f"C{side + 1}P{k}"]
                foot = np.cross(force, moment) / (force @ force)
                z = (foot + (middle - foot) @ force / (force @ force) * force)[2]
                out[order] = float(np.linalg.norm(force)), float(z)
        return out


def contact_sums(path: StrPath) -> dict[str, tuple[Floats, ...]]:
    """Return force [N], moment about the origin [N mm] and middle of contact [mm] by slave surface, in the last increment.

    RuntimeError if the ``.dat`` file has none.
    """
    rows = [line.split() for line in Path(path).read_text(encoding="ascii").splitlines() if line.strip()]
    out: dict[str, tuple[Floats, ...]] = {}
    for k, row in enumerate(rows):
        if row[:4] == ["statistics", "for", "slave", "set"]:
            first, middle = (np.array(rows[k + step], dtype=float) for step in (2, 4))
            if first[:3].any():
                out[row[4].rstrip(",")] = first[:3], first[3:], middle[:3]
            else:
                out.pop(row[4].rstrip(","), None)
    if not out:
        raise RuntimeError(f"{path} has no contact forces: CalculiX found no equilibrium, or no flanks touch")
    return out


@dataclass(frozen=True, slots=True)
class Touching:
    """Tooth pairs that may touch, n of them.

    `order` are their numbers, `heights` the heights of the sections that may touch, over the common width [mm], and `rolls` by
    gear the roll lengths there [mm]. `width` is the Hertzian half width [mm], and `slave` the gear (0 or 1) of the slave side.
    `fillet` states by gear whether its fillet touches too, by a tip in it or by the corner of an undercut.
    """

    order: list[int]
    heights: list[Floats]
    rolls: tuple[list[Floats], list[Floats]]
    width: list[float]
    slave: list[int]
    fillet: tuple[list[bool], list[bool]]


def nominal_at(pair: GearPair, phase: float, z: Floats | float) -> Floats:
    """Abscissa [mm] of pair 0 on the line of action at heights z [mm] of the common width.

    `phase` is the mesh phase of the leading end.
    """
    slope = math.tan(pair.gear_1.beta_b)
    origin = pair.b_w if slope > 0 else 0.0
    return pair.path[0] + phase * pair.p_bt + slope * (np.asarray(z) - origin)


def touching(case: Case, phase: float, approach: float) -> Touching:
    """Return the tooth pairs with gaps below `REACH` approaches anywhere along the width, and their contact places."""
    pair, forms, common = case.pair, case.forms, case.pair.b_w
    heights, modulus = np.linspace(0.0, common, SECTIONS), contact_modulus(case.materials)
    candidates = contacts(pair, (nominal_at(pair, phase, heights) - pair.path[0]) / pair.p_bt)
    if forms is not None:
        candidates = _modified(pair, candidates, heights, forms)
    out = Touching([], [], ([], []), [], [], ([], []))
    for k, order in enumerate(candidates.order.tolist()):
        own = ToothPairs(pair, case.broken)(order)
        if own is None:
            continue
        if own != pair:
            for name, values in touching_sections(own, candidates.nominal[:, k])._asdict().items():
                merged = np.array(getattr(candidates, name))  # Contacts of a pair are shared.
                merged[..., k] = values
                candidates = replace(candidates, **{name: merged})
        near = candidates.gap[:, k] < REACH * approach
        if not near.any():
            continue
        rolls = candidates.roll_1[near, k], candidates.roll_2[near, k]
        out.order.append(order)
        out.heights.append(heights[near])
        out.rolls[0].append(rolls[0])
        out.rolls[1].append(rolls[1])
        out.width.append(float(half_width(case.forces[0] / common, float(candidates.radius[near, k].max()), modulus)))
        # Does a corner of pinion or wheel touch?
        corners = [np.isin(candidates.corner[near, k], ids).any() for ids in ((1, 3), (2, 4))]
        out.slave.append(int(corners[1] and not corners[0]))
        for number, gear in enumerate(pair.gears):
            edge = candidates.corner_gap[FORM[number] - 1, :, k] < REACH * approach  # The corner may be a second contact.
            out.fillet[number].append(bool(edge.any() or on_fillet(gear, rolls[number]).any()))
    return out


def _modified(pair, found, heights, forms):
    """Contacts of the sections at `heights`, with the flanks modified as at these heights."""
    touches = [
        first_touch(pair, forms, found.nominal[:, k], np.full(heights.size, order), found.gap[:, k], heights)
        for k, order in enumerate(found.order.tolist())
    ]
    return Contacts(found.order, found.nominal, *(np.stack(values, axis=-1) for values in zip(*touches, strict=True)))


def write_contact_solid(path: StrPath, case: Case, phase: float, approach: float, how: Pressing) -> SolidDeck:
    """Write the deck of `contact_inp.write_contact_inp` for gears of finite width.

    Nodes lie on modified flanks (`gearfe.geometry.mesh.relieved_solid`), which include misaligned axes.
    """
    pair, forms, fineness = case.pair, case.forms, (how.per_width or SOLID) * how.refine
    common = pair.b_w
    touch = touching(case, phase, approach)
    parts = []
    damage = [tuple(sum(kinds, ())) for kinds in zip(case.cracks, case.pits, case.broken, strict=True)]
    for number, damages in enumerate(damage):
        gear = (pair.gear_1, replace(pair.gear_2, beta=-pair.gear_1.beta))[number]
        low = -(gear.b - common) / 2
        teeth = [(1, -1)[number] * order % gear.z for order in touch.order]
        # Near damage the load varies quickly along the width on both gears.
        holed = any(hurt._removes_contact for hurt in (damages or damage[1 - number]))
        if holed:
            cut = [_strip(gear, touch, number, k, tooth, low, fineness) for k, tooth in enumerate(teeth)]
            body = _holed(gear, damages, cut, how)
        else:
            patches = {tooth: [_patch(gear, touch, number, k, fineness)] for k, tooth in enumerate(teeth)}
            body = _layered(gear, case, number, patches, how)
        if forms is not None:
            body = replace(body, points=relieved_points(body.points, gear, forms[number], teeth))
        turn = float(pair.turn(nominal_at(pair, phase, low))[number])
        mirror = (1, pair.outward)[number]
        x, y = turned([mirror * body.points[0], body.points[1]], turn)
        place = np.array([x, y + (0.0, pair.centre_2)[number], body.points[2] + low])
        parts.append(placed(body, place, mirrored=mirror < 0))
    angles = how.turned(pair, approach)
    slaves = {}
    for k, order in enumerate(touch.order):
        side = touch.slave[k]
        slaves[order] = side, _faces(pair, parts[side], touch, side, k)
    assembly, places = Assembly(), []
    for number, part in enumerate(parts):
        surfaces = {f"C{number + 1}P{k}": _faces(pair, part, touch, number, k) for k in range(len(touch.order))}
        places.append(part.points[:2, part.held] - [[0.0], [(0.0, pair.centre_2)[number]]])  # relative to the centre
        assembly.add(number + 1, part, case.materials[number], surfaces, turned(places[number], angles[number]) - places[number])
    write_lines(path, _text(assembly, touch, how.penalty * max(m.E for m in case.materials)))
    radii, held = (pair.gear_1.r_b, pair.gear_2.r_b), assembly.held
    return SolidDeck((held[0], held[1]), (places[0], places[1]), radii, (parts[0], parts[1]), slaves)


def _faces(pair, part, found, number, k):
    """Return the faces ``(corners, n)`` of a gear that may touch in a tooth pair: flank, and for hexahedra a touching fillet."""
    gear = pair.gears[number]
    tooth = (1, -1)[number] * found.order[k] % gear.z
    out = part.faces[f"flank {tooth}"]
    below = part.faces.get(f"fillet {tooth}") if found.fillet[number][k] else None
    return out if below is None else np.hstack([out, below])


def _patch(gear, found, number, k, per_width):
    """Return the flank strip that a contact line sweeps [mm]: its place and edge length."""
    rolls = found.rolls[number][k]
    arcs, a = arc_at(gear, np.append(rolls, gear.roll_f) if found.fillet[number][k] else rolls), found.width[k]
    return float(arcs.min()) - STRIP * a, float(arcs.max()) + STRIP * a, a / per_width


def _strip(gear, found, number, k, tooth, low, per_width):
    """Return a contact line in the frame of the helix, the half width of its refined strip, and the edge length there [mm]."""
    radius, angle = flank(gear, found.rolls[number][k])
    line = np.array([*cartesian(radius, angle + 2 * math.pi * tooth / gear.z), found.heights[k] - low])
    return line, 1.5 * found.width[k], found.width[k] / per_width


def _layered(gear, case, number, patches, how):
    """Mesh a whole gear in layers of hexahedra, fine on the patches of the loaded teeth."""
    check_mesh(DENSITY * gear.z * how.layers * how.refine**2, how.refine, solved=False)
    fine = [(z, z, END * gear.b / how.layers) for z in (0.0, gear.b)]
    options = {"layer": gear.b / how.layers, "loaded": list(patches), "patches": patches, "fine": fine}
    mesh = solid(gear, cracks=case.cracks[number], broken=case.broken[number], refine=how.refine, sizes=SIZES, **options)
    body = part_of(mesh)
    return replace(body, faces=body.faces | {f"fillet {tooth}": faces[:4] for tooth, faces in mesh.fillets.items()})


def _holed(gear: Gear, damage, strips, how) -> DeckBody:
    """Mesh a whole gear in tets, with or without pits cut out. Its damaged tooth is tooth 0 during meshing."""
    cracks, holes = split(damage)
    if len(cracks) > 1 or not all(crack.through for crack in cracks):
        raise ValueError("a gear with holes may have one crack only, through the whole width: leave out the others")
    tooth = damage[0].tooth % gear.z if damage else 0
    turn = 2 * math.pi * tooth / gear.z
    strips = [(turned(line, -turn), *rest) for line, *rest in strips]
    least = min((min(pit.axes) for pit in holes), default=1.0)
    rim = RIM * how.refine * min(size for *_, size in strips) / least
    sizes = TETS | {"rim": min(rim, HOLES["rim"])}
    sector = holed_sector(gear, holes, *cracks, teeth=None, refine=how.refine, sizes=sizes, strips=strips, stretch=STRETCH)
    body = holed_part(sector if how.pits == "cut" else filled(sector, teeth=None), strips)
    if how.pits == "lost":
        body = replace(body, faces=_uncovered(body.faces))
    points = turned(body.points, turn)
    faces = {_renamed(name, tooth, gear.z): corners for name, corners in body.faces.items()}
    return replace(body, points=points, faces=faces)


def _uncovered(faces):
    """Return the faces, with flanks reduced by the parts above the pits."""
    above = {tuple(face) for face in faces["pits"].T.tolist()}
    return {name: corners[:, [tuple(face) not in above for face in corners.T.tolist()]] for name, corners in faces.items()}


def _renamed(name, tooth, z):
    """Return the name of a flank if tooth 0 of the mesh is tooth `tooth` of the gear."""
    return f"flank {(int(name.split()[1]) + tooth) % z}" if name.startswith("flank ") else name


def _text(assembly, found, stiffness):
    yield "** gearfe: gear pair of finite width in contact; mm, N, MPa"
    yield from (*assembly.nodes, *assembly.blocks)
    contacts = [(f"C{slave + 1}P{k}", f"C{2 - slave}P{k}") for k, slave in enumerate(found.slave)]
    yield from pressing(stiffness, contacts, assembly.motions)
    yield "*NODE PRINT, NSET=H1\nRF\n*NODE PRINT, NSET=H2\nRF"
    yield from (f"*CONTACT PRINT, SLAVE={slave}, MASTER={master}\nCF" for slave, master in contacts)
    yield "*CONTACT FILE\nCDIS\n*END STEP\n"
