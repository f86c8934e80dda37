"""Pages of the articles: the simulations they name are those behind their numbers, and no two pages disagree."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.scene import verdicts
from validation.make import machines
from validation.shared import page as pages
from validation.shared import places, simulated, table_rows
from validation.shared.openings import OPENINGS

PAGES = list(machines.PAGES)


@pytest.mark.parametrize("page", PAGES)
def test_pages_open_with_what_is_claimed_found_and_decides(page):
    parts = OPENINGS[page](machines.CommittedRows(table_rows.read(page)))
    assert len(parts) == 3
    head = pages.read(page)[0].partition("\n|")[0]
    assert "of a model" in head, "the counts are the answer"
    for part in parts:
        assert part in head


@pytest.mark.parametrize("page", PAGES)
def test_verdicts_follow_from_the_numbers_on_file(page):
    """Judged again with the words of today: a verdict that an assumption sets is called so, and no other row is on file."""
    own = table_rows.read(page)
    for one in machines.references(page):
        rows = [row for row in own if row.id == one.id]
        ours = {(row.case, row.pair) if row.pair else row.case: None if np.isnan(row.ours) else row.ours for row in rows}
        assert [row.verdict for row in verdicts.judge(one, ours)] == [row.verdict for row in rows], one.id
    assert {row.id for row in own} == {one.id for one in machines.references(page)}


def test_power_of_mesh_lines_is_found_in_records_of_any_length():
    """Two mesh lines and a hundredth of their power elsewhere, in a record that holds no whole periods of them."""
    from validation.make import compound_numbers

    (one, two), _ = compound_numbers.frequencies()
    time = np.arange(round(3.3 * 52416)) / 52416.0
    x = sum(a * np.cos(2 * np.pi * f * time) for a, f in ((1.0, one), (1.0, two), (0.2, one + two + 16.8)))
    made = gf.Signal(x, 52416.0, "rad/s2")
    assert_allclose(compound_numbers.of_mesh_lines(made), 2 / 2.04, rtol=1e-3)
    assert_allclose(compound_numbers.of_mesh_lines(replace(made, values=x[: round(20 / 14 * 52416)])), 2 / 2.04, rtol=1e-3)


@pytest.mark.slow
def test_a_finer_sampled_sideband_is_that_of_the_frozen_page():
    """At S0's 10 kHz the healthy force has lines where the pits' are. Sampled finer it has none."""
    from validation.make import planetary_runs

    found = planetary_runs.finer("mild")
    mesh, fault = planetary_runs.speeds()[2:]
    side = (simulated.amplitude(found, mesh - fault) + simulated.amplitude(found, mesh + fault)) / 2
    assert_allclose(side, _on_file("planetary_pitting", "the same, sampled", "mild", "impact law"), rtol=0.02)


@pytest.mark.slow
def test_a_low_line_under_linear_stiffness_is_that_of_the_frozen_page():
    from validation.make import helical_pitting as page

    start = simulated.periodic("helical_pitting", "severe")
    made = simulated.machine("helical_pitting", "severe")
    response = simulated.record(made, page.SECONDS, page.RATE, page.SETTLE, start)
    found = simulated.spectrum(simulated.signal(response, page.FORCE))
    line = simulated.amplitude(found, page.frequencies()["f_r"])
    assert_allclose(line, _on_file("helical_pitting", "low lines [N]", "severe, 1 f_r", "linear stiffness"), rtol=1e-3)


@pytest.mark.slow
def test_a_machine_without_errors_has_the_indicators_of_the_frozen_page():
    from validation.make import herringbone_runs as runs

    bare = runs.made("case4").with_meshes(error=(), backlash=0.0)
    response = simulated.record(bare, runs.SECONDS, runs.RATE, 4 * runs.SETTLE)
    found = simulated.signal(response, runs.TURNING).indicators(*runs.speeds()[2:])["kurtosis"]
    assert_allclose(found, _on_file("herringbone_machine", "its kurtosis", "case 4", "without errors"), rtol=1e-3)


def _on_file(page, quantity, case, column):
    """Value of a table of a frozen page of variants."""
    rows = table_rows.rows_of(places.TABLES / f"{page}_laws.csv")
    (row,) = (row for row in rows if row["quantity"].startswith(quantity) and row["case"] == case)
    return float(row[column])
