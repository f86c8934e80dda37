"""Cracked gears of a set, beside finite elements of the whole gear with its crack, held or on pads."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sets import STEEL, case, gears, unequal
from test_rim import pads_ends

import gearfe as gf
from gearfe.flexibility.finite_elements.elasticity import Body
from gearfe.flexibility.finite_elements.solver import factor
from gearfe.geometry.mesh import section_mesh
from gearfe.geometry.mesh.both_flanks import _marked
from gearfe.geometry.mesh.outline import stations
from gearfe.geometry.mesh.periodic_sector import periodic_sector
from gearfe.geometry.mesh.section_mesh import section
from gearfe.geometry.tooth.profile import cartesian, flank, flank_normal
from gearfe.planetary_sets.cracked import cracked, cracks_of
from gearfe.planetary_sets.rim import rim_angles, rim_moved, ring_on
from gearfe.planetary_sets.rim_supports import RimBed, RimSupports
from gearfe.planetary_sets.solve import bodies_of, planetary_stiffness
from gearfe.planetary_sets.whole_gear import PLACES, between_teeth, carry, sector_stiffness, whole_gear

RING = gears().planet_ring.gear_2
SUN = gears().sun
GEARS = [SUN, pytest.param(RING, marks=pytest.mark.slow)]
BOTH = (gf.Crack(level=0.4), gf.Crack(level=0.3, side="unloaded", tooth=2))


def direct(gear, cracks, teeth, monkeypatch, support=None):
    """Displacements of unit loads on `teeth` with the edge held; of a ring on pads also these, and nodes of its rim moved."""
    ends = pads_ends(gear, support)[0] if support else [0.0]
    monkeypatch.setattr(section_mesh, "held_circle", lambda gear: _marked(gear, ends, 0.01, 0.4))
    roll = (gear.roll_f + gear.roll_a) / 2
    rolls = stations(gear, 0.3)
    rolls[np.argmin(abs(rolls - roll))] = roll
    mesh = section(gear, dict.fromkeys(teeth, rolls), fillet_size=0.15, size=0.5, far_size=0.8, cracks=cracks).mesh
    stiffness, places = Body(mesh, STEEL).stiffness(), mesh.doflocs
    load = np.zeros((stiffness.shape[0], len(teeth)))
    for k, tooth in enumerate(teeth):
        turn = 2 * math.pi * tooth / gear.z
        radius, angle = flank(gear, roll)
        at = np.abs(places - cartesian(radius, angle + turn)[:, None]).max(axis=0).argmin()
        x, y = -flank_normal(gear, roll)
        load[2 * at, k], load[2 * at + 1, k] = math.cos(turn) * x + math.sin(turn) * y, math.cos(turn) * y - math.sin(turn) * x
    edge = np.flatnonzero(np.abs(np.hypot(*places) - gear.held) < 1e-9 * gear.held)
    angle, out, moved = np.arctan2(*places[:, edge]), [], np.zeros(load.shape)
    for nodes in (edge, *([edge[support.covers(gear, places[:, edge])]] if support else [])):
        free = np.setdiff1d(np.arange(stiffness.shape[0]), [2 * nodes, 2 * nodes + 1])
        moved[:] = 0.0
        moved[free] = factor(stiffness[free][:, free])(load[free])
        out.append(load.T @ moved)
    return out, angle, moved.reshape(-1, 2, len(teeth))[edge]


def ours(gear, table, teeth):
    row = carry(gear, np.array([(gear.roll_f + gear.roll_a) / 2]))[0]
    at = np.ix_(teeth, range(PLACES), teeth, range(PLACES))
    return np.einsum("a,taub,b->tu", row, table[at], row)


@pytest.mark.parametrize("gear", GEARS, ids=["sun", "ring"])
def test_other_teeth_of_a_cracked_gear_yield_as_by_direct_finite_elements(gear, monkeypatch):
    """From the cracked tooth and past it; a crack on either side."""
    teeth = (0, 1, 3, gear.z - 1)
    whole = whole_gear(gear, STEEL)
    found = cracked(cracks_of(whole, BOTH, 1.0), whole.held_inverse()).table
    (want,), _, _ = direct(gear, BOTH, teeth, monkeypatch)
    plain = ours(gear, between_teeth(whole.held()), teeth)
    got, away = ours(gear, found, teeth), ~np.eye(4, dtype=bool)
    assert_allclose(got[away], want[away], atol=2e-3 * abs(want[away]).max())
    assert abs(plain - want)[away].max() > 0.05 * abs(want[away]).max()


@pytest.mark.slow
@pytest.mark.parametrize(("rim", "level"), [(95.0, 0.7), (91.0, 0.4)])
def test_a_cracked_ring_on_pads_is_that_of_direct_finite_elements(rim, level, monkeypatch):
    """What the pads let it give way, and how its rim moves under a load on the cracked tooth."""
    gear, support, teeth = gears(rim=rim).planet_ring.gear_2, RimSupports(6, 4.8, first=0.03), (0, 1, 28, 83)
    crack = (gf.Crack(level=level),)
    (held, free), angle, moved = direct(gear, crack, teeth, monkeypatch, support)
    whole = whole_gear(gear, STEEL)
    made, plain = (ring_on(whole, support, 20.0, one) for one in (cracks_of(whole, crack, 1.0), None))
    want = free - held
    assert_allclose(ours(gear, made.more, teeth), want, atol=3e-3 * abs(want).max())
    assert abs(ours(gear, plain.more, teeth) - want).max() > 0.05 * abs(want).max()
    loads = np.zeros((gear.z, PLACES))
    loads[0] = carry(gear, np.array([(gear.roll_f + gear.roll_a) / 2]))[0]
    tractions, motion = (np.einsum("pta,ta->p", values, loads) for values in (made.reaction, made.moves))
    got = rim_moved(made, loads, tractions, motion)
    sin, cos = np.sin(angle), np.cos(angle)
    x, y = moved[:, 0, 0], moved[:, 1, 0]
    _, middle, reach = pads_ends(gear, support)
    clear = np.abs((angle[:, None] - middle + math.pi) % (2 * math.pi) - math.pi).min(axis=1) - reach > 1.0 / gear.r_rim
    for k, beside in enumerate((sin * x + cos * y, cos * x - sin * y)):
        own = np.interp(angle, rim_angles(whole) % (2 * math.pi), got[:, k], period=2 * math.pi)
        assert_allclose(own[clear], beside[clear], atol=6e-3 * abs(beside).max())


def test_a_sector_without_cracks_is_the_periodic_one():
    for gear in (SUN, RING):
        whole = whole_gear(gear, STEEL)
        found = cracks_of(whole, (gf.Crack(level=0.4),), 1.0)
        plain = sector_stiffness(periodic_sector(gear, ()), STEEL)[0]
        nothing = found._replace(softer=np.zeros_like(found.softer), loads=np.zeros_like(found.loads))
        assert plain.shape[0] == found.softer.shape[1]
        table = cracked(nothing, whole.held_inverse()).table[1:, :PLACES, 1:, :PLACES]
        want = between_teeth(whole.held())[1:, :, 1:]
        assert_allclose(table, want, atol=1e-12 * abs(want).max())


def test_kinds_of_rings_with_cracks_are_symmetric_and_agree_when_stiff():
    whole = whole_gear(RING, STEEL)
    found, n = cracks_of(whole, BOTH, 1.0), 84 * PLACES
    for support in (RimBed(1e3, 1e3), RimSupports(5, 5.0), RimSupports(6, 5.0, radial=0, tangential=1e5)):
        more = ring_on(whole, support, 20.0, found).more.reshape(n, n)
        assert_allclose(more, more.T, atol=1e-9 * abs(more).max())
    soft, stiff = (abs(ring_on(whole, RimBed(k, k), 20.0, found).more).max() for k in (1e3, 1e12))
    assert stiff < 1e-6 * soft


@pytest.mark.parametrize("ring", [RimSupports(6, 4.8), RimSupports(6, 4.8, radial=0, tangential=1e5, pushes=True)])
def test_sets_with_a_cracked_ring(ring):
    """The mesh that loads the cracked tooth gives way more, all is in balance, and the other planets take what it leaves."""
    plain, hurt = (planetary_stiffness(case(ring=ring, damage=one), [0.3]) for one in (None, {"ring": [gf.Crack(level=0.5)]}))
    assert_allclose(hurt.force[0].sum(), 3 * 2000.0, rtol=1e-10)
    more = 2000.0 / hurt.k[1, 0, 0] - 2000.0 / plain.k[1, 0, 0]  # of the crack, whatever the ring stands on
    assert more > 0.05 * 2000.0 / plain.k_alone[1, 0, 0]
    assert hurt.force[1, 0, 0] < plain.force[1, 0, 0]
    assert hurt.force[1, 0, 1:].min() > plain.force[1, 0, 1:].min()


def test_a_cracked_planet_is_that_planet_alone():
    given = unequal(0, 30, 71, damage={("planet", 1): [gf.Crack(level=0.5, tooth=3)]})
    made = bodies_of(given)
    assert list(made.planets) == [1]
    plain = made.planet
    apart = np.array([[made.planets[1][t, :, u] - plain[(t - u) % 31] for u in range(31)] for t in range(31)])
    assert abs(apart[3]).max() > 0.05 * abs(plain).max()
    others = np.delete(np.delete(apart, 3, axis=0), 3, axis=1)
    assert abs(others).max() < 0.2 * abs(apart).max()
