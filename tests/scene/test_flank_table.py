"""[flank.NAME] tables of a scene: units, places, mistakes."""

import math

import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli.arguments import main

SCENE = """
title = "A pair with tip relief"
source = "none"
[material.steel]
E_MPa = 207000
nu = 0.3
[gear.pinion]
z = 24
m_n_mm = 3.0
alpha_n_deg = 20
b_mm = 20
r_bore_mm = 15
material = "steel"
[gear.wheel]
z = 36
m_n_mm = 3.0
alpha_n_deg = 20
b_mm = 20
r_bore_mm = 20
material = "steel"
[pair.main]
gear_1 = "pinion"
gear_2 = "wheel"
force_N = 3000
"""
RELIEF = """
[flank.short]
gear = "pinion"
tip_relief_um = 10
tip_start_angle_deg = 24
tip_exponent = 2
"""


def loaded(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE + text)
    return gf.load_scene(path), path


def test_units_are_those_of_the_keys(tmp_path):
    scene, _ = loaded(tmp_path, RELIEF + "\n[flank.wheel]\ngear = 'wheel'\nprofile_crowning_um = 4\nprofile_slope_um = -2\n")
    case = scene.pair().case()
    assert case.flanks == {
        "pinion": gf.Flank(tip_relief=0.010, tip_start_angle=math.radians(24), tip_exponent=2),
        "wheel": gf.Flank(profile_crowning=0.004, profile_slope=-0.002),
    }
    curve = gf.mesh_stiffness(case, phases=8)
    found = gf.transmission_error(case.pair, [3000.0], case.material, flanks=case.flanks, phases=8)
    assert_allclose(curve.te, found.te[0])


WIDE = """
[flank.wide]
gear = "pinion"
helix_crowning_um = 5
helix_slope_um = -3
twist_um = 2
end_relief_um = [4, 8]
end_length_mm = [2, 3]
"""


def test_keys_along_the_width_and_misalignment(tmp_path):
    askew = "F_beta_x_um = 12\nf_sigma_beta_um = 6\nbearing_span_mm = 90\n"
    scene, _ = loaded(tmp_path, askew + WIDE)
    case = scene.pair().case()
    assert case.misalignment == gf.Misalignment(F_beta_x=0.012, f_sigma_beta=0.006, length=90)
    made = case.flanks["pinion"]
    assert made == gf.Flank(
        helix_crowning=0.005, helix_slope=-0.003, twist=0.002, end_relief=(0.004, 0.008), end_length=(2.0, 3.0)
    )
    assert scene.case().why_wide
    assert not loaded(tmp_path, RELIEF)[0].case().why_wide
    for text, message in (
        ("f_sigma_beta_um = 6\n", r"\[pair.main\]: misalignment: .* give length"),
        ("F_beta_x_um = 12000\n", r"\[pair.main\]: F_beta_x_um = 12000: the misalignment is 600 um per mm"),
        (WIDE.replace("[2, 3]", "[2, 30]"), r"\[flank.wide\]: end_length_mm = \[2, 30\], but the gear of z = 24 is 20 mm wide"),
        (WIDE.replace("[4, 8]", "4"), r"expected two numbers in um"),
    ):
        with pytest.raises(ValueError, match=message):
            loaded(tmp_path, text)


@pytest.mark.slow
def test_a_misaligned_pair_is_compared_in_three_dimensions(tmp_path):
    _, path = loaded(tmp_path, "F_beta_x_um = 12\n")
    found = gf.compare(path, phases=4)
    assert list(found.curves) == ["ritz3d", "textbook", "herringbone_article"]
    assert all(curve.unloaded is not None for curve in found.curves.values())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (RELIEF.replace("_um", "_mm"), r"\[flank.short\]: unknown key 'tip_relief_mm'"),
        (RELIEF.replace("= 10", "= 10000"), r"\[flank.short\]: tip_relief_um = 10000: the flank of z = 24 deviates by 10 mm"),
        (
            RELIEF.replace("= 24", "= 50"),
            r"\[flank.short\]: tip_start_angle_deg = 50 is not inside the flank of z = 24, 5.99\d* to 32.86\d* degrees",
        ),
        (RELIEF.replace('"pinion"', '"sun"'), "no such gear; there is pinion, wheel"),
        (
            RELIEF + RELIEF.replace("short", "again"),
            r"'pinion' has two tables \(flank\) in pair 'main'; give each of them the key pair",
        ),
        ("[flank.a]\ngear = 'wheel'\ntable_roll_mm = [1, 2]\n", "give table_roll_mm and table_removed_um together"),
        ("[flank.a]\ngear = 'wheel'\npitch_um = 3\n", "expected a list of numbers in um"),
    ],
)
def test_mistakes_are_explained(tmp_path, text, message):
    with pytest.raises(ValueError, match=message):
        loaded(tmp_path, text)


def test_the_command_line_prints_and_draws_the_map(tmp_path, capsys):
    _, path = loaded(tmp_path, RELIEF)
    assert main(["te", str(path), "--forces", "1000", "3000", "--phases", "16", "--plot", str(tmp_path / "te.svg")]) == 0
    text = capsys.readouterr().out
    assert "peak-to-peak" in text
    assert len([line for line in text.splitlines() if line.split()[1:2] in (["1000"], ["3000"])]) == 2
    assert (tmp_path / "te.svg").stat().st_size > 1000
    assert main(["stiffness", str(path), "--forces", "1000", "--force", "1000"]) == 1
    assert main(["stiffness", str(path), "--forces", "1000", "-o", str(tmp_path / "te.csv")]) == 0


@pytest.mark.parametrize("gear", ["pinion", "ring"])
def test_a_relief_may_start_at_a_length_below_the_tip(tmp_path, gear):
    own = SCENE
    if gear == "ring":
        own = own.replace("z = 36", "z = 90").replace("r_bore_mm = 20", "r_rim_mm = 160\naddendum = 0.8\nrack_tip_radius = 0.2")
    lengths = "tip_relief_um = 10\ntip_start_length_mm = 2.0\nroot_relief_um = 8\nroot_start_length_mm = 1.5\n"
    path = tmp_path / "scene.toml"
    side = "wheel" if gear == "ring" else "pinion"
    path.write_text(own + f"[flank.one]\ngear = '{side}'\n" + lengths)
    chosen = gf.load_scene(path).pair()
    body = chosen.pair.gear_2 if gear == "ring" else chosen.pair.gear_1
    form = chosen.flanks[side].on(body)
    inside = 1 if body.roll_f > body.roll_a else -1
    assert_allclose(form.removed(body.roll_a), 0.010, rtol=1e-9)
    assert_allclose(form.removed(body.roll_a + inside * 1.0), 0.005, rtol=1e-9)
    assert_allclose(form.removed(body.roll_a + inside * 2.0), 0.0, atol=1e-12)
    assert_allclose(form.removed(body.roll_f - inside * 0.75), 0.004, rtol=1e-9)
    path.write_text(own + f"[flank.one]\ngear = '{side}'\n" + lengths.replace("2.0", "200"))
    with pytest.raises(ValueError, match=r"tip_start_length_mm = 200.*mm long in roll length"):
        gf.load_scene(path)
    path.write_text(own + f"[flank.one]\ngear = '{side}'\n" + lengths + "tip_start_diameter_mm = 70\n")
    with pytest.raises(ValueError, match="with 2 of its starts"):
        gf.load_scene(path)
