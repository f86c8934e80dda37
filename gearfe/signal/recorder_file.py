"""Channels of recorder files: WAV, universal file 58 (UFF), TDMS, Parquet. Each format has its own library."""

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from ..core.extras import needing
from ..core.threads import Shared, own_warnings
from ..geometry.aliases import StrPath
from .found import Found, numeric
from .text_table import named

TIME_RESPONSE = 1  # function type of a data set 58 with a quantity over time
DIRECTIONS = {1: "+x", -1: "-x", 2: "+y", -2: "-y", 3: "+z", -3: "-z"}
EPOCH = np.datetime64("1970-01-01T00:00:00")
TDMS_UNITS = ("unit_string", "NI_UnitDescription", "unit")
SAID_NOTHING = ("", "none", "unknown")


@contextmanager
def _reading(path: StrPath, kind: str, begins: bytes = b"", ends: bytes = b"") -> Iterator[None]:
    """Convert errors of a library that reads a damaged file to ValueErrors of one line."""
    try:
        with open(path, "rb") as file:
            if file.read(len(begins)) != begins or (ends and file.read().split()[-1:] != [ends]):
                raise ValueError(f"it does not {f'end with {ends.decode()}' if ends else f'begin with {begins.decode()}'}")
        yield
    except Exception as error:  # pyuff raises `Exception`; scipy and npTDMS raise any type, such as NameError.
        if isinstance(error, OSError) and error.strerror:
            raise ValueError(f"cannot read {path}: {error.strerror}") from error
        reason = " ".join(str(error).split()) or type(error).__name__
        if isinstance(error, RecursionError):
            reason = "something in it, such as the source of a scale, refers to itself"
        raise ValueError(f"{path} is not a whole {kind} file: {reason}") from error


def wav_file(path: StrPath) -> Found:
    """Return the channels of a WAV file. Whole numbers are divided by the full scale."""
    from scipy.io import wavfile

    with _reading(path, "WAV"):
        with own_warnings(wavfile.WavFileWarning) as caught:
            rate, data = wavfile.read(path)
        for one in caught:
            if "not understood" not in str(one.message):  # Chunks of other programs are allowed.
                raise one.message
    whole = data.dtype.kind != "f"
    if whole:
        data = (data.astype(float) - 128) / 128 if data.dtype == np.uint8 else data / -float(np.iinfo(data.dtype).min)
    recording = Found({f"channel {i}": one for i, one in enumerate(np.atleast_2d(data.T), 1)}, parts=whole)
    recording.rates = dict.fromkeys(recording.vectors, float(rate))
    return recording


def uff_file(path: StrPath) -> Found:
    """Return the channels of a universal file: data sets 58 (functions at nodes) that are responses over time."""
    with needing("pyuff"):
        import pyuff
    with _reading(path, "universal file (UFF)", ends=b"-1"), own_warnings(Warning):
        sets = pyuff.UFF(os.fspath(path)).read_sets()
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
    labels = [text for key in ("id1", "rsp_ent_name") if (text := _said(one.get(key, "")))]
    name = f"{(labels or ['channel'])[0]} {one['rsp_node']}{DIRECTIONS.get(one['rsp_dir'], '')}"
    step = one.get("abscissa_inc", 0) if one.get("abscissa_spacing") == 1 else 0
    found.add(name, np.asarray(data), _said(one.get("ordinate_axis_units_lab", "")), step, one.get("abscissa_min", 0.0))


def _said(text):
    return "" if str(text).strip().lower() in SAID_NOTHING else str(text).strip()


