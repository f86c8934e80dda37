"""Contributing page: each recipe of `tests/recipes` touches the files that the page names and no others, and works in a copy."""

import json
import math
import os
import re
import shutil
import subprocess
import sys
import tomllib

import numpy as np
import pytest
from conftest import ROOT
from numpy.testing import assert_allclose
from scipy.linalg import eigh
from scipy.optimize import brentq
from usual import RACK

import gearfe as gf

FOLDER = ROOT / "tests" / "recipes"
RECIPES = {path.stem: tomllib.loads(path.read_text(encoding="utf-8")) for path in sorted(FOLDER.glob("*.toml"))}
SCENE = """
[pair.bent]
gear_1 = "pinion"
gear_2 = "wheel"
force_N = 2000.0

[flank.bent]
gear = "pinion"
pair = "bent"
quartic_um = 10.0

[[band]]
case = "banded"
gear = "pinion"
pair = "stage"
radius_mm = 21.0
z_mm = 8.0
width_mm = 6.0
depth_mm = 0.1

[[spall]]
case = "spalled"
gear = "pinion"
pair = "stage"
radius_mm = 21.0
z_mm = 8.0
sides_mm = [20.0, 6.0]
depth_mm = 0.1

[machine]
model = "turning_pair"
speed_rpm = 1500.0
torque_Nm = 39.4668
"""
PAIR = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **RACK), gf.Gear(z=31, r_bore=14.2, **RACK))  # of the scene
STEEL = gf.Material(E=206e3, nu=0.3)
LAW = """
import json
from dataclasses import replace
import numpy as np
import gearfe as gf
from gearfe.dynamics.machine.laws.lankarani import Lankarani
from machines import WAVE, two_masses

hit = gf.single_mesh(1.0, 1e9, 0.0, force=1e-3, backlash=np.inf, film=0.0, law=Lankarani(0.95, 0.1))
start = [-1e-6], [0.1]
own = {"law": Lankarani(0.8, 0.05, power=1.4), "backlash": 6e-5, "error": ((60e-6, 1500.0, 0.3),), "zeta": 0.0, "damping": 50.0}
mixed = two_masses(stiffness=5e9 / WAVE.mean() * WAVE, film=0.3, **own)
mixed = replace(mixed, meshes=(*mixed.meshes, gf.GearMesh("spring", np.array([0.5, 1.0]), 1e8 + 0 * WAVE, 500.0, zeta=0.02)))
told = {"left": []}
for method in ("fast", "DOP853"):
    run = gf.simulate(hit, 1.5e-3, rate=1e5, method=method, initial=start, filtered=False, rtol=1e-10)
    told["left"].append(float(-run.v[-1, 0] / 0.1))
runs = [gf.simulate(mixed, 0.004, rate=5e4, filtered=False, rtol=1e-10, **how) for how in ({"step": 1e-6}, {"method": "DOP853"})]
told["lost"] = [run.stats["losses"] for run in runs]
pairs = [[run.q for run in runs], [run.mesh() for run in runs]]
told["apart"] = [float((abs(one - two).max(0) / np.ptp(two, 0)).max()) for one, two in pairs]
print(json.dumps(told))
"""


def rows(path):
    """Rows of a table `Where would I put ...`: the recipe's name, and its files and folders; other names in code style."""
    found = re.findall(r"^\| (?:a|an) ([^|]*) \| (.*) \|$", path.read_text(encoding="utf-8").split("Where would I put")[1], re.M)
    code = {name.replace(" ", "_"): re.findall("`([^`]+)`", files) for name, files in found}
    return {name: ({one for one in own if "/" in one}, {one for one in own if "/" not in one}) for name, own in code.items()}


PLACES = rows(ROOT / "gearfe" / "docs" / "where.md")


