import math
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import gearfe as gf
from gearfe.cli import main
from gearfe.energy import textbook
from gearfe.hertz import linear_hertz
from gearfe.own_model import own_curve, own_models
from validation import own_model as example

SCENE = gf.load_scene("planetary_pitting")
CHOSEN = SCENE.pair()
PAIR, WIDTH = CHOSEN.pair, 20e-3  # m
LEAVES = PAIR.eps_alpha % 1.0
N = 100
PHASE = np.arange(N) / N
STEP = np.where(PHASE <= LEAVES, 4.0e8, 2.5e8)


def by_textbook(phases, **options):
    return gf.mesh_stiffness(PAIR, CHOSEN.force, CHOSEN.materials, method="textbook", phases=phases, **options)


def textbook_pair(radius_1, radius_2):
    """Of one tooth pair [N/m], written as a user would: from radii."""
    flexibility = linear_hertz(CHOSEN.materials)
    for gear, material, radius in zip((PAIR.gear_1, PAIR.gear_2), CHOSEN.materials, (radius_1, radius_2), strict=True):
        flexibility = flexibility + textbook.components(gear, material, np.sqrt(radius**2 - gear.r_b**2)).total
    return 1e3 * PAIR.gear_1.b / flexibility


def curve_of(model, phases=50, name="mine"):
    return own_curve(name, own_models({name: model})[name], PAIR, by_textbook(phases))


def write(path, header, x, k, *, separator=",", end="\n"):
    rows = [f"{float(a)!r}{separator}{float(b)!r}" for a, b in zip(x, k, strict=True)]
    path.write_bytes(end.join([*header, *rows, ""]).encode())
    return path


# functions


def test_total_function_gives_the_textbooks_curve():
    want = by_textbook(64)
    got = own_curve("mine", lambda phase: by_textbook(phase).k, PAIR, want)
    assert_allclose(got.k, want.k, rtol=1e-12)
    assert_allclose(got.lte, want.lte, rtol=1e-12)
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
    sine = PAIR.a * math.sin(PAIR.alpha_w)  # both touch in one point of the line of action
    assert_allclose(
        np.sqrt(seen[1][0] ** 2 - PAIR.gear_1.r_b**2) + np.sqrt(seen[1][1] ** 2 - PAIR.gear_2.r_b**2), sine, rtol=1e-12
    )


def test_a_function_may_change_what_it_is_given():
    def total(phase):
        phase += 1
        return 3e8 * phase

    assert_allclose(curve_of(total, [0.0, 0.5]).k, [3e8, 4.5e8], rtol=1e-15)


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda phase: 3e8, r"'mine' returned an array of shape \(\), but give \(50,\).*numpy.vectorize"),
        (lambda phase: np.full((50, 1), 3e8), r"shape \(50, 1\)"),
        (lambda phase: 3e8 if phase < 0.6 else 2e8, "'mine' failed: .*ambiguous.*numpy.vectorize"),
        (lambda: 3e8, "'mine' failed: .*positional argument"),
        (lambda phase: np.where(phase == 0.5, np.nan, 3e8), "returned k = nan N/m at phase 0.5, but"),
        (lambda phase: np.where(phase < 0.5, 3e8, -1.0), "returned k = -1 N/m at phase 0.5, but k must be finite and positive"),
        (lambda phase: np.full(50, 3e8 + 1j), "complex128, but k is a real number"),
        (lambda phase: ["stiff"] * 50, "but k is a real number"),
        (gf.PairModel(lambda r, s: np.where(r > 22.9, np.inf, 2e8)), r"k = inf N/m at radius_1 = 22.9\d* mm, radius_2 = \d"),
        (gf.PairModel(lambda radius: radius), "failed: .*positional argument"),
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

    models = own_models([mine, gf.PairModel(textbook_pair), lambda phase: phase, str(example.EXAMPLE)])
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


# files


