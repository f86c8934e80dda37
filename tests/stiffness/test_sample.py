"""Rows of the sample of random pairs, made anew: what the page counts is what this code gives."""

import pytest

from validation.make import sample
from validation.shared.table_rows import rows_of

ROWS = rows_of(sample.TABLE)
NUMBERS = ("difference", "fe_error", "fe_estimate", "ritz_error", "ritz_estimate")
COVERED = ("apart_covered", "fe_covered", "ritz_covered")


def check(row):
    found = sample.row(int(row["seed"]))
    assert found["pair"] == row["pair"]
    for name in NUMBERS:
        assert float(found[name]) == pytest.approx(float(row[name]), rel=0.02, abs=5e-4), (
            f"seed {row['seed']}, {name}: remake the page"
        )
    for name in COVERED:
        assert found[name] == row[name], f"seed {row['seed']}, {name}: remake the page"


def test_the_cheapest_row_made_anew():
    check(min(ROWS, key=lambda row: float(row["cpu_s"])))
