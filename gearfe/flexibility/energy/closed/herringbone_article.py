"""Formulas of article S4 (crack-pitting coupled herringbone planetary stage), as printed wherever they can be computed."""

import math

import numpy as np
from numpy.polynomial.legendre import leggauss

from .beam import FOUNDATIONS, Components, body_ratio, load_angle, sainsot, sainsot_outside
from .integrals import HEALTHY, beam_parts

GAUSS = leggauss(32)
DEFAULTS = {"contact": "herringbone_article", "root": "prism"}  # defaults of `gearfe.flexibility.energy.closed.plain_sum`
ROOTS, FEET = ("prism", "base"), ("root", "base")


def components(gear, material, roll, *, damage=HEALTHY, foundation="sainsot", root="prism", foot="root"):
    """Flexibility of one tooth by article S4 ("Crack-Pitting Coupled Gear Dynamics").

    As printed: the foundation bracket ``L* u**2 + M* u + P* (1 + tan(a)**2) + Q* tan(a)`` with ``u = u_f / S_f``, the factor
    ``cos(a)**2 / (E L)``, and the coefficient table.

    Corrections to the printed text, which is incomplete:

    1. the integrals of k_b, k_s, k_a have lost their factors (all print ``.../(2 E L dL)``): those of the source they
       abridge are used. When r_f < r_b the article has two integrals, from a_1 to a_2 and from a_2 to a_3, and its d ends with "-
       R_f": the beam starts on the root circle, with a prism of constant thickness up to the base circle (``root="prism"``).
       ``root="base"`` omits the second integral. Many codes use this simplification, which the article contradicts;
    2. d and h_x are garbled (they lack the factors alpha_2 +- alpha): the same source's are used;
    3. u_f, S_f and theta_f are not defined, beyond "polynomial functions of the tooth height and fillet angle": Sainsot's, with
       the root half angle of a straight radial flank below the base circle, ``r_f sin(theta_f) = r_b sin(alpha_2)``
       (``foot="root"``). With ``foot="base"`` the body ends, and u_f, S_f, theta_f and h are counted, on the larger of base and
       root circle. This choice of where the body ends is independent of `root`, which states where the beam begins.

    Damage (the same integrals with the article's ``A_x`` and ``I_x`` of a cracked and pitted section), corrected:

    4. a cracked section is ``(h_x + h_c) L`` from the crack, at the foot of the beam, up to where ``h_x = h_c`` (the printed
       transition "x <= d" is the whole tooth); the article's angle and length, and its undefined level as in
       `gearfe.Crack`, of the half thickness at the foot;
    5. the printed ``dI = dA (h_p**2 + 3/4 p_d**2) / 12`` mixes up the axes and lacks the parallel-axis term, so that I - dI
       can become negative: the inertia here is that of the section left, about its own centroid;
    6. several pits in a section take the union of their widths, not the sum (for k_h "I sum the reductions" is the variant
       ``lost="summed"`` of `gearfe.flexibility.energy.closed.plain_sum`); material unloaded by the crack is not removed again
       (case 3 of the article, which it only calls "close to");
    7. pits reduce axial compression as printed; cracks do not (the article gives no cracked k_a).

    For a ring:

    8. its beam is integrated over its own profile, the involute extended to the root circle (the printed integrals from a_f to
       a_1 have lost their factors);
    9. the article gives one foundation formula right after the ring's integrals and uses it for both gears of every pair:
       ``foundation="printed"`` does so, with ``h = 1`` (`energy.closed.beam.RING_H`: the article defines no h, a ring has no
       bore), u_f inwards from the root circle and theta_f of the ring's own tooth. The formula is a fit to discs held at their
       bore; ``foundation="external"`` omits the foundation of the ring.

    The contact term ``k_h = E L / 2 (1 - mu**2)`` is in `contact`.

    References
    ----------
    X. Liang, M. J. Zuo, T. H. Patel, J. Mech. Eng. Sci. 228(3) (2014) 535-547, eqs. 6-20 (the planetary form).
    """
    roll = np.atleast_1d(np.asarray(roll, dtype=float))
    for name, value, choices in (("foundation", foundation, FOUNDATIONS), ("root", root, ROOTS), ("foot", foot, FEET)):
        if value not in choices:
            raise ValueError(f"{name} = {value!r}, but it must be one of {', '.join(choices)}")
    if damage or gear.internal:  # The integrals are evaluated over the height, with the sections that the damage leaves.
        parts = beam_parts(gear, material, roll, root, damage)
    else:
        parts = _healthy(gear, material, load_angle(gear, roll), root)
    return Components(*parts, *body(gear, material, roll, foundation, foot))


