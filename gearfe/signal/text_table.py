"""Channels of text tables as people export them: title rows, comments, units below the names, decimal commas, no names at all."""

import csv
import os
import re
import warnings
from collections import Counter
from typing import NamedTuple

import numpy as np

from .found import KEYS, Found, plain

SEPARATORS = (";", "\t", ",", None)  # of cells; None: blanks
LOOKED = 200  # rows at the end of a table by which its way of writing numbers is told
UNITS = re.compile(
    r"-|%|V|mV|pC|g|s|ms|us|rad|deg|°|k?Hz|rpm|1/min|[munkM]?(m|N|Nm|Pa|W|A)|[mu]?m/s(\^?2|²|\*\*2)?|°C|K|bar|\[.*\]|\(.*\)"
)
STATEMENT = re.compile(r"([\w ]+?)\s*(?:[\[(](\w+)[\])])?\s*[:=;,\t]+\s*([^;,\t]+(?:,\d+)?)[;,\t\s]*(\w*)[;,\t\s]*")


SPACE = "[ \xa0\u2009\u202f]"  # blanks, also those that do not break
GROUPS = {  # by decimal mark, what stands between thousands (a regular expression), and numbers that have it
    mark: {one: re.compile(rf"[-+]?\d{{1,3}}({one}\d{{3}})+({re.escape(mark)}\d*)?(e[-+]?\d+)?", re.IGNORECASE) for one in groups}
    for mark, groups in {".": (",", "'", SPACE), ",": (r"\.", "'", SPACE)}.items()
}


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
    """Channels of a text table.

    Parameters
    ----------
    path : path
        For the messages.
    lines : list of str
    header : str, optional
        Names and units of the columns, ``"time [s], housing [m/s^2]"``, if the file has none, or others.

    Returns
    -------
    Found

    Raises
    ------
    ValueError
        If there are no rows of numbers, or one that does not fit the others: its line is named.
    """
    numbered = [(i, line.strip()) for i, line in enumerate(lines, 1) if line.strip()]
    comments = [line.lstrip("#% ") for _, line in numbered if line[0] in "#%"]
    rows = [(i, line) for i, line in numbered if line[0] not in "#%"]
    given = None if header is None else re.split(r"[,;\t]", header)
    way = _way(rows, given)
    if way is None:
        first = f"; its first line is {numbered[0][1][:60]!r}" if numbered else ": it is empty"
        raise ValueError(f"{path}: no rows of numbers{first}")
    titles = [line for _, line in rows[: way.above]]
    found = Found({})
    names = given or _names(titles, comments, way, found)
    pairs = [named(cell) for cell in names]
    if len({name for name, _ in pairs}) < len(pairs):
        raise ValueError(f"{path}: two columns have the same name ({', '.join(name for name, _ in pairs)})")
    table = _table(path, rows[way.above :], way, len(names))
    found.vectors, found.units = dict(zip([name for name, _ in pairs], table.T, strict=True)), dict(pairs)
    for line in (*titles, *comments):
        _state(path, found, line, way.mark)
    return found


def named(cell: str) -> tuple[str, str]:
    """Name and unit of ``housing [m/s^2]`` or ``housing (m/s^2)``."""
    match = re.fullmatch(r"(.*?)\s*(?:\[([^\[]*)\]|\(([^(]*)\))?", cell.strip().strip('"').strip(), re.DOTALL)
    return (match[1], (match[2] or match[3] or "").strip()) if match else (cell.strip(), "")


def _cells(line, separator):
    if separator is not None and '"' in line:  # a separator between quotes parts nothing
        return [cell.strip() for cell in next(csv.reader([line.rstrip(f"{separator} ")], delimiter=separator))]
    whole = line if separator is None else line.rstrip(f"{separator} ")
    return [cell.strip().strip('"').strip() for cell in whole.split(separator)]


def _plain(cell, mark, group=""):
    """A number as Python reads it."""
    if group and GROUPS[mark][group].fullmatch(cell):
        cell = re.sub(group, "", cell)
    return cell.replace(mark, ".") if mark == "." or "." not in cell else ""


def _is_number(cell, mark, group=""):
    try:
        float(_plain(cell, mark, group))
    except ValueError:
        return False
    return True


def _numbers(line, separator, mark, group=""):
    """Count of cells if all are numbers, else 0."""
    found = _cells(line, separator)
    return len(found) if all(_is_number(cell, mark, group) for cell in found) else 0