@pytest.mark.parametrize(
    ("unit", "factor"),
    [
        ("k [N/m]", 1.0),
        ("K (N/m)", 1.0),
        ("mesh stiffness [N/mm]", 1e3),
        ("k [N/um]", 1e6),
        ("k [N/µm]", 1e6),
        ("k [N/μm]", 1e6),
        ("k [kN/mm]", 1e6),
        ("k[MN/m]", 1e6),
        ("k [GN/m]", 1e9),
        ("c [N/(mm um)]", 1e9 * WIDTH),
        ("c (N/(mm um))", 1e9 * WIDTH),
        ("c [N/(um·mm)]", 1e9 * WIDTH),
        ("c [N/mm/µm]", 1e9 * WIDTH),
        ("c [N/(m um)]", 1e6 * WIDTH),
        ("k_N_per_m", 1.0),
        ("k_N_per_mm", 1e3),
        ("k_mesh_N_per_um", 1e6),
        ("k_GN_per_m", 1e9),
        ("c_N_per_mm_um", 1e9 * WIDTH),
        ("c_N_per_m_per_um", 1e6 * WIDTH),
    ],
)
def test_stiffness_units(tmp_path, unit, factor):
    path = write(tmp_path / "k.csv", [f"phase,{unit}"], PHASE, STEP / factor)
    assert_allclose(curve_of(path, PHASE).k, STEP, rtol=1e-14)


@pytest.mark.parametrize(
    ("name", "cycle"),
    [
        ("phase", 1),
        ("Phase [-]", 1),
        ("phase [1]", 1),
        ("angle [deg]", 360 / 21),
        ("angle_deg", 360 / 21),
        ("roll angle [rad]", 2 * math.pi / 21),
        ("Pinion angle (rad)", 2 * math.pi / 21),
        ("pinion_angle_rad", 2 * math.pi / 21),
    ],
)
def test_abscissae_of_a_cycle(tmp_path, name, cycle):
    path = write(tmp_path / "k.csv", [f"{name};k [N/m]"], cycle * PHASE, STEP, separator=";")
    assert_allclose(curve_of(path, PHASE).k, STEP, rtol=1e-14)


@pytest.mark.parametrize("name", ["radius [mm]", "radius_mm", "Pinion radius (mm)", "contact_radius_mm"])
def test_table_of_one_pair(tmp_path, name):
    low, high = np.hypot(PAIR.gear_1.r_b, PAIR.path)
    radius = np.linspace(low, high, 60)
    path = write(tmp_path / "k.csv", [f"{name}\tk [N/um]"], radius, 200 + 3 * radius, separator="\t")
    got = curve_of(path, 64)
    want = curve_of(gf.PairModel(lambda r, _: 1e6 * (200 + 3 * r)), 64)
    assert_allclose(got.k, want.k, rtol=1e-12, err_msg="linear in between")
    assert_allclose(got.share, want.share, rtol=1e-12)
    wide = write(tmp_path / "c.csv", ["radius [mm],c [N/(mm um)]"], radius, (200 + 3 * radius) / 20)
    assert_allclose(curve_of(wide, 64).k, want.k, rtol=1e-12)
    for cut, message in (
        (slice(3, None), r"do not cover the active flank of the pinion, 19.86\d* to 23 mm"),
        (slice(None, -3), "do not cover"),
        (slice(None, None, 59), "rows are up to 3.13.* mm apart; sample every 0.15"),
    ):
        short = write(tmp_path / "s.csv", ["radius [mm],k [N/m]"], radius[cut], 1e6 * radius[cut])
        with pytest.raises(ValueError, match=message):
            curve_of(short)


