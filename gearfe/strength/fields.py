"""Stress fields of loaded gears: both gears of a spur pair in their transverse section, and output as ``.vtu``."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..core.files import written
from ..core.steps import steps
from ..flexibility.finite_elements.elasticity import HeldSection
from ..flexibility.finite_elements.fe import EDGES, flank_load
from ..flexibility.finite_elements.one_tooth import edge_lengths
from ..flexibility.hertz import contact_modulus, half_width
from ..geometry.damage.chip import loaded_side
from ..geometry.damage.kinds import why_wide
from ..geometry.mesh.outline import stations
from ..geometry.mesh.section_mesh import section
from ..geometry.pair.contacts import contacts
from ..geometry.tooth.profile import arc_at
from ..stiffness.solve import Solve, solve

MISES = "von Mises stress [MPa]"


@dataclass(frozen=True, slots=True)
class Field:
    """Displacement and stress on second-order elements.

    `points` ``(3, n)`` are the nodes, `moved` ``(3, n)`` their displacements [mm], and `stress` ``(6, n)`` their stresses (xx,
    yy, zz, xy, yz, xz) [MPa]. `cells` ``(6 or 10, m)`` are in VTK's order, of `kind` ``triangle6`` or ``tetra10``. `lines`
    ``(2, k)`` are edges of the outline, the crack and the rims of pits. `root` is the largest von Mises stress on the fillets
    [MPa]. `opening` is the largest opening of the crack under load [mm].
    """

    points: np.ndarray
    kind: str
    cells: np.ndarray
    moved: np.ndarray
    stress: np.ndarray
    lines: np.ndarray
    root: float
    opening: float

    @property
    def mises(self):
        """Von Mises stress ``(n,)`` [MPa]."""
        return von_mises(self.stress)


def von_mises(stress):
    """Von Mises stress ``(n,)`` of stress ``(6, n)`` (xx, yy, zz, xy, yz, xz)."""
    xx, yy, zz, xy, yz, xz = stress
    return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * (xy**2 + yz**2 + xz**2))


def write_vtu(path, fields):
    """Write fields as one VTK file: ``displacement [mm]``, ``stress [MPa]`` (xx, yy, zz, xy, yz, xz), von Mises stress."""
    import meshio

    first = np.cumsum([0, *(field.points.shape[1] for field in fields)])
    cells = [(field.kind, (field.cells + start).T) for field, start in zip(fields, first, strict=False)]
    data = {"displacement [mm]": "moved", "stress [MPa]": "stress", MISES: "mises"}
    values = {name: np.concatenate([getattr(field, key).T for field in fields]) for name, key in data.items()}
    mesh = meshio.Mesh(np.concatenate([field.points.T for field in fields]), cells, point_data=values)
    with written(path) as name:
        mesh.write(name, file_format="vtu")


def loaded_phase(case):
    """Return the phase of the largest load on the damaged tooth (or next to a missing tooth). Without damage it is 0."""
    order = case.first_tooth
    if order is None:
        return 0.0
    if case.missing:  # The pair behind a missing tooth carries the whole load just before it leaves the path.
        return (case.pair.eps_alpha - 1) * 0.9 - order
    phases = -order + case.pair.eps_alpha * (np.arange(64) + 0.5) / 64
    curve = solve(replace(case, damage=None, supports=None), Solve("ritz", phases))
    load = curve.force[:, curve.order == order].sum(axis=1)
    return float(phases[np.flatnonzero(load > (1 - 1e-6) * load.max())[-1]])


def stressed_gears(case, phase=0.0, refine=1.0):
    """Return the `Field` of both gears of a spur pair at `phase`, in plane strain, in the frame of the pinion.

    Crack faces may pass through each other.
    """
    pair, materials = case.pair, case.materials
    if any(case.pits):
        raise ValueError(f"{why_wide([*case.pits[0], *case.pits[1]])}: a transverse section cannot show them")
    curve = solve(replace(case, supports=None), Solve("ritz", [phase]))  # Supports do not change the load sharing of a section.
    candidates = contacts(pair, [phase])
    forces = dict(zip(curve.order.tolist(), curve.force[0] / curve.meta["width_mm"], strict=True))
    carrying = [(i, k) for i, k in enumerate(candidates.order.tolist()) if forces.get(k, 0.0) > 0]
    nominal = candidates.nominal[0, carrying[0][0]] - carrying[0][1] * pair.p_bt
    modulus = contact_modulus(materials)
    out = []
    rolls = candidates.roll_1[0], candidates.roll_2[0]
    mirrors, centres = (1, pair.outward), (0.0, pair.centre_2)
    damage = tuple(zip(case.cracks, case.broken, strict=True))
    gears = pair.gears, materials, damage, rolls, pair.turn(nominal), centres, mirrors, (1, -1)
    for gear, material, hurt, roll, turn, centre, mirror, ahead in steps(zip(*gears, strict=True)):
        loads = {}
        for i, k in carrying:
            radius = pair.relative_radius(candidates.roll_1[0, i], candidates.roll_2[0, i])
            loads[ahead * k] = (roll[i], forces[k], float(half_width(forces[k], radius, modulus)))
        mesh, moved, stress = _loaded_gear(gear, material, loads, refine, *hurt)
        out.append(_placed(mesh, moved.reshape(-1, 2).T, stress, material, turn, centre, mirror))
    return out


def _placed(mesh, moved, stress, material, turn, centre, mirror):
    """Return the `Field` of a gear rotated by `turn` about its centre at height `centre`."""
    cos, sin = math.cos(turn), math.sin(turn)
    frame = np.array([[cos * mirror, sin], [-sin * mirror, cos]])
    x, y = frame @ mesh.mesh.doflocs
    xx, yy, xy = stress
    plane = np.einsum("ia,abn,jb->ijn", frame, np.array([[xx, xy], [xy, yy]]), frame)
    zero = np.zeros(x.size)
    six = np.array([plane[0, 0], plane[1, 1], material.nu * (xx + yy), plane[0, 1], zero, zero])
    inner = mesh.mesh
    cells = np.vstack([inner.t[:3], inner.nvertices + inner.t2f])
    rim, held = inner.boundaries["rim"], inner.boundaries["held"]
    edges = np.concatenate([rim, held])
    (start, stop), middle = inner.facets[:, edges], inner.nvertices + edges
    lines = [np.array([start, middle]), np.array([middle, stop])]
    lines += [np.array([face[:-1], face[1:]]) for seam in mesh.seams for face in seam.faces]
    opening = [np.hypot(*(moved[:, seam.faces[0]] - moved[:, seam.faces[1]])).max() for seam in mesh.seams]
    made = np.array([x, y + centre, zero]), "triangle6", cells, np.vstack([frame @ moved, zero]), six, np.hstack(lines)
    field = Field(*made, 0.0, max(opening, default=0.0))
    outline = np.unique(inner.facets[:, rim])
    low = mesh.gear.outward * (mesh.gear.r_form - np.hypot(*mesh.mesh.doflocs[:, outline])) > 0
    return replace(field, root=float(field.mises[outline[low]].max()))


def _loaded_gear(gear, material, loads, refine, cracks, broken):
    """Mesh a gear for contacts ``{tooth: (roll, line load, half width)}``, and solve it."""
    edge = edge_lengths(gear, EDGES, refine)
    rolls, arcs = {}, {}
    for tooth, (roll, _, a) in loads.items():
        end = loaded_side(gear, broken, tooth)
        top = arc_at(gear, end.roll_a)
        arcs[tooth] = min(arc_at(gear, roll), top - a)
        rolls[tooth] = stations(end, edge["flank"], patches=[(arcs[tooth] - 1.5 * a, arcs[tooth] + 1.5 * a, a / 6)])
    sizes = {"fillet_size": edge["fillet"] / 2, "size": edge["near"] / 2, "far_size": edge["far"]}
    mesh = section(gear, rolls, **sizes, cracks=cracks, broken=broken)
    body = HeldSection(mesh.mesh, material)
    force = 0.0
    for tooth, (_, line_load, a) in loads.items():

        def pressure(s, arc=arcs[tooth], a=a, line_load=line_load):
            return 2 * line_load / (math.pi * a) * np.sqrt(np.maximum(1 - ((s - arc) / a) ** 2, 0.0))

        force = force + flank_load(mesh, tooth, pressure, np.array([0]), rolls[tooth].size - 1)
    moved = body.solve(force)[:, 0]
    return mesh, moved, body.stress(moved, inset=0.05 if cracks else 0.0)


def rounded_up(value):
    """Return the next of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(s * power for s in (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10) if s * power >= value * (1 - 1e-9))
