"""Every verb of a planetary or compound train with damage of a body and a tooth by chance: the result shows it and names it."""

import copy
import random
import re

import numpy as np
import pytest

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.simulated import responses
from gearfe.runs.sweeps.kinds import KINDS
from gearfe.scene.load import read_tables, scene_of
from gearfe.scene.toml_file import toml

CHANCE = random.Random(45)
ROWS = {  # by scene: rows without the tooth, the body in words, meshes of the body
    "planetary_pitting": [
        ({"gear": "sun"}, "the sun", ("sun_planet1", "sun_planet2", "sun_planet3")),
        *(({"gear": "planet", "body": f"planet{k}"}, f"planet{k}", (f"sun_planet{k}", f"planet_ring{k}")) for k in (1, 2, 3)),
        ({"gear": "ring"}, "the ring", ("planet_ring1", "planet_ring2", "planet_ring3")),
    ],
    "compound_planetary": [
        ({"gear": "sun", "body": "sun1"}, "sun1", ("sun1_p1", "sun1_p2", "sun1_p3")),
        ({"gear": "sun"}, "sun2", ("sun2_b1", "sun2_b2", "sun2_b3")),
        ({"gear": "planet", "body": "b3"}, "b3", ("sun2_b3", "b3_c3")),
        ({"gear": "planet", "body": "c2", "pair": "planet_ring_2"}, "c2", ("c2_ring",)),
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
    options = {"phases": 8, "curves": "ritz", "duration_s": 0.6, "rate_Hz": 8000.0, "method": "fast",
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
