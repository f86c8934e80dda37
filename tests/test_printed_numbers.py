"""Every number that the articles print has a row, and what the row says of it is so."""

import pytest

from validation.make import printed
from validation.shared import page as pages
from validation.shared import places

ROWS = printed.ledger()


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['article']} {row['what']}")
def test_what_is_said_of_a_printed_number(row):
    """Judged numbers stand in their reference as printed, used ones where they are said to be; the others have a reason."""
    which = printed.kind(row)
    if which == "unused":
        assert len(row["unused"]) > 20
    elif which == "verdict":
        there = printed.judged(row["verdict"])
        for value in row["values"]:
            assert any(abs(one - value) <= 1e-9 * abs(value) for one in there), f"{value}: not among {there}"
    else:
        there = [number for place in row["used"] for number in printed.put_in(place)]
        if there:
            assert len(there) == len(row["values"])
            assert there == pytest.approx(row["values"], rel=1e-5)


def test_places_that_are_not_there_are_found():
    with pytest.raises(TypeError):
        printed.put_in("gearfe/dynamics/machine/impact.py: no such words")
    with pytest.raises(KeyError):
        printed.put_in("herringbone: gear.sun.teeth")
    with pytest.raises(ValueError, match="none of verdict, used, unused"):
        printed.kind({"article": "S4", "what": "teeth"})


def test_every_judged_number_is_printed_somewhere():
    """The other way round: results of the scenes that have a printed number stand in the ledger, each with its values."""
    import gearfe as gf

    told = {}
    for row in ROWS:
        if "verdict" in row:
            name, _, factor = row["verdict"].partition(", per ")
            told.setdefault(name, set()).update(f"{value * float(factor or 1):.8g}" for value in row["values"])
    derived = {  # quotients and differences of printed values, and formulas whose value is ours
        "herringbone: displacement_span", "compound_planetary: stiffness_ratio", "compound_planetary: converged_stiffness",
        "compound_planetary: measured_speed", "helical_pitting: one_speed", "herringbone: mesh_period",
        "compound_planetary: same_instant",
    }  # fmt: skip
    for scene in printed.PAGES:
        for one in gf.load_scene(scene).references:
            number = any(row.value == row.value for row in one.rows) and one.unit != "statement"
            name = f"{scene}: {one.id}"
            assert not number or name in told.keys() | derived, f"{name} has no row in printed.toml"
            if number and name in told:
                assert told[name] == {f"{row.value:.8g}" for row in one.rows if row.value == row.value}, name


def test_the_page_is_made_of_the_ledger():
    text = pages.read("printed")[0]
    assert printed.answer(ROWS) in text
    assert (places.PAGES / "tables" / "printed.csv").is_file()
