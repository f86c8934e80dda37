"""Decks of pairs in three dimensions where an undercut flank touches with the edge below it: faces, nodes, the slave."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.decks.solid_deck import sides_of
from gearfe.geometry.tooth.profile import arc_at
from gearfe.geometry.tooth.side import place

APPROACH, LOAD = 0.03, 600.0  # mm, N/mm


def written(tmp_path, z, phase, damage=None, **more):
    rack, beta = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 4.0}, math.radians(10)
    pair = gf.GearPair(gf.Gear(z=z, r_bore=3.0, beta=beta, **rack), gf.Gear(z=30, r_bore=18.0, beta=-beta, **rack))
    run = {"face": "helical", "per_width": 0.7, "layers": 1, "damage": damage} | more
    return pair, gf.write_contact_inp(tmp_path / "p.inp", pair, phase, APPROACH, LOAD, (STEEL, STEEL), **run)


def turned_back(gear, part, nodes, tooth):
    """Radius [mm] and angle [rad] from the centre-line of a tooth, in the section at z = 0."""
    x, y, z = part.points[:, nodes]
    angle = np.arctan2(x, y) - gear.twist_rate * z - 2 * math.pi * tooth / gear.z
    return np.hypot(x, y), angle


@pytest.mark.parametrize("cracked", [False, True])
def test_the_gear_that_owns_the_edge_is_the_slave_with_its_fillet(tmp_path, cracked):
    pair, deck = written(tmp_path, 10, 0.0, {"pinion": [gf.Crack(level=0.3)]} if cracked else None)
    gear, part = pair.gear_1, deck.parts[0]
    side, faces = deck.slaves[0]
    assert side == 0
    assert sides_of(part.cells, faces).shape[1] == faces.shape[1], "every face is one of a cell"
    radius, angle = turned_back(gear, part, np.unique(faces), 0)
    assert_allclose(radius.max(), gear.r_a, rtol=1e-9)
    assert radius.min() < gear.r_form - 0.2
    below = (radius < gear.r_form * (1 - 1e-9)) & (radius > gear.r_f * (1 + 1e-9))
    found = place(gear, radius[below])
    angle = angle[below] - np.median(angle[below] - found.angle)  # where the gear stands
    assert_allclose(angle, found.angle, atol=2e-5)
    arcs = np.unique(np.round(arc_at(gear, place(gear, radius).roll), 4))
    beside = np.abs(arcs - arc_at(gear, gear.roll_f)) < 0.25
    assert np.diff(arcs[beside]).max() < 1.6 * np.diff(arcs[beside]).min(), "the fillet is as fine as the flank"


@pytest.mark.slow
def test_without_an_edge_that_touches_flanks_alone_are_pressed(tmp_path):
    for z, phase in ((10, 0.5), (25, 0.5)):
        pair, deck = written(tmp_path, z, phase, per_width=0.3)
        for order, (side, faces) in deck.slaves.items():
            gear = (pair.gear_1, pair.gear_2)[side]
            x, y = deck.parts[side].points[:2, np.unique(faces)] - [[0.0], [(0.0, pair.centre_2)[side]]]
            assert np.hypot(x, y).min() > gear.r_form - 1e-6, (z, order)
