"""A scene in words says what its file says."""

import math
import re

import pytest

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.told_scene import told, told_flank
from gearfe.scene.load import scene_names


@pytest.fixture
def everything(tmp_path):
    text = gf.new_scene(tmp_path / "my.toml").read_text()
    text = re.sub(
        r"^#\[\[(missing_tooth|chip).*?\n\n", "\n", text, flags=re.M | re.S
    )  # with flanks that change along the width no method has it
    (tmp_path / "all.toml").write_text(re.sub(r"^#(?=[\w\[])", "", text, flags=re.M))
    return tmp_path / "all.toml"


def test_all_of_a_scene_is_told(everything, capsys):
    assert main(["check", str(everything)]) == 0
    text = capsys.readouterr().out
    for words in (
        "gear pinion: 21 teeth, module 2 mm",
        "2000 N along the line of action, 39.47 N m on the pinion",
        "tip relief 20 um, linear",
        "share the load over the first and the last 3.63 mm of roll",  # (eps_alpha - 1) p_bt, 0.615 times 5.904 mm
        "axes: misalignment F_beta_x 10 um",
        "pinion held by a shaft of 40 mm of 18.4 mm, 40 mm of 18.4 mm, bearings at 0 and 80 mm (200 N/um and 200 N/um)",
        "wheel held by springs: radial stiffness 200 N/um",
        "2 mm crack at 60 degrees in the pinion's tooth 0; solved by ritz3d: cracks change along the width",
        "5 pits in the pinion's tooth 0",
        "machine: helical_pair, 1500 rpm",
        "assumed: bore radius 9.2 mm",
    ):
        assert words in text


@pytest.mark.parametrize("name", scene_names())
def test_method_told_is_the_one_taken(name):
    scene = gf.load_scene(name)
    text = "\n".join(told(scene))
    for pair in scene.pairs.values():
        assert pair.damage.keys() <= {case for case in re.findall(r"case (\S+):", text)}
    if name == "planetary_pitting":
        chosen = scene.pair()
        for case in (None, "mild"):
            method = gf.mesh_stiffness(chosen.case(case), phases=1).meta["method"]
            line = next(one for one in told(scene) if ("healthy;" if case is None else f"case {case}:") in one)
            assert f"solved by {method}:" in line


def test_overlap_of_helical_and_herringbone_pairs_is_told(tmp_path):
    """b sin(beta) / (pi m_n), ISO 21771."""
    chosen = gf.load_scene(gf.new_scene(tmp_path / "my.toml", helix_deg=15.0)).pair().pair
    assert chosen.eps_beta == pytest.approx(20.0 * math.sin(math.radians(15)) / (2.0 * math.pi))
    scene = gf.load_scene(tmp_path / "my.toml")
    assert f"overlap ratio {chosen.eps_beta:.3f};" in "\n".join(told(scene))
    assert "the overlap ratio is that of one half" in "\n".join(told(gf.load_scene("herringbone")))


def test_starts_of_a_relief_are_one_place():
    gear = gf.Gear(z=21, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=7.4)
    roll = math.sqrt(22.0**2 - gear.r_b**2)
    starts = {"diameter": 44.0, "roll": roll, "angle": roll / gear.r_b}
    texts = {told_flank(gf.Flank(tip_relief=0.02, **{f"tip_start_{how}": value}), gear) for how, value in starts.items()}
    assert len(texts) == 1
    assert "tip relief 20 um, linear, from a diameter of 44 mm on" in texts.pop()
    assert told_flank(gf.Flank(), gear) == "involute"
