"""Identities of a stiffness curve: what it derives from its columns."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import gearfe as gf
from gearfe.stiffness.curve import joined

pytestmark = pytest.mark.quick
LOAD, PHASES = 2000.0, 16


@pytest.fixture(scope="module")
def curve(pair, steel):
    return gf.mesh_stiffness(pair, LOAD, steel, phases=PHASES, error=True)


def test_between_its_phases_it_is_linear_and_periodic(curve):
    between = (np.arange(PHASES) + 0.25) / PHASES
    assert_allclose(curve(curve.phase - 3.0), curve.k, rtol=1e-12)
    assert_allclose(curve(between), 0.75 * curve.k + 0.25 * np.roll(curve.k, -1), rtol=1e-12)
    half = replace(curve, phase=curve.phase / 2)
    assert_array_equal(half(half.phase), half.k)
    for phase in (-0.01, 0.5):
        with pytest.raises(ValueError, match="not a whole mesh cycle"):
            half([0.1, phase])


def test_zones_and_their_errors_are_means_over_the_phases_of_the_zone(curve, pair):
    double = curve.phase <= pair.eps_alpha - 1
    zones, errors = curve.zones(), curve.zone_errors()
    want = {"double": curve.k[double].mean(), "single": curve.k[~double].mean(), "mean": curve.k.mean(), "max": curve.k.max()}
    assert zones == pytest.approx(want)
    assert errors["single"] == pytest.approx(curve.error[~double].mean() / want["single"])
    assert errors["max"] == pytest.approx(curve.error[curve.k.argmax()] / want["max"])
    assert replace(curve, error=None).zone_errors() == {}
    assert_allclose(curve.share.sum(axis=1), 1.0)


def test_a_compliance_in_series_adds_its_deflection(curve):
    added = 1e-9 * (1 + curve.phase)
    soft = curve.with_compliance(added)
    assert_allclose(1 / soft.k - 1 / curve.k, added, rtol=1e-9)
    assert_allclose(1 / soft.k_tangent - 1 / curve.k_tangent, added, rtol=1e-9)
    assert_allclose(soft.te - curve.te, LOAD * added, rtol=1e-9)
    assert_allclose(soft.error / soft.k**2, curve.error / curve.k**2, err_msg="the error of the deflection stays")
    assert_allclose(replace(soft, support_deflection=LOAD * added).without_supports().k, curve.k, rtol=1e-12)
    assert curve.without_supports() is curve


def test_parts_of_a_curve_join_to_the_curve(curve, pair, steel):
    parts = [gf.mesh_stiffness(pair, LOAD, steel, phases=part, error=True) for part in np.split(curve.phase, [5])]
    whole = joined(parts)
    for name in ("phase", "k", "k_tangent", "deflection", "error", "order", "force"):
        assert_allclose(getattr(whole, name), getattr(curve, name), rtol=1e-12, err_msg=name)
    assert whole.unloaded is None
