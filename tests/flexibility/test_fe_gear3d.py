"""Pairs of whole gears by hexahedra: against the energy model, damage of part of the width, halves, the cache, refusals."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.flexibility.finite_elements import fe3d, solver
from gearfe.flexibility.finite_elements.crack_zones import zone_forces
from gearfe.flexibility.finite_elements.fe_gear3d import MeshedGear, solid_flexibility
from gearfe.flexibility.solid import hats, solved_teeth
from gearfe.stiffness import cache

RACK = {"m_n": 2.0, "alpha_n": math.radians(20)}
GEAR = gf.Gear(z=12, x=0.3, b=4.0, r_bore=5.0, **RACK)
DEGREE = 3
COARSE = {"degree": DEGREE, "refine": 0.4}  # its section is quick and, by a few parts in a thousand, too stiff
SMALL = replace(GEAR, z=9, x=0.5, b=2.0, r_bore=4.0)


def test_only_the_teeth_that_share_load_are_solved():
    assert solved_teeth(GEAR, (), 2) == [0, 1, 2]
    assert solved_teeth(GEAR, (), 30) == list(range(12))
    assert solved_teeth(GEAR, (gf.Crack(level=0.3, tooth=3),), 1) == [1, 2, 3, 4, 5]
    assert solved_teeth(GEAR, (gf.Crack(level=0.3),), 1) == [0, 1, 2, 10, 11]


def pair_of(b=4.0, beta=0.2):
    rack = RACK | {"b": b}
    return gf.GearPair(gf.Gear(z=12, x=0.3, r_bore=5.0, beta=beta, **rack), gf.Gear(z=13, x=0.3, r_bore=5.0, beta=-beta, **rack))


def curve_of(steel, damage=None, pair=None, force=400.0, **options):
    return gf.mesh_stiffness(
        pair or pair_of(), force, steel, damage=damage, **({"method": "fe3d", "refine": 0.4, "phases": 4} | options)
    )


def test_both_gears_are_looked_at_before_the_first_is_solved(steel, monkeypatch):
    """The mate does not fit: that is said at once, not after the minutes of the first."""
    pair = pair_of()
    pair = gf.GearPair(pair.gear_1, replace(pair.gear_2, z=30, x=0.0, r_bore=20.0))
    small, large = (MeshedGear(gear, refine=0.4).plan().memory for gear in (pair.gear_1, pair.gear_2))
    assert small < large
    monkeypatch.setattr(solver, "free_memory", lambda: (small + large) / 2)
    monkeypatch.setattr(fe3d, "half_solved", lambda *given: pytest.fail("solved"))
    told = []
    with pytest.raises(RuntimeError, match=r"unknowns need about .* are free: coarsen the mesh"):
        curve_of(steel, pair=pair, tell=told.append, cache=False)
    assert not told


@pytest.mark.slow
def test_what_is_solved_is_no_work_ahead(steel, tmp_path, monkeypatch):
    """A cracked gear needs the sound one first; what is kept, in the process or on the disk, needs nothing."""
    monkeypatch.setenv("GEARFE_CACHE", str(tmp_path))
    cache.clear()
    run = {"neighbours": 1, **COARSE}
    sound, cracked = cache.unsolved(SMALL, steel, (gf.Crack(level=0.3),), **run).values()
    assert sound.unknowns < cracked.unknowns
    assert sound.seconds < cracked.seconds
    found = cache.solved_solid(SMALL, steel, **run)
    assert found.unknowns == sound.unknowns
    for _ in ("kept", "on the disk"):
        assert not cache.unsolved(SMALL, steel, **run)
        assert len(cache.unsolved(SMALL, steel, (gf.Crack(level=0.3),), **run)) == 1
        cache.clear()
    assert len(cache.unsolved(SMALL, steel, cache=False, **run)) == 1


@pytest.mark.slow
def test_the_curve_says_what_was_done(steel, tmp_path, monkeypatch):
    """Identities, what it tells, and that a second process finds the gears on the disk."""
    monkeypatch.setenv("GEARFE_CACHE", str(tmp_path))
    cache.clear()
    told = []
    curve = curve_of(steel, tell=told.append)
    assert [line.split(",")[0] for line in told] == ["2 solves", "z = 12", "z = 13"]
    assert all("unknowns, about" in line and "GB free" in line for line in told[1:])
    assert_allclose(curve.k * curve.deflection, 400.0, rtol=1e-12)
    assert_allclose(curve.force.sum(axis=1), 400.0, rtol=1e-9)
    assert curve.meta["method"] == "fe3d"
    assert curve.meta["face"] == "helical"
    assert len(curve.meta["dofs"]) == 2
    assert min(curve.meta["dofs"]) > 5000
    cache.clear()
    again = curve_of(steel, tell=told.append, force=[400.0, 800.0])
    assert len(told) == 3, "read from the disk, one solve for all loads"
    assert_allclose(again[0].k, curve.k, rtol=1e-12)
    assert (again[1].k > again[0].k).all()
    cache.clear()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"teeth": 3}, "teeth = 3 with method = 'fe3d'"),
        ({"variants": {"root": "prism"}}, "only textbook or herringbone_article have variants"),
        ({"refine": 0.0}, "refine = 0.0"),
        ({"face": "spur"}, "the gears have a helix angle"),
        ({"damage": {"pinion": [gf.Crack(level=0.3, width=(1.0, 4.5))]}}, "beyond the face, which ends at 4 mm"),
        ({"damage": {"pinion": [gf.Crack(level=0.3, width=w) for w in ((0, 1), (2, 4))]}}, "only one can be meshed"),
        ({"damage": {"pinion": [gf.Pit(radius=12.5, z=9.0, axes=(1.0, 1.0), depth=0.1)]}}, "pit at z = 9 mm"),
    ],
)
def test_impossible_options_are_named(steel, options, message):
    with pytest.raises(ValueError, match=message):
        curve_of(steel, **options)


@pytest.mark.slow
def test_a_mesh_too_coarse_for_its_patches_is_refused(steel):
    with pytest.raises(RuntimeError, match="too coarse for patches of degree 10 along the width"):
        solid_flexibility(MeshedGear(SMALL, refine=0.4, degree=12), steel)


@pytest.mark.slow
def test_degrees_the_layers_do_not_carry_are_dropped(steel):
    """The rest is what it would be without them, also of a cracked gear."""
    coarse = {"refine": 0.36}
    whole = solid_flexibility(MeshedGear(SMALL, degree=8, **coarse), steel)
    assert whole.degree == 6
    less = solid_flexibility(MeshedGear(SMALL, degree=6, **coarse), steel)
    assert_allclose(whole.near[0], less.near[0], rtol=1e-9, atol=1e-12 * np.abs(less.near[0]).max())
    cracked = solid_flexibility(MeshedGear(SMALL, (gf.Crack(level=0.3),), degree=8, **coarse), steel, healthy=whole)
    assert cracked.degree == 6
    assert cracked.near[0].shape == whole.near[0].shape


@pytest.mark.slow
def test_zones_of_crack_faces_keep_them_apart(steel):
    """Loads open a crack on their side and close the one behind; with closed faces the tooth is nearly a healthy one."""
    patches, size = fe3d.Patches((0,), hats(SMALL)[:, 5:6], 1), {"refine": 0.3, "per_hat": 2, "layer": 0.4}
    healthy = fe3d.influence(fe3d.mesh_patches(SMALL, patches, **size), steel, patches).matrix.item()
    for side, sign in (("loaded", 1), ("unloaded", -1)):
        mesh = fe3d.mesh_patches(SMALL, patches, cracks=(gf.Crack(level=0.4, side=side),), **size)
        found = fe3d.influence(mesh, steel, patches, zones=zone_forces(mesh))
        opening = found.opening[:, 0, 0, 0]
        assert (sign * opening > 0).all()
        assert np.linalg.eigvalsh(found.mutual)[0] > 0
        open_crack = found.matrix.item()
        assert open_crack > 1.3 * healthy
        if side == "unloaded":
            shut = open_crack - opening @ np.linalg.solve(found.mutual, opening)
            print("shut", shut / healthy, "open", open_crack / healthy)
            assert 0.99 * healthy < shut < healthy + 0.15 * (open_crack - healthy)
