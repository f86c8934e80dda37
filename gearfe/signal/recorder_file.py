"""Channels of files that recorders write: WAV, universal file 58 (UFF), TDMS, Parquet; each read by its own library."""

import logging
import os
import struct
import warnings
from contextlib import contextmanager
from typing import Any

import numpy as np

from ..core.extras import needing
from ..core.files import read_text
from ..core.threads import Shared, own_warnings
from .found import TIMES, Found, numeric, plain
from .text_table import named

TIME_RESPONSE = 1  # function type of a data set 58 that holds a quantity over time
DIRECTIONS = {1: "+x", -1: "-x", 2: "+y", -2: "-y", 3: "+z", -3: "-z"}
EPOCH = np.datetime64("1970-01-01T00:00:00")
TDMS_UNITS = ("unit_string", "NI_UnitDescription", "unit")
SAID_NOTHING = ("", "none", "unknown")
# what scipy and npTDMS, which trust their files, raise when these are damaged (NameError: a chunk is missing)
DAMAGE: tuple[type[Exception], ...] = (ArithmeticError, AttributeError, EOFError, LookupError, MemoryError, NameError)
DAMAGE += (NotImplementedError, OSError, RecursionError, TypeError, ValueError, Warning, struct.error)


def wav_file(path: str | os.PathLike[str]) -> Found:
    """Channels of a WAV file: whole numbers as parts of its full scale, divided by the largest the file can hold."""
    from scipy.io import wavfile

    try:
        with own_warnings(wavfile.WavFileWarning) as caught:
            rate, data = wavfile.read(path)
        for one in caught:
            if "not understood" not in str(one.message):  # chunks of other programs
                raise one.message
    except DAMAGE as error:
        raise _damaged(path, "WAV", error) from error
    values = _full_scale(np.atleast_2d(data.T))
    recording = Found({f"channel {i}": one for i, one in enumerate(values, 1)}, parts=data.dtype.kind != "f")
    recording.rates = dict.fromkeys(recording.vectors, float(rate))
    return recording


def _full_scale(data):
    if data.dtype.kind == "f":
        return data
    if data.dtype == np.uint8:
        return (data.astype(float) - 128) / 128
    return data / -float(np.iinfo(data.dtype).min)


def uff_file(path: str | os.PathLike[str]) -> Found:
    """Channels of the data sets 58 (functions at nodes) of a universal file that are responses over time."""
    with needing("pyuff"):
        import pyuff
    try:
        with open(path, "rb") as file:
            end = file.read().split()[-1:]
    except OSError as error:
        raise ValueError(f"cannot read {path}: {error.strerror or error}") from error
    if end != [b"-1"]:
        raise ValueError(f"{path} is not a whole universal file (UFF): it does not end with -1")
    try:
        with own_warnings(Warning):
            sets = pyuff.UFF(os.fspath(path)).read_sets()
    except Exception as error:  # pyuff itself raises just Exception
        raise _damaged(path, "universal file (UFF)", error) from error
    recording = Found({})
    for data_set in sets if isinstance(sets, list) else [sets]:
        _uff_set(recording, data_set)
    return recording


def _uff_set(found: Found, one: dict[str, Any]) -> None:
    """Add a data set."""
    kind, data = one.get("type"), one.get("data")
    if kind != 58 or one.get("func_type") != TIME_RESPONSE or not numeric(data):
        text = f"function type {one.get('func_type')}" if kind == 58 else f"of type {kind}"
        found.other.append(f"a data set {text} (no response over time)")
        return
    labels = [str(one.get(key, "")).strip() for key in ("id1", "rsp_ent_name")]
    label = next((text for text in labels if text.lower() not in SAID_NOTHING), "channel")
    name = f"{label} {one['rsp_node']}{DIRECTIONS.get(one['rsp_dir'], '')}"
    name = _free(found, name)
    unit = str(one.get("ordinate_axis_units_lab", "")).strip()
    found.vectors[name], found.units[name] = np.asarray(data), "" if unit.lower() in SAID_NOTHING else unit
    if one.get("abscissa_spacing") == 1 and one.get("abscissa_inc", 0) > 0:
        found.rates[name] = 1 / float(one["abscissa_inc"])
        found.starts[name] = float(one.get("abscissa_min", 0.0))


def _free(found, name):
    """Name, with a number appended if it is already used."""
    taken = [vector for vector in found.vectors if vector == name or vector.startswith(f"{name} (")]
    return f"{name} ({len(taken) + 1})" if taken else name


def tdms_file(path: str | os.PathLike[str]) -> Found:
    """Channels of a TDMS file, ``group/channel`` (``channel`` if there is one group), with their units and increments."""
    with needing("npTDMS"):
        from nptdms import TdmsFile
    try:
        with open(path, "rb") as file:
            if file.read(4) != b"TDSm":
                raise ValueError("it does not begin with TDSm")
        with _quiet:
            file = TdmsFile.read(path)
        groups = file.groups()
        values = {(group.name, series.name): series[:] for group in groups for series in group.channels()}
        status = file.file_status
    except DAMAGE as error:
        raise _damaged(path, "TDMS", error) from error
    if status.incomplete_final_segment:
        raise ValueError(f"{path} is not a whole TDMS file: its last segment is cut; record or copy it again")
    recording = Found({}, nested="/" if len(groups) > 1 else "")
    for key, value in file.properties.items():
        recording.state(str(key), value)
    for (group, channel), data in values.items():
        name = f"{group}/{channel}" if recording.nested else channel
        _tdms_channel(recording, name, np.asarray(data), file[group][channel].properties)
    return recording


