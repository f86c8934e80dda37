"""Potential energy method (PEM): cantilever of the true profile, Sainsot's fillet foundation, tooth pairs in parallel."""

import numpy as np

from ....geometry.tooth.profile import flank, root_half_angle
from .beam import FOUNDATIONS, Components, body_ratio, load_angle, sainsot, sainsot_outside
from .integrals import HEALTHY, beam_parts


def components(gear, material, roll, *, damage=HEALTHY, root="fillet", foundation="sainsot", lever="crossing", theta_f=None):
    """Return the flexibility of one tooth by beam theory over its real profile, from the root circle to the load.

    With force F at (x_F, y_F), turned by beta from the normal of the centre-line (y along it), and the half thickness
    x(y) of fillet and involute::

        bending = int (cos(beta) (y_F - y) - x_F sin(beta))**2 / (E I) dy,   I = 2 x**3 / 3
        shear   = int 1.2 cos(beta)**2 / (G A) dy,                           A = 2 x
        axial   = int sin(beta)**2 / (E A) dy
        foundation = cos(beta)**2 / E (L* (u/S)**2 + M* u/S + P* (1 + Q* tan(beta)**2))

    With damage, I and A are those of the sections it leaves (`energy.closed.section`); axial compression and foundation
    neglect cracks. For a ring, y is measured towards its centre, and there is no Sainsot foundation.

    Parameters
    ----------
    gear : Gear
    material : Material
    roll : ndarray
        Roll lengths of the contact [mm].
    damage : ToothDamage
        Of this tooth. Pits also shorten the contact: see `gearfe.flexibility.energy.closed.plain_sum`.
    root : {"fillet", "base", "line", "prism"}
        Where the beam begins: on the root circle over the true fillet; or where the involute, extended downwards, meets the
        larger of base and root circle, ``base`` with nothing below it, ``line`` with a straight radial flank and ``prism``
        with constant thickness down to the root circle.
    foundation : {"sainsot", "external", "printed", "none"}
        ``external``: Sainsot's of external gears, none of a ring. ``printed``: of a ring too, with ``h = 1``, as article S4 has
        it (see `herringbone_article`), though it is a fit to discs held at their bore.
    lever : {"crossing", "contact"}
        u: height over the root circle of the point where the load line crosses the centre-line (Sainsot), or of the
        contact point itself (as some codes have it).
    theta_f : float, optional
        Root half angle [rad] in S = 2 r_f theta_f; default: where the fillet touches the root circle.

    Returns
    -------
    Components

    References
    ----------
    X. Liang, M. J. Zuo, M. Pandey, Mech. Mach. Theory 76 (2014) 20-38, eqs. 9-14; H. Ma et al., Eng. Fail. Anal. 44
    (2014) 179-194 (from the root circle over the true fillet); X. Liang, H. Zhang, L. Liu, M. J. Zuo, Mech. Mach. Theory
    106 (2016) 1-15 (pits as lost section and lost contact); Sainsot et al. 2004, eq. 8, its bracket as here.
    """
    if foundation not in FOUNDATIONS:
        raise ValueError(f"foundation = {foundation!r}, but it must be one of {', '.join(FOUNDATIONS)}")
    if lever not in ("crossing", "contact"):
        raise ValueError(f"lever = {lever!r}, but it must be 'crossing' or 'contact'")
    roll = np.atleast_1d(np.asarray(roll, dtype=float))
    parts = beam_parts(gear, material, roll, root, damage)
    return Components(*parts, *body(gear, material, roll, foundation=foundation, lever=lever, theta_f=theta_f))


def body(gear, material, roll, *, foundation="sainsot", lever="crossing", theta_f=None):
    """Return the foundation flexibility ``(n,)`` [mm per N/mm] of `components`, and the violated ranges of validity."""
    if foundation == "none" or (foundation == "external" and gear.internal):
        return np.zeros(np.shape(roll)), ()
    beta = load_angle(gear, roll)
    radius, angle = flank(gear, roll)
    x_f, y_f = radius * np.sin(angle), gear.outward * radius * np.cos(angle)
    theta = root_half_angle(gear) if theta_f is None else theta_f
    h = body_ratio(gear, foundation)
    outside = sainsot_outside(gear, h, theta)
    height = y_f - gear.outward * gear.r_f - (x_f * np.tan(beta) if lever == "crossing" else 0.0)
    ratio = height / (2 * gear.r_f * theta)
    l, m, p, q = sainsot(h, theta)  # noqa: E741 the source's letters
    return np.cos(beta) ** 2 / material.E * (l * ratio**2 + m * ratio + p * (1 + q * np.tan(beta) ** 2)), outside
