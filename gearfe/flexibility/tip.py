"""Stress intensity at a crack tip as a linear function of the displacement: the interaction integral.

With the displacement u and stress s of a body, and stress t and displacement w of the unit singular field::

    K = E' / 2 (int (s_ij w_i,1 + t_ij u_i,1 - t_kl u_k,l delta_1j) q,j dA - int p_i w_i,1 q ds)

Axis 1 runs along the crack. q falls from 1 around the tip to 0, before the crack bends and before any other boundary. The second
integral is over the faces, with their tractions p.

References
----------
J. F. Yau, S. S. Wang, H. T. Corten, J. Appl. Mech. 47 (1980) 335-341; M. L. Williams, J. Appl. Mech. 24 (1957) 109-114.
"""

import numpy as np

from ..geometry.aliases import Floats


def tip_rows(grads: Floats, place: Floats, slope: Floats, area: Floats, material, state: str) -> Floats:
    """First integral for K_I and K_II, as factors ``(2, nodes, 2, triangles)`` of the nodal displacements of triangles.

    Parameters
    ----------
    grads : ndarray, shape (nodes, 2, triangles, points)
        Gradients of the shape functions [1/mm] in the axes of the crack.
    place, slope : ndarray, shape (2, triangles, points)
        Place from the tip [mm] and gradient of q [1/mm] in these axes.
    area : ndarray, shape (triangles, points)
        Area of each point [mm^2].
    material : Material
    state : {"plane strain", "plane stress"}
    """
    lam, mu = material.lame(state)
    out = []
    for mode in (1, 2):
        stress, along = singular(mode, np.hypot(*place), np.arctan2(place[1], place[0]), material, state)
        outer = np.einsum("atp,btp->abtp", along, slope)
        factor = mu * (outer + outer.transpose(1, 0, 2, 3)) - stress * slope[0]
        factor[:, 0] += np.einsum("ajtp,jtp->atp", stress, slope)
        factor[[0, 1], [0, 1]] += lam * (outer[0, 0] + outer[1, 1])
        out.append(np.einsum("abtp,nbtp,tp->nat", factor, grads, area, optimize=True))
    return material.plane_modulus(state) / 2 * np.array(out)


def face_factor(distance: Floats, q: Floats) -> Floats:
    """Return the stress intensity [1/sqrt(mm)] of a unit force on the crack faces at a `distance` [mm] behind the tip.

    It is ``sqrt(2 / (pi r)) q``. In an infinite body the crack has this stress intensity where q is 1.
    """
    return np.sqrt(2 / (np.pi * distance)) * q


def singular(mode, r, t, material, state):
    """Stress (2, 2, ...) and displacement slope along the crack (2, ...) of the unit singular field."""
    nu, mu = material.nu, material.shear_modulus
    kappa = 3 - 4 * nu if state == "plane strain" else (3 - nu) / (1 + nu)
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
