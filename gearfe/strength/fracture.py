"""Stress intensity factors of a root crack, and its direction of growth."""

import math
from dataclasses import dataclass

import numpy as np

from ..core.material import Material
from ..core.threads import single
from ..flexibility.finite_elements.fe import EDGES
from ..flexibility.finite_elements.one_tooth import NARROW, check_line_load, check_one, edge_lengths, load_at, narrow_section
from ..geometry.damage.crack import Crack
from ..geometry.damage.kinds import check_crack
from ..geometry.tooth.gear import Gear


@dataclass(frozen=True, slots=True)
class Intensity:
    """Stress intensity at a crack tip.

    Attributes
    ----------
    K_I, K_II : float
        [MPa sqrt(mm)]; K_I < 0 means that the faces are pressed together (then no opening mode exists).
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
    check_one(gear, material, refine)
    check_line_load(line_load, gear, material)
    check_crack(crack)
    edge = edge_lengths(gear, EDGES, refine)
    edge["fillet"] /= 2
    at = load_at(gear, radius), NARROW * gear.m_n, NARROW * gear.m_n / 4
    mesh, body, load = narrow_section(gear, material, state, edge, at, crack.tooth, [crack])
    moved = line_load * body.solve(load)[:, 0]
    return tip_intensity(body, moved, mesh.seams[0].faces)


def tip_intensity(body, moved, faces):
    """Stress intensity by the interaction integral over a ring of triangles around the tip.

    ``K = E' / 2 int (s_ij w_i,1 + t_ij u_i,1 - s_kl e_kl delta_1j) q,j dA``, with u, s the displacement and stress found, w, t, e
    displacement, stress and strain of the unit singular field, axis 1 along the crack, q falling from 1 at half the ring's radius
    to 0. The ring ends before the crack's mouth or bend and before any other boundary. `moved` ``(2 nodes,)`` is the displacement
    of a `Body` [mm], `faces` ``(2, n)`` as in `gearfe.geometry.mesh.section_mesh.Seam`.

    References
    ----------
    J. F. Yau, S. S. Wang, H. T. Corten, J. Appl. Mech. 47 (1980) 335-341; F. Erdogan, G. C. Sih, J. Basic Eng. 85 (1963)
    519-527 (direction).
    """
    mesh = body.mesh
    tip = mesh.doflocs[:, faces[0, -1]]
    ahead = tip - mesh.doflocs[:, faces[0, -3]]
    ahead = ahead / np.hypot(*ahead)
    turn = np.array([ahead, [-ahead[1], ahead[0]]])  # to local axes
    place = turn @ (mesh.doflocs - tip[:, None])
    distance = np.hypot(*place)
    q = np.clip(2 - 2 * distance / _ring_radius(mesh, place, faces), 0, 1)
    used = np.flatnonzero((q[body.nodes] > 0).any(axis=0) & (q[body.nodes] < 1).any(axis=0))
    grads = np.array([body.basis.basis[i][0].grad[:, used] for i in range(6)])  # node, direction, triangle, point
    grads = np.einsum("ab,nbtp->natp", turn, grads)
    shapes = np.array([body.basis.elem.lbasis(body.basis.X, i)[0] for i in range(6)])
    local = turn @ moved.reshape(-1, 2).T
    du = np.einsum("int,njtp->ijtp", local[:, body.nodes[:, used]], grads)
    dq = np.einsum("nt,njtp->jtp", q[body.nodes[:, used]], grads)
    x = np.einsum("int,np->itp", place[:, body.nodes[:, used]], shapes)
    lam, mu = body.material.lame(body.state)
    stress = _stress(du, lam, mu)
    values = []
    for mode in (1, 2):
        aux_stress, aux_slope = _singular(mode, np.hypot(*x), np.arctan2(x[1], x[0]), body)
        energy = np.einsum("ijtp,ijtp->tp", aux_stress, (du + du.transpose(1, 0, 2, 3)) / 2)
        flow = np.einsum("ijtp,itp->jtp", stress, aux_slope) + np.einsum("ijtp,itp->jtp", aux_stress, du[:, 0])
        flow[0] -= energy
        values.append(float(body.material.plane_modulus(body.state) / 2 * ((flow * dq).sum(axis=0) * body.basis.dx[used]).sum()))
    return Intensity(*values, growth_angle(*values))


def _ring_radius(mesh, place, faces):
    """Radius [mm] of the largest ring around the tip within which the crack is straight and there is no other boundary."""
    on_line = np.abs(place[1, faces[0]]) < 1e-6 * np.abs(place[0, faces[0]]).max()
    straight = np.abs(place[0, faces[0][on_line]]).max()
    rim = np.unique(np.concatenate([mesh.facets[:, edges].ravel() for edges in mesh.boundaries.values()]))
    return 0.9 * min(straight, np.hypot(*place[:, rim]).min())


def _stress(gradient, lam, mu):
    """Plane stress tensor of a displacement gradient (2, 2, ...)."""
    mean = lam * (gradient[0, 0] + gradient[1, 1])
    out = mu * (gradient + gradient.transpose(1, 0, 2, 3))
    out[0, 0] += mean
    out[1, 1] += mean
    return out


def _singular(mode, r, t, body):
    """Stress (2, 2, ...) and displacement slope along the crack (2, ...) of the unit singular field (Williams 1957)."""
    nu, mu = body.material.nu, body.material.shear_modulus
    kappa = 3 - 4 * nu if body.state == "plane strain" else (3 - nu) / (1 + nu)
    c, s, c3, s3 = np.cos(t / 2), np.sin(t / 2), np.cos(1.5 * t), np.sin(1.5 * t)
    if mode == 1:
        xx, yy, xy = c * (1 - s * s3), c * (1 + s * s3), c * s * c3
        g = np.array([c * (kappa - np.cos(t)), s * (kappa - np.cos(t))])
        h = np.array([-s / 2 * (kappa - np.cos(t)) + c * np.sin(t), c / 2 * (kappa - np.cos(t)) + s * np.sin(t)])
    else:
        xx, yy, xy = -s * (2 + c * c3), s * c * c3, c * (1 - s * s3)
        g = np.array([s * (kappa + 2 + np.cos(t)), -c * (kappa - 2 + np.cos(t))])
        h = np.array([c / 2 * (kappa + 2 + np.cos(t)) - s * np.sin(t), s / 2 * (kappa - 2 + np.cos(t)) + c * np.sin(t)])
    stress = np.array([[xx, xy], [xy, yy]]) / np.sqrt(2 * np.pi * r)
    return stress, (np.cos(t) * g / 2 - np.sin(t) * h) / (2 * mu * np.sqrt(2 * np.pi * r))


def growth_angle(k_1, k_2):
    """Angle of largest tangential stress [rad]: ``k_1 sin(t) + k_2 (3 cos(t) - 1) = 0``.

    >>> round(math.degrees(growth_angle(0.0001, 1.0)), 1)
    -70.5
    """
    if k_1 <= 0:
        return math.nan
    if k_2 == 0:
        return 0.0
    return 2 * math.atan((k_1 - math.copysign(math.sqrt(k_1**2 + 8 * k_2**2), k_1)) / (4 * k_2))
