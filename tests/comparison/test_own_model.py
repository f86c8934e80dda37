import math
import re
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from own_curves import CHOSEN, LEAVES, PAIR, PHASE, STEP, WIDTH, by_textbook, write
from remake import EXAMPLE

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.compare import FORMULATIONS
from gearfe.comparison.own_model import own_curve, own_models
from gearfe.flexibility.energy.closed import textbook
from gearfe.flexibility.hertz import linear_hertz

SCENE = gf.load_scene("planetary_pitting")


def textbook_pair(radius_1, radius_2):
    """Of one tooth pair [N/m], written as a user would: from radii."""
    flexibility = linear_hertz(CHOSEN.materials)
    for gear, material, radius in zip((PAIR.gear_1, PAIR.gear_2), CHOSEN.materials, (radius_1, radius_2), strict=True):
        flexibility = flexibility + textbook.components(gear, material, np.sqrt(radius**2 - gear.r_b**2)).total
    return 1e3 * PAIR.gear_1.b / flexibility


def curve_of(model, phases=50, name="mine"):
    return own_curve(name, own_models({name: model})[name], PAIR, by_textbook(phases))


def test_total_function_gives_the_textbooks_curve():
    want = by_textbook(64)
    got = own_curve("mine", lambda phase: by_textbook(phase).k, PAIR, want)
    assert_allclose(got.k, want.k, rtol=1e-12)
    assert_allclose(got.deflection, want.deflection, rtol=1e-12)
    assert_array_equal(got.k_tangent, got.k)
    assert_array_equal(got.order, want.order)
    assert np.isnan(got.force[want.force > 0]).all(), "a total says nothing of the shares"
    assert np.isnan(got.pressure).all()
    assert got.meta["method"] == "mine"
    assert got.zones() == pytest.approx(want.zones(), rel=1e-12)


@pytest.mark.parametrize("phases", [64, np.linspace(-1.2, 2.3, 41)])
def test_pair_function_gives_the_textbooks_curve_and_shares(phases):
    want = by_textbook(phases)
    got = own_curve("mine", gf.PairModel(textbook_pair), PAIR, want)
    assert_allclose(got.k, want.k, rtol=1e-12)
    assert_allclose(got.force, want.force, rtol=1e-12)
    assert_array_equal(got.order, want.order)


def test_functions_see_phases_of_one_cycle_and_radii_of_the_active_flank():
    seen = []

    def total(phase):
        seen.append(phase)
        return np.full(phase.shape, 3e8)

    def single(radius_1, radius_2):
        seen.append((radius_1, radius_2))
        return np.full(radius_1.shape, 2e8)

    asked = np.array([-1e-17, -0.25, 0.5, 1.0, 2.75])
    curve_of(total, asked)
    assert_array_equal(seen[0], [0.0, 0.75, 0.5, 0.0, 0.75])
    curve_of(gf.PairModel(single), [0.0, 0.3, LEAVES])
    for radius, gear in zip(seen[1], (PAIR.gear_1, PAIR.gear_2), strict=True):
        assert radius.ndim == 1
        assert radius.max() == pytest.approx(gear.r_a, rel=1e-9)
        assert radius.min() > gear.r_b
    sine = PAIR.a * math.sin(PAIR.alpha_wt)  # both touch in one point of the line of action
    assert_allclose(
        np.sqrt(seen[1][0] ** 2 - PAIR.gear_1.r_b**2) + np.sqrt(seen[1][1] ** 2 - PAIR.gear_2.r_b**2), sine, rtol=1e-12
    )


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda phase: 3e8, r"'mine' returned an array of shape \(\), but give \(50,\).*numpy.vectorize"),
        (lambda phase: 3e8 if phase < 0.6 else 2e8, "'mine' failed with ValueError: .*ambiguous.*numpy.vectorize"),
        (lambda: 3e8, "'mine' failed with TypeError: .*positional argument"),
        (lambda phase: np.where(phase == 0.5, np.nan, 3e8), "returned k = nan N/m at phase 0.5, but"),
        (lambda phase: np.where(phase < 0.5, 3e8, -1.0), "returned k = -1 N/m at phase 0.5, but k must be finite and positive"),
        (lambda phase: 1 // 0, "'mine' failed with ZeroDivisionError"),
        (lambda phase: np.full(50, 3e8 + 1j), "complex128, but k is a real number"),
        (gf.PairModel(lambda r, s: np.where(r > 22.9, np.inf, 2e8)), r"k = inf N/m at radius_1 = 22.9\d* mm, radius_2 = \d"),
    ],
)
def test_refused_functions(function, message):
    with pytest.raises(ValueError, match=message):
        curve_of(function)


def test_a_vectorised_scalar_function_is_taken():
    scalar = np.vectorize(lambda phase: 4.0e8 if phase <= LEAVES else 2.5e8)
    assert_array_equal(curve_of(scalar, PHASE).k, STEP)


def test_names():
    def mine(phase):
        return phase

    models = own_models([mine, gf.PairModel(textbook_pair), lambda phase: phase, str(EXAMPLE)])
    assert list(models) == ["mine", "textbook_pair", "model 3", "matlab_curve"]
    assert list(own_models({"a": mine, "b": mine})) == ["a", "b"]
    for given, message in (
        ([mine, mine], "'mine' stands for two models; rename"),
        ({"fe": mine}, "'fe' is a formulation of gearfe"),
        ([3.0], "'model 1' is float, but give f"),
        (mine, r"but give a list, models=\[...\]"),
        ("k.csv", "'k.csv', but give a list"),
    ):
        with pytest.raises(ValueError, match=message):
            own_models(given, taken=("fe",))
    with pytest.raises(ValueError, match=r"PairModel\(3\): give a function"):
        gf.PairModel(3)


