"""The half-space's kernels against independent integrals and the plane."""

import math
from itertools import pairwise

import numpy as np
import pytest
from checks import line_kernel
from numpy.polynomial.legendre import leggauss
from numpy.testing import assert_allclose

from gearfe.flexibility import halfspace

pytestmark = pytest.mark.quick


def hats_apart(knots, others, u):
    """Integral over s of hat(s) hat'(s - u) for every u, piecewise quadratic."""

    def hat(s, start, top, stop):
        return 2 / (stop - start) * np.maximum(np.minimum((s - start) / (top - start), (stop - s) / (stop - top)), 0.0)

    cuts = np.clip(np.hstack([knots + 0 * u[:, None], others + u[:, None]]), knots[0], knots[2])
    cuts = np.sort(cuts, axis=1)[..., None]
    gauss, weight = leggauss(3)
    s = (cuts[:, :-1] + cuts[:, 1:]) / 2 + np.diff(cuts, axis=1) / 2 * gauss
    return (np.diff(cuts, axis=1) / 2 * weight * hat(s, *knots) * hat(s - u[:, None, None], *others)).sum(axis=(1, 2))


def panels(ends, longest, count):
    """Gauss points and weights on the panels between `ends`, cut to at most `longest`."""
    gauss, weight = leggauss(count)
    ends = np.concatenate([np.linspace(a, b, math.ceil((b - a) / longest) + 1)[:-1] for a, b in pairwise(ends)] + [ends[-1:]])
    half = np.diff(ends)[:, None] / 2
    return ((ends[:-1] + ends[1:])[:, None] / 2 + half * gauss).ravel(), (half * weight).ravel()


@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_patch_kernel_equals_its_integral(slope):
    """The same mean over differences t = z - z' (in ln t) and u = s - s' (in arsinh, which takes up 1 / R)."""
    knots = np.array([[0.0, 0.3, 0.7], [0.5, 1.0, 1.1], [1.2, 1.6, 1.9]]).T
    width, stretch = 5.0, 1.1
    got = halfspace.patch_kernel(knots, width, 3, np.full((3, 3), slope), stretch)
    gauss, weight = leggauss(6)
    for (i, a), (j, b) in [((0, 0), (0, 0)), ((0, 1), (1, 2)), ((2, 3), (0, 3)), ((1, 2), (1, 1))][: 4 if slope else 2]:
        one, two = knots[:, i], knots[:, j]
        kinks = np.unique(np.subtract.outer(one, two))
        want = 0.0
        logs, steps = panels(np.log([1e-9, 0.3, 1.5, width]), 0.7, 8)
        for t, step in zip(np.exp(logs), np.exp(logs) * steps, strict=True):
            for signed in (t, -t):
                low, high = max(0.0, signed), min(width, width + signed)
                z = (low + high) / 2 + (high - low) / 2 * gauss
                both = halfspace.modes(z, width, 3)[:, a] * halfspace.modes(z - signed, width, 3)[:, b]
                x, dx = panels(np.arcsinh((kinks - slope * signed) / (stretch * t)), 1.0, 8)
                across = hats_apart(one, two, slope * signed + stretch * t * np.sinh(x)) @ dx
                want += step * (high - low) / 2 * (weight @ both) * across
        assert_allclose(got[i, a, j, b], want, rtol=1e-6, atol=1e-7 * got[i, 0, i, 0])


def test_far_and_near_kernels_agree():
    knots = np.array([[0.0, 0.3, 0.7], [0.5, 1.0, 1.1]]).T
    c = halfspace.FAR * 0.7 * np.array([1 - 1e-9, 1 + 1e-9])
    near, far = np.moveaxis(halfspace.hat_distance(knots, np.full((2, 2, 2), 0.4), c), 2, 0)
    assert_allclose(near, far, rtol=1e-7)


def test_long_line_is_the_plane_law():
    """Displacement in the middle of an even line load: ``2 ln(2 L) + 2 (ln(2 / a) + 1/2)``, L its half length."""
    a, reach = 0.05, 400.0
    for count in (2001, 801):
        edge = np.linspace(-reach, reach, count + 1)
        kernel = line_kernel(edge[:-1], edge[1:], halfspace.strip(np.full(count, a)))
        got = (kernel @ np.diff(edge))[count // 2]
        assert_allclose(got, 2 * math.log(2 * reach) + 2 * (math.log(2 / a) + 0.5), rtol=1e-6)
