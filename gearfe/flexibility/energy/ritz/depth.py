"""Polynomial degree along the width at each place of the section. The degree decreases with depth below loaded flanks.

The variation along the width of a surface load decays like ``exp(-k pi d / b)`` at depth d, with k half waves in the width b.
Polynomials of low degree suffice in the body. High degrees are needed next to the contact.
"""

import math

import numpy as np

from ....geometry.mesh.triangle import table
from ....geometry.tooth.profile import cartesian, flank

LOST = 2  # number of highest axial modes that are discarded as inaccurate
LEAST, DECAY = 5, 2.0  # degree of non-decaying parts; half waves that decay by less than exp(-`DECAY`) are kept
SAMPLES = 60  # number of points of the loaded flank from which distances are measured
SAME = 1e-6  # Distances with a smaller difference share one degree [m_n].


def axial_degree(width, m_n):
    """Return the axial degree for a `width` [mm] that suits cubic triangles: 2 and 0.8 per normal module [mm], at least 8."""
    return max(8, math.ceil(0.8 * width / m_n) + LOST)


def degrees(gear, sector, numbers, sides, degree, order):
    """Return the degree along the width of every node ``(n,)``, an even number of at most `degree`.

    The degree of a node depends on its position in the section. Both sides of a sector have the same degrees, also with damage.
    `numbers` ``(k, m)`` are all nodes of the triangles. `sides` are those of both sides, left ones first. `order` is the
    polynomial order in the section.
    """
    width = gear.b
    place = np.einsum("cn,dcm->dnm", table(order).nodes, sector.points[:, sector.triangles])
    away = np.zeros(int(numbers.max()) + 1)
    away[numbers.ravel()] = _distance(gear, place.reshape(2, -1))
    nearer = away[sides].reshape(2, -1).min(axis=0)
    away[sides] = np.tile(np.round(nearer / (SAME * gear.m_n)) * SAME * gear.m_n, 2)
    turned = abs(gear.twist_rate) * width / 2  # Rigid motions are not constant along a twisted gear.
    wanted = LEAST + turned + DECAY * width / (math.pi * np.maximum(away, 1e-9 * width))
    return np.minimum(2 * np.ceil(np.minimum(wanted, degree) / 2).astype(int), degree)


def _distance(gear, points):
    """Return the distance of points ``(2, n)`` to the nearest loaded flank of their tooth and the adjacent teeth [mm]."""
    radius, angle = flank(gear, np.linspace(gear.roll_f, gear.roll_a, SAMPLES))
    teeth = np.array([-1, 0, 1])[:, None] * 2 * math.pi / gear.z
    line = cartesian(np.tile(radius, 3), (angle + teeth).ravel())
    return np.hypot(*(points[:, :, None] - line[:, None, :])).min(axis=1)
