"""One schema: what it permits is read alike everywhere, what it does not is said, and what is made from it is current."""

import json
import math
import re
import tomllib
import warnings
from importlib import resources

import pytest
from conftest import ROOT
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

import gearfe as gf
from gearfe.app.cli import main
from gearfe.app.damage import CASE
from gearfe.app.state import read, tables_of
from gearfe.dynamics.machine.of_scene import MACHINES
from gearfe.geometry.damage.crack_form import STARTS
from gearfe.geometry.pair.lines import FACES
from gearfe.runs.datasets.faults import FAULTS
from gearfe.runs.sweeps.kinds import KINDS
from gearfe.runs.sweeps.samples import METHODS
from gearfe.runs.sweeps.study import read_study
from gearfe.scene.describe import json_schema, keys_page
from gearfe.scene.dotted_keys import set_values
from gearfe.scene.load import load_scene, scene_names, scene_of
from gearfe.scene.schema import scene_schema, schema_of
from gearfe.scene.toml_file import toml

OPTIONS = st.fixed_dictionaries(
    {
        "teeth": st.tuples(st.integers(17, 40), st.integers(17, 60)),
        "module": st.sampled_from([0.5, 1.0, 2.5, 7.0]),
        "helix_deg": st.sampled_from([0.0, 8.0, -20.0]),
        "width": st.floats(5.0, 60.0),
        "torque_Nm": st.none() | st.floats(1.0, 20.0),
    }
)
PAGE = {  # tables of which the page has fields, by the place of one in a new scene
    "material.steel": "material", "pair.stage": "pair", "flank.pinion": "flank", "support.wheel": "support",
    "crack.cracked": "crack",
}  # fmt: skip
OTHERS = {"r_bore_mm", "face", "a_mm", "groove_mm", "tooth", "ends", "end_relief_um", "width_mm", "level", "length_mm"}


def values(key):
    """Any value of the range of a key that is usual, without its ends."""
    if key.choices:
        return st.sampled_from(key.choices)
    if key.type == "boolean":
        return st.booleans()
    low, high, _ = key.usual
    return (
        st.integers(int(low) + 1, int(high) - 1)
        if key.type == "integer"
        else st.floats(low, high, exclude_min=True, exclude_max=True)
    )


def drawn():
    """Values by dotted key, of a few of the keys that the page has."""
    keys = {}
    for place, kind in PAGE.items():
        for key in scene_schema()[kind].keys.values():
            if (key.usual or key.choices or key.type == "boolean") and key.name not in OTHERS and key.name != "rounded":
                keys[f"{place}.{key.name}"] = values(key)
    return st.lists(st.sampled_from(sorted(keys)), unique=True, max_size=6).flatmap(
        lambda names: st.fixed_dictionaries({name: keys[name] for name in names})
    )


@settings(deadline=None, max_examples=40, suppress_health_check=list(HealthCheck))
@given(OPTIONS, drawn())
def test_new_load_form_and_scene_go_round(tmp_path_factory, options, chosen):
    """A new scene with any values of the schema is written, read, shown in the form and written again: the same case."""
    path = tmp_path_factory.mktemp("new") / "my.toml"
    try:
        gf.new_scene(path, **options)
    except ValueError:
        assume(False)
    tables = tomllib.loads(path.read_text(encoding="utf-8"))
    tables |= {"flank": {"pinion": {"gear": "pinion"}}, "support": {"wheel": {"gear": "wheel"}}}
    tables = set_values(tables, chosen)
    for end in ("tip", "root"):  # a relief has a start, and there is none without
        flank = tables["flank"]["pinion"]
        if not flank.get(f"{end}_relief_um"):
            flank |= {f"{end}_relief_um": 0.0, f"{end}_exponent": 1.0}
            flank.pop(f"{end}_start_length_mm", None)
        else:
            flank.setdefault(f"{end}_start_length_mm", 0.5 * options["module"])
    if not any(value for key, value in tables["flank"]["pinion"].items() if key.endswith(("_um", "ing_mm", "chamfer_mm"))):
        del tables["flank"]
    if len(tables["support"]["wheel"]) == 1:
        del tables["support"]
    assert tomllib.loads(toml(tables)) == tables
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        try:
            case = scene_of("my.toml", tables).case("stage", "cracked")
        except ValueError:
            assume(False)
        state, notes = read("my.toml", toml(tables))
        again = scene_of("my.toml", tomllib.loads(toml(tables_of(state)))).case("stage", CASE)
    assert notes == []
    assert again == case


