"""The page of measured gearboxes: its tables and counts computed again."""

import measured
import pytest
from numpy.testing import assert_allclose

from validation.shared import page as pages

TEXT = " ".join(pages.read("measured")[0].split())


def on_page(rows):
    """Judge that the page has these rows."""
    for row in rows:
        assert f"| {' | '.join(row)} |" in TEXT


def test_the_lines_of_the_phm_train_and_the_error_of_its_tachometer():
    on_page(measured.train_rows())
    for f, mesh, _, second, output in measured.phm_rows():
        assert_allclose([mesh / f, second / f, f / output], [32, 16, 5])
    assert max(measured.phm_angle()) < measured.PHM_HZ[-1] / measured.PHM_RATE, "less than a sample"


def test_a_perfect_planetary_set_has_its_line_at_a_multiple_of_three():
    assert max(measured.perfect()) < 1e-3
    assert "Its left sideband and mesh line are below a thousandth of it" in TEXT


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_the_page_is_what_is_computed_now():
    found = measured.planetary()
    on_page([*measured.sideband_rows(found), *measured.indicator_rows(), *measured.bore_rows()])
    (planet, planets), (sun, suns) = measured.trends(found).values()
    assert (
        f"in {planet} of {planets} scanned sets. A sun fault raises the right one by more than 2 % in {sun} of {suns} sets"
        in TEXT
    )
