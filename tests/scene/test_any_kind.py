"""Every table and key of a scene given as something else: a scene, or a ValueError that names the file, nothing else."""

import copy
import datetime
import functools
import math
import operator
import re
import tomllib
from functools import cache

import pytest
from any_place import judge, places, replaced
from gearboxes import PLANETARY, SHAFT, end

import gearfe as gf
from gearfe.geometry.pair import gear_pair
from gearfe.geometry.pair.interference import overlap
from gearfe.scene.load import scene_of
from gearfe.scene.schema import scene_schema

RACK = {"m_n_mm": 2.0, "alpha_n_deg": 20.0, "b_mm": 20.0, "material": "steel", "beta_deg": 0.0, "x": 0.0, "z_cutter": 20}
RACK |= {"E_sn_um": 0.0, "addendum": 1.0, "dedendum": 1.25, "rack_tip_radius": 0.2}
RELIEF = {"relief_um": 5.0, "start_roll_mm": 8.0, "exponent": 1.0}
WHOLE_SCENE = {  # every key of the vocabulary that can stand beside the others
    "title": "whole",
    "source": "own",
    "later": ["nothing"],
    "material": {"steel": {"E_MPa": 2.06e5, "nu": 0.3}},
    "gear": {
        "sun": {"z": 21, "r_bore_mm": 7.4, **RACK},
        "ring": {"z": 84, "r_rim_mm": 95.0, **RACK, "addendum": 0.86, "x": -0.4617},
    },
    "pair": {
        "stage": {
            "gear_1": "sun", "gear_2": "ring", "force_N": 2000.0, "a_mm": 62.0,
            "backlash_um": 200.0, "face": "spur", "groove_mm": 0.0,
            "F_beta_x_um": 5.0, "f_sigma_beta_um": 0.0, "f_sigma_delta_um": 0.0, "bearing_span_mm": 60.0,
        }
    },
    "flank": {
        "relieved": {
            "gear": "sun", "pair": "stage", **{f"tip_{key}": value for key, value in (RELIEF | {"start_roll_mm": 11.0}).items()},
            "root_relief_um": 0.0, "root_exponent": 1.0, "profile_crowning_um": 3.0, "helix_crowning_um": 3.0, "helix_slope_um":
            0.0, "twist_um": 0.0, "end_relief_um": [5.0, 5.0], "end_length_mm": [2.0, 2.0], "end_exponent": 2.0,
            "profile_slope_um": 0.0, "table_roll_mm": [0.0, 12.0], "table_removed_um": [0.0, 2.0], "pitch_um": [0.0, 1.0] * 10 +
            [0.0], "wear_roll_mm": [0.0, 12.0], "wear_um": [0.0, 2.0], "tip_rounding_mm": 0.0, "tip_chamfer_mm": 0.0,
            "tooth_scale": [1.0, 1.1] * 10 + [1.0], "eccentricity_um": 0.0, "eccentric_tooth": 0.0, "both_sides": False,
        }
    },
    "support": {
        "soft": {
            "gear": "ring", "pair": "stage", "radial_N_per_um": 500.0, "tilt_Nm_per_mrad": 50.0, "torsion_Nm_per_mrad": 50.0,
            "axial_N_per_um": 100.0, "coupling_urad_per_kN": 0.0,
        }
    },
    "shaft": {
        "thin": {
            "gear": "sun", "pair": "stage", "material": "steel", "lengths_mm": [40.0, 40.0], "diameters_mm": [12.0, 12.0],
            "bores_mm": [0.0, 2.0], "bearings_at_mm": [0.0, 80.0], "gear_at_mm": 30.0, "torque_at_mm": 80.0,
            "bearings_N_per_um": [200.0, 200.0], "integral": False,
        }
    },
    "crack": [
        {
            "case": "cracked", "gear": "sun", "level": 0.3, "angle_deg": 45.0, "start": "30deg", "turning": False, "tooth": 0,
            "body": "sun", "pair": "stage", "width_mm": [0.0, 10.0], "ends": [1.0, 1.0], "rounded": False,
        }
    ],
    "pits": [
        {
            "case": "pitted", "gear": "sun", "radius_mm": 20.8, "count": 2, "first_mm": 5.0, "last_mm": 15.0,
            "axes_mm": [1.0, 2.0], "depth_mm": 0.2, "angle_deg": 0.0, "tooth": 0, "pair": "stage",
        },
        {
            "case": "pitted", "gear": "sun", "radius_mm": 20.8, "count": 2, "along": "contact_line", "middle_mm": 10.0,
            "pitch_mm": 3.0, "mirrored": False, "both_halves": False, "axes_mm": [1.0, 2.0], "depth_mm": 0.2,
        },
    ],
    "missing_tooth": [{"case": "missing", "gear": "sun", "tooth": 3}],
    "chip": [{"case": "chipped", "gear": "sun", "tooth": 3, "pair": "stage", "depth_mm": 0.5, "radius_mm": 2.0}],
    "spall": [
        {
            "case": "spalled", "gear": "sun", "radius_mm": 20.8, "z_mm": 10.0, "sides_mm": [1.0, 4.0], "depth_mm": 0.2,
            "corner_mm": 0.3, "both_halves": False, "tooth": 0, "pair": "stage",
        }
    ],
    "machine": {
        "model": "herringbone_planetary", "speed_rpm": 1000.0, "torque_Nm": 100.0, "n_planets": 3, "contact": "linear",
        "backlash_um": 100.0, "profile_error_um": 0.0, "runout_um": 0.0, "misplaced_um": 0.0, "misplaced_y_um": 0.0,
        "impact": {
            "damping_Ns_per_mm": 1.0, "depth_mm": 0.1, "friction": [0.2, 0.1], "friction_speeds_mm_per_s": [0.1, 10.0],
            "pulse_Nm": 0.0, "pulse_period_s": 0.5, "pulse_width_s": 0.05,
        },
        "bodies": {name: {"mass_kg": 1.0, "inertia_kgm2": 1e-3} for name in scene_schema()["machine"].keys["bodies"].names},
    },
    "given": {"gear.sun.z": 21},
    "assumption": [{"what": "width", "why": "none given", "depends": "k", "holds": {"gear.sun.b_mm": 20.0}}],
    "reference": [
        {
            "id": "k", "kind": "model", "quantity": "stiffness", "unit": "N/m", "source": "own", "relative": 0.1,
            "tolerance": "own", "trend": False, "note": "", "reason": "", "correction": "", "set_by": "",
            "rows": [{"case": "healthy", "kind": "model", "pair": "stage", "printed": 3e8, "corrected": 3e8, "correction": "unit",
                      "reason": ""}],
        }
    ],
}  # fmt: skip
TRAIN = ("shaft", "bearing", "motor", "load", "coupling", "stage", "machine", "sensor")  # tables of a gearbox
WHOLE_GEARBOX = PLANETARY | {  # every key of these that stands in no other scene
    "shaft": {
        name: SHAFT | row | {
            "bearings_at_mm": [0.0, 80.0], "bearings": ["needle", "needle"], "bearings_axial_N_per_um": [100.0, 0.0],
            "gears_turned_deg": [0.0] * len(row["gears"]),
        }
        for name, row in PLANETARY["shaft"].items()
    },
    "sensor": {
        "box": {"channels": ["spring bearing one2 x"], "weights": [1.0],
                "modes_Hz": [800.0], "modes_ratio": [0.05], "modes_kg": [4.0]},
        "plate": {"channels": ["spring bearing one2 x"], "frf_Hz": [0.0, 1.0], "frf_real": [0.0, 1.0], "frf_imag": [0.0, 0.0],
                  "frf_unit": "g"},
        "ring": {"housing": "inner", "angle_deg": 30.0},
    },
    "load": {"brake": end("out", at_mm=120.0, slope_Nms_per_rad=0.1), "pump": end("two", torque_Nm=5.0)},
    "stage": {"set": PLANETARY["stage"]["set"] | {"carrier_mass_kg": 1.0, "pin_N_per_um": 100.0, "pin_axial_N_per_um": 10.0,
                                                  "pin_tilt_Nm_per_mrad": 1.0}},
    "machine": PLANETARY["machine"] | {"dofs": "six", "density_kg_per_m3": 7800.0, "damping_per_stiffness_s": 1e-6},
}  # fmt: skip
ELSE = [
    3, -1, 0, 10**9, 10**5000, -(10**30), 1e300, math.nan, -math.inf, True, "", "21", "sun", [], [1], [[]], ["x"], [True, False],
    [1e300, 10**400], [math.nan, 1.0], {}, [{}], {"x": 1}, {"x": {}}, [{"x": [1]}], datetime.date(1979, 5, 27),
]  # fmt: skip