@settings(deadline=None, max_examples=25, suppress_health_check=list(HealthCheck))
@given(OPTIONS)
def test_any_new_scene_opens_in_the_page(tmp_path_factory, options):
    path = tmp_path_factory.mktemp("new") / "my.toml"
    try:
        scene = load_scene(gf.new_scene(path, **options))
    except ValueError:
        assume(False)
    state, notes = read("my.toml", path.read_text(encoding="utf-8"))
    assert notes == []
    assert scene_of("page", tables_of(state)).case("stage", CASE) == scene.case("stage", "cracked")


TEXT = (resources.files("gearfe.scene.scenes") / "planetary_pitting.toml").read_text(encoding="utf-8")
MESSAGES = [  # of a scene: text, what is there instead, the whole message but the file
    ("alpha_n_deg = 20.0", "alpha_n_deg = 0.35", "[gear.sun] alpha_n_deg = 0.35, but it must lie between 5 and 45 degrees"),
    ("z = 21", "zz = 21", "[gear.sun]: unknown key 'zz' (nearest: 'z'); expected z, m_n_mm, alpha_n_deg, beta_deg, b_mm, x, "
     "addendum, dedendum, rack_tip_radius, r_bore_mm, r_rim_mm, z_cutter, E_sn_um, x_E, material"),
    ("z = 21\n", "", "[gear.sun]: missing key 'z'; expected a whole number"),
    ("b_mm = 20.0", "b_mm = '20'", "[gear.sun] b_mm = '20': expected a number in mm"),
    ("r_bore_mm = 7.4", "r_bore_mm = 74.0", "[gear.sun]: r_bore_mm = 74.0, but the bore must lie inside the root circle: give "
     "0 < r_bore_mm < 18.5 mm"),
    ("a_mm = 52.0", "face = 'straight'", "[pair.sun_planet] face = 'straight', but it must be one of spur, helical, herringbone"),
    ("axes_mm = [", "axes_mm = [-1.0, 1.0] # ", "[pits 1] axes_mm = [-1.0, 1.0], but each number must be above 0 mm"),
    ('model = "planetary"', 'model = "planetry"', "[machine] model = 'planetry', but it must be one of planetary, "
     "compound_planetary, helical_pair, herringbone_planetary, gearbox"),
    ('gear = "sun"', 'gear = "son"', "[pits 1] gear = 'son': no such gear; there is sun, planet, ring"),
    ("[given]\n", '[given]\n"gear.sun" = 21\n', "[given] 'gear.sun' is a table, but give single values: gear.sun.KEY = VALUE"),
]  # fmt: skip


@pytest.mark.quick
@pytest.mark.parametrize(("old", "new", "message"), MESSAGES, ids=[new or "missing" for _, new, _ in MESSAGES])
def test_messages_name_file_table_key_value_and_remedy(old, new, message):
    assert old in TEXT
    with pytest.raises(ValueError, match=r"own\.toml") as caught:
        scene_of("own.toml", tomllib.loads(TEXT.replace(old, new, 1)))
    assert str(caught.value) == f"own.toml {message}"


PINION = {"gear": "pinion"}
ROWS = {  # a valid row of each table
    "pair": {}, "flank": PINION, "support": PINION, "machine": {"model": "helical_pair", "speed_rpm": 1e3, "torque_Nm": 50.0},
    "crack": PINION | {"case": "c", "length_mm": 1.0, "angle_deg": 45.0}, "chip": PINION | {"case": "c", "depth_mm": 0.5},
    "pits": PINION | {"case": "c", "count": 3, "radius_mm": 31.0, "axes_mm": [0.3, 0.3], "depth_mm": 0.2, "middle_mm": 10.0,
                      "pitch_mm": 2.0},
    "spall": PINION | {"case": "c", "radius_mm": 31.0, "z_mm": 10.0, "sides_mm": [1.0, 3.0], "depth_mm": 0.2},
}  # fmt: skip