@pytest.mark.parametrize(
    "header",
    [
        ["phase,k [N/m]"],
        ["# by hand, 2024", "", '"phase","k [N/m]"', "% all of it"],
        ["# phase,k [N/m]", "# by hand, 2024"],
        ["%phase;k_N_per_m"],
        ["\ufeffphase,k [N/m]"],
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_headers_and_line_ends(tmp_path, header, end):
    path = write(tmp_path / "k.csv", header, PHASE, STEP, end=end)
    assert_allclose(curve_of(path, PHASE).k, STEP, rtol=1e-15)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "k.csv: no rows of numbers"),
        ("# phase,k [N/m]\n", "no rows of numbers"),
        ("0,3e8\n0.01,3e8\n", "no header with units above the numbers '0, 3e8'; write one, for example 'phase,k"),
        ("phase,k\n0,1\n", "second column 'k' states no known unit of stiffness; use k .* N/m, N/mm"),
        ("phase,k [N m]\n0,1\n", "no known unit"),
        ("phase,k [N/s]\n0,1\n", "no known unit"),
        ("phase,k_N_m_\n0,1\n", "no known unit"),
        ("angle,k [N/m]\n0,1\n", "first column 'angle', but it must be 'phase' .* 'angle .deg.'"),
        ("phase [deg],k [N/m]\n0,1\n", r"first column 'phase \[deg\]'"),
        ("time [s],k [N/m]\n0,1\n", r"first column 'time \[s\]'"),
        ("wheel angle [rad],k [N/m]\n0,1\n", "first column 'wheel angle"),
        ("radius [m],k [N/m]\n0,1\n", "first column 'radius"),
        ("phase k [N/m]\n0 1\n", "1 columns .phase k .N/m.., but give two, separated by comma"),
        ("phase,k [N/m],error\n0,1,2\n", "3 columns"),
        ("phase,k [N/m]\n0,1\n0.1\n", "k.csv, line 3: '0.1' is not a row of two numbers"),
        ("phase,k [N/m]\n0,1\n\n# end\n0.1,x\n", "line 5: '0.1; x' is not a row"),
        ("phase;k [N/m]\n0;1\n0,1;3,2E+08\n", "line 3: .*use a decimal point"),
        ("phase,k [N/m]\n0,nan\n", "line 2: 0, nan: both must be finite"),
        ("phase,k [N/m]\n0,1\ninf,1\n", "line 3: inf, 1: both must be finite"),
        ("phase,k [N/m]\n0,1\n0.1,0\n", "line 3: 0.1, 0: .*k positive"),
        ("phase,k [N/m]\n0,1\n0,1\n", "line 3: the first column must rise, but 0 follows 0"),
        ("phase,k [N/m]\n1,1\n0.5,1\n", "must rise, but 0.5 follows 1"),
        ("phase,k [N/m]\n0,1\n", "1 rows of numbers"),
        ("# phase_offset = a\nphase,k [N/m]\n0,1\n1,1\n", "phase_offset = 'a', but give a finite number"),
        ("# phase_offset = 1\n# offset: 2\nphase,k [N/m]\n0,1\n1,1\n", "phase_offset is given 2 times"),
        ("# phase_offset = 1\nradius [mm],k [N/m]\n0,1\n1,1\n", "a table over the radius has no phase"),
    ],
)
def test_refused_files(tmp_path, text, message):
    path = tmp_path / "k.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        gf.read_model(path)


def test_unreadable_files(tmp_path):
    with pytest.raises(ValueError, match=r"cannot read the model .*none.csv: No such file"):
        gf.read_model(tmp_path / "none.csv")
    (tmp_path / "k.mat").write_bytes(b"MATLAB 5.0 \xff\xfe")
    with pytest.raises(ValueError, match=r"k.mat is not text in UTF-8: export the curve as CSV"):
        gf.read_model(tmp_path / "k.mat")


@pytest.mark.parametrize(
    ("x", "message"),
    [
        (np.linspace(0, 0.6, 61), "angles 0 to 10.2857 deg cover 0.6 mesh cycles, but one is needed: 0 to 17.1429 deg"),
        (np.linspace(0, PAIR.eps_alpha, 99), r"cover 1.615 mesh cycles: keep the rows of one, for example 0 to 17.1429 deg"),
        (np.linspace(0, 1, 17), "rows are up to 0.0625 of a mesh cycle apart; sample every 0.8571 deg or finer"),
        (np.delete(np.linspace(0, 1, 101), range(30, 36)), "rows are up to 0.07 of a mesh cycle apart"),
    ],
)
def test_refused_cycles(tmp_path, x, message):
    path = write(tmp_path / "k.csv", ["angle [deg],k [N/m]"], x * 360 / 21, np.full(x.size, 3e8))
    with pytest.raises(ValueError, match=message):
        curve_of(path)


