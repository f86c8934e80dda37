"""`error_map`: errors of closed forms relative to the converged energy model for thousands of gear pairs."""

import contextlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from ..core.case import Case
from ..core.checks import numbers, whole
from ..core.material import Material
from ..core.threads import own_warnings
from ..geometry.aliases import Floats
from ..geometry.damage.crack import Crack, crack_path
from ..geometry.pair.gear_pair import GearPair
from ..geometry.tooth.gear import Gear
from ..stiffness.methods import ROWS
from ..stiffness.solve import Solve, solve
from .batches import batch

# the sampled space: uniform between these ends; bores in root radii, loads F / (b m_n) in MPa on a logarithmic scale
RANGES = {
    "z_1": (12, 80),
    "z_2": (12, 120),
    "alpha_deg": (17.5, 25.0),
    "x_1": (-0.3, 0.6),
    "x_2": (-0.3, 0.6),
    "bore_1": (0.2, 0.9),
    "bore_2": (0.2, 0.9),
    "rack_tip_radius": (0.2, 0.38),
    "crack": (0.02, 0.7),
}
LOADS = (10.0, 50.0, 250.0)
ZONES = ("single", "double", "mean", "max")
# Methods that sum over pairs come first.
CLOSED_FORMS = sorted((row for row in ROWS if not row.converged), key=lambda row: row.kind != "sum")
HEALTHY = tuple(row.name for row in CLOSED_FORMS)
CRACKED = {f"{row.name} {model}": (row.name, {"crack_model": model}) for row in CLOSED_FORMS for model in row.crack_models}


@dataclass(frozen=True, slots=True)
class ErrorMap:
    """Relative errors of formulations against `ritz`, with a row per pair, load and state of damage.

    `columns` maps names to arrays: the sampled numbers, ``load`` [MPa], ``crack`` (0: healthy), and for each zone ``k`` of ritz
    [N/(mm um)] and the error of each formulation as ``"textbook single"`` and so on (nan: the formulation or the zone does not
    exist there). ``extended mean`` is the relative increase of the mean k by contact beyond the path of contact. `formulations`
    are their names.
    """

    columns: dict[str, Floats]
    formulations: tuple[str, ...]

    def rows(self, **limits: tuple[float, float]) -> NDArray[np.bool_]:
        """Return the mask of the rows whose columns lie within the given ``name=(low, high)``."""
        inside = np.ones(self.columns["load"].size, dtype=bool)
        for name, (low, high) in limits.items():
            inside &= (self.columns[name] >= low) & (self.columns[name] <= high)
        return inside

    def bands(
        self, formulation: str, zone: str = "mean", **limits: tuple[float, float]
    ) -> tuple[float, float, float, float, int]:
        """Return errors at 5, 50 and 95 % of the rows within `limits`, the share below 3 %, and the number of rows."""
        error = self.columns[f"{formulation} {zone}"][self.rows(**limits)]
        error = error[np.isfinite(error)]
        if error.size == 0:
            return (math.nan,) * 4 + (0,)
        return *np.percentile(error, [5, 50, 95]).tolist(), float((np.abs(error) < 0.03).mean()), error.size


