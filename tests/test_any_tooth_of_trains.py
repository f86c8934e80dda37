"""Every verb of a planetary or compound train with damage of a body and a tooth by chance: the result shows it and names it."""

import copy
import random
import re

import numpy as np
import pytest

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.simulated import responses
from gearfe.planetary_sets.of_scene import build_set
from gearfe.runs.sweeps.kinds import KINDS
from gearfe.scene.load import read_tables, scene_of
from gearfe.scene.toml_file import toml

CHANCE = random.Random(45)
ROWS = {  # by scene: rows without the tooth, the body in words, meshes of the body
    "planetary_pitting": [
        ({"gear": "sun"}, "the sun", ("sun_planet1", "sun_planet2", "sun_planet3")),
        *(({"gear": "planet", "body": f"planet{k}"}, f"planet{k}", (f"sun_planet{k}", f"planet_ring{k}")) for k in (1, 2, 3)),
        ({"gear": "ring"}, "the ring", ("planet_ring1", "planet_ring2", "planet_ring3")),
        ({"gear": "planet", "pair": "planet_ring"}, "planet1", ("planet_ring1",)),
    ],
    "compound_planetary": [
        ({"gear": "sun", "body": "sun1"}, "sun1", ("sun1_p1", "sun1_p2", "sun1_p3")),
        ({"gear": "sun"}, "sun2", ("sun2_b1", "sun2_b2", "sun2_b3")),
        ({"gear": "planet", "body": "b3"}, "b3", ("sun2_b3", "b3_c3")),
        ({"gear": "planet", "body": "c2", "pair": "planet_ring_2"}, "c2", ("c2_ring",)),
        ({"gear": "planet", "body": "p3", "pair": "planet_ring_1"}, "p3", ("p3_ring",)),
        ({"gear": "ring_2"}, "the ring", ("c1_ring", "c2_ring", "c3_ring")),
    ],
}
DAMAGE = {"crack": {"level": 0.4, "angle_deg": 60.0}, "missing_tooth": {}, "chip": {"depth_mm": 0.8, "angle_deg": 60.0}}
TRAINS = [(name, *row, CHANCE.randrange(1, 20), CHANCE.choice(list(DAMAGE))) for name, rows in ROWS.items() for row in rows]
TRAINS = [train if "pair" not in train[1] else (*train[:-1], "crack") for train in TRAINS]  # a missing tooth has no flank


def scene_tables(name, row, tooth, kind):
    """Tables of a built-in scene with one damage as its only case, and contacts that open."""
    left = ("assumption", "given", "reference", "set", *("crack", "pits", "spall", "missing_tooth", "chip"))
    given = copy.deepcopy({key: value for key, value in read_tables(name)[1].items() if key not in left})
    given["machine"] |= {"contact": "linear", "backlash_um": 200.0}
    return given | {kind: [{"case": "x", "tooth": tooth} | row | DAMAGE[kind]]}


def _with_flank(**flank):
    """Tables of a planetary set with a flank of the planet."""
    tables = copy.deepcopy(
        {
            key: value
            for key, value in read_tables("planetary_pitting")[1].items()
            if key not in ("assumption", "given", "reference", "set")
        }
    )
    return tables | {"flank": {"own": {"gear": "planet"} | flank}}


PITCH = [0.0] * 4 + [15.0] + [0.0] * 26


def test_a_pitch_deviation_of_one_planet_is_in_its_two_meshes_only():
    """They have the curve that all planets have if the table names no body. The healthy stiffness is the same."""
    every, one, healthy = (
        gf.build_machine(scene_of("x.toml", tables), phases=8, method="ritz")
        for tables in (_with_flank(pitch_um=PITCH), _with_flank(pitch_um=PITCH, body="planet2"), _with_flank())
    )
    assert [(fault.gear, fault.tooth) for fault in one.faults] == [("planet2", 4)]
    assert {fault.gear for fault in every.faults} == {"planet1", "planet2", "planet3"}
    for mine, all_alike, plain in zip(one.meshes, every.meshes, healthy.meshes, strict=True):
        assert len(mine.damage) == mine.name.endswith("2")
        assert len(all_alike.damage) == 1
        np.testing.assert_allclose(mine.cycle.mean, plain.cycle.mean, rtol=1e-4)
        for own, wanted in zip(mine.damage, all_alike.damage, strict=False):
            np.testing.assert_allclose(own.curve.k, wanted.curve.k, rtol=1e-9)
            np.testing.assert_allclose(own.curve.unloaded, wanted.curve.unloaded, atol=1e-12)


WRONG = [
    ({"body": "planet9", "pitch_um": PITCH}, r"body = 'planet9' as wheel of pair sun_planet, but .* planet1, planet2, planet3"),
    ({"body": "planet2", "tip_relief_um": 20.0, "tip_start_length_mm": 1.0}, "has another profile than the other bodies"),
]


