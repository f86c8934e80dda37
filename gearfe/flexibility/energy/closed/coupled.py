"""Coupled closed form: potential energy method with known corrections. The common body couples the teeth.

The deflection of a tooth of an external, undamaged gear (transverse section) has three parts:

1. a beam of varying section from the 30-degree tangents of the fillet to the load, with the shear stress in equilibrium
   with a taper (`shear_parts`);
2. the gear body, an annulus between bore and root circle under the section forces of all teeth
   (`gearfe.flexibility.energy.closed.annulus`), which couples the teeth;
3. the local deflection under Hertzian pressure down to the tooth's centre-line (`local_remainder`).

The body ends at the root circle. The root arc of a tooth lies between the ends of its fillets (as for Sainsot's theta_f). The
material between that arc and the 30-degree section is taken as rigid. This convention matters and was chosen by comparison with
finite elements. On the narrower arc between the radii through the ends of the 30-degree section, the stiffness of 19/48, 25/30,
18/27 and 21/31 teeth is 9 to 12 % too low, instead of -1.7 to +0.3 %. The good agreement is therefore partly a cancellation of
approximations. The other gears below are the better test.

Range of validity: errors of k relative to `finite_elements.fe` without contact off the path of contact, in the zones of single
and double contact. The error of 21/31 teeth changes by 0.2 % between 30 and 500 N/mm.

- the rack 1.0/1.25/0.38 at 20 degrees, x = 0, solid bodies: +0.1, +1.6 % at 18/18, -1.4, +0.3 % at 25/25, -2.5, -0.6 % at
  35/35, -3.3, -1.3 % at 50/50, -4.2, -2.0 % at 100/100: below 3 % up to about 40 teeth;
- teeth with wide roots are too compliant, because they are hardly beams: 30/30 with alpha = 25 degrees -6.0, -3.3 %, with x =
0.5 -5.7,
  -3.1 %, with a tip radius of 0.2 -4.2, -2.3 %. Of 80 random pairs (z 12 to 119, alpha 17.5 to 25 degrees, x -0.4 to 0.6, tip
  radius 0.2 to 0.38, bore 0.25 to 0.75 r_f) the median is -5.1, -3.0 %, the range -8.8 to +0.4 and -5.7 to +1.3 %;
- thin rims: the coupling between teeth is 11 to 27 % too small at r_bore / r_f = 0.9 (up to 3 % at 0.5). There it is a small
  part of the whole: k in the double zone is +3.6 % off at 18/18 and 0.85 to 0.9, +2.1 % at 25/25 and -1.7 % at 80/80 (0.9);
- no rings, cracks, or contact at tip corners.
"""

import math
from dataclasses import replace
from functools import partial

import numpy as np

from ....geometry.cubic import Bicubic, Cubic, through
from ....geometry.tooth.profile import arc_at, cartesian, flank, roll_at_arc, root_half_angle, tangent_point
from ...hertz import half_plane
from ...plane import Flexibility
from ...solved import solved_gears
from .annulus import root_flexibility, shear_height
from .beam import Components, along_fillet, along_flank, load_angle

NODES = 48  # number of spline nodes along the flank, equidistant in roll length


def section_loads(gear, roll, height):
    """Return shear force, normal force and moment of a tooth at a `height` above the gear's centre, per unit load on its flank.

    With the load at (x_F, y_F) turned by beta from the normal of the centre-line (`load_angle`)::

        V = -cos(beta),   N = -sin(beta),   M = cos(beta) (y_F - y) - sin(beta) x_F

    V along x, N along y (tension is positive), M = integral of x sigma_y: ``(3, n)`` of V, N [-] and M [mm], for roll lengths
    ``(n,)`` and heights [mm] that are broadcast against them.
    """
    beta = load_angle(gear, roll)
    x_f, y_f = cartesian(*flank(gear, roll))
    moment = np.cos(beta) * (y_f - height) - np.sin(beta) * x_f
    return np.array([np.broadcast_to(v, moment.shape) for v in (-np.cos(beta), -np.sin(beta), moment)])


def shear_parts(half, slope, shear, normal, moment):
    """Return A, B, C of the shear stress ``A (h**2 - x**2) + B + C x`` across a beam of half thickness h.

    The faces have the slope h'.

    With ``sigma = M x / I + N / (2 h)``, equilibrium along the beam, ``d sigma / dy + d tau / dx = 0``, and faces free of load,
    ``tau = +-h' sigma`` at ``x = +-h``, leave::

        tau = (M / I)' (h**2 - x**2) / 2 + (M h / I) h' + N h' x / (2 h**2),    I = 2 h**3 / 3,   M' = V

    Its integral is V; for h' = 0 it is the parabola. It agrees with the exact wedge to the square of the wedge's angle. Unit
    width; V, N [N/mm] and M [N mm/mm] as in `section_loads`.

    References
    ----------
    S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed. (1970), section 38 (the wedge).
    """
    inertia = 2 * half**3 / 3
    return (shear - 3 * moment * slope / half) / inertia / 2, moment * half / inertia * slope, normal * slope / (2 * half**2)


def shear_square(half, slope, shear, normal, moment):
    """Integral of ``tau**2`` over the section of unit width. The arguments are those of `shear_parts`."""
    a, b, c = shear_parts(half, slope, shear, normal, moment)
    return 16 / 15 * a**2 * half**5 + 8 / 3 * a * b * half**3 + 2 * b**2 * half + 2 / 3 * c**2 * half**3


