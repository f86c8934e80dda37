"""Contacts that move along the flanks to where they yield less, and crack faces that overlap."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import RACK

import gearfe as gf
from gearfe.contact import closed_cracks
from gearfe.contact.sliding import moved_contacts, sliding
from gearfe.contact.unknowns import OVERLAP, overlaps
from gearfe.geometry.pair.contacts import contacts
from gearfe.geometry.tooth.profile import arc_at


def softer_upwards(gear, change):
    """Flexibility that grows by so much per length of the flank, whichever tooth."""
    return SimpleNamespace(gear=gear, matrix=lambda roll, teeth: change * arc_at(gear, roll)[..., None])


@pytest.mark.parametrize("changes", [(3e-6, 0.0), (0.0, 3e-6), (3e-6, 3e-6), (3e-6, -1e-6)])
def test_contacts_slide_to_where_both_flanks_yield_less(changes):
    """Up the pinion is down the wheel: the pair changes by the difference, and what is gained is P S' x + x**2 / (2 R)."""
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK))
    found = contacts(pair, [0.2, 0.7], extended=False)
    bodies = [softer_upwards(gear, change) for gear, change in zip((pair.gear_1, pair.gear_2), changes, strict=True)]
    values = {"found": found, "flexibility": bodies, "radius": found.radius}
    contact = SimpleNamespace(pair=pair, opening_at=lambda *_: None, stiffness=None, **values)
    contact.moved = moved_contacts(contact)
    load, along, radius = 100.0, changes[0] - changes[1], found.radius
    moved = -radius * load * along / 2
    gained = -(load * along * moved + moved**2 / (2 * radius))
    got = sliding(contact) * load**2
    there = np.isfinite(found.gap)
    assert there.sum() >= 3
    assert_allclose(got[there], gained[there], rtol=1e-9, atol=1e-15)
    assert (got[~there] == 0).all()


def test_faces_that_overlap_anywhere_are_closing():
    slight = -0.5 * OVERLAP
    for opening, closes in (
        ([1.0, 0.5, 0.1], False),
        ([1.0, 0.5, -0.1], True),
        ([-1.0, -0.5, -0.1], True),
        ([1.0, slight], False),
    ):
        assert overlaps(np.array([opening])).tolist() == [closes]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:no tooth with damage")
@pytest.mark.parametrize("method", ["ritz", "fe"])
def test_contacts_slide_as_well_where_crack_faces_touch(method):
    """A crack of 0.5 % of the thickness changes nothing where its faces touch. Contacts that do not slide lose 0.18 % here."""
    rack = {"m_n": 1.0, "alpha_n": math.radians(25), "b": 1.0, "rack_tip_radius": 0.15}
    ring = gf.Gear(z=75, addendum=0.8, r_rim=42.9, **rack)
    pair = gf.GearPair(gf.Gear(z=39, x=0.4, r_bore=7.9, **rack), ring)
    crack = gf.Crack(level=0.005, start="60deg", tooth=2)
    case = pair, 38.0, gf.Material(E=207e3, nu=0.3)
    sound, cracked = (
        gf.mesh_stiffness(*case, method=method, phases=[1.22], damage=damage) for damage in (None, {"wheel": [crack]})
    )
    assert cracked.meta["crack_closed_phases"] == [1.22]
    assert_allclose(cracked.k, sound.k, rtol=2e-4)


def test_closed_faces_have_one_solution_by_two_ways(monkeypatch):
    """Joined faces of all phases at once, and one contact problem of contacts and faces for each phase."""
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK))
    damage = {"pinion": [gf.Crack(level=0.5, angle=math.radians(63))]}
    case = gf.Case(pair, 2000.0, gf.Material(E=207e3, nu=0.25), damage=damage)
    how = gf.Solve(method="ritz", phases=np.arange(-24, 40) / 16, error=False)
    at_once = gf.solve(case, how)
    monkeypatch.setattr(closed_cracks, "STEPS", 0)
    one_by_one = gf.solve(case, how)
    assert len(at_once.meta["crack_closed_phases"]) >= 5
    np.testing.assert_allclose(one_by_one.k, at_once.k, rtol=1e-9)
    np.testing.assert_allclose(one_by_one.k_tangent, at_once.k_tangent, rtol=1e-9)
