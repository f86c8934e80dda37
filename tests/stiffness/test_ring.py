"""Internal gears and planetary sets."""

import math
import warnings

import numpy as np
import pytest
from checks import form_mismatch
from full_contact import full_contact
from numpy.testing import assert_allclose
from usual import RACK, STEEL

import gearfe as gf
from gearfe.geometry.pair.contacts import contacts
from gearfe.geometry.tooth.profile import cartesian, fillet, flank, form_point
from validation.shared import reference


def ring(z, **numbers):
    return gf.Gear(z=z, **({"r_rim": z + 12.5, "rack_tip_radius": 0.2} | RACK | numbers))


def planet(z, **numbers):
    return gf.Gear(z=z, **({"r_bore": 0.45 * z} | RACK | numbers))


@pytest.fixture(scope="module")
def pair():
    with pytest.warns(UserWarning, match="trimmed"):
        return gf.GearPair(planet(27), ring(72))


def test_ring_root_stress_of_boundary_elements():
    table = reference.load()["ring_root_stress"]
    for row in table["rows"]:
        got, eps_alpha = reference.ring_root_stress(row)
        assert_allclose(got, row["value"], rtol=table["tolerance"], err_msg=table["source"])
        assert_allclose(eps_alpha, row["eps_alpha"], rtol=1e-11)


@pytest.mark.slow
def test_ring_root_stress_has_an_estimate_that_covers_a_finer_mesh():
    row = reference.load()["ring_root_stress"]["rows"][0]
    one = gf.Gear(z=row["z"], m_n=1.0, alpha_n=math.radians(20), b=1.0, r_rim=42.0, rack_tip_radius=row["rack_tip_radius"])
    case = one, math.hypot(*row["point"]), 1 / math.cos(one.alpha_n), gf.Material()
    stress, estimate = gf.root_stress(*case, half_width=0.05, error=True)
    fine = gf.root_stress(*case, half_width=0.05, refine=2.0)
    print(f"{stress:.5f} +- {estimate:.5f}, finer {fine:.5f}, boundary elements {row['value']}")
    assert abs(stress - fine) <= estimate
    assert estimate <= 2e-3 * stress


def test_shaped_fillet_curvature_at_the_root():
    """Euler-Savary: rho + d**2 / (1 / (1/r_0 - 1/r) + d) with the cutter's pitch radius r_0 (source: 0.2686915887850)."""
    gear = gf.Gear(z=60, m_n=1.0, alpha_n=math.radians(20), b=1.0, r_rim=42.0, rack_tip_radius=0.2)
    phi = math.pi / 2 - np.array([0, 1e-4, 2e-4])
    x, y = cartesian(*fillet(gear, phi))
    turn = np.arctan2(np.diff(y), np.diff(x))
    radius = np.hypot(*(np.diff(v).mean() for v in (x, y))) / abs(np.diff(turn)[0])
    assert_allclose(radius, 0.2686915887850, rtol=1e-3)


@pytest.mark.parametrize("z", [36, 60, 84, 150])
def test_fillet_meets_involute(z):
    gear = ring(z)
    assert abs(form_mismatch(gear)) < 1e-9
    assert gear.r_a < gear.r_form < gear.r_f
    phi, roll = form_point(gear)
    ends = cartesian(*fillet(gear, np.array([phi, phi + 1e-6])))
    tangent = np.diff(ends)[:, 0] / np.linalg.norm(np.diff(ends))
    step = np.diff(cartesian(*flank(gear, np.array([roll, roll - 1e-6]))))[:, 0]
    assert abs(tangent @ step) > 0.9999 * np.linalg.norm(step)


def test_trimming_is_reported(pair):
    assert pair.gear_2.addendum < 1
    assert "contact ratio 1.944 -> 1.805" in pair.notes[0]
    assert_allclose(pair.path[0], pair.gear_1.roll_f, rtol=1e-9)


def test_flanks_touch_and_gaps_match_the_outlines(pair):
    place = sum(pair.path) / 2
    turn_1, turn_2 = pair.turn(place)
    r_1, a_1 = flank(pair.gear_1, place)
    r_2, a_2 = flank(pair.gear_2, pair.mate_roll(place))
    one = cartesian(r_1, turn_1 + a_1)
    two = cartesian(r_2, turn_2 - a_2) + np.array([0, pair.centre_2])
    assert_allclose(one, two, atol=1e-10)
    assert abs(pair.backlash) < 1e-9
    found = contacts(pair, pair.eps_alpha - 1 + np.array([1e-4, 0.02, 0.05]))
    gap = found.gap[:, list(found.order).index(1)]
    assert (np.diff(gap) > 0).all()
    assert gap[0] < 1e-6


@pytest.mark.parametrize("method", ["fe", "ritz"])
def test_27_72_ring_pair(method):
    table = reference.load()["healthy_ring"]
    got = reference.healthy_ring(method)
    assert_allclose(got[:2], table["value"][:2], rtol=table["tolerance"], err_msg=table["source"])


@pytest.mark.parametrize("method", ["fe", "ritz"])
def test_verdict_on_the_minimum_of_the_27_72_ring_pair(method):
    """Not found: the source does not give its ring's fillet. A sharper one (cutter 40, radius 0.1) gives 17.17."""
    table = reference.load()["healthy_ring"]
    ours, printed = reference.healthy_ring(method)[2], table["value"][2]
    assert abs(ours / printed - 1) > table["tolerance"], "found now: a tolerance was widened, or the ring has changed"
    assert_allclose(ours, 17.36, atol=0.02)


