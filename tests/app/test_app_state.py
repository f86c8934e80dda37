"""The state of the page is a scene: nothing of it is lost on the way there and back, and what no field holds is refused."""

import json
import tomllib
from importlib import resources

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import gearfe as gf
from gearfe.app.damage import CASE
from gearfe.app.fields import BY_NAME, FIELDS, START, checked_state, form
from gearfe.app.solving import scene_from
from gearfe.app.state import SeveralError, read, tables_of
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
