"""Rows of the pages on growth, computed again. Their sources share no numbers with the pages."""

import numpy as np
import pytest

from validation.make import growth, growth_conventions, growth_detection
from validation.shared import kept_rows


@pytest.mark.parametrize("seed", [12, 25])
def test_polylines_near_the_load_are_those_on_file(seed):
    known = kept_rows.stored("growth_polylines")[str(seed)]["off_percent"]
    found = growth.polyline_row(seed)["off_percent"]
    assert found < 1
    assert found == pytest.approx(known, abs=0.02)


@pytest.mark.parametrize("key", [(0.3, 60, 0.5), (0.5, 90, 0.5)])
def test_rims_on_file_break_again(key):
    row = growth.rim_row(*key)
    assert row["outcome"] == kept_rows.stored("growth_rims")[" ".join(map(str, key))]["outcome"] == "rim cut"


def test_calculix_agrees_within_two_percent():
    rows = kept_rows.stored("growth_calculix").values()
    assert len(rows) == 5
    for row in rows:
        assert row["ritz_K_I"] == pytest.approx(row["K_I"], rel=0.02)
        assert row["ritz_K_II"] == pytest.approx(row["K_II"], abs=0.02 * row["K_I"])


def test_a_straight_crack_loses_the_stiffness_on_file():
    row, known = growth_conventions.stiffness_row(18, 3.0), kept_rows.stored("growth_conventions")["k 18 3.0"]
    np.testing.assert_allclose([row["path"], *row["straight"]], [known["path"], *known["straight"]], rtol=1e-3)


def test_detection_has_its_false_alarm_rate_without_a_crack_and_certainty_with_a_large_one():
    healthy = np.array(kept_rows.stored("growth_detection")["healthy"]["residual"])
    n = healthy.shape[1]
    nothing = growth_detection.detection(healthy, np.zeros(n), 30.0)
    assert nothing == pytest.approx([growth_detection.FALSE] * 2, abs=0.008)
    impulse = np.zeros(n)
    impulse[: n // 100] = 50 * healthy.std()
    assert growth_detection.detection(healthy, impulse, 30.0) == pytest.approx([1.0, 1.0])