def body(gear, material, roll, foundation="sainsot", foot="root"):
    """Return the foundation flexibility ``(n,)`` [mm per N/mm], and the violated ranges of validity of its formula."""
    force = load_angle(gear, roll)
    cos, tan = np.cos(force), np.tan(force)
    if foundation == "none" or (foundation == "external" and gear.internal):
        return np.zeros(np.shape(roll)), ()
    below = gear.r_f < gear.r_b
    ends = gear.r_b if below and foot == "base" else gear.r_f
    theta = math.asin(min(1.0, gear.r_b * math.sin(gear.base_half_angle) / ends)) if below else float(gear.half_thickness(ends))
    h = body_ratio(gear, foundation) * ends / gear.r_f
    outside = sainsot_outside(gear, h, theta)
    ratio = gear.outward * (gear.r_b / cos - ends) / (2 * ends * theta)
    l, m, p, q = sainsot(h, theta)  # noqa: E741 the source's letters
    return cos**2 / material.E * (l * ratio**2 + m * ratio + p * (1 + tan**2) + q * tan), outside


def _healthy(gear, material, force, root):
    """Bending, shear and axial flexibility, by the integrals of the source over the angle."""
    alpha_2, cos, sin = gear.base_half_angle, np.cos(force), np.sin(force)
    points, weights = GAUSS
    low = max(gear.r_f, gear.r_b)
    stop = alpha_2 - math.tan(math.acos(gear.r_b / low))
    half = (stop + force)[:, None] / 2
    at = -force[:, None] + half * (1 + points)
    step = half * weights * (alpha_2 - at) * np.cos(at)
    depth = np.sin(at) + (alpha_2 - at) * np.cos(at)
    arm = 1 + cos[:, None] * ((alpha_2 - at) * np.sin(at) - np.cos(at))
    bending = (step * 3 * arm**2 / (2 * depth**3)).sum(axis=1) / material.E
    shear = (step * 1.2 * (1 + material.nu) / depth).sum(axis=1) * cos**2 / material.E
    axial = (step / (2 * depth)).sum(axis=1) * sin**2 / material.E
    if gear.r_f < gear.r_b and root == "prism":
        theta = math.asin(min(1.0, gear.r_b * math.sin(alpha_2) / gear.r_f))
        depth = (gear.r_b * math.cos(alpha_2) - gear.r_f * math.cos(theta)) / gear.r_b
        far = 1 - (gear.r_f / gear.r_b) * cos * math.cos(theta)
        near = 1 - cos * math.cos(alpha_2)
        bending += (far**3 - near**3) / (2 * material.E * cos * math.sin(alpha_2) ** 3)
        shear += 1.2 * (1 + material.nu) * cos**2 * depth / (material.E * math.sin(alpha_2))
        axial += sin**2 * depth / (2 * material.E * math.sin(alpha_2))
    return bending, shear, axial


def contact(materials):
    """Contact flexibility [mm per N/mm] of ``k_h = E L / 2 (1 - mu**2)`` as printed, averaged over two materials.

    It is 1.57 times more flexible than the textbook's ``pi E L / 4 (1 - mu**2)``.
    """
    return sum((1 - m.nu**2) / m.E for m in materials)
