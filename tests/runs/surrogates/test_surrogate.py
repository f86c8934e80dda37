"""A surrogate is as far from `ritz` as it says, on cases it never saw; outside its ranges it says nothing."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.runs.surrogates.fit import _regression, held_back_error, solved
from gearfe.runs.surrogates.zoned import DEGREE, breaks_of, phases_of, series_of
from gearfe.runs.surrogates.zoned import at as value_at

LOADS = {"force": (600.0, 3000.0)}


@pytest.fixture(scope="module")
def fitted(pair, steel):
    return gf.fit_surrogate(pair, steel, LOADS, cases=16, held_back=8, workers=1)


def fresh(fitted, steel, forces):
    points = [{"force": force} for force in forces]
    return points, [solved(fitted.space, (steel, steel), point, True) for point in points]


@pytest.mark.slow
def test_error_on_cases_of_our_own_is_as_stated(fitted, steel):
    """Neither fitted nor held back: forces of this test."""
    error, _ = held_back_error(fitted, *fresh(fitted, steel, [650.0, 1777.0]))
    assert fitted.error["mean"] < 2e-4
    assert fitted.error["worst"] < 5e-3
    assert error["mean"] < 2 * fitted.error["mean"]
    assert error["worst"] < 3 * fitted.error["worst"]


def test_the_error_of_cases_left_out_is_that_of_fits_without_them():
    """The formula of the leverage against as many fits as there are cases, each without one."""
    rng = np.random.default_rng(7)
    points = rng.uniform(-1, 1, (24, 1))
    values = np.exp(points * np.array([0.3, 0.9, -0.5])) + 0.01 * rng.standard_normal((24, 3))
    powers, _, left_out = _regression(points, values, 1)
    terms = np.polynomial.legendre.legvander(points[:, 0], int(powers.max()))[:, powers[:, 0]]
    away = []
    for i in range(24):
        rest = np.arange(24) != i
        weights = np.linalg.lstsq(terms[rest], values[rest], rcond=None)[0]
        away.append(values[i, 1:] - terms[i] @ weights[:, 1:])
    assert_allclose(left_out, np.sqrt((np.array(away) ** 2).mean() * (DEGREE + 1)), rtol=1e-8)


def test_a_worse_surrogate_says_so(fitted, steel):
    """The same check on weights that are off: it can fail."""
    off = fitted.weights.copy()
    off[0, fitted.worst.size + 1 :: 9] += 0.01  # ln k one percent too high in every piece
    error, _ = held_back_error(replace(fitted, weights=off), *fresh(fitted, steel, [1111.0]))
    assert_allclose(error["mean"], 0.01, rtol=0.1)
    assert error["worst"] > fitted.error["worst"]


def test_curve_is_that_of_ritz(fitted, pair, steel):
    made = fitted.curve(64, force=1500.0)
    want = gf.mesh_stiffness(pair, 1500.0, steel, phases=64)
    assert (np.abs(made.k - want.k) <= 2 * made.error).mean() > 0.95
    for zone, value in want.zones().items():
        assert_allclose(made.zones()[zone], value, rtol=1e-3, err_msg=zone)
    assert_allclose(made.deflection, want.deflection, rtol=5e-3)
    assert_allclose(made.meta["eps_alpha"], pair.eps_alpha, rtol=1e-6)
    assert_allclose(fitted.k(made.phase + 3, force=1500.0), made.k, rtol=1e-3)  # rounding chooses the piece at a break


def test_outside_its_ranges_it_says_nothing(fitted):
    for force in (599.0, 3001.0, float("nan"), "1000"):
        with pytest.raises(ValueError, match="is invalid outside"):
            fitted.k(0.3, force=force)
    with pytest.raises(ValueError, match="no value of 'force'"):
        fitted.curve()
    with pytest.raises(ValueError, match="'level' is none of its inputs"):
        fitted.k(0.3, force=1000.0, level=0.3)


def test_saved_and_loaded(fitted, tmp_path):
    fitted.save(tmp_path / "k.npz")
    again = gf.Surrogate.load(tmp_path / "k.npz")
    phase = np.linspace(0, 1, 7)
    assert (again.k(phase, force=1234.0) == fitted.k(phase, force=1234.0)).all()
    assert (again.error, again.space.ranges) == (fitted.error, fitted.space.ranges)
    np.savez(tmp_path / "other.npz", a=1.0)
    for wrong in ("other.npz", "none.npz", "k.csv"):
        with pytest.raises(ValueError, match=wrong):
            gf.Surrogate.load(tmp_path / wrong)
    with pytest.raises(ValueError, match=r"k\.csv"):
        fitted.save(tmp_path / "k.csv")


def test_gaps_in_the_ranges_are_refused(pair, steel):
    with pytest.raises(ValueError, match=r"at a corner of the ranges, bore_1 = 1\.1"):
        gf.fit_surrogate(pair, steel, {"force": 900.0, "bore_1": (0.3, 1.1)}, cases=16, held_back=8, workers=1)
    with pytest.raises(ValueError, match="cases = 3"):
        gf.fit_surrogate(pair, steel, LOADS, cases=3)


def test_zones_too_short_are_refused():
    for ratio in (1.05, 1.95, 2.02):
        with pytest.raises(ValueError, match=r"shorter than 0\.1"):
            breaks_of(ratio, None, cracked=True)


def test_breaks_are_where_k_bends(pair, steel):
    """Between the breaks a polynomial follows k; across one it does not."""

    def solve(phase):
        return gf.mesh_stiffness(pair, 2000.0, steel, phases=phase)

    breaks = breaks_of(pair.eps_alpha, solve, cracked=False)
    assert_allclose(breaks[-1] - breaks[0], 1.0)
    phase = np.linspace(breaks[0], breaks[-1], 150)
    k = solve(phase).k

    def off(breaks):
        return np.abs(value_at(phase, breaks, series_of(solve(phases_of(breaks)).k)) / k - 1)

    assert off(breaks).mean() < 1e-4
    assert off(breaks).max() < 3e-3
    moved = breaks.copy()
    moved[[1, -2]] += (-0.02, 0.02)  # where the tip corners first touch and let go
    assert off(moved).max() > 3 * off(breaks).max()
