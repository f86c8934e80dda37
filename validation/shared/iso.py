"""ISO 6336-1 tooth stiffness, for comparison."""

import math

Q_SERIES = (0.04723, 0.15551, 0.25791, -0.00635, -0.11654, -0.00193, -0.24188, 0.00529, 0.00182)


def virtual_teeth(gear):
    """Return the number of teeth of the virtual spur gear, ``z / (cos(beta_b)**2 cos(beta))`` (ISO 21771:2007, 4.4)."""
    return gear.z / (math.cos(gear.beta_b) ** 2 * math.cos(gear.beta))


def theoretical_stiffness(pair):
    """Theoretical single stiffness c'_th [N/(mm um)] = ``1 / q'`` of solid disc gears, external pairs.

    ``q' = C1 + C2/z_n1 + C3/z_n2 + C4 x1 + C5 x1/z_n1 + C6 x2 + C7 x2/z_n2 + C8 x1**2 + C9 x2**2``.

    References
    ----------
    ISO 6336-1:2019, 9.3.2.
    """
    z1, z2 = virtual_teeth(pair.gear_1), virtual_teeth(pair.gear_2)
    x1, x2 = pair.gear_1.x, pair.gear_2.x
    terms = (1.0, 1 / z1, 1 / z2, x1, x1 / z1, x2, x2 / z2, x1**2, x2**2)
    return 1 / sum(c * t for c, t in zip(Q_SERIES, terms, strict=True))
