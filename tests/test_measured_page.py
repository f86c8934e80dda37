"""The page of measured gearboxes: its cheap rows computed again, and what it says of them."""

import re

import measured
import pytest
from numpy.testing import assert_allclose

from validation.shared import page as pages

TEXT = pages.read("measured")[0]


def test_the_lines_of_the_phm_train_and_the_error_of_its_tachometer():
    assert "\n".join(measured._phm_text()[2].splitlines()) in TEXT
    for f, mesh, _, second, output in measured.phm_rows():
        assert_allclose([mesh / f, second / f, f / output], [32, 16, 5])
    assert max(measured.phm_angle()) < measured.PHM_HZ[-1] / measured.PHM_RATE, "less than a sample"


def test_a_perfect_planetary_set_has_its_line_at_a_multiple_of_three():
    assert max(measured.perfect()) < 1e-3
    assert "Its left sideband and mesh line are below a thousandth of it" in " ".join(TEXT.split())


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_the_page_is_what_is_computed_now():
    """All rows of its tables, and all numbers of its sentences."""
    text, lines = TEXT.splitlines(), "\n".join(measured.lines()).splitlines()
    assert [line for line in lines if line.startswith("|") and line not in text] == []
    numbers = re.findall(r"\d+\.\d+", "\n".join(line for line in lines if not line.startswith("|")))
    assert [number for number in numbers if number not in TEXT] == []
