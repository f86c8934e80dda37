"""Evaluation of a sweep: main effects, Sobol indices, percentile bands of curves, and ROC AUC of two states."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import stats

from ...core.checks import numbers
from .runs import Runs

if TYPE_CHECKING:
    import pandas
    import xarray

BINS = 8  # number of bins of a random variable
RESAMPLES = 200  # number of bootstrap resamples


def main_effects(runs: Runs, output: str, where: Any = None) -> "pandas.DataFrame":
    """Return the mean of an output for each value of each input (drawn inputs: for each eighth of their values).

    Parameters
    ----------
    runs : Runs
    output : str
        A column of numbers.
    where : optional
        See `Runs.table`; failed cases are always left out.

    Returns
    -------
    pandas.DataFrame
        Columns ``input``, ``value`` (of a bin: its median), ``mean``, ``spread`` (standard deviation), ``cases``.

    Raises
    ------
    ValueError
        If there is no such column, or no case with a value.
    """
    import pandas

    table = _numbers(runs, output, where)
    parts = []
    for name in runs.inputs:
        column = table[name]
        drawn = column.dtype.kind == "f" and column.nunique() > 4 * BINS
        home = pandas.qcut(column, BINS, labels=False) if drawn else column
        groups = table.groupby(home, sort=True)
        summary = groups[output].agg(["mean", "std", "count"]).reset_index(drop=True)
        summary.columns = ["mean", "spread", "cases"]
        values = groups[name].median() if drawn else groups[name].first()
        parts.append(pandas.DataFrame({"input": name, "value": values.to_numpy(dtype=object)}).join(summary))
    return pandas.concat(parts, ignore_index=True)


def sobol_indices(runs: Runs, output: str, where: Any = None) -> "pandas.DataFrame":
    """Return first-order and total Sobol indices of the drawn inputs of a study with ``method = "saltelli"``.

    The first-order index is the part of an output's variance caused by one input alone. The total index includes its
    interactions with other inputs. `scipy.stats.sobol_indices` has the estimators of Saltelli et al. (2010).

    Parameters
    ----------
    runs : Runs
    output : str
        A column of numbers.
    where : optional
        See `Runs.table`. All other inputs must have a single value in the remaining rows.

    Returns
    -------
    pandas.DataFrame
        By input: ``first``, ``total`` and the ends of their 95 % bootstrap intervals.

    Raises
    ------
    ValueError
        If the sample is another one, or a case of it is missing or failed.
    """
    import pandas

    sample = runs.about["study"]["sample"]
    if sample.get("method") != "saltelli":
        raise ValueError(f"the sample is {sample.get('method')!r}, but Sobol indices need method = 'saltelli' in [sample]")
    names, count = list(sample["of"]), sample["count"]
    table = _numbers(runs, output, where).sort_values("draw")
    if table["draw"].tolist() != list(range(count * (len(names) + 2))):
        raise ValueError(
            f"Sobol indices need a value for each of the {count * (len(names) + 2)} draws once, but there are "
            f"{len(table)} with a value, "
            f"of {table['draw'].nunique()} draws: select one value of the other inputs by where, and a subset "
            "without failed cases"
        )
    parts = table[output].to_numpy().reshape(len(names) + 2, 1, count)
    indices = stats.sobol_indices(func={"f_A": parts[0], "f_B": parts[1], "f_AB": parts[2:]}, n=count)
    spread = indices.bootstrap(confidence_level=0.95, n_resamples=RESAMPLES)
    columns: dict[str, Any] = {}
    for name, order in (("first", "first_order"), ("total", "total_order")):
        ends = getattr(spread, order).confidence_interval
        columns |= {name: getattr(indices, order).ravel(), f"{name}_low": ends.low.ravel(), f"{name}_high": ends.high.ravel()}
    return pandas.DataFrame(columns, index=pandas.Index(names, name="input"))


def curve_bands(
    runs: Runs, name: str = "k", *, percentiles: Sequence[float] = (5, 50, 95), where: Any = None
) -> "xarray.Dataset":
    """Return percentiles of a curve over all cases, at each of its abscissae.

    Parameters
    ----------
    runs : Runs
    name : str
        A column of curves that have the same places in all cases.
    percentiles : sequence of float
    where : optional
        See `Runs.table`; failed cases are left out.

    Returns
    -------
    xarray.Dataset
        ``name`` over ``percentile`` and ``place``, with the phase as a coordinate where there is one.

    Raises
    ------
    ValueError
        If curves have other phases, or there is none.
    """
    parts = np.atleast_1d(numbers("percentiles", percentiles, " [%]"))
    if parts.ndim != 1 or not ((parts >= 0) & (parts <= 100)).all():
        raise ValueError(f"percentiles = {percentiles}, but give numbers from 0 to 100")
    curves = runs.curves([name], where)
    curves = curves.isel(number=curves["status"].to_numpy() == "done")
    if not curves.sizes["number"] or "phase" in curves.data_vars:
        raise ValueError("percentiles need curves at the same phases: choose cases of one geometry and span by where")
    bands = curves[[name]].quantile(parts / 100, dim="number", keep_attrs=True, skipna=False)
    return bands.rename(quantile="percentile").assign_coords(percentile=parts).dropna("place")


def roc_auc(healthy: Any, damaged: Any) -> float:
    """Compute the area under the ROC curve for separating healthy and damaged values (Mann-Whitney U).

    It is the probability that a random damaged gear has a larger value than a random healthy one. 0.5: no separation. 1: all
    damaged values are larger. Below 0.5: damage reduces the value.

    Parameters
    ----------
    healthy : array, shape (m,)
        Values of healthy gears, in any unit.
    damaged : array, shape (n,)
        Values of damaged gears, in the same unit.

    Returns
    -------
    float
        Between 0 and 1; equal values count half. nan if one of the values is nan.

    Raises
    ------
    ValueError
        If there are no values on one side, or they are no numbers.

    Examples
    --------
    >>> roc_auc([1.0, 2.0, 3.0], [2.5, 3.5, 4.5])
    0.8888888888888888
    """
    undamaged, hurt = numbers("healthy", healthy, ""), numbers("damaged", damaged, "")
    if undamaged.ndim != 1 or hurt.ndim != 1 or not undamaged.size or not hurt.size:
        raise ValueError("values of healthy and damaged gears: give a row of each, one value at least")
    return float(stats.mannwhitneyu(hurt, undamaged).statistic / (undamaged.size * hurt.size))


def _numbers(runs, output, where):
    """Return inputs, draw and a numeric output of the finished cases."""
    if output not in runs.fields or runs.fields[output].kind not in ("number", "whole"):
        known = [name for name, field in runs.fields.items() if field.kind == "number" and name not in runs.inputs]
        raise ValueError(f"{output!r} is no column of numbers; there is {', '.join(known)}")
    table = runs.table([*runs.inputs, "draw", "status", output], where)
    table = table[(table["status"] == "done") & table[output].notna()]
    if table.empty:
        raise ValueError(f"no finished case has a value of {output!r}")
    return table
