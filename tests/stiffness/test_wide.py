"""`mesh_stiffness` of gears of finite width: the curve's identities, damage, choice of method, refusals."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import pair_18_27 as pair_of

import gearfe as gf
from gearfe.flexibility.hertz import contact_modulus, peak_pressure

RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
FORCE = 1500.0
COARSE = {"refine": 0.6, "method": "ritz3d"}
PIT = gf.Pit(radius=18.7, z=4.0, axes=(0.8, 1.5), depth=0.1)


def curve_of(steel, damage=None, pair=None, force=FORCE, **options):
    return gf.mesh_stiffness(pair or pair_of(8.0), force, steel, damage=damage, **(COARSE | {"phases": 5} | options))


@pytest.fixture(scope="module")
def healthy(steel):
    return curve_of(steel, error=True)


def test_k_and_its_estimate_are_properties_of_the_phase(healthy, steel):
    """Neighbours in the list of phases do not enter: one phase alone gets what it gets among others, sound and damaged."""
    alone = curve_of(steel, error=True, phases=healthy.phase[[3]])
    assert_allclose((alone.k[0], alone.error[0]), (healthy.k[3], healthy.error[3]), rtol=1e-6)
    both, one = (curve_of(steel, {"pinion": [PIT]}, error=True, phases=np.array(phases)) for phases in ([0.1, 0.6], [0.6]))
    assert_allclose((both.k[1], both.error[1]), (one.k[0], one.error[0]), rtol=1e-6)


def test_meta_says_what_was_done(healthy):
    meta = healthy.meta
    assert (meta["method"], meta["why"]) == ("ritz3d", "asked for")
    assert (meta["face"], meta["groove"], meta["refine"]) == ("helical", 0.0, 0.6)
    assert (meta["force_N"], meta["width_mm"], meta["extended"]) == (FORCE, 8.0, True)


def test_no_pair_is_pressed_less_than_by_an_even_load(healthy, steel):
    """The largest pressure of a pair lies above Hertz's of its mean load on a line of full length with the largest radius."""
    pair = pair_of(8.0)
    beta_b = pair.gear_1.beta_b
    radius = max(float(pair.relative_radius(*pair.curvature_radii(p))) for p in np.linspace(0, pair.eps_alpha, 20))
    line = healthy.force / math.cos(beta_b) / (8.0 / math.cos(beta_b))
    least = peak_pressure(line, radius / math.cos(beta_b), contact_modulus((steel, steel)))
    flat = np.isfinite(healthy.pressure)  # nan: nothing but a tip corner touches
    assert flat.mean() > 0.8
    assert (healthy.pressure[flat] >= 1e6 * least[flat]).all()
    assert (healthy.pressure[flat] < 5e9).all()
    assert ((healthy.pressure > 0) == (healthy.force > 0))[flat].all()


def test_several_forces_give_a_list(healthy, steel):
    curves = curve_of(steel, force=[FORCE, 1.02 * FORCE, 8 * FORCE])
    assert [curve.meta["force_N"] for curve in curves] == [FORCE, 1.02 * FORCE, 8 * FORCE]
    assert_allclose(curves[2].k, curve_of(steel, force=8 * FORCE).k, rtol=1e-12)
    assert_allclose(curves[0].k, healthy.k, rtol=1e-12)
    between = 2 / (1 / curves[0].k_tangent + 1 / curves[1].k_tangent)
    assert_allclose(0.02 * FORCE / (curves[1].deflection - curves[0].deflection), between, rtol=3e-4)
    assert (curves[2].k > 1.02 * curves[0].k).all(), "the contact stiffens under load"
    assert (healthy.k_tangent > healthy.k).all()
    assert isinstance(curve_of(steel, force=[FORCE]), list)


@pytest.mark.slow
def test_auto_says_which_method_and_why(steel):
    def chosen(pair, **options):
        meta = curve_of(steel, pair=pair, phases=1, method="auto", **options).meta
        return meta["method"], meta["why"]

    spur = pair_of(8.0, beta=0.0)
    assert chosen(pair_of(8.0)) == ("ritz3d", "contact lines run across helical teeth")
    assert chosen(spur, damage={"pinion": [PIT]}) == ("ritz3d", "pits change along the width")
    assert chosen(spur) == ("ritz", "spur gears, nothing changes along the width: plane strain")
    with pytest.warns(UserWarning, match="no tooth with damage"):
        assert chosen(spur, damage={"wheel": [gf.Crack(level=0.3, tooth=9)]})[0] == "ritz"


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_a_pit_of_tooth_k_acts_on_pair_k(steel, gear):
    """Also one cycle earlier, because pair 1 is where pair 0 will be."""
    pit = PIT if gear == "pinion" else replace(PIT, radius=28.1)
    phases = np.array([-0.2, 0.0, 0.1])
    healthy = curve_of(steel, phases=phases)
    one = curve_of(steel, {gear: [replace(pit, tooth=1)]}, phases=phases)
    zero = curve_of(steel, {gear: [pit]}, phases=phases + 1)
    assert_allclose(one.k, zero.k, rtol=1e-9)
    assert (one.k < 0.9999 * healthy.k).any()
    own = {k: healthy.force[:, column] for column, k in enumerate(healthy.order)}
    away = {k: one.force[:, column] - own[k] for column, k in enumerate(one.order)}
    assert away[1].min() < -1.0, "the pitted pair gives load away"
    assert max(change.min() for k, change in away.items() if k != 1) > -1e-6 * FORCE, "and no other"


