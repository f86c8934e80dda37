"""Files as loggers and spreadsheets write them: rounded times, code pages, marks between thousands, dates; each told."""

import math
import re

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import gearfe as gf
from gearfe.app.cli import main
from gearfe.signal.time_axis import rounding, step_of

RATE = 5120.0


def written(path, time, values, form="{:.6g},{:.5g}\n", head="time [s],a [m/s^2]\n", encoding="utf-8"):
    path.write_bytes((head + "".join(form.format(t, v) for t, v in zip(time, values, strict=True))).encode(encoding))
    return path


def times(n, rate=RATE, start=0.0):
    return start + np.arange(n) / rate


@pytest.mark.parametrize("n", [60_000, 20_000])
@pytest.mark.parametrize("start", [0.0, 3.0])
def test_a_logger_of_six_digits(tmp_path, n, start):
    """From 10 s on its times are rounded to half a step; the rate still follows from all of them."""
    path = written(tmp_path / "log.csv", times(n, start=start), np.arange(n) % 7)
    rough = n / RATE + start > 10
    if not rough:
        assert_allclose(gf.read_signal(path).rate, RATE, rtol=1e-4)
        return
    with pytest.warns(UserWarning, match=r"times are rounded to 0.0001 s; all of them fit 5120 Hz, which is assumed"):
        assert_allclose(gf.read_signal(path).rate, RATE, rtol=1e-5)
    with pytest.warns(UserWarning, match="which is assumed"):
        assert gf.read_signal(path, rate=RATE).rate == RATE


