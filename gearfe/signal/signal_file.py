"""Measured signals from files: CSV, MATLAB and numpy. Rate and unit are stated, in the file or by the caller."""

import math
import os
import re
from pathlib import Path

import numpy as np

from ..files import read
from .series import Signal

TIME = {"s": 1.0, "ms": 1e-3, "us": 1e-6}
TURN = {"rad": 1.0, "deg": math.pi / 180}
HERTZ = {"": 1.0, "hz": 1.0, "khz": 1e3}
RATES = ("rate", "fs", "sampling rate", "sampling frequency")
TIMES, ANGLES, SHAFTS = ("time", "t"), ("angle", "shaft angle"), ("shaft frequency",)
UNEVEN = 0.1  # of a step: times printed with few digits stay below, a lost sample does not
AGREE = 1e-3  # between a stated rate and the time column


def read_signal(
    path: str | os.PathLike[str],
    *,
    column: str | None = None,
    rate: float | None = None,
    unit: str | None = None,
    shaft_frequency: float | None = None,
) -> Signal:
    """Read one signal from a ``.csv`` (or ``.txt``), ``.mat`` or ``.npz`` file.

    The rate is ``rate`` (or ``fs``, ``sampling_rate``, ``sampling_frequency``) [Hz], or follows from ``time`` (or ``t``), or is
    given here; where it is given twice the values must agree. The unit is stated beside the values, or here.

    - CSV: columns by comma, semicolon or tab, numbers with a decimal point. A header line, or the last comment (# or %)
      above the numbers, names the columns and their units: ``time [s], housing [m/s^2]``; time in s, ms or us, a shaft's
      ``angle`` in rad or deg. Comments may state ``# rate = 61440 Hz``, ``# unit = m/s^2``, ``# shaft_frequency = 16.7 Hz``.
    - .mat (up to version 7) and .npz: vectors by name, ``time`` [s], ``angle`` [rad]; scalars ``rate``, ``shaft_frequency``
      [Hz]; text ``unit``. A response that gearfe wrote (``values``, ``names``, ``units``): columns by channel.

    Parameters
    ----------
    path : path
    column : str, optional
        Name of the column or vector; needed if there are several.
    rate, shaft_frequency : float, optional
        [Hz].
    unit : str, optional

    Returns
    -------
    Signal
        Named after file and column.

    Raises
    ------
    ValueError
        Naming file and cause: no rate, two rates, times that fall or have gaps, no unit, an unknown unit, several columns, a
        cell that is no number (with its line), a sample that is not finite.
    """
    found = read(path, "signal")
    vectors, units, stated = _from_arrays(path, found) if isinstance(found, dict) else _from_lines(path, found)
    time, angle = (_special(path, vectors, units, names, scale) for names, scale in ((TIMES, TIME), (ANGLES, TURN)))
    name = _choose(path, vectors, column)
    unit_stated = {text.strip() for text in (unit, units.get(name), stated.get("unit")) if text and text.strip()}
    if len(unit_stated) != 1:
        given = f"units {', '.join(sorted(unit_stated))}" if unit_stated else "no unit"
        raise ValueError(f"{path}: {given} for {name!r}; give one, in the file ('{name} [m/s^2]', 'unit = m/s^2') or as unit=")
    turning = _one(path, "shaft_frequency", [shaft_frequency, *(stated[key] for key in SHAFTS if key in stated)])
    return Signal(
        vectors[name],
        _rate(path, rate, stated, time, vectors[name].size),
        unit_stated.pop(),
        f"{Path(path).stem} {name}",
        angle,
        turning,
    )


def _plain(name):
    return name.strip().lower().replace("_", " ")


def _special(path, vectors, units, names, scale):
    """Take the time or angle vector out of `vectors`, in s or rad; None if there is none."""
    found = [name for name in vectors if _plain(name) in names]
    if not found:
        return None
    if len(found) > 1:
        raise ValueError(f"{path}: {' and '.join(map(repr, found))}; keep one of them")
    unit = units.get(found[0], "")
    if unit not in scale:
        raise ValueError(
            f"{path}: column {found[0]!r} has unit {unit!r}, but must state one of {', '.join(scale)}: '{found[0]} [s]'".replace(
                "[s]", f"[{next(iter(scale))}]"
            )
        )
    return scale[unit] * vectors.pop(found[0])


def _choose(path, vectors, column):
    if column is None and len(vectors) == 1:
        return next(iter(vectors))
    if column is None or column not in vectors:
        asked = f"no column {column!r}" if column is not None else f"{len(vectors) or 'no'} columns of values"
        raise ValueError(f"{path}: {asked}; it has {', '.join(map(repr, vectors)) or 'none'}: give one as column=")
    return column


def _one(path, name, values):
    """The one finite positive number among `values` [Hz], which may be None; None if there is none."""
    numbers = []
    for value in (v for v in values if v is not None):
        match = re.fullmatch(r"\s*([-+.\d]+(?:e[-+]?\d+)?)\s*(\w*)\s*", str(value), re.IGNORECASE)
        try:
            number = float(match[1]) * HERTZ[match[2].lower()]
        except (TypeError, ValueError, KeyError):
            number = math.nan
        if not 0 < number < math.inf:
            raise ValueError(f"{path}: {name} = {str(value).strip()!r}, but give a positive number of Hz")
        numbers.append(number)
    if numbers and max(numbers) > min(numbers) * (1 + 1e-9):
        raise ValueError(f"{path}: {name} is given as {' and '.join(f'{number:g}' for number in numbers)} Hz; give it once")
    return numbers[0] if numbers else None


