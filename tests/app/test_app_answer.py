"""Answers of the page: numbers of a state, its program, notes, growth of its crack and drawn teeth."""

import json
import os
import subprocess
import sys
import tomllib
from importlib import resources

import numpy as np
import pytest
from conftest import ROOT
from numpy.testing import assert_allclose
from test_app_state import CRACK, NEW, PART, PITS, STATES

import gearfe as gf
from gearfe.app.damage import CASE, SET, first_rows, kinds
from gearfe.app.fields import START, checked_state
from gearfe.app.solving import answer, compared, picture, scene_from
from gearfe.app.state import PAIR, read, tables_of
from gearfe.comparison.losses import damage_phases
from gearfe.core.units import in_newton_per_um
from gearfe.scene.toml_file import toml


@pytest.mark.parametrize("kind", ["quick", "fine"])
def test_numbers_of_the_page_are_those_of_mesh_stiffness(kind, tmp_path):
    """Of the scene that the page's own TOML makes, to the last bit; printed ones to their last digit."""
    state = checked_state({"z_1": 19, "force": 1500.0, "damage": [CRACK | {"length_mm": 1.5}]})
    found = json.loads(answer(kind, state))
    file = tmp_path / "page.toml"
    file.write_text(json.loads(answer("toml", state))["text"], encoding="utf-8")
    scene = gf.load_scene(file)
    error = kind == "fine"
    for curve, case in zip(found["curves"], (None, CASE), strict=True):
        run = scene.pair(PAIR).case(case).as_dict() | {"phases": curve["at"], "method": "ritz", "error": error}
        own = gf.mesh_stiffness(**run)
        assert curve["solved"] == own.k.tolist()
        assert curve["te"] == (own.te * 1e6).tolist()
        assert curve["error"] == ((own.error / 1e6).tolist() if error else [])
    chosen, count = scene.pair(PAIR), 64 if error else 32
    cycle = damage_phases(chosen.case(), count)
    zones = [gf.mesh_stiffness(chosen.case(case), phases=cycle, method="ritz").zones() for case in (None, CASE)]
    for zone, *two in found["tables"][0][1][1:-1]:
        assert two[:2] == [in_newton_per_um(one[zone]) for one in zones]
    if error:
        assert "±" in found["headline"]


def test_the_program_prints_the_numbers_of_the_page(capsys):
    for damage in ([CRACK | {"length_mm": 1.2}], STATES["every kind"]["damage"][:2] + STATES["every kind"]["damage"][4:]):
        state = checked_state({"damage": damage, "tip_relief_1": 15.0})
        text = json.loads(answer("python", state))["text"]
        exec(compile(text, "gear.py", "exec"), {})
        lines = capsys.readouterr().out.splitlines()
        tables = json.loads(answer("fine", state))["tables"]
        wanted = []
        for words, table in tables:
            wanted += [words] if len(tables) > 1 else []
            for zone, healthy, damaged, *_ in table[1:-1]:
                wanted.append(f"{zone}: healthy {float(healthy):.4g} N/um, damaged {float(damaged):.4g} N/um")
        assert lines == wanted
        assert len(tables) == (1 if len(damage) == 1 else 3)


def test_csv_is_the_curve(tmp_path):
    state = checked_state({"damage": []})
    file = tmp_path / "k.csv"
    file.write_text(json.loads(answer("csv", state))["text"], encoding="utf-8")
    curve = gf.StiffnessCurve.from_csv(file)
    assert curve.k.tolist() == json.loads(answer("fine", state))["curves"][0]["solved"]


def test_damage_of_an_unloaded_flank_or_of_several_bodies_is_refused():
    """Of a planet whose crack is on the flank of the sun, seen in its pair with the ring, and of two planets."""
    text = (resources.files("gearfe.scene.scenes") / "planetary_pitting.toml").read_text(encoding="utf-8")
    crack = '\n[[crack]]\ncase = "own"\ngear = "planet"\nlevel = 0.2\n'
    state, _ = read("my.toml", text + crack, "sun_planet", "own")
    assert state["damage"] == [{"kind": "crack", "gear": "wheel", "level": 0.2}]
    with pytest.raises(ValueError, match="on a flank that is not loaded"):
        read("my.toml", text + crack, "planet_ring", "own")
    both = f'{crack}body = "planet1"\n{crack}body = "planet2"\ntooth = 7\n'
    with pytest.raises(ValueError, match="several bodies"):
        read("my.toml", text + both, "sun_planet", "own")
    _, told = read("my.toml", f'{text}{crack}body = "planet2"\n', "sun_planet", "own")
    assert "not taken from my.toml: bodies of damaged teeth planet2" in told


def test_what_a_section_cannot_show_is_said():
    found = json.loads(answer("quick", checked_state({"damage": [PITS], "beta": 8.0})))
    assert found["section"]
    assert any("pits" in one for one in found["notes"])
    assert any("helical teeth are taken as spur" in one for one in found["notes"])
    assert found["picture"]["gears"][0]["damage"], "drawn all the same"
    assert compared(scene_from(checked_state({})), "ritz", 8, error=False)[1] == ()


def test_impossible_gears_are_refused_in_gearfes_words():
    told = json.loads(answer("quick", checked_state({"held_1": 40.0})))["refused"]
    assert told.startswith("[gear.pinion]: r_bore_mm = 40.0, but the bore must lie inside")


