"""Former names still work, and each warning gives the new name."""

import math
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import gearfe as gf
from gearfe import RENAMED
from gearfe.app.cli import main
from gearfe.scene.toml_file import FORMER

GEAR = {"z": 21, "m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0, "r_bore": 7.4}
PAIR = gf.GearPair(gf.Gear(**GEAR), gf.Gear(**GEAR))
CURVE = gf.StiffnessCurve(
    *([[0.0, 0.5], [1e8, 1e8], [1e8, 1e8], [1e-6, 1e-6]]),
    order=[0],
    force=[[100.0]] * 2,
    pressure=[[1.0]] * 2,
    meta={"force_N": 100.0},
)
OSCILLATOR = gf.single_mesh(1.0, 1e8, 500.0)


def mesh(**changed):
    return gf.single_mesh(1.0, 1e8, 500.0, **changed).meshes[0]


@pytest.mark.parametrize(
    ("old", "new", "former", "present"),
    [
        ("tip_radius", "rack_tip_radius", lambda: gf.Gear(**GEAR, tip_radius=0.3), lambda: gf.Gear(**GEAR, rack_tip_radius=0.3)),
        ("tip_radius", "rack_tip_radius", lambda: PAIR.gear_1.tip_radius, lambda: 0.38),
        ("tip_radius", "rack_tip_radius", lambda: replace(PAIR.gear_1, tip_radius=0.3).rack_tip_radius, lambda: 0.3),
        ("crowning", "profile_crowning", lambda: gf.Flank(crowning=0.01), lambda: gf.Flank(profile_crowning=0.01)),
        ("lead_slope", "helix_slope", lambda: gf.Flank(lead_slope=0.01), lambda: gf.Flank(helix_slope=0.01)),
        ("F_beta", "F_beta_x", lambda: gf.Misalignment(F_beta=0.01), lambda: gf.Misalignment(F_beta_x=0.01)),
        ("alpha_w", "alpha_wt", lambda: PAIR.alpha_w, lambda: PAIR.alpha_wt),
        ("lte", "deflection", lambda: CURVE.lte, lambda: CURVE.deflection),
        ("beta", "damping_per_stiffness", lambda: mesh(beta=1e-6).damping_per_stiffness, lambda: 1e-6),
        (
            *("heard", "output"),
            lambda: gf.frequency_response(OSCILLATOR, [0.0], heard="mesh", input="mesh"),
            lambda: gf.frequency_response(OSCILLATOR, [0.0], output="mesh", input="mesh"),
        ),
        ("slope", "profile_slope", lambda: gf.Flank(slope=0.01), lambda: gf.Flank(profile_slope=0.01)),
        ("lead_crowning", "helix_crowning", lambda: gf.Flank(lead_crowning=0.01), lambda: gf.Flank(helix_crowning=0.01)),
        ("lead_crowning", "helix_crowning", lambda: gf.Flank(helix_crowning=0.01).lead_crowning, lambda: 0.01),
        *((old, new, partial(getattr, gf, old), partial(getattr, gf, new)) for old, new in RENAMED.items()),
        (
            *(r"simulate\(dt=, every=\)", r"simulate\(rate=, step=, filtered=\)"),
            lambda: gf.simulate(OSCILLATOR, 1e-3, dt=1e-5, every=4).q,
            lambda: gf.simulate(OSCILLATOR, 1e-3, step=1e-5, rate=25e3, filtered=False).q,
        ),
        ("published", "herringbone_article", lambda: gf.Solve("published"), lambda: gf.Solve("herringbone_article")),
    ],
)  # fmt: skip
def test_a_former_name_works_and_its_warning_gives_the_new_one(old, new, former, present):
    with pytest.warns(DeprecationWarning, match=rf"{old}'? is now '?{new}"):
        got = former()
    assert np.all(got == present())


def test_former_keys_of_scenes_are_read_with_a_note(tmp_path, capsys):
    path = tmp_path / "my.toml"
    assert main(["new", str(path)]) == 0
    text = path.read_text(encoding="utf-8")
    flank = '\n[flank.p]\ngear = "pinion"\ncrowning_um = 3.0\nlead_slope_um = 2.0\n'
    path.write_text(text + flank, encoding="utf-8")
    with pytest.warns(FutureWarning, match=r"my.toml: key (crowning|lead_slope)_um is now (profile_crowning|helix_slope)_um"):
        found = gf.load_scene(path).case().flanks["pinion"]
    assert found == gf.Flank(profile_crowning=0.003, helix_slope=0.002)
    capsys.readouterr()
    assert main(["check", str(path)]) == 0
    assert "note: my.toml: key crowning_um is now profile_crowning_um" in capsys.readouterr().err


def test_former_keys_are_none_of_today():
    from gearfe.scene.schema import scene_schema

    today = {key for table in scene_schema().values() for key in table.keys}
    assert today >= set(FORMER.values())
    assert not today & set(FORMER)


def test_former_options_of_the_command_work(tmp_path, capsys):
    run = ["planetary_pitting", "--forces", "1000", "--phases", "8"]
    files = [str(tmp_path / f"{name}.csv") for name in ("te", "former")]
    assert main(["te", *run, "-o", files[0]]) == 0
    printed = capsys.readouterr()
    assert main(["stiffness", *run, "-o", files[1]]) == 0
    former = capsys.readouterr()
    assert former.out == printed.out.replace(*files)
    assert Path(files[0]).read_text() == Path(files[1]).read_text()
    assert "--forces is now gearfe te --forces" in former.err
    assert main(["compare", "planetary_pitting", "--cases", "--case", "x"]) == 1
