"""Channels of text tables as people export them: title rows, comments, units below the names, decimal commas, no names at all."""

import os
import re
import warnings
from collections import Counter
from typing import NamedTuple

import numpy as np

from .found import KEYS, TIMES, Found, plain
from .text_cells import CLOCK, DATE, GROUPS, cells_of, is_number, numbers, plain_number, since_start, value

SEPARATORS = (";", "\t", ",", None)  # of cells; None: blanks
LOOKED = 200  # rows at the end of a table from which its way of writing numbers is found
UNITS = re.compile(
    r"-|%|V|mV|pC|g|s|ms|us|rad|deg|°|k?Hz|rpm|1/min|[munkM]?(m|N|Nm|Pa|W|A)|[mu]?m/s(\^?2|²|\*\*2)?|°C|K|bar|hh:mm:ss\S*|\[.*\]|\(.*\)"
)
STATEMENT = re.compile(r"([\w ]+?)\s*(?:[\[(](\w+)[\])])?\s*[:=;,\t]+\s*([^;,\t]+(?:,\d+)?)[;,\t\s]*(\w*)[;,\t\s]*")


class Way(NamedTuple):
    """How a table writes its numbers: what parts cells, the decimal mark, cells in a row, rows of text above the numbers.

    `group` is what stands between thousands, as a regular expression; empty if nothing does.
    """

    separator: str | None
    mark: str
    columns: int
    above: int
    group: str = ""


def text_table(path: str | os.PathLike[str], lines: list[str], header: str | None = None) -> Found:
    """Channels of a text table: the `lines` of a file, whose `path` is for the messages.

    `header` has the names and units of the columns, ``"time [s], housing [m/s^2]"``, if the file has none, or others. ValueError
    if there are no rows of numbers, or one that does not fit the others: its line is named.
    """
    numbered = [(i, line.strip()) for i, line in enumerate(lines, 1) if line.strip()]
    comments = [line.lstrip("#% ") for _, line in numbered if line[0] in "#%"]
    rows = [(i, line) for i, line in numbered if line[0] not in "#%"]
    columns = None if header is None else re.split(r"[,;\t]", header)
    way = _way(rows, columns)
    if way is None:
        first = f"; its first line is {numbered[0][1][:60]!r}" if numbered else ": it is empty"
        raise ValueError(f"{path}: no rows of numbers{first}")
    titles = [line for _, line in rows[: way.above]]
    recording = Found({})
    names = columns or _names(titles, comments, way, recording)
    pairs = [named(cell) for cell in names]
    if len({name for name, _ in pairs}) < len(pairs):
        raise ValueError(f"{path}: two columns have the same name ({', '.join(name for name, _ in pairs)})")
    table = _table(path, rows[way.above :], way, len(names))
    recording.vectors, recording.units = dict(zip([name for name, _ in pairs], table.T, strict=True)), dict(pairs)
    _clocks(path, recording, cells_of(rows[way.above][1], way.separator, len(names)))
    for line in (*titles, *comments):
        _state(path, recording, line, way.mark)
    return recording


def named(cell: str) -> tuple[str, str]:
    """Name and unit of ``housing [m/s^2]`` or ``housing (m/s^2)``."""
    match = re.fullmatch(r"(.*?)\s*(?:\[([^\[]*)\]|\(([^(]*)\))?", cell.strip().strip('"').strip(), re.DOTALL)
    return (match[1], (match[2] or match[3] or "").strip()) if match else (cell.strip(), "")


def _way(rows, given):
    """`Way` in which the most rows are numbers; of several, one that fits the names of the columns. None if no row is numbers."""
    best, most = _ways(rows, [(mark, "") for mark in ".,"], 0)
    fitting = _fitting(rows, best, given)
    if most < len(rows[-LOOKED:]) or not fitting:  # some rows are no numbers, unless they have marks between thousands
        grouped, grouped_most = _ways(rows, [(mark, group) for mark in GROUPS for group in GROUPS[mark]], most)
        grouped_fitting = _fitting(rows, grouped, given)
        if grouped_most > most:
            best, fitting = grouped, grouped_fitting
        fitting = fitting or grouped_fitting
    return next(iter(fitting or best), None)


def _fitting(rows, ways, given):
    """Those of several ways that fit the names of the columns."""
    return [way for way in ways if (len(given) == way.columns if given else _fits(rows, way))]


def _ways(rows, marks, most):
    """Ways of writing in which the most rows, and at least `most`, are numbers; and how many rows that is."""
    best = []
    for mark, group in marks:
        for separator in SEPARATORS:
            if group and separator in (None, mark):  # a mark between thousands that is the separator ends a cell
                continue
            counts = Counter(n for _, line in rows[-LOOKED:] if (n := numbers(line, separator, mark, group)))
            score, count = sum(counts.values()), counts.most_common(1)[0][0] if counts else 0
            if score and score >= most:
                above = next((i for i, (_, line) in enumerate(rows) if numbers(line, separator, mark, group) == count), 0)
                way = Way(separator, mark, count, above, group)
                best, most = [*best, way] if score == most else [way], score
    return best, most


