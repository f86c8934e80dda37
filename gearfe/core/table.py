"""`Table`: columns with units and rows of numbers, formatted only for display and files."""

import csv
import io
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from html import escape
from typing import Any, NamedTuple
from unicodedata import category, east_asian_width

from ..geometry.aliases import StrPath
from .files import suffix_of, written
from .units import significant

Form = str | Callable[[float], str]
FAR, WORDS = ' class="far"', ' class="words"'  # classes of the style sheet of pages
LATEX = {letter: f"\\{letter}" for letter in "&%$#_{}"}
LATEX |= {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "±": r"$\pm$", "<": "$<$", ">": "$>$"}


class Column(NamedTuple):
    """Name, unit and format of the numbers of a column.

    `form` is a format such as ``"{:.3g}"``, or a function that returns the text of a number. The unit is in the head, ``%`` after
    every number. Numbers larger than `mark` in size are emphasised.
    """

    name: str
    unit: str = ""
    form: Form = "{:.5g}"
    mark: float = math.inf

    @property
    def head(self) -> str:
        """Name with the unit."""
        name = " ".join(self.name.splitlines())
        return f"{name} [{self.unit}]" if self.unit and self.unit != "%" else name

    def text(self, cell: Any) -> str:
        """Return the text of a cell, which is empty for None and nan."""
        value, form = cell if isinstance(cell, tuple) else (cell, self.form)
        if value is None or isinstance(value, str):
            return " ".join((value or "").splitlines())
        if math.isnan(value):
            return ""
        return form(value) if callable(form) else form.format(value) + (" %" if self.unit == "%" else "")

    def marks(self, cell: Any) -> bool:
        """Whether a cell is emphasised."""
        return isinstance(cell, (int, float)) and abs(cell) > self.mark


def stiffness_column(name: str, digits: int = 4) -> Column:
    """Return a `Column` of stiffnesses in N/um with this number of significant digits."""
    return Column(name, "N/um", partial(significant, digits=digits))


def _width(text):
    """Return the width of a text on a terminal. East Asian letters have two columns, combining marks none."""
    return sum(0 if category(letter) in ("Mn", "Me", "Cf") else 1 + (east_asian_width(letter) in "WF") for letter in text)


@dataclass(frozen=True, slots=True)
class Table:
    r"""Rows of numbers and texts under columns.

    Parameters
    ----------
    columns : sequence of Column or str
        A text is the name of a column without unit.
    rows : sequence of sequence
        Cells: a number in the unit of its column, a text, None, or ``(number, form)`` where the format is not that of its column.
    title : str

    Examples
    --------
    >>> columns = ["zone", Column("k", "N/um", "{:.1f}"), Column("error", "%", "{:+.1f}")]
    >>> table = Table(columns, [["mean", 9.13, 0.2], ["a|b", 12, None]])
    >>> print(table.markdown())
    | zone | k [N/um] | error |
    |---|---|---|
    | mean | 9.1 | +0.2 % |
    | a\|b | 12.0 |  |
    >>> print(table.csv(), end="")
    zone,k [N/um],error [%]
    mean,9.13,0.2
    a|b,12,
    """

    columns: Sequence[Any]
    rows: Sequence[Sequence[Any]]
    title: str = ""

    def __post_init__(self) -> None:
        """Convert all columns to `Column` objects."""
        object.__setattr__(self, "columns", tuple(Column(one) if isinstance(one, str) else one for one in self.columns))

    def cells(self) -> list[list[str]]:
        """Return the texts of all cells. The first row is the head."""
        return [[column.head for column in self.columns], *self._texts(lambda text, marked: text)]

    def _texts(self, show):
        pairs = [zip(self.columns, row, strict=True) for row in self.rows]
        return [[show(column.text(cell), column.marks(cell)) for column, cell in row] for row in pairs]

    def numeric(self) -> list[bool]:
        """Return, for each column, whether it contains a number."""
        return [any(row[k] is not None and not isinstance(row[k], str) for row in self.rows) for k in range(len(self.columns))]

    def _marked(self):
        head, *_ = self.cells()
        rows = [head, *self._texts(lambda text, marked: f"**{text}**" if marked else text)]
        return [[cell.replace("|", r"\|") for cell in row] for row in rows]

    def markdown(self) -> str:
        """Return the table as Markdown without padding."""
        head, *rows = ("| " + " | ".join(row) + " |" for row in self._marked())
        return "\n".join([head, "|---" * len(self.columns) + "|", *rows])

    def __str__(self) -> str:
        """Return the table as Markdown with columns of equal width, for a terminal."""
        rows = self._marked()
        widths = [max(map(_width, column)) for column in zip(*rows, strict=True)]

        def line(cells):
            parts = zip(cells, widths, self.numeric(), strict=True)
            padded = ((cell, " " * (width - _width(cell)), number) for cell, width, number in parts)
            return f"| {' | '.join(space + cell if number else cell + space for cell, space, number in padded)} |"

        rule = "|".join("-" * (width + 2) for width in widths)
        return "\n".join([line(rows[0]), f"|{rule}|", *map(line, rows[1:])])

    def html(self, *, words: bool = False) -> str:
        """Return a ``<table>`` inside a scrolling ``<div>``. With `words`, its cells contain sentences."""
        head, *_ = self.cells()
        rows = self._texts(lambda text, marked: f"<td{FAR if marked else ''}>{escape(text)}</td>")
        label = escape(self.title or "table")
        return "".join([
            f'<div class="wide" tabindex="0" role="region" aria-label="{label}"><table{WORDS if words else ""}>\n',
            f"<caption>{label}</caption>\n" if self.title else "",
            "<thead><tr>", *(f'<th scope="col">{escape(name)}</th>' for name in head), "</tr></thead>\n<tbody>",
            *(f"<tr>{''.join(row)}</tr>\n" for row in rows), "</tbody></table></div>",
        ])  # fmt: skip

    _repr_html_ = html

    def latex(self) -> str:
        """Return a LaTeX ``tabular`` that needs no package."""

        def shown(text, marked=False):
            safe = "".join(LATEX.get(letter, letter) for letter in text)
            safe = f"$-${safe[1:]}" if safe[:1] == "-" else safe
            return f"\\textbf{{{safe}}}" if marked else safe

        rows = [[shown(name) for name in self.cells()[0]], *self._texts(shown)]
        head, *body = (" & ".join(row) + r" \\" for row in rows)
        sides = "".join("lr"[number] for number in self.numeric())
        return "\n".join([f"\\begin{{tabular}}{{{sides}}}", r"\hline", head, r"\hline", *body, r"\hline", r"\end{tabular}"])

    def csv(self) -> str:
        """Return comma-separated values with all digits and units in the head."""
        out = io.StringIO()
        file = csv.writer(out, lineterminator="\n")
        file.writerow(f"{column.name} [{column.unit}]" if column.unit else column.name for column in self.columns)
        for row in self.rows:
            plain = (cell[0] if isinstance(cell, tuple) else cell for cell in row)
            file.writerow("" if cell is None or cell != cell else cell for cell in plain)
        return out.getvalue()

    def save(self, path: StrPath) -> None:
        """Write to `path`. Its suffix selects the format: ``.csv``, ``.md`` or ``.tex``. ValueError if it is not writable."""
        text = {".csv": self.csv, ".md": self.markdown, ".tex": self.latex}[suffix_of(path, "table")]()
        with written(path) as name, open(name, "w", encoding="utf-8") as file:
            file.write(text if text.endswith("\n") else f"{text}\n")
