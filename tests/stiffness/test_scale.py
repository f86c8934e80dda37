"""Meshes and cells know no millimetre: gears s times as large are s times as stiff under s**2 times the load."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.flexibility.finite_elements.fe_gear3d import MeshedGear, solid_flexibility

STEEL = gf.Material(206e3, 0.3)
PHASES = np.array([0.05, 0.3, 0.62, 0.9, 0.98])
SCALES = 0.25, 25.0  # a power of two, and one at which the last digits of all lengths change


def gear(s, z, *, b=8.0, bore=0.4, beta=0.0, **options):
    rack = {"m_n": 2.0 * s, "alpha_n": math.radians(20), "beta": math.radians(beta), "b": b * s}
    body = {"r_rim": (z + 10) * s} if options.pop("ring", False) else {"r_bore": bore * z * s}
    return gf.Gear(z=z, **rack, **body, **options)


def pair(s, beta=0.0, **options):
    return gf.GearPair(gear(s, 19, beta=beta, **options), gear(s, 31, beta=-beta, **options))


def ring(s, **options):
    options = {"rack_tip_radius": 0.3} | options  # what fits on the tip of the cutter
    return gf.GearPair(gear(s, 20, **options), gear(s, 62, ring=True, addendum=0.9, **options))


def undercut(s):
    gears = (gf.Gear(z=z, m_n=s, alpha_n=math.radians(20), beta=side * math.radians(8.2), b=15.68 * s, r_bore=bore * s, x=x)
             for z, side, bore, x in ((11, 1, 2.5, 0.0), (36, -1, 8.0, -0.23)))  # fmt: skip
    return gf.GearPair(*gears)


def flanks(s):
    one = gf.Flank(tip_relief=0.012 * s, tip_start_diameter=40.5 * s, tip_rounding=0.1 * s)
    return {"pinion": one, "wheel": gf.Flank(profile_crowning=0.005 * s, tip_chamfer=0.1 * s)}


def flanks_along(s):
    one, two = flanks(s).values()
    return {"pinion": replace(one, helix_crowning=0.006 * s), "wheel": replace(two, end_relief=0.01 * s, end_length=s)}


def crack(s, **options):
    return {"pinion": [gf.Crack(length=1.2 * s, **options)]}


def crack_and_pits(s):
    deep = gf.Pit(radius=19.2 * s, z=3 * s, axes=(0.6 * s, 0.9 * s), depth=0.2 * s)
    (runs_out,) = crack(s, width=(0.0, 6 * s), ends=(1.0, 0.0), rounded=True)["pinion"]
    return {"pinion": [deep, runs_out], "wheel": [replace(deep, radius=31 * s, z=5 * s, depth=0.004 * s)]}


def curve(s, method, make, options):
    made = {name: value(s) if callable(value) else value for name, value in options.items()}
    load = 100.0 * s * made.pop("b", 8.0 * s)
    return gf.mesh_stiffness(make(s), load, STEEL, method=method, phases=PHASES, cache=False, **made)


def alike(case, scales, *, rtol=1e-6):
    one = curve(1.0, *case)
    for s in scales:
        other = curve(s, *case)
        assert_allclose(other.k / s, one.k, rtol=rtol, err_msg=f"{s:g} times as large")
        assert_allclose(other.deflection / s, one.deflection, rtol=rtol)
        if one.unloaded is not None:
            assert_allclose(other.unloaded / s, one.unloaded, rtol=rtol, atol=rtol * np.ptp(one.te))
        if one.error is not None:
            assert_allclose(other.error / s, one.error, atol=1e-6 * one.k.max())


SECTIONS = {
    "energy": ("ritz", pair, {"error": True}),
    "energy, flanks": ("ritz", pair, {"flanks": flanks}),
    "finite elements, crack": ("fe", pair, {"damage": crack, "refine": 0.5}),
    "finite elements, ring": ("fe", ring, {}),
    "coupled beams": ("coupled", pair, {}),
    "textbook, crack": ("textbook", pair, {"damage": crack}),
    "herringbone_article, crack": ("herringbone_article", pair, {"damage": crack}),
}
SOLIDS = {
    "undercut": ("ritz3d", undercut, {}),
    "ring": ("ritz3d", ring, {}),
    "helical, flanks, crack and pits": ("ritz3d", lambda s: pair(s, 15.0), {"flanks": flanks_along, "damage": crack_and_pits}),
}


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow if "ring" in name else []) for name in SECTIONS])
def test_a_section_of_another_size_is_alike(name):
    alike(SECTIONS[name], SCALES)


@pytest.mark.slow
@pytest.mark.parametrize("name", SOLIDS)
def test_a_wide_pair_of_another_size_is_alike(name):
    alike(SOLIDS[name], SCALES)


@pytest.mark.slow
def test_hexahedra_of_another_size_are_alike():
    """What loads along the width do to each other on a helical gear with a sloping crack in half of its width."""

    def influences(s):
        small = gear(s, 9, b=2.0, beta=12.0, x=0.5)
        cracks = (gf.Crack(length=0.8 * s, width=(0.0, s), ends=(1.0, 0.6)),)
        run = {"degree": 3, "refine": 0.4}
        healthy = solid_flexibility(MeshedGear(small, **run), STEEL, cache=False)
        found = solid_flexibility(MeshedGear(small, cracks, **run), STEEL, healthy=healthy, cache=False)
        return found.near | found.far

    one, other = influences(1.0), influences(25.0)
    assert set(other) == set(one)
    for key, values in one.items():
        assert_allclose(other[key], values, atol=1e-6 * np.abs(values).max(), rtol=0, err_msg=str(key))


@pytest.mark.parametrize("s", SCALES)
def test_root_stress_of_a_gear_of_another_size_is_the_same(s):
    one, other = (gf.root_stress(gear(by, 19, b=2.0), 19.5 * by, 100.0 * by, STEEL) for by in (1.0, s))
    assert_allclose(other, one, rtol=1e-6)
