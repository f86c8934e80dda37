"""The textbook: a cantilever of the true profile, Sainsot's foundation, plain sum of tooth pairs."""

import numpy as np

from geometry.tooth import cartesian, flank, root_half_angle

from .beam import Components, along_fillet, along_flank, load_angle, sainsot


def components(gear, material, roll, *, lever="crossing", theta_f=None):
    """Flexibility of one tooth by beam theory over its real profile, from the root circle to the load.

    With force F at (x_F, y_F), turned by beta from the normal of the centre-line (y along it), and the half thickness
    x(y) of fillet and involute::

        bending = int (cos(beta) (y_F - y) - x_F sin(beta))**2 / (E I) dy,   I = 2 x**3 / 3
        shear   = int 1.2 cos(beta)**2 / (G A) dy,                           A = 2 x
        axial   = int sin(beta)**2 / (E A) dy
        foundation = cos(beta)**2 / E (L* (u/S)**2 + M* u/S + P* (1 + Q* tan(beta)**2))

    Parameters
    ----------
    gear : Gear
    material : Material
    roll : ndarray
        Roll lengths of the contact [mm].
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
    (2014) 179-194 (from the root circle over the true fillet); Sainsot et al. 2004, eq. 8, its bracket as here.
    """
    if lever not in ("crossing", "contact"):
        raise ValueError(f"lever = {lever!r}, but it must be 'crossing' or 'contact'")
    roll = np.atleast_1d(np.asarray(roll, dtype=float))
    beta = load_angle(gear, roll)
    cos, sin = np.cos(beta), np.sin(beta)
    x_f, y_f = cartesian(*flank(gear, roll))
    (i0, i1, i2), area = _moments(gear, roll)
    arm = cos * y_f - sin * x_f
    bending = (arm**2 * i0 - 2 * arm * cos * i1 + cos**2 * i2) / material.E
    shear = 1.2 * cos**2 * area / material.shear_modulus
    axial = sin**2 * area / material.E
    theta = root_half_angle(gear) if theta_f is None else theta_f
    height = y_f - gear.r_f - (x_f * np.tan(beta) if lever == "crossing" else 0.0)
    ratio = height / (2 * gear.r_f * theta)
    l, m, p, q = sainsot(gear.r_f / gear.r_bore, theta)  # noqa: E741 the source's letters
    foundation = cos**2 / material.E * (l * ratio**2 + m * ratio + p * (1 + q * np.tan(beta) ** 2))
    return Components(bending, shear, axial, foundation)


def _moments(gear, roll):
    """Integrals of y**k / I (k = 0, 1, 2) and of 1 / A from the root circle to the load, unit width."""
    pieces = along_fillet(gear), along_flank(gear, roll)
    inertia = [(p.step * p.y**k * 1.5 / p.x**3).sum(axis=-1) for p in pieces for k in range(3)]
    area = sum((p.step / (2 * p.x)).sum(axis=-1) for p in pieces)
    return [inertia[k] + inertia[3 + k] for k in range(3)], area