def test_a_jump_is_not_smeared(tmp_path):
    """Rows of a square wave, compared where no row is: every value must be one of its two levels, on the right side."""
    asked = np.linspace(0, 1, 1000, endpoint=False)
    want = np.where(asked <= LEAVES, 4.0e8, 2.5e8)
    for n in (21, 64, 101):
        x = np.linspace(0.003, 0.003 + 1, n)
        path = write(tmp_path / "k.csv", ["phase,k [N/m]"], x, np.where(x % 1 <= LEAVES, 4.0e8, 2.5e8))
        assert_allclose(curve_of(path, asked).k, want, rtol=1e-15, err_msg=f"{n} rows")


def test_a_short_zone_needs_a_row(tmp_path):
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0, "addendum": 0.59}
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    reference = gf.mesh_stiffness(pair, 2000.0, CHOSEN.materials, method="textbook")
    assert 1.01 < pair.eps_alpha < 1.03
    x = 0.04 + np.arange(20) / 20
    path = write(tmp_path / "k.csv", ["phase,k [N/m]"], x, np.full(20, 3e8))
    with pytest.raises(ValueError, match=r"no row from phase 0 to 0.0\d*, where another number of pairs is in contact"):
        own_curve("mine", gf.read_model(path), pair, reference)


def test_between_rows_k_is_linear_and_never_leaves_their_range(tmp_path):
    asked = np.linspace(0, 1, 777, endpoint=False)
    k = by_textbook(PHASE).k
    got = curve_of(write(tmp_path / "k.csv", ["phase,k [N/m]"], PHASE, k), asked).k
    assert_allclose(got, by_textbook(asked).k, rtol=2e-3)
    assert k.min() <= got.min()
    assert got.max() <= k.max()
    halfway = curve_of(tmp_path / "k.csv", [0.205]).k[0]
    assert halfway == pytest.approx((k[20] + k[21]) / 2, rel=1e-14)


def test_both_ends_of_a_cycle_may_be_given_and_rounded(tmp_path):
    x = np.round(np.linspace(0, 360 / 21, N + 1), 3)
    for last in (STEP[0], STEP[-1]):  # 0.9999 of a cycle: whichever side of the jump the user means
        path = write(tmp_path / "k.csv", ["angle [deg],k [N/m]"], x, np.append(STEP, last))
        assert_allclose(curve_of(path, [0.0, 0.3, 0.97, 0.985, 0.995]).k, [4e8, 4e8, 2.5e8, 2.5e8, 2.5e8], rtol=1e-15)


@pytest.mark.parametrize("line", ["# phase_offset = 0.25", "% Phase offset: 0.25", None])
def test_phase_offset(tmp_path, line):
    shifted = np.where((PHASE + 0.25) % 1 <= LEAVES, 4.0e8, 2.5e8)  # the file's zero is at phase 0.25
    path = write(tmp_path / "k.csv", [*([line] if line else []), "angle [deg],k [N/m]"], PHASE * 360 / 21, shifted)
    model = path if line else gf.read_model(path, phase_offset=0.25)
    assert_allclose(curve_of(model, PHASE).k, STEP, rtol=1e-14)


def test_wrong_origin_is_hinted_at_with_its_remedy(tmp_path):
    shifted = np.where((PHASE + 0.25) % 1 <= LEAVES, 4.0e8, 2.5e8)
    path = write(tmp_path / "k.csv", ["phase,k [N/m]"], PHASE, shifted)
    with pytest.warns(UserWarning, match="rises most steeply at phase 0.75, .* '# phase_offset = 0.25'"):
        curve_of(path)
    half = write(tmp_path / "h.csv", ["# phase_offset = 0.1", "phase,k [N/m]"], PHASE, shifted)
    with pytest.warns(UserWarning, match="at phase 0.85, .* '# phase_offset = 0.25'"):
        curve_of(half)