def test_herringbone_is_twice_a_half(healthy, steel):
    whole = curve_of(steel, pair=pair_of(18.5), force=2 * FORCE, face="herringbone", groove=2.5)
    assert_allclose(whole.k, 2 * healthy.k, rtol=1e-7)
    assert_allclose(whole.force, 2 * healthy.force, rtol=1e-6, atol=1e-6)
    assert (whole.meta["face"], whole.meta["groove"]) == ("herringbone", 2.5)
    assert_allclose(whole.pressure, healthy.pressure, rtol=1e-6)
    pit = replace(PIT, z=18.5 - PIT.z, tooth=1)
    run = {"pair": pair_of(18.5), "force": 2 * FORCE, "face": "herringbone", "groove": 2.5, "phases": 1}
    one, both = (curve_of(steel, {"pinion": pits}, **run).k for pits in ([pit], [pit, replace(pit, z=PIT.z)]))
    half = curve_of(steel, {"pinion": [replace(PIT, tooth=1)]}, phases=1).k
    assert_allclose(both, 2 * half, rtol=1e-7)
    assert both < 0.9999 * one
    assert one < 0.9999 * whole.k[0]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"face": "double"}, "face = 'double', but it must be one of spur, helical, herringbone"),
        ({"face": "spur"}, "face = 'spur', but the gears have a helix angle"),
        ({"groove": 2.0}, "groove = 2.0 mm, but only face = 'herringbone'"),
        ({"face": "herringbone", "groove": 8.0}, "groove = 8.0 mm, but it must lie between"),
        ({"face": "herringbone", "groove": -1.0}, "groove = -1.0, but give the width of the relief groove, 0 or more"),
        ({"face": "herringbone", "groove": math.nan}, "groove = nan, but it needs a number"),
        ({"method": "ritz", "face": "helical"}, "face = 'helical' with method = 'ritz'"),
        ({"method": "ritz", "groove": 2.0}, "groove = 2.0 mm with method = 'ritz'"),
        ({"method": "ritz", "damage": {"pinion": [PIT]}}, "pits with method = 'ritz'"),
        ({"method": "fe", "damage": {"pinion": [PIT]}}, "pits with method = 'fe'"),
        ({"teeth": 3}, "teeth = 3 with method = 'ritz3d'"),
        ({"force": -1.0}, "force = -1"),
    ],
)
def test_impossible_options_are_named(steel, options, message):
    with pytest.raises(ValueError, match=message):
        curve_of(steel, **options)


@pytest.mark.parametrize("degrees", [60.0, 75.0, -60.0])
def test_steep_helices_are_refused(degrees):
    with pytest.raises(ValueError, match="60 degrees and more are not supported"):
        pair_of(8.0, beta=math.radians(degrees))


def test_pits_over_the_whole_contact_line_name_the_phase(steel):
    pits = [replace(PIT, axes=(8.0, 20.0), tooth=k) for k in range(-1, 4)]
    with (
        pytest.warns(UserWarning, match=r"semi-axes 8 x 20 mm removes the whole flank of z = \d+: no flank is left to"),
        pytest.raises(RuntimeError, match=r"no contact at phase 0\.25: damage covers it all"),
    ):
        curve_of(steel, {"pinion": pits}, phases=np.array([0.25, 0.5]))


@pytest.mark.slow
def test_overlap_carries_pairs_whose_section_loses_contact(steel):
    """Contact ratio 0.999 at 45 degrees: solved as steadily as one of 1.001, refused where nothing knows of the width."""

    def pair(addendum, width=8.0):
        rack = RACK | {"b": width, "r_bore": 5.0, "addendum": addendum}
        return gf.GearPair(*(gf.Gear(z=z, beta=sign * math.radians(45), **rack) for z, sign in ((17, 1), (27, -1))))

    low, high = 0.5, 1.2
    while high - low > 1e-9:
        middle = (low + high) / 2
        low, high = (middle, high) if pair(middle).eps_alpha < 0.999 else (low, middle)
    less, more = pair(low), pair(low + 0.002)
    assert less.eps_alpha < 1 < more.eps_alpha
    assert_allclose(curve_of(steel, pair=less, phases=2).k, curve_of(steel, pair=more, phases=2).k, rtol=2e-3)
    for method in ("ritz", "fe", "textbook"):
        with pytest.raises(ValueError, match=r"contact ratio 0\.999 < 1 with method"):
            curve_of(steel, pair=less, method=method)
    with pytest.raises(ValueError, match=r"overlap .* < 1 at a"):
        pair(low, 0.002)
    with pytest.raises(ValueError, match=r"contact ratio 0\.999 < 1 with method = 'ritz3d'"):
        curve_of(steel, pair=less, face="herringbone", groove=7.999)
