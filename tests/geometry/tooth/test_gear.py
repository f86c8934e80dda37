import math

import numpy as np
import pytest
from checks import form_mismatch
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.geometry.tooth.profile import cartesian, fillet, flank, flank_normal, form_point, root_curve, tangent_point

pytestmark = pytest.mark.quick

RACK = {"m_n": 1.0, "alpha_n": math.radians(20), "b": 1.0, "r_bore": 0.1}


@pytest.mark.parametrize("z", [5, 8, 10, 12, 14, 16, 17, 18, 25, 200, 1000])
@pytest.mark.parametrize("x", [-0.4, -0.1, 0.0, 0.3])
def test_fillet_meets_involute(z, x):
    gear = gf.Gear(z=z, x=x, **RACK)
    assert abs(form_mismatch(gear)) < 1e-6 * gear.m_n
    assert_allclose(fillet(gear, math.pi / 2)[0], gear.r_f, rtol=1e-12)


@pytest.mark.parametrize(("z", "undercut"), [(10, True), (12, True), (14, True), (17, False), (18, False)])
def test_undercut_limit(z, undercut):
    """Straight rack flank to 1.0 m below the pitch line: undercut below 2 / sin(20)**2 = 17.1 teeth."""
    gear = gf.Gear(z=z, **RACK)
    assert (form_point(gear)[0] > gear.alpha_n + 1e-3) == undercut
    assert gear.r_form >= gear.r_b


def test_fillet_is_smooth_where_not_undercut():
    gear = gf.Gear(z=30, **RACK)
    phi, roll = form_point(gear)
    ends = cartesian(*fillet(gear, np.array([phi, phi + 1e-6])))
    along = np.diff(ends, axis=1)[:, 0]
    normal = flank_normal(gear, roll)
    assert abs(along @ normal) < 1e-5 * np.linalg.norm(along)


def test_generated_fillet_is_the_envelope_of_the_rack():
    """Rolling the rack against the gear, no rack tip point enters the tooth, and every fillet point is touched."""
    gear = gf.Gear(z=20, **RACK, rack_tip_radius=0.3)
    phi = np.linspace(form_point(gear)[0], math.pi / 2, 400)
    r_fillet, a_fillet = fillet(gear, phi)
    order = np.argsort(r_fillet)
    xi = math.pi / 4 - 0.95 * math.tan(gear.alpha_n) - 0.3 / math.cos(gear.alpha_n)
    turn = np.linspace(gear.alpha_n, math.pi / 2, 200)
    corner = np.array([xi + 0.3 * np.cos(turn), gear.r - 0.95 - 0.3 * np.sin(turn)])
    least = np.inf
    for rolled in np.linspace(-2, 2, 1601):
        x, y = corner[0] + rolled, corner[1]
        radius, space = np.hypot(x, y), np.arctan2(x, y) - rolled / gear.r
        on = (radius > r_fillet.min()) & (radius < r_fillet.max())
        solid = np.interp(radius[on], r_fillet[order], a_fillet[order])
        clearance = radius[on] * (math.pi / gear.z - space[on] - solid)
        least = min(least, clearance.min(initial=np.inf))
    assert -1e-4 < least < 1e-4


def test_helical_section_uses_the_transverse_rack():
    gear = gf.Gear(z=18, m_n=2.0, alpha_n=math.radians(20), beta=math.radians(16), b=30.0, r_bore=9.0)
    assert_allclose([gear.m_t, math.degrees(gear.alpha_t), math.degrees(gear.beta_b)], [2.0806, 20.7386, 15.0116], rtol=1e-4)
    assert gear.r_a - gear.r_f == pytest.approx(2.25 * 2.0)


def test_30_degree_tangent():
    gear = gf.Gear(z=25, **RACK)
    phi = tangent_point(gear)
    near = np.diff(cartesian(*fillet(gear, np.array([phi - 1e-5, phi + 1e-5]))), axis=1)[:, 0]
    assert_allclose(math.degrees(math.atan2(abs(near[0]), abs(near[1]))), 30, atol=0.05)


