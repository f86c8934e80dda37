"""Gear in one piece with its shaft. It is held at its end faces, which move with the adjoining shaft stubs.

The body is solid (except for a free hole at its centre) and elastic throughout, without a beam inside the gear. Where a stub
adjoins, the end face inside the stub's radius stays plane and moves as a rigid disc, like the cross section of a beam. With C the
influence between loads f with both discs held, and g the forces that a unit motion q of the discs causes at the free nodes,
free nodes,

    C_total = C_ff + C_fg (K_body + K_stubs)**-1 C_gf,    K_body = r' K r - g' K_free**-1 g

where r are the discs' rigid motions. This is exact and needs one factorisation and twelve more columns.
"""

import math
from dataclasses import replace

import numpy as np
from scipy.sparse import hstack

from ...core.supports.stubs import MOTIONS, face_radii, stub_stiffness
from .fe3d import Influence, loads_and_rows, planned
from .solid_assembly import assemble
from .solver import half_solved


def integral_influence(mesh, material, patches, shaft, *, tell=None, zones=None):
    """Compute the influence matrix (`gearfe.flexibility.finite_elements.fe3d.influence`) of a gear on the stubs of its shaft.

    Raises
    ------
    ValueError
        If the gear reaches beyond its shaft, or nothing of an end face is left inside of a stub.
    """
    mesh, discs = on_stubs(mesh, shaft)
    load, _, rows = loads_and_rows(mesh, patches, zones)
    columns = load.shape[1]
    cost = planned(mesh, patches, columns - math.prod(patches.shape) + discs.shape[1])
    if tell:
        tell(cost)
    whole = assemble(mesh.points, mesh.cells, material, np.arange(mesh.points.shape[1]))
    moved = whole @ discs + whole.T @ discs - whole.diagonal()[:, None] * discs  # Only the lower triangle of `whole` is stored.
    gram = half_solved(whole[rows][:, rows].tocsc(), hstack([load[rows], -moved[rows]]), cost)
    direct, cross, back = gram[:columns, :columns], gram[:columns, columns:], gram[columns:, columns:]
    used = np.flatnonzero(np.abs(discs).max(axis=0))
    stiff = discs.T @ moved - back + stub_stiffness(shaft, mesh.gear.b)
    total = direct + cross[:, used] @ np.linalg.solve(stiff[np.ix_(used, used)], cross[:, used].T)
    return Influence.between(patches, (total + total.T) / 2, rows.size)


def on_stubs(mesh, shaft):
    """Return the mesh, held at discs on its end faces, and the rigid motions of the discs at all nodes ``(3 nodes, 12)``."""
    gear, points = mesh.gear, mesh.points
    first, last = shaft.gear - gear.b / 2, shaft.gear + gear.b / 2
    if first < -1e-9 * gear.b or last > shaft.length + 1e-9 * gear.b:
        raise ValueError(
            f"shaft: the gear from {first:g} to {last:g} mm is one with its shaft, which reaches from 0 to {shaft.length:g} mm"
        )
    if first < shaft.torque < last:
        raise ValueError(
            f"shaft: torque = {shaft.torque:g} mm is inside of the gear, {first:g} to {last:g} mm: it must leave through a stub"
        )
    radius, held, motions = np.hypot(points[0], points[1]), [], np.zeros((points.shape[1], 3, 2 * MOTIONS))
    for k, (z, stub) in enumerate(zip((0.0, gear.b), face_radii(shaft, gear.b), strict=True)):
        reach = min(stub, gear.r_f)
        disc = np.flatnonzero((np.abs(points[2] - z) < 1e-9 * gear.b) & (radius <= reach * (1 + 1e-9)))
        if reach and not disc.size:
            raise ValueError(
                f"shaft: its radius {stub:g} mm next to the gear is less than that of its bore, r_bore = {gear.r_bore:g} mm"
            )
        x, y = points[0, disc], points[1, disc]
        rigid = motions[disc, :, MOTIONS * k : MOTIONS * (k + 1)]
        rigid[:, [0, 1, 2], [0, 1, 2]] = 1.0
        # Rotations about x and y move the disc along z, and a rotation about z moves it in its plane.
        rigid[:, 2, 3], rigid[:, 2, 4] = y, -x
        rigid[:, 0, 5], rigid[:, 1, 5] = -y, x
        motions[disc, :, MOTIONS * k : MOTIONS * (k + 1)] = rigid
        held.append(disc)
    return replace(mesh, held=np.concatenate(held)), motions.reshape(-1, 2 * MOTIONS)