@pytest.mark.parametrize("kind", ROWS)
def test_any_impossible_number_is_answered_by_its_key(tmp_path, kind):
    """Of every number of a table, negative to huge: the message has file, table and the key with its unit."""
    tables = tomllib.loads(
        gf.new_scene(tmp_path / "my.toml", teeth=(21, 38), module=3.0, width=20.0, torque_Nm=50.0).read_text(encoding="utf-8")
    )
    del tables["crack"]
    answered = 0
    for key in (one for one in scene_schema()[kind].keys.values() if one.type in ("number", "integer", "numbers")):
        for factor in (-30.0, -1.0, 3.0, 30.0, 1e4, math.nan):
            value = factor * (key.usual or (0, 10))[1]
            value = int(value) if key.type == "integer" and value == value else value
            row = ROWS[kind] | {key.name: [value, 2 * value] if key.type == "numbers" else value}
            if key.name == "level":
                del row["length_mm"]
            forms = {"machine": row, "pair": {"stage": tables["pair"]["stage"] | row}, "flank": {"a": row}, "support": {"a": row}}
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UserWarning)
                text = ""
                try:
                    scene = scene_of("my.toml", tables | {kind: forms.get(kind, [row])})
                    scene.case("stage", next(iter(scene.cases), None))
                except ValueError as error:
                    text = str(error)
            assert not text or re.match(rf"my\.toml \[{kind}.*\b{key.name}\b", text), text
            answered += bool(text)
    assert answered > 3


@pytest.mark.quick
def test_choices_are_those_of_the_code():
    scene, runs = scene_schema(), schema_of("gearfe.runs")
    assert set(scene["machine"].keys["model"].choices) == set(MACHINES)
    assert set(scene["crack"].keys["start"].choices) == set(STARTS)
    assert set(scene["pair"].keys["face"].choices) == set(FACES)
    assert set(runs["study"].keys["kind"].choices) == set(KINDS)
    assert {kind.options for kind in KINDS.values()} <= set(runs)
    assert set(runs["sample"].keys["method"].choices) == set(METHODS)
    assert {f"{kind}_fault" for kind in FAULTS} <= set(runs)


@pytest.mark.quick
def test_every_key_is_described_and_its_default_permitted():
    for schema in (scene_schema(), schema_of("gearfe.runs")):
        for table in schema.values():
            for key in table.keys.values():
                assert key.text, f"{table.name}.{key.name}"
                if isinstance(key.default, (int, float, str)) and not isinstance(key.default, bool):
                    assert key.permits(key.default), f"{table.name}.{key.name}"


@pytest.mark.quick
def test_the_page_of_keys_is_current():
    page = (ROOT / "gearfe" / "docs" / "reference" / "keys.md").read_text(encoding="utf-8")
    made = keys_page(scene_schema(), schema_of("gearfe.runs"))
    assert page == made + "\n", "write it: python -m gearfe schema --page > gearfe/docs/reference/keys.md"


@pytest.mark.quick
def test_scenes_validate_by_the_json_schema(tmp_path):
    jsonschema = pytest.importorskip("jsonschema")
    judge = jsonschema.Draft7Validator(json.loads(json_schema(scene_schema())))
    judge.check_schema(judge.schema)
    for name in scene_names():
        judge.validate(tomllib.loads((resources.files("gearfe.scene.scenes") / f"{name}.toml").read_text(encoding="utf-8")))
    tables = tomllib.loads(gf.new_scene(tmp_path / "my.toml").read_text(encoding="utf-8"))
    judge.validate(tables)
    wrong = {"gear.pinion.z": 3, "gear.pinion.beta": 1.0, "gear.pinion.r_rim_mm": 50.0, "crack.cracked.start": "tip"}
    for key in set(wrong) - {"gear.pinion.beta"}:
        assert not judge.is_valid(set_values(tables, {key: wrong[key]})), key
    assert not judge.is_valid(tables | {"gears": {}})