def vocabulary():
    """Every key of every table but those of a planetary set, and the file of a sensor, whose columns replace it."""
    of_sets = ("set", "ring", "ring_support", "pin", "frf")
    return {key for name, table in scene_schema().items() if name not in of_sets for key in table.keys} - {*of_sets}


def test_the_whole_scene_has_every_key():
    """Those left out exclude another, and stand in `ALSO`."""
    scene = scene_of("whole.toml", copy.deepcopy(WHOLE_SCENE))
    assert set(scene.pair().damage) == {"chipped", "cracked", "missing", "pitted", "spalled"}
    scene_of("gearbox.toml", copy.deepcopy(WHOLE_GEARBOX))
    keys = {part for whole in (WHOLE_SCENE, WHOLE_GEARBOX) for path in places(whole) for part in path if isinstance(part, str)}
    assert vocabulary() - keys == {path[-1] for path, _ in ALSO}


START = ("flank", "relieved")
ALSO = [  # keys that exclude one of the whole scene, with what goes for them
    *[((*START, f"{end}_start_{how}"), (*START, f"{end}_start_roll_mm")) for end in ("tip", "root")
      for how in ("diameter_mm", "angle_deg", "length_mm")],
    ((*START, "root_start_roll_mm"), ()),
    (("gear", "sun", "x_E"), ("gear", "sun", "E_sn_um")),
    (("crack", 0, "length_mm"), ("crack", 0, "level")),
    (("crack", 0, "path_mm"), ("crack", 0, "level")),
    (("pits", 1, "span_mm"), ("pits", 1, "pitch_mm")),
    (("reference", 0, "absolute"), ("reference", 0, "relative")),
    (("reference", 0, "rows", 0, "claim"), ("reference", 0, "rows", 0, "printed")),
]  # fmt: skip