def _way(rows, given):
    """The way in which most rows are numbers; of several one that fits the names of the columns. None if there is none."""
    best, most = _ways(rows, [(mark, "") for mark in ".,"], 0)
    fitting = _fitting(rows, best, given)
    if most < len(rows[-LOOKED:]) or not fitting:  # some rows are no numbers, unless thousands are parted
        grouped, more = _ways(rows, [(mark, group) for mark in GROUPS for group in GROUPS[mark]], most)
        found = _fitting(rows, grouped, given)
        if more > most:
            best, fitting = grouped, found
        fitting = fitting or found
    return next(iter(fitting or best), None)


def _fitting(rows, ways, given):
    """Those of several ways that fit the names of the columns."""
    return [way for way in ways if (len(given) == way.columns if given else _fits(rows, way))]


def _ways(rows, marks, most):
    """Ways in which most rows, and at least so many, are numbers; and how many those are."""
    best = []
    for mark, group in marks:
        for separator in SEPARATORS:
            if group and separator in (None, mark):  # thousands parted like cells would be cells
                continue
            counts = Counter(n for _, line in rows[-LOOKED:] if (n := _numbers(line, separator, mark, group)))
            score, count = sum(counts.values()), counts.most_common(1)[0][0] if counts else 0
            if score and score >= most:
                above = next((i for i, (_, line) in enumerate(rows) if _numbers(line, separator, mark, group) == count), 0)
                way = Way(separator, mark, count, above, group)
                best, most = [*best, way] if score == most else [way], score
    return best, most


def _fits(rows, way):
    """Whether the row above the numbers has as many cells as they, and is none of numbers in another way."""
    if not way.above:
        return False
    line = rows[way.above - 1][1]
    return len(_cells(line, way.separator)) == way.columns and not any(_numbers(line, way.separator, mark) for mark in ".,")


def _names(titles, comments, way, found):
    """Names of the columns with their units, from the rows above the numbers, or the comments."""
    rows = [cells for line in titles if len(cells := _cells(line, way.separator)) == way.columns]
    if len(rows) > 1 and all(UNITS.fullmatch(cell) for cell in rows[-1]):
        return [f"{name} [{unit.strip('[]()')}]" for name, unit in zip(*rows[-2:], strict=True)]
    if titles and len(_cells(titles[-1], way.separator)) == way.columns:
        return rows[-1]
    if titles and not rows and len(cells := _cells(titles[-1], way.separator)) > 1:
        return cells  # a header whose count does not fit is told with the first row
    rows = [cells for line in comments if len(cells := _cells(line, way.separator)) == way.columns]
    rows = [cells for cells in rows if len(cells) > 1 or re.fullmatch(r"[^:=]+\[.+\]", cells[0])] or rows[:0]
    if rows:
        return rows[-1]
    if way.columns == 1:
        return ["signal"]
    found.hint = f"{way.columns} columns without names; give header=, 'time [s], acceleration [m/s^2]'"
    return [f"column {i}" for i in range(1, way.columns + 1)]


def _table(path, rows, way, count):
    if way.group:
        return _grouped(path, rows, way, count)
    lines = [line if way.separator is None else line.rstrip(f"{way.separator} ") for _, line in rows]
    if way.mark == ",":
        if any("." in line for line in lines):  # 1.5 among decimal commas, or 1.234,5
            raise ValueError(_bad_row(path, rows, way, count))
        lines = [line.replace(",", ".") for line in lines]
    try:
        table = np.loadtxt(lines, delimiter=way.separator, ndmin=2, quotechar='"', comments=None)
    except ValueError as error:
        raise ValueError(_bad_row(path, rows, way, count) or f"{path}: {error}") from error
    if table.shape[1] != count:
        raise ValueError(_bad_row(path, rows, way, count))
    return table


def _grouped(path, rows, way, count):
    """Numbers with something between their thousands, which is told."""
    wrong = _bad_row(path, rows, way, count)
    if wrong:
        raise ValueError(wrong)
    cells = [_cells(line, way.separator) for _, line in rows]
    one = next((cell for row in cells for cell in row if GROUPS[way.mark][way.group].fullmatch(cell)), cells[0][0])
    warnings.warn(f"{path}: thousands are taken to be parted: {one!r} is {_plain(one, way.mark, way.group)}", stacklevel=6)
    return np.array([[float(_plain(cell, way.mark, way.group)) for cell in row] for row in cells])


def _bad_row(path, rows, way, count):
    for i, line in rows:
        if _numbers(line, way.separator, way.mark, way.group) != count:
            shown = line if len(line) <= 80 else f"{line[:80]}..."
            return f"{path}, line {i}: {shown!r} is not a row of {count} numbers"
    return None


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
