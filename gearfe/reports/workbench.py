"""`signal_workbench`: analyses of vibration records as pictures, tables and one page in a folder."""

import math
import re
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..core.table import Column, Table
from ..figures.vibration_plots import plot_averages, plot_kurtogram, plot_spectra
from ..geometry.aliases import StrPath
from ..signal.kurtogram import fast_kurtogram
from ..signal.orders import order_spectrum, residual_signal, synchronous_average
from ..signal.series import Signal
from ..signal.spectra import spectrum, squared_envelope_spectrum
from ..signal.spectral_lines import expected_lines
from ..signal.spectrum import Spectrum
from ..stiffness.provenance import versions
from .template import embedded, page_maker

UNSAFE = re.compile(r"[^\w.-]+")  # characters not allowed in file names
HARMONICS = 4  # number of fault harmonics marked in the envelope spectrum


class WorkbenchPart(NamedTuple):
    """Picture of the workbench: file name, title, ``draw(path=)``, and its tables by record."""

    name: str
    title: str
    draw: Callable[..., Any]
    tables: dict[str, Table]


def signal_workbench(
    signals: Mapping[str, Signal],
    folder: StrPath,
    *,
    teeth: int | None = None,
    fault: float | None = None,
    verdict: str = "",
    tables: Mapping[str, Table] | None = None,
    simulated: Mapping[str, Signal] | None = None,
    command: str = "",
) -> Path:
    """Write analyses of records into a folder: spectrum, envelope, kurtogram, and with `teeth` average, residual, orders.

    Each part is a picture (``.png``) and a table of each record (``.csv``). ``page.html`` shows all of them.

    Parameters
    ----------
    signals : dict of str to Signal
        Records by name, the healthy one first. With `teeth` each needs `angle` or `shaft_frequency`.
    folder : path
        Made if it does not exist; files of the same names are replaced.
    teeth : int, optional
        Number of teeth of the gear on that shaft.
    fault : float, optional
        Fault frequency [Hz], marked in the spectrum of the envelope.
    verdict : str
        First sentence of the page.
    tables : dict of str to Table, optional
        Further tables of the page by title.
    simulated : dict of str to Signal, optional
        Simulated records of the same gear; average and order spectrum are shown after the measured ones.
    command : str
        Command that makes the page, printed at its end.

    Returns
    -------
    Path
        Of the page.

    Raises
    ------
    ValueError
        If the folder cannot be written, or a record lacks its shaft.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write = page_maker(folder / "page.html", "signal.html")
    shown = []
    parts = [*_of_time(signals, fault), *(_of_angle(signals, teeth) if teeth else ())]
    if teeth and simulated:
        parts += [part._replace(name=f"simulated_{part.name}", title=f"Simulated mesh force: {part.title}") for part in
                  _of_angle(simulated, teeth)]  # fmt: skip
    for part in parts:
        picture = folder / f"{part.name}.png"
        part.draw(path=picture)
        for record, table in part.tables.items():
            table.save(folder / f"{part.name}_{UNSAFE.sub('_', record)}.csv")
        shown.append(embedded(picture, part.title))
    about = [
        f"{name}: {one.values.size} samples at {one.rate:.6g} Hz, {one.duration:.4g} s, {one.unit}"
        for name, one in signals.items()
    ]
    return write(
        title=", ".join(signals), verdict=verdict, about=about, pictures=shown, tables=tables or {}, command=command,
        version=versions()["gearfe"],
    )  # fmt: skip


def _of_time(signals, fault):
    """Return the parts that need no shaft angle."""
    kurtograms = {name: fast_kurtogram(record) for name, record in signals.items()}
    last = list(signals)[-1]
    band = kurtograms[last].band
    envelopes = {name: squared_envelope_spectrum(record, band) for name, record in signals.items()}
    lines = {f"{k} x fault" if k > 1 else "fault": k * fault for k in range(1, HARMONICS + 1)} if fault else None
    top = None if lines else min(500.0, envelopes[last].frequency[-1])
    spectra = {name: spectrum(record) for name, record in signals.items()}
    yield _spectra("spectrum", "Amplitude spectrum", spectra, None, spectra[last].frequency[-1])
    title = f"Squared envelope from {band[0]:.0f} to {band[1]:.0f} Hz, the most impulsive band of {last}"
    yield _spectra("envelope", title, envelopes, lines, top)
    for name, found in kurtograms.items():
        rows = np.column_stack([found.centre, found.bandwidth, found.kurtosis]).tolist()
        columns = (Column("centre", "Hz"), Column("bandwidth", "Hz"), Column("kurtosis"))
        draw = partial(plot_kurtogram, found, title=name)
        yield WorkbenchPart(
            f"kurtogram_{list(signals).index(name) + 1}", f"Kurtogram of {name}", draw, {name: Table(columns, rows)}
        )


def _of_angle(signals, teeth):
    """Return the parts over the shaft angle: order spectrum, average and difference signal."""
    orders = {name: order_spectrum(record) for name, record in signals.items()}
    lines = {name.replace("f_m", "mesh"): at for name, at in expected_lines(teeth, None, count=1, harmonics=3).items()}
    yield _spectra("orders", "Order spectrum", orders, lines, None)
    averages = {name: _from_zero(synchronous_average(record)[0], record) for name, record in signals.items()}
    parts = {name: (one, residual_signal(one, teeth, sidebands=1)) for name, one in averages.items()}
    unit = next(iter(signals.values())).unit
    columns = (Column("angle", "deg"), Column("average", unit), Column("difference signal", unit))
    tables = {
        name: Table(columns, np.column_stack([360 * np.arange(one.size) / one.size, one, rest]).tolist())
        for name, (one, rest) in parts.items()
    }
    title = f"Synchronous average (TSA) and difference signal of the {teeth}-tooth gear"
    yield WorkbenchPart("average", title, partial(plot_averages, parts, teeth, unit=unit), tables)


def _from_zero(average, record):
    """Return an average that starts at shaft angle 0 instead of the angle of the first sample, within half a sample."""
    return np.roll(average, round(record.shaft_angle[0] / (2 * np.pi) * average.size))


def _spectra(name, title, found: dict[str, Spectrum], lines, top):
    """Return the part with the spectra of all records."""
    columns = {one: (Column("order" if each.axis == "order" else "frequency", "" if each.axis == "order" else "Hz"),
                     Column("amplitude", each.unit)) for one, each in found.items()}  # fmt: skip
    tables = {one: Table(columns[one], np.column_stack([each.frequency, each.values]).tolist()) for one, each in found.items()}
    return WorkbenchPart(name, title, partial(plot_spectra, found, lines, top=top), tables)


def trend_table(rows: Mapping[str, Mapping[str, float]]) -> Table:
    """Return a `Table` of indicators with a row per record, in the order of measurement."""
    names = list(next(iter(rows.values())))
    columns = ["record", *(Column(name, "", "{:.4g}") for name in names)]
    return Table(columns, [[record, *(row.get(name, math.nan) for name in names)] for record, row in rows.items()])
