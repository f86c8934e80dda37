"""Local contact of two flanks: half-plane logarithm, line contact, and the linear approximations of the textbook."""

import math

import numpy as np

FAR = 30.0  # Hat functions at larger distances, in their lengths, act like forces at their centroids.


def half_plane(material, state="plane strain"):
    """Coefficient c [mm per N/mm] of the half-plane: a line load P moves the surface by ``-c P ln r`` (Flamant).

    ``c = 2 (1 - nu**2) / (pi E)`` in plane strain (K. L. Johnson, Contact Mechanics, 1985, eq. 2.19).
    """
    return 2 / (math.pi * material.plane_modulus(state))


def contact_modulus(materials, state="plane strain"):
    """Contact modulus E* [MPa] of two materials, ``1 / E* = sum (1 - nu**2) / E``."""
    return 1 / sum(1 / m.plane_modulus(state) for m in materials)


def half_width(line_load, radius, modulus):
    """Half width a [mm] of a line contact, ``a**2 = 4 P R / (pi E*)`` (Johnson 1985, eq. 4.43)."""
    return np.sqrt(4 * line_load * radius / (math.pi * modulus))


def peak_pressure(line_load, radius, modulus):
    """Largest contact pressure [MPa], ``p0 = 2 P / (pi a)`` (Johnson 1985, eq. 4.45)."""
    return np.sqrt(line_load * modulus / (math.pi * radius))


def log_kernel(distance):
    """Fourth antiderivative of ``ln |x|``: ``x**4 / 24 (ln |x| - 25/12)``, zero at 0."""
    x = np.abs(np.asarray(distance, dtype=float))
    safe = np.where(x > 0, x, 1.0)
    square = x * x
    return square * square / 24 * (np.log(safe) - 25 / 12)


def hat_logarithm(knots_1, knots_2):
    """Mean of ``-ln |x - y|`` over hat functions of unit area: the flat-surface kernel between hat function pressures.

    A hat function of unit area on knots (s0, s1, s2) has as second derivative three point masses, so the double integral is
    nine values of `log_kernel`; exact for hat functions of unequal sides. A one-sided hat function (s1 = s2 or s0 = s1) is
    given a fall over a thousandth of its rise, or the other way round.

    Parameters
    ----------
    knots_1, knots_2 : ndarray, shape (3, n) and (3, m)
        Start, top and end of the hat functions along the arc [mm].

    Returns
    -------
    ndarray, shape (n, m)
    """
    (places_1, masses_1), (places_2, masses_2) = _masses(knots_1), _masses(knots_2)
    kernel = log_kernel(places_1[:, :, None, None] - places_2)
    out = -np.einsum("pn,pnqm,qm->nm", masses_1, kernel, masses_2)
    wide = np.maximum(*np.meshgrid(np.ptp(knots_1, axis=0), np.ptp(knots_2, axis=0), indexing="ij"))
    apart = knots_1.mean(axis=0)[:, None] - knots_2.mean(axis=0)
    far = np.abs(apart) > FAR * wide
    square = apart[far] ** 2  # A series about the centroid distance avoids cancellation of nine values.
    spread = (_variance(knots_1)[:, None] + _variance(knots_2))[far]
    out[far] = spread / (2 * square) - np.log(square) / 2
    return out


def _variance(knots):
    """Variance [mm^2] of the position under hat functions of unit area."""
    start, top, stop = knots
    return (start**2 + top**2 + stop**2 - start * top - start * stop - top * stop) / 18


def _masses(knots):
    """Positions and weights ``(3, n)`` of the three point masses in the second derivative of hat functions."""
    start, top, stop = knots
    start, stop = np.minimum(start, top - 1e-3 * (stop - top)), np.maximum(stop, top + 1e-3 * (top - start))
    left, right = top - start, stop - top
    height = 2 / (left + right)
    return np.array([start, top, stop]), np.array([height / left, -height / left - height / right, height / right])


def linear_hertz(materials):
    """Linear contact flexibility [mm per N/mm] of the textbook: stiffness ``pi E L / 4 (1 - nu**2)`` for equal materials.

    Yang and Sun, J. Mech. Transm. Autom. Des. 107 (1985) 529-535; for two materials the compliances are averaged.
    """
    return 2 / (math.pi * contact_modulus(materials))


def weber_line(line_load, materials, radius, depth):
    """Contact flexibilities of two teeth under a line load, secant and tangent [mm per N/mm].

    Approach of the two tooth centre-lines, per body ``2 (1 - nu**2) P / (pi E) (ln(2 h / a) - nu / (2 (1 - nu)))``, with a the
    half width of the contact (`half_width`). The formula is for plane strain and requires h well above a.

    `line_load` is in N/mm of touching length, `radius` the relative radius of curvature [mm], `depth` the distance h from flank
    to tooth centre-line along the load line, of both bodies [mm].

    References
    ----------
    C. Weber, K. Banaschek, Formaenderung und Profilruecknahme bei gerad- und schraegverzahnten Raedern, Schriftenreihe
    Antriebstechnik 11, Vieweg, 1953.
    """
    width = half_width(line_load, radius, contact_modulus(materials))
    secant, tangent = 0.0, 0.0
    for material, h in zip(materials, depth, strict=True):
        coefficient = half_plane(material)
        secant = secant + coefficient * (np.log(2 * h / width) - material.nu / (2 * (1 - material.nu)))
        tangent = tangent - coefficient / 2
    return secant, secant + tangent


def palmgren_line(line_load, materials, length):
    """Contact flexibilities of two bodies in line contact, secant and tangent [mm per N/mm], after Palmgren and Lundberg.

    ``delta = 3.81 (sum (1 - nu**2) / (pi E))**0.9 F**0.9 / L**0.8``, for steel ``3.84e-5 F**0.9 / L**0.8`` (mm, N): fitted to
    rollers, and independent of their radius. `line_load` is in N/mm of the touching `length` [mm].

    References
    ----------
    A. Palmgren, Grundlagen der Waelzlagertechnik, 3rd ed., Franckh, 1964; T. A. Harris, Rolling Bearing Analysis, 3rd ed.,
    Wiley, 1991, ch. 6 (the steel form).
    """
    secant = 3.81 * (1 / (math.pi * contact_modulus(materials))) ** 0.9 * (length / line_load) ** 0.1
    return secant, 0.9 * secant
