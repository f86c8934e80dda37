import sys
import tomllib
from dataclasses import replace
from importlib import resources

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import arguments, main
from gearfe.strength.fields import stressed_gears
from gearfe.strength.render import render_contact


@pytest.mark.quick
def test_every_verb_has_a_function_and_a_place_for_its_options():
    tables = tomllib.loads(resources.files("gearfe.app.cli").joinpath("verbs.toml").read_text(encoding="utf-8"))
    for verb in tables["verbs"].values():
        module, _, name = verb["run"].partition(".")
        assert callable(getattr(arguments.MODULES[module], name))
        assert {*verb.get("shared", ()), *verb.get("further", ())} <= tables["shared"].keys()
        assert verb.keys() <= {"run", "text", "methods", "aliases", "shared", "further", "options"}


@pytest.mark.quick
def test_stiffness_writes_curve_and_plot(tmp_path, capsys):
    out, plot = tmp_path / "k.csv", tmp_path / "k.png"
    assert main(["stiffness", "planetary_pitting", "--phases", "8", "-o", str(out), "--plot", str(plot)]) == 0
    assert gf.StiffnessCurve.from_csv(out).phase.size == 8
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert "assumed: face width" in capsys.readouterr().out


def test_stiffness_of_one_gear_turned_against_the_other(tmp_path):
    out = tmp_path / "k.csv"
    assert main(["stiffness", "planetary_pitting", "--phases", "4", "--pose", "pinion", "-o", str(out)]) == 0
    case = gf.load_scene("planetary_pitting").pair().case(None)
    expected = gf.mesh_stiffness(case, phases=4, span="cycle", pose="pinion")
    np.testing.assert_allclose(gf.StiffnessCurve.from_csv(out).k, expected.k, rtol=1e-9)
    mean = gf.mesh_stiffness(case, phases=4, span="cycle")
    assert abs(mean.k / expected.k - 1).max() > 1e-6


@pytest.mark.slow
def test_stiffness_of_a_case_is_told_as_compare_tells_it(capsys):
    """One number for one question: zones over the same cycle, losses against the same healthy gears."""
    run = ["compound_planetary", "--case", "crack30", "--phases", "8"]
    assert main(["stiffness", *run]) == 0
    text = capsys.readouterr().out
    rows = {
        line.split("|")[1].strip(): [cell.strip() for cell in line.split("|")[2:-1]] for line in text.splitlines() if "|" in line
    }
    told = gf.compare("compound_planetary", case="crack30", phases=8, refine=0.4)  # of the reference alone
    for zone, lost in told.losses()["ritz"].items():
        assert f"{100 * lost:.1f} %" in text, zone
    ritz = next(row for row in told.rows() if (row.method, row.zone) == ("ritz", "single"))
    assert rows["single"][0] == f"{ritz.k / 1e6:.2f}"
    assert told.definition in text
    assert "3.07 mm crack" in text


@pytest.mark.slow
def test_a_closed_form_solves_no_set(monkeypatch, capsys):
    """It runs without gmsh; solved pairs state the stiffness in their set."""

    def solved(*_, **__):
        raise AssertionError("the set is solved")

    monkeypatch.setattr("gearfe.planetary_sets.solve.planetary_stiffness", solved)
    assert main(["stiffness", "planetary_pitting", "--method", "textbook", "--phases", "4"]) == 0
    assert "in the whole set" not in capsys.readouterr().out
    monkeypatch.undo()
    assert main(["stiffness", "planetary_pitting", "--phases", "4"]) == 0
    assert "in the whole set" in capsys.readouterr().out


def test_compare_prints_errors_by_zone(tmp_path, capsys):
    file = tmp_path / "errors.tex"
    assert main(["compare", "planetary_pitting", "--phases", "8", "--refine", "0.6", "-o", str(file)]) == 0
    text = capsys.readouterr().out
    rows = {line.split("|")[1].strip(): line.split("|")[2:-1] for line in text.splitlines() if line.startswith("| ")}
    assert {"single", "double", "mean", "max", "seconds"} <= rows.keys()
    fe, textbook = float(rows["double"][0]), float(rows["double"][2])
    assert abs(100 * (textbook / fe - 1) - float(rows["double"][3].replace("%", ""))) < 0.1
    assert 0 < float(rows["double"][1].strip("+- %\u00b1")) < 1
    assert f"double & {fe:.1f} & $\\pm$" in file.read_text(encoding="utf-8")


