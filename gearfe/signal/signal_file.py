"""Measured signals from files of many formats. Rate and unit come from the file or the caller. They are never guessed."""

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..core.files import read, suffix_of
from ..geometry.aliases import StrPath
from .array_file import array_file, hdf_file
from .channel import signal_of
from .found import Found
from .recorder_file import labview_file, parquet_file, tdms_file, uff_file, wav_file
from .series import Signal
from .tachometer import SPEEDS, with_speed_record, with_tachometer
from .text_table import text_table

LONGEST = 60  # longest unit [characters]
READERS = {
    ".npz": array_file, ".mat": array_file, ".h5": hdf_file, ".hdf5": hdf_file, ".wav": wav_file, ".uff": uff_file,
    ".unv": uff_file, ".uf": uff_file, ".tdms": tdms_file, ".parquet": parquet_file,
}  # fmt: skip


def read_signal(
    path: StrPath,
    *,
    column: str | None = None,
    rate: float | None = None,
    unit: str | None = None,
    shaft_frequency: float | None = None,
    header: str | None = None,
    scale: float = 1.0,
) -> Signal:
    """Read one channel of a file of measured signals. See `read_signals` for several channels.

    The rate is ``rate`` (or ``fs``, ``sampling_rate``, ``sample_rate``, ``sampling_frequency``) [Hz] in the file, or follows from
    ``time`` (or ``t``), or is an argument. If it is given twice, the values must agree. The unit is in the file or an argument.

    - ``.csv``, ``.txt``: columns by comma, semicolon, tab or blanks, numbers with a decimal point or comma. The last row above
      the numbers, or the last comment (# or %), has the names of the columns and their units: ``time [s], housing [m/s^2]``.
      Units may be in a row below the names. Rows above are titles. Time is in s, ms or us, a shaft's ``angle`` in rad or deg.
      Titles and comments may state ``rate = 61440 Hz``, ``unit = m/s^2``, ``shaft_frequency = 16.7 Hz``. The encoding is UTF-8 or
      UTF-16. There are warnings for Windows-1252, thousands separators, empty cells, clock times (``2024-03-12 10:00:00.25``,
      ``10:00:00,25``), which become the time, and times rounded to more than a tenth of a step.
    - ``.mat`` (also of version 7.3), ``.npz``, ``.h5``, ``.hdf5``: vectors by name, columns of long matrices (``acc 1``), fields
      of structs (``run.acc``) and cells (``run{2}``); ``time`` [s], ``angle`` [rad]; scalars ``rate``, ``shaft_frequency`` [Hz];
      text or attribute ``unit``. A response that gearfe wrote: columns by channel.
    - ``.wav``: ``channel 1``...; whole numbers as parts of full scale, to be given `unit` and `scale`.
    - ``.uff``, ``.unv`` (data sets 58, functions over time), ``.tdms``, ``.parquet``, ``.lvm`` (or text that begins with
      ``LabVIEW Measurement``): channels with the units and steps stated; dates of a clock in Parquet are the time.

    Nothing is unpickled, no other file is opened, and an archive, MATLAB or HDF5 file that states more numbers than it can hold
    is rejected. HDF5, version 7.3, UFF, TDMS, Parquet and LVM need ``pip install 'gearfe[signals]'``.

    Parameters
    ----------
    path : path
    column : str, optional
        Name of the channel; the part behind its groups or behind a blank is sufficient if only one name ends so. Needed if there
        are several channels.
    rate, shaft_frequency : float, optional
        Sampling rate and shaft frequency [Hz]. If the file itself has several rates, the one that `rate` names counts.
    unit : str, optional
    header : str, optional
        Header of a text table without names: ``"time [s], housing [m/s^2]"``.
    scale : float
        Calibration factor, for instance of the sensor: `unit` per unit in the file. Then `unit` replaces the unit of the file.

    Returns
    -------
    Signal
        Named after file and column.

    Raises
    ------
    ValueError
        The message states file and cause: no rate, two rates, times that fall or have gaps, no unit, an unknown unit, several
        columns, a cell that is no number (with its line), a sample that is not finite, a damaged file; and the contents.
    RuntimeError
        If the library that reads the format is missing.
    """
    recording = channels(path, header)
    name = _choose(path, recording, column)
    return signal_of(path, recording, name, rate=rate, unit=unit, shaft_frequency=shaft_frequency, scale=scale)