def test_a_curve_written_by_gearfe(tmp_path):
    want = by_textbook(64)
    want.to_csv(tmp_path / "k.csv")
    assert_array_equal(curve_of(tmp_path / "k.csv", 64).k, want.k)
    other = gf.mesh_stiffness(PAIR, 3000.0, CHOSEN.materials, method="textbook")
    other.to_csv(tmp_path / "f.csv")
    with pytest.warns(UserWarning, match=r"f.csv was computed for another force_N than"):
        curve_of(tmp_path / "f.csv", 64)
    by_textbook(64, span="tooth").to_csv(tmp_path / "t.csv")
    with pytest.raises(ValueError, match=r"keep the rows of one, for example -0\.25 to 0\.75"):
        curve_of(tmp_path / "t.csv")


def test_own_curves_are_saved_and_read_again(tmp_path):
    for model in (lambda phase: by_textbook(phase).k, gf.PairModel(textbook_pair)):
        before = curve_of(model)
        before.to_csv(tmp_path / "k.csv")
        before.save(tmp_path / "k.json")
        after = gf.StiffnessCurve.from_csv(tmp_path / "k.csv")
        assert_array_equal(after.force, before.force)
        assert after.meta == before.meta


# the comparison, and the example of MATLAB


def test_matlab_example_is_the_textbooks_curve():
    data = example.EXAMPLE.read_bytes()
    assert data.startswith(b"phase,k_N_per_m\r\n0,")
    assert data.count(b"\r\n") == example.ROWS + 1
    want = by_textbook(np.arange(example.ROWS) / example.ROWS)
    assert_allclose(gf.read_model(example.EXAMPLE).k, want.k, rtol=1e-12, err_msg="remake: python -m validation own_model")


def test_compare_gives_the_textbooks_error_row():
    models = {"file": example.EXAMPLE, "total": lambda phase: by_textbook(phase).k, "pairs": gf.PairModel(textbook_pair)}
    result = gf.compare(SCENE, models=models, phases=32, refine=0.5)
    assert list(result.curves) == ["fe", "textbook", "published", "file", "total", "pairs"]
    assert result.seconds.keys() == result.curves.keys()
    for _, _, _, others in result.rows():
        for name, tolerance in (("file", 1e-9), ("total", 1e-12), ("pairs", 1e-12)):
            assert_allclose(others[name], others["textbook"], rtol=tolerance, err_msg=name)
    assert result.table().splitlines()[0].endswith("| file [N/m] | error | total [N/m] | error | pairs [N/m] | error |")


def test_own_models_of_a_ring():
    chosen = SCENE.pair("planet_ring")
    result = gf.compare(SCENE, "planet_ring", models=[gf.PairModel(lambda r, s: np.full(r.size, 2e8))], phases=8, refine=0.5)
    inside = result.reference.phase <= chosen.pair.eps_alpha - 1
    assert_allclose(result.curves["model 1"].k, np.where(inside, 4e8, 2e8), rtol=1e-15)


def test_command_line(tmp_path, capsys):
    mine = write(tmp_path / "mine.csv", ["angle_deg,c_N_per_mm_um"], PHASE * 360 / 21, STEP / 1e9 / WIDTH)
    plot = tmp_path / "all.svg"
    options = ["--phases", "16", "--refine", "0.5", "--plot", str(plot)]
    assert main(["compare", "planetary_pitting", *options, "--model", str(mine), "--model", str(example.EXAMPLE)]) == 0
    text = capsys.readouterr().out
    assert "| mine [N/m] | error | matlab_curve [N/m] | error |" in text
    cells = {line.split("|")[1].strip(): line.split("|")[2:-1] for line in text.splitlines() if line.startswith("| ")}
    assert float(cells["double"][6]) == 4e8
    assert float(cells["single"][6]) == 2.5e8
    assert cells["mean"][8:] == cells["mean"][2:4], "as the textbook, which the example is"
    assert "matlab_curve" in plot.read_text()


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
    from gearfe.render import plot_curves

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = plot_curves({"textbook": by_textbook(50), "mine": curve_of(lambda phase: 3e8 + 0 * phase)})
    lines = {line.get_label(): line.get_ydata() for line in figure.axes[0].lines}
    assert_allclose(lines["mine"], 0.3, rtol=1e-14)
