"""Rows of pits along lines of a flank."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.geometry.damage.hollow import centre_arc
from gearfe.geometry.pair.lines import bands_of, covered
from gearfe.geometry.pair.pit_lines import pit_line

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 40.0}
SIZE = {"axes": (0.4, 0.4), "depth": 0.2}


def pairs(beta):
    sun, planet = (gf.Gear(z=z, r_bore=r, beta=beta, **RACK) for z, r in ((18, 8.0), (27, 12.0)))
    ring = gf.Gear(z=72, r_rim=87.0, addendum=0.86, rack_tip_radius=0.2, beta=beta, **RACK)
    return {"external": gf.GearPair(sun, replace(planet, b=50.0)), "ring": gf.GearPair(planet, ring)}


@pytest.mark.parametrize("beta", [0.28, -0.28])
@pytest.mark.parametrize("kind", ["external", "ring"])
@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("face", ["helical", "herringbone"])
def test_a_row_along_a_contact_line_lies_on_one(beta, kind, which, face):
    """One phase has the centres of all pits on the line of the pair; a row mirrored meets it in its middle pit only."""
    pair = pairs(beta)[kind]
    gear = (pair.gear_1, pair.gear_2)[which]
    radius = (pair.pitch_radius_1, pair.pitch_radius_1 * pair.gear_2.z / pair.gear_1.z)[which]
    run = {"radius": radius, "middle": gear.b / 2 - 9.0, "face": face, "axes": (0.1, 0.1), "depth": 0.2}
    shift = (gear.b - min(pair.gear_1.b, pair.gear_2.b)) / 2
    z = np.array(bands_of(pair, face, 0.0))
    rolls, counts = pair.curvature_radii(pair.pitch_phase), []
    # lines through the pitch point at the height of the middle pit; the pinion's roll falls from the end that touches first
    slope = -np.sign(z[:, 1] - z[:, 0]) * math.tan(abs(gear.beta_b))
    middle = np.array([run["middle"] - shift, gear.b - run["middle"] - shift][: len(z)])
    line = rolls[0] + slope[:, None] * (z - middle[:, None])
    for both, mirrored in ((False, False), (face == "herringbone", False), (False, True)):
        pits = [(), ()]
        pits[which] = pit_line(pair, which, "contact_line", 5, 1.5, both=both, mirrored=mirrored, **run)
        piece = covered(pair, pits, np.zeros(len(z), dtype=int), (line, pair.mate_roll(line)), z)[0]
        counts.append(np.bincount(piece, minlength=2).tolist()[: len(z)])
    assert counts == ([[5, 0], [5, 5], [1, 0]] if face == "herringbone" else [[5], [5], [1]])
    row = pit_line(pair, which, "contact_line", 5, 1.5, **run)
    own = np.array([(pit.z, math.sqrt(pit.radius**2 - gear.r_b**2)) for pit in row])
    assert_allclose(np.hypot(*np.diff(own, axis=0).T), 1.5, rtol=1e-12, err_msg="the pitch is counted along the line")


def test_rows_along_the_axis_and_up_the_profile():
    pair = pairs(0.28)["external"]
    run = {"radius": 18.7, "middle": 10.0, **SIZE}
    row = pit_line(pair, 0, "axis", 3, 2.0, **run)
    assert [pit.z for pit in row] == [8.0, 10.0, 12.0]
    assert {pit.radius for pit in row} == {18.7}
    row = pit_line(pair, 0, "profile", 4, 0.3, **run)
    assert_allclose(np.diff([centre_arc(pair.gear_1, pit) for pit in row]), 0.3, rtol=1e-12)
    assert {pit.z for pit in row} == {10.0}
    one = pit_line(pair, 0, "axis", 1, 0.0, both=True, face="herringbone", angle=0.3, **run)
    assert [(pit.z, pit.angle) for pit in one] == [(10.0, 0.3), (30.0, -0.3)]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"along": "tooth"}, "along = 'tooth', but pits lie along one of axis, contact_line, profile"),
        ({"count": 0}, "whole number from 1"),
        ({"pitch": 0.0}, "pitch = 0.0 mm"),
        ({"both": True}, "pits in both halves, but face = 'helical': only herringbone"),
        ({"mirrored": True}, "only a row along a contact line can be inclined"),
        ({"along": "contact_line", "pitch": 11.0}, "a row of 3 pits over 22 mm along the contact line leaves the flank"),
        ({"along": "contact_line", "middle": 21.0, "face": "herringbone"}, "or its half of the width"),
        ({"along": "contact_line", "radius": 10.0}, "contact lines of z = 18 lie beyond"),
        ({"along": "contact_line", "middle": 47.0}, "the teeth of z = 18 have no contact there"),
    ],
)
def test_rows_that_cannot_be_are_refused(change, message):
    run = {"along": "axis", "count": 3, "pitch": 2.0, "radius": 18.7, "middle": 10.0, **SIZE} | change
    along, count, pitch = (run.pop(name) for name in ("along", "count", "pitch"))
    with pytest.raises(ValueError, match=message):
        pit_line(pairs(0.28)["external"], 0, along, count, pitch, **run)