def test_warnings_become_notes(tmp_path, capsys):
    text = (resources.files("gearfe.scene.scenes") / "planetary_pitting.toml").read_text()
    path = tmp_path / "untrimmed.toml"
    path.write_text(text.replace("addendum = 0.859\n", ""))
    assert main(["stiffness", str(path), "--method", "textbook"]) == 0
    assert "note: the ring's tip (z = 84) was trimmed" in capsys.readouterr().err


@pytest.mark.slow
def test_render_makes_a_picture_of_stress(tmp_path, capsys):
    path = tmp_path / "stress.png"
    assert main(["render", "planetary_pitting", "--refine", "0.5", "-o", str(path)]) == 0
    from matplotlib.image import imread

    picture = imread(path)
    assert picture.shape[:2] == (1050, 1400)
    assert np.unique((picture[..., :3] * 8).astype(int).reshape(-1, 3), axis=0).shape[0] > 50, "colours, not a blank"


def test_render_opens_a_crack_and_says_how_far(tmp_path, capsys):
    import meshio

    path = tmp_path / "cracked.vtu"
    assert main(["render", "compound_planetary", "--case", "crack30", "--refine", "0.5", "-o", str(path)]) == 0
    assert "which opens the crack" in capsys.readouterr().out
    found = meshio.read(path)
    assert set(found.cells_dict) == {"triangle6"}
    assert {"displacement [mm]", "stress [MPa]", "von Mises stress [MPa]"} == set(found.point_data)
    assert np.isfinite(found.point_data["stress [MPa]"]).all()


@pytest.mark.slow
def test_pictures_have_the_flanks_and_shafts_of_their_scene(tmp_path):
    """k of the picture of contact is that of `mesh_stiffness`; a relieved neighbour leaves its load to the tooth shown."""
    chosen = gf.load_scene("planetary_pitting").pair()
    askew = replace(chosen, misalignment=gf.Misalignment(F_beta_x=0.01), supports={"pinion": gf.Support(radial=2e5, tilt=5e7)})
    told = render_contact(askew.case(), tmp_path / "contact.svg", phase=0.9)
    solved = gf.mesh_stiffness(askew.case(), method="ritz3d", phases=[0.9])
    assert told["k"] == pytest.approx(solved.k[0], rel=1e-9)
    assert told["k"] < 0.6 * render_contact(chosen.case(), tmp_path / "contact.svg", phase=0.9)["k"]
    gears = ("pinion", chosen.pair.gear_1), ("wheel", chosen.pair.gear_2)
    relieved = replace(chosen, flanks={n: gf.Flank(tip_relief=0.1, tip_start_diameter=2 * g.r_a - 1.0) for n, g in gears})
    plain, more = (max(field.root for field in stressed_gears(one.case(), 0.1, 0.5)) for one in (chosen, relieved))
    share = gf.mesh_stiffness(chosen.case(), phases=[0.1]).force[0].max() / chosen.force
    assert more == pytest.approx(plain / share, rel=0.1), "one tooth carries all of it"


def test_check_draws_the_pair_with_its_damage(tmp_path, capsys):
    path = tmp_path / "pair.svg"
    assert main(["check", "compound_planetary", "--picture", str(path)]) == 0
    assert f"written: {path}" in capsys.readouterr().out
    assert main(["check", "compound_planetary", "--case", "crack30"]) == 1
    assert "add --picture FILE" in capsys.readouterr().err