def refused(tmp_path, capsys, text, *verb):
    path = tmp_path / "own.toml"
    path.write_text(text, encoding="utf-8")
    assert main([*verb, str(path)] if len(verb) == 1 else [verb[0], str(path), *verb[1:]]) == 1
    return capsys.readouterr().err


SPALL = '\n[[spall]]\ncase = "deep"\ngear = "wheel"\nradius_mm = 32.0\nz_mm = 1.5\nsides_mm = [3.0, 3.0]\ndepth_mm = 2.0\n'


def test_check_refuses_what_other_verbs_refuse(tmp_path, capsys):
    """A spall deeper than half the tooth, a machine whose pairs are missing or that has no such contact."""
    new = gf.new_scene(tmp_path / "my.toml").read_text(encoding="utf-8")
    checked = refused(tmp_path, capsys, new + SPALL, "check")
    assert "[pair.stage, deep]: spall of depth = 2 mm, but half the tooth of the 31-tooth gear" in checked
    assert "half the tooth of the 31-tooth gear" in refused(
        tmp_path, capsys, new + SPALL, "stiffness", "--case", "deep", "--phases", "1"
    )
    machine = '\n[machine]\nmodel = "{}"\nspeed_rpm = 100.0\ntorque_Nm = 40.0\n{}\n'
    for model, more, told in (
        ("planetary", "", "has no pair 'sun_planet'; it has stage"),
        ("compound_planetary", 'contact = "impact"', "the model 'compound_planetary' has linear contact only"),
        ("helical_pair", 'contact = "impact"\nimpact.friction = [0.1, 0.1]', "only the model 'planetary' has this key"),
    ):
        text = new + machine.format(model, more)
        assert told in refused(tmp_path, capsys, text, "check")
        assert told in refused(tmp_path, capsys, text, "dynamics")


def test_check_names_the_cases_that_a_machine_neglects(tmp_path, capsys):
    text = gf.new_scene(tmp_path / "my.toml").read_text(encoding="utf-8")
    crack = '\n[[crack]]\ncase = "other"\ngear = "pinion"\nlevel = 0.3\nbody = "planet2"\n'
    machine = '\n[machine]\nmodel = "helical_pair"\nspeed_rpm = 100.0\ntorque_Nm = 40.0\n'
    (tmp_path / "my.toml").write_text(text + crack + machine, encoding="utf-8")
    assert main(["check", str(tmp_path / "my.toml")]) == 0
    said = capsys.readouterr().out
    assert "case other is not in the machine: case 'other' damages body 'planet2' as pinion of pair stage" in said
    assert "case cracked is not in the machine" not in said


def test_schema_is_printed(capsys):
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out)["definitions"]["gear"]["properties"]["z"]["minimum"] == 5


def test_a_sweep_keeps_supports_and_takes_whole_numbers_of_steps(tmp_path):
    """Steps of a key of whole numbers are whole numbers, and a pair of a sweep stands on the supports of its scene."""
    path = gf.new_scene(tmp_path / "my.toml")
    with path.open("a", encoding="utf-8") as file:
        file.write('\n[support.soft]\ngear = "pinion"\nradial_N_per_um = 50.0\n')
    study = {"scene": str(path), "vary": {"gear.pinion.z": {"from": 19, "to": 21, "count": 3}}, "options": {"phases": 4}}
    from gearfe.runs.sweeps.blocks import blocks, rows

    checked = read_study(study)
    made = [row for block in blocks(checked)[0] for row in rows(checked, block)]
    assert [row["status"] for row in made] == ["done"] * 3, made
    own = gf.mesh_stiffness(load_scene(path).case(), phases=4).k.mean()
    assert made[-1]["k_mean"] == pytest.approx(own, rel=1e-12)