def beam(gear, material, roll, *, state="plane strain"):
    """Bending, shear and axial flexibility ``(3, n)`` [mm per N/mm] of the tooth from its 30-degree section to loads at `roll`.

    With the section forces of `section_loads`, the stress of `shear_parts` and ``E' = E / (1 - nu**2)`` in plane strain::

        bending = int M**2 / (E' I) dy,   axial = int N**2 / (E' 2 h) dy,   shear = int int tau**2 / G dx dy
    """
    roll = np.atleast_1d(np.asarray(roll, dtype=float))
    out = np.zeros((3, roll.size))
    for part in (along_fillet(gear, tangent_point(gear)), along_flank(gear, roll)):
        shear, normal, moment = section_loads(gear, roll[:, None], part.y)
        square = shear_square(part.x, part.slope, shear, normal, moment)
        out[0] += (part.step * moment**2 * 1.5 / part.x**3).sum(axis=1)
        out[1] += (part.step * square).sum(axis=1)
        out[2] += (part.step * normal**2 / (2 * part.x)).sum(axis=1)
    stretch = material.plane_modulus(state)
    return out / np.array([[stretch], [material.shear_modulus], [stretch]])


def body(gear, material, state="plane strain", neighbours=1, *, cache=True):
    """Return the flexibility ``(neighbours + 1, 3, 3)`` of the gear body between a tooth and itself or the next teeth.

    See `annulus.root_flexibility`. The body lies between bore and root circle. The root arc of each tooth lies between the
    ends of its fillets.
    """

    def solve():
        apart = 2 * math.pi / gear.z * np.arange(neighbours + 1)
        return root_flexibility(gear.r_bore, gear.r_f, root_half_angle(gear), apart, material, state=state)

    return solved_gears(cache).get(("coupled", gear, material, state, neighbours), solve)


def body_loads(gear, roll):
    """Return the section forces ``(3, n)`` of `section_loads` at the root circle."""
    return section_loads(gear, np.atleast_1d(roll), shear_height(gear.r_f, root_half_angle(gear)))


def components(gear, material, roll, *, state="plane strain", cache=True):
    """Return the `Components` of one tooth: `beam`, and as foundation the `body` under this tooth, without local deflection."""
    loads = body_loads(gear, roll)
    bending, shear, axial = beam(gear, material, roll, state=state)
    foundation = np.einsum("an,ab,bn->n", loads, body(gear, material, state, cache=cache)[0], loads)
    return Components(bending, shear, axial, foundation)


def local_remainder(gear, material, roll, *, state="plane strain"):
    """Return the load-independent part of the local deflection that is missing in `sharing.line_contact`.

    The middle of an elliptic pressure of half width a approaches the half-plane's point at depth d by the integral of
    ``eps_z = (sigma_z - nu / (1 - nu) sigma_x) (1 - nu**2) / E`` over the depth. With the stresses on the axis (Johnson, eqs.
    4.45: ``sigma_z = -p0 a / s``, ``sigma_x = -p0 ((a**2 + 2 z**2) / s - 2 z) / a``, ``s = sqrt(a**2 + z**2)``) and ``a << d`` ::

        c P [ln(2 d / a) - nu / (2 (1 - nu))],    c = 2 (1 - nu**2) / (pi E),   d = h_L = x_F / cos(beta)

    h_L reaches along the load line to the tooth's centre-line. `sharing.line_contact` adds ``c P (ln(2 / a) + 1/2)`` per body
    (the mean of ``-c P ln|s|`` over the same pressure). The remainder, independent of the load, is::

        c [ln h_L - 1/2 - nu / (2 (1 - nu))]

    In plane stress nu / (1 - nu) is nu. Returns ``(n,)`` [mm per N/mm]. Lengths inside logarithms are in mm.

    References
    ----------
    C. Weber, K. Banaschek, Formaenderung und Profilruecknahme bei gerad- und schraegverzahnten Raedern (1953); K. L. Johnson,
    Contact Mechanics (1985), section 5.6 (eq. 5.57).
    """
    x_f, _ = cartesian(*flank(gear, roll))
    depth = x_f / np.cos(load_angle(gear, roll))
    ratio = material.nu / (1 - material.nu) if state == "plane strain" else material.nu
    return half_plane(material, state) * (np.log(depth) - 0.5 - ratio / 2)


def isolated(gear, material, formula, *, state="plane strain"):
    """Return the flexibility of a gear with uncoupled teeth: one tooth by `formula`, plus `local_remainder`.

    `formula` maps ``(gear, material, roll)`` to `Components`.
    """
    roll = np.linspace(gear.roll_f, gear.roll_a, NODES)
    arc = arc_at(gear, roll)
    near = formula(gear, material, roll).total + local_remainder(gear, material, roll, state=state)
    return Flexibility(gear, {0: Cubic(arc, near)}, {}, {}, (arc[0], arc[-1]))


def flexibility(gear, material, *, neighbours=1, state="plane strain", cache=True):
    """Return the closed-form flexibility of a healthy external gear, in the form of `finite_elements.fe.flexibility`.

    It contains no contact at tip corners, so `gearfe.contact.pair_contact.PairContact` requires ``extended=False``.

    Raises
    ------
    ValueError
        If the gear is a ring: its teeth are too wide at their root for a beam, and its body is held outside.
    """
    if gear.internal:
        raise ValueError("the coupled closed form has no ring (wide tooth roots, body held outside): use finite elements")
    alone = isolated(gear, material, partial(components, state=state, cache=cache), state=state)
    arc = alone.near[0].x
    loads = body_loads(gear, roll_at_arc(gear, arc))
    bases, between = through(arc), body(gear, material, state, neighbours, cache=cache)[1:]
    far = {(0, k): Bicubic(bases, loads.T @ c.T @ loads, bases) for k, c in enumerate(between, start=1)}
    return replace(alone, far=far)
