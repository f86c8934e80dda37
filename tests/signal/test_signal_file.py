import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.io import savemat
from waves import noise

import gearfe as gf

ROWS = "\n".join(f"{i / 1000:.3f},{i * i}" for i in range(10))


@pytest.mark.parametrize(
    ("text", "rate", "unit"),
    [
        (f"time [s],a [m/s^2]\n{ROWS}\n", 1000.0, "m/s^2"),
        (f"# time [s],a (m/s^2)\n{ROWS}\n", 1000.0, "m/s^2"),
        (f"t [ms],a [g]\n{ROWS}\n", 1e6, "g"),
        ("time [s];a [N]\n" + ROWS.replace(",", ";"), 1000.0, "N"),
        ('"time [s]"\t"a [N]"\n' + ROWS.replace(",", "\t"), 1000.0, "N"),
        ("# rate = 61.44 kHz\n# unit: m/s^2\n" + "\n".join(str(i * i) for i in range(10)), 61440.0, "m/s^2"),
        ("% fs = 61440 Hz\na [N]\n" + "\n".join(str(i * i) for i in range(10)), 61440.0, "N"),
    ],
)
def test_csv(tmp_path, text, rate, unit):
    path = tmp_path / "x.csv"
    path.write_text(text, encoding="utf-8")
    signal = gf.read_signal(path)
    assert_array_equal(signal.values, np.arange(10.0) ** 2)
    assert_allclose(signal.rate, rate)
    assert signal.unit == unit


def test_csv_with_angle_and_several_columns(tmp_path):
    path = tmp_path / "run.csv"
    rows = "\n".join(f"{i / 64:.6f},{i * 15},{i},{2 * i}" for i in range(40))
    path.write_text(f"time [s],angle [deg],in [N],out [N]\n{rows}\n")
    signal = gf.read_signal(path, column="out")
    assert_array_equal(signal.values, 2.0 * np.arange(40))
    assert_allclose(signal.angle, np.radians(15.0 * np.arange(40)))
    assert signal.name == "run out"


def test_arguments_state_what_a_file_does_not(tmp_path):
    path = tmp_path / "bare.txt"
    path.write_text("1\n2\n4\n")
    signal = gf.read_signal(path, rate=8000, unit="m/s^2", shaft_frequency=41.67)
    assert (signal.rate, signal.unit, signal.shaft_frequency) == (8000.0, "m/s^2", 41.67)


def with_rows(rows, header="time [s],a [N]"):
    return header + "\n" + "\n".join(rows) + "\n"


EVEN = [f"{i / 1000:.3f},{i}" for i in range(20)]


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        (with_rows(EVEN, "a [N],b [N]"), {}, r"2 columns of values; it has 'a' \[N\], 'b' \[N\]: give one as column="),
        (with_rows(EVEN), {"column": "c"}, r"no column 'c'; it has 'a' \[N\]"),
        (with_rows(EVEN, "time [s],a"), {}, "no unit for 'a'; give one"),
        (with_rows(EVEN), {"unit": "g"}, "units N, g for 'a'; give one"),
        (with_rows(EVEN, "time,a [N]"), {}, r"column 'time' has no unit, but needs one of s, ms, us: call it 'time \[s\]'"),
        (with_rows(EVEN, "time [s],t [s]"), {}, "no column of values, only 'time' and 't'; rename one of them"),
        (with_rows(EVEN, "angle [turns],a [N]"), {"rate": 1}, "needs one of rad, deg"),
        (with_rows(["1", "2"], "a [N]"), {}, "states no sampling rate: add a column"),
        (with_rows(EVEN[:5] + EVEN[6:]), {}, r"sample \d+ at 0\.\d+ s does not fit a step"),
        (with_rows(EVEN[:1] + EVEN[2:]), {}, r"sample 1 at 0\.002 s does not fit"),
        (with_rows(EVEN[::-1]), {}, "times must rise"),
        (with_rows(["0,1", "nan,2", "2,3"]), {}, "time 1 is nan"),
        (with_rows(["0,1"]), {}, "1 times for 1 samples"),
        (with_rows(["0,1", "1,inf", "2,3"]), {}, "sample 1 is inf"),
        (with_rows(EVEN), {"rate": 2000}, "rate = 2000 Hz, but its times are 1000 Hz"),
        ("# rate = 5 Hz\n" + with_rows(["1", "2"], "a [N]"), {"rate": 6}, "rate is given as 6 and 5 Hz"),
        ("# rate = 5 rpm\n" + with_rows(["1", "2"], "a [N]"), {}, "rate = '5 rpm', but give a positive number of Hz"),
        ("# fs = -5\n" + with_rows(["1", "2"], "a [N]"), {}, "rate = '-5', but give a positive"),
        (with_rows(["0,1", "1,x"]), {}, r"line 3: '1,x' is not a row of 2 numbers"),
        (with_rows(["0,1", "1,2,3"]), {}, r"line 3: '1,2,3' is not a row of 2 numbers"),
        (with_rows(["0,5;1,5", "1;2.5"], "time [s];a [N]"), {}, r"line 3: '1;2\.5' is not a row of 2 numbers"),
        ("\n".join(EVEN), {}, "2 columns without names; give header="),
        (with_rows(EVEN, "a [N],a [g]"), {}, r"two columns have the same name"),
        ("# nothing\n", {}, "no rows of numbers"),
        ("# rate = 5\n# rate = 6\n" + with_rows(["1", "2"], "a [N]"), {}, "rate is stated twice, 5 and 6"),
        ("# run 3 (second try)\n1\n2\n", {"rate": 1}, "no unit for 'signal'"),
        ("a [N]\n", {"rate": 1}, "no rows of numbers"),
    ],
)
def test_csv_refusals(tmp_path, text, options, message):
    path = tmp_path / "x.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=message) as caught:
        gf.read_signal(path, **options)
    assert "x" in str(caught.value)


