"""Condition indicators of one gear from its synchronous average (TSA): FM0, FM4, M6A, M8A, NA4, NB4, ER, SLF.

The average over one revolution is split. The *regular* signal contains the orders of a healthy gear: shaft, mesh and its
harmonics with one sideband on either side. The *difference* signal is the rest. The *residual* signal also contains the
sidebands (`gearfe.residual_signal`).
"""

import math
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.table import Column, Table
from ..geometry.aliases import Floats
from .given import oscillation, samples
from .orders import mesh_coherence, residual_signal, synchronous_average
from .series import Signal

GEAR_SOURCES = {
    "FM0": "peak to peak of the average over the sum of its mesh lines' amplitudes; Stewart 1977, NASA TM 105950; one line 2",
    "FM4": "kurtosis of the difference signal d, N sum(d**4) / sum(d**2)**2; noise 3; Stewart 1977",
    "M6A": "N**2 sum(d**6) / sum(d**2)**3; noise 15; Martin 1989",
    "M8A": "N**3 sum(d**8) / sum(d**2)**4; noise 105; Martin 1989",
    "NA4": "N sum(r**4) over the square of the mean of sum(r**2) over this and all earlier records, r residual; NASA TM 105950",
    "NB4": "as NA4, of the envelope of the band around f_m without its mean; NASA TM 106467",
    "energy ratio": "rms of the difference signal over rms of the regular signal; Vecer 2005",
    "sideband level factor": "sum of the first sidebands' amplitudes f_m +- f_shaft over the rms of the average; Vecer 2005",
}
CLEAR = 3.0  # threshold relative to the median of adjacent orders; white noise exceeds it in 0.2 % of cases
SHARP = 0.9  # least part of the mesh line that an average must keep; below it, indicators of local faults change
EMPTY = 1e-9  # A smaller remainder, relative to the average, is a rounding error.


def gear_indicators(
    average: ArrayLike, teeth: int, *, before: Sequence[ArrayLike] = (), shaft_orders: int = 2
) -> dict[str, float]:
    """Compute the condition indicators of a gear from its synchronous average, by the names of `GEAR_SOURCES` (with formulae).

    ::

        d = x - regular,  FM4 = kurtosis(d),  M6A, M8A: its sixth and eighth moments,  ER = rms(d) / rms(regular)
        FM0 = (max x - min x) / sum_n A(n teeth),  SLF = (A(teeth - 1) + A(teeth + 1)) / rms(x)
        NA4 = N sum(r**4) / mean_j(sum(r_j**2))**2,  r = x without shaft and mesh orders, j over all records so far
        NB4: the same of |b + i H b| without its mean, b the orders from teeth / 2 to 3 teeth / 2

    x is the average without its mean. MATLAB's `gearConditionMetrics` has FM0, FM4, M6A, M8A, NA4 and energy ratio with the same
    names and sources. Its numbers were not compared.

    Parameters
    ----------
    average : ndarray, shape (n,)
        Synchronous average over one turn of the gear's shaft, see `gearfe.synchronous_average`.
    teeth : int
    before : sequence of ndarray
        Earlier averages of the same gear, in any order: NA4 and NB4 grow when the gear changes. Without them NA4 is the kurtosis
        of the residual signal.
    shaft_orders : int
        Orders of the shaft that a healthy gear shows too.

    Returns
    -------
    dict of str to float
        Without unit. Of a gear whose difference signal is nothing but rounding, nan for what would divide by it.

    Raises
    ------
    ValueError
        If the average is too short for its teeth, constant, or has no mesh line at all.

    Warns
    -----
    UserWarning
        If no mesh line stands out, so that the average is hardly that of this gear.

    References
    ----------
    - R. M. Stewart, Some useful data analysis techniques for gearbox diagnostics, ISVR (1977).
    - H. R. Martin, Statistical moment analysis as a means of surface damage detection, 7th Int. Modal Analysis Conf. (1989).
    - J. J. Zakrajsek, D. P. Townsend, H. J. Decker, NASA TM 105950 (1993); J. J. Zakrajsek, R. F. Handschuh, H. J. Decker, NASA
      TM 106467 (1994).
    - P. Vecer, M. Kreidl, R. Smid, Condition indicators for gearbox condition monitoring systems, Acta Polytechnica 45(6) (2005).
    - M. Lebold et al., Review of vibration analysis methods for gearbox diagnostics and prognostics, MFPT 54 (2000).
    """
    x = _turn(average)
    difference = residual_signal(x, teeth, sidebands=1, shaft_orders=shaft_orders)
    regular = x - difference
    amplitude = 2 / x.size * np.abs(np.fft.rfft(x))
    mesh = amplitude[teeth::teeth].sum()
    if not mesh > EMPTY * np.abs(x).max():
        raise ValueError(f"the average has no mesh line of {teeth} teeth: give the average over one revolution of that gear")
    if not has_mesh_line(amplitude, teeth):
        warnings.warn(
            f"the average has no line at {teeth} orders or their harmonics (FM0 {np.ptp(x) / mesh:.3g}), so its indicators do "
            "not describe that gear: check the teeth, and the ratio of its shaft to the tachometer's",
            stacklevel=2,
        )
    if not isinstance(before, (list, tuple)):
        raise ValueError(f"before is {type(before).__name__}, but give a list of earlier averages")
    history = [x, *map(_turn, before)]
    residuals = [residual_signal(turn, teeth, shaft_orders=shaft_orders) for turn in history]
    envelopes = [_band_envelope(turn, teeth) for turn in history]
    floor = EMPTY * _rms(x)
    return {
        "FM0": float(np.ptp(x) / mesh),
        "FM4": _moment(difference, 4, floor),
        "M6A": _moment(difference, 6, floor),
        "M8A": _moment(difference, 8, floor),
        "NA4": _against_history(residuals, floor),
        "NB4": _against_history(envelopes, floor),
        "energy ratio": _rms(difference) / _rms(regular),
        "sideband level factor": float((amplitude[teeth - 1] + amplitude[teeth + 1]) / _rms(x)),
    }


