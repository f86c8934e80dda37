"""Cells of text tables: where a row is cut, and what a cell is: a number, a time of a clock, a date, or nothing."""

import csv
import math
import re

import numpy as np

SPACE = "[ \xa0\u2009\u202f]"  # blanks, also those that do not break
GROUPS = {  # by decimal mark, what stands between thousands (a regular expression), and numbers that have it
    mark: {one: re.compile(rf"[-+]?\d{{1,3}}({one}\d{{3}})+({re.escape(mark)}\d*)?(e[-+]?\d+)?", re.IGNORECASE) for one in groups}
    for mark, groups in {".": (",", "'", SPACE), ",": (r"\.", "'", SPACE)}.items()
}
DATE = re.compile(r"\d{4}([-/.])\d{1,2}\1\d{1,2}|\d{1,2}([-/.])\d{1,2}\2\d{2,4}")
CLOCK = re.compile(
    rf"(?:(?:{DATE.pattern})[T ]\s*)?(?P<h>\d{{1,2}}):(?P<m>\d{{2}}):(?P<s>\d{{2}}(?:[.,]\d+)?)\s*(?:Z|[-+]\d{{2}}:?\d{{2}})?"
)
DAY = 86400.0  # s


def cells_of(line, separator, count=None):
    """Cells of a row: with a known `count` also the empty ones at its end, otherwise separators at the end are dropped."""
    whole = line if separator is None else line.rstrip(f"{separator} ")
    if separator is not None and '"' in line:  # a separator between quotes ends no cell
        cells = [cell.strip() for cell in next(csv.reader([whole], delimiter=separator))]
    else:
        cells = [cell.strip().strip('"').strip() for cell in whole.split(separator)]
    empty = 0 if count is None or separator is None else min(count - len(cells), line[len(whole) :].count(separator))
    return cells + [""] * empty


def plain_number(cell, mark, group=""):
    """A number as Python reads it."""
    if group and GROUPS[mark][group].fullmatch(cell):
        cell = re.sub(group, "", cell)
    return cell.replace(mark, ".") if mark == "." or "." not in cell else ""


def is_number(cell, mark, group=""):
    """Whether a cell is a number."""
    try:
        float(plain_number(cell, mark, group))
    except ValueError:
        return False
    return True


def numbers(line, separator, mark, group=""):
    """Count of the cells of a row if they are numbers, or numbers beside dates and times of a clock; else 0."""
    cells = cells_of(line, separator)
    rest = [cell for cell in cells if not is_number(cell, mark, group)]
    return len(cells) if len(rest) < len(cells) and all(CLOCK.fullmatch(cell) or DATE.fullmatch(cell) for cell in rest) else 0


def value(cell, mark, group=""):
    r"""Value of a cell: its number, the seconds of the day of a clock time, nan if it is empty or a date; None for anything else.

    >>> value("1.234,5", ",", r"\."), value("10:00:01,5", ",")
    (1234.5, 36001.5)
    """
    if is_number(cell, mark, group):
        return float(plain_number(cell, mark, group))
    clock = CLOCK.fullmatch(cell)
    if clock:
        return 3600 * float(clock["h"]) + 60 * float(clock["m"]) + float(clock["s"].replace(",", "."))
    return math.nan if not cell or DATE.fullmatch(cell) else None


def since_start(seconds):
    """Seconds of the day as seconds from the first on, past midnight too."""
    rising = np.unwrap(seconds, period=DAY)
    return rising - rising[0]
