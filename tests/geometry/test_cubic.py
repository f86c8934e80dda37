"""Splines against those of scipy."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import CubicSpline, RectBivariateSpline

from gearfe.geometry.cubic import Bicubic, Cubic, through

RANDOM = np.random.default_rng(4)


@pytest.mark.parametrize("shape", [(), (3,), (2, 3), (0,)])
@pytest.mark.parametrize("n", [4, 5, 48])
def test_a_spline_and_its_slope_are_those_of_scipy_also_beyond_the_ends(n, shape):
    x = np.cumsum(RANDOM.uniform(0.2, 1.0, n))
    y, at = RANDOM.normal(size=(n, *shape)), np.linspace(x[0] - 0.5, x[-1] + 0.5, 42).reshape(6, 7)
    made, want = Cubic(x, y), CubicSpline(x, y)
    for order in (0, 1):
        assert_allclose(made(at, order), want(at, order), rtol=1e-9, atol=1e-9 * np.abs(want(at, order)).max(initial=0))
    assert made(x[1]).shape == shape


def test_a_surface_is_that_of_scipy_also_beyond_its_edges():
    x, y = (np.cumsum(RANDOM.uniform(0.2, 1.0, n)) for n in (7, 12))
    values = RANDOM.normal(size=(x.size, y.size))
    made, want = Bicubic(through(x), values, through(y)), RectBivariateSpline(x, y, values)
    u, v = (np.linspace(one[0] - 0.3, one[-1] + 0.3, 30) for one in (x, y))
    assert_allclose(made.ev(u, v[::-1]), want.ev(u, v[::-1]), atol=1e-11)
    assert_allclose(made(u, v), want(u, v), atol=1e-11)
