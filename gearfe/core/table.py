"""`Table`: columns with units and rows of numbers, formatted only for display and files."""

import csv
import io
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from html import escape
from typing import Any, NamedTuple

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
        from rich import box
        from rich.console import Console
        from rich.table import Table as Drawn
        from rich.text import Text

        head, *rows = self._marked()
        drawn = Drawn(box=box.MARKDOWN)
        for name, number in zip(head, self.numeric(), strict=True):
            drawn.add_column(Text(name), justify="right" if number else "left", no_wrap=True)
        for row in rows:
            drawn.add_row(*map(Text, row))
        console = Console(file=io.StringIO(), width=10_000, color_system=None)
        with console.capture() as shown:
            console.print(drawn)
        return shown.get().strip()

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


def stacked(tables: Sequence[tuple[str, Table]]) -> Table:
    """Return one `Table` of tables with equal columns. Several tables get a first column with their names.

    Examples
    --------
    >>> one, two = Table(["k"], [[9.0]]), Table(["k"], [[8.0]])
    >>> print(stacked([("tooth 0", one), ("tooth 5", two)]).markdown())
    | part | k |
    |---|---|
    | tooth 0 | 9 |
    | tooth 5 | 8 |
    """
    if len(tables) == 1:
        return tables[0][1]
    columns = (Column("part"), *tables[0][1].columns)
    return Table(columns, [[name, *row] for name, table in tables for row in table.rows])
