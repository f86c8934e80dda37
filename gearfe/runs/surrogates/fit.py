"""`fit_surrogate`: polynomials by least squares on a Sobol sample of `ritz`, tested on held-back cases."""

import itertools
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from scipy.stats import qmc

from ...core.case_parts import two_materials
from ...core.checks import whole
from ...core.material import Material
from ...geometry.aliases import Floats
from ...geometry.pair.gear_pair import GearPair
from ...stiffness.solve import Solve, solve
from ..batches import batch
from .space import Space, space_of
from .surrogate import ERRORS, Surrogate
from .zoned import DEGREE, breaks_of, phases_of, piece_of, series_of

FEWEST, MOST = 16, 20_000  # limits of the number of cases in a fit
CHECKED = 64  # phases per mesh cycle at which held-back cases are compared
SETS = tuple((degree, power) for degree in range(1, 9) for power in (1.0, 0.75, 0.6))  # limits of sums of degrees**power
BUSY = 0.6  # largest number of polynomial terms per case


def fit_surrogate(
    pair: GearPair,
    material: Material | tuple[Material, Material],
    inputs: Mapping[str, float | tuple[float, float]],
    *,
    cases: int = 256,
    held_back: int = 64,
    seed: int = 0,
    workers: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Surrogate:
    """Fit a surrogate of `mesh_stiffness` by ``ritz`` over ranges of gears, cracks and loads.

    The ranges are sampled (scrambled Sobol sequences) and every case is solved. Products of Legendre polynomials of the inputs
    are fitted by least squares to the breaks of the mesh cycle and, between them, to ln k. The products are chosen by
    leave-one-out errors of the fitted cases. The stated error is that on `held_back` further cases, at phases that were not
    fitted.

    Parameters
    ----------
    pair : GearPair
        Spur gears with the values that `inputs` do not contain. If teeth or profile shifts vary, the centre distance is that
        without backlash.
    material : Material or (Material, Material)
    inputs : dict
        Ranges ``(low, high)``, or single numbers to hold, of `gearfe.runs.surrogates.space.INPUTS`: ``force`` [N], crack
        ``level`` and ``angle`` [rad] of a pinion tooth, ``z_1``, ``z_2``, ``x_1``, ``x_2``, and ``bore_1``, ``bore_2`` in root
        radii. Without a level the gears are healthy.
    cases, held_back : int
        Cases fitted, and cases kept to judge the fit.
    seed : int
        Seed of the samples.
    workers, progress
        See `gearfe.batch`.

    Raises
    ------
    ValueError
        If an input is invalid. Also if a gear or crack is geometrically impossible, or the number of contact zones changes,
        anywhere in the ranges. The message states where.

    References
    ----------
    B. Sudret, Global sensitivity analysis using polynomial chaos expansions, Reliab. Eng. Syst. Saf. 93 (2008) 964-979.
    G. Blatman, B. Sudret, Adaptive sparse polynomial chaos expansion based on least angle regression, J. Comput. Phys. 230
    (2011) 2345-2367, on sums of powers of the degrees and on leaving one out.
    """
    started = time.perf_counter()
    space, materials = space_of(pair, inputs), two_materials(material)
    if max(whole("cases", cases, FEWEST), whole("held_back", held_back, 8)) > MOST:
        raise ValueError(f"cases = {cases}, held_back = {held_back}, but give at most {MOST}")
    whole("seed", seed, 0)
    _check_corners(space, materials)
    drawn, fresh = _sample(space, cases, seed), _sample(space, held_back, seed + 1_000_003)
    jobs = [
        {"space": space, "materials": materials, "point": point, "check": i >= len(drawn)}
        for i, point in enumerate(drawn + fresh)
    ]
    done = batch(jobs, work=solved, workers=workers, progress=progress)
    for point, result in zip(drawn + fresh, done.results, strict=True):
        if isinstance(result, Exception):
            raise ValueError(f"no stiffness within the ranges at {_told(point)}: {result}; narrow the ranges") from result
    pairs = sorted({result["pairs"] for result in done.results})
    if len(pairs) > 1:
        raise ValueError(f"contact ratios from below {pairs[-1]} to above it are in the ranges: k jumps there; narrow them")
    fitted, judged = done.results[: len(drawn)], done.results[len(drawn) :]
    points = space.scaled([list(point.values()) for point in drawn])
    values = np.array([np.append(case["breaks"], case["series"]) for case in fitted])
    powers, weights, left_out = _regression(points, values, fitted[0]["breaks"].size)
    meta = {
        "pairs": pairs[0], "cases": cases, "held_back": held_back, "seed": seed, "terms": len(powers),
        "left out, rms of ln k": left_out, "seconds": time.perf_counter() - started, "seconds_cases": sum(done.seconds),
        "curve": fitted[0]["meta"],
    }  # fmt: skip
    blank = Surrogate(space, powers, weights, dict.fromkeys(ERRORS, 0.0), np.zeros(fitted[0]["breaks"].size - 1), meta)
    error, worst = held_back_error(blank, fresh, judged)
    return Surrogate(space, powers, weights, error, worst, meta)


def solved(space: Space, materials: tuple[Material, Material], point: dict[str, float], check: bool) -> dict[str, Any]:
    """Return the curve of one case by `ritz`: breaks, Chebyshev coefficients of ln k. With `check`, return k at test phases."""
    case = space.case(point, materials)
    eps_alpha = case.pair.eps_alpha

    def curve(phase):
        return solve(case, Solve("ritz", phases=phase))

    if check:
        low = int(eps_alpha)
        half = (1 - (eps_alpha - low)) / 2
        span = np.array([-half, eps_alpha + half if space.cracked else 1 - half])
        phase = np.arange(np.ceil(span[0] * CHECKED), np.floor(span[1] * CHECKED)) / CHECKED + 0.37 / CHECKED
        sampled = curve(phase[(phase > span[0]) & (phase < span[1])])
        return {"pairs": low, "phase": sampled.phase, "k": sampled.k}
    breaks = breaks_of(eps_alpha, curve, cracked=space.cracked)
    sampled = curve(phases_of(breaks))
    meta = {name: sampled.meta[name] for name in ("materials", "state", "order", "refine", "versions", "stiffness", "pose")}
    return {"pairs": int(eps_alpha), "breaks": breaks, "series": series_of(np.log(sampled.k)), "meta": meta}


def held_back_error(
    surrogate: Surrogate, points: list[dict[str, float]], judged: list[dict[str, Any]]
) -> tuple[dict[str, float], Floats]:
    """Return the errors of a surrogate on unfitted cases, as in `Surrogate.error` and `Surrogate.worst`."""
    worst = np.zeros(surrogate.worst.size)
    differences, means = [], []
    for point, case in zip(points, judged, strict=True):
        breaks, _ = surrogate._parts(surrogate.space.point(point))
        phase = np.clip(case["phase"], breaks[0], breaks[-1]) if surrogate.space.cracked else case["phase"]
        k = surrogate.k(phase, **point)
        away = np.abs(k / case["k"] - 1)
        np.maximum.at(worst, piece_of(surrogate._within(phase, breaks), breaks), away)
        differences.append(away)
        means.append(abs(k.mean() / case["k"].mean() - 1))
    away = np.concatenate(differences)
    error = {"mean": float(away.mean()), "worst": float(away.max()), "worst mean k": float(max(means))}
    return error | {"cases": len(judged), "phases": int(away.size)}, worst


def _sample(space, count, seed):
    unit = qmc.Sobol(len(space.ranges), seed=seed).random_base2(int(np.ceil(np.log2(count))))[:count]
    return [space.at(point) for point in unit]


def _check_corners(space, materials):
    """Build the gears at all corners of the ranges, so that errors appear before any solution."""
    for ends in itertools.product(*space.ranges.values()):
        point = dict(zip(space.ranges, ends, strict=True))
        try:
            space.case(point, materials)
        except ValueError as error:
            raise ValueError(f"no stiffness at a corner of the ranges, {_told(point)}: {error}; narrow the ranges") from error


def _told(point):
    return ", ".join(f"{name} = {value:g}" for name, value in point.items())


def _regression(points, values, breaks):
    """Return the products of Legendre polynomials of `SETS` with the least leave-one-out error, and their weights."""
    best = None
    for degree, power in SETS:
        powers = _products(points.shape[1], degree, power, BUSY * len(points))
        if powers is None:
            continue
        basis = legendre.legvander(points, degree)
        terms = np.prod([basis[:, j, powers[:, j]] for j in range(points.shape[1])], axis=0)
        inverse = np.linalg.pinv(terms)
        weights = inverse @ values
        leverage = np.einsum("ij,ji->i", terms, inverse)
        away = (values - terms @ weights) / np.maximum(1 - leverage, 1e-6)[:, None]
        left_out = float(np.sqrt((away[:, breaks:] ** 2).sum(axis=1).mean() / (values.shape[1] - breaks) * (DEGREE + 1)))
        if best is None or left_out < best[2]:
            best = powers, weights, left_out
    return best


def _products(inputs, degree, power, most):
    """Degrees ``(terms, inputs)`` whose sum of powers is at most ``degree**power``, or None for more than `most` terms."""
    out = [[n] for n in range(degree + 1)]
    for _ in range(inputs - 1):
        out = [[*row, n] for row in out for n in range(degree + 1) if sum(m**power for m in (*row, n)) <= degree**power + 1e-9]
        if len(out) > 50 * most:
            return None
    return np.array(out) if len(out) <= most else None
