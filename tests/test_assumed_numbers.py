"""What scenes say that their stiffness depends on is what the page of assumptions computed."""

import re

import pytest

import gearfe as gf
from validation.shared.places import TABLES
from validation.shared.table_rows import rows_of

SAID = [  # scene, pair, words with {} for a number of whole or tenths of percent, changes of the table
    ("planetary_pitting", "sun_planet", "{} % with bores 0.8 times, {} % with 1.4 times, {} % with half",
     ("bores 0.8 times", "bores 1.4 times", "bores halved")),
    ("planetary_pitting", "sun_planet", "mean k {} % at half, {} % at twice the force", ("force halved", "force doubled")),
    ("planetary_pitting", "planet_ring", "{} % with 0.1 m less", ("ring addendum 0.1 lower",)),
    ("planetary_pitting", "planet_ring", "{} % and {} % with one module more and less",
     ("rim one module thicker", "rim one module thinner")),
    ("planetary_pitting", "sun_planet", "mean k {} % with a tip radius of 0.25", ("rack tip radius 0.25",)),
    ("compound_planetary", "sun_planet", "{} % with bores 0.8 times, {} % with 1.4 times",
     ("bores 0.8 times", "bores 1.4 times")),
    ("compound_planetary", "sun_planet", "mean k {} % at half, {} % at twice the force", ("force halved", "force doubled")),
    ("compound_planetary", "planet_ring_1", "{} % with 0.1 m less", ("ring addendum 0.1 lower",)),
    ("compound_planetary", "sun_planet", "mean k {} % with a tip radius of 0.25", ("rack tip radius 0.25",)),
    ("helical_pitting", "pinion_wheel", "{} % with bores 0.8 times, {} % with 1.4 times", ("bores 0.8 times", "bores 1.4 times")),
    ("helical_pitting", "pinion_wheel", "mean k {} % at half, {} % at twice the force", ("force halved", "force doubled")),
    ("helical_pitting", "pinion_wheel", "mean k {} % with a tip radius of 0.25", ("rack tip radius 0.25",)),
    ("herringbone", "sun_planet", "{} % with bores 0.8 times, {} % with 1.4 times, {} % with half",
     ("bores 0.8 times", "bores 1.4 times", "bores halved")),
    ("herringbone", "sun_planet", "{} % at half, {} % at twice the force", ("force halved", "force doubled")),
    ("herringbone", "planet_ring", "{} % and {} % with one module more and less; addendum 0.1 m less {} %",
     ("rim one module thicker", "rim one module thinner", "ring addendum 0.1 lower")),
    ("herringbone", "sun_planet", "mean k {} % with a tip radius of 0.25", ("rack tip radius 0.25",)),
]  # fmt: skip
NUMBER = r"([-+]\d+(?:\.\d+)?)"


@pytest.mark.parametrize(("scene", "pair", "words", "changes"), SAID)
def test_what_a_scene_says_of_its_assumptions(scene, pair, words, changes):
    table = {(row["scene"], row["pair"], row["change"]): float(row["value"]) for row in rows_of(TABLES / "assumptions.csv")}
    told = " | ".join(one["depends"] for one in gf.load_scene(scene).assumptions)
    found = re.search(re.escape(words).replace(r"\{\}", NUMBER), told)
    assert found, f"{scene} does not say: {words}"
    for number, change in zip(found.groups(), changes, strict=True):
        digits = len(number.partition(".")[2])
        assert abs(float(number) - table[scene, pair, change]) <= 0.55 * 10.0**-digits, change
