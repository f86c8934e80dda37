"""Half-plane under a line load (Flamant): the exactly known singular part of a loaded flank."""

import math

import numpy as np


def displacement(points, place, inward, tip_side, modulus, ratio):
    """Displacement ``(2, loads, n)`` [mm per N/mm] at `points` of half-planes loaded at `place` along `inward`.

    The field is normalised so that the surface moves by ``-c ln r`` along the load, ``c = 2 / (pi E')``. The rotation about the
    load has its jump half-way between the outward normal and the surface on `tip_side`, where there is no material.

    `place`, `inward` and `tip_side` ``(2, loads)`` are load points [mm], unit load directions and unit tangents towards the tip,
    `modulus` and `ratio` E' [MPa] and nu' of plane stress; in plane strain E / (1 - nu**2), nu / (1 - nu).

    References
    ----------
    S. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed. (1970), section 36.
    """
    along, across, radius = _local(points, place, inward, tip_side)
    angle = np.arctan2(across, along)
    angle = np.where(angle > 0.75 * math.pi, angle - 2 * math.pi, angle)
    log = np.log(radius)
    cos, sin = along / radius, across / radius
    minus = (1 - ratio) / 2
    radial = -2 * cos * log - 2 * minus * angle * sin + (1 + ratio) * cos
    turning = 2 * sin * (log + ratio) - 2 * minus * (angle * cos - sin) - (1 + ratio) * sin
    first, second = radial * cos - turning * sin, radial * sin + turning * cos
    scale = 1 / (math.pi * modulus)
    return scale * (inward[:, :, None] * first + tip_side[:, :, None] * second)


def traction(points, normal, place, inward, tip_side):
    """Return the traction ``(2, loads, n)`` [MPa per N/mm] of the field of `displacement` on surfaces with outward `normal`."""
    along, across, radius = _local(points, place, inward, tip_side)
    away = (inward[:, :, None] * along + tip_side[:, :, None] * across) / radius
    stress = -2 / math.pi * along / radius**2
    return stress * np.einsum("dln,dn->ln", away, normal) * away


def _local(points, place, inward, tip_side):
    offset = points[:, None, :] - place[:, :, None]
    along = np.einsum("dln,dl->ln", offset, inward)
    across = np.einsum("dln,dl->ln", offset, tip_side)
    return along, across, np.hypot(along, across)
