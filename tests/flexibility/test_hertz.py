import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import xlogy

import gearfe as gf
from gearfe.flexibility import hertz
from gearfe.flexibility.halfspace import hat_points
from gearfe.flexibility.hats import hat_knots, wider
from gearfe.flexibility.hertz import hat_logarithm

pytestmark = pytest.mark.quick


@pytest.mark.parametrize("apart", [0.0, 0.7, 3.0])
def test_hat_logarithm_equals_its_integral(apart):
    """By brute force: the density of the distance of two hats, sampled finely, against the log integrated exactly."""
    one, two = np.array([0.0, 0.4, 1.0]), np.array([0.0, 0.3, 0.8]) + apart
    edges = np.linspace(0, 1, 4001)

    def density(knots):
        x = knots[0] + (knots[2] - knots[0]) * (edges[1:] + edges[:-1]) / 2
        return x, np.interp(x, knots, [0, 1, 0]) / np.interp(x, knots, [0, 1, 0]).sum()

    (x, p), (y, q) = density(one), density(two)
    width = (two[2] - two[0]) / 4000
    want = 0.0
    for start in range(0, 4000, 500):
        d = x[start : start + 500, None] - y[None, :]
        low, high = d - width / 2, d + width / 2
        mean_log = (xlogy(high, np.abs(high)) - high - xlogy(low, np.abs(low)) + low) / width  # over each cell of y
        want -= p[start : start + 500] @ mean_log @ q
    assert_allclose(hat_logarithm(one[:, None], two[:, None])[0, 0], want, rtol=1e-6, atol=1e-7)


@pytest.mark.parametrize("apart", [29.0, 31.0, 60.0])
def test_hats_that_are_uneven_on_either_side_of_where_the_series_begins(apart):
    """By Gauss points, which are exact as good as: the logarithm is smooth that far away."""
    one, two = np.array([[0.0], [0.3], [1.0]]), np.array([[0.0], [0.7], [0.9]]) + apart
    (x, p), (y, q) = ((points[0], weight[0]) for points, weight in (hat_points(one, 6), hat_points(two, 6)))
    want = -p @ np.log(np.abs(x[:, None] - y)) @ q
    assert_allclose(hat_logarithm(one, two)[0, 0], want, atol=2e-7)


def test_hertz_pressure_carries_the_load():
    modulus = hertz.contact_modulus((gf.Material(), gf.Material()))
    a, p = hertz.half_width(100.0, 5.0, modulus), hertz.peak_pressure(100.0, 5.0, modulus)
    assert_allclose(np.pi / 2 * a * p, 100.0, rtol=1e-12)


def test_linear_hertz_of_equal_materials():
    steel = gf.Material(E=206e3, nu=0.3)
    assert_allclose(1 / hertz.linear_hertz((steel, steel)), np.pi * 206e3 / (4 * (1 - 0.09)), rtol=1e-12)


def test_hats_twice_as_wide_are_sums_of_hats():
    """Their logarithm from the weights is that of their own knots, on uneven edges too."""
    arc = np.cumsum(1.1 ** np.arange(21))
    knots = hat_knots(arc)
    top = np.concatenate([[arc[0]], knots[1], [arc[-1]]])
    inner = np.arange(2, top.size - 2)
    wide = np.array([top[inner - 2], top[inner], top[inner + 2]])
    weights = wider(knots)[1:-1]
    assert_allclose(weights @ hat_logarithm(knots, knots) @ weights.T, hat_logarithm(wide, wide), rtol=1e-9)
    assert_allclose(weights @ knots.mean(axis=0), wide.mean(axis=0), rtol=1e-12)
