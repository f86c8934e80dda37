"""[support.NAME] and [shaft.NAME] tables of a scene, and the newer keys of [flank.NAME]: units, places, mistakes."""

from dataclasses import replace

import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf

SCENE = """
title = "A pair on shafts"
source = "none"
[material.steel]
E_MPa = 207000
nu = 0.3
[gear.pinion]
z = 24
m_n_mm = 3.0
alpha_n_deg = 20
b_mm = 15
r_bore_mm = 15
material = "steel"
[gear.wheel]
z = 30
m_n_mm = 3.0
alpha_n_deg = 20
b_mm = 15
r_bore_mm = 18
material = "steel"
[pair.main]
gear_1 = "pinion"
gear_2 = "wheel"
force_N = 2000
"""
HELD = """
[shaft.drive]
gear = "pinion"
material = "steel"
lengths_mm = [50, 30]
diameters_mm = [30, 25]
bearings_at_mm = [0, 50]
gear_at_mm = 70
torque_at_mm = 0
bearings_N_per_um = [200, 400]
[support.output]
gear = "wheel"
radial_N_per_um = 150
tilt_Nm_per_mrad = 20
torsion_Nm_per_mrad = 300
coupling_urad_per_kN = 3
"""


def loaded(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE + text)
    return gf.load_scene(path)


def test_units_are_those_of_the_keys(tmp_path):
    chosen = loaded(tmp_path, HELD).pair()
    segments, stiff = [(50, 30), (30, 25)], (2e5, 4e5)
    shaft = gf.Shaft(segments=segments, bearings=(0, 50), gear=70, material=STEEL, torque=0, bearing_stiffness=stiff)
    assert chosen.case().supports == {
        "pinion": shaft,
        "wheel": gf.Support(radial=1.5e5, tilt=2e7, torsion=3e8, coupling=3e-9),
    }
    assert chosen.case().why_wide
    bored = loaded(tmp_path, HELD.replace("gear_at", "bores_mm = [8, 8]\ngear_at")).pair().supports["pinion"]
    assert bored.segments[1].bore == 8
    assert loaded(tmp_path, HELD.replace("gear_at", "integral = true\ngear_at")).pair().supports["pinion"].integral


def test_a_comparison_says_what_a_section_leaves_out(tmp_path):
    scene = loaded(tmp_path, HELD.replace("coupling_urad_per_kN = 3", ""))
    from gearfe.stiffness.methods import fitted

    case, _, left_out = fitted("ritz", scene.case())
    assert "do not tilt" in left_out[0]
    found, plain = (gf.mesh_stiffness(one, method="ritz", phases=4) for one in (case, replace(case, supports=None)))
    springs = [held.support() if isinstance(held, gf.Shaft) else held for held in scene.pair().supports.values()]
    way = [
        1e-3 * (1 / held.radial + gear.r_b**2 / held.torsion) for held, gear in zip(springs, scene.gears.values(), strict=True)
    ]
    assert_allclose(1 / found.k - 1 / plain.k, sum(way), rtol=1e-9)
    assert fitted("ritz3d", scene.case())[2] == ()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[support.a]\ngear = 'wheel'\npair = 'x'\n", r"\[support.a\] pair = 'x': no such pair"),
        (
            HELD + "[support.b]\ngear = 'wheel'\n",
            r"\[support.b\]: gear 'wheel' has two tables \(support or shaft\) in pair 'main'; give each of them the key pair",
        ),
        (
            HELD.replace("gear_at_mm = 70", "gear_at_mm = 90"),
            r"\[shaft.drive\]: shaft: gear_at_mm = 90, but the shaft reaches from 0 to 80",
        ),
        (HELD.replace("[30, 25]", "[30]"), r"\[shaft.drive\]: shaft of 2 lengths: give as many diameters_mm"),
    ],
)
def test_mistakes_are_explained(tmp_path, text, message):
    with pytest.raises(ValueError, match=message):
        loaded(tmp_path, text)


def test_newer_keys_of_flanks(tmp_path):
    flank = """
[flank.a]
gear = "pinion"
tip_rounding_mm = 0.2
eccentricity_um = 8
eccentric_tooth = 2.5
tooth_scale = [1.0, 1.1]
wear_roll_mm = [8, 10, 12]
wear_um = [0, 5, 0]
"""
    with pytest.raises(ValueError, match=r"\[flank.a\]: tooth_scale = \(1\.0, 1\.1\): 2 values, but z = 24"):
        loaded(tmp_path, flank)
    found = loaded(tmp_path, flank.replace("tooth_scale = [1.0, 1.1]", "")).pair().flanks["pinion"]
    assert found == gf.Flank(tip_rounding=0.2, eccentricity=0.008, eccentric_tooth=2.5, wear=([8, 10, 12], [0, 0.005, 0]))
    assert loaded(tmp_path, "[flank.a]\ngear = 'wheel'\ntip_chamfer_mm = 0.3\n").pair().flanks["wheel"].tip_chamfer == 0.3
    with pytest.raises(ValueError, match="give wear_roll_mm and wear_um together"):
        loaded(tmp_path, "[flank.a]\ngear = 'wheel'\nwear_um = [1, 2]\n")


def test_the_softest_springs_that_a_scene_can_state_are_a_support():
    """The product of their stiffnesses is smaller than any number: it is not divided by."""
    assert not gf.Support(radial=2.2e-13, tilt=5e-324).tilts
    with pytest.raises(ValueError, match="the stiffness matrix is not positive definite"):
        gf.Support(radial=2e5, tilt=2e7, coupling=1e-3)
