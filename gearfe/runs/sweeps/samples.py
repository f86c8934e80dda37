"""Sample of a study: points of the unit cube (scipy.stats.qmc) mapped through distributions, with correlations."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ...core.checks import is_number
from ...geometry.checks import shown
from ...scene.reading import LARGEST

WIDEST = 10.0  # largest standard deviation of a logarithm, with two thirds of the values over nine decades
LEAST = 1e-9  # least part of a distribution within its limits, above rounding errors
METHODS = ("sobol", "random", "latin", "saltelli")


def _stats():
    """Return `scipy.stats`, which takes 0.5 s to load. Workers of a sweep do not need it."""
    from scipy import stats

    return stats


class Distribution(NamedTuple):
    """Distribution: names of its parameters, constructor, and the rule for them as a function and in words."""

    size: int
    meaning: str
    make: Callable[..., Any]
    rule: Callable[[list[float]], bool]
    told: str


def _rises(values):
    return sorted(values) == list(values) and values[0] < values[-1]


RISING = (_rises, "the values must rise")
SHAPES = {
    "uniform": Distribution(2, "low, high", lambda low, high: _stats().uniform(low, high - low), *RISING),
    "normal": Distribution(
        2, "mean, standard deviation", lambda *v: _stats().norm(*v), lambda v: v[1] > 0, "a standard deviation is > 0"
    ),
    "lognormal": Distribution(
        2, "median, standard deviation of the logarithm", lambda median, spread: _stats().lognorm(spread, scale=median),
        lambda v: v[0] > 0 and 0 < v[1] <= WIDEST, f"a median is > 0, a standard deviation of the logarithm from 0 to {WIDEST:g}",
    ),
    "triangular": Distribution(
        3, "low, most likely, high",
        lambda low, middle, high: _stats().triang((middle - low) / (high - low), low, high - low), *RISING,
    ),
}  # fmt: skip


def cube(method, count, dims, seed):
    """Points of the unit cube ``(n, dims)``.

    ``saltelli``: two Sobol samples A and B of `count` points and, for each dimension, A with that column of B, in this order:
    ``count (dims + 2)`` points, from which first-order and total Sobol indices are estimated (A. Saltelli et al., Comput. Phys.
    Commun. 181 (2010) 259-270).
    """
    rng = np.random.default_rng(seed)
    if method == "random":
        return rng.random((count, dims))
    if method == "latin":
        return _stats().qmc.LatinHypercube(dims, rng=rng).random(count)
    if method == "sobol":
        return _stats().qmc.Sobol(dims, rng=rng).random(count)
    joint = _stats().qmc.Sobol(2 * dims, rng=rng).random(count)
    a, b = joint[:, :dims], joint[:, dims:]
    mixed = [np.where(np.arange(dims) == j, b, a) for j in range(dims)]
    return np.concatenate([a, b, *mixed])


def correlated(points, names, pairs):
    """Return points of the unit cube whose normal scores have the correlations `pairs` ``(name, name, value)`` (Gaussian copula).

    For normal distributions these are the correlations of the values.
    """
    matrix = np.eye(len(names))
    for first, second, value in pairs:
        i, j = names.index(first), names.index(second)
        matrix[i, j] = matrix[j, i] = value
    try:
        factor = np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        raise ValueError("the correlations contradict each other: their matrix is not positive definite") from None
    norm = _stats().norm
    return norm.cdf(norm.ppf(np.clip(points, 1e-15, 1 - 1e-15)) @ factor.T)


def check_shape(where, spec):
    """Raise ValueError unless `spec` is one distribution ``{name: parameters}``. A normal one may also have ``within``."""
    names = [name for name in spec if name not in ("within", "also")]
    if len(names) != 1 or names[0] not in (*SHAPES, "choice"):
        known = ", ".join((*SHAPES, "choice"))
        raise ValueError(f"{where}: {shown(spec)} is no distribution; give one of {known}, and within = [low, high]")
    (name,) = names
    values, within, shape = spec[name], spec.get("within"), SHAPES.get(name)
    meaning = shape.meaning if shape else "the values, each as likely"
    if not isinstance(values, (list, tuple)) or not values or (shape and len(values) != shape.size):
        raise ValueError(f"{where}: {name} = {shown(values)}, but give a list: {meaning}")
    if shape is None:
        if within is not None:
            raise ValueError(f"{where}: within applies to a distribution; remove the unwanted values from the choice")
        return
    if not all(map(_finite, values)):
        raise ValueError(f"{where}: {name} = {shown(values)}, but give finite numbers: {meaning}")
    if not shape.rule(values):
        raise ValueError(f"{where}: {name} = {values!r}, but {shape.told}: {meaning}")
    if within is not None:
        _check_within(where, spec, name)


def _check_within(where, spec, name):
    within = spec["within"]
    if not (isinstance(within, (list, tuple)) and len(within) == 2 and all(map(_finite, within)) and within[0] < within[1]):
        raise ValueError(f"{where}: within = {shown(within)}, but give [low, high] with low < high")
    if not np.diff(_distribution(spec).cdf(within))[0] > LEAST:
        raise ValueError(
            f"{where}: within = {within} contains no values of {name} = {spec[name]}; give an interval that contains values"
        )


def _finite(value):
    return is_number(value) and abs(value) < LARGEST


def quantiles(spec, u):
    """Values of a distribution at the probabilities `u`, as a list. ``within`` truncates the distribution."""
    if "choice" in spec:
        values = spec["choice"]
        return [values[min(int(p * len(values)), len(values) - 1)] for p in u]
    distribution = _distribution(spec)
    if "within" in spec:
        low, high = distribution.cdf(spec["within"])
        u = low + (high - low) * u
    return distribution.ppf(u).tolist()


def _distribution(spec):
    return next(shape.make(*spec[name]) for name, shape in SHAPES.items() if name in spec)
