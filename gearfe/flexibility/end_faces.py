"""What free end faces add to the half-space under a loaded flank: every load once more, in the mirror of each end face.

A half-space goes on beyond the end faces of a gear and holds what is pressed near them. The mirror image of each load beyond a
face takes that hold away but for what the stress along the width, nu times the others in plane strain, still carries there. How
far is exact for a line load on the face itself, which is in plane stress: see `edge_factor`. (That mirrored loads free a face of
shear is Hetenyi's way into the quarter-space, J. Appl. Mech. 37, 1970; a factor on them for the rest is Guilbault's, J. Tribol.
133, 2011, whose own holds for single forces.)
"""

import numpy as np
from numpy.polynomial import legendre

from .halfspace import between, graded, hat_distance, modes

POINTS = 12  # Gauss points at least in each part of the distance to the mirror


def edge_factor(material):
    """Weight psi of the mirrored loads, ``2 / (1 - nu**2) - 1``.

    A line load up to the end face has there half the half-space's logarithm from itself and psi times as much from its mirror
    image; together they are that of plane stress, ``1 / (1 - nu**2)`` times that of plane strain. Without Poisson's ratio psi is
    1 and the mirror exact: such a line strains no section along the width.
    """
    return 2 / (1 - material.nu**2) - 1


def mirrored_patches(knots, width, degree, stretch=1.0):
    """Mean of ``1 / R`` between patches and the images of patches in both end faces.

    The image of a load on a contact line is on that line's continuation, ``stretch (z + z')`` away; across the lines the patches
    are so wide against the slope of helical lines that it is left out.

    The arguments are as of `halfspace.patch_kernel`, and so is what is returned.
    """
    q, weight = between(np.append(graded(knots, width), [1.5 * width, 2 * width]), max(POINTS, degree + 4))  # q = z + z'
    gauss, inner = legendre.leggauss(degree + 1)
    low, high = np.maximum(q - width, 0.0), np.minimum(q, width)
    z = low[:, None] + (high - low)[:, None] * (1 + gauss) / 2
    ahead = modes(z, width, degree) * ((high - low)[:, None] / 2 * inner * weight[:, None])[..., None]
    overlap = ahead.transpose(0, 2, 1) @ modes(q[:, None] - z, width, degree)
    n = knots.shape[1]
    distance = hat_distance(knots, np.zeros((n, n, q.size)), stretch * q).reshape(n * n, q.size)
    first = (distance @ overlap.reshape(q.size, -1)).reshape(n, n, degree + 1, degree + 1)
    sign = (-1.0) ** np.arange(degree + 1)
    return (first * (1 + np.outer(sign, sign))).transpose(0, 2, 1, 3)  # the other face: the same with z turned round
