"""Spalls: what they may be, what they take of the flank and of the body, and where contact lines cross them."""

import math

import numpy as np
import pytest
from checks import lost_width
from numpy.testing import assert_allclose
from usual import RACK

import gearfe as gf
from gearfe.flexibility.energy.closed.section import section
from gearfe.geometry.damage.hollow import centre_arc, check_hollows, flank_edge, intervals, takes_all
from gearfe.geometry.damage.hollow_volume import removed_volume
from gearfe.geometry.mesh.holes import holed_sector
from gearfe.geometry.pair.gear_pair import GearPair
from gearfe.geometry.pair.lines import contact_lines, lost_length
from gearfe.geometry.tooth.profile import arc_at

GEAR = gf.Gear(z=21, r_bore=7.4, **RACK)
HELICAL = gf.Gear(z=21, r_bore=7.4, beta=0.3, **RACK)
RING = gf.Gear(z=72, r_rim=90.0, rack_tip_radius=0.3, **RACK)
GOOD = {"radius": 21.0, "z": 10.0, "sides": (1.5, 6.0), "depth": 0.2, "corner": 0.4}
COARSE = {"far": 3.0, "tooth": 1.2, "flank": 1.0, "fillet": 0.8}


def spall(gear=GEAR, **numbers):
    return gf.Spall(**GOOD | {"radius": gear.r} | numbers)


def pair(beta=0.0):
    return GearPair(gf.Gear(z=21, r_bore=7.4, beta=beta, **RACK), gf.Gear(z=31, r_bore=11.4, beta=-beta, **RACK))


@pytest.mark.parametrize("corner", [0.0, 0.4, 0.75])
def test_area_is_that_of_points_thrown_at_random(corner):
    found, rng = spall(corner=corner), np.random.default_rng(1)
    u, w = rng.uniform(-1, 1, (2, 1_000_000)) * [[0.9], [3.5]]
    area = found._contains(u, w).mean() * 1.8 * 7.0
    assert_allclose(area, 1.5 * 6.0 - (4 - math.pi) * corner**2, rtol=3e-3)
    low, high = found.span(u)
    assert (found._contains(u, w) == ((low - found.z < w) & (w < high - found.z))).all(), "the span says the same"
    arc = centre_arc(GEAR, found) + np.linspace(-0.75, 0.75, 20_001)
    assert_allclose(np.trapezoid(lost_width(GEAR, [found], arc), arc), 9.0 - (4 - math.pi) * corner**2, rtol=1e-5)


@pytest.mark.parametrize("gear", [GEAR, RING], ids=["gear", "ring"])
@pytest.mark.parametrize("seed", range(6))
def test_crossing_of_oblique_lines_against_points_along_them(gear, seed):
    rng = np.random.default_rng(seed)
    sides = tuple(rng.uniform(0.4, 4.0, 2))
    found = spall(gear, sides=sides, corner=rng.choice([0.0, 0.2, min(sides) / 2]))
    roll = math.sqrt(gear.r**2 - gear.r_b**2) + rng.uniform(-1.5, 1.5, 2)
    t = (np.arange(200_000) + 0.5) / 200_000
    low, high = intervals(gear, [found], arc_at(gear, roll[0] + (roll[1] - roll[0]) * t))
    inside = (low[0] < 20.0 * t) & (20.0 * t < high[0])
    parts = found.crossing(gear, roll, (0.0, 20.0))
    assert_allclose(sum(b - a for a, b in parts), inside.mean(), atol=2e-5)
    assert all(inside[(t > a + 1e-5) & (t < b - 1e-5)].all() for a, b in parts)


def test_lines_along_the_axis_meet_the_whole_side_or_nothing():
    found = spall(corner=0.0)
    at = math.sqrt(21.0**2 - GEAR.r_b**2)
    assert_allclose(found.crossing(GEAR, (at, at), (0.0, 20.0)), [(0.35, 0.65)], rtol=1e-12)
    assert_allclose(found.crossing(GEAR, (at, at), (20.0, 0.0)), [(0.35, 0.65)], rtol=1e-12)
    assert found.crossing(GEAR, (GEAR.roll_a, GEAR.roll_a), (0.0, 20.0)) == []


@pytest.mark.parametrize("gear", [GEAR, HELICAL, RING], ids=["gear", "helical", "ring"])
def test_a_fully_rounded_square_is_a_round_pit(gear):
    """Other formulas throughout: polynomials of sides and corners against the quadric of an ellipse."""
    round_ = spall(gear, sides=(1.2, 1.2), corner=0.6)
    pit = gf.Pit(radius=gear.r, z=10.0, axes=(0.6, 0.6), depth=0.2)
    arc = centre_arc(gear, pit) + np.linspace(-0.7, 0.7, 41)
    assert_allclose(intervals(gear, [round_], arc), intervals(gear, [pit], arc), atol=1e-12)
    at = math.sqrt(gear.r**2 - gear.r_b**2)
    for roll in ((at - 0.3, at + 0.4), (at, at), (at - 2.0, at + 2.0)):
        assert_allclose(round_.crossing(gear, roll, (0.0, 20.0)), pit.crossing(gear, roll, (0.0, 20.0)), atol=1e-9)
    assert_allclose(removed_volume(gear, [round_]), removed_volume(gear, [pit]), rtol=3e-4)  # of sums over 400 x 400 places


