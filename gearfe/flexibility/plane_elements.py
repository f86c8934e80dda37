"""Stiffness of plane triangles of any shape functions, computed for all triangles at once.

The weak form is ``lambda div u div v + 2 mu eps(u) : eps(v)``. On a straight triangle the map is linear, so its matrix is a sum
of the same four reference matrices ``int d_e N_i d_f N_j``; only bent ones are integrated one by one.
"""

import numpy as np


def stiffness(slope, weight, arms, lam, mu):
    """Stiffness matrices of triangles with straight edges ``(m, 2 n, 2 n)``, ordered ux, uy node by node.

    Parameters
    ----------
    slope : ndarray, shape (2, n, q)
        Derivatives of the n shape functions by the reference coordinates at q points.
    weight : ndarray, shape (q,)
        Quadrature weights of these points.
    arms : ndarray, shape (m, 2, 2)
        Derivatives of the coordinates x, y (rows) by the reference coordinates (columns) [mm].
    lam, mu : float
        Lame's constants of the plane problem [MPa].
    """
    (xx, xy), (yx, yy) = arms.transpose(1, 2, 0)
    area = xx * yy - xy * yx
    back = np.array([[yy, -xy], [-yx, xx]]) / area  # derivatives of the reference coordinates by x and y
    outer = np.einsum("eam,fbm->mabef", back, back)
    factor = lam * outer + mu * outer.transpose(0, 2, 1, 3, 4)
    alike = mu * np.einsum("mccef->mef", outer)
    factor[:, 0, 0] += alike
    factor[:, 1, 1] += alike
    factor *= np.abs(area)[:, None, None, None, None]  # for either orientation of the corners
    n, m = slope.shape[1], area.size
    reference = ((slope * weight).reshape(2 * n, -1) @ slope.reshape(2 * n, -1).T).reshape(2, n, 2, n).swapaxes(1, 2)
    spread = np.zeros(
        (2, 2, 2, 2, n, 2, n, 2)
    )  # The axes have their final order, because transposing the sum would take ten times as long.
    for a, b in np.ndindex(2, 2):
        spread[a, b, :, :, :, a, :, b] = reference
    return (factor.reshape(m, 16) @ spread.reshape(16, -1)).reshape(m, 2 * n, 2 * n)


def bent_stiffness(slope, weight, jacobian, lam, mu):
    """Return the stiffness of triangles whose maps have derivatives `jacobian` ``(m, 2, 2, q)`` at the points."""
    (xx, xy), (yx, yy) = jacobian.transpose(1, 2, 0, 3)
    area = xx * yy - xy * yx
    n, m = slope.shape[1], area.shape[0]
    gradient = np.empty((m, n, 2, area.shape[1]))
    first, second = slope
    gradient[:, :, 0] = (yy / area)[:, None] * first - (yx / area)[:, None] * second
    gradient[:, :, 1] = (xx / area)[:, None] * second - (xy / area)[:, None] * first
    rows = gradient.reshape(m, 2 * n, -1)
    product = ((rows * (np.abs(area) * weight)[:, None]) @ rows.mT).reshape(m, n, 2, n, 2)
    local = lam * product + mu * product.transpose(0, 1, 4, 3, 2)
    alike = mu * (product[:, :, 0, :, 0] + product[:, :, 1, :, 1])
    local[:, :, 0, :, 0] += alike
    local[:, :, 1, :, 1] += alike
    return local.reshape(m, 2 * n, 2 * n)