@pytest.mark.slow
def test_ring_pair_equals_full_contact(pair):
    """A tip corner carries 4 % here: pressures there take twice the usual resolution, at which they differ by 0.5 %."""
    fast = gf.mesh_stiffness(pair, 2000.0, STEEL, phases=[0.9])
    full = full_contact(pair, 100.0, 0.9, (STEEL, STEEL), per_width=20)
    assert_allclose(fast.deflection[0] * 1e3, full.approach, rtol=0.01)


def test_energy_methods_have_no_ring(pair):
    with pytest.raises(ValueError, match="has no foundation for a ring"):
        gf.mesh_stiffness(pair, 2000.0, STEEL, method="textbook")


@pytest.mark.slow
@pytest.mark.parametrize("start", ["30deg", "root"])
def test_ring_crack(pair, start):
    """The crack makes the mesh softer, by the work up to each load.

    ``int(delta, dF)`` is the complementary energy, the least of ``p' C p / 2 + gap . p`` over all shares p >= 0 of the load. It
    cannot fall if C rises. The secant k has no such bound: it may rise by 0.1 % where the cracked tooth touches off the path,
    since loads on its neighbour then press it less away from its mate, and it carries more.
    """
    nodes, weights = np.polynomial.legendre.leggauss(8)
    loads = [2000.0 * (1 + float(x)) / 2 for x in nodes]

    def work(**damage):
        curves = gf.mesh_stiffness(pair, [*loads, 2000.0], STEEL, span="tooth", phases=16, **damage)
        return curves[-1].k, np.array([curve.deflection for curve in curves[:-1]]).T @ weights

    (healthy, least), (cracked, more) = work(), work(damage={"wheel": [gf.Crack(level=0.3, start=start)]})
    assert (more > least * (1 - 2e-5)).all()
    loss = 1 - cracked / healthy
    assert loss.min() > -1e-3
    assert 0.02 < loss.max() < 0.5


def test_infinite_ring_is_a_rack_like_mate():
    """The relative curvature of a ring pair tends to the pinion's as the ring grows."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        big = gf.GearPair(planet(27), ring(2000))
    roll = big.gear_1.r_b * math.tan(big.alpha_wt)
    assert_allclose(big.relative_radius(roll, big.mate_roll(roll)), roll, rtol=0.02)


def test_interference_of_close_tooth_numbers():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(ValueError, match="interference"):
            gf.GearPair(planet(35), ring(40))


def test_radial_assembly(pair):
    assert pair.radial_assembly
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert not gf.GearPair(planet(30), ring(40)).radial_assembly


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ring(72, r_rim=70.0), "r_rim = 70.0 mm"),
        (lambda: gf.Gear(z=72, **RACK), "give r_bore for an external gear or r_rim"),
        (lambda: gf.Gear(z=72, r_rim=90.0, r_bore=3.0, **RACK), "are both given"),
        (lambda: ring(30), "inside the base circle"),
        (lambda: ring(60, z_cutter=60), "z_cutter = 60"),
        (lambda: ring(60, dedendum=2.2, addendum=0.5), "pointed|fillets overlap|cutter"),
        (lambda: gf.GearPair(ring(72), planet(27)), "gear_1 is a ring"),
        (lambda: gf.GearPair(planet(80), ring(72)), "does not fit into a ring"),
        (lambda: gf.GearPair(planet(27), ring(72), 46.0), "too large"),
    ],
)
def test_impossible_rings_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_planetary_set_of_article_s1_does_not_close():
    gears = planet(21), planet(31), ring(84, x=-0.6524)
    with pytest.raises(ValueError, match=r"x_ring = -0.6524 does not close at a = 52 mm: .* x_ring = -0.4617"):
        gf.PlanetarySet(*gears, 3)
    closed = gf.PlanetarySet(*gears[:2], ring(84, x=-0.4617), 3)
    assert closed.a == pytest.approx(52)
    with pytest.warns(UserWarning, match="trimmed"):
        assert closed.planet_ring.eps_alpha > 1.5
    assert math.degrees(closed.sun_planet.alpha_wt) == pytest.approx(20)


def test_planetary_spacing_and_neighbours():
    with pytest.raises(ValueError, match="not whole"):
        gf.PlanetarySet(planet(18), planet(27), ring(72), 4)
    with pytest.raises(ValueError, match="touch each other"):
        gf.PlanetarySet(planet(18), planet(27), ring(72), 5)
    gf.PlanetarySet(planet(18), planet(27), ring(72), 3)
    for n in (0, -3, 1.5):
        with pytest.raises(ValueError, match="whole number of planets"):
            gf.PlanetarySet(planet(18), planet(27), ring(72), n)
    for a in (math.nan, 0.0, 20.0):
        with pytest.raises(ValueError, match="base circles"):
            gf.PlanetarySet(planet(18), planet(27), ring(72), 3, a)


def test_planet_planet_is_an_external_pair():
    assert gf.GearPair(planet(21), planet(21)).eps_alpha > 1.5
