"""The contact pattern of a scene's pair, in numbers and as a picture."""

import numpy as np
import pytest

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.pattern import pattern_of


@pytest.fixture(scope="module")
def askew(tmp_path_factory):
    """A narrow spur pair, 20 um wider open at z = b."""
    scene = gf.new_scene(tmp_path_factory.mktemp("pattern") / "own.toml", teeth=(17, 23), width=8.0)
    scene.write_text(scene.read_text().replace("#F_beta_x_um = 10.0", "F_beta_x_um = 20.0"))
    return scene


@pytest.mark.slow
def test_load_over_the_face_is_the_whole_force(askew):
    chosen = gf.load_scene(askew).pair()
    found = pattern_of(chosen.case(), phases=4)
    z, load = gf.face_load_distribution(found.contact)
    assert load.mean() * 8.0 == pytest.approx(chosen.force, rel=0.01)  # spur: normal to the flank is along the line of action
    assert np.diff(z).max() < 0.1
    assert load[z < 1].mean() > 2 * load[z > 7].mean()
    assert found.factor == pytest.approx(load.max() / load.mean())
    assert found.pressure == max(np.nanmax(cells.pressure) for cells in found.contact.cells)
    assert found.z < 4.0  # it presses where it closes


def test_pattern_of_the_command_line(askew, tmp_path, capsys):
    assert main(["render", str(askew), "--what", "pattern", "-o", str(tmp_path / "pattern.png")]) == 0
    assert "face load factor" in capsys.readouterr().out
    assert (tmp_path / "pattern.png").read_bytes().startswith(b"\x89PNG")
    assert main(["render", str(askew), "--what", "pattern", "--phase", "0.2", "-o", str(tmp_path / "other.png")]) == 1
    assert "leave out --phase" in capsys.readouterr().err


def test_a_line_without_load_is_grey_and_zero_is_the_first_colour(askew):
    chosen = gf.load_scene(askew).pair()
    contact = gf.contact_pattern(
        **chosen.case().as_dict() | {"force": 100.0}, phases=[0.0, 0.9]
    )  # so light that z = b stays open
    figure = gf.plot_contact(chosen.pair, contact, None)
    idle, drawn = figure.axes[0].collections
    assert len(idle.get_segments()) == sum((cells.load == 0).sum() for cells in contact.cells) > 0
    assert drawn.get_clim()[0] == 0.0