@pytest.mark.parametrize("beta", [0.0, 0.3])
def test_a_spall_takes_what_its_parts_take(beta):
    """A sharp rectangle against twelve that fill it."""
    made, whole = pair(beta), gf.Spall(radius=21.0 / math.cos(beta), z=10.0, sides=(1.2, 4.0), depth=0.2)
    gear = made.gear_1
    lines = contact_lines(made, np.linspace(0.0, 1.6, 9), face="helical" if beta else "spur")
    lost = lost_length(lines, ((whole,), ()))
    middle = centre_arc(gear, whole)

    def at(u):
        return math.sqrt(gear.r_b**2 + 2 * gear.r_b * (middle + u))

    parts = [gf.Spall(at(u), z, (0.4, 1.0), 0.2) for u in (-0.4, 0.0, 0.4) for z in (8.5, 9.5, 10.5, 11.5)]
    assert_allclose(lost_length(lines, (parts, ())), lost, atol=1e-9)
    assert lost.sum() > 4.0


@pytest.mark.parametrize(  # each two of the three choices meet
    ("gear", "corner", "stretch"),
    [
        (GEAR, 0.4, 1.6),
        (HELICAL, 0.75, 1.6),
        *(
            pytest.param(*one, marks=pytest.mark.slow)
            for one in ((GEAR, 0.0, 1.0), (GEAR, 0.75, 1.0), (HELICAL, 0.0, 1.6), (HELICAL, 0.4, 1.0))
        ),
    ],
)
def test_volume_by_integral_is_that_of_the_solid_that_is_cut(gear, corner, stretch):
    made = holed_sector(gear, [spall(gear, corner=corner)], teeth=1, sizes=COARSE, stretch=stretch)
    want, cut, meshed = made.removed
    assert_allclose(cut, want, rtol=5e-4)
    assert_allclose(meshed, cut, rtol=0.05)


@pytest.mark.slow
def test_spalls_over_the_tip_and_the_end_face_and_of_a_ring_are_cut():
    for gear, numbers in ((GEAR, {"z": 19.5}), (GEAR, {"radius": GEAR.r_a - 0.2}), (RING, {}), (GEAR, {"side": "unloaded"})):
        _, cut, _ = holed_sector(gear, [spall(gear, **numbers)], teeth=1, sizes=COARSE).removed
        assert cut < 0.2 * 9.0 * 1.1


@pytest.mark.parametrize("corner", [0.0, 0.4])
def test_section_has_the_area_and_inertia_of_the_parallel_axis_theorem(corner):
    """``dI = l s**3 / 12 + A dA (h - s / 2)**2 / (A - dA)``, l the length and s the depth: of a section 2 h x b."""
    found, h, b, s = spall(corner=corner), 1.7, GEAR.b, 0.2
    for u in (0.0, 0.6):
        arc = np.array([centre_arc(GEAR, found) + u])
        low, high = found.span(np.array([u]))
        length = float(high[0] - low[0])
        area, inertia, _ = section(GEAR, np.array([h]), np.array([20.0]), arc, [], [found])
        whole, taken = 2 * h * b, length * s
        lost = length * s**3 / 12 + whole * taken * (h - s / 2) ** 2 / (whole - taken)
        assert_allclose([area[0] * b, inertia[0] * b], [whole - taken, 2 * h**3 * b / 3 - lost], rtol=1e-12)


def test_outline_that_is_drawn_is_the_edge():
    z, radius = flank_edge(GEAR, spall())
    assert_allclose([z.min(), z.max()], [7.0, 13.0], atol=2e-3)
    assert (z[0], radius[0]) == (z[-1], radius[-1]), "closed"
    found = spall()
    u, w = found._edge()
    assert found._contains(0.999 * u, 0.999 * w).all()
    assert not found._contains(1.01 * u, 1.01 * w).any()


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"depth": 0.0}, "depth = 0.0"),
        ({"sides": (1.0,)}, "two lengths"),
        ({"sides": (1.0, -1.0)}, "sides = "),
        ({"sides": (1.0, 1e9)}, "a side is from 1e-06 to 1e"),
        ({"corner": 0.8}, "half the shorter one of sides"),
        ({"corner": -0.1}, "corner's radius"),
        ({"tooth": 0.5}, "whole number"),
    ],
)
def test_contradictory_spalls_are_refused(numbers, message):
    with pytest.raises(ValueError, match=message):
        gf.Spall(**GOOD | numbers)


@pytest.mark.parametrize(
    ("numbers", "message"),
    [({"radius": 24.0}, "spall at radius"), ({"z": -0.1}, "spall at z"), ({"depth": 1.5}, "spall of depth")],
)
def test_spalls_beside_the_flank_are_refused(numbers, message):
    check_hollows(GEAR, [spall()])
    with pytest.raises(ValueError, match=message):
        check_hollows(GEAR, [spall(**numbers)])


def test_a_spall_larger_than_its_flank_takes_all_of_it():
    assert takes_all(GEAR, spall(sides=(20.0, 50.0), corner=0.0))
    assert not takes_all(GEAR, spall(sides=(20.0, 19.0), corner=0.0))
    assert not takes_all(GEAR, spall(sides=(1.0, 50.0), corner=0.0))
