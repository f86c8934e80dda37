"""Identities any mesh stiffness must satisfy, and the fast path against the full contact problem."""

import math
from dataclasses import replace

import numpy as np
import pytest
from full_contact import full_contact
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.flexibility.finite_elements import fe

FORCE = 2000.0


@pytest.fixture(scope="module")
def curve(pair, steel):
    return gf.mesh_stiffness(pair, FORCE, steel)


def test_hats_have_unit_resultant_along_the_involute_normal(pair):
    mesh = fe.mesh_gear(pair.gear_1, read=range(1, 2))
    for tooth, rtol in ((0, 1e-6), (1, 1e-4)):  # tooth 1 is only read: four times longer edges
        hats = fe.hats(mesh, tooth)
        load = hats.load
        resultant = np.hypot(*[np.asarray(load[d::2].sum(axis=0)).ravel() for d in range(2)])
        first, _, last = np.sqrt(2 * hats.knots / pair.gear_1.r_b)  # the normal turns by the roll angle
        assert (resultant < 1 + 1e-9).all()
        assert (resultant > np.cos((last - first) / 2)).all()
        points = mesh.mesh.doflocs
        moment = points[0] @ load[1::2] - points[1] @ load[0::2]
        assert_allclose(moment, pair.gear_1.r_b, rtol=rtol, err_msg="the load line touches the base circle")


def test_shares_sum_to_one_and_forces_to_the_load(curve):
    assert_allclose(curve.share.sum(axis=1), 1, rtol=1e-12)
    assert_allclose(curve.force.sum(axis=1), FORCE, rtol=1e-12)
    assert (curve.force >= 0).all()
    assert_allclose(curve.k * curve.deflection, FORCE, rtol=1e-12)
    assert (curve.k_tangent > curve.k).all(), "the contact stiffens"


@pytest.mark.parametrize("extended", [False, True])
def test_swapping_the_gears_mirrors_the_curve(pair, steel, extended):
    phase = np.linspace(0.01, 0.99, 40)
    mirrored = gf.GearPair(pair.gear_2, pair.gear_1)
    one = gf.mesh_stiffness(pair, FORCE, steel, phases=phase, extended=extended)
    two = gf.mesh_stiffness(mirrored, FORCE, steel, phases=(pair.eps_alpha - phase) % 1, extended=extended)
    assert_allclose(two.k, one.k, rtol=1e-9)


def test_scaling_modulus_and_load_together_leaves_k_over_modulus(pair, steel, curve):
    soft = gf.Material(E=steel.E / 50, nu=steel.nu)
    assert_allclose(gf.mesh_stiffness(pair, FORCE / 50, soft).k, curve.k / 50, rtol=1e-9)


def test_no_locking(pair):
    with pytest.warns(UserWarning, match="softer than any gear"):
        rubber = gf.Material(E=10.0, nu=0.499)
    phase = np.linspace(0, 0.9, 7)
    coarse, fine = (gf.mesh_stiffness(pair, 1.0, rubber, phases=phase, refine=r).k for r in (1, 2.5))
    assert_allclose(coarse, fine, rtol=0.01)


def test_default_resolution_is_within_half_a_percent(pair, steel, curve):
    """Against twice the resolution here; against 160k unknowns per gear in validation/pages/speed.md."""
    fine = gf.mesh_stiffness(pair, FORCE, steel, refine=2)
    assert_allclose(curve.k, fine.k, rtol=2e-3)


@pytest.mark.parametrize(("line_load", "phase"), [(100.0, 0.75), pytest.param(300.0, 0.55, marks=pytest.mark.slow)])
def test_fast_path_equals_full_contact_inside_the_path(pair, steel, phase, line_load):
    fast = gf.mesh_stiffness(pair, line_load * 20.0, steel, phases=[phase])
    full = full_contact(pair, line_load, phase, (steel, steel))
    assert_allclose(fast.deflection[0] * 1e3, full.approach, rtol=2e-3)
    share = dict(zip(full.order, full.force / line_load, strict=True))
    assert_allclose(fast.share[0], [share[k] for k in fast.order], atol=2e-3)


@pytest.mark.slow
def test_corner_contact_is_within_one_percent_of_full_contact(pair, steel):
    fast = gf.mesh_stiffness(pair, 300.0 * 20.0, steel, phases=[0.62])
    full = full_contact(pair, 300.0, 0.62, (steel, steel), per_width=12)
    assert_allclose(fast.deflection[0] * 1e3, full.approach, rtol=0.01)


@pytest.mark.quick
def test_load_stiffens_the_single_pair_by_about_three_percent_per_doubling(pair, steel):
    low, high = gf.mesh_stiffness(pair, [1000.0, 2000.0], steel, phases=[0.8])
    assert 1.015 < high.k[0] / low.k[0] < 1.045


def test_bore_and_plane_state_matter(pair, steel, curve):
    wide = gf.GearPair(*(replace(g, r_bore=0.9 * g.r_f) for g in (pair.gear_1, pair.gear_2)))
    thin = gf.mesh_stiffness(wide, FORCE, steel)
    assert abs(thin.k.mean() / curve.k.mean() - 1) > 0.1
    stress = gf.mesh_stiffness(pair, FORCE, steel, state="plane stress")
    assert 0.90 < stress.k.mean() / curve.k.mean() < 0.98


def test_two_materials(pair, steel):
    polymer = gf.Material(E=3000.0, nu=0.4)
    mixed = gf.mesh_stiffness(pair, 50.0, (polymer, steel))
    both = gf.mesh_stiffness(pair, 50.0, polymer)
    assert (mixed.k > both.k).all()


def test_three_pairs():
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0, "addendum": 1.35, "dedendum": 1.6, "rack_tip_radius": 0.2}
    pair = gf.GearPair(gf.Gear(z=60, r_bore=30.0, **rack), gf.Gear(z=70, r_bore=30.0, **rack))
    assert 2 < pair.eps_alpha < 3
    curve = gf.mesh_stiffness(pair, FORCE, gf.Material(), phases=16)
    assert (curve.force > 0).sum(axis=1).max() == 3


@pytest.mark.parametrize("method", ["textbook", "herringbone_article"])
def test_energy_methods_are_plain_sums(pair, steel, method):
    light, heavy = gf.mesh_stiffness(pair, [1.0, 2e4], steel, method=method)
    assert_allclose(light.k, heavy.k, rtol=1e-12)
    assert_allclose(light.share.sum(axis=1), 1, rtol=1e-12)
    zones = light.zones()
    assert 1.5 < zones["double"] / zones["single"] < 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"force": 0.0}, "force = 0.0 N"),
        ({"method": "magic"}, "ritz, ritz3d, fe, fe3d, coupled, textbook, herringbone_article"),
        ({"phases": 0}, "phases = 0"),
        ({"phases": [[0.1]]}, "at least one finite phase"),
        ({"state": "plain"}, "plane strain"),
        ({"teeth": 0}, "teeth = 0"),
        ({"span": "year"}, "cycle"),
        ({"refine": 0.0}, "refine = 0.0"),
    ],
)
def test_bad_input(pair, steel, change, message):
    import gmsh

    with pytest.raises(ValueError, match=message):
        gf.mesh_stiffness(**({"pair": pair, "force": FORCE, "material": steel} | change))
    assert not gmsh.isInitialized()
