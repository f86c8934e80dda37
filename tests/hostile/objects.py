"""Objects that arguments of public functions are, each made once."""

import math
from functools import cache
from pathlib import Path

import numpy as np
from comparison.test_machine_fit import TRAIN
from planetary_sets.sets import STEEL, gears
from planetary_sets.sets import case as set_case

import gearfe as gf
from gearfe.scene.toml_file import toml

PLACE = Path("hostile")  # folder of the files that functions write
STUDY = {
    "scene": "planetary_pitting",
    "pair": "sun_planet",
    "options": {"method": "textbook", "phases": 4},
    "vary": {"gear.sun.r_bore_mm": [6.0, 6.5]},
}


def file(name):
    PLACE.mkdir(exist_ok=True)
    return str(PLACE / name)


def written(name, text):
    Path(file(name)).write_text(text, encoding="utf-8")
    return file(name)


@cache
def pair():
    return gears().sun_planet


@cache
def helical():
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0, "beta": math.radians(15)}
    return gf.GearPair(gf.Gear(21, r_bore=7.4, **rack), gf.Gear(31, r_bore=11.4, **rack))


@cache
def curve():
    return gf.mesh_stiffness(pair(), 2000.0, STEEL, method="textbook", phases=16)


@cache
def law():
    return gf.force_law(pair(), [500.0, 1000.0, 2000.0], STEEL, method="textbook", phases=16)


@cache
def machine():
    return gf.single_mesh(1.0, curve(), 500.0, force=10.0)


@cache
def stage():
    return gf.pitted_planetary(gears(), {"sun_planet": 3e8, "planet_ring": 4e8})


@cache
def response():
    return gf.simulate(stage(), 0.02, rate=2e4)


@cache
def signal():
    time = np.arange(4096) / 4096
    values = np.sin(2 * np.pi * 200 * time) * (1 + 0.2 * np.sin(2 * np.pi * 10 * time))
    return gf.Signal(values + 0.01 * np.random.default_rng(0).normal(size=4096), 4096.0, "m/s^2", shaft_frequency=10.0)


@cache
def average():
    return gf.synchronous_average(signal(), 512)[0]


@cache
def contact():
    return gf.contact_pattern(helical(), 2000.0, STEEL, phases=2)


@cache
def set_curves():
    return gf.planetary_stiffness(set_case(), 2, refine=0.4, error=False)


@cache
def scene(name="planetary_pitting"):
    return gf.load_scene(name)


@cache
def runs():
    return gf.sweep(STUDY, file("runs"), workers=1)


@cache
def rexs():
    gf.write_rexs(file("own.rexs"), scene())
    return file("own.rexs")


@cache
def meshes():
    return gf.export_mesh(file("parts.msh"), pair().gear_1, refine=0.4)


@cache
def train():
    return written("train.toml", toml(TRAIN))


@cache
def healthy_record():
    response = gf.simulate(gf.build_machine(gf.load_scene(train())), 0.2, rate=12800.0)
    return response.signal("a.theta acceleration")
