"""Channels of exported text tables with title rows, comments, unit rows, decimal commas and missing names."""

import contextlib
import csv
import math
import re
import warnings
from collections import Counter
from itertools import product
from typing import NamedTuple

import numpy as np

from ..geometry.aliases import StrPath
from .found import KEYS, Found, plain

SEPARATORS = (";", "\t", ",", None)  # cell separators; None: blanks
LOOKED = 200  # number of rows at the end of a table that determine its number format
LONGEST = 300  # longest title that states a value [characters]
UNITS = re.compile(
    r"-|%|V|mV|pC|g|s|ms|us|rad|deg|°|k?Hz|rpm|1/min|[munkM]?(m|N|Nm|Pa|W|A)|[mu]?m/s(\^?2|²|\*\*2)?|°C|K|bar|hh:mm:ss\S*|\[.*\]|\(.*\)"
)
STATEMENT = re.compile(r"([\w ]+?)\s*(?:[\[(](\w+)[\])])?\s*[:=;,\t]+\s*([^;,\t]+(?:,\d+)?)[;,\t\s]*(\w*)[;,\t\s]*")
SPACE = "[ \xa0\u2009\u202f]"  # blanks, including non-breaking ones
GROUPS = {  # by decimal mark: pattern of thousands separators, pattern of numbers with them
    mark: {one: re.compile(rf"[-+]?\d{{1,3}}({one}\d{{3}})+({re.escape(mark)}\d*)?(e[-+]?\d+)?", re.IGNORECASE) for one in groups}
    for mark, groups in {".": (",", "'", SPACE), ",": (r"\.", "'", SPACE)}.items()
}
DATE = re.compile(r"\d{4}([-/.])\d{1,2}\1\d{1,2}|\d{1,2}([-/.])\d{1,2}\2\d{2,4}")
CLOCK = re.compile(
    rf"(?:(?:{DATE.pattern})[T ]\s*)?(?P<h>\d{{1,2}}):(?P<m>\d{{2}}):(?P<s>\d{{2}}(?:[.,]\d+)?)\s*(?:Z|[-+]\d{{2}}:?\d{{2}})?"
)
DAY = 86400.0  # length of a day [s]


class Way(NamedTuple):
    """Number format of a table: cell separator, decimal mark, cells in a row, and rows of text above the numbers.

    `group` is the thousands separator as a regular expression, empty without one.
    """

    separator: str | None
    mark: str
    group: str = ""
    columns: int = 0
    above: int = 0

    def cells(self, line: str, count: int | None = None) -> list[str]:
        """Return the cells of a row. With a known `count`, empty cells at the end are kept, otherwise they are dropped."""
        whole = line if self.separator is None else line.rstrip(f"{self.separator} ")
        # Separators inside quotes do not end a cell.
        if self.separator is not None and '"' in line and len(line) <= csv.field_size_limit():
            cells = [cell.strip() for cell in next(csv.reader([whole], delimiter=self.separator))]
        else:
            cells = [cell.strip().strip('"').strip() for cell in whole.split(self.separator)]
        empty = 0 if count is None or self.separator is None else line[len(whole) :].count(self.separator)
        return cells + [""] * min((count or 0) - len(cells), empty)

    def number(self, cell: str) -> float | None:
        """Return the number in a cell, or None for another content."""
        if self.group and GROUPS[self.mark][self.group].fullmatch(cell):
            cell = re.sub(self.group, "", cell)
        elif self.mark == "," and "." in cell:
            return None
        try:
            return float(cell.replace(self.mark, "."))
        except ValueError:
            return None

    def numbers(self, line: str) -> int:
        """Return the number of cells in a row of numbers, dates and clock times, or 0 for other rows."""
        cells = self.cells(line)
        rest = [cell for cell in cells if self.number(cell) is None]
        clocks = all(CLOCK.fullmatch(cell) or DATE.fullmatch(cell) for cell in rest)
        return len(cells) if len(rest) < len(cells) and clocks else 0

    def value(self, cell: str) -> float | None:
        r"""Return the number of a cell, seconds of the day for a clock time, nan for an empty cell or a date, otherwise None.

        >>> Way(";", ",", r"\.").value("1.234,5"), Way(";", ",").value("10:00:01,5")
        (1234.5, 36001.5)
        """
        number, clock = self.number(cell), CLOCK.fullmatch(cell)
        if clock:
            return 3600 * float(clock["h"]) + 60 * float(clock["m"]) + float(clock["s"].replace(",", "."))
        return math.nan if not cell or DATE.fullmatch(cell) else number


