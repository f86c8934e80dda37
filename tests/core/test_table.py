"""Numbers of a table stay numbers until they are rendered; no renderer loses or changes a cell."""

import csv
import math

import pytest

from gearfe.core.table import Column, Table, stiffness_column

pytestmark = pytest.mark.quick

TABLE = Table(
    ["case", stiffness_column("k"), Column("error", "%", "{:+.1f}", mark=10.0), Column("count", form="{}")],
    [["a_b & c|d", 1.0 / 3.0, -0.25, 3], ["<two>\nlines", 1e9 / 7.0, 12.5, None], ["cost", (2.0, "{:.3f} s"), math.nan, 0]],
)


def test_cells_have_the_formats_of_their_columns():
    assert TABLE.cells() == [
        ["case", "k [N/um]", "error", "count"],
        ["a_b & c|d", "0.3333", "-0.2 %", "3"],
        ["<two> lines", "1.429e+08", "+12.5 %", ""],
        ["cost", "2.000 s", "", "0"],
    ]


def test_markdown_and_terminal_have_the_same_cells():
    for text in (TABLE.markdown(), str(TABLE)):
        rows = [[cell.strip() for cell in line.replace(r"\|", "/").strip("|").split("|")] for line in text.splitlines()]
        assert len({len(line) for line in str(TABLE).splitlines()}) == 1, "columns are aligned"
        assert [row for row in rows if set("".join(row)) != {"-"}] == [
            ["case", "k [N/um]", "error", "count"],
            ["a_b & c/d", "0.3333", "-0.2 %", "3"],
            ["<two> lines", "1.429e+08", "**+12.5 %**", ""],
            ["cost", "2.000 s", "", "0"],
        ]


def test_html_and_latex_escape_what_they_must():
    page = TABLE.html()
    assert "<td>a_b &amp; c|d</td>" in page
    assert "<td>&lt;two&gt; lines</td>" in page
    assert page.count(' class="far">+12.5 %<') == 1
    text = TABLE.latex()
    assert r"a\_b \& c|d & 0.3333 & $-$0.2 \% & 3 \\" in text
    assert r"$<$two$>$ lines & 1.429e+08 & \textbf{+12.5 \%} &  \\" in text
    assert text.startswith(r"\begin{tabular}{lrrr}")


def test_csv_has_all_digits(tmp_path):
    TABLE.save(tmp_path / "t.csv")
    with open(tmp_path / "t.csv", newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert head == ["case", "k [N/um]", "error [%]", "count"]
    assert [float(row[1]) for row in rows] == [1.0 / 3.0, 1e9 / 7.0, 2.0]
    assert [row[2] for row in rows] == ["-0.25", "12.5", ""]
    assert rows[1][0] == "<two>\nlines"


def test_other_suffixes_are_refused(tmp_path):
    with pytest.raises(ValueError, match=r"use one of \.csv, \.md, \.tex"):
        TABLE.save(tmp_path / "t.xlsx")