def test_flank_is_an_involute():
    gear = gf.Gear(z=25, **RACK)
    roll = np.linspace(gear.roll_f, gear.roll_a, 50)
    points, normal = cartesian(*flank(gear, roll)), flank_normal(gear, roll)
    assert_allclose(
        np.abs(points[0] * normal[1] - points[1] * normal[0]), gear.r_b, rtol=1e-12, err_msg="normals touch the base circle"
    )
    arc = np.hypot(*np.diff(points, axis=1)).sum()
    assert_allclose(arc, (gear.roll_a**2 - gear.roll_f**2) / (2 * gear.r_b), rtol=1e-4)


def test_root_curve_is_continuous():
    gear = gf.Gear(z=25, **RACK)
    points = cartesian(*root_curve(gear, np.array([-1e-9, 1e-9])))
    assert np.linalg.norm(np.diff(points, axis=1)) < 1e-7


def test_rack_tip_radius_is_capped_with_a_warning():
    with pytest.warns(UserWarning, match=r"rack_tip_radius = 0.38 m_n does not fit .* capped at the full tip radius 0.317"):
        gear = gf.Gear(z=30, m_n=1.0, alpha_n=math.radians(25), b=1.0, r_bore=5.0)
    assert gear.rack_tip_radius == pytest.approx(gear.full_tip_radius)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"z": 4}, "z = 4, but a gear needs at least 5 teeth"),
        ({"z": 20.5}, "number of teeth is an integer"),
        ({"z": math.nan}, "z = nan"),
        ({"m_n": math.nan}, "m_n = nan"),
        ({"x": math.inf}, "x = inf"),
        ({"b": 0.0}, "b = 0.0"),
        ({"alpha_n": 20.0}, "radians"),
        ({"beta": 1.2}, "60 degrees"),
        ({"z": 8, "x": 0.9}, "pointed"),
        ({"r_bore": 20.0}, "r_bore = 20.0 mm, but the bore must lie inside the root circle"),
        ({"r_bore": 0.0}, "r_bore = 0.0"),
        ({"r_bore": 1e-300}, "r_bore = 1e-300 mm, but its edge is held and must have a length: give r_bore >= 0.01 mm"),
        ({"r_bore": None, "r_rim": 1e8}, r"r_rim = 1e\+08 mm, but a rim has at most 100 root radii|r_rim = 100000000.0 mm, but"),
        ({"z": 100_000_000}, "z = 100000000, but gears have at most 10000 teeth"),
        ({"z": 5, "x": -0.6}, "undercut"),
        ({"rack_tip_radius": -0.1}, "rack_tip_radius"),
        ({"dedendum": 2.5}, "pointed before its tip"),
    ],
)
def test_impossible_gears_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        gf.Gear(**({"z": 25} | RACK | change))


@pytest.mark.parametrize("beta", [-30, 0, 15])
@pytest.mark.parametrize("x", [-0.3, 0.0, 0.5])
def test_teeth_are_as_thick_as_the_shifted_rack_leaves_them(beta, x):
    """On the reference circle half a pitch and, across the helix, 2 x m_n tan(alpha_n); normal to flanks pi m_n cos(alpha_n)."""
    gear = gf.Gear(z=30, x=x, m_n=2.0, alpha_n=math.radians(20), b=20.0, beta=math.radians(beta), r_bore=10.0)
    thickness = 2 * gear.r * gear.half_thickness(gear.r)
    across = (math.pi / 2 + 2 * x * math.tan(gear.alpha_n)) * gear.m_n
    assert thickness * math.cos(gear.beta) == pytest.approx(across, rel=1e-12)
    assert gear.p_bt * math.cos(gear.beta_b) == pytest.approx(math.pi * gear.m_n * math.cos(gear.alpha_n), rel=1e-12)
    assert math.tan(gear.beta_b) == pytest.approx(gear.r_b * gear.twist_rate, rel=1e-12)