def _rate(path, given, stated, time, samples):
    rate = _one(path, "rate", [given, *(stated[key] for key in RATES if key in stated)])
    if time is None:
        if rate is None:
            raise ValueError(
                f"{path} states no sampling rate: add a column 'time [s]', write 'rate = ... Hz' into it, or give rate="
            )
        return rate
    if time.size != samples or samples < 2:
        raise ValueError(f"{path}: {time.size} times for {samples} samples")
    bad = np.flatnonzero(~np.isfinite(time))
    if bad.size:
        raise ValueError(f"{path}: time {bad[0]} is {time[bad[0]]}")
    step = (time[-1] - time[0]) / (samples - 1)
    off = np.abs(time - np.linspace(time[0], time[-1], samples))
    if not step > 0 or off.max() > UNEVEN * step:
        i = int(np.argmax(off)) if step > 0 else samples - 1
        raise ValueError(
            f"{path}: times must rise in equal steps, but sample {i} at {time[i]:.9g} s does not fit a step of {step:.6g} s: "
            "a gap, or a varying rate; resample first"
        )
    if rate is not None and abs(rate * step - 1) > AGREE:
        raise ValueError(f"{path}: rate = {rate:g} Hz, but its times are {1 / step:g} Hz; give one of them")
    return 1 / step if rate is None else rate


def _from_lines(path, lines):
    """Columns of a text table, their units, and what its comments state."""
    numbered = [(i, line.strip()) for i, line in enumerate(lines, 1) if line.strip()]
    comments = [line.lstrip("#% ") for _, line in numbered if line[0] in "#%"]
    rows = [(i, line) for i, line in numbered if line[0] not in "#%"]
    if not rows:
        raise ValueError(f"{path}: no rows of numbers")
    separator = next((s for s in ";\t," if s in rows[-1][1]), ",")
    first = rows[0][1].split(separator)
    statements = [(_plain(m[1]), m[2].strip()) for c in comments if (m := re.fullmatch(r"([\w ]+?)\s*[:=]\s*(.+)", c))]
    stated = {}
    for key, value in statements:
        if stated.setdefault(key, value) != value and key in (*RATES, *SHAFTS, "unit"):
            raise ValueError(f"{path}: {key} is stated twice, {stated[key]} and {value}; keep one")
    if not any(map(_is_number, first)):
        header = rows.pop(0)[1].split(separator)
    else:
        named = [c.split(separator) for c in comments if len(c.split(separator)) == len(first)]
        named = [cells for cells in named if len(cells) > 1 or re.fullmatch(r"[^:=]+\[.+\]", cells[0].strip())]
        header = named[-1] if named else ["signal"] if len(first) == 1 else _no_header(path, len(first))
    units, names = {}, []
    for cell in header:
        match = re.fullmatch(r"(.*?)\s*(?:\[(.*)\]|\((.*)\))?", cell.strip().strip('"').strip())
        names.append(match[1])
        units[match[1]] = (match[2] or match[3] or "").strip()
    if len(set(names)) < len(names):
        raise ValueError(f"{path}: two columns have the same name ({', '.join(names)})")
    table = _table(path, rows, separator, len(names))
    return dict(zip(names, table.T, strict=True)), units, stated


def _no_header(path, count):
    raise ValueError(f"{path}: {count} columns without names; write a header above the numbers: 'time [s], acceleration [m/s^2]'")


def _is_number(cell):
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _table(path, rows, separator, count):
    if not rows:
        raise ValueError(f"{path}: no rows of numbers")
    try:
        table = np.loadtxt([line for _, line in rows], delimiter=separator, ndmin=2)
    except ValueError as error:
        raise ValueError(_bad_row(path, rows, separator, count) or f"{path}: {error}") from error
    if table.shape[1] != count:
        raise ValueError(_bad_row(path, rows, separator, count))
    return table


def _bad_row(path, rows, separator, count):
    for i, line in rows:
        cells = line.split(separator)
        if len(cells) != count or not all(map(_is_number, cells)):
            hint = "; use a decimal point" if any(re.fullmatch(r"\s*[-+\d]*,\d+(e.*)?\s*", cell) for cell in cells) else ""
            return f"{path}, line {i}: {line!r} is not a row of {count} numbers{hint}"
    return None


def _from_arrays(path, arrays):
    """Vectors, their units, and what scalars and text state."""
    vectors, stated = {}, {}
    arrays, named = _channels(arrays)
    for name, value in arrays.items():
        if value.dtype.kind in "US" and value.size == 1:
            stated[_plain(name)] = str(value.reshape(-1)[0])
        elif value.size == 1 and value.dtype.kind in "fiu":
            stated[_plain(name)] = float(value.reshape(-1)[0])
        elif value.size > 1 and value.size == max(value.shape) and value.dtype.kind in "fiu":
            vectors[name] = value.reshape(-1)
    if not vectors:
        kinds = ", ".join(f"{name} {value.dtype}{list(value.shape)}" for name, value in arrays.items())
        raise ValueError(f"{path}: no vector of real numbers; it has {kinds or 'nothing'}")
    units = {name: "s" if _plain(name) in TIMES else "rad" if _plain(name) in ANGLES else "" for name in vectors}
    return vectors, units | named, stated


def _channels(arrays):
    """Columns of ``values`` as vectors by ``names``, and their ``units``: a response as `gearfe.Response.save` writes it."""
    if not {"values", "names", "units"} <= arrays.keys() or arrays["values"].ndim != 2:
        return arrays, {}
    names, units = ([str(np.ravel(one)[0]).strip() for one in arrays[key].reshape(-1)] for key in ("names", "units"))
    if not len(names) == len(units) == arrays["values"].shape[1]:
        return arrays, {}
    columns = dict(zip(names, arrays["values"].T, strict=True))
    rest = {key: value for key, value in arrays.items() if key not in ("values", "names", "units")}
    return rest | columns, dict(zip(names, units, strict=True))
