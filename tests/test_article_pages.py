"""Pages of the articles: the simulations they name are those behind their numbers, and no two pages disagree."""

import pytest

from validation.make import machines
from validation.shared import simulated, state, table_rows
from validation.shared.openings import OPENINGS

PAGES = list(machines.PAGES)


@pytest.mark.parametrize("page", PAGES)
def test_every_simulated_row_names_its_run(page):
    told = table_rows.read_runs(page)
    home = machines.module(page)
    for row in table_rows.read(page):
        assert row.run == home.RUN_OF.get(row.id, ""), f"{row.id}: run python -m validation machines {page}"
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
    assert f"play {own['backlash_um']:g} um" in told
    assert f"{own['profile_error_um']:g} um at 480 Hz" in told
    assert "errors" not in table_rows.read_runs("herringbone_machine")["without errors"]


@pytest.mark.parametrize("page", PAGES)
def test_pages_open_with_what_is_claimed_found_and_decides(page):
    parts = OPENINGS[page](machines.Found(table_rows.read(page)))
    assert len(parts) == 3
    head = state.without_first_line(page).splitlines()[4]
    assert "of a model" in state.without_first_line(page).splitlines()[2], "the counts are the answer"
    for part in parts:
        assert part in head