def text_table(path: StrPath, lines: list[str], header: str | None = None) -> Found:
    """Return the channels of a text table from its `lines`. `path` is used in messages.

    `header` states or replaces the names and units of the columns: ``"time [s], housing [m/s^2]"``. ValueError
    if there are no rows of numbers, or one that does not fit the others: its line is named.
    """
    numbered = [(i, line.strip()) for i, line in enumerate(lines, 1) if line.strip()]
    rows = [(i, line) for i, line in numbered if line[0] not in "#%"]
    comments = [line.lstrip("#% ") for _, line in numbered if line[0] in "#%"]
    columns = None if header is None else re.split(r"[,;\t]", header)
    way = _way(rows, columns)
    if way is None:
        first = f"; its first line is {numbered[0][1][:60]!r}" if numbered else ": it is empty"
        raise ValueError(f"{path}: no rows of numbers{first}")
    titles = [line for _, line in rows[: way.above]]
    recording = Found({})
    recording.units = _named(path, columns or _names(titles, comments, way, recording))
    table = _table(path, rows[way.above :], way, len(recording.units))
    recording.vectors = dict(zip(recording.units, table.T, strict=True))
    _clocks(path, recording, way.cells(rows[way.above][1], len(recording.units)))
    for line in (*titles, *comments):
        _state(path, recording, line, way.mark)
    return recording


def _named(path, cells):
    """Return units by the names of the columns."""
    pairs = [named(cell) for cell in cells]
    if len(dict(pairs)) < len(pairs):
        raise ValueError(f"{path}: two columns have the same name ({', '.join(name for name, _ in pairs)})")
    return dict(pairs)


def named(cell: str) -> tuple[str, str]:
    """Return name and unit of a heading such as ``housing [m/s^2]`` or ``housing (m/s^2)``."""
    text = cell.strip().strip('"').strip()
    start = text.rfind({"]": "[", ")": "("}.get(text[-1:], "\0"))
    return (text, "") if start < 0 else (text[:start].rstrip(), text[start + 1 : -1].strip())


def _way(rows, given):
    """Return the `Way` by which most rows are numbers. Among equals, the first that fits the column names is used.

    Thousands separators are assumed only if more rows are numbers with them, or if no other format fits. The result is None if
    no row is numbers.
    """
    best, most, looked = None, (0, False), rows[-LOOKED:]
    for way in _ways():
        counts = Counter(n for _, line in looked if (n := way.numbers(line)))
        count = max(counts, key=counts.__getitem__, default=0)
        above = next((i for i, (_, line) in enumerate(rows) if count and way.numbers(line) == count), 0)
        way = way._replace(columns=count, above=above)
        score = counts.total(), len(given) == count if given else _fits(rows, way)
        if score > most and score[0]:
            best, most = way, score
        if most == (len(looked), True):
            break
    return best


def _ways():
    """Yield every `Way` of reading cells, beginning with those without thousands separators."""
    marks = [(mark, "") for mark in GROUPS] + [(mark, group) for mark, groups in GROUPS.items() for group in groups]
    for (mark, group), separator in product(marks, SEPARATORS):
        if not group or separator not in (None, mark):
            yield Way(separator, mark, group)


def _fits(rows, way):
    """Return whether the row above the numbers is a header with the same number of cells."""
    if not way.above:
        return False
    line = rows[way.above - 1][1]
    return len(way.cells(line)) == way.columns and not any(Way(way.separator, mark).numbers(line) for mark in GROUPS)


