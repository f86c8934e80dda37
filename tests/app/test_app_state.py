"""The state of the page is a scene: nothing of it is lost on the way there and back, and what no field holds is refused."""

import json
import os
import subprocess
import sys
import tomllib
from importlib import resources

import numpy as np
import pytest
from conftest import ROOT
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.damage import CASE, SET, first_rows, kinds
from gearfe.app.fields import BY_NAME, FIELDS, START, checked_state, form
from gearfe.app.solving import answer, compared, picture, scene_from
from gearfe.app.state import PAIR, SeveralError, read, tables_of
from gearfe.comparison.losses import damage_phases
from gearfe.core.units import in_newton_per_um
from gearfe.scene.load import scene_names
from gearfe.scene.toml_file import toml

NEW = "new.toml"
CRACK = {"kind": "crack", "gear": "pinion", "length_mm": 2.0}
PITS = {"kind": "pits", "gear": "pinion", "radius_mm": 21.0, "first_mm": 4.0, "axes_mm": [0.5, 1.0], "depth_mm": 0.2}
PART = CRACK | {"width_mm": [0.0, 8.0]}


def values(field):
    """Any value that the field takes."""
    if field.choices:
        return st.sampled_from(field.choices)
    return st.integers(int(field.low), int(field.high)) if field.whole else st.floats(field.low, field.high)


@pytest.mark.slow
@settings(deadline=None, max_examples=15)
@given(st.fixed_dictionaries({one.name: values(one) for one in FIELDS}), st.text(max_size=20))
def test_any_state_is_written_and_read_alike(state, title):
    """As TOML, with whatever text: what the file says is what the tables say. (Most such gears cannot be.)"""
    state = checked_state(state | {"title": title, "speed": 0.0})
    tables = tables_of(state)
    assert tomllib.loads(toml(tables)) == tables


STATES = {
    "start": {},
    "healthy": {"damage": [], "title": 'a "name" with \\ and é'},
    "level": {"damage": [{"kind": "crack", "gear": "wheel", "level": 0.4, "turning": True}]},
    "ring": {"wheel": "ring", "z_2": 84, "held_2": 95.0, "addendum_2": 0.8, "rack_tip_radius_2": 0.2, "damage": []},
    "helix": {"beta": -12.5, "lead_1": 4.0, "F_beta_x": 10.0, "speed": 1500.0},
    "herringbone": {"beta": 16.0, "b_1": 30.0, "b_2": 30.0, "face": "herringbone", "groove": 4.0},
    "pits": {"damage": [PITS | {"count": 3, "last_mm": 16.0}]},
    "pits about a middle": {
        "damage": [PITS | {"first_mm": None, "middle_mm": 10.0, "count": 3, "pitch_mm": 3.0, "angle_deg": 30.0}]
    },
    "every kind": {
        "damage": [
            CRACK | {"tooth": 5},
            CRACK | {"tooth": 5, "gear": "wheel", "angle_deg": 70.0},
            PITS | {"tooth": 9, "count": 2, "last_mm": 9.0},
            {
                "kind": "spall",
                "gear": "wheel",
                "radius_mm": 31.0,
                "z_mm": 9.0,
                "sides_mm": [1.0, 4.0],
                "depth_mm": 0.2,
                "tooth": 30,
            },
            {"kind": "missing_tooth", "gear": "wheel", "tooth": 12},
            {"kind": "chip", "gear": "pinion", "depth_mm": 0.4, "tooth": 14},
        ]
    },
    "a path": {"damage": [{"kind": "crack", "gear": "pinion", "path_mm": [1.0, 17.8, 0.2, 17.6], "start": "60deg"}]},
    "flanks": {"tip_relief_1": 20.0, "tip_length_1": 1.2, "tip_exponent_1": 2.0, "crowning_2": 3.0, "a": 52.1},
    "edges": {"root_relief_2": 8.0, "root_length_2": 1.0, "root_exponent_2": 2.0, "tip_rounding_1": 0.1, "tip_chamfer_2": 0.1},
    "soft": {"radial_1": 200.0, "tilt_2": 50.0, "torsion_1": 30.0, "damage": []},
    "part": {"damage": [PART | {"rounded": True, "ends": [1.0, 0.5]}]},
    "materials": {"E_1": 210000.0, "nu_2": 0.25, "x_1": 0.2, "x_2": -0.1, "force": 1234.5},
    "assumed": {"assumption": [{"what": "bore", "why": "a start", "holds": {"gear.pinion.r_bore_mm": 9.2}}]},
}


def _without_none(value):
    rows = isinstance(value, list)
    return [{key: one for key, one in row.items() if one is not None} for row in value] if rows else value


@pytest.mark.quick
@pytest.mark.parametrize("name", STATES)
def test_a_state_comes_back_from_its_file(name):
    state = checked_state({key: _without_none(value) for key, value in STATES[name].items()})
    back, notes = read(NEW, toml(tables_of(state)))
    assert notes == []
    assert tables_of(back) == tables_of(state)
    assert {name: back[name] for name in STATES[name]} == {name: state[name] for name in STATES[name]}
    assert scene_from(back).pair().damage == scene_from(state).pair().damage