@pytest.mark.parametrize("seed", range(12))
def test_a_gap_is_told_from_rounding(seed):
    """Times rounded to 0.3 to 3 steps: whole records pass, one lost or doubled sample in their middle does not."""
    rng = np.random.default_rng(seed)
    coarse = 10.0 ** -rng.integers(2, 5)
    rate, n = rng.uniform(0.3, 3.0) / coarse, 20_000
    whole = np.round(times(n, rate, rng.uniform(-5, 50)) / coarse) * coarse
    for cut in (whole, np.floor(times(n, rate, 0.7) / coarse) * coarse):  # rounded, and cut off
        with pytest.warns(UserWarning, match="times are rounded"):
            assert_allclose(1 / step_of("x", cut), rate, rtol=4 * coarse * rate / n)
    at = int(rng.integers(n // 4, 3 * n // 4))
    for wrong in (np.delete(whole, at), np.delete(whole, slice(at, at + 50)), np.insert(whole, at, whole[at])):
        with pytest.raises(ValueError, match=r"more than their rounding to .*: a gap, or a varying rate"):
            step_of("x", wrong)
        with pytest.raises(ValueError, match="or another rate than"):
            step_of("x", wrong, rate)
    with pytest.warns(UserWarning, match="times are rounded"):
        assert step_of("x", whole, rate) == 1 / rate
    with pytest.raises(ValueError, match="or another rate than"):
        step_of("x", whole, 1.01 * rate)


def test_a_gap_in_exact_times_stays_one():
    exact = np.delete(times(5000), slice(1000, 1003))
    with pytest.raises(ValueError, match=r"3 samples are missing between 0.195117188 and 0.195898437 s; cut the file there"):
        step_of("x", exact)
    with pytest.raises(ValueError, match="a gap, or a varying rate; resample first"):
        step_of("x", times(5000) ** 1.1)
    with pytest.raises(ValueError, match=r"rounded to 0.01 s; print them with more digits, or give rate= too"):
        step_of("x", np.round(times(3000), 2))


def test_what_times_were_rounded_to():
    assert_array_equal(rounding(np.round(times(3000), 4)), 1e-4)
    assert rounding(times(3000, 3e3 * math.pi)).max() == 0.0
    six = np.array([float(f"{t:.6g}") for t in times(3000, start=99.9)])
    assert set(np.unique(np.round(np.log10(rounding(six))))) == {-4.0, -3.0}


NUMBERS = [  # how 1234.5 and 0.25 are written, cells parted by ; or tab
    ("1,234.5", "0.25"), ("1.234,5", "0,25"), ("1'234.5", "0.25"), ("1 234,5", "0,25"), ("1\xa0234.5", "0.25"),
    ("1\u202f234,5", "0,25"),
]  # fmt: skip


@pytest.mark.parametrize("separator", [";", "\t"])
@pytest.mark.parametrize(("large", "small"), NUMBERS)
def test_marks_between_thousands(tmp_path, large, small, separator):
    path = tmp_path / "t.csv"
    path.write_text(f"a [mV]{separator}b [g]\n" + f"{large}{separator}{small}\n{small}{separator}-{large}\n" * 9)
    with pytest.warns(UserWarning, match=re.escape(f"thousands separators are assumed: {large!r} is 1234")):
        found = gf.read_signals(path, rate=10.0)
    assert_array_equal(found["a"].values[:3], [1234.5, 0.25, 1234.5])
    assert_array_equal(found["b"].values[:2], [0.25, -1234.5])


def test_thousands_between_quotes_and_what_is_no_thousand(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("a [mV],b [g]\n" + '"1,234.5",3\n' * 9)
    with pytest.warns(UserWarning, match="thousands"):
        assert gf.read_signal(path, column="a", rate=10.0).values[0] == 1234.5
    path.write_text("a [mV];b [g]\n" + "1,234;3,5\n" * 9)  # a decimal comma, as ever
    assert gf.read_signal(path, column="a", rate=10.0).values[0] == 1.234
    path.write_text("a [mV];b [g]\n" + "1,234.5;3.5\n" * 9 + "12,34.5;1\n")
    with pytest.raises(ValueError, match=r"line 11: '12,34.5;1' is not a row of 2 numbers"):
        gf.read_signal(path, column="a", rate=10.0)


@pytest.mark.parametrize(("encoding", "told"), [("latin-1", True), ("cp1252", True), ("utf-16", False), ("utf-16-le", False),
                                                ("utf-16-be", False), ("utf-8-sig", False)])  # fmt: skip
def test_code_pages(tmp_path, encoding, told, recwarn):
    path = written(tmp_path / "c.csv", times(50), np.arange(50), "{:.9f}\t{:g}\n", "time [s]\ta [m/s²]\n", encoding)
    found = gf.read_signal(path)
    assert found.unit == "m/s^2", "one spelling, so that files can be compared"
    assert_allclose(found.rate, RATE, rtol=1e-6)
    said = [str(one.message) for one in recwarn]
    assert said == ([f"{path} is not UTF-8: read as Windows-1252 (Latin-1)"] if told else [])


CLOCKS = [  # the first cells of a row: a date and a time of a clock, its seconds left to be filled in
    "2026-03-12T23:59:{:09.6f}Z;", "2026-03-12 23:59:{:09.6f}+01:00;", "12.03.2026;23:59:{:09.6f};", "23:59:{:09.6f};",
]  # fmt: skip


@pytest.mark.parametrize("clock", CLOCKS)
@pytest.mark.parametrize("mark", [".", ","])
def test_times_of_a_clock(tmp_path, clock, mark):
    """Over midnight; dates of another column are left aside."""
    names = "Date;Timestamp;" if clock.count(";") > 1 else "Timestamp;"
    rows = [(clock.format(59.5 + i / 1000) + f"{i % 7:.2f}") for i in range(500)]
    rows += [(clock.replace("23:59", "00:00").format(i / 1000) + f"{i % 7:.2f}") for i in range(500)]
    path = tmp_path / "c.csv"
    path.write_text(f"{names}a [g]\n" + "\n".join(row.replace(".", mark) if "12.03" not in row else row for row in rows) + "\n")
    with pytest.warns(UserWarning, match=r"'Timestamp' \(.*\) is used as the time, in seconds from its first row"):
        found = gf.read_signal(path)
    assert_allclose(found.rate, 1000.0, rtol=1e-6)
    assert found.values.size == 1000


def test_commas_between_quotes_are_decimal(tmp_path):
    path = tmp_path / "q.csv"
    path.write_text('"Zeit [s]","a [m/s²]"\n' + "".join(f'"{i / 100:.4f}","-{i % 7}.25"\n'.replace(".", ",") for i in range(50)))
    found = gf.read_signal(path)
    assert_allclose(found.rate, 100.0, rtol=1e-9)
    assert_array_equal(found.values[:2], [-0.25, -1.25])


@pytest.mark.parametrize("empty", ["0.02,,1", "0.02,1,", '"0.02","","1"'])
def test_empty_cells_are_told_and_refuse_their_own_column_only(tmp_path, empty):
    path = tmp_path / "e.csv"
    path.write_text("time [s],a [g],b [g]\n" + "".join(f"{empty if i == 2 else f'{i / 100},{i},{-i}'}\n" for i in range(9)))
    lost, whole = ("b", "a") if empty.endswith(",") else ("a", "b")
    with pytest.warns(UserWarning, match="1 rows have empty cells, the first in line 4: read as missing"):
        assert gf.read_signal(path, column=whole).values.size == 9
    told = f"'{lost}': sample 2 is nan, the first of 1 that are missing; cut the file to samples 3 to 8"
    with pytest.warns(UserWarning, match="empty"), pytest.raises(ValueError, match=told):
        gf.read_signal(path, column=lost)


def test_a_column_that_rises_may_be_the_time(tmp_path):
    path = written(tmp_path / "epoch.csv", times(50, start=1.7e9), np.arange(50) % 7, "{:.6f},{:g}\n", "timestamp,a [g]\n")
    with pytest.raises(ValueError, match="if 'timestamp', which rises all along, is the time, name it so by header="):
        gf.read_signal(path, column="a")


def test_parts_of_full_scale_are_told(tmp_path, capsys):
    from scipy.io import wavfile

    path = tmp_path / "w.wav"
    wavfile.write(path, 8000, (1000 * np.sin(np.arange(4000))).astype(np.int16))
    assert main(["signal", str(path)]) == 1
    assert "parts of full scale: give what that is as --scale and --unit" in capsys.readouterr().err
    assert main(["signal", str(path), "--unit", "m/s^2"]) == 0
    assert "full scale is taken for 1 m/s^2; give what it is as --scale" in capsys.readouterr().err
    assert main(["signal", str(path), "--unit", "m/s^2", "--scale", "500"]) == 0
    assert "full scale" not in capsys.readouterr().err


@pytest.mark.parametrize("name", ["Zeit", "Temps"])
def test_times_of_german_and_french_loggers(tmp_path, name):
    path = written(tmp_path / "z.csv", times(50), np.arange(50), "{:.9f};{:g}\n", f"{name} [s];a [g]\n")
    assert_allclose(gf.read_signal(path).rate, RATE, rtol=1e-6)


def test_the_command_line_says_how_to_name_columns(tmp_path, capsys):
    path = written(tmp_path / "n.csv", times(500), np.arange(500) % 7, "{:.9f},{:g}\n", "t,a\n")
    assert main(["signal", str(path)]) == 1
    said = capsys.readouterr().err
    assert "name all columns of a text table in --header" in said
    assert "header=" not in said
    assert main(["signal", str(path), "--header", "t [s], a [g]"]) == 0


def test_what_is_no_text(tmp_path):
    path = tmp_path / "b.csv"
    path.write_bytes(bytes(range(256)) * 9)
    with pytest.raises(ValueError, match="is not text in UTF-8, UTF-16 or Windows-1252: export it as CSV in UTF-8"):
        gf.read_signal(path)


@pytest.mark.parametrize(
    ("name", "kind"), [("time", "datetime64[ns]"), ("Timestamp", "datetime64[us]"), ("t", "timedelta64[ms]")]
)
def test_dates_in_parquet_are_the_time(tmp_path, name, kind):
    pa = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    clock = np.arange(500) * np.timedelta64(1_000_000, "ns")
    clock = (np.datetime64("2026-03-29T00:59:59.9") + clock if kind.startswith("d") else clock).astype(kind)
    path = tmp_path / "d.parquet"
    parquet.write_table(pa.table({name: clock, "a [g]": np.arange(500.0)}), path)
    with pytest.warns(UserWarning, match=rf"'{name}' \(.*\) is used as the time, in seconds from its first row"):
        found = gf.read_signal(path)
    assert_allclose(found.rate, 1000.0, rtol=1e-9)
    parquet.write_table(pa.table({name: pa.array([clock[0], None, clock[2]]), "a [g]": np.arange(3.0)}), path)
    with pytest.raises(ValueError, match=f"1 times of '{name}' are missing"):
        gf.read_signal(path)


def test_two_rates_and_how_to_say_which(tmp_path, capsys):
    from scipy.io import savemat

    path = tmp_path / "two.mat"
    savemat(path, {"a": np.arange(40.0), "sr": 5120.0, "rate": 10240.0, "unit": "g"})
    with pytest.raises(ValueError, match=r"as 5120 and 10240 Hz \(sr = 5120.0 and rate = 10240.0\); choose one by rate="):
        gf.read_signal(path)
    assert gf.read_signal(path, rate=5120.0).rate == 5120.0
    assert main(["signal", str(path)]) == 1
    assert "; choose one by --rate\n" in capsys.readouterr().err
    csv = written(tmp_path / "x.csv", times(50), np.arange(50), "{:.9f},{:g}\n")
    assert main(["signal", str(csv), "--rate", "100"]) == 1
    assert re.search(r"rate = 100 Hz, but its times are 5120 Hz; leave --rate out", capsys.readouterr().err)


@pytest.mark.parametrize("source", [1, -1, 0, 5])
def test_a_tdms_scale_of_no_source(tmp_path, source):
    """Scale 1 takes its values from itself, or from a scale that is not there."""
    nptdms = pytest.importorskip("nptdms")
    path = tmp_path / "s.tdms"
    scale = {"Scale_Type": "Linear", "Linear_Slope": 2.0, "Linear_Y_Intercept": 0.0, "Linear_Input_Source": source}
    properties = {f"NI_Scale[1]_{name}": value for name, value in scale.items()} | {"NI_Number_Of_Scales": 2}
    properties |= {"wf_increment": 1e-3, "unit_string": "g", "NI_Scaling_Status": "unscaled"}
    with nptdms.TdmsWriter(path) as file:
        file.write_segment([nptdms.ChannelObject("g", "a", np.arange(100, dtype="i2"), properties=properties)])
    with pytest.raises(ValueError, match="not a whole TDMS file: " + ("something in it" if source in (1, -1) else ".")):
        gf.read_signal(path)