def without(tables, path):
    home = tables
    for part in path[:-1]:
        home[part] = copy.copy(home[part])
        home = home[part]
    if path:
        home.pop(path[-1], None)
    return tables


def attempts():
    for turn, path in enumerate(places(WHOLE_SCENE)):
        for value in ELSE[turn % 4 :: 4]:  # keys of a kind are many, so that each kind is given all of them
            yield path, value, replaced(WHOLE_SCENE, path, value)
    for turn, path in enumerate(path for path in places(WHOLE_GEARBOX) if path[0] in TRAIN):
        for value in ELSE[turn % 4 :: 4]:
            yield path, value, replaced(WHOLE_GEARBOX, path, value)
    for path, instead in ALSO:
        for value in ELSE:
            yield path, value, without(replaced(WHOLE_SCENE, path, value), instead)
            yield path, value, replaced(WHOLE_SCENE, path, value)


WORDS = [  # of a scene file, what is said of it
    ("[[flank]]\ngear = 'sun'", r"\[\[flank\]\] is a list of tables, but they have names: write \[flank.NAME\]"),
    ("[[support]]\ngear = 'sun'", r"write \[support.NAME\]"),
    ("[[gear]]\nz = 21", r"write \[gear.NAME\]"),
    ("flank = 3", r"flank = 3, but give tables with names: \[flank.NAME\]"),
    ("flank.x = 3", r"\[flank.x\]: expected a table of keys and values, got 3"),
    ("[crack]\ncase = 'x'", r"\[crack\] is one table, but there may be several: write \[\[crack\]\]"),
    ("pits = 3", r"pits = 3, but give a list of tables: \[\[pits\]\]"),
    ("[reference]\nid = 'x'", r"write \[\[reference\]\]"),
    ("assumption = 'steel'", r"assumption = 'steel', but give a list of tables"),
    (
        "[machine]\nmodel = 'planetary'\nspeed_rpm = 0\ntorque_Nm = 3",
        r"speed_rpm = 0, but it must lie between 0.001 and 1e\+06 rpm",
    ),
    ("[machine]\nmodel = 'planetary'\nspeed_rpm = 1\ntorque_Nm = 3\nbodies = []", r"write \[machine.bodies.NAME\]"),
]