def test_a_new_scene_opens_whole(tmp_path):
    """What `gearfe new` writes has a field for everything, also with a relief, and its stiffness is the page's."""
    file = gf.new_scene(tmp_path / NEW, teeth=(20, 33), tip_relief_um=20.0, tip_length_mm=1.5)
    state, notes = read(NEW, file.read_text())
    assert notes == []
    assert state["tip_relief_2"] == 20.0
    scene = gf.load_scene(file)
    mine = scene_from(state)
    assert mine.title == scene.title
    assert [one["what"] for one in mine.assumptions] == [one["what"] for one in scene.assumptions]
    wanted, got = scene.pair().case("cracked"), mine.pair().case(CASE)
    assert got == wanted


@pytest.mark.parametrize("scene", scene_names())
def test_a_built_in_scene_is_refused_until_a_pair_and_a_case_are_chosen(scene):
    text = (resources.files("gearfe.scene.scenes") / f"{scene}.toml").read_text(encoding="utf-8")
    with pytest.raises(SeveralError, match="choose a pair and case") as caught:
        read(scene, text)
    whole = gf.load_scene(scene)
    assert caught.value.choices == {name: ["", *one.damage] for name, one in whole.pairs.items()}
    pair, cases = next((name, cases) for name, cases in caught.value.choices.items() if len(cases) > 1)
    case = cases[1]
    state, notes = read(scene, text, pair, case)
    assert any("not taken" in one for one in notes)
    mine, own = scene_from(state).pair(), whole.pair(pair)
    assert mine.pair.gear_1 == own.pair.gear_1
    assert mine.materials == own.materials
    assert mine.damage.get(CASE) == own.damage.get(case)
    assert mine.force == own.force


REFUSED = {
    'z_cutter = 25\nz = 21': "gear.pinion.z_cutter = 25",
    'z = 21\n[support.soft]\ngear = "pinion"\naxial_N_per_um = 200.0': "support.pinion.axial_N_per_um",
    'z = 21\n[flank.p]\ngear = "pinion"\nprofile_slope_um = 3.0': "flank.pinion.profile_slope_um = 3.0",
    'z = 21\n[machine]\nmodel = "helical_pair"\nspeed_rpm = 100.0\ntorque_Nm = 7.0\nrunout_um = 3.0': "machine helical_pair",
    "z = 300": "this page accepts 6 to 160",
}  # fmt: skip


@pytest.mark.parametrize("more", REFUSED)
def test_what_no_field_holds_is_refused_by_its_name(more):
    text = toml(tables_of(START))
    head, _, tail = more.partition("\n[")
    text = text.replace("z = 21", head, 1) + (f"[{tail}\n" if tail else "")
    with pytest.raises(ValueError, match=r"new\.toml|page accepts") as caught:
        read(NEW, text)
    assert REFUSED[more] in str(caught.value)


WRONG = {
    "a list": [1],
    "no field": {"zz": 1},
    "a text for a number": {"z_1": "21"},
    "half a tooth": {"z_1": 21.5},
    "infinite": {"force": 1e400},
    "thousands of digits": {"z_1": 10**5000},
    "beyond": {"b_1": 1e6},
    "no choice": {"wheel": "maybe"},
    "damage that is no list": {"damage": CRACK},
    "an unknown kind": {"damage": [CRACK | {"kind": "scuffing"}]},
    "an unknown gear": {"damage": [CRACK | {"gear": "sun"}]},
    "another case": {"damage": [CRACK | {"case": "other"}]},
    "a key of another kind": {"damage": [CRACK | {"depth_mm": 0.2}]},
    "two sizes": {"damage": [CRACK | {"level": 0.2}]},
    "half a damaged tooth": {"damage": [CRACK | {"tooth": 0.5}]},
    "too many pits": {"damage": [PITS | {"count": 10**6}]},
    "too many rows": {"damage": [CRACK] * 1000},
    "a path of thousands of corners": {"damage": [{"kind": "crack", "gear": "pinion", "path_mm": [1.0, 17.0] * 4000}]},
    "a long title": {"title": "a" * 5000},
    "assumptions that are none": {"assumption": [{"what": "a", "else": 1}]},
}


@pytest.mark.parametrize("name", WRONG)
def test_a_state_that_cannot_be_is_refused_in_a_line(name):
    with pytest.raises(ValueError, match=r"but|expected|no field|unknown key|one of them") as caught:
        checked_state(WRONG[name])
    assert len(str(caught.value)) < 1500


def test_the_form_has_every_field_within_its_bounds():
    found = json.loads(form())
    assert found["start"] == checked_state({})
    for field in found["fields"]:
        assert field["choices"] or field["low"] < field["high"]
        name, _, wanted = field["when"].partition("=")
        assert not name or set(wanted.split(",")) <= set(BY_NAME[name].choices)


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
