"""Stress intensity factors of a root crack, and the direction of crack growth."""

from dataclasses import dataclass

import numpy as np

from ..core.material import Material
from ..core.threads import single
from ..flexibility.finite_elements.fe import EDGES
from ..flexibility.finite_elements.one_tooth import NARROW, check_line_load, edge_lengths, load_at, narrow_section
from ..flexibility.tip import tip_rows
from ..geometry.damage.crack import Crack
from ..geometry.damage.kinds import check_crack
from ..geometry.tooth.gear import Gear
from .kink import growth_angle


@dataclass(frozen=True, slots=True)
class Intensity:
    """Stress intensity at a crack tip.

    Attributes
    ----------
    K_I, K_II : float
        Stress intensity factors [MPa sqrt(mm)]. K_I < 0 means that the faces are pressed together, without mode I.
    direction : float
        Angle [rad] by which the crack would turn when it grows (maximum tangential stress), positive to the left seen
        along the crack; nan if K_I <= 0.
    """

    K_I: float
    K_II: float
    direction: float


@single
def stress_intensity(
    gear: Gear,
    crack: Crack,
    radius: float,
    line_load: float,
    material: Material,
    *,
    state: str = "plane strain",
    refine: float = 1.0,
) -> Intensity:
    """Stress intensity factors of a cracked tooth under a load on its flank.

    Parameters
    ----------
    gear : Gear
    crack : Crack
    radius : float
        Radius of the loaded flank point of the cracked tooth [mm].
    line_load : float
        Load normal to the flank, per face width [N/mm].
    material : Material
    state : {"plane strain", "plane stress"}
    refine : float
        Divides the edge lengths.

    Returns
    -------
    Intensity

    Raises
    ------
    ValueError
        If the load is not positive, the point is off the flank, or the crack leaves the body.
    """
    check_line_load(line_load, gear, material)
    check_crack(crack)
    edge = edge_lengths(gear, EDGES, refine)
    edge["fillet"] /= 2
    at = load_at(gear, radius), NARROW * gear.m_n, NARROW * gear.m_n / 4
    mesh, body, load = narrow_section(gear, material, state, edge, at, crack.tooth, [crack])
    moved = line_load * body.solve(load)[:, 0]
    return tip_intensity(body, moved, mesh.seams[0].faces)


def tip_intensity(body, moved, faces):
    """Compute the stress intensity by the interaction integral over a ring of triangles around the crack tip.

    `gearfe.flexibility.tip` defines the integral. The ring contains neither the mouth nor a bend of the crack, nor another
    boundary.
    `moved` ``(2 nodes,)`` is the displacement of a `Body` [mm], `faces` ``(2, n)`` are those of a
    `gearfe.geometry.mesh.section_mesh.Seam`.

    References
    ----------
    J. F. Yau, S. S. Wang, H. T. Corten, J. Appl. Mech. 47 (1980) 335-341; F. Erdogan, G. C. Sih, J. Basic Eng. 85 (1963)
    519-527 (direction).
    """
    values = (tip_reads(body, faces) @ moved).tolist()
    return Intensity(*values, growth_angle(*values))


def tip_reads(body, faces):
    """Return nodal vectors ``(2, 2 nodes)`` whose products with the displacement of a `Body` are K_I and K_II."""
    mesh = body.mesh
    turn, place, q = ring(mesh, faces)
    used = np.flatnonzero((q[body.nodes] > 0).any(axis=0) & (q[body.nodes] < 1).any(axis=0))
    nodes = body.nodes[:, used]
    grads = np.array([body.basis.basis[i][0].grad[:, used] for i in range(6)])  # axes: node, direction, triangle, point
    grads = np.einsum("ab,nbtp->natp", turn, grads)
    shapes = np.array([body.basis.elem.lbasis(body.basis.X, i)[0] for i in range(6)])
    slope, at = np.einsum("nt,njtp->jtp", q[nodes], grads), np.einsum("int,np->itp", place[:, nodes], shapes)
    rows = np.einsum("knat,ab->kbnt", tip_rows(grads, at, slope, body.basis.dx[used], body.material, body.state), turn)
    out = np.zeros((2, mesh.doflocs.shape[1], 2))
    for mode, component in np.ndindex(2, 2):
        np.add.at(out[mode, :, component], nodes, rows[mode, component])
    return out.reshape(2, -1)


def ring(mesh, faces):
    """Return axes ``(2, 2)`` of a tip, nodes ``(2, nodes)`` in these axes [mm], and q ``(nodes,)`` of the largest ring.

    Within the ring the crack is straight, and there is no other boundary.
    """
    tip = mesh.doflocs[:, faces[0, -1]]
    ahead = tip - mesh.doflocs[:, faces[0, -3]]
    ahead = ahead / np.hypot(*ahead)
    turn = np.array([ahead, [-ahead[1], ahead[0]]])
    place = turn @ (mesh.doflocs - tip[:, None])
    on_line = np.abs(place[1, faces[0]]) < 1e-6 * np.abs(place[0, faces[0]]).max()
    straight = np.abs(place[0, faces[0][on_line]]).max()
    rim = np.unique(np.concatenate([mesh.facets[:, edges].ravel() for edges in mesh.boundaries.values()]))
    radius = 0.9 * min(straight, np.hypot(*place[:, rim]).min())
    return turn, place, np.clip(2 - 2 * np.hypot(*place) / radius, 0, 1)