def has_mesh_line(amplitude, teeth):
    """Return whether one of the first three mesh orders exceeds the orders within half a mesh order."""
    for order in range(teeth, min(4 * teeth, amplitude.size), teeth):
        around = amplitude[max(order - teeth // 2, 1) : order + teeth // 2 + 1]
        if amplitude[order] > CLEAR * np.median(around):
            return True
    return False


def _by_name(signals):
    """Return records by name. Records of a list have their own names."""
    records = list(signals.values()) if isinstance(signals, Mapping) else signals
    if not records:
        raise ValueError("signals: give one record or more, by name or in a list")
    named = signals if isinstance(signals, Mapping) else {record.name: record for record in records}
    if len(named) < len(records):
        raise ValueError("two records have the same name: give them by name, in a dict")
    return named


def gear_indicator_table(
    signals: Mapping[str, Signal] | Sequence[Signal], teeth: int, *, samples_per_turn: int | None = None
) -> dict[str, dict[str, float]]:
    """Compute `gear_indicators` of several records in the order of measurement.

    Parameters
    ----------
    signals : dict of str to Signal, or list of Signal
        By name (default: their own), the earliest first, each with the `angle` or `shaft_frequency` of the gear's shaft.
    teeth : int
    samples_per_turn : int, optional
        See `gearfe.synchronous_average`; all records get the largest number any of them needs by itself.

    Returns
    -------
    dict of str to dict of str to float
        ``table[record][indicator]``; NA4 and NB4 over this and all earlier records.
    """
    named = _by_name(signals)
    for name, record in named.items():
        if (kept := mesh_coherence(record, teeth)) < SHARP:
            warnings.warn(
                f"{name}: the average keeps {100 * kept:.2g} % of the mesh line of {teeth} teeth, because the speed varies or "
                "differs from the one given; local faults are smeared: give tacho=, or speeds= to estimate the speed",
                stacklevel=2,
            )
    averages = {name: synchronous_average(record, samples_per_turn)[0] for name, record in named.items()}
    if len({record.size for record in averages.values()}) > 1:
        most = max(record.size for record in averages.values())
        averages = {name: synchronous_average(record, most)[0] for name, record in named.items()}
    records = list(averages.values())
    return {name: gear_indicators(one, teeth, before=records[:k]) for k, (name, one) in enumerate(averages.items())}


def tabulate_gear_indicators(found: Mapping[str, Mapping[str, float]]) -> Table:
    """Return a `Table` of `gear_indicator_table` with a row per indicator and a column per record."""
    columns = ["indicator", *(Column(record, form="{:.4g}") for record in found)]
    return Table(columns, [[name, *(row[name] for row in found.values())] for name in GEAR_SOURCES])


def _turn(average: Any) -> Floats:
    return oscillation(samples("average", average), "a constant average has no indicators")


def _rms(x):
    return math.sqrt(np.mean(np.square(x)))


def _moment(x, power, floor):
    """Return an even moment over the same power of the RMS value (4: kurtosis), or nan below the rounding limit `floor`."""
    spread = _rms(x)
    return float(np.mean((x / spread) ** power)) if spread > floor else math.nan


def _against_history(parts, floor):
    """Return the fourth moment of the first part over the squared mean variance of all parts."""
    mean = float(np.mean([np.mean(np.square(part)) for part in parts]))
    return float(np.mean(parts[0] ** 4)) / mean**2 if mean > floor**2 else math.nan


def _band_envelope(x, teeth):
    """Return the envelope of the band around the first mesh order, without its mean."""
    order = np.arange(x.size)
    kept = (order > teeth / 2) & (order < 1.5 * teeth) & (order < x.size / 2)
    envelope = np.abs(np.fft.ifft(np.where(kept, 2 * np.fft.fft(x), 0)))
    return envelope - envelope.mean()
