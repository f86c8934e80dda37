"""Pages of the articles: the simulations they name are those behind their numbers, and no two pages disagree."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.scene import verdicts
from validation.make import machines
from validation.shared import openings, places, simulated, table_rows
from validation.shared import page as pages
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


def test_statements_that_the_places_of_pits_set_are_not_counted():
    rows = table_rows.read("helical_pitting")
    said = [
        row
        for row in rows
        if row.id in ("statements", "further") and "lost contact line" not in row.case and "the same" not in row.case
    ]
    held = sum(row.verdict == verdicts.REPRODUCED for row in said)
    assert f"{held} of its {len(said)} statements hold" in openings.helical_pitting(machines.CommittedRows(rows))[1]


def test_repeats_tell_levels_apart_by_what_the_rows_say():
    rows = table_rows.read("planetary_pitting")
    assert "apart by SC by S0's formula, SC by S1's formula, RMS" in openings.planetary_pitting(machines.CommittedRows(rows))[1]
    none = [row._replace(ours=float("does not" in row.case)) if "three repeats" in row.case else row for row in rows]
    assert "apart by none of its indicators" in openings.planetary_pitting(machines.CommittedRows(none))[1]


def test_power_of_mesh_lines_is_found_in_records_of_any_length():
    """Two mesh lines and a hundredth of their power elsewhere, in a record that holds no whole periods of them."""
    from validation.make import compound_numbers

    (one, two), _ = compound_numbers.frequencies()
    time = np.arange(round(3.3 * 52416)) / 52416.0
    x = sum(a * np.cos(2 * np.pi * f * time) for a, f in ((1.0, one), (1.0, two), (0.2, one + two + 16.8)))
    made = gf.Signal(x, 52416.0, "rad/s2")
    assert_allclose(compound_numbers.of_mesh_lines(made), 2 / 2.04, rtol=1e-3)
    assert_allclose(compound_numbers.of_mesh_lines(replace(made, values=x[: round(20 / 14 * 52416)])), 2 / 2.04, rtol=1e-3)


def test_folded_lines_do_not_hide_what_pits_raise():
    """At S0's 10 kHz the healthy force has lines where the pits' are; sampled finer it has none, and the verdict follows."""
    rows = table_rows.rows_of(places.TABLES / "planetary_pitting_laws.csv")
    finer, folded = (
        {row["case"]: float(row["impact law"]) for row in rows if row["quantity"] == quantity}
        for quantity in ("the same, sampled 71680 times a second [N]", "sidebands f_m +- 40 Hz [N]")
    )
    said = {row.case: row.ours for row in table_rows.read("planetary_pitting")}
    assert finer["healthy"] == 0 < finer["mild"] < finer["moderate"] < finer["severe"]
    assert folded["mild"] < 10 * folded["healthy"]
    word = "pits raise sidebands 40 Hz beside 280 Hz"
    assert [said[word], said[f"{word}, sampled finer"]] == [0, 1]


@pytest.mark.slow
def test_a_finer_sampled_sideband_is_computed_again():
    from validation.make import planetary_runs

    found = planetary_runs.finer("mild")
    mesh, fault = planetary_runs.speeds()[2:]
    side = (simulated.amplitude(found, mesh - fault) + simulated.amplitude(found, mesh + fault)) / 2
    rows = table_rows.rows_of(places.TABLES / "planetary_pitting_laws.csv")
    (row,) = (row for row in rows if row["quantity"].startswith("the same, sampled") and row["case"] == "mild")
    assert_allclose(side, float(row["impact law"]), rtol=0.02, err_msg="run python -m validation PAGE planetary_pitting")


def test_dominant_frequencies_are_judged_of_what_s2_simulates_too():
    rows = table_rows.rows_of(places.TABLES / "compound_planetary_laws.csv")
    (power,) = (row for row in rows if row["quantity"].startswith("power of the healthy signal below"))
    said = {row.case: row.ours for row in table_rows.read("compound_planetary")}
    word = "dominant frequencies are below 2000 Hz"
    assert said[word] == (float(power["ring.theta acceleration"]) > 50)
    assert said[f"{word}, of sun 2's velocity"] == (float(power["sun2.theta velocity"]) > 50)
