"""A missing tooth: the body without it, the gap to its neighbours' tip corners, and what refuses it."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import PAIR_17_38 as PAIR

import gearfe as gf
from gearfe.contact.pair_contact import PairContact
from gearfe.flexibility.energy.ritz import plane

STEEL = gf.Material(E=206e3, nu=0.3)
FORCE = 1669.3
PHASES = np.array([-0.1, 0.3, 0.625, 0.6875, 0.84, 0.9375, 1.3])


def case(side="pinion", tooth=0):
    return gf.Case(PAIR, FORCE, STEEL, damage={side: [gf.MissingTooth(tooth=tooth)]})


@pytest.mark.quick
def test_both_methods_agree_and_neighbours_are_softer():
    """On the path within the estimates, and far within what a gap off the path may change; neighbours lose some 0.15 %."""
    ritz, fe = (gf.solve(case(), gf.Solve(method, PHASES, error=True)) for method in ("ritz", "fe"))
    assert (abs(ritz.k - fe.k) <= ritz.error + fe.error).all()
    assert_allclose(ritz.k, fe.k, rtol=3e-3)
    healthy = gf.solve(case().healthy, gf.Solve("ritz", PHASES))
    assert 1e-3 < 1 - ritz.k[0] / healthy.k[0] < 2e-3
    assert 0 not in ritz.order
    assert ritz.unloaded[4] > 1e-4  # m
    assert_allclose(ritz.te, ritz.unloaded + ritz.deflection, rtol=1e-12)
    assert_allclose(ritz.k * ritz.deflection, FORCE, rtol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("side", ["pinion", "wheel"])
def test_whole_outlines_pressed_together_agree(side, monkeypatch):
    """The independent solver shares gears, material and the definition of the phase, and nothing of contact and elements.

    A tooth that is drawn but idle is stiffer than one that is absent, by the same amount in both.
    """
    from validation.shared.arbiter import pressing

    gone = [(0,), ()] if side == "pinion" else [(), (0,)]
    want = pressing.pressed(PAIR, None, FORCE / 15, PHASES, (206e3, 0.3), missing=gone)
    got = gf.solve(case(side), gf.Solve("ritz", PHASES, error=True))
    k = 15e3 * want.k
    assert (abs(got.k - k) <= got.error + 15e3 * want.error).all()
    assert_allclose(got.k, k, rtol=5e-3)
    assert_allclose(1e3 * got.unloaded, want.least, atol=1e-6)
    body = pressing.MeshedBody
    monkeypatch.setattr(pressing, "MeshedBody", lambda *args, missing, **options: body(*args, **options))
    idle = pressing.pressed(PAIR, None, FORCE / 15, PHASES[:2], (206e3, 0.3), missing=gone)
    bodies = [plane.flexibility(gear, STEEL) for gear in (PAIR.gear_1, PAIR.gear_2)]
    number = ("pinion", "wheel").index(side)
    bodies[number] = replace(bodies[number], missing=(0,))
    drawn = PairContact(PAIR, (STEEL, STEEL), bodies, PHASES[:2], extended=True, state="plane strain").solve(FORCE / 15)
    ours, theirs = FORCE / drawn.closing * 1e3 / got.k[:2] - 1, idle.k / want.k[:2] - 1
    print(ours, theirs)
    assert_allclose(ours, theirs, rtol=0.2)
    assert (ours > 5e-4).all()


def test_what_does_not_model_it_refuses_it():
    for method in ("textbook", "herringbone_article", "coupled"):
        with pytest.raises(ValueError, match=r"missing tooth|damage with"):
            gf.solve(case(), gf.Solve(method, 4))
    with pytest.raises(ValueError, match="at some phases only a missing tooth"):
        gf.solve(case(), gf.Solve("ritz", [0.84], extended=False))
    with pytest.raises(ValueError, match="only one of two adjacent"):
        gf.Case(PAIR, FORCE, STEEL, damage={"pinion": [gf.MissingTooth(), gf.MissingTooth(tooth=16)]})
    for side in ("pinion", "wheel"):
        with pytest.raises(ValueError, match=r"^tooth 3 of .* is missing and has a crack"):
            gf.Case(PAIR, FORCE, STEEL, damage={side: [gf.MissingTooth(tooth=3), gf.Crack(level=0.3, tooth=3)]})
        with pytest.raises(ValueError, match=r"^teeth 4 and 5 of"):
            gf.Case(PAIR, FORCE, STEEL, damage={side: [gf.MissingTooth(tooth=5), gf.MissingTooth(tooth=4)]})
    with pytest.raises(ValueError, match="tetrahedra have no missing tooth"):
        gf.export_mesh("x.vtu", PAIR.gear_1, [gf.MissingTooth()], cells="tetrahedra")
    with pytest.raises(ValueError, match="whole number"):
        gf.MissingTooth(tooth=0.5)