def test_hint_at_a_wrong_unit():
    with pytest.warns(UserWarning, match="'mine' is 0.001 times the reference"):
        curve_of(lambda phase: 1e-3 * by_textbook(50).k)


def test_own_curves_are_saved_and_read_again(tmp_path):
    for model in (lambda phase: by_textbook(phase).k, gf.PairModel(textbook_pair)):
        before = curve_of(model)
        before.to_csv(tmp_path / "k.csv")
        before.save(tmp_path / "k.json")
        after = gf.StiffnessCurve.from_csv(tmp_path / "k.csv")
        assert_array_equal(after.force, before.force)
        assert after.meta == before.meta


@pytest.mark.slow
def test_compare_gives_the_textbooks_error_row():
    models = {"file": EXAMPLE, "total": lambda phase: by_textbook(phase).k, "pairs": gf.PairModel(textbook_pair)}
    result = gf.compare(SCENE, models=models, phases=32, refine=0.5)
    assert list(result.curves) == ["fe", *FORMULATIONS, "file", "total", "pairs"]
    assert result.seconds.keys() == result.curves.keys()
    for zone in ("single", "double", "mean", "max"):
        others = {row.method: (row.k, row.error) for row in result.rows() if row.zone == zone}
        for name, tolerance in (("file", 1e-9), ("total", 1e-12), ("pairs", 1e-12)):
            assert_allclose(others[name], others["textbook"], rtol=tolerance, err_msg=name)
    assert result.table().cells()[0][-6::2] == ["file [N/um]", "total [N/um]", "pairs [N/um]"]


@pytest.mark.slow
def test_own_models_of_a_ring():
    chosen = SCENE.pair("planet_ring")
    result = gf.compare(SCENE, "planet_ring", models=[gf.PairModel(lambda r, s: np.full(r.size, 2e8))], phases=8, refine=0.5)
    inside = result.reference.phase <= chosen.pair.eps_alpha - 1
    assert_allclose(result.curves["model 1"].k, np.where(inside, 4e8, 2e8), rtol=1e-15)


def test_command_line(tmp_path, capsys):
    mine = write(tmp_path / "mine.csv", ["angle_deg,c_N_per_mm_um"], PHASE * 360 / 21, STEP / 1e9 / WIDTH)
    plot = tmp_path / "all.svg"
    options = ["--phases", "16", "--refine", "0.5", "--plot", str(plot)]
    assert main(["compare", "planetary_pitting", *options, "--model", str(mine), "--model", str(EXAMPLE)]) == 0
    text = capsys.readouterr().out
    assert "| mine [N/um] | error | matlab_curve [N/um] | error |" in re.sub(r" +\|", " |", re.sub(r"\| +", "| ", text))
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if line.startswith("| ")]
    column = {name.removesuffix(" [N/um]"): k for k, name in enumerate(rows[0]) if name != "error"}
    cells = {row[0]: row for row in rows}
    assert float(cells["double"][column["mine"]]) == 400.0
    assert float(cells["single"][column["mine"]]) == 250.0
    own, textbook = column["matlab_curve"], column["textbook"]
    assert cells["mean"][own : own + 2] == cells["mean"][textbook : textbook + 2], "as the textbook, which the example is"
    assert "matlab_curve" in plot.read_text()


def test_functions_of_a_python_file(tmp_path, capsys):
    path = tmp_path / "models.py"
    path.write_text(
        "import numpy as np\nimport gearfe as gf\n\ndef flat(phase):\n    return np.full(phase.shape, 2.5e8)\n\n"
        "alone = gf.PairModel(lambda radius_1, radius_2: 2e8 + 0 * radius_1)\n"
    )
    found = gf.compare("planetary_pitting", models=[f"{path}:flat", f"{path}:alone"], phases=8, refine=0.5)
    assert_allclose(found.curves["flat"].k, 2.5e8, rtol=1e-15)
    assert_allclose(found.curves["alone"].zones()["single"], 2e8, rtol=1e-15)
    for name, said in (("", "it has flat, alone"), (":np", "no model 'np'"), (":none", "no model 'none'")):
        assert main(["compare", "planetary_pitting", "--model", f"{path}{name}"]) == 1
        assert said in capsys.readouterr().err
    path.write_text("1 / 0")
    for wrong, said in ((path, "failed with ZeroDivisionError"), (tmp_path / "none.py", "no such file")):
        with pytest.raises(ValueError, match=said):
            gf.compare("planetary_pitting", models=[f"{wrong}:flat"])


def test_command_line_names_the_file_that_is_wrong(tmp_path, capsys):
    path = write(tmp_path / "mine.csv", ["phase,k"], PHASE, STEP)
    assert main(["compare", "planetary_pitting", "--model", str(path)]) == 1
    assert "mine.csv: second column 'k' states no known unit" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["compare", "--help"])
    text = " ".join(capsys.readouterr().out.split())
    for word in ("--model FILE", "angle [deg]", "radius [mm]", "N/(mm um)", "0: a pair enters"):
        assert word in text


def test_own_models_are_drawn():
    from gearfe.figures.stiffness_plots import plot_curves

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = plot_curves({"textbook": by_textbook(50), "mine": curve_of(lambda phase: 3e8 + 0 * phase)})
    lines = {line.get_label(): line.get_ydata() for line in figure.axes[0].lines}
    assert_allclose(lines["mine"], 300.0, rtol=1e-14)
