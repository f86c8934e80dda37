"""Cracked gears of a set, beside finite elements of the whole gear with its crack, held or on pads."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import nnls
from sets import STEEL, case, gears
from test_rim import pads_ends

import gearfe as gf
from gearfe.flexibility.finite_elements.elasticity import HeldSection
from gearfe.flexibility.finite_elements.fe import face_columns
from gearfe.flexibility.finite_elements.solver import factor
from gearfe.geometry.mesh import section_mesh
from gearfe.geometry.mesh.both_flanks import _marked
from gearfe.geometry.mesh.outline import stations
from gearfe.geometry.mesh.section_mesh import section
from gearfe.geometry.tooth.profile import cartesian, flank, flank_normal
from gearfe.planetary_sets.cracked import cracked_teeth, faces_of
from gearfe.planetary_sets.rim import rim_angles, rim_moved, ring_faces, ring_on
from gearfe.planetary_sets.rim_supports import RimSupports
from gearfe.planetary_sets.solve import planetary_stiffness
from gearfe.planetary_sets.whole_gear import PLACES, between_teeth, carry, whole_gear

RING = gears().planet_ring.gear_2
SUN = gears().sun
GEARS = [SUN, pytest.param(RING, marks=pytest.mark.slow)]
BOTH = (gf.Crack(level=0.4), gf.Crack(level=0.3, side="unloaded", tooth=2))


def direct(gear, cracks, teeth, monkeypatch, support=None, broken=()):
    """Displacements of unit loads on `teeth`, faces free and in contact, edge held and on pads; nodes of its rim moved there."""
    ends = pads_ends(gear, support)[0] if support else [0.0]
    monkeypatch.setattr(section_mesh, "held_circle", lambda gear: _marked(gear, ends, 0.01, 0.4))
    roll = (gear.roll_f + gear.roll_a) / 2
    rolls = stations(gear, 0.3)
    rolls[np.argmin(abs(rolls - roll))] = roll
    made = section(gear, dict.fromkeys(teeth, rolls), fillet_size=0.15, size=0.5, far_size=0.8, cracks=cracks, broken=broken)
    stiffness, places = HeldSection(made.mesh, STEEL).stiffness(), made.mesh.doflocs
    load, count = np.zeros((stiffness.shape[0], len(teeth))), len(teeth)
    for k, tooth in enumerate(teeth):
        turn = 2 * math.pi * tooth / gear.z
        radius, angle = flank(gear, roll)
        at = np.abs(places - cartesian(radius, angle + turn)[:, None]).max(axis=0).argmin()
        x, y = -flank_normal(gear, roll)
        load[2 * at, k], load[2 * at + 1, k] = math.cos(turn) * x + math.sin(turn) * y, math.cos(turn) * y - math.sin(turn) * x
    load = np.hstack([load, face_columns(made).toarray()]) if cracks else load
    edge = np.flatnonzero(np.abs(np.hypot(*places) - gear.held) < 1e-9 * gear.held)
    angle, out, moved = np.arctan2(*places[:, edge]), [], np.zeros(load.shape)
    for nodes in (edge, *([edge[support.covers(gear, places[:, edge])]] if support else [])):
        free = np.setdiff1d(np.arange(stiffness.shape[0]), [2 * nodes, 2 * nodes + 1])
        moved[:] = 0.0
        moved[free] = factor(stiffness[free][:, free])(load[free])
        found = load.T @ moved
        out.append((found[:count, :count], in_contact(found[:count, :count], found[count:, :count], found[count:, count:])))
    return out, angle, moved[:, :count].reshape(-1, 2, count)[edge]


def in_contact(free, opening, ease):
    """Displacements under each load alone ``(n, n)`` if faces with openings ``(m, n)`` and `ease` ``(m, m)`` do not overlap."""
    if not ease.size:
        return free
    upper = cholesky(ease)
    pushed = [nnls(upper, -solve_triangular(upper, column, trans="T"))[0] for column in opening.T]
    return free + opening.T @ np.array(pushed).T


def ours(gear, table, teeth):
    row = carry(gear, np.array([(gear.roll_f + gear.roll_a) / 2]))[0]
    at = np.ix_(teeth, range(PLACES), teeth, range(PLACES))
    return np.einsum("a,taub,b->tu", row, table[at], row)


def with_faces(gear, healthy, faces, teeth):
    """`ours` with the faces of cracks free, and in contact."""
    row = carry(gear, np.array([(gear.roll_f + gear.roll_a) / 2]))[0]
    pushed, ease = faces.by_teeth[:, teeth, :PLACES] @ row, np.linalg.inv(faces.stiffness)
    opened, touch = ease @ pushed, faces.touch
    free = ours(gear, healthy, teeth) + pushed.T @ opened
    return free, in_contact(free, opened[touch], ease[np.ix_(touch, touch)])


@pytest.mark.slow
@pytest.mark.parametrize("gear", GEARS, ids=["sun", "ring"])
def test_other_teeth_of_a_cracked_gear_yield_as_by_direct_finite_elements(gear, monkeypatch):
    """From the cracked tooth and past it; a crack on either side, its faces free and in contact."""
    teeth = (0, 1, 3, gear.z - 1)
    whole = whole_gear(gear, STEEL)
    faces = faces_of(whole, cracked_teeth(whole, BOTH, 1.0), whole.held_inverse())
    (want,), _, _ = direct(gear, BOTH, teeth, monkeypatch)
    plain, away = ours(gear, between_teeth(whole.held()), teeth), ~np.eye(4, dtype=bool)
    for got, beside in zip(with_faces(gear, between_teeth(whole.held()), faces, teeth), want, strict=True):
        assert_allclose(got[away], beside[away], atol=2e-3 * abs(beside[away]).max())
        assert abs(plain - beside)[away].max() > 0.05 * abs(beside[away]).max()


@pytest.mark.slow
@pytest.mark.parametrize(("rim", "level"), [(95.0, 0.7), (91.0, 0.4)])
def test_a_cracked_ring_on_pads_is_that_of_direct_finite_elements(rim, level, monkeypatch):
    """What the pads let it give way, faces free and in contact, and how its rim moves under a load on the cracked tooth."""
    gear, support, teeth = gears(rim=rim).planet_ring.gear_2, RimSupports(6, 4.8, first=0.03), (0, 1, 3, 28, 83)
    crack = (gf.Crack(level=level),)
    (held, loose), angle, moved = direct(gear, crack, teeth, monkeypatch, support)
    whole = whole_gear(gear, STEEL)
    cracked, made = cracked_teeth(whole, crack, 1.0), ring_on(whole, support, 20.0)
    faces = ring_faces(made, support, cracked)
    on_pads = with_faces(gear, made.more, faces, teeth)
    all_round = with_faces(gear, 0 * made.more, faces_of(whole, cracked, whole.held_inverse()), teeth)
    for got, less, on, by in zip(on_pads, all_round, loose, held, strict=True):
        assert_allclose(got - less, on - by, atol=3e-3 * abs(on - by).max())
    shut = abs(on_pads[0] - on_pads[1])
    assert shut.max() > 0.02 * abs(on_pads[0]).max()
    loads = np.zeros((gear.z, PLACES))
    loads[0] = carry(gear, np.array([(gear.roll_f + gear.roll_a) / 2]))[0]
    opened = np.linalg.solve(faces.stiffness, np.einsum("eta,ta->e", faces.by_teeth, loads))
    gripped = made.grip @ (faces.pads @ opened)
    tractions, motion = (np.einsum("pta,ta->p", values, loads) for values in (made.reaction, made.moves))
    got = rim_moved(made, loads, tractions + gripped[:-3], motion + gripped[-3:]) + (faces.edge @ opened).reshape(-1, 2)
    sin, cos = np.sin(angle), np.cos(angle)
    x, y = moved[:, 0, 0], moved[:, 1, 0]
    _, middle, reach = pads_ends(gear, support)
    clear = np.abs((angle[:, None] - middle + math.pi) % (2 * math.pi) - math.pi).min(axis=1) - reach > 1.0 / gear.r_rim
    for k, beside in enumerate((sin * x + cos * y, cos * x - sin * y)):
        own = np.interp(angle, rim_angles(whole) % (2 * math.pi), got[:, k], period=2 * math.pi)
        assert_allclose(own[clear], beside[clear], atol=6e-3 * abs(beside).max())


@pytest.mark.parametrize(
    "ring",
    [pytest.param(RimSupports(6, 4.8), marks=pytest.mark.slow), RimSupports(6, 4.8, radial=0, tangential=1e5, pushes=True)],
)
def test_sets_with_a_cracked_ring(ring):
    """The mesh that loads the cracked tooth gives way more, all is in balance, and the other planets take what it leaves."""
    plain, hurt = (
        planetary_stiffness(case(ring=ring, damage=one), [0.3]) for one in (None, {"ring": [gf.Crack(level=0.5, start="root")]})
    )
    assert_allclose(hurt.force[0].sum(), 3 * 2000.0, rtol=1e-10)
    more = 2000.0 / hurt.k[1, 0, 0] - 2000.0 / plain.k[1, 0, 0]  # of the crack, whatever the ring stands on
    assert more > 0.05 * 2000.0 / plain.k_alone[1, 0, 0]
    assert hurt.force[1, 0, 0] < plain.force[1, 0, 0]
    assert hurt.force[1, 0, 1:].min() > plain.force[1, 0, 1:].min()