def _names(titles, comments, way, found):
    """Return the column names with units, from the rows above the numbers or from comments."""
    rows, said = ([cells for line in lines if len(cells := way.cells(line)) == way.columns] for lines in (titles, comments))
    if len(rows) > 1 and all(map(UNITS.fullmatch, rows[-1])):
        return [f"{name} [{unit.strip('[]()')}]" for name, unit in zip(*rows[-2:], strict=True)]
    last = way.cells(titles[-1]) if titles else []
    if last and (len(last) == way.columns or (not rows and last[1:])):
        return last  # A header with the wrong number of columns is reported with the first row.
    if said := list(filter(_are_names, said)):
        return said[-1]
    if way.columns == 1:
        return ["signal"]
    found.hint = f"{way.columns} columns without names; give header=, 'time [s], acceleration [m/s^2]'"
    return [f"column {i}" for i in range(1, way.columns + 1)]


def _are_names(cells):
    return len(cells) > 1 or (cells[0].endswith("]") and not {":", "="} & {*cells[0]})


def _table(path, rows, way, count):
    """Return the values of the columns. Empty cells are nan."""
    lines = [line if way.separator is None else line.rstrip(f"{way.separator} ") for _, line in rows]
    comma = way.mark == ","
    if not (way.group or way.mark == way.separator or (comma and any("." in line for line in lines))):
        plain_lines = [line.replace(",", ".") for line in lines] if comma else lines
        with contextlib.suppress(ValueError):  # The cell is empty, a clock time, or invalid.
            table = np.loadtxt(plain_lines, delimiter=way.separator, ndmin=2, quotechar='"', comments=None)
            if table.shape[1] == count:
                return table
    return _by_cell(path, rows, way, count)


def _by_cell(path, rows, way, count):
    """Return `_table` cell by cell (thousands separators, quoted commas, empty cells), with a warning."""
    cells = [way.cells(line, count) for _, line in rows]
    table = [[way.value(cell) for cell in row] for row in cells]
    for (i, line), row in zip(rows, table, strict=True):
        if len(row) != count or None in row:
            shown = line if len(line) <= 80 else f"{line[:80]}..."
            raise ValueError(f"{path}, line {i}: {shown!r} is not a row of {count} numbers")
    if way.group:
        example = next((cell for row in cells for cell in row if GROUPS[way.mark][way.group].fullmatch(cell)), cells[0][0])
        warnings.warn(f"{path}: thousands separators are assumed: {example!r} is {way.number(example):.12g}", stacklevel=6)
    empty = [i for (i, _), row in zip(rows, cells, strict=True) if "" in row]
    if empty:
        warnings.warn(f"{path}: {len(empty)} rows have empty cells, the first in line {empty[0]}: read as missing", stacklevel=6)
    return np.array(table)


def _clocks(path, found, first):
    """Convert a column of clock times to seconds, and remove date columns. `first` contains the cells of the first row."""
    for name, cell in zip(list(found.vectors), first, strict=True):
        if DATE.fullmatch(cell):
            found.other.append(f"{name!r} (dates)")
            del found.vectors[name]
        elif CLOCK.fullmatch(cell):
            rising = np.unwrap(found.vectors.pop(name), period=DAY)  # The times may pass midnight.
            found.take_clock(path, name, cell, rising - rising[0], 5)


def _state(path, found, line, mark):
    """Store the metadata of a title row or a comment: ``rate = 5120 Hz``, ``Sample rate [Hz];5120``."""
    match = len(line) <= LONGEST and (re.fullmatch(r"([\w ]+?)\s*[:=]\s*(.+)", line) or STATEMENT.fullmatch(line))
    key = plain(match[1]) if match else ""
    if key not in KEYS:
        return
    value = match[2] if match.re.groups == 2 else " ".join(part for part in (match[3].strip(), match[2] or match[4]) if part)
    value = value.strip().replace(mark, ".") if key != "unit" else value.strip()
    before = found.nearest(found.stated, "", (key,))
    if before and before[0] != value:
        raise ValueError(f"{path}: {key} is stated twice, {before[0]} and {value}; keep one")
    found.stated[key] = value