@pytest.mark.parametrize(("flank", "message"), WRONG)
def test_flanks_of_one_body_that_a_machine_does_not_model_are_rejected(flank, message):
    with pytest.raises(ValueError, match=message):
        gf.build_machine(scene_of("x.toml", _with_flank(**flank)), phases=8, method="ritz")


def test_a_set_has_the_flanks_of_each_planet():
    tables = _with_flank(body="planet2", tip_relief_um=20.0, tip_start_length_mm=1.0) | {"set": {"n_planets": 3}}
    tables["flank"]["rest"] = {"gear": "planet", "profile_crowning_um": 4.0}
    found = build_set(scene_of("x.toml", tables)).flanks
    assert {name: (flank.tip_relief, flank.profile_crowning) for name, flank in found.items()} == {
        "planet1": (0.0, 0.004), "planet2": (0.02, 0.0), "planet3": (0.0, 0.004)
    }  # fmt: skip
    tables["flank"]["own"]["body"] = "planet7"
    with pytest.raises(ValueError, match=r"\[flank\] body = 'planet7', but the planet of the set is planet1, planet2, planet3"):
        build_set(scene_of("x.toml", tables))


def test_a_pair_tells_which_body_it_has():
    tables = _with_flank(body="planet2", profile_crowning_um=2.0)
    tables["flank"]["rest"] = {"gear": "planet", "profile_crowning_um": 4.0}
    with pytest.warns(UserWarning, match="the wheel has the flanks of planet2, and not those of the other bodies"):
        case = scene_of("x.toml", tables).case("sun_planet")
    assert case.flanks["wheel"].profile_crowning == 0.002


@pytest.mark.slow
@pytest.mark.parametrize(("name", "row", "body", "meshes", "tooth", "kind"), TRAINS)
def test_machine_sweep_and_record_show_the_tooth(name, row, body, meshes, tooth, kind):
    scene = scene_of(f"{name}.toml", scene_tables(name, row, tooth, kind))
    machine = gf.build_machine(scene, "x", phases=8, method="ritz")
    assert [(fault.gear, fault.tooth) for fault in machine.faults] == [(body.removeprefix("the "), tooth)]
    assert tuple(mesh.name for mesh in machine.meshes if mesh.changes) == meshes
    found = responses(scene, "x", duration=0.3, phases=8)
    forces = {mesh: [np.asarray(record[f"force {mesh}"]) for record in found.values()] for mesh in meshes}
    assert all(abs(hurt - healthy).max() > 1e-3 * np.ptp(healthy) for healthy, hurt in forces.values())
    options = {"phases": 8, "curves": "ritz", "duration_s": 1.0, "rate_Hz": 8000.0, "method": "fast",
               "channel": f"force {meshes[0]}", "signal": False}  # fmt: skip
    before, after = (KINDS["vibration"].work(scene, case, options)[0]["peak"] for case in (None, "x"))
    assert abs(after / before - 1) > 1e-5


@pytest.mark.slow
@pytest.mark.parametrize(("name", "row", "body", "meshes", "tooth", "kind"), TRAINS[2::5])
def test_dynamics_and_report_name_the_tooth(tmp_path, capsys, name, row, body, meshes, tooth, kind):
    path = tmp_path / "train.toml"
    path.write_text(toml(scene_tables(name, row, tooth, kind)), encoding="utf-8")
    assert main(["dynamics", str(path), "--case", "x", "--duration", "0.7"]) == 0
    assert f"tooth {tooth} of {body}: " in capsys.readouterr().out
    assert main(["report", str(path), "--case", "x", "--duration", "0.7", "-o", str(tmp_path / "page.html")]) == 0
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert re.search(rf"tooth {tooth} of the (pinion|wheel): [^:]* Hz, {body.removeprefix('the ')}\)", page)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "row", "body", "meshes", "tooth", "kind"), TRAINS[::3])
def test_labels_of_data_sets_name_the_tooth(tmp_path, name, row, body, meshes, tooth, kind):
    path = tmp_path / "train.toml"
    path.write_text(toml(scene_tables(name, row, tooth, kind)), encoding="utf-8")
    severity = {"crack": [0.4], "chip": [0.8]}.get(kind)
    fault = {"kind": kind, "tooth": tooth} | row | ({"severity": severity} if severity else {})
    plan = {
        "title": "one tooth", "scene": str(path), "seed": 3, "repeats": 2,
        "window": {"seconds": 0.3, "count": 1, "rate_Hz": 4000.0, "harmonics": 3},
        "operation": {"speed_rpm": [1000.0], "torque_Nm": [100.0]}, "fault": [fault],
        "sensor": [{"name": "force", "channel": f"force {meshes[0]}", "noise": [0.0]}],
        "split": {"train": 0.5, "validation": 0.0, "test": 0.5},
    }  # fmt: skip
    labels = gf.dataset(plan, tmp_path / "set", workers=1).labels({"fault": kind})
    assert set(zip(labels["body"], labels["tooth"], strict=True)) == {(body.removeprefix("the "), tooth)}
    assert (labels["loss_max"] > 1e-3).all()