def edited(text, recipe, path):
    """The text of a file with the edits that a recipe has for it, of text that stands there once."""
    for edit in (edit for edit in recipe["edit"] if edit["path"] == path):
        assert text.count(edit["old"]) == 1, f"{path}: {edit['old']!r} stands there {text.count(edit['old'])} times"
        text = text.replace(edit["old"], edit["new"])
    return text


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """Folder with both packages and all recipes in them, and with a scene that uses them."""
    folder = tmp_path_factory.mktemp("copy")
    for name in ("gearfe", "geometry"):
        shutil.copytree(ROOT / name, folder / name, symlinks=True, ignore=shutil.ignore_patterns("docs", "__pycache__"))
    for recipe in RECIPES.values():
        for new in recipe.get("new", ()):
            assert not (folder / new["path"]).exists()
            (folder / new["path"]).write_text(new["text"].lstrip(), encoding="utf-8")
        for path in {edit["path"] for edit in recipe["edit"]}:
            text = (folder / path).read_text(encoding="utf-8")
            (folder / path).write_text(edited(text, recipe, path), encoding="utf-8")
    gearfe(folder, "new", "my.toml")
    with open(folder / "my.toml", "a", encoding="utf-8") as scene:
        scene.write(SCENE)
    return folder


def python(folder, *arguments):
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(folder), str(ROOT / "tests")])}
    environment.pop("NUMBA_CACHE_DIR", None)
    done = subprocess.run([sys.executable, *arguments], capture_output=True, text=True, env=environment, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout


def gearfe(folder, *arguments):
    """What the command of the copy prints."""
    return python(folder, "-m", "gearfe", *arguments)


def table(text, row, after=""):
    """Numbers of the row of a printed table that begins so."""
    line = next(line for line in text[text.index(after) :].splitlines() if line.strip(" |").startswith(row))
    return [float(one) for one in re.findall(r"[-+]?\d+\.?\d*(?:e[-+]\d+)?", line.split(row, 1)[1])]


def test_every_row_of_the_page_has_a_recipe():
    assert set(PLACES) == set(RECIPES)


@pytest.mark.parametrize("name", sorted(RECIPES))
def test_a_recipe_touches_what_the_page_says_and_no_more(name):
    """A folder that is promised gets one file; a file is edited; what it is said to hold is there."""
    files, names = PLACES[name]
    new = [f"{os.path.dirname(one['path'])}/" for one in RECIPES[name].get("new", ())]
    edits = {edit["path"] for edit in RECIPES[name]["edit"]}
    assert len(set(new)) == len(new)
    assert {*new, *edits} == files
    for path in edits:
        edited((ROOT / path).read_text(encoding="utf-8"), RECIPES[name], path)
    assert all(any(re.search(rf"\b{one}\b", (ROOT / path).read_text(encoding="utf-8")) for path in edits) for one in names)


LINES = {
    "check": "check my.toml",
    "compare": "compare my.toml --pair stage --case banded --phases 4 --refine 0.5",
    "banded": "stiffness my.toml --case banded --method textbook",
    "spalled": "stiffness my.toml --case spalled --method textbook",
    "bent": "te my.toml --pair bent --method equal --forces 2000 --phases 32",
    "kept": "stiffness my.toml -o k.tsv",
}
ALL = """
import contextlib, io, json, sys
import gearfe
from gearfe.app.cli import main
said = []
for line in sys.argv[1:]:
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        code = main(line.split())
    if code:
        raise SystemExit(f"{line}: exit code {code}")
    said.append(out.getvalue())
frequencies = gearfe.natural_frequencies(gearfe.build_machine(gearfe.load_scene("my.toml")))[0]
print(json.dumps([said, list(frequencies)]))
"""


@pytest.fixture(scope="module")
def told(copy):
    """What the command of the copy prints by line, and the frequencies of its machine, all in one process."""
    said, frequencies = json.loads(python(copy, "-c", ALL, *LINES.values()))
    return dict(zip(LINES, said, strict=True)) | {"frequencies": frequencies}


def test_a_new_scene_and_its_check_know_them(copy, told):
    text = (copy / "my.toml").read_text(encoding="utf-8")
    assert "\n#[[band]]\n" in text
    assert "\n#quartic_um = " in text
    said = told["check"]
    assert "case banded: band 6 mm wide in the pinion's tooth 0; solved by ritz3d: bands change along the width" in said
    assert "flank of the pinion: quartic 10 um" in said
    assert "machine: turning_pair" in said


def test_closed_form_and_damage_are_compared(told):
    """A tooth pair of the closed form is two springs 4 / E and the contact 4 (1 - nu**2) / (pi E) over the width that is left."""
    said = told["compare"]
    columns = [one.strip() for one in next(line for line in said.splitlines() if "| estimate |" in line).split("|")[1:-1]]
    assert columns[-2] == "equal [N/um]"
    left = (20 - 6) / 20
    k = 1e-3 * 20 * STEEL.E / (8 + 4 * (1 - STEEL.nu**2) / math.pi / left)
    assert_allclose(table(said, "single", "errors against ritz3d")[-2], k, rtol=2e-4)
    healthy, banded, loss, doubt, *_ = table(said, "single", "loss of stiffness")
    assert 0 < doubt < loss < 100 * (1 - left)
    assert banded < healthy
    ours, theirs = ([table(told[case], row) for row in ("single", "double", "mean", "max")] for case in ("banded", "spalled"))
    assert ours == theirs  # a band is a spall as high as the tooth
    assert all(damaged < healthy for healthy, damaged, _ in ours)


def test_flank_modification_bends_the_unloaded_error(told):
    """The least that the flanks lack where a pair of teeth could touch, r; they touch beside it, where less is gone.

    Beside it by s along the flank the gap is ``r + r' s + s**2 / (2 rho)``, least ``r - r'**2 rho / 2``.
    """
    gear = PAIR.gear_1
    places = np.arange(32) / 32 + np.arange(2)[:, None]
    roll = PAIR.path[0] + places * PAIR.p_bt
    p, rate = 2 * (roll - gear.roll_f) / (gear.roll_a - gear.roll_f) - 1, 2 / (gear.roll_a - gear.roll_f)
    slope = 0.01 * 4 * p**3 * rate * gear.r_b / roll
    lacks = 0.01 * p**4 - slope**2 * PAIR.relative_radius(roll, PAIR.mate_roll(roll)) / 2
    least = np.where(places < PAIR.eps_alpha, lacks, np.inf).min(axis=0)
    assert_allclose(table(told["bent"], "unloaded")[0], 1e3 * np.ptp(least), atol=1e-3)


def test_format_holds_the_curve_and_machine_has_its_frequencies(copy, told):
    """The natural frequencies of the new machine are those of two discs, a shaft and the mean of the curve in the new file."""
    head, *lines = (copy / "k.tsv").read_text(encoding="utf-8").splitlines()
    k = np.array([line.split("\t") for line in lines], dtype=float)[:, head.split("\t").index("k [N/m]")].mean()
    row = 1e-3 * np.array([PAIR.gear_1.r_b, PAIR.gear_2.r_b])
    inertia = np.diag([gf.gear_member(gear, 7850.0, 0.0).inertia for gear in (PAIR.gear_1, PAIR.gear_2)])
    squares = eigh(k * np.outer(row, row) + np.diag([1e5, 0.0]), inertia, eigvals_only=True)
    assert_allclose(told["frequencies"], np.sqrt(squares) / (2 * math.pi), rtol=1e-3)


@pytest.mark.slow
def test_machine_vibrates(copy):
    """In the compiled integrator, which a copy of the code compiles anew."""
    said = gearfe(copy, "dynamics", "my.toml", "--duration", "0.02", "--channel", "one.theta acceleration")
    assert len(table(said.replace("[Hz]", ""), "natural frequencies")) == 2
    assert "one.theta acceleration, amplitude of the lines" in said
    assert_allclose(table(said, "mesh frequency", "amplitude of the lines")[0], 1500 / 60 * 21)


@pytest.mark.slow
def test_contact_law_runs_in_both_integrators(copy):
    """They agree, also beside a mesh of another law; a mass that strikes it returns as the closed form says."""
    told = json.loads(python(copy, "-W", "ignore", "-c", LAW))
    assert min(told["lost"]) > 3
    assert max(told["apart"]) < 1e-5
    loss = 3 * (1 - 0.95**2) / 4  # times the speed: with v' = -force, v dv / (1 + loss v) is the same on the way in and out

    def spent(v):
        return v / loss - math.log(1 + loss * v) / loss**2

    assert_allclose(told["left"], brentq(lambda v: spent(-v) - spent(1.0), 0.5, 1.0), rtol=1e-4)
