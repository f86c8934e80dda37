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
def test_every_simulated_row_names_its_run(page):
    told = table_rows.read_runs(page)
    home = machines.module(page)
    for row in table_rows.read(page):
        assert row.run == home.RUN_OF.get(row.id, ""), f"{row.id}: run python -m validation PAGE {page}"
        if row.id in home.SIMULATED and row.id != "degrees":
            assert row.run in told, f"{row.id}, {row.case}: {row.run!r} is not among {', '.join(told)}"


@pytest.mark.parametrize(
    ("page", "run", "case"),
    [
        ("planetary_pitting", "impact law", {"pulsed": True}),
        ("planetary_pitting", "impact law, no pulses", {"pulsed": False}),
        ("helical_pitting", "impact law", {"pulsed": False}),
    ],
)
def test_the_runs_are_what_the_page_says(page, run, case):
    """The words are made again from the machine and a short record; length and rate from the page's own constants."""
    home = machines.module(page)
    made = simulated.own_law(page, **case)
    assert (made.law["power"] == 1.5).all()
    short = simulated.record(made, 0.002, home.RATE, 0.001)
    first, _, _ = simulated.told(short).rpartition("; ")
    time = f"{home.SECONDS:.4g} s after {home.SETTLE:.4g} s, {home.RATE:.6g} samples per second"
    assert table_rows.read_runs(page)[run] == f"{first}; {time}"


def test_the_errors_of_the_herringbone_stage_are_those_of_its_scene():
    import gearfe as gf

    own = gf.load_scene("herringbone").machine
    told = table_rows.read_runs("herringbone_machine")["with errors"]
    assert f"backlash {own['backlash_um']:g} um" in told
    assert f"{own['profile_error_um']:g} um at 480 Hz" in told
    assert "errors" not in table_rows.read_runs("herringbone_machine")["without errors"]


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
def test_a_finer_sampled_sideband_is_computed_again():
    from validation.make import planetary_runs

    found = planetary_runs.finer("mild")
    mesh, fault = planetary_runs.speeds()[2:]
    side = (simulated.amplitude(found, mesh - fault) + simulated.amplitude(found, mesh + fault)) / 2
    rows = table_rows.rows_of(places.TABLES / "planetary_pitting_laws.csv")
    (row,) = (row for row in rows if row["quantity"].startswith("the same, sampled") and row["case"] == "mild")
    assert_allclose(side, float(row["impact law"]), rtol=0.02, err_msg="run python -m validation PAGE planetary_pitting")