@pytest.mark.parametrize(("text", "message"), WORDS, ids=[text[:20] for text, _ in WORDS])
def test_what_is_said_of_a_wrong_table(text, message):
    with pytest.raises(ValueError, match=f"own.toml.*{message}"):
        scene_of("own.toml", copy.deepcopy(WHOLE_SCENE) | tomllib.loads(text))


@pytest.mark.parametrize("text", [f"a = {'9' * 5000}", f"a = {'[' * 5000}", 'a = "\\ud800"', 'a = "\x00"'])
def test_what_no_parser_reads(tmp_path, text):
    """More digits than Python reads, lists in lists, half a character."""
    path = tmp_path / "own.toml"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"own.toml: not readable as TOML"):
        gf.load_scene(path)


@pytest.mark.slow
def test_any_place_of_a_scene_given_as_anything(monkeypatch):
    cut = cache(lambda pair, *nominals: overlap(pair, nominals))  # most attempts leave the teeth as they are
    monkeypatch.setattr(gear_pair, "overlap", lambda pair, nominals: cut(pair, *nominals))
    before = copy.deepcopy((WHOLE_SCENE, WHOLE_GEARBOX))
    judge(attempts(), lambda tables: scene_of("whole.toml", tables), "whole.toml")
    assert before == (WHOLE_SCENE, WHOLE_GEARBOX), "what is read is not changed"


NUMBERED = sorted({"gear", "pair", "flank", "support", "crack", "pits", "spall", "chip", *TRAIN})
TYPED = (1e20, 1e4, 300.0, 40, 1e-5, -7.0)


def numbers_of(whole, tables):
    """Paths to the numbers of these tables of a whole scene."""
    return [
        path
        for path in places(whole)
        if path[0] in tables and type(functools.reduce(operator.getitem, path, whole)) in (int, float)
    ]


def named_keys(text, key):
    """Keys that a message states as typed: this `key`, and those of the table where it does not fit."""
    where = re.search(r"\[(\w+)", text)[1]
    keys = {key, *scene_schema()[where].keys} - ({"z", "x"} - {key})
    return {one for one in keys if re.search(rf"(?<![\w.]){one}(?![\w.])", text)}


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.slow
@pytest.mark.parametrize("table", NUMBERED)
def test_messages_on_numbers_name_the_key_as_typed(table):
    """The key that was changed, or the key of the table where it does not fit (a bore that a smaller module has no room for)."""
    whole = WHOLE_SCENE if table in WHOLE_SCENE else WHOLE_GEARBOX
    attempts = [(path, value, replaced(whole, path, value)) for path in numbers_of(whole, (table,)) for value in TYPED]
    for path, instead in ALSO:
        for value in TYPED if path[0] == table else ():
            given = [value, value, 2 * value, 2 * value] if path[-1] == "path_mm" else value
            attempts.append((path, given, without(replaced(WHOLE_SCENE, path, given), instead)))
    wrong, refused = [], 0
    for path, value, tables in attempts:
        key = next(part for part in reversed(path) if isinstance(part, str))
        try:
            scene_of("whole.toml", tables)
        except ValueError as error:
            refused += 1
            if not named_keys(str(error), key) or "np.float" in str(error):
                wrong.append(f"{path} = {value}: {error}")
    assert refused, table
    assert not wrong, "\n".join(wrong)
