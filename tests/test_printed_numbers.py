"""Every number that the articles print has a row, and what the row says of it is so."""

import inspect
import tomllib
from importlib import import_module, resources

import pytest

import gearfe as gf
from validation.make import printed
from validation.shared import page as pages
from validation.shared import places
from validation.shared.places import ROOT

ROWS = printed.ledger()
DEFAULTS = {"x": 0.0, "angle_deg": 45.0}  # of a scene's tables, where the file leaves them out


def judged(text):
    """Printed values of a reference, given as ``scene: id``, or ``scene: id, per factor`` (they are divided by it)."""
    scene, _, rest = text.partition(": ")
    name, _, factor = rest.partition(", per ")
    reference = next(one for one in gf.load_scene(scene).references if one.id == name)
    return [row.value / float(factor or 1.0) for row in reference.rows]


def put_in(text):
    """Numbers at a place that ``used`` names, divided by its factor; see the ledger's head."""
    place, _, factor = text.partition(", per ")
    return [value / float(factor or 1.0) for value in _found(place)]


def _found(place):
    home, _, what = place.partition(": ")
    if "/" in home:  # the text of a file
        return [] if what in (ROOT / home).read_text(encoding="utf-8") else None
    if home.startswith("gearfe."):  # a default of a function
        function, name = what.split()
        return [inspect.signature(getattr(import_module(home), function)).parameters[name].default]
    word, _, key = what.partition(" of ")
    if key:
        case = key.partition(".")[2]
        damage = [one for own in gf.load_scene(home).pair().damage[case].values() for one in own]
        return (
            [sum(isinstance(one, gf.Pit) for one in damage)]
            if word == "count"
            else [one.level for one in damage if isinstance(one, gf.Crack)]
        )
    value = tomllib.loads((resources.files("gearfe.scene.scenes") / f"{home}.toml").read_text(encoding="utf-8"))
    for part in what.split("."):
        if isinstance(value, list):
            value = value[int(part)] if part.isdigit() else next(one for one in value if one["case"] == part)
        elif part not in value and part in DEFAULTS:
            value = DEFAULTS[part]
        else:
            value = value[part]
    return value if isinstance(value, list) else [value]


@pytest.mark.slow
@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['article']} {row['what']}")
def test_what_is_said_of_a_printed_number(row):
    """Judged numbers stand in their reference as printed, used ones where they are said to be; the others have a reason."""
    which = printed.kind(row)
    if which == "unused":
        assert len(row["unused"]) > 20
    elif which == "verdict":
        there = judged(row["verdict"])
        for value in row["values"]:
            assert any(abs(one - value) <= 1e-9 * abs(value) for one in there), f"{value}: not among {there}"
    else:
        there = [number for place in row["used"] for number in put_in(place)]
        if there:
            assert len(there) == len(row["values"])
            assert there == pytest.approx(row["values"], rel=1e-5)


def test_places_that_are_not_there_are_found():
    with pytest.raises(TypeError):
        put_in("gearfe/dynamics/machine/impact.py: no such words")
    with pytest.raises(KeyError):
        put_in("herringbone: gear.sun.teeth")
    with pytest.raises(ValueError, match="none of verdict, used, unused"):
        printed.kind({"article": "S4", "what": "teeth"})


def test_every_judged_number_is_printed_somewhere():
    """The other way round: results of the scenes that have a printed number stand in the ledger, each with its values."""
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
