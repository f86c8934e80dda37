"""Random pairs of hard kinds: rows on file are those of the present code, and CalculiX decides beyond the outlines."""

import pytest

from validation.make import random_search as search
from validation.shared.table_rows import rows_of

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")  # drawn gears are capped and trimmed


def test_every_difference_beyond_the_estimates_has_a_value_of_calculix():
    """The page counts the rows that stay open; CalculiX has decided each row that the outlines do not cover."""
    rows, large = rows_of(search.TABLE), rows_of(search.LARGE)
    assert len({row["seed"] for row in rows}) == search.COUNT
    told = [search.settled(row, large) for row in search.beyond(rows)]
    assert None not in told
    assert search.open_rows(rows) == []


def test_the_draw_of_a_seed_is_that_of_the_rows_on_file():
    rows = rows_of(search.TABLE)
    for row in rows[:40:4]:
        kind, pair, _, load, phases, _ = search.random_case(int(row["seed"]))
        assert (row["kind"], row["load_N_mm"]) == (kind, f"{load:.1f}")
        assert row["pair"].startswith(f"{pair.gear_1.z}/{pair.gear_2.z}")
        assert row["phase"] in [f"{phase:.4f}" for phase in phases]


@pytest.mark.slow
def test_rows_of_the_hardest_cases_are_those_on_file():
    """Difference and estimate of `ritz` to 1e-3 of a percent of k."""
    rows = search.beyond(rows_of(search.TABLE))
    seeds = {row["seed"] for row in rows}
    truth = [row for row in rows_of(search.TRUTH) if row["seed"] in seeds]
    again = {(row["seed"], row["phase"]): row for row in search._ours(truth)}
    for row in rows:
        for name in ("off_percent", "estimate_percent"):
            assert float(again[row["seed"], row["phase"]][name]) == pytest.approx(float(row[name]), abs=1e-3)


@pytest.mark.slow
def test_sliding_beyond_its_limit_is_in_the_estimate():
    """A tooth with a deep bent crack on which contact slides by more than the limit, by CalculiX with large displacements.

    The seed is not of the page. Its difference of 6.8 % exceeded the former estimate of 5.0 %.
    """
    curve, _ = search.ours(930043)
    assert abs(curve.k[0] * 1e-6 / 4.751 - 1) < curve.error[0] / curve.k[0] + 0.0032
