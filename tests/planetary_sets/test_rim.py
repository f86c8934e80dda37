"""The ring on what holds its rim, beside finite elements of the whole ring (scikit-fem's own forms, pads' nodes fixed)."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.sparse.linalg import splu
from sets import STEEL, gears
from skfem import Basis, ElementTriP2, ElementVector, asm
from skfem.models.elasticity import lame_parameters, linear_elasticity

from gearfe.geometry.mesh.both_flanks import both_flanks
from gearfe.geometry.mesh.outline import stations
from gearfe.geometry.tooth.profile import cartesian, flank, flank_normal
from gearfe.planetary_sets.rim import rim_angles, rim_moved, ring_on
from gearfe.planetary_sets.rim_supports import RimBed, RimSupports
from gearfe.planetary_sets.whole_gear import PLACES, between_teeth, carry, whole_gear

TEETH = (0, 7, 28, 43)
NEAR = 1.0  # mm beside a pad, where the picture of the rim is spread over some edges


def ring(rim=95.0):
    return gears(rim=rim).planet_ring.gear_2


def pads_ends(gear, support):
    middle = support.first + 2 * math.pi / support.count * np.arange(support.count)
    reach = support.width / (2 * gear.r_rim)
    return np.concatenate([middle - reach, middle + reach]), middle, reach


def direct(gear, support, roll):
    """Displacement of unit loads under each other with the pads alone held, less that with the whole rim held; and the rim's."""
    rolls = stations(gear, 0.3)
    rolls[np.argmin(abs(rolls - roll))] = roll
    ends, middle, reach = pads_ends(gear, support)
    made = both_flanks(
        gear,
        {(tooth, 0): rolls for tooth in TEETH},
        fillet_size=0.2,
        size=0.5,
        far_size=1.0,
        marks=ends,
        mark_size=0.001,
        held_size=0.4,
    )
    basis = Basis(made.mesh, ElementVector(ElementTriP2()), intorder=4)
    stiffness = asm(linear_elasticity(*lame_parameters(STEEL.E, STEEL.nu)), basis).tocsc()
    places, load = basis.doflocs, np.zeros((stiffness.shape[0], len(TEETH)))
    for k, tooth in enumerate(TEETH):
        turn = 2 * math.pi * tooth / gear.z
        radius, angle = flank(gear, roll)
        at = np.flatnonzero(np.abs(places - cartesian(radius, angle + turn)[:, None]).max(axis=0) < 1e-9)
        x, y = -flank_normal(gear, roll)
        load[at, k] = math.cos(turn) * x + math.sin(turn) * y, math.cos(turn) * y - math.sin(turn) * x
    edge = basis.get_dofs("held").flatten()
    away = np.abs((np.arctan2(*places[:, edge])[:, None] - middle + math.pi) % (2 * math.pi) - math.pi).min(axis=1)
    out = []
    for fixed in (edge, edge[away < reach + 1e-9]):
        free = np.setdiff1d(np.arange(stiffness.shape[0]), fixed)
        factor = splu(stiffness[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                      options={"SymmetricMode": True})  # fmt: skip
        moved = np.zeros(load.shape)
        moved[free] = factor.solve(load[free])
        out.append(load.T @ moved)
    return out[1] - out[0], (np.arctan2(*places[:, edge[::2]]), moved[edge].reshape(-1, 2, len(TEETH)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rim", "support"),
    [(95.0, RimSupports(6, 4.8, first=0.01)), (91.0, RimSupports(3, 12.0, first=0.1)), (95.0, RimSupports(12, 9.0, first=1.0))],
)
def test_released_ring_is_that_of_direct_finite_elements(rim, support):
    gear = ring(rim)
    roll = (gear.roll_f + gear.roll_a) / 2
    want, (angle, moved) = direct(gear, support, roll)
    made, rows = ring_on(whole_gear(gear, STEEL), support, 20.0), carry(gear, np.array([roll]))[0]
    at = np.ix_(TEETH, range(PLACES), TEETH, range(PLACES))
    found = np.einsum("a,tauc,c->tu", rows, made.more[at], rows)
    assert_allclose(found, want, atol=2e-3 * abs(want).max())
    loads = np.zeros((gear.z, PLACES))
    loads[TEETH[1]] = rows
    tractions, whole = (np.einsum("pta,ta->p", values, loads) for values in (made.reaction, made.moves))
    _, middle, reach = pads_ends(gear, support)
    away = np.abs((angle[:, None] - middle + math.pi) % (2 * math.pi) - math.pi).min(axis=1) - reach
    clear = away > NEAR / gear.r_rim
    own, ours = rim_angles(made.whole) % (2 * math.pi), rim_moved(made, loads, tractions, whole)
    sin, cos = np.sin(angle), np.cos(angle)
    x, y = moved[:, 0, 1], moved[:, 1, 1]
    for values, beside in ((ours[:, 0], sin * x + cos * y), (ours[:, 1], cos * x - sin * y)):
        got = np.interp(angle, own, values, period=2 * math.pi)
        assert_allclose(got[clear], beside[clear], atol=5e-3 * abs(beside).max())


def test_pads_carry_what_the_teeth_are_given():
    gear = ring()
    made = ring_on(whole_gear(gear, STEEL), RimSupports(5, 6.0, first=0.3), 20.0)
    rng = np.random.default_rng(1)
    loads = rng.random((gear.z, PLACES))
    tractions = np.einsum("pta,ta->p", made.reaction, loads)
    lugs = ring_on(whole_gear(gear, STEEL), RimSupports(3, 6.0, radial=0, pushes=True), 20.0)
    given = np.einsum("mta,ta->m", lugs.gives, loads)
    rest = made.pads.turns @ tractions + given
    assert_allclose(rest, 0, atol=1e-10 * abs(given).max())


@pytest.mark.slow
def test_stiff_springs_hold():
    """Beds and springs of pads so stiff that they are rigid; pads that leave no gap hold the rim."""
    whole = whole_gear(ring(), STEEL)
    held = between_teeth(whole.held())
    assert abs(ring_on(whole, RimBed(1e12, 1e12), 20.0).more).max() < 1e-6 * abs(held).max()
    rigid, stiff = (ring_on(whole, RimSupports(6, 4.8, **k), 20.0).more for k in ({}, {"radial": 1e13, "tangential": 1e13}))
    assert_allclose(stiff, rigid, atol=1e-6 * abs(rigid).max())
    few, many = (abs(ring_on(whole, RimSupports(*n), 20.0).more).max() for n in ((6, 4.8), (42, 14.1)))
    assert many < 0.02 * few


def test_springs_in_series():
    """One load in the middle between pads on soft springs: the ring moves as a body, each pad's spring takes its part."""
    whole = whole_gear(ring(), STEEL)
    k, width, n = 10.0, 20.0, 6
    soft, rigid = (ring_on(whole, RimSupports(n, 4.8, **o), width) for o in ({"radial": k, "tangential": k}, {}))
    load = np.zeros((84, PLACES))
    load[[0, 28, 56], 4] = 1.0  # a torque alone
    moved = [float(np.einsum("ta,taub,ub->", load, one.more, load)) for one in (soft, rigid)]
    turn = (3 * ring().r_b / ring().r_rim) ** 2 / (n * k / width)
    assert_allclose(moved[0] - moved[1], turn, rtol=2e-4)


def test_all_kinds_are_symmetric_and_add():
    whole = whole_gear(ring(), STEEL)
    n = 84 * PLACES
    for support in (RimBed(1e4, 1e4), RimSupports(4, 5.0), RimSupports(7, 5.0, radial=0)):
        more = ring_on(whole, support, 20.0).more.reshape(n, n)
        assert_allclose(more, more.T, atol=1e-12 * abs(more).max())
        assert np.linalg.eigvalsh(more).min() > -1e-4 * abs(more).max()
    assert not ring_on(whole, "held", 20.0).more.any()


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: RimSupports(0, 5.0), "a ring needs a support"),
        (lambda: RimSupports(3, 0.0), "give the arc of the rim that a pad holds"),
        (lambda: RimSupports(3, 5.0, tangential=0), "nothing supports the ring's torque"),
        (lambda: RimSupports(2, 5.0, radial=0), "these do not support"),
        (lambda: RimSupports(3, 5.0, pushes=True), "give radial = 0"),
        (lambda: RimBed(1e3, 0.0), "give a finite number > 0"),
        (lambda: RimBed(math.inf, 1.0), "ring = 'held'"),
        (lambda: ring_on(whole_gear(ring(), STEEL), RimSupports(90, 7.0), 20.0), "longer than its rim"),
        (lambda: ring_on(whole_gear(ring(), STEEL), None, 20.0), "a ring needs a support"),
    ],
)
def test_what_holds_no_ring_is_refused(build, message):
    with pytest.raises(ValueError, match=message):
        build()
