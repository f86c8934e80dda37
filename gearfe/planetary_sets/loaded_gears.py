"""Single gears of a loaded set, for decks and pictures: position, touching flanks, and mesh."""

import math
from collections import Counter
from typing import Any

import numpy as np

from ..core.checks import whole
from ..decks.solid_deck import held_nodes
from ..flexibility.hertz import contact_modulus, half_width
from ..geometry.mesh.both_flanks import both_flanks
from ..geometry.pair.broken import ToothPairs, touching_each
from ..geometry.pair.contacts import contacts
from ..geometry.tooth.profile import arc_at
from .case import PlanetaryCase
from .faults import faults
from .meshes import broken_of
from .rim_supports import RimSupports
from .standing import Standing, directions, standing, tooth_angles

NEAR = 1.5  # gaps up to this multiple of the approach can close


def check_meshable(case: PlanetaryCase) -> None:
    """Raise ValueError for a set whose gears are not meshed: modified flanks, or a ring neither held nor on rigid pads."""
    rigid = isinstance(case.ring, RimSupports) and math.isinf(case.ring.radial) and math.isinf(case.ring.tangential)
    if not (case.ring == "held" or rigid):
        raise ValueError(
            "the ring is neither held nor on rigid pads, so that it cannot be meshed: give a case with one of these supports"
        )
    if case.flanks:
        raise ValueError("modified flanks of a set are not meshed: give a case without them")


def drawable(curves: Any, at: Any) -> tuple[PlanetaryCase, Standing]:
    """Return case and `Standing` of one position. ValueError if the gears cannot be meshed.

    ValueError for the reasons of `check_meshable`, or if there is no such position.
    """
    if whole("at", at, 0) >= curves.position.size:
        raise ValueError(f"at = {at}, but there are {curves.position.size} positions: give 0 to {curves.position.size - 1}")
    case = curves.meta["case"]
    check_meshable(case)
    return case, standing(case.gears, np.array(case.planet_angles), [curves.position[at]])


def meshed(case, gear, rolls, fillet, near, far, pad, cracks=(), broken=()):
    """Mesh a gear with given edge lengths [mm], and return its `Section` and its held nodes."""
    pads = gear.internal and case.ring != "held"
    marks = case.ring.ends(gear) if pads else ()
    sizes = {"fillet_size": fillet, "size": near, "far_size": far, "marks": marks, "mark_size": pad}
    section = both_flanks(gear, rolls, **sizes, cracks=cracks, broken=broken)
    held = held_nodes(section.mesh)
    return section, held[case.ring.covers(gear, section.mesh.doflocs[:, held])] if pads else held


def touching(case, stand, curves, at):
    """Return both flanks of all tooth pairs that may touch, as a dict by (body, tooth, side).

    The values are `arc`, `roll` and half `width` of the contact [mm], `tip` (true at a tip corner) and `force` [N/mm].
    """
    out = []
    for inner, phases, firsts in ((0, stand.outer, stand.planet), (1, stand.inner, stand.ring)):
        pair = case.pairs[inner]
        for i in range(case.planets):
            phase = float(phases[0, i])
            whole = math.floor(phase)
            damage = faults(case, bool(inner), i, int(firsts[i]))[1]
            pairs = ToothPairs(pair, tuple(map(broken_of, damage)))
            near = contacts(pair, [phase - whole])
            teeth = [(int(order) - whole, nominal) for order, nominal in zip(near.order, near.nominal[0], strict=True)]
            teeth = [one for one in teeth if pairs(one[0]) is not None]
            order, nominal = map(np.array, zip(*teeth, strict=True))
            found = touching_each(pairs, order, np.zeros(order.size), nominal)
            load = curves.force[inner, at, i] / case.width
            force = dict(zip(curves.order.tolist(), curves.pair_force[inner, at, i].tolist(), strict=True))
            for k in np.flatnonzero(found.gap - found.gap.min() < NEAR * _closed(curves, inner, at, i)).tolist():
                tooth = int(order[k])
                first = (-tooth if inner else tooth), int(firsts[i]) - tooth
                width = float(half_width(load, found.radius[k], contact_modulus(case.material[inner : inner + 2])))
                sides = []
                for which, (gear, roll) in enumerate(zip(pair.gears, found.rolls, strict=True)):
                    body = ((0, 1 + i), (1 + i, 1 + case.planets))[inner][which]
                    sides.append({
                        "body": body, "tooth": first[which] % gear.z, "side": 1 if inner and not which else 0,
                        "arc": float(arc_at(gear, roll[k])), "width": width,
                        "roll": float(roll[k]), "force": force.get(tooth + whole, 0.0) / case.width,
                        "tip": abs(float(roll[k]) - gear.roll_a) < 1e-9 * gear.m_n,
                    })  # fmt: skip
                out.append(sides)
    counted = Counter((side["body"], side["tooth"], side["side"]) for pair in out for side in pair)
    if max(counted.values()) > 1:
        raise ValueError(f"at = {at}: a flank touches two others at this position: choose another one")
    return out


def _closed(curves, inner, at, i):
    """Return the approach of a mesh after its first touch [mm], or 0 without load."""
    k = float(curves.k[inner, at, i])
    return float(curves.force[inner, at, i]) / k * 1e3 if k else 0.0


def placed(case, stand, curves, at):
    """Return gear, material, centre [mm], angle of tooth 0 [rad] and motion of the held nodes, for sun, planets and ring."""
    angles, gears = np.array(case.planet_angles), case.gears
    sun, planets, ring = tooth_angles(gears, angles, stand)
    _, inner = directions(gears, angles)
    turn, orbit = curves.te[at] * 1e3, curves.orbit[at] * 1e3
    out = [(gears.sun, case.material[0], np.zeros(2), sun, (turn / gears.sun.r_b, orbit))]
    for i, angle in enumerate(angles):
        place = np.array([math.sin(angle), math.cos(angle)])
        along = np.array([math.cos(angle), -math.sin(angle)])
        error = case.errors[i][0] * place + case.errors[i][1] * along
        # approach of the ring mesh by rotation and translation of the planet
        turned = _closed(curves, 1, at, i) + inner[:, i] @ error
        out.append((gears.planet, case.material[1], gears.a * place, planets[i], (-turned / gears.planet.r_b, error)))
    out.append((case.ring_gear, case.material[2], np.zeros(2), ring, (0.0, np.zeros(2))))
    return out
