import math

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from own_curves import CHOSEN, LEAVES, PAIR, PHASE, STEP, WIDTH, by_textbook, write
from remake import EXAMPLE, ROWS
from scipy.io import savemat

import gearfe as gf
from gearfe.comparison.own_model import own_curve, own_models


def curve_of(model, phases=50):
    """Of a ModelFile, a function, or the path of a file."""
    return own_curve("mine", gf.read_model(model) if hasattr(model, "suffix") else model, PAIR, by_textbook(phases))


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
        ["# phase,k [GN/m]", "# now phase and k in SI:", "# phase,k [N/m]"],
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
        ("0,3e8\n0.01,3e8\n", "no header with units above the numbers '0, 3e8'; write one, for example 'phase,k"),
        ("phase,k\n0,1\n", "second column 'k' states no known unit of stiffness; use k .* N/m, N/mm"),
        ("phase,k [N/s]\n0,1\n", "no known unit"),
        ("angle,k [N/m]\n0,1\n", "first column 'angle', but it must be 'phase' .* 'angle .deg.'"),
        ("phase [deg],k [N/m]\n0,1\n", r"first column 'phase \[deg\]'"),
        ("time [s],k [N/m]\n0,1\n", r"first column 'time \[s\]'"),
        ("radius [m],k [N/m]\n0,1\n", "first column 'radius"),
        ("phase k [N/m]\n0 1\n", "1 columns .phase k .N/m.., but give two, separated by comma"),
        ("phase,k [N/m],error\n0,1,2\n", "3 columns"),
        ("phase,k [N/m]\n0,1\n0.1\n", "k.csv, line 3: '0.1' is not a row of two numbers"),
        ("phase,k [N/m]\n0,1\n\n# end\n0.1,x\n", "line 5: '0.1; x' is not a row"),
        ("phase,k [N/m]\n0,0,3\n", "line 2: .*separate columns by ;"),
        ("phase,k [N/m]\n0,nan\n", "line 2: 0, nan: both must be finite"),
        ("phase,k [N/m]\n0,1\n0.1,0\n", "line 3: 0.1, 0: .*k positive"),
        ("phase,k [N/m]\n0,1\n0,1\n", "line 3: the first column must rise, but 0 follows 0"),
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
    with pytest.raises(ValueError, match=r"cannot read .*none.csv: No such file"):
        gf.read_model(tmp_path / "none.csv")
    (tmp_path / "k.mat").write_bytes(b"MATLAB 5.0 \x00\x01IM\xff\xfe")
    with pytest.raises(ValueError, match=r"k.mat is not a MATLAB file, or a damaged one"):
        gf.read_model(tmp_path / "k.mat")


