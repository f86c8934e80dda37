"""Every table and key of a study given as something else: a study, or a ValueError that names it, nothing else."""

import copy
import datetime
import math

from any_place import judge, places, replaced

from gearfe.runs.sweeps import study
from gearfe.runs.sweeps.study import read_study, values
from gearfe.scene.load import scene_of

STEPS = {"from": 1000, "to": 2000, "count": 3, "spacing": "log", "also": ["pair.planet_sun.force_N"]}
STUDY = {
    "title": "all",
    "scene": "",
    "kind": "stiffness",
    "pair": "sun_planet",
    "case": "cracked",
    "seed": 1,
    "block": 5,
    "options": {"method": "coupled", "phases": 4, "span": "cycle", "error": False, "refine": 1.0, "order": 4, "pose": "mean"},
    "crack": [{"case": "cracked", "gear": "sun", "level": 0.2}],
    "flank": {"bent": {"gear": "sun", "profile_crowning_um": 3.0}},
    "vary": {
        "crack.cracked.level": [0.1, 0.2],
        "pair": {"sun_planet": {"force_N": STEPS}},
    },
    "along": [{"gear.sun.r_bore_mm": [7.0, 7.4], "gear.planet.r_bore_mm": [11.0, 11.4]}],
    "sample": {
        "method": "sobol",
        "count": 4,
        "of": {
            "gear.sun.x": {"normal": [0.0, 0.01], "within": [-0.03, 0.03]},
            "gear.planet.x": {"lognormal": [0.1, 0.02]},
            "gear.sun.b_mm": {"uniform": [19.0, 21.0], "within": [19.5, 20.0], "also": ["gear.planet.b_mm"]},
            "material.steel.nu": {"triangular": [0.28, 0.3, 0.31]},
            "gear.sun.z_cutter": {"choice": [20, 30]},
        },
        "correlated": [{"between": ["gear.sun.x", "gear.sun.b_mm"], "value": -0.6}],
    },
}  # fmt: skip
GEAR = "m_n_mm = 2.0\nalpha_n_deg = 20.0\nb_mm = 20.0\nmaterial = 'steel'"
SCENE = f"""\
title = "small"
source = "own"
material.steel = {{ E_MPa = 2.06e5, nu = 0.3 }}
[gear.sun]
z = 21
r_bore_mm = 7.4
{GEAR}
[gear.planet]
z = 31
r_bore_mm = 11.4
{GEAR}
[pair.sun_planet]
gear_1 = "sun"
gear_2 = "planet"
force_N = 2000.0
[pair.planet_sun]
gear_1 = "planet"
gear_2 = "sun"
force_N = 2000.0
"""
ELSE = [
    -1, 10**9, 10**400, math.nan, True, "gear.sun.z", [], [1], [[]], ["x"], [{}], [math.nan, 1.0], [2.0, 1.0], {}, {"x": {}},
    {"uniform": [1, 2], "also": 5}, {"from": 1, "to": 2, "count": 10**12}, datetime.date(1979, 5, 27),
]  # fmt: skip


def test_any_place_of_a_study_given_as_anything(tmp_path, monkeypatch):
    path = tmp_path / "own.toml"
    path.write_text(SCENE)
    monkeypatch.setitem(STUDY, "scene", str(path))
    sound = set()  # scenes that were read before: their gears take most of the time

    def read(file, tables):
        if repr(tables) not in sound:
            scene_of(file, tables)
            sound.add(repr(tables))

    monkeypatch.setattr(study, "scene_of", read)
    assert len(values(read_study(copy.deepcopy(STUDY)))[1]) == 2 * 3 * 2 * 4
    attempts = (
        (path, value, replaced(STUDY, path, value)) for turn, path in enumerate(places(STUDY)) for value in ELSE[turn % 2 :: 2]
    )
    judge(attempts, lambda tables: values(read_study(tables)), ("study", "no scene", "own.toml"))
