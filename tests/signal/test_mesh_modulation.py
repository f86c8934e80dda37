"""Modulations of a mesh line that are known come back; fault frequencies of bearings."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf

pytestmark = pytest.mark.quick
TURN = 2 * np.pi * np.arange(2048) / 2048


@pytest.mark.parametrize("harmonic", [1, 2])
def test_amplitude_and_phase_come_back(harmonic):
    teeth = 25
    loud = 1 + 0.3 * np.cos(TURN + 0.7) + 0.1 * np.sin(3 * TURN)
    late = 0.05 * np.sin(2 * TURN) - 0.02 * np.cos(TURN)
    wave = 3 * loud * np.cos(harmonic * teeth * TURN + late + 0.4) + np.cos(TURN) + 0.5 * np.cos((3 - harmonic) * teeth * TURN)
    found = gf.mesh_modulation(wave, teeth, harmonic=harmonic)
    assert_allclose(found.amplitude, 3 * loud, atol=1e-5)
    assert_allclose(found.phase, late, atol=1e-5)


def test_a_tooth_that_is_softer_shows_where_it_meshes():
    dip = np.exp(-0.5 * ((TURN - 2.0) / 0.15) ** 2)
    found = gf.mesh_modulation((1 - 0.4 * dip) * np.cos(32 * TURN - 0.3 * dip), 32)
    assert abs(TURN[np.argmin(found.amplitude)] - 2.0) < 0.02
    assert abs(TURN[np.argmin(found.phase)] - 2.0) < 0.02


def test_averages_without_such_a_line_are_refused():
    for given, said in (
        ({"average": np.cos(24 * TURN), "teeth": 25}, "no mesh line of order 25"),
        ({"average": np.cos(24 * TURN[:40]), "teeth": 24}, "take more samples per turn"),
        ({"average": np.cos(24 * TURN), "teeth": 24, "sidebands": 24}, "fewer sidebands"),
        ({"average": np.cos(24 * TURN), "teeth": 24, "harmonic": 0}, "harmonic = 0"),
        ({"average": [1.0, np.nan] * 100, "teeth": 24}, "average: sample 1 is nan"),
    ):
        with pytest.raises(ValueError, match=said):
            gf.mesh_modulation(**given)


def test_bearings():
    one = gf.bearing_lines(30.0, 8, 10.0, 50.0, 0.3, count=2)
    assert_allclose(one["outer"] + one["inner"], 8 * 30.0, rtol=1e-12)  # of every roller, both rings
    assert_allclose(one["outer"], 8 * one["cage"], rtol=1e-12)  # the outer ring stands
    assert_allclose(one["2 roller"], 2 * one["roller"])
    assert_allclose(one["roller"], 2 * 50.0 / 10.0 * one["outer"] * one["inner"] / (8**2 * 30.0), rtol=1e-12)
    assert [*gf.bearing_lines(30.0, 8, 10.0, 50.0, 0.3)] == [*one][:4] == ["cage", "outer", "inner", "roller"]
    both = gf.bearing_lines(30.0, 8, 10.0, 50.0, 0.3, outer=10.0)
    assert_allclose(both["inner"], one["inner"] * 20 / 30, rtol=1e-12)
    assert_allclose(both["cage"], 10.0 + (one["cage"]) * 20 / 30, rtol=1e-12)  # seen from the outer ring, and its turns
    hub = gf.bearing_lines(0.0, 8, 10.0, 50.0, 0.3, outer=20.0)
    assert_allclose(hub["cage"], 20.0 - one["cage"] * 20 / 30, rtol=1e-12)  # both rings by 20 Hz back: the outer ring stands
    for given, said in (
        ((30.0, 30, 10.0, 50.0), "rollers fit on the pitch diameter"),
        ((30.0, 8, 60.0, 50.0), "rollers fit on the pitch diameter"),
        ((30.0, 8, 10.0, 50.0, 2.0), "contact_angle = 2.0"),
        ((0.0, 8, 10.0, 50.0), "outer = 0.0 Hz with an inner ring of 0.0 Hz"),
        ((-1.0, 8, 10.0, 50.0), "turns = -1.0"),
    ):
        with pytest.raises(ValueError, match=said):
            gf.bearing_lines(*given)
    with pytest.raises(ValueError, match=r"outer = 30\.0 Hz"):
        gf.bearing_lines(30.0, 8, 10.0, 50.0, outer=30.0)
