"""Values of a study's sample: points of the unit cube by scipy.stats.qmc, through distributions, with correlations."""

import numpy as np
from scipy import stats
from scipy.stats import qmc

from ...core.checks import is_number
from ...scene.reading import LARGEST
from ...scene.schema import shown

WIDEST = 10.0  # standard deviation of a logarithm: two thirds of the values over nine decades
LEAST = 1e-9  # part of a distribution that must lie within its limits: below, its values are rounding
METHODS = ("sobol", "random", "latin", "saltelli")
SHAPES = {  # name: number of parameters, and what they are
    "uniform": (2, "low, high"),
    "normal": (2, "mean, standard deviation"),
    "lognormal": (2, "median, standard deviation of the logarithm"),
    "triangular": (3, "low, most likely, high"),
    "choice": (None, "the values, each as likely"),
}


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
        return qmc.LatinHypercube(dims, rng=rng).random(count)
    if method == "sobol":
        return qmc.Sobol(dims, rng=rng).random(count)
    joint = qmc.Sobol(2 * dims, rng=rng).random(count)
    a, b = joint[:, :dims], joint[:, dims:]
    mixed = [np.where(np.arange(dims) == j, b, a) for j in range(dims)]
    return np.concatenate([a, b, *mixed])


def correlated(points, names, pairs):
    """Points of the unit cube whose normal scores have the correlations `pairs`, ``(name, name, value)``: a Gaussian copula.

    Of normal distributions these are the correlations themselves.
    """
    matrix = np.eye(len(names))
    for first, second, value in pairs:
        i, j = names.index(first), names.index(second)
        matrix[i, j] = matrix[j, i] = value
    try:
        factor = np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        raise ValueError("the correlations contradict each other: their matrix is not positive definite") from None
    return stats.norm.cdf(stats.norm.ppf(np.clip(points, 1e-15, 1 - 1e-15)) @ factor.T)


def check_shape(where, spec):
    """Raise ValueError unless `spec` is one distribution, ``{name: parameters}``, and, of a normal one, ``within``."""
    names = [name for name in spec if name in SHAPES]
    unknown = [name for name in spec if name not in (*SHAPES, "within", "also")]
    if len(names) != 1 or unknown:
        raise ValueError(f"{where}: {shown(spec)} is no distribution; give one of {', '.join(SHAPES)}, and within = [low, high]")
    (name,) = names
    count, meaning = SHAPES[name]
    values = spec[name]
    if not isinstance(values, (list, tuple)) or not values or (count is not None and len(values) != count):
        raise ValueError(f"{where}: {name} = {shown(values)}, but give a list: {meaning}")
    if name == "choice":
        if "within" in spec:
            raise ValueError(f"{where}: within is of a distribution; leave out of the choice what is not in it")
        return
    if not all(map(_finite, values)):
        raise ValueError(f"{where}: {name} = {shown(values)}, but give finite numbers: {meaning}")
    rising = {"uniform": values, "triangular": values}.get(name, [0, 1])
    if sorted(rising) != list(rising) or rising[0] == rising[-1]:
        raise ValueError(f"{where}: {name} = {values!r}, but the values must rise: {meaning}")
    if name in ("normal", "lognormal") and not values[1] > 0:
        raise ValueError(f"{where}: {name} = {values!r}, but a standard deviation is > 0")
    if name == "lognormal" and not (values[0] > 0 and values[1] <= WIDEST):
        bounds = f"a median is > 0, and a standard deviation of the logarithm above {WIDEST:g} is none of gears"
        raise ValueError(f"{where}: lognormal = {values!r}, but {bounds}")
    if "within" in spec:
        _check_within(where, name, spec)


def _finite(value):
    return is_number(value) and abs(value) < LARGEST


def _check_within(where, name, spec):
    """Raise ValueError unless ``within`` is an interval in which a part of the distribution lies."""
    within = spec["within"]
    if not (isinstance(within, (list, tuple)) and len(within) == 2 and all(map(_finite, within)) and within[0] < within[1]):
        raise ValueError(f"{where}: within = {shown(within)}, but give [low, high] with low < high")
    low, high = _distribution(spec).cdf(within)
    if not high - low > LEAST:
        raise ValueError(
            f"{where}: within = {within} leaves nothing of {name} = {spec[name]}; give an interval in which values lie"
        )


def quantiles(spec, u):
    """Values of a distribution at the probabilities `u`, as a list; with ``within``, of what lies between the two."""
    if "choice" in spec:
        values = spec["choice"]
        return [values[min(int(p * len(values)), len(values) - 1)] for p in u]
    distribution = _distribution(spec)
    if "within" in spec:
        low, high = distribution.cdf(spec["within"])
        u = low + (high - low) * u
    return distribution.ppf(u).tolist()


def _distribution(spec):
    if "uniform" in spec:
        low, high = spec["uniform"]
        return stats.uniform(low, high - low)
    if "normal" in spec:
        return stats.norm(*spec["normal"])
    if "lognormal" in spec:
        median, spread = spec["lognormal"]
        return stats.lognorm(spread, scale=median)
    low, middle, high = spec["triangular"]
    return stats.triang((middle - low) / (high - low), low, high - low)
