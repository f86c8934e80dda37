"""Gear body as an elastic annulus, held at its bore and loaded by the teeth on its outer circle.

Angles are counted as in `gearfe.geometry.tooth.profile`: clockwise from the centre-line (+y) of tooth 0, ``e_r = (sin, cos)`` and
``e_t = (cos, -sin)``. Loads on the outer circle are Fourier series, and each harmonic is solved in closed form.
"""

import math

import numpy as np
from numpy.polynomial.legendre import leggauss

TURNS = 60.0  # harmonics reach n = TURNS / half angle of the arc; 3 times as many change no flexibility by more than 3e-4
GAUSS = leggauss(128)  # Gauss points that resolve the highest harmonic over the arc


def harmonic_flexibility(orders, ratio, nu, state="plane strain"):
    """Displacement of the outer circle of an annulus with fixed inner circle under harmonic tractions on the outer circle.

    Tractions ``(p cos n t, q sin n t)``, radial and tangential, move the circle by ``(u cos n t, v sin n t)``::

        (u, v) = r / (2 G) H_n (p, q)

    From Kolosov's ``2 G (u + i v) = e**(-it) (kappa phi - z conj(phi') - conj(psi))`` and ``sigma - i tau = phi' + conj(phi')
    - e**(2it) (conj(z) phi'' + psi')`` with the powers of z that give the harmonic n: ``phi = z**(1 + n), z**(1 - n)``,
    ``psi = z**(n - 1), z**(-n - 1)``; for n = 1 the second is ``phi = ln z, psi = -kappa ln z``, the net force.

    `orders` n are whole numbers from 0, `ratio` is the inner over the outer radius; H_n ``(n, 2, 2)`` are symmetric.

    References
    ----------
    J. H. Michell, Proc. London Math. Soc. 31 (1899) 100-124; N. I. Muskhelishvili, Some Basic Problems of the Mathematical
    Theory of Elasticity (1953), sections 32, 39, 59.
    """
    kappa = 3 - 4 * nu if state == "plane strain" else (3 - nu) / (1 + nu)
    n = np.maximum(np.asarray(orders, dtype=float), 1.0)  # Values at n = 0 are replaced below.
    power = np.array([n + 1, 1 - n, n - 1, -n - 1])
    sign = np.array([1.0, -1.0, 1.0, -1.0])[:, None]
    of_phi = np.array([True, True, False, False])[:, None]
    move = np.where(of_phi, [kappa - power, sign * (kappa + power)], [-np.ones_like(power), sign + 0 * power])
    stress = np.where(
        of_phi, [power * (3 - power), sign * power * (power - 1)], [-power, sign * power]
    )  # axes of both arrays: direction, term, harmonic
    # Each term is scaled to 1 at its largest value, so that no power overflows.
    fall = ratio ** np.abs(power)
    outer = np.where(power < 0, fall, 1.0)
    inner = move * np.where(power < 0, 1.0, fall)
    move, stress = move * outer, stress * outer
    first = n == 1
    inner[:, 1, first] = np.array([[2 * kappa * math.log(ratio) - 1], [-2 * kappa * math.log(ratio) - 1]])
    move[:, 1, first] = -1.0
    stress[:, 1, first] = np.array([[3 + kappa], [1 - kappa]])
    system = np.concatenate([inner, stress]).transpose(2, 0, 1)
    unit = np.zeros((4, 2))
    unit[2:] = np.eye(2)
    out = move.transpose(2, 0, 1) @ np.linalg.solve(system, np.broadcast_to(unit, (n.size, 4, 2)))
    pressure = (kappa - 1) * (1 - ratio**2) / (2 + (kappa - 1) * ratio**2)
    out[np.asarray(orders) == 0] = np.diag([pressure, 1 / ratio**2 - 1])
    return out


def arc_tractions(r, half_angle):
    """Return the tractions of unit section forces of a tooth on its root arc, ``+-half_angle`` of the circle.

    They are the stresses of a rectangular beam section of half width ``h = r sin(half_angle)``, projected along the tooth onto
    the arc: parabolic shear ``3 (1 - x**2 / h**2) / (4 h)`` along x, uniform ``1 / (2 h)`` and linear ``3 x / (2 h**3)`` along
    y.

    Returns
    -------
    angle : ndarray, shape (m,)
        Gauss points on the arc [rad].
    force : ndarray, shape (3, 2, m)
        For unit shear force V along x [N/mm], normal force N along y [N/mm] and moment M [N mm/mm]: force along x and y
        at the points. V acts at the height of `shear_height`.
    """
    s, weights = GAUSS
    h = r * math.sin(half_angle)
    none = np.zeros_like(s)
    force = [[0.75 * (1 - s**2), none], [none, 0.5 + none], [none, 1.5 * s / h]]
    return np.arcsin(s * h / r), np.array(force) * weights


def shear_height(r, half_angle):
    """Height over the centre [mm] at which the parabolic shear of `arc_tractions` acts."""
    angle, force = arc_tractions(r, half_angle)
    return float(r * np.cos(angle) @ force[0, 0])


def root_flexibility(r_bore, r, half_angle, apart, material, *, state="plane strain", turns=TURNS):
    """Return the flexibility of an annulus between the section forces of teeth on its outer circle.

    ``C[k]`` gives the displacements conjugate to (V, N, M) of a tooth (their means weighted by the same tractions, see
    `arc_tractions`) per unit (V, N, M) on a tooth at the angle ``apart[k]`` before it, each in the axes of its tooth. The
    energy of two teeth with forces f and g is thus ``f C[0] f / 2 + g C[0] g / 2 + g C[k] f``. It replaces
    Sainsot's polynomial fit by the Fourier series to which that was fitted. The shear displacement is work-conjugate, and
    adjacent teeth are included.

    Parameters
    ----------
    r_bore, r : float
        Radius of the held bore, and outer radius [mm].
    half_angle : float
        Half angle of the arc a tooth stands on [rad].
    apart : sequence of float
        Angles between tooth and tooth, clockwise [rad]; 0 for a tooth and itself.
    turns : float
        Harmonics reach ``turns / half_angle``.

    Returns
    -------
    ndarray, shape (len(apart), 3, 3)
        [mm per N/mm], [1 per N/mm] with one M, [1/mm per N/mm] with two.
    """
    orders = np.arange(math.ceil(turns / half_angle) + 1)
    angle, (shear, normal, moment) = arc_tractions(r, half_angle)
    sin, cos = np.sin(angle), np.cos(angle)
    radial = np.array([sin * f[0] + cos * f[1] for f in (shear, normal, moment)])
    around = np.array([cos * f[0] - sin * f[1] for f in (shear, normal, moment)])
    wave = np.exp(-1j * orders[:, None] * angle)
    # With q = i q', the sine harmonics of q are coupled to the cosine harmonics of p: one real matrix serves both parities.
    series = np.stack([wave @ radial.T, 1j * (wave @ around.T)], axis=1)
    series[0] /= math.sqrt(2)  # The harmonic n = 0 has no counterpart at -n.
    by_order = series.conj().mT @ harmonic_flexibility(orders, r_bore / r, material.nu, state) @ series
    shift = np.exp(1j * np.outer(np.asarray(apart, dtype=float), orders))
    return np.einsum("kn,nab->kab", shift, by_order).real / (2 * math.pi * material.shear_modulus)
