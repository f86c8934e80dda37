"""A whole planetary set in contact as a CalculiX deck: the second opinion on `planetary_stiffness`.

Sun and planets are turned by what was found here, the ring is held on its pads; what the bodies then push is CalculiX's own.
"""

import math
import os
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.mesh.both_flanks import both_flanks
from geometry.mesh.outline import stations
from geometry.tooth.profile import arc_at

from ..elements.contact_deck import TIP
from ..elements.deck import element_nodes, held_nodes
from ..elements.elasticity import edge_nodes
from ..elements.fe import EDGES
from ..files import written
from ..flexibility.hertz import contact_modulus, half_width
from .case import PlanetaryCase
from .standing import directions, standing, tooth_angles

NEAR = 1.5  # times the approach of a mesh: gaps up to there are pressed together


@dataclass(frozen=True, slots=True)
class SetDeck:
    """What is needed to read the result: of sun, planets and ring the held nodes and their places from the gear's centre [mm].

    `rim` are the nodes of the ring's outer edge, `around` their places [mm], `angle` that of the ring's tooth 0 [rad].
    """

    case: PlanetaryCase
    held: list[NDArray[np.int64]]
    place: list[NDArray[np.float64]]
    rim: NDArray[np.int64]
    around: NDArray[np.float64]
    angle: float

    def forces(self, path: str | os.PathLike[str]) -> dict[str, Any]:
        """What CalculiX printed to the ``.dat`` file `path`, per width [N/mm].

        ``"sun"``, ``"ring"``: torque over the base radius. ``"outer"``, ``"inner"`` ``(planets,)``: forces of the meshes of each
        planet, from its pin's force and torque.
        """
        reaction = _printed(path, "forces")
        moments, sums = [], []
        for nodes, place in zip(self.held, self.place, strict=True):
            f = np.array([reaction[n] for n in nodes.tolist()])[:, :2].T
            moments.append(float((place[1] * f[0] - place[0] * f[1]).sum()))
            sums.append(f.sum(axis=1))
        gears, n = self.case.gears, self.case.planets
        outer, inner = directions(gears, np.array(self.case.angles))
        meshes = []
        for i in range(n):  # the pin holds against both meshes: force and clockwise torque
            system = np.array([[*outer[:, i]], [*inner[:, i]]]).T
            torque = np.array([-1.0, 1.0]) * gears.planet.r_b
            rows = np.vstack([system, torque / gears.planet.r_b])
            right = -np.append(sums[1 + i], moments[1 + i] / gears.planet.r_b)
            meshes.append(np.linalg.lstsq(rows, right, rcond=None)[0])
        found = np.array(meshes).T
        return {"sun": moments[0] / gears.sun.r_b, "ring": moments[-1] / gears.ring.r_b, "outer": found[0], "inner": found[1]}

    def moved(self, path: str | os.PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Angles ``(n,)`` of the rim's nodes from the ring's tooth 0 [rad]; how they move outwards, clockwise ``(n, 2)`` [mm]."""
        found = _printed(path, "displacements")
        u = np.array([found[n] for n in self.rim.tolist()])[:, :2]
        angle = np.arctan2(*self.around)
        sin, cos = np.sin(angle), np.cos(angle)
        out = np.column_stack([sin * u[:, 0] + cos * u[:, 1], cos * u[:, 0] - sin * u[:, 1]])
        return (angle - self.angle) % (2 * math.pi), out


def _printed(path, what):
    """Rows of each node from the parts of a ``.dat`` file whose heading begins with `what`."""
    out, on = {}, False
    for line in Path(path).read_text(encoding="ascii").splitlines():
        row = line.split()
        if row and not row[0].isdigit():
            on = row[0] == what
        elif on and len(row) == 4:
            out[int(row[0])] = tuple(map(float, row[1:]))
    if not out:
        raise RuntimeError(f"{path} holds no {what}: CalculiX found no equilibrium; its .sta and .cvg files say how far it came")
    return out


def write_set_inp(
    path: str | os.PathLike[str], curves: Any, at: int, *, per_width: float = 6.0, penalty: float = 500.0, refine: float = 1.0
) -> SetDeck:
    """Write a deck of one position of `SetCurves`: all gears with all teeth in second-order triangles, plane strain.

    Small displacements; frictionless surface-to-surface contact of all flanks that may touch.

    Parameters
    ----------
    path : path
        Ends in ``.inp``.
    curves : SetCurves
        Of a case with a held ring or one on rigid pads, without modified flanks and cracks.
    at : int
        Number of the position.
    per_width : float
        Edges per Hertz half width.
    penalty : float
        Stiffness of the contact springs over E, per mm.
    refine : float
        Divides the other edge lengths.

    Returns
    -------
    SetDeck
    """
    case = curves.meta["case"]
    position = curves.position[at]
    stand = standing(case.gears, np.array(case.angles), [position])
    pressed = touching(case, stand, curves, at)
    bodies = placed(case, stand, curves, at)
    lines = ["** gearfe: planetary set, plane strain; mm, N, MPa, per mm of width", "*NODE, NSET=ALL"]
    blocks, ends, contact = [], [], []
    held, place, first, element, surfaces = [], [], 0, 0, {}
    for number, (gear, material, centre, angle, moved) in enumerate(bodies):
        rolls = _rolls(gear, [one for pair in pressed for one in pair if one["body"] == number], per_width, refine)
        marks = case.ring.ends(gear) if gear.internal and case.ring != "held" else ()
        edge = {name: size * gear.m_n / refine for name, size in EDGES.items()}
        made = both_flanks(
            gear, rolls, fillet_size=edge["fillet"], size=edge["near"], far_size=edge["far"], marks=marks, mark_size=0.05 / refine
        )
        cos, sin = math.cos(angle), math.sin(angle)
        x, y = made.mesh.doflocs
        own = np.array([cos * x + sin * y, cos * y - sin * x])
        lines += [f"{first + k}, {u:.12e}, {v:.12e}, 0." for k, (u, v) in enumerate((own.T + centre).tolist(), 1)]
        nodes = element_nodes(made.mesh, own)
        blocks += [f"*ELEMENT, TYPE=CPE6, ELSET=G{number}"]
        blocks += [f"{element + j}, {', '.join(map(str, row))}" for j, row in enumerate((nodes + first + 1).T.tolist(), 1)]
        blocks += [f"*MATERIAL, NAME=M{number}\n*ELASTIC\n{material.E!r}, {material.nu!r}"]
        blocks += [f"*SOLID SECTION, ELSET=G{number}, MATERIAL=M{number}\n1."]
        for tooth, side in rolls:
            name = surfaces[number, tooth, side] = f"C{number}T{tooth}S{side}"
            blocks += [f"*SURFACE, NAME={name}, TYPE=ELEMENT"]
            middles = edge_nodes(made.mesh, made.flank[tooth, side])[2]
            for face in range(3):
                blocks += [f"{element + j + 1}, S{face + 1}" for j in np.flatnonzero(np.isin(nodes[3 + face], middles)).tolist()]
        fixed = held_nodes(made.mesh)
        if len(marks):
            fixed = fixed[case.ring.covers(gear, made.mesh.doflocs[:, fixed])]
        held.append(fixed + first + 1)
        place.append(own[:, fixed])
        blocks += [f"*NSET, NSET=H{number}", *(f"{n}," for n in held[-1].tolist())]
        turn, shift = moved
        u = np.array([place[-1][1] * turn, -place[-1][0] * turn]) + np.reshape(shift, (2, 1))
        for n, (ux, uy) in zip(held[-1].tolist(), u.T.tolist(), strict=True):
            ends += [f"{n}, 1, 1, {ux:.10e}", f"{n}, 2, 2, {uy:.10e}"]
        if number == len(bodies) - 1:
            every = held_nodes(made.mesh)
            rim, around = every + first + 1, own[:, every]
            blocks += ["*NSET, NSET=RIM", *(f"{n}," for n in rim.tolist())]
        first, element = first + x.size, element + nodes.shape[1]
    for one, two in pressed:
        pinion, wheel = (surfaces[side["body"], side["tooth"], side["side"]] for side in (one, two))
        slave = (wheel, pinion) if two["tip"] else (pinion, wheel)
        contact += ["*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE", ", ".join(slave)]
    stiff = penalty * max(m.E for m in case.material)
    law = f"*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiff:.6e}"
    step = ["*STEP, INC=200\n*STATIC\n1., 1.", "*BOUNDARY", *ends]
    prints = [*(f"*NODE PRINT, NSET=H{k}\nRF" for k in range(len(bodies))), "*NODE PRINT, NSET=RIM\nU"]
    with written(path) as name:
        Path(name).write_text("\n".join([*lines, *blocks, law, *contact, *step, *prints, "*END STEP\n"]), encoding="ascii")
    return SetDeck(case, held, place, rim, around, bodies[-1][3])


def touching(case, stand, curves, at):
    """Both sides of all tooth pairs that may touch: body, tooth, side, and where (see the dict).

    `arc`, `roll` and half `width` of the contact [mm], `tip`: whether the tip corner is there, `force` [N/mm].
    """
    out = []
    for inner, phases, firsts in ((0, stand.outer, stand.planet), (1, stand.inner, stand.ring)):
        pair = case.pairs[inner]
        for i in range(case.planets):
            phase = float(phases[0, i])
            whole = math.floor(phase)
            found = pair.contacts([phase - whole])
            load = curves.force[inner, at, i] / case.width
            force = Counter(dict(zip(curves.order.tolist(), curves.pair_force[inner, at, i].tolist(), strict=True)))
            approach = curves.force[inner, at, i] / curves.k[inner, at, i] * 1e3
            for k in np.flatnonzero(found.gap[0] < NEAR * approach).tolist():
                tooth = int(found.order[k]) - whole
                first = (-tooth if inner else tooth), int(firsts[i]) - tooth
                width = float(half_width(load, found.radius[0, k], contact_modulus(case.material[inner : inner + 2])))
                sides = []
                for which, (gear, roll) in enumerate(zip((pair.gear_1, pair.gear_2), (found.roll_1, found.roll_2), strict=True)):
                    body = ((0, 1 + i), (1 + i, 1 + case.planets))[inner][which]
                    sides.append({
                        "body": body, "tooth": first[which] % gear.z, "side": 1 if inner and not which else 0,
                        "arc": float(arc_at(gear, roll[0, k])), "width": width,
                        "roll": float(roll[0, k]), "force": float(force[int(found.order[k])]) / case.width,
                        "tip": abs(float(roll[0, k]) - gear.roll_a) < 1e-9 * gear.m_n,
                    })  # fmt: skip
                out.append(sides)
    counted = Counter((one["body"], one["tooth"], one["side"]) for pair in out for one in pair)
    if max(counted.values()) > 1:
        raise ValueError("a flank touches two others here: choose another position")
    return out


def placed(case, stand, curves, at):
    """Gear, material, centre [mm], angle of tooth 0 [rad], and motion of the held nodes (turn, (x, y)) of sun, planets, ring."""
    angles, gears = np.array(case.angles), case.gears
    sun, planets, ring = tooth_angles(gears, angles, stand)
    _, inner = directions(gears, angles)
    turn, orbit = curves.te[at] * 1e3, curves.orbit[at] * 1e3
    out = [(gears.sun, case.material[0], np.zeros(2), sun, (turn / gears.sun.r_b, orbit))]
    for i, angle in enumerate(angles):
        place = np.array([math.sin(angle), math.cos(angle)])
        along = np.array([math.cos(angle), -math.sin(angle)])
        error = case.errors[i][0] * place + case.errors[i][1] * along
        closed = curves.force[1, at, i] / curves.k[1, at, i] * 1e3  # of the mesh with the ring, by the planet's turn and shift
        turned = closed + inner[:, i] @ error
        out.append((gears.planet, case.material[1], gears.a * place, planets[i], (-turned / gears.planet.r_b, error)))
    out.append((case.ring_gear, case.material[2], np.zeros(2), ring, (0.0, np.zeros(2))))
    return out


def _rolls(gear, sides, per_width, refine):
    """Roll lengths of the vertices of loaded flanks, by tooth and side."""
    edge, top, out = {name: size * gear.m_n / refine for name, size in EDGES.items()}, arc_at(gear, gear.roll_a), {}
    for one in sides:
        arc, a = one["arc"], one["width"]
        tip = min(a / per_width / 2, TIP * gear.m_n) if top - arc < 2 * a else 0.05 * gear.m_n
        patch = (arc - 3 * a, arc + 3 * a, a / per_width)
        out[one["tooth"], one["side"]] = stations(gear, 2 * edge["flank"], tip=tip, low=edge["flank"], patches=[patch])
    return out