def error_map(
    pairs: int = 2000,
    *,
    seed: int = 0,
    loads: Sequence[float] = LOADS,
    phases: int = 24,
    workers: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> ErrorMap:
    """Compute the errors of the closed forms relative to `ritz` for a sample of gear pairs.

    The sample is a scrambled Sobol sequence over `RANGES`. Samples without valid teeth or contact, or whose crack leaves the
    body, are skipped. Every pair is computed healthy, and every second one also with a pinion crack from the 30-degree point at
    45 degrees. Steel (206 GPa, 0.3) in plane strain, without the contact beyond the path of contact that closed forms neglect.

    Parameters
    ----------
    pairs : int
        Number of pairs (two gears each).
    seed : int
        Seed of the sample.
    loads : sequence of float
        F / (b m_n) [MPa]: geometry and load scale with the module.
    phases : int
        Number of phases per mesh cycle.
    workers, progress
        See `gearfe.batch`.

    Returns
    -------
    ErrorMap
        A row for each pair, load and state of damage.

    Raises
    ------
    ValueError
        If `pairs` is no whole number from 1, `phases` is below 1, `loads` are empty, not positive, not finite or beyond the
        strength of teeth, or `workers` is no whole number from 1.
    """
    at = {"loads": numbers("loads", loads, " [MPa]").reshape(-1).tolist(), "phases": whole("phases", phases, 1)}
    cases = [{"sample": one, **at} for one in _samples(whole("pairs", pairs, 1, 10**6), seed)]
    rows: list[dict[str, float]] = []
    for result in batch(cases, work=_one, workers=workers, progress=progress).results:
        if isinstance(result, Exception):
            raise result
        rows += result
    names = (*HEALTHY, *CRACKED)
    keys = [*RANGES, "load", *(f"k {zone}" for zone in ZONES), "extended mean", *(f"{n} {zone}" for n in names for zone in ZONES)]
    return ErrorMap({key: np.array([row.get(key, math.nan) for row in rows]) for key in keys}, names)


def build(sample):
    """Return a pair of module 1 mm and width 1 mm from sampled numbers."""
    rack = {"m_n": 1.0, "alpha_n": math.radians(sample["alpha_deg"]), "b": 1.0, "rack_tip_radius": sample["rack_tip_radius"]}
    with own_warnings():  # The own warning states that tip radii are reduced to the full rounding.
        gears = []
        for k in (1, 2):
            z, x = sample[f"z_{k}"], sample[f"x_{k}"]
            gears.append(Gear(z=int(z), x=x, r_bore=sample[f"bore_{k}"] * (z / 2 - 1.25 + x), **rack))
        return GearPair(*gears)


def _samples(count, seed):
    """Return `count` samples for which gears exist."""
    ends, seed = np.array(list(RANGES.values())), whole("seed", seed, 0)
    source, out = qmc.Sobol(len(RANGES), seed=seed), []
    while len(out) < count:
        for point in qmc.scale(source.random(256), ends[:, 0], ends[:, 1]).tolist():
            sample = dict(zip(RANGES, point, strict=True))
            sample |= {name: float(round(sample[name])) for name in ("z_1", "z_2")}
            with contextlib.suppress(ValueError):
                crack_path(build(sample).gear_1, Crack(level=sample["crack"]))
                out.append(sample)
    return [sample | {"crack": sample["crack"] * (k % 2)} for k, sample in enumerate(out[:count])]


def _one(sample, loads, phases):
    """Return the rows of one pair."""
    case, how = Case(build(sample), loads, Material()), Solve("ritz", phases=(np.arange(phases) + 0.5) / phases, extended=False)
    truth, beyond = solve(case, how), solve(case, replace(how, extended=True))
    curves = {name: solve(case, replace(how, method=name)) for name in HEALTHY}
    rows = [
        {**sample, "crack": 0.0, "load": load, "extended mean": beyond[i].k.mean() / truth[i].k.mean() - 1}
        | _errors(truth, curves, i)
        for i, load in enumerate(loads)
    ]
    if sample["crack"]:
        inside = np.linspace(0, case.pair.eps_alpha, int(phases * case.pair.eps_alpha) + 1)
        case = replace(case, damage={"pinion": [Crack(level=sample["crack"])]})
        how = replace(how, phases=(inside[1:] + inside[:-1]) / 2)
        truth, curves = solve(case, how), {}
        for name, (method, variants) in CRACKED.items():
            with contextlib.suppress(ValueError):  # The crack leaves no beam section, so the model has no value.
                curves[name] = solve(case, replace(how, method=method, variants=variants))
        rows += [sample | {"load": load} | _errors(truth, curves, i) for i, load in enumerate(loads)]
    return rows


def _errors(truth, found, i):
    zones = truth[i].zones()
    out = {f"k {zone}": k * 1e-6 for zone, k in zones.items() if zone in ZONES}
    for name, curves in found.items():
        out |= {f"{name} {zone}": k / zones[zone] - 1 for zone, k in curves[i].zones().items() if zone in ZONES}
    return out
