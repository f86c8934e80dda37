"""Pages state at their foot what computed them, long tables are continued by the same sources, and cheap rows are compared."""

import datetime
import re

import numpy as np
import pytest

from validation import check
from validation.shared import kept_rows, page


@pytest.fixture
def tables(tmp_path, monkeypatch):
    monkeypatch.setattr(kept_rows, "TABLES", tmp_path)
    monkeypatch.setattr(page, "PAGES", tmp_path)
    return tmp_path


def test_a_row_is_computed_once_and_again_by_other_sources(tables, monkeypatch):
    made = iter(range(9))
    monkeypatch.setattr(kept_rows, "digest", lambda: "one")
    keys = (("a", False), ("b", False), ("a", False), ("a", True))
    assert [kept_rows.kept("t", key, lambda: {"n": next(made)}, again)["n"] for key, again in keys] == [0, 1, 0, 0]
    monkeypatch.setattr(kept_rows, "digest", lambda: "two")
    assert kept_rows.kept("t", "a", lambda: {"n": next(made)})["n"] == 0
    assert kept_rows.kept("t", "a", lambda: {"n": next(made)}, again=True)["n"] == 2
    assert {key: (row["n"], row["made_by"]) for key, row in kept_rows.stored("t").items()} == {"a": (2, "two"), "b": (1, "one")}


def test_a_table_is_continued_by_the_sources_that_began_it_alone(tables, monkeypatch):
    table = tables / "t.csv"
    for digest, left in (("one", ""), ("one", "row"), ("two", "")):
        monkeypatch.setattr(kept_rows, "digest", lambda digest=digest: digest)
        kept_rows.begin(table)
        assert (table.read_text() if table.is_file() else "") == left
        table.write_text("row")


def test_a_page_states_what_computed_it_and_its_independent_values(tables):
    page.put("one", "# One\n\nAnswer.\n")
    page.sign("one", 12.3)
    page.sign("one", 100.0, reference=True)
    page.sign("one", 7.0)
    text, foot = page.read("one")
    assert text == "# One\n\nAnswer.\n"
    now = rf"on {datetime.date.today()} in (\d+) CPU s by gearfe [\d.]+, sources [0-9a-f]{{12}}\."
    assert re.fullmatch(f"Computed {now} Independent values computed {now}", foot).groups() == ("7", "100")
    page.put("one", "# Two\n")
    assert page.read("one") == ("# Two\n", foot)


@pytest.mark.parametrize("name", [path.stem for path in sorted(page.PAGES.glob("*.md"))])
def test_every_page_states_at_its_foot_what_computed_it(name):
    stated = r"Computed (on|from) 20\d\d-\d\d-\d\d.* in \d+ CPU s by gearfe [\d.]+, (sources|commits?) [0-9a-f]{7,12}"
    assert re.match(stated, page.read(name)[1])


def test_every_page_has_its_turn_within_ten_days():
    days = [check.pages_of(739_000 + day) for day in range(10)]
    assert {name for names in days for name in names} == set(check.PAGES)
    assert max(map(len, days)) <= 2


def test_a_row_that_differs_is_named(capsys, monkeypatch):
    rows = [("same", [1.0, "yes"], lambda: [1.00005, "yes"]), ("other", {"k": 1.0, "seconds": 2.0}, lambda: {"k": 1.0002})]
    monkeypatch.setattr(check, "cheap_rows", lambda name: iter(rows))
    found = check.check(pages=["truth"])
    assert "truth, other: 0.0002" in found
    assert "same" not in found
    assert "2 of 2" in capsys.readouterr().out
    assert check.check(pages=["truth"], seconds=0.0) is None, "no time, no row"


@pytest.mark.parametrize(
    ("known", "found", "off"),
    [
        (np.nan, np.nan, 0.0), (np.nan, 1.0, np.inf), (0.0, 0.0, 0.0), (0.0, 1e-9, np.inf), ([1.0], [1.0, 2.0], np.inf),
        ("yes", "no", np.inf), ({"a": 2.0}, {"a": 1.0}, 0.5), ({"a": 2.0}, {"b": 1.0}, np.inf),
        (np.array([1.0, 2.0]), [1.0, 3.0], 0.5),
    ],
)  # fmt: skip
def test_differences(known, found, off):
    assert check.difference(known, found) == off


@pytest.mark.parametrize("name", ["truth", "planetary_pitting", "helical_pitting"])
def test_cheapest_rows_are_those_on_file(name):
    assert check.check(pages=[name], seconds=2.0) is None
