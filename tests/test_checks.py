"""What functions of single gears and teeth are asked for: what cannot be is refused in one line, before any work."""

import math

import numpy as np
import pytest
from usual import STEEL

import gearfe as gf

GEAR = gf.Gear(z=18, m_n=2.0, alpha_n=math.radians(20), b=8.0, r_bore=8.0)
PAIR = gf.GearPair(GEAR, GEAR)
CRACK = gf.Crack(level=0.4)


def along_front(gear=GEAR, crack=CRACK, radius=18.0, line_load=100.0, material=STEEL, **options):
    return gf.stress_intensity_along_front(gear, crack, radius, line_load, material, refine=options.get("refine", 0.4))


def deck(path, gear=GEAR, radius=18.0, line_load=100.0, material=STEEL, **options):
    return gf.write_line_inp(path / "line.inp", gear, radius, line_load, material, **options)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"line_load": True}, "line_load = True"),
        ({"line_load": 1e30}, r"line_load = 1e\+30 N/mm, but under more than 2.07e\+04 N/mm \(E m_n / 20\)"),
        ({"line_load": lambda z: 1e30 * z}, r"line_load = 8e\+30 N/mm, but under more than"),
        ({"line_load": lambda z: z * math.nan}, "gives nan to nan"),
        ({"line_load": lambda z: -z}, "gives -0.0 to -8.0"),
        ({"line_load": lambda z: 0 * z}, "somewhere > 0"),
        ({"line_load": lambda z: "much"}, "loads are compressive"),
        ({"line_load": lambda z: np.ones(3)}, "function of an array of heights"),
        ({"line_load": lambda: 1.0}, "function of an array of heights"),
        ({"radius": "18"}, "radius = '18'"),
        ({"radius": None}, "radius = None"),
        ({"material": (STEEL, STEEL)}, "but give a Material"),
        ({"gear": PAIR}, "but give a Gear"),
        ({"refine": 1e9}, "give 0.2 to 64"),
        ({"refine": 1e-9}, "give 0.2 to 64"),
        ({"refine": True}, "refine = True"),
        ({"crack": gf.Crack(level=0.4, width=(0.0, 1e-6))}, "a width of 0.8 m_n"),
        ({"crack": gf.Crack(level=0.4, ends=(0.01, 0.01))}, "a depth of 0.15 and"),
        ({"crack": gf.Crack(level=0.4, ends=(1e-9, 1e-9))}, "too short to be meshed"),
    ],
)
def test_intensities_along_a_front(given, message):
    with pytest.raises(ValueError, match=message):
        along_front(**given)


@pytest.mark.parametrize(
    ("function", "more"),
    [
        (gf.root_stress, {}),
        (gf.root_stress_along_width, {"refine": 0.4}),
        (gf.stress_intensity, {"crack": CRACK}),
    ],
)
def test_one_tooth(function, more):
    run = {"gear": GEAR, "radius": 18.0, "line_load": 100.0, "material": STEEL} | more
    for change in ({"gear": PAIR}, {"material": 207e3}, {"radius": [18.0]}, {"line_load": "100"}, {"refine": math.inf}):
        with pytest.raises(ValueError, match=next(iter(change))):
            function(**(run | change))
    if not more.get("crack"):
        for width in (0, -1, math.nan, "narrow", True):
            with pytest.raises(ValueError, match="half_width"):
                function(half_width=width, **run)
    with pytest.raises(ValueError, match="but give a Gear"):
        gf.tooth_flexibility("gear", 18.0, STEEL)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"half_width": math.nan}, "half_width = nan"),
        ({"layer": "thin"}, "layer = 'thin'"),
        ({"layer": 1e-9}, "at least 0.0001 mm"),
        ({"refine": 0}, "refine = 0"),
        ({"cracks": CRACK}, "give a list, each entry a Crack"),
        ({"cracks": [3]}, "cracks = 3, but give a Crack"),
        ({"material": None}, "material = None"),
    ],
)
def test_line_decks(tmp_path, given, message):
    with pytest.raises(ValueError, match=message):
        deck(tmp_path, **given)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"gear": PAIR}, "but give a Gear"),
        ({"damage": CRACK}, "give a list, each entry a Crack, a Pit"),
        ({"damage": {"pinion": [CRACK]}}, "give a list, each entry a Crack, a Pit"),
        ({"damage": None}, "give a list, each entry a Crack, a Pit"),
        ({"teeth": 1.5}, "teeth = .*whole number"),
        ({"teeth": "3"}, "teeth = .*whole number"),
        ({"teeth": True}, "teeth = .*whole number"),
        ({"refine": 0}, "refine = 0"),
        ({"path": None}, "path = None"),
        ({"path": "no/such/folder.msh"}, "existing, writable folder"),
    ],
)
def test_meshes(tmp_path, monkeypatch, given, message):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=message):
        gf.export_mesh(**({"path": "gear.msh", "gear": GEAR} | given))


def test_root_stress_of_contact():
    contact = gf.contact_pattern(PAIR, 1000.0, STEEL, phases=[0.1])
    larger = gf.GearPair(gf.Gear(z=60, m_n=2.0, alpha_n=math.radians(20), b=8.0, r_bore=8.0), GEAR)
    for pair, found, index, material, options, message in (
        (PAIR, contact, "first", STEEL, {}, "index = 'first'"),
        (PAIR, contact, 0.5, STEEL, {}, "index = 0.5"),
        (PAIR, None, 0, STEEL, {}, "contact = None, but give a Contact3D"),
        (GEAR, contact, 0, STEEL, {}, "pair = Gear.*but give a GearPair"),
        (PAIR, contact, 0, (STEEL, STEEL), {}, "but give a Material"),
        (PAIR, contact, 0, STEEL, {"refine": 0}, "refine = 0"),
        (larger, contact, 0, STEEL, {}, "computed for this pair"),
    ):
        with pytest.raises(ValueError, match=message):
            gf.root_stress_of_contact(pair, found, index, material, **options)


@pytest.mark.parametrize("method", ["ritz", "ritz3d", "fe", "fe3d"])
def test_a_crack_too_short_for_any_mesh_says_so(method):
    with pytest.raises(ValueError, match=r"crack of level = 1e-06: .* too short to be meshed"):
        gf.mesh_stiffness(PAIR, force=1000.0, material=STEEL, method=method, phases=2, damage={"pinion": [gf.Crack(level=1e-6)]})