@contextmanager
def _no_log():
    """Silence the log of the library about damage, which is raised as an error instead."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(before)


_quiet = Shared(_no_log)


def _tdms_channel(found: Found, name: str, data: Any, properties: Any) -> None:
    """Add a channel."""
    if not numeric(data) or data.size < 2:
        found.other.append(f"{name!r} ({data.dtype}, {data.size} values)")
        return
    found.vectors[name] = data
    found.units[name] = next((str(properties[key]).strip() for key in TDMS_UNITS if properties.get(key)), "")
    step = properties.get("wf_increment", 0)
    if isinstance(step, (int, float)) and step > 0:
        found.rates[name] = 1 / float(step)
        begun = properties.get("wf_start_time", EPOCH)
        seconds = (begun - EPOCH) / np.timedelta64(1, "us") * 1e-6 if isinstance(begun, np.datetime64) else 0.0
        found.starts[name] = float(seconds) + float(properties.get("wf_start_offset", 0.0))


def labview_file(path: str | os.PathLike[str], lines: list[str] | None = None) -> Found:
    """Channels of a LabVIEW measurement file (``.lvm``) with one segment, whose header states names, units and step."""
    with needing("lvm-read"):
        import lvm_read
    try:  # `lvm_read.read` would unpickle a file of the same name
        parts = lvm_read.read_str("\n".join(read_text(path) if lines is None else lines) + "\n")
        segment = parts[0]
        columns, names = np.atleast_2d(segment["data"]).T, segment["Channel names"]
    except DAMAGE as error:
        raise _damaged(path, "LabVIEW measurement", error) from error
    if parts["Segments"] != 1:
        raise ValueError(f"{path} has {parts['Segments']} segments: save each of them as a file")
    stated = next(iter(segment.get("Samples", [])), columns.shape[1])
    if stated != columns.shape[1]:
        raise ValueError(f"{path} is not a whole LabVIEW measurement file: {columns.shape[1]} of {stated} samples are there")
    several = parts.get("X_Columns") == "Multi"
    first = 0 if parts.get("X_Columns") == "No" else 1
    recording, units = Found({}), segment.get("Y_Unit_Label", [])
    for place in range(first, len(columns), 2 if several else 1):
        if names[place] == "Comment":
            break
        column = place - first  # of the header, which has no entry for a single time column
        name = _free(recording, names[place].strip() or "channel")
        recording.vectors[name] = columns[place]
        recording.units[name] = units[column].strip() if column < len(units) else ""
        steps, starts = (segment.get(key, []) for key in ("Delta_X", "X0"))
        if column < len(steps) and steps[column] > 0:
            recording.rates[name] = 1 / steps[column]
            recording.starts[name] = float(starts[column]) if column < len(starts) else 0.0
    return recording


def parquet_file(path: str | os.PathLike[str]) -> Found:
    """Columns of a Parquet file; units in the names, ``a [m/s^2]``, or as ``unit`` in the metadata of a field."""
    with needing("pyarrow"):
        import pyarrow as pa
        import pyarrow.parquet as pq
    try:
        table = pq.ParquetFile(path).read()
    except (OSError, pa.ArrowException, ValueError) as error:
        raise _damaged(path, "Parquet", error) from error
    recording = Found({})
    for key, value in (table.schema.metadata or {}).items():
        recording.state(key.decode("utf-8", "replace"), value.decode("utf-8", "replace"))
    for field, column in zip(table.schema, table.columns, strict=True):
        name, unit = named(field.name)
        if pa.types.is_timestamp(field.type) or pa.types.is_duration(field.type):
            _clock(path, recording, name, column, pa)
            continue
        if not (pa.types.is_integer(field.type) or pa.types.is_floating(field.type)):
            recording.other.append(f"{field.name!r} ({field.type})")
            continue
        field_unit = (field.metadata or {}).get(b"unit", b"").decode("utf-8", "replace")
        name = _free(recording, name)
        recording.vectors[name], recording.units[name] = column.to_numpy(), unit or field_unit
    return recording


def _clock(path, found, name, column, pa):
    """Dates of a clock, or times since a start, as the time [s] from the first on, whatever the column is called."""
    if column.null_count:
        raise ValueError(f"{path}: {column.null_count} times of {name!r} are missing; cut or mend these rows")
    if found.axes(TIMES):
        found.other.append(f"{name!r} ({column.type}, beside {found.axes(TIMES)[0]!r})")
        return
    count = column.cast(pa.int64()).to_numpy()
    seconds = (count - (count[0] if count.size else 0)) * {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[column.type.unit]
    taken = name if plain(name) in TIMES else "time"
    found.vectors[taken], found.units[taken] = seconds, "s"
    warnings.warn(f"{path}: {name!r} ({column.type}) is taken for the time, in seconds from its first row on", stacklevel=4)


def _damaged(path, kind, error):
    """Return what to raise for a file that its library cannot read, in one line."""
    if isinstance(error, OSError) and error.strerror:
        return ValueError(f"cannot read {path}: {error.strerror}")
    reason = " ".join(str(error).split()) or type(error).__name__
    if isinstance(error, RecursionError):
        reason = "something in it, such as the source of a scale, refers to itself"
    return ValueError(f"{path} is not a whole {kind} file: {reason}")
