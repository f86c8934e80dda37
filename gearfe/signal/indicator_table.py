"""Condition indicators of several cases, with their increments over the healthy case."""

import math
from collections.abc import Mapping
from typing import Any, TypedDict, Unpack

from ..core.table import Column, Table
from .series import Signal

LABELS = {  # labels in tables; the RMS value may exceed the peak if the signal has a mean
    "rms": "rms (with the mean)",
    "peak": "peak (from the mean)",
    "crest factor S4": "peak over rms with the mean (article S4)",
    "mesh line": "amplitude at the mesh frequency",
    "sideband index": "mean amplitude of the first sidebands",
    "SC (S0)": "centre of the sidebands' energy, Hz (article S0)",
    "SC (S1)": "mean amplitude around the mesh frequency (article S1)",
}
TENFOLD = 900.0  # growth above which a factor is printed [%]
ROUNDING = 1e-9  # Smaller changes, relative to the largest oscillation, are rounding errors.
GREAT = 1e8  # growth above which the healthy value is a rounding error [%]


def increment(value, healthy):
    """``(value - healthy) / healthy`` in percent (S4)."""
    if not healthy:
        raise ValueError(f"healthy = {healthy}, but an increment in percent needs a value other than 0")
    return 100 * (value - healthy) / healthy


class IndicatorOptions(TypedDict, total=False):
    """Options of `Signal.indicators`."""

    window: str | tuple[Any, ...]
    tolerance: float | None
    harmonics: int


def indicator_table(
    signals: Mapping[str, Signal],
    mesh_frequency: float | None = None,
    fault_frequency: float | None = None,
    *,
    healthy: str = "healthy",
    **options: Unpack[IndicatorOptions],
) -> dict[str, dict[str, tuple[float, float]]]:
    """Compute the indicators of several cases, with the increments over the healthy case.

    Parameters
    ----------
    signals : dict of str to Signal
        Signals by case, of the same unit and rate. Longer ones are cut to the shortest, since the sideband indicators depend on
        the length.
    mesh_frequency, fault_frequency, **options
        See `Signal.indicators`.
    healthy : str
        The case to compare with.

    Returns
    -------
    dict of str to dict of str to (float, float)
        ``table[case][indicator]`` is the value and the increment [%], nan where the healthy value is 0. Both are nan for a record
        whose oscillation is rounding, less than 1e-9 of the largest.

    Raises
    ------
    ValueError
        If there is no case called `healthy`; if a signal differs from it in unit or rate; if a signal is constant. With
        frequencies also: if only one is given, or one is no positive number of Hz; if the fault frequency is not below the mesh
        frequency, or less than 4 bins of the spectrum; if a line or a sideband lies above half of the rate, or has no bin within
        `tolerance`; if the spectrum is zero around the mesh frequency; if scipy has no such `window`.
    """
    if healthy not in signals:
        raise ValueError(f"no case {healthy!r} to compare with; there are {', '.join(signals) or 'none'}: give one as healthy=")
    first = signals[healthy]
    for case, signal in signals.items():
        if (signal.unit, signal.rate) != (first.unit, first.rate):
            raise ValueError(
                f"{case}: {signal.rate:g} Hz in {signal.unit}, but {healthy} has {first.rate:g} Hz in {first.unit}: "
                "compare records of the same rate and unit"
            )
    count = min(signal.values.size for signal in signals.values())
    at = mesh_frequency, fault_frequency
    indicators = {case: signal[:count].indicators(*at, **options) for case, signal in signals.items()}
    sizes = {case: signal.values.std() for case, signal in signals.items()}
    for case, size in sizes.items():
        if size < ROUNDING * max(sizes.values()):
            indicators[case] = dict.fromkeys(indicators[case], math.nan)
    reference = indicators[healthy]
    return {
        case: {name: (value, increment(value, reference[name]) if reference[name] else math.nan) for name, value in row.items()}
        for case, row in indicators.items()
    }


def tabulate_indicators(found: Mapping[str, Mapping[str, tuple[float, float]]]) -> Table:
    """Return a `Table` of `indicator_table` with a row per indicator, and value and increment per case.

    A healthy value that is a millionth or less of the faulty one is printed as none.
    """
    columns, parts = [Column("indicator")], []
    for case, row in found.items():
        columns.append(Column(case, form="{:.4g}"))
        grown = any(growth and not math.isnan(growth) for _, growth in row.values())
        columns += [Column(f"{case}, change", "%", _growth)] * grown
        parts.append((row, 1 + grown))
    names = next(iter(found.values()))
    return Table(columns, [[LABELS.get(name, name), *(x for row, n in parts for x in row[name][:n])] for name in names])


def _growth(more):
    if abs(more) < TENFOLD:
        return f"{more:+.1f} %"
    return f"{1 + more / 100:.3g} x healthy" if abs(more) < GREAT else "healthy: none"