def test_matlab_and_numpy_files(tmp_path):
    x = noise(50)
    savemat(tmp_path / "a.mat", {"acc": x[:, None], "Fs": 5120.0, "unit": "m/s^2", "shaft_frequency": 11.7})
    np.savez(tmp_path / "a.npz", acc=x, time=np.arange(50) / 5120, angle=np.arange(50.0), unit="m/s^2", note="run 3")
    for suffix in ("mat", "npz"):
        signal = gf.read_signal(tmp_path / f"a.{suffix}")
        assert_array_equal(signal.values, x)
        assert_allclose(signal.rate, 5120.0)
        assert signal.unit == "m/s^2"
    assert signal.angle[-1] == 49.0
    assert gf.read_signal(tmp_path / "a.mat").shaft_frequency == 11.7


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"a": np.ones(9), "unit": "N"}, "states no sampling rate"),
        ({"a": np.ones(9), "fs": 3.0}, "no unit for 'a'"),
        ({"a": np.ones(9), "fs": 3.0, "rate": 4.0, "unit": "N"}, "rate is given as 3 and 4 Hz"),
        ({"a": np.ones((3, 3)), "fs": 3.0}, r"no vector of real numbers; it has 'a' \(float64\[3, 3\]: which side is time\?\)"),
        ({"a": np.ones(9), "b": np.ones(9), "fs": 3.0, "unit": "N"}, "2 columns of values; it has 'a', 'b'"),
        ({"a": np.ones(9), "time": np.arange(8.0), "unit": "N"}, "8 times for 9 samples"),
    ],
)
@pytest.mark.parametrize("suffix", ["mat", "npz"])
def test_array_file_refusals(tmp_path, arrays, message, suffix):
    path = tmp_path / f"x.{suffix}"
    np.savez(path, **arrays) if suffix == "npz" else savemat(path, arrays)
    with pytest.raises(ValueError, match=message):
        gf.read_signal(path)


def test_files_that_are_something_else(tmp_path):
    for name, content, message in (
        ("a.flac", b"fLaC", r"no format for '\.flac'; use one of \.csv, \.txt, \.npz, \.mat, \.h5"),
        ("a.npz", b"no archive at all", "is not a numpy archive"),
        ("a.mat", b"no matlab file, but long enough to hold a header " * 5, "is not a MATLAB file"),
        (
            "b.mat",
            b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM" + b"\x89HDF",
            "but holds no HDF5: it is damaged",
        ),
        ("a.csv", b"\x81\x00\x01", "is not text in UTF-8"),
        ("w.csv", b"\xff\xfe\x00\x01", "no rows of numbers"),
    ):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ValueError, match=message):
            gf.read_signal(tmp_path / name)
    with open(tmp_path / "array.npz", "wb") as file:
        np.save(file, noise(9))
    with pytest.raises(ValueError, match="is not a numpy archive"):
        gf.read_signal(tmp_path / "array.npz")
    with pytest.raises(ValueError, match=r"cannot read .*No such file"):
        gf.read_signal(tmp_path / "missing.csv")
    np.savez(tmp_path / "o.npz", a=np.array([{}, 1], dtype=object), allow_pickle=True)
    with pytest.raises(ValueError, match="is not a numpy archive of plain arrays"):
        gf.read_signal(tmp_path / "o.npz")
