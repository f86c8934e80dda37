"""Kinks of modified flanks: how far the flank turns there, and rows as long as what is pressed."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.contact import kink_law
from gearfe.contact.kinks import _nearest, kink_rows, near_kink
from gearfe.contact.pair_contact import PairContact
from gearfe.contact.sharing import share
from gearfe.flexibility.energy.ritz.plane import flexibility
from gearfe.geometry.pair.flanks import flank_forms
from gearfe.geometry.tooth.profile import arc_at, cartesian, flank

RACK = {"m_n": 3.0, "alpha_n": math.radians(20), "b": 20.0}
PAIR = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **RACK), gf.Gear(z=36, r_bore=20.0, **RACK))
RING = gf.Gear(z=72, r_rim=125.0, addendum=0.85, rack_tip_radius=0.2, **RACK)


def _left(points):
    """Angle by which a line through three points turns to its left."""
    (x, u), (y, v) = np.diff(points)
    return math.asin((x * v - y * u) / (math.hypot(x, y) * math.hypot(u, v)))


@pytest.mark.parametrize("wheel", [PAIR.gear_2, RING], ids=["external", "ring"])
def test_a_relief_turns_the_flank_outwards(wheel):
    """Against the tangents of the flank's points just before and after the kink: convex is positive, on both gears."""
    pair = gf.GearPair(PAIR.gear_1, wheel)
    gears = pair.gear_1, pair.gear_2
    flanks = [gf.Flank(tip_relief=0.005, tip_start_roll=gear.roll_a - gear.outward * 4.0) for gear in gears]
    forms = flank_forms(pair, dict(zip(("pinion", "wheel"), flanks, strict=True)))
    contact = PairContact.__new__(PairContact)
    contact.pair, contact.flanks = pair, forms
    rolls = np.array([[gear.roll_f, gear.roll_a - gear.outward * 4.1] for gear in gears])  # one touch near each gear's kink
    contact.found = SimpleNamespace(roll_1=rolls[0, ::-1, None], roll_2=rolls[1, :, None])
    hosts, _, kinks, slopes = _nearest(contact, np.array([0, 1]), np.array([0, 0]))
    assert hosts.tolist() == [0, 1]
    for gear, form, kink, slope in zip(gears, forms, kinks, slopes, strict=True):
        start = gear.roll_a - gear.outward * 4.0
        assert_allclose(kink, arc_at(gear, start))
        roll = start + 1e-3 * gear.outward * np.array([-1.0, 0.0, 1.0])
        radius, angle = flank(gear, roll)
        left = [_left(cartesian(radius, angle - removed)) for removed in (form.removed(roll) / gear.r_b, 0.0)]
        assert_allclose(slope, gear.outward * (left[0] - left[1]), rtol=2e-3)


def test_rows_at_small_roundings_are_as_long_as_what_is_pressed():
    """The load of the flank would press far more than the rounding's start does: hats are as short as Hertz's contact on it."""
    steel, load = gf.Material(E=207e3, nu=0.3), 50.0
    forms = flank_forms(PAIR, {name: gf.Flank(tip_rounding=0.02) for name in ("pinion", "wheel")})
    bodies = [flexibility(gear, steel) for gear in (PAIR.gear_1, PAIR.gear_2)]
    contact = PairContact(PAIR, (steel, steel), bodies, np.arange(32) / 32, extended=True, state="plane strain", flanks=forms)
    rows = kink_rows(contact, np.argwhere(near_kink(contact, load) & (contact.found.gap < 0.01)), load)
    assert rows
    for row in rows.values():
        pressed = np.flatnonzero(share(row.influence, row.gap, load)[0] > 0)
        assert pressed.size >= 24  # 11 to 17 with hats as long as beside the rounding


def test_what_a_kink_adds_in_three_dimensions_is_that_of_its_own_flank(monkeypatch):
    """Where it is the nearer kink, one of the mate that hardly bends changes nothing; nor does another size."""
    monkeypatch.setattr(kink_law, "LOADS", np.array([0.3, 1.0]))
    monkeypatch.setattr(kink_law, "PLACES", 3)

    def table(s, **more):
        rack = {"m_n": 3.0 * s, "alpha_n": math.radians(20), "b": 20.0 * s}
        pair = gf.GearPair(gf.Gear(z=24, r_bore=15.0 * s, **rack), gf.Gear(z=36, r_bore=20.0 * s, **rack))
        made = {"wheel": gf.Flank(tip_chamfer=0.2 * s)} | {side: gf.Flank(**own) for side, own in more.items()}
        law = kink_law.KinkLaw(pair, (gf.Material(), gf.Material()), 200.0 * s, flank_forms(pair, made))
        at, unit, _, (spline, least, most) = law.zones[-1]
        return at + 1.9 * unit * math.sqrt(most), spline(np.log([least, most]), np.linspace(-1, 1, 6))

    beside, alone = table(1.0)
    assert np.abs(alone).max() < 1.6, "beside the logarithm of a strip, 5 to 8; where contact is on the ridge, 1.5"
    relief = {"root_relief": 1e-9, "root_start_roll": beside}
    assert_allclose(table(1.0, pinion=relief)[1][:, :4], alone[:, :4], atol=0.005)
    assert_allclose(table(25.0)[1], alone, atol=1e-5)
    assert np.ptp(alone) > 0.1


@pytest.mark.slow
def test_pinion_and_wheel_exchanged_where_a_chamfer_carries():
    """Lines of a helical pair touch the ridge far off the path: the same whichever gear is called pinion, law and gaps."""
    rack = {"m_n": 6.0, "alpha_n": math.radians(20), "b": 39.163, "beta": math.radians(15)}
    gears, flank = (
        (gf.Gear(z=18, x=0.1643, r_bore=16.2, **rack), gf.Gear(z=28, x=-0.1535, r_bore=25.2, **rack)),
        gf.Flank(tip_chamfer=0.534),
    )
    materials, phase = (gf.Material(E=207e3, nu=0.27), gf.Material(E=110e3, nu=0.33)), np.array([0.0, 0.99])
    pair, other = gf.GearPair(*gears), gf.GearPair(*gears[::-1])
    one = gf.mesh_stiffness(pair, 17526.0, materials, method="ritz3d", phases=phase, flanks={"pinion": flank})
    last = pair.eps_alpha + abs(pair.eps_beta)
    two = gf.mesh_stiffness(other, 17526.0, materials[::-1], method="ritz3d", phases=last - phase, flanks={"wheel": flank})
    assert_allclose(two.k, one.k, rtol=1e-7)
