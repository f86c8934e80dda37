"""Rows of Markdown tables whose cells hold texts of files: a bar or a line end in a name does not part a cell."""

import re
from collections.abc import Iterable


def table_row(cells: Iterable[str]) -> str:
    r"""One row.

    >>> print(table_row(["mild", "a|b", "1.5"]))
    | mild | a\|b | 1.5 |
    """
    inner = " | ".join(" ".join(cell.splitlines()).replace("|", r"\|") for cell in cells)
    return f"| {inner} |"


def table_cells(row: str) -> list[str]:
    r"""Cells of a row that `table_row` wrote.

    >>> table_cells(table_row(["mild", "a|b"]))
    ['mild', 'a|b']
    """
    inner = row.strip().removeprefix("|").removesuffix("|")
    return [cell.strip().replace(r"\|", "|") for cell in re.split(r"(?<!\\)\|", inner)]
