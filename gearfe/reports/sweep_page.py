"""`sweep_report`: a self-contained page of the results of a sweep."""

import json
from pathlib import Path

import numpy as np

from ..core.table import Column, Table
from ..geometry.aliases import StrPath
from ..runs.sweeps.effects import curve_bands, main_effects
from ..runs.sweeps.runs import Runs, open_runs
from .figures import BAND, blank, part_of_page, style
from .template import page_maker

SIZE = {"height": 420, "hovermode": "closest"}
IN_UM = {"N/m": (1e-6, "N/um"), "m": (1e6, "um")}  # factor and unit by unit of the results
SHOWN = {  # by type of study: output for main effects, and curve for bands
    "stiffness": ("k_mean", "k"),
    "transmission error": ("te_peak_to_peak", "te"),
    "set": ("k_planet_ring", None),
    "vibration": ("rms", None),
    "growth": ("revolutions", None),
}


def sweep_report(runs: Runs | StrPath, path: StrPath) -> Path:
    """Write a self-contained page of a sweep: inputs, results, effects of inputs, bands of curves, provenance.

    Parameters
    ----------
    runs : Runs, str or path
        Result of `gearfe.open_runs`, or the folder of the sweep.
    path : path
        A ``.html`` file.

    Raises
    ------
    ValueError
        If the page could not be written, or there are no results.
    RuntimeError
        If plotly, jinja2, pandas or xarray is missing; the message has the command that installs them.
    """
    write = page_maker(path, "sweep.html")
    runs = runs if isinstance(runs, Runs) else open_runs(runs)
    table, study = runs.table(), runs.about["study"]
    output, curve = SHOWN[study["kind"]]
    return write(
        title=runs.about["title"], there=len(table), cases=runs.about["cases"], study=study, made=runs.about["made"],
        varied=_varied(table, runs), numbers=_numbers(table, runs), failed=_failed(table),
        output=f"{output} [{_unit(runs, output)[1]}]", several=len(runs.inputs) > 1,
        effects=_effects(runs, output), bands=_bands(runs, curve),
        seconds=f"{table['seconds'].sum():.4g} s",
        each=f"{table['seconds'].median():.3g} s", text=json.dumps(study, indent=1),
        versions=", ".join(f"{name} {value}" for name, value in runs.about["made"].items()),
    )  # fmt: skip


def _varied(table, runs):
    """`Table` of the inputs with their values."""
    rows = []
    for name in runs.inputs:
        column = table[name]
        plain = column.dtype.kind in "if"
        ends = (column.min(), column.max()) if plain else (str(column.iloc[0]), str(column.iloc[-1]))
        rows.append([name, column.nunique(), *ends])
    whole, value = Column("distinct values", form="{}"), Column("", form="{:.6g}")
    return Table(("input", whole, value._replace(name="from"), value._replace(name="to")), rows)


def _numbers(table, runs):
    """`Table` of the percentiles of the outputs."""
    rows, skipped = [], {*runs.inputs, "point", "draw", "seconds"}
    for name, field in runs.fields.items():
        column = table[name].dropna() if name in table and field.kind == "number" and name not in skipped else ()
        if len(column):
            factor, unit = _unit(runs, name)
            rows.append([name, unit, *factor * np.percentile(column, (0, 5, 50, 95, 100))])
    return Table(("output", "unit", "minimum", "5 %", "median", "95 %", "maximum"), rows)


def _unit(runs, name):
    """Return factor and unit in which the page states a result."""
    unit = runs.units[name]
    return IN_UM.get(unit, (1.0, unit))


def _failed(table):
    """`Table` of the errors with their numbers of cases."""
    count = table.loc[table["status"] != "done", "error"].value_counts()
    return Table((Column("cases", form="{}"), "error"), [(n, text) for text, n in count.head(20).items()])


def _effects(runs, output):
    """Return main effects: a single input over its values, several inputs over their own ranges."""
    factor, unit = _unit(runs, output)
    single = runs.inputs[0] if len(runs.inputs) == 1 else None
    figure = blank(single or "position in the range of the input", f"mean {output} [{unit}]", **SIZE)
    for i, (name, effects) in enumerate(main_effects(runs, output).groupby("input", sort=False)):
        texts = [str(value) if isinstance(value, str) else f"{value:.5g}" for value in effects["value"]]
        figure.add_scatter(
            x=texts if single else np.linspace(0, 1, len(effects)), y=factor * effects["mean"], name=name,
            mode="lines+markers", text=texts,
            line=style(i) | {"width": 2},
            hovertemplate="%{text}: %{y:.5g}",
        )  # fmt: skip
    return part_of_page(figure, "figure-effects")


def _bands(runs, curve):
    """Return the median and the 5 to 95 % band of the curves. Both are empty without common abscissae."""
    if curve is None:
        return ""
    try:
        bands = curve_bands(runs, curve)
    except ValueError:  # The cases have different phases.
        return ""
    factor, unit = _unit(runs, curve)
    phase, (low, middle, high) = bands["phase"].to_numpy(), factor * bands[curve].to_numpy()
    figure = blank("mesh phase", f"{curve} [{unit}]", **SIZE)
    band = {"x": np.concatenate([phase, phase[::-1]]), "y": np.concatenate([high, low[::-1]]), "mode": "lines"}
    figure.add_scatter(**band, **BAND, name="5 to 95 %")
    figure.add_scatter(x=phase, y=middle, mode="lines", line={"color": "#0072b2"}, name="median")
    return part_of_page(figure, "figure-bands")