def test_info_cites_the_installed_version(capsys):
    assert main(["info", "--cite"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "@software{gearfe,"
    assert f"  version = {{{gf.__version__}}}," in lines


def test_scenes_and_info(capsys):
    assert main(["scenes"]) == 0
    assert main(["info"]) == 0
    text = capsys.readouterr().out
    assert "planetary_pitting: pairs sun_planet, planet_ring" in text
    assert "gmsh starts" in text


@pytest.mark.parametrize(
    ("verb", "option", "good"),
    [
        (["stiffness", "planetary_pitting", "--method", "fe3d"], "-o", "k.csv"),
        (["stiffness", "planetary_pitting", "--method", "fe3d"], "--plot", "k.png"),
        (["compare", "planetary_pitting"], "--plot", "k.svg"),
        (["render", "planetary_pitting"], "-o", "s.vtu"),
        (["render", "planetary_pitting", "--what", "contact"], "-o", "s.png"),
        (["check", "planetary_pitting"], "--picture", "s.png"),
        (["dynamics", "planetary_pitting"], "-o", "r.mat"),
        (["dynamics", "planetary_pitting"], "--plot", "r.pdf"),
        (["dynamics", "planetary_pitting"], "--kurtogram", "r.png"),
        (["signal", "none.csv"], "--plot", "r.png"),
        (["signal", "none.csv"], "--kurtogram", "r.png"),
        (["signal", "none.csv"], "--cepstrum", "r.png"),
        (["signal", "none.csv"], "--spectrogram", "r.png"),
    ],
)
def test_outputs_are_checked_before_any_work(verb, option, good, tmp_path, monkeypatch, capsys):
    def work(*_, **__):
        raise AssertionError("work began")

    for name in ("gearfe.scene.load.load_scene", "gearfe.signal.signal_file.read_signals"):
        monkeypatch.setattr(name, work)
    (tmp_path / "folder.png").mkdir()
    suffix = good.rpartition(".")[2]
    for given, message in (
        ("", "empty file name"),
        (str(tmp_path / "x.xlsx"), "no format for '.xlsx'; use one of "),
        (str(tmp_path / "nosuffix"), "no format for 'a file without a suffix'"),
        (str(tmp_path / "missing" / good), "cannot write"),
        (str(tmp_path / f"{'long' * 100}.{suffix}"), "cannot write"),
    ):
        assert main([*verb, option, given]) == 1, given
        assert message in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["folder.png"], "a check leaves nothing behind"
    with pytest.raises(AssertionError, match="work began"):
        main([*verb, option, str(tmp_path / good)])


def test_two_outputs_do_not_share_a_file(tmp_path, capsys):
    same = str(tmp_path / "x.png")
    assert main(["signal", "none.csv", "--plot", same, "--kurtogram", same]) == 1
    assert "--plot and --kurtogram name the same file" in capsys.readouterr().err


def test_missing_renderer_names_the_package(monkeypatch, tmp_path, capsys):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    assert main(["render", "planetary_pitting", "-o", str(tmp_path / "s.png")]) == 1
    assert "pip install pyvista" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_law_of_contact_for_a_scene_without_machine_is_refused(capsys):
    assert main(["dynamics", "herringbone_contact_line", "--contact", "impact"]) == 1
    assert "has no [machine] table" in capsys.readouterr().err


def test_transmission_error_of_a_damaged_pair_is_saved_beside_healthy(tmp_path, capsys):
    arguments = ["te", "compound_planetary", "--case", "crack50", "--phases", "16", "--forces", "1000", "2000"]
    assert main([*arguments, "-o", str(tmp_path / "te.csv")]) == 0
    printed = capsys.readouterr().out
    assert "5.11 mm crack at 45 degrees" in printed
    assert "healthy [um]" in printed
    scene = gf.load_scene("compound_planetary")
    rows = np.loadtxt(tmp_path / "te.csv", delimiter=",", skiprows=1)
    want = gf.transmission_error(scene.case(case="crack50"), [1000.0, 2000.0], phases=rows[:, 0])
    assert_allclose(rows[:, 1:], np.vstack([want.te, want.unloaded]).T, rtol=1e-9)
    assert main([*arguments, "-o", str(tmp_path / "te.tex")]) == 0
    assert "tabular" in (tmp_path / "te.tex").read_text()


def test_saved_transmission_errors_contain_each_damaged_tooth(tmp_path):
    scene = tmp_path / "two.toml"
    assert main(["new", str(scene), "--teeth", "24", "43", "--module", "3", "--crack", "2", "60"]) == 0
    second = '\n[[crack]]\ngear = "wheel"\ntooth = 5\nlength_mm = 3.0\nangle_deg = 60.0\ncase = "cracked"\n'
    scene.write_text(scene.read_text() + second)
    assert main(["te", str(scene), "--case", "cracked", "--phases", "8", "-o", str(tmp_path / "te.md")]) == 0
    _, _, *rows = (tmp_path / "te.md").read_text().splitlines()
    assert sum("2 mm crack" in row for row in rows) == sum("3 mm crack" in row for row in rows) > 0