@pytest.mark.parametrize(
    ("x", "message"),
    [
        (np.linspace(0, 0.6, 61), "angles 0 to 10.2857 deg cover 0.6 mesh cycles, but one is needed: 0 to 17.1429 deg"),
        (np.linspace(0, 0.97, 98), "cover 0.97 mesh cycles, but one is needed"),
        (np.linspace(0.5, 1.7, 99), r"phases 0.5 to 1.7, but 0 to 0.98 are needed; give them all, or keep the rows of one"),
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
    x = np.round(np.linspace(0, 360 / 21, 101), 3)
    for last in (STEP[0], STEP[-1]):  # 0.9999 of a cycle: whichever side of the jump the user means
        path = write(tmp_path / "k.csv", ["angle [deg],k [N/m]"], x, np.append(STEP, last))
        assert_allclose(curve_of(path, [0.0, 0.004, 0.3, 0.97, 0.985, 0.995]).k, [4e8, 4e8, 4e8, 2.5e8, 2.5e8, 2.5e8], rtol=1e-15)


@pytest.mark.parametrize("line", ["# phase_offset = 0.25", "% Phase offset: 0.25", None])
def test_phase_offset(tmp_path, line):
    shifted = by_textbook(PHASE + 0.25).k  # the file's zero is at phase 0.25
    path = write(tmp_path / "k.csv", [*([line] if line else []), "angle [deg],k [N/m]"], PHASE * 360 / 21, shifted)
    model = path if line else gf.read_model(path, phase_offset=0.25)
    assert_allclose(curve_of(model, PHASE).k, by_textbook(PHASE).k, rtol=1e-11)


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
    assert_array_equal(curve_of(tmp_path / "t.csv", 64).k, want.k)


def test_matlab_example_is_the_textbooks_curve():
    data = EXAMPLE.read_bytes()
    assert data.startswith(b"phase,k_N_per_m\r\n0,")
    assert data.count(b"\r\n") == ROWS + 1
    want = by_textbook(np.arange(ROWS) / ROWS)
    assert_allclose(gf.read_model(EXAMPLE).k, want.k, rtol=1e-12, err_msg="python -m tests.remake own_model")


def test_decimal_commas_and_matlab_vectors_are_the_same_curve(tmp_path):
    angle = 360 / PAIR.gear_1.z * PHASE
    rows = "".join(f"{x!r};{k!r}\n".replace(".", ",") for x, k in zip(angle.tolist(), (STEP / 1e6).tolist(), strict=True))
    (tmp_path / "k.csv").write_text(f"theta_deg;k_N_per_um\n{rows}")
    savemat(tmp_path / "k.mat", {"theta_deg": angle, "k_N_per_um": STEP / 1e6, "torque": 3.0})
    for name in ("k.csv", "k.mat"):
        assert_allclose(curve_of(tmp_path / name, PHASE).k, STEP, rtol=1e-14)


def test_a_comma_in_the_name_of_a_file_parts_nothing(tmp_path):
    file = tmp_path / "run 3,5.csv"
    file.write_text("phase,k [N/um]\n" + "".join(f"{x},{300 + x}\n" for x in np.linspace(0, 1, 33)))
    assert list(own_models([str(file)])) == list(own_models([file]))
    with pytest.raises(ValueError, match="has 3 parts"):
        own_models({"mine": "a.csv,b.csv,c.csv"})


@pytest.mark.slow
def test_a_cracked_curve_of_gearfe_loses_what_gearfe_finds(tmp_path):
    scene = gf.load_scene("compound_planetary")
    case, pair = next(iter(scene.pair().damage)), next(iter(scene.pairs))
    cycle = gf.compare(scene, pair, case=case, phases=16)
    chosen = {"healthy": scene.case(pair), case: scene.case(pair, case)}
    for name, suffix in (("healthy", "mat"), (case, "csv")):
        phases = np.linspace(-0.5, 2.5, 97)
        gf.solve(chosen[name], gf.Solve("fe", phases)).save(tmp_path / f"{name}.{suffix}")
    with_own = gf.compare(scene, pair, case=case, phases=16, models=[f"{tmp_path}/{case}.csv,{tmp_path}/healthy.mat"])
    found = with_own.losses()
    for zone, lost in cycle.losses()["fe"].items():
        assert_allclose(found[case][zone], lost, atol=2e-4, err_msg=zone)


@pytest.mark.slow
def test_a_pair_model_of_the_damaged_tooth_counts_for_that_tooth_alone():
    healthy, half = (gf.PairModel(lambda r_1, r_2, k=k: np.full(r_1.shape, k)) for k in (2e8, 1e8))
    scene = gf.load_scene("compound_planetary")
    found = gf.compare(scene, case=next(iter(scene.pair().damage)), phases=16, models={"mine": (half, healthy)})
    lost = found.losses()["mine"]
    assert_allclose([lost["single"], lost["double"]], [0.5, 0.25], rtol=1e-12)
    with pytest.raises(ValueError, match="state the case of damage"):
        gf.compare(scene, phases=16, models={"mine": (half, healthy)})
