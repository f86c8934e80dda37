"""ISO 6336-3 on helical gears beside a numerical generation of the virtual spur gear by its rack."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf


def generated(z, gear):
    """Tangent of the fillet at 30 degrees and half tooth angles of a gear of z teeth, not whole, that a rack generates.

    Returns half of the chord there, its height above the axis and the radius of curvature, and radii and half angles along the
    flank, all in modules. The rack rolls on the reference circle; it touches where its normal goes through the pitch point.
    """
    alpha, tip, r = gear.alpha_n, gear.rack_tip_radius, z / 2
    depth = gear.dedendum - tip - gear.x_E  # of the centre of the rack's tip below the reference circle
    aside = math.pi / 4 - (gear.dedendum - tip) * math.tan(alpha) - tip / math.cos(alpha)
    shift = np.linspace(-1.5, 1.0, 200_001) * 2
    centre = np.array([aside + shift, np.full(shift.size, r - depth)])
    to = centre - [[0.0], [r]]
    fillet = centre + tip * to / np.hypot(*to)
    # the flank is a line; it touches at the foot of its perpendicular from the pitch point
    normal = np.array([math.cos(alpha), -math.sin(alpha)])
    away = normal[0] * (math.pi / 4 + shift) + normal[1] * gear.x_E
    flank = normal[:, None] * away + [[0.0], [r]]
    out = []
    for points in (fillet, flank):
        angle = np.arctan2(*points) - shift / r  # from the middle of the tooth space
        out.append((np.hypot(*points), math.pi / z - angle))
    radius, angle = out[0]
    x, y = radius * np.sin(angle), radius * np.cos(angle)
    dx, dy = np.gradient(x), np.gradient(y)
    tilt = np.abs(np.arctan2(np.abs(dx), np.abs(dy)) - math.radians(30))
    inside = np.flatnonzero((to[0] > 0) & (-to[1] > math.sin(alpha) * np.hypot(*to)))  # normals from the root to the flank
    k = inside[tilt[inside].argmin()]
    curvature = (dx * np.gradient(dy) - dy * np.gradient(dx))[k] / np.hypot(dx, dy)[k] ** 3
    return x[k], y[k], 1 / abs(curvature), out[1]


@pytest.mark.parametrize("seed", range(8))
def test_the_virtual_spur_gear_is_that_of_its_rack(seed):
    rng = np.random.default_rng(seed)
    beta, alpha = math.radians(rng.uniform(5, 30)), math.radians(rng.uniform(17, 25))
    rack = {"m_n": rng.uniform(1, 6), "alpha_n": alpha, "b": rng.uniform(10, 60), "rack_tip_radius": rng.uniform(0.2, 0.3)}
    z, x = rng.integers(19, 40, 2), rng.uniform(-0.1, 0.4, 2)
    pinion, wheel = (
        gf.Gear(z=int(n), x=float(s), beta=sign * beta, r_bore=0.3 * n * rack["m_n"], **rack)
        for n, s, sign in zip(z, x, (1, -1), strict=True)
    )
    pair = gf.GearPair(pinion, wheel)
    for side, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2)):
        norm = gf.iso_root_stress(pair, 1000.0, side)
        beta_b = math.asin(math.sin(beta) * math.cos(alpha))
        z_n = gear.z / (math.cos(beta_b) ** 2 * math.cos(beta))
        half, low, rho, (radius, angle) = generated(z_n, gear)
        order = np.argsort(radius)
        at, r_bn = norm.radius / gear.m_n, z_n / 2 * math.cos(alpha)
        # a force along the tangent of the base circle meets the centre line at r_b over the cosine of its slope
        slope = math.acos(r_bn / at) - np.interp(at, radius[order], angle[order])
        arm, chord = r_bn / math.cos(slope) - low, 2 * half
        y_f = 6 * arm * math.cos(slope) / (chord**2 * math.cos(alpha))
        y_s = (1.2 + 0.13 * chord / arm) * (chord / (2 * rho)) ** (1 / (1.21 + 2.3 * arm / chord))
        assert_allclose([norm.Y_F, norm.Y_S], [y_f, y_s], rtol=1e-3)
        overlap = rack["b"] * math.sin(beta) / (math.pi * gear.m_n)
        y_beta = 1 - min(overlap, 1) * math.degrees(beta) / 120
        force = 1000.0 * gear.r_b / gear.r  # tangential, at the reference circle
        assert_allclose(norm.stress, force / (rack["b"] * gear.m_n) * y_f * y_s * y_beta, rtol=2e-3)


def test_helical_teeth_tend_to_spur_teeth():
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 5.0}
    spur, helical = (
        gf.GearPair(gf.Gear(z=21, beta=beta, r_bore=5.0, **rack), gf.Gear(z=43, beta=-beta, r_bore=10.0, **rack))
        for beta in (0.0, 1e-6)
    )
    one, two = (gf.iso_root_stress(pair, 1000.0) for pair in (spur, helical))
    assert_allclose([two.stress, two.radius], [one.stress, one.radius], rtol=1e-6)
