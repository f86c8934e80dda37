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


def aligned(table: str) -> str:
    r"""A Markdown table with its columns padded to one width each; numbers stand to the right. Other lines stay.

    >>> print(aligned("| zone | k |\n|---|---|\n| single | 9.1 |\n| max | 12.0 |"))
    | zone   |    k |
    |--------|-----:|
    | single |  9.1 |
    | max    | 12.0 |
    """
    lines = table.splitlines()
    rows = {at: table_cells(line) for at, line in enumerate(lines) if line.startswith("|")}
    rule = {at for at, row in rows.items() if all(set(cell) <= set("-:") for cell in row)}
    texts = [row for at, row in rows.items() if at not in rule]
    count = max((len(row) for row in texts), default=0)
    padded = [[cell.replace("|", r"\|") for cell in row] + [""] * (count - len(row)) for row in texts]
    width = [max(len(row[k]) for row in padded) for k in range(count)]
    right = [k > 0 and any(row[k][-1:].isdigit() or row[k][-1:] == "%" for row in padded[1:]) for k in range(count)]
    made = iter(padded)
    for at in rows:
        if at in rule:
            lines[at] = "|" + "|".join("-" * (w + 1) + (":" if r else "-") for w, r in zip(width, right, strict=True)) + "|"
            continue
        cells = (cell.rjust(w) if r else cell.ljust(w) for cell, w, r in zip(next(made), width, right, strict=True))
        lines[at] = "| " + " | ".join(cells) + " |"
    return "\n".join(lines)