def _fits(rows, way):
    """Whether the row above the numbers has as many cells as they have, and is not itself numbers written in another way."""
    if not way.above:
        return False
    line = rows[way.above - 1][1]
    return len(cells_of(line, way.separator)) == way.columns and not any(numbers(line, way.separator, mark) for mark in ".,")


def _names(titles, comments, way, found):
    """Names of the columns with their units, from the rows above the numbers, or the comments."""
    rows = [cells for line in titles if len(cells := cells_of(line, way.separator)) == way.columns]
    if len(rows) > 1 and all(UNITS.fullmatch(cell) for cell in rows[-1]):
        return [f"{name} [{unit.strip('[]()')}]" for name, unit in zip(*rows[-2:], strict=True)]
    if titles and len(cells_of(titles[-1], way.separator)) == way.columns:
        return rows[-1]
    if titles and not rows and len(cells := cells_of(titles[-1], way.separator)) > 1:
        return cells  # a header whose count does not fit is reported with the first row
    rows = [cells for line in comments if len(cells := cells_of(line, way.separator)) == way.columns]
    rows = [cells for cells in rows if len(cells) > 1 or re.fullmatch(r"[^:=]+\[.+\]", cells[0])] or rows[:0]
    if rows:
        return rows[-1]
    if way.columns == 1:
        return ["signal"]
    found.hint = f"{way.columns} columns without names; give header=, 'time [s], acceleration [m/s^2]'"
    return [f"column {i}" for i in range(1, way.columns + 1)]


def _table(path, rows, way, count):
    """Values, nan where a cell is empty."""
    last = cells_of(rows[-1][1], way.separator)
    if way.group or way.mark == way.separator or not all(is_number(cell, way.mark) for cell in last):
        return _by_cell(path, rows, way, count)
    lines = [line if way.separator is None else line.rstrip(f"{way.separator} ") for _, line in rows]
    if way.mark == "," and any("." in line for line in lines):  # 1.5 among decimal commas, or 1.234,5
        return _by_cell(path, rows, way, count)
    try:
        plain = [line.replace(",", ".") for line in lines] if way.mark == "," else lines
        table = np.loadtxt(plain, delimiter=way.separator, ndmin=2, quotechar='"', comments=None)
    except ValueError:  # a cell is empty, or wrong
        return _by_cell(path, rows, way, count)
    return table if table.shape[1] == count else _by_cell(path, rows, way, count)


def _by_cell(path, rows, way, count):
    """As `_table`, cell by cell: with marks between thousands, commas between quotes and empty cells, of which it warns."""
    cells = [cells_of(line, way.separator, count) for _, line in rows]
    table = [[value(cell, way.mark, way.group) for cell in row] for row in cells]
    wrong = next((i for i, row in enumerate(table) if len(row) != count or None in row), None)
    if wrong is not None:
        line = rows[wrong][1]
        shown = line if len(line) <= 80 else f"{line[:80]}..."
        raise ValueError(f"{path}, line {rows[wrong][0]}: {shown!r} is not a row of {count} numbers")
    if way.group:
        example = next((cell for row in cells for cell in row if GROUPS[way.mark][way.group].fullmatch(cell)), cells[0][0])
        meaning = f"thousands are taken to be parted: {example!r} is {plain_number(example, way.mark, way.group)}"
        warnings.warn(f"{path}: {meaning}", stacklevel=6)
    empty = [i for (i, _), row in zip(rows, cells, strict=True) if "" in row]
    if empty:
        warnings.warn(f"{path}: {len(empty)} rows have empty cells, the first in line {empty[0]}: read as missing", stacklevel=6)
    return np.array(table)


def _clocks(path, found, first):
    """Turn a column of clock times into the time, and drop dates; `first` are the cells of the first row."""
    for name, cell in zip(list(found.vectors), first, strict=True):
        if DATE.fullmatch(cell):
            found.other.append(f"{name!r} (dates)")
            del found.vectors[name]
        elif CLOCK.fullmatch(cell):
            seconds = since_start(found.vectors.pop(name))
            if found.axes(TIMES):
                found.other.append(f"{name!r} (of a clock, beside {found.axes(TIMES)[0]!r})")
                continue
            taken = name if plain(name) in TIMES else "time"
            found.vectors[taken], found.units[taken] = seconds, "s"
            warnings.warn(f"{path}: {name!r} ({cell}) is taken for the time, in seconds from its first row on", stacklevel=5)


def _state(path, found, line, mark):
    """Note what a title row or a comment states: ``rate = 5120 Hz``, ``Sample rate [Hz];5120``."""
    match = re.fullmatch(r"([\w ]+?)\s*[:=]\s*(.+)", line) or STATEMENT.fullmatch(line)
    key = plain(match[1]) if match else ""
    if not match or key not in KEYS:
        return
    value = match[2] if match.re.groups == 2 else " ".join(part for part in (match[3].strip(), match[2] or match[4]) if part)
    value = value.strip().replace(mark, ".") if key != "unit" else value.strip()
    before = found.nearest(found.stated, "", (key,))
    if before and before[0] != value:
        raise ValueError(f"{path}: {key} is stated twice, {before[0]} and {value}; keep one")
    found.stated[key] = value
