"""References of a scene: read strictly."""

from importlib import resources

import pytest

import gearfe as gf
from gearfe.scene.references import printed_stiffness

pytestmark = pytest.mark.quick

TEXT = (resources.files("gearfe.scene.scenes") / "herringbone.toml").read_text(encoding="utf-8")
FIRST = """
[[reference]]
id = "a"
quantity = "mesh frequency"
unit = "Hz"
source = "S4"
relative = 0.01
tolerance = "because"
rows = [{ case = "one", printed = 480.0 }, { case = "two", printed = 8.9, corrected = 80.0, correction = "turned over" }]
"""


def scene(tmp_path, old="", new=""):
    assert old in FIRST
    path = tmp_path / "s.toml"
    path.write_text(TEXT[: TEXT.index("# What the articles print")] + FIRST.replace(old, new, 1), encoding="utf-8")
    return gf.load_scene(path)


def test_as_printed(tmp_path):
    (found,) = scene(tmp_path).references
    assert (found.id, found.unit, found.relative, found.absolute, found.trend) == ("a", "Hz", 0.01, None, False)
    assert [(row.case, row.value, row.corrected) for row in found.rows] == [("one", 480.0, None), ("two", 8.9, 80.0)]
    assert found.within(484.0, 480.0)
    assert not found.within(486.0, 480.0)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("relative = 0.01", "", r"give relative \(tolerance as a part of the printed value\) or absolute"),
        (
            "relative = 0.01",
            "relative = 0.01\nabsolute = 1.0",
            r"give relative \(tolerance as a part of the printed value\) or absolute",
        ),
        ("relative = 0.01", "relative = -0.01", "relative = -0.01, but it must be at least 0"),
        ('id = "a"', 'name = "a"', "unknown key 'name'"),
        ('source = "S4"', "", "missing key 'source'"),
        ('unit = "Hz"', 'unit = "statement"', "rows of unit 'statement' have claim"),
        ("printed = 480.0", "claim = true", "rows of unit 'statement' have claim"),
        ("printed = 480.0", "printed = 480.0, claim = true", "printed and claim exclude each other"),
        ("printed = 480.0", 'printed = "480"', "printed = '480': expected a number"),
        ("printed = 480.0", 'printed = 480.0, pair = "moon"', "no such pair; there is sun_planet, planet_ring"),
        (', correction = "turned over"', "", "but no correction; state what was changed"),
        ('case = "two"', 'case = "one"', "two rows of case 'one'"),
        ("rows = [{", "rows = [1, {", "expected a table of keys and values, got 1"),
    ],
)
def test_errors_name_file_table_and_key(tmp_path, old, new, message):
    with pytest.raises(ValueError, match=message) as caught:
        scene(tmp_path, old, new)
    assert "s.toml [reference 1" in str(caught.value)


def test_ids_are_used_once(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text(TEXT[: TEXT.index("# What the articles print")] + FIRST + FIRST, encoding="utf-8")
    with pytest.raises(ValueError, match="reference id 'a' is used twice"):
        gf.load_scene(path)


def test_printed_stiffness_of_a_case():
    made = gf.load_scene("herringbone")
    lines = printed_stiffness(made, "sun_planet", "case2")
    assert len(lines) == 2
    assert "analytical: 960 N/um" in lines[0]
    assert "1030 N/um after a correction" in lines[0]
    assert printed_stiffness(made, "sun_planet") != lines
    assert "1676 N/um (S2" in printed_stiffness(gf.load_scene("compound_planetary"), "sun_planet")[0]
    assert printed_stiffness(gf.load_scene("helical_pitting"), "pinion_wheel") == []