def tdms_file(path: StrPath) -> Found:
    """Return the channels of a TDMS file as ``group/channel`` (``channel`` for a single group), with units and increments."""
    with needing("npTDMS"):
        from nptdms import TdmsFile
    with _reading(path, "TDMS", begins=b"TDSm"):
        with _quiet:
            file = TdmsFile.read(path)
        groups = file.groups()
        series = [(group.name, channel, np.asarray(channel[:])) for group in groups for channel in group.channels()]
        if file.file_status.incomplete_final_segment:
            raise ValueError("its last segment is cut; record or copy it again")
    recording = Found({}, nested="/" if len(groups) > 1 else "")
    for key, value in file.properties.items():
        recording.state(str(key), value)
    for group, channel, data in series:
        name, properties = f"{group}/{channel.name}" if recording.nested else channel.name, channel.properties
        if not numeric(data) or data.size < 2:
            recording.other.append(f"{name!r} ({data.dtype}, {data.size} values)")
            continue
        unit = next((properties[key] for key in TDMS_UNITS if properties.get(key)), "")
        begun = properties.get("wf_start_time", EPOCH)
        seconds = (begun - EPOCH) / np.timedelta64(1, "us") * 1e-6 if isinstance(begun, np.datetime64) else 0.0
        start = float(seconds) + float(properties.get("wf_start_offset", 0.0))
        recording.add(name, data, unit, properties.get("wf_increment", 0), start)
    return recording


@contextmanager
def _no_log():
    """Suppress the library's log of damage, because damage raises an error."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(before)


_quiet = Shared(_no_log)


def labview_file(path: StrPath, lines: list[str]) -> Found:
    """Return the channels of a LabVIEW file (``.lvm``) with one segment, whose header states names, units and step."""
    with needing("lvm-read"):
        import lvm_read
    with _reading(path, "LabVIEW measurement"):  # `lvm_read.read` is unsafe: it loads a pickle file of the same name.
        parts = lvm_read.read_str("\n".join(lines) + "\n")
        segment = parts[0]
        columns, names = np.atleast_2d(segment["data"]).T, segment["Channel names"]
        stated = next(iter(segment.get("Samples", [])), columns.shape[1])
        if stated != columns.shape[1]:
            raise ValueError(f"the file contains {columns.shape[1]} of {stated} samples")
    if parts["Segments"] != 1:
        raise ValueError(f"{path} has {parts['Segments']} segments: save each of them as a file")
    first = 0 if parts.get("X_Columns") == "No" else 1
    recording = Found({})
    for place in range(first, len(columns), 2 if parts.get("X_Columns") == "Multi" else 1):
        if names[place] == "Comment":
            break
        column = place - first  # The header has no entry for a single time column.
        unit, step, start = (_entry(segment, key, column) for key in ("Y_Unit_Label", "Delta_X", "X0"))
        recording.add(names[place].strip() or "channel", columns[place], unit, step or 0, start or 0.0)
    return recording


def _entry(segment, key, column):
    """Return the entry of a column in a header line, or an empty text if the line is too short."""
    values = segment.get(key, [])
    return values[column] if column < len(values) else ""


def parquet_file(path: StrPath) -> Found:
    """Return the columns of a Parquet file. Units are part of names, ``a [m/s^2]``, or ``unit`` in a field's metadata."""
    with needing("pyarrow"):
        import pyarrow as pa
        import pyarrow.parquet as pq
    with _reading(path, "Parquet"):
        table = pq.ParquetFile(path).read()
    recording = Found({})
    for key, value in (table.schema.metadata or {}).items():
        recording.state(key.decode("utf-8", "replace"), value.decode("utf-8", "replace"))
    for field, column in zip(table.schema, table.columns, strict=True):
        name, unit = named(field.name)
        if pa.types.is_timestamp(field.type) or pa.types.is_duration(field.type):
            if column.null_count:
                raise ValueError(f"{path}: {column.null_count} times of {name!r} are missing; remove or replace these rows")
            count = column.cast(pa.int64()).to_numpy()
            seconds = (count - count[:1]) * {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[column.type.unit]
            recording.take_clock(path, name, column.type, seconds, 4)
        elif pa.types.is_integer(field.type) or pa.types.is_floating(field.type):
            recording.add(name, column.to_numpy(), unit or (field.metadata or {}).get(b"unit", b"").decode("utf-8", "replace"))
        else:
            recording.other.append(f"{field.name!r} ({field.type})")
    return recording