def read_signals(
    path: StrPath,
    columns: Sequence[str] | None = None,
    *,
    units: str | Mapping[str, str] | None = None,
    tachometer: str | None = None,
    pulses: int = 1,
    ratio: float = 1.0,
    level: float | None = None,
    **stated: Any,
) -> dict[str, Signal]:
    """Read channels of a file, by name. See `read_signal` for the formats.

    Channels that begin or end at different times, as TDMS and universal files may state, are cut to the time that they share,
    to the nearest sample.

    Parameters
    ----------
    path : path
    columns : sequence of str, optional
        Default: all, the tachometer excepted.
    units : str or dict of str to str, optional
        Of all channels, or by channel; where the file states none.
    tachometer : str, optional
        Channel of pulses of the shaft, from which all others get their `angle`: see `gearfe.with_tachometer`. If its unit is
        ``rpm`` or ``1/min`` it is taken for the speed of the shaft, with a warning, and its integral for the angle. A channel
        that is shorter than the others, with values that rise, contains the times of the pulses [s].
    pulses : int
        Pulses per revolution of the tachometer's shaft.
    ratio : float or fractions.Fraction
        Speed of the gear's shaft over that of the tachometer's shaft; 1 if the tachometer is on the gear's shaft.
    level : float, optional
        At which a pulse counts, in the tachometer's unit; default: half its height.
    **stated
        ``rate``, ``header``, ``scale`` of `read_signal`; ``unit`` is another name of `units`.

    Returns
    -------
    dict of str to Signal
        By the full name of the channel; with a tachometer that of pulses, from its first to its last pulse.

    Raises
    ------
    ValueError
        As `read_signal`; if `columns`, `units` or `tachometer` name no channel of the file, or `columns` is empty where there are
        several; if `pulses` is no whole number from 1 on, the tachometer has fewer than 4 pulses or lost one, or its speed is not
        above 0 everywhere.
    RuntimeError
        If the library that reads the format is missing.
    """
    units = stated.pop("unit", units)
    recording = channels(path, stated.pop("header", None))
    pulse = None if tachometer is None else _choose(path, recording, tachometer)
    every = [channel for channel in recording.channels() if channel != pulse]
    names = every if columns is None else [_choose(path, recording, column) for column in columns]
    if not names:
        _choose(path, recording, None)
    by_name = _units(path, recording, units, names)
    out = {name: signal_of(path, recording, name, unit=by_name.get(name), **stated) for name in names}
    if pulse is None:
        return _aligned(path, recording, out)
    return _with_angle(path, recording, out, pulse, stated.get("rate"), {"pulses": pulses, "ratio": ratio, "level": level})


def _units(path, recording, units, names):
    """Return units by channel. A single unit applies to channels without a unit, and must agree with that of a single channel."""
    if not isinstance(units, Mapping):
        return {name: units for name in names if units and (len(names) == 1 or not recording.units.get(name))}
    if unknown := [name for name, unit in units.items() if name not in recording.vectors and unit is not None]:
        raise ValueError(f"{path}: units for {', '.join(map(repr, unknown))}, but it has {recording.told()}")
    return units


def _with_angle(path, recording, out, pulse, rate, options):
    """Return the signals with the shaft angle from a channel of pulses, pulse times or speed."""
    times, ratio = recording.vectors[pulse], options["ratio"]
    if times.size < min(channel.values.size for channel in out.values()) and (np.diff(times) > 0).all():
        starts = {name: times - recording.starts.get(name, 0.0) for name in out}
        return {name: with_tachometer(channel, starts[name], options["pulses"], ratio=ratio) for name, channel in out.items()}
    clock = signal_of(path, recording, pulse, unit=None if recording.units.get(pulse) else "1", rate=rate)
    out = _aligned(path, recording, {**out, pulse: clock})
    clock = out.pop(pulse)
    if clock.unit in SPEEDS:
        meaning = "taken for the shaft's speed, its integral for the angle"
        warnings.warn(f"{path}: {pulse!r} is in {clock.unit}: {meaning}", stacklevel=4)
        return {name: with_speed_record(channel, clock, ratio=ratio) for name, channel in out.items()}
    return {name: with_tachometer(channel, clock, **options) for name, channel in out.items()}


def _aligned(path, found, signals):
    """Return the signals cut to their common time, if the file states different starts."""
    starts = {name: found.starts.get(name, 0.0) for name in signals}
    if len(set(starts.values())) == 1:
        return signals
    if not starts:
        raise ValueError("columns: give at least one")
    first = max(starts.values())
    last = min(start + signals[name].duration for name, start in starts.items())
    out = {}
    for name, signal in signals.items():
        skip, count = round((first - starts[name]) * signal.rate), round((last - first) * signal.rate)
        if count < 2:
            told = ", ".join(f"{name!r} at {start:g} s" for name, start in starts.items())
            raise ValueError(
                f"{path}: the channels have different time axes and start at {told}: select those of one time axis by columns="
            )
        out[name] = signal.part(skip, skip + count)
    return out


def channels(path: StrPath, header: str | None = None) -> Found:
    """Return the contents of a file: channels, units and rates.

    ValueError if its suffix is unknown, or if it is unreadable, is damaged, or holds no channel.
    """
    suffix = suffix_of(path, "signal", reading=True)
    try:
        lines = [] if suffix in READERS else read(path, "signal")
        labview = suffix == ".lvm" or "".join(lines[:1]).startswith("LabVIEW Measurement")
        if header is not None and (labview or suffix in READERS):
            raise ValueError(f"{path}: header = {header!r}, but only text tables can be without column names; omit header")
        if suffix in READERS:
            recording = READERS[suffix](path)
        else:
            recording = labview_file(path, lines) if labview else text_table(path, lines, header)
    except OSError as error:
        raise ValueError(f"cannot read {path}: {error.strerror or error}") from error
    if not recording.vectors:
        raise ValueError(f"{path}: no vector of real numbers; it has {recording.told()}")
    strange = [name for name, unit in recording.units.items() if not unit.isprintable() or len(unit) > LONGEST]
    if strange:
        raise ValueError(f"{path}: the unit of {strange[0]!r} is not readable text: the file is damaged")
    return recording


def _choose(path, found, column):
    """Return the full name of the requested channel."""
    names = found.channels()
    if column is None and len(names) == 1:
        return names[0]
    if column in found.vectors:
        return column
    same = [name for name in names if column and (found.leaf(name) == column or name.endswith(f" {column}"))]
    if len(same) == 1:
        return same[0]
    if column is None and found.hint:
        raise ValueError(f"{path}: {found.hint}, or a column")
    if not names:
        raise ValueError(f"{path}: no column of values, only {' and '.join(map(repr, found.vectors))}; rename one of them")
    asked = f"no column {column!r}" if column is not None else f"{len(names)} columns of values"
    raise ValueError(f"{path}: {asked}; it has {found.told()}: give one as column=")
