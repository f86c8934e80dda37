"""Random pitch deviations keep the tolerances of their class."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.geometry.tooth.pitch import pitch_tolerances

GEAR = gf.Gear(z=35, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=20.0)


@pytest.mark.parametrize("seed", range(20))
def test_one_tolerance_is_used_up_and_the_other_kept(seed):
    places = np.array(gf.random_pitch(GEAR, 7, seed))
    most, total = pitch_tolerances(GEAR, 7)
    parts = np.abs(np.diff(places, append=places[0])).max() / most, np.ptp(places) / total
    assert max(parts) == pytest.approx(1)
    assert min(parts) > 0.2
    assert_allclose(places.mean(), 0, atol=1e-15)
    assert gf.random_pitch(GEAR, 7, seed) == tuple(places.tolist())
    assert_allclose(gf.random_pitch(GEAR, 9, seed), 2 * places)  # two classes are a factor of two


def test_tolerances_by_hand():
    """Class 5, d = 100 mm, m_n = 2 mm: 0.1 + 0.8 + 5 = 5.9 um and 0.2 + 5.5 + 1.4 + 12 = 19.1 um; class 7 is twice that."""
    gear = gf.Gear(z=50, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=20.0)
    assert_allclose(pitch_tolerances(gear, 5), [5.9e-3, 19.1e-3], rtol=1e-12)
    assert_allclose(pitch_tolerances(gear, 7), [11.8e-3, 38.2e-3], rtol=1e-12)


def test_what_is_no_class_is_refused():
    for given in (0, 12, 6.5, "6", True):
        with pytest.raises(ValueError, match=r"classes 1 to 11|iso_class = .*whole number"):
            gf.random_pitch(GEAR, given, 1)
    with pytest.raises(ValueError, match=r"equal seeds give equal deviations|seed = .*whole number"):
        gf.random_pitch(GEAR, 6, 1.5)
