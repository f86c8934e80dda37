"""Correction of the half-space for free end faces: each load has a mirror image beyond each end face.

A half-space continues beyond the end faces of a gear and supports the loads near them. The mirror image of each load removes this
support, except for that of the stress along the width, nu times the others in plane strain. The remaining part is exact for a
line load on the face itself, which is in plane stress: see `edge_factor`. (Mirrored loads that free a face of shear are Hetenyi's
method for the quarter-space, J. Appl. Mech. 37, 1970. Guilbault, J. Tribol. 133, 2011, uses a factor on them for the rest; his
factor is for single forces.)
"""

import numpy as np

from .halfspace import between, graded, over_width

POINTS = 12  # least number of Gauss points in each part of the distance to the mirror image


def edge_factor(material):
    """Weight psi of the mirrored loads, ``2 / (1 - nu**2) - 1``.

    At the end face, a line load that reaches it has half of the half-space logarithm itself and psi times as much from its
    mirror image. Together they are that of plane stress, ``1 / (1 - nu**2)`` times that of plane strain. For a Poisson's ratio
    of 0, psi is 1 and the mirror image is exact, because a line load then causes no strain along the width.
    """
    return 2 / (1 - material.nu**2) - 1


def mirrored_patches(knots, width, degree, stretch=1.0):
    """Return the mean of ``1 / R`` between patches and the images of patches in both end faces.

    The image of a load on a contact line is on that line's continuation, ``stretch (z + z')`` away. The slope of helical lines
    across the patches is neglected, since the patches are wide. Parameters and return value are those of
    `halfspace.patch_kernel`.
    """
    q, weight = between(np.append(graded(knots, width), [1.5 * width, 2 * width]), max(POINTS, degree + 4))  # q = z + z'
    span = np.maximum(q - width, 0.0), np.minimum(q, width)
    first = over_width(knots, (0.0, stretch * q, weight), span, lambda z: (z, q[:, None] - z), width, degree)
    sign = (-1.0) ** np.arange(degree + 1)
    return (first * (1 + np.outer(sign, sign))).transpose(0, 2, 1, 3)  # The other face has the same terms with reversed z.