def test_a_crack_of_part_of_the_width_waits_for_three_dimensions():
    """The section would have it through the whole width: it is shown healthy, and says so; so is a support that tilts."""
    part = {"damage": [PART]}
    plain = json.loads(answer("quick", START | {"damage": []}))
    for state in (part, part | {"tilt_1": 50.0}, {"damage": [], "tilt_2": 50.0}):
        shown = json.loads(answer("quick", START | state))
        assert shown["section"]
        assert "solve in three dimensions" in shown["notes"][0]
        assert [one["k"] for one in shown["curves"]] == [one["k"] for one in plain["curves"]]


def test_of_a_planetary_set_one_pair_is_shown_and_that_is_said():
    page = (ROOT / "gearfe" / "docs" / "howto" / "planetary_set.md").read_text(encoding="utf-8")
    text = page[page.index("title = ") : page.index("```\n\n```sh")]
    _, told = read("my.toml", text, "sun_planet", "")
    assert "not taken from my.toml: the planetary set" in told


@pytest.mark.slow
def test_gears_that_a_slider_passes_are_not_written_to_the_disk(tmp_path):
    """By a solver process in three dimensions, whose gears other programs keep there."""
    work = "from gearfe.app.solving import *; begin(); print(answer('solid', START | {'beta': 9.0, 'z_1': 23}).decode())"
    command = [sys.executable, "-c", work]
    told = subprocess.run(command, env=os.environ | {"GEARFE_CACHE": str(tmp_path)}, capture_output=True, text=True, check=True)
    assert json.loads(told.stdout)["method"].startswith("ritz3d")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("side", ["pinion", "wheel"])
def test_a_crack_grows_along_its_computed_path(side):
    """By two steps of `grow_crack`, by one and a half, and beyond the end; the file of the page has the same path."""
    given = {"damage": [{"kind": "crack", "gear": side, "length_mm": 0.6}]}
    own = scene_from(checked_state(given)).pair()
    growth = gf.grow_crack(own.case(), gf.Crack(length=0.6), side)
    tables = {
        by: tomllib.loads(json.loads(answer("toml", checked_state(given | {"crack_grown": by})))["text"]) for by in (0.4, 0.3, 60)
    }
    paths = {by: np.reshape(one["crack"][0]["path_mm"], (-1, 2)) for by, one in tables.items()}
    assert_allclose(paths[0.4], growth.cracks[2].path, rtol=1e-9)
    assert_allclose(paths[0.3][-1], np.mean(growth.cracks[2].path[-2:], axis=0), rtol=1e-9)
    assert_allclose(paths[60], growth.cracks[-1].path, rtol=1e-9)
    assert [one["crack"][0]["gear"] for one in tables.values()] == [side] * 3
    back, notes = read(NEW, toml(tables[0.4]))
    assert (notes, tables_of(back)) == ([], tables[0.4])
    further = json.loads(answer("toml", checked_state(back | {"crack_grown": 0.2})))["text"]
    path = np.reshape(tomllib.loads(further)["crack"][0]["path_mm"], (-1, 2))
    assert_allclose(path[:3], growth.cracks[2].path, rtol=1e-9)
    assert_allclose(path, growth.cracks[3].path, atol=0.05 * 0.2, err_msg="the growth from a reopened file is a new one")


@pytest.mark.parametrize(
    ("more", "message"), [({"beta": 12.0}, "for spur gears"), ({"damage": [CRACK, PITS]}, "must be the only damage")]
)
def test_what_cannot_grow_is_refused(more, message):
    with pytest.raises(ValueError, match=message):
        scene_from(checked_state({"crack_grown": 0.4} | more))


def test_every_key_of_damage_has_a_field():
    """Except those that the page sets itself."""
    for kind, fields in kinds().items():
        assert {one["key"] for one in fields} | set(SET) >= set(gf.scene.schema.scene_schema()[kind].keys)
        assert all(one["low"] is None or one["low"] < one["high"] for one in fields)


@pytest.mark.parametrize(
    "more",
    [{}, {"m_n": 5.0, "z_1": 17}, {"wheel": "ring", "z_2": 84, "held_2": 95.0, "addendum_2": 0.8, "rack_tip_radius_2": 0.2}],
)
def test_added_damage_suits_the_gears(more):
    state = checked_state(more | {"damage": [], "held_1": 3.0 * more.get("m_n", 2.0), "held_2": more.get("held_2", 20.0)})
    for kind, row in first_rows(scene_from(state).pair().pair, state["force"]).items():
        assert scene_from(checked_state(state | {"damage": [row]})).pair().damage[CASE], kind


@pytest.mark.parametrize("side", ["pinion", "wheel"])
def test_the_damaged_tooth_is_drawn_where_it_is_in_mesh(side):
    """Tooth k at phase p - k stands where tooth 0 stands at phase p."""
    places = []
    for tooth in (0, 5):
        own = picture(scene_from(checked_state({"damage": [CRACK | {"gear": side, "tooth": tooth}]})))["gears"][side == "wheel"]
        angle = own["turn"] + own["rate"] * (0.8 - tooth)
        places.append(gf.geometry.tooth.profile.turned(np.array(own["damage"][0]["line"]).T, angle))
    assert_allclose(places[1], places[0], atol=1e-4)
