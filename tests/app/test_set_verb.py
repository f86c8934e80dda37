"""``gearfe set``: the numbers of the set in words and in files, and what is refused before work begins."""

import numpy as np
import pytest
from set_page import SCENE

import gearfe as gf
from gearfe.app.cli import main


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "my_set.toml"
    path.write_text(SCENE)
    return path


def test_the_first_sentence_is_the_answer(scene, tmp_path, capsys):
    """On six pads 84 teeth are looked at over 14 mesh cycles; a damaged set over two, beside the healthy one."""
    csv = tmp_path / "set.csv"
    assert main(["set", str(scene), "--positions", "4", "-o", str(csv)]) == 0
    title, _, said, *rest = capsys.readouterr().out.splitlines()
    found = gf.planetary_stiffness(gf.build_set(gf.load_scene(scene)), 14 * np.arange(5) / 5)
    inside, alone = found.k[1].mean(), found.k_alone[1].mean()
    assert title == "Planetary set 21/31/84"
    assert f"k of planet and ring {inside / 1e6:.1f} N/um, alone {alone / 1e6:.1f} ({100 * (inside / alone - 1):+.1f} %)" in said
    assert f"K_gamma {found.K_gamma:.3f}, transmission error {1e6 * np.ptp(found.te):.3g} um" in said
    text = "\n".join(rest)
    assert "over 5 positions in 14 mesh cycles" in text
    assert f"{found.force[0, :, 1].max():.5g}" in text
    assert len(csv.read_text().splitlines()) == 3 + 5


def test_damage_stands_beside_health(scene, capsys):
    assert main(["set", str(scene), "--case", "cracked", "--positions", "5"]) == 0
    said = capsys.readouterr().out.splitlines()[2]
    at = 2 * np.arange(5) / 5
    loaded = gf.load_scene(scene)
    cracked, healthy = (gf.planetary_stiffness(gf.build_set(loaded, case), at) for case in ("cracked", None))
    loss = 100 * (1 - cracked.k / healthy.k)
    assert loss.argmax() // (3 * at.size) == 0
    assert said.endswith(f"the damage reduces k by up to {loss.max():.1f} % in the mesh of sun and planet, planet 1")


def test_what_cannot_be_is_refused_before_work_begins(scene, tmp_path, monkeypatch, capsys):
    def work(*_, **__):
        raise AssertionError("work began")

    monkeypatch.setattr("gearfe.planetary_sets.solve.planetary_stiffness", work)
    for options, told in (
        (["-o", str(tmp_path / "x.png")], "no format for '.png'"),
        (["--picture", str(tmp_path / "x.csv")], "no format for '.csv'"),
        (["--animate", str(tmp_path / "x.mp4")], "ends in .gif"),
        (["--animate", str(tmp_path / "none" / "x.gif")], "cannot write"),
        (["--case", "broken"], "no case 'broken' in the set of scene my_set; it has cracked"),
        (["--positions", "0"], "positions = 0"),
        (["--cycles", "0"], "cycles = 0"),
        (["--cycles", "1000000"], "cycles = 1000000, but give at most 10000"),
    ):
        assert main(["set", str(scene), *options]) == 1
        assert told in capsys.readouterr().err
    assert main(["set", "herringbone"]) == 1
    assert "has no [set] table: add one with n_planets or planet_angles_deg" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["my_set.toml"]


@pytest.mark.parametrize(
    ("support", "told"),
    [
        ('kind = "held"', "held all around"),
        (
            'kind = "bed"\nradial_MPa_per_mm = 1e4\ntangential_MPa_per_mm = 5e3',
            "on an elastic bed of 10000 (radial) and 5000 MPa/mm",
        ),
        ('kind = "pads"\ncount = 4\nwidth_mm = 8\nradial_N_per_um = 40', "on 4 pads of 8 mm, radial 40 N/um"),
        (
            'kind = "lugs"\ncount = 5\nwidth_mm = 8\ntangential_N_per_um = 50',
            "on 5 lugs, which only push, of 8 mm, tangential 50",
        ),
    ],
)
def test_check_tells_the_set(scene, capsys, support, told):
    pads = SCENE[SCENE.index("[ring.support]") : SCENE.index("[pin.first]")]
    scene.write_text(SCENE.replace(pads, f"[ring.support]\n{support}\n"))
    assert main(["check", str(scene)]) == 0
    said = capsys.readouterr().out
    assert told in said
    assert "set: 3 planets at 0, 120, 240 degrees, pins of 300 N/um, 1 of 3 off their places; 2027" in said
