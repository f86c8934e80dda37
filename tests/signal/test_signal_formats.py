"""Every format that others write, made by its own library; every file that gearfe writes, read by another library."""

import sys
import wave

import h5py
import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import pyuff
from nptdms import ChannelObject, RootObject, TdmsWriter
from numpy.testing import assert_allclose, assert_array_equal
from scipy.io import savemat, wavfile
from universal_files import data_set

import gearfe as gf
from gearfe.signal.signal_file import READERS, channels

RATE, N = 5120.0, 400
TIME = np.arange(N) / RATE
X, Y = np.sin(2 * np.pi * 50 * TIME), 0.25 * np.cos(2 * np.pi * 7 * TIME) - 0.5


def write_npz(path):
    np.savez(path, acc=X, force=Y, fs=RATE, unit="m/s^2")


def write_mat(path):
    savemat(path, {"run": {"acc": X, "force": Y, "fs": RATE, "unit": "m/s^2"}})


def write_hdf(path):
    with h5py.File(path, "w") as file:
        file.attrs["sampling_rate"] = RATE
        for name, values in (("acc", X), ("force", Y)):
            file.create_dataset(f"run/{name}", data=values).attrs["unit"] = "m/s^2"


def write_wav(path):
    wavfile.write(path, int(RATE), np.stack([X, Y], axis=1).astype(np.float32))


def write_uff(path, binary=0):
    for name, values, node in (("acc", X, 7), ("force", Y, 8)):
        pyuff.UFF(str(path)).write_sets([data_set(name, values, node, RATE, binary=binary)], "add")


def write_tdms(path):
    told = {"wf_increment": 1 / RATE, "unit_string": "m/s^2"}
    with TdmsWriter(str(path)) as file:
        file.write_segment(
            [RootObject({}), *(ChannelObject("run", name, v, properties=told) for name, v in (("acc", X), ("force", Y)))]
        )


def write_parquet(path):
    pd.DataFrame({"time [s]": TIME, "acc [m/s^2]": X, "force [m/s^2]": Y}).to_parquet(path)


def write_lvm(path):
    """Layout of LabVIEW's measurement files with one time column."""
    head = ["LabVIEW Measurement\t", "Separator\tTab", "Decimal_Separator\t.", "X_Columns\tOne", "***End_of_Header***\t", "\t"]
    step = f"{1 / RATE:.9E}"
    head += ["Channels\t2\t", f"Samples\t{X.size}\t{X.size}\t", "Y_Unit_Label\tm/s^2\tm/s^2\t", "X0\t0.0\t0.0\t"]
    head += [f"Delta_X\t{step}\t{step}\t", "***End_of_Header***\t\t\t", "X_Value\tacc\tforce\tComment"]
    rows = [f"{t:.8f}\t{x:.9g}\t{y:.9g}" for t, x, y in zip(TIME, X, Y, strict=True)]
    path.write_text("\n".join(head + rows) + "\n", encoding="utf-8")


WRITERS = {
    ".npz": write_npz, ".mat": write_mat, ".h5": write_hdf, ".hdf5": write_hdf, ".wav": write_wav, ".uff": write_uff,
    ".unv": write_uff, ".uf": write_uff, ".tdms": write_tdms, ".parquet": write_parquet, ".lvm": write_lvm,
}  # fmt: skip


def test_every_reader_is_tested():
    assert set(WRITERS) == {".lvm", *READERS}


@pytest.mark.parametrize("suffix", WRITERS)
def test_what_its_own_library_wrote_is_read_channel_by_channel(tmp_path, suffix):
    path = tmp_path / f"run{suffix}"
    WRITERS[suffix](path)
    found = gf.read_signals(path, units="m/s^2")
    assert len(found) == 2
    for (name, one), values in zip(found.items(), (X, Y), strict=True):
        assert_allclose(one.values, values, rtol=1e-6, atol=1e-7)
        assert_allclose(
            one.rate, RATE, rtol=1e-5 if suffix.startswith(".u") else 1e-8, err_msg="UFF prints six digits of the step"
        )
        assert one.unit == "m/s^2"
        assert one.name == f"run {name}"
    with pytest.raises(ValueError, match=r"2 columns of values; it has '.*, '.*: give one as column="):
        gf.read_signal(path, unit="m/s^2")


def test_channels_are_named_after_what_the_file_calls_them(tmp_path):
    names = {}
    for suffix in (".mat", ".h5", ".uff", ".tdms", ".wav"):
        WRITERS[suffix](tmp_path / f"a{suffix}")
        names[suffix] = channels(tmp_path / f"a{suffix}").channels()
    assert names[".mat"] == ["run.acc", "run.force"]
    assert names[".h5"] == ["run/acc", "run/force"]
    assert names[".uff"] == ["acc 7-z", "force 8-z"]
    assert names[".tdms"] == ["acc", "force"]
    assert names[".wav"] == ["channel 1", "channel 2"]
    assert_array_equal(gf.read_signal(tmp_path / "a.h5", column="force").values, Y), "without its group"


@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")  # of pyuff's writer
def test_binary_universal_files_and_other_functions_in_them(tmp_path):
    write_uff(tmp_path / "b.uff", binary=1)
    for column in ("force 8-z", "8-z"):  # names begin with the title of the record, which differs from file to file
        assert_array_equal(gf.read_signal(tmp_path / "b.uff", column=column).values, Y)
    spectrum = data_set("frf", X, 1, RATE, func_type=4)
    pyuff.UFF(str(tmp_path / "f.uff")).write_sets([spectrum], "add")
    with pytest.raises(ValueError, match="it has a data set function type 4"):
        gf.read_signal(tmp_path / "f.uff")
    for values in (X, Y):
        pyuff.UFF(str(tmp_path / "t.uff")).write_sets([data_set("acc", values, 7, RATE)], "add")
    assert channels(tmp_path / "t.uff").channels() == ["acc 7-z", "acc 7-z (2)"]


@pytest.mark.parametrize(("dtype", "full"), [(np.int16, 2**15), (np.int32, 2**31), (np.uint8, 2**7)])
def test_wav_of_whole_numbers_is_part_of_full_scale(tmp_path, dtype, full):
    values = np.arange(-100, 100)
    wavfile.write(tmp_path / "x.wav", 8000, (values + (128 if dtype == np.uint8 else 0)).astype(dtype))
    found = gf.read_signal(tmp_path / "x.wav", unit="g", scale=3.0)
    assert_allclose(found.values, 3.0 * values / full)
    assert (found.rate, found.unit) == (8000.0, "g")


def test_wav_of_24_bits_by_pythons_own_writer(tmp_path):
    values = np.array([0, 1, -1, 2**22, -(2**23)])
    with wave.open(str(tmp_path / "x.wav"), "wb") as file:
        file.setparams((1, 3, 8000, 0, "NONE", "NONE"))
        file.writeframes(b"".join(int(one).to_bytes(3, "little", signed=True) for one in values))
    assert_allclose(gf.read_signal(tmp_path / "x.wav", unit="1").values, values / 2**23)


def test_tdms_with_several_groups(tmp_path):
    with TdmsWriter(str(tmp_path / "x.tdms")) as file:
        for group, values in (("one", X), ("two", Y)):
            file.write_segment([ChannelObject(group, "acc", values), ChannelObject(group, "note", ["run"] * 3)])
    assert_array_equal(gf.read_signal(tmp_path / "x.tdms", column="two/acc", rate=RATE, unit="g").values, Y)
    with pytest.raises(ValueError, match=r"no column 'acc'; it has 'one/acc', 'two/acc', 'one/note' \(object, 3 values\)"):
        gf.read_signal(tmp_path / "x.tdms", column="acc", rate=RATE, unit="g")


def test_parquet_with_units_in_its_metadata(tmp_path):
    fields = [pa.field("t", pa.float64(), metadata={"unit": "ms"}), pa.field("acc", pa.float32(), metadata={"unit": "g"})]
    schema = pa.schema([*fields, pa.field("note", pa.string())])
    pq.write_table(pa.table([1e3 * TIME, X.astype(np.float32), ["a"] * N], schema=schema), tmp_path / "x.parquet")
    found = gf.read_signal(tmp_path / "x.parquet")
    assert_allclose(found.values, X, atol=1e-7)
    assert_allclose(found.rate, RATE)
    assert found.unit == "g"


def test_matlab_matrices_structs_and_cells(tmp_path):
    matrix = np.stack([X, Y])
    savemat(tmp_path / "m.mat", {"data": matrix, "fs": RATE, "unit": "g"})
    assert_array_equal(gf.read_signal(tmp_path / "m.mat", column="data 2").values, Y)
    runs = np.array([(X, "g", TIME), (Y, "N", TIME)], dtype=[("acc", object), ("unit", object), ("time", object)])
    savemat(tmp_path / "s.mat", {"run": runs})
    assert channels(tmp_path / "s.mat").channels() == ["run(1).acc", "run(2).acc"]
    assert_allclose(gf.read_signal(tmp_path / "s.mat", column="run(2).acc").rate, RATE)
    cells = np.empty(2, dtype=object)
    cells[:] = [X, Y]
    savemat(tmp_path / "c.mat", {"c": cells, "rate": RATE})
    assert_array_equal(gf.read_signal(tmp_path / "c.mat", column="c{1}", unit="g").values, X)


def matlab73(path):
    """A file as MATLAB's `save -v7.3` lays it out: header, arrays turned round, text as numbers, cells as references."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("acc", X[None, :]), ("both", np.stack([X, Y])), ("fs", np.array([[RATE]]))):
            file.create_dataset(f"run/{name}", data=values).attrs["MATLAB_class"] = np.bytes_("double")
        file["run"].attrs["MATLAB_class"] = np.bytes_("struct")
        text = file.create_dataset("unit", data=np.array([[ord(c)] for c in "m/s^2"], dtype=np.uint16))
        text.attrs["MATLAB_class"] = np.bytes_("char")
        file.create_dataset("#refs#/a", data=Y[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
        cell = file.create_dataset("cell", data=np.array([[file["#refs#/a"].ref]], dtype=h5py.ref_dtype))
        cell.attrs["MATLAB_class"] = np.bytes_("cell")
    with open(path, "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")


def test_matlab_of_version_7_3(tmp_path):
    matlab73(tmp_path / "x.mat")
    assert channels(tmp_path / "x.mat").channels() == ["cell{1}", "run.acc", "run.both 1", "run.both 2"]
    for column, values in (("acc", X), ("both 2", Y), ("cell{1}", Y)):
        found = gf.read_signal(tmp_path / "x.mat", column=column)
        assert_array_equal(found.values, values)
        assert (found.rate, found.unit) == (RATE, "m/s^2")


def rows(separator=",", mark=".", n=40):
    return "\n".join(
        separator.join(f"{v:.6f}".replace(".", mark) for v in row) for row in zip(TIME[:n], X[:n], Y[:n], strict=True)
    )


TABLES = {
    "title rows": f"Gearbox 3, second try\nRecorded;2024-05-01\n\ntime [s],acc [g],force [g]\n{rows()}",
    "units below the names": f"Test\ntime;acc;force\ns;g;g\n{rows(';')}",
    "units in brackets below": f"time\tacc\tforce\n(s)\t[g]\t(g)\n{rows(chr(9))}",
    "decimal commas": f"time [s];acc [g];force [g]\n{rows(';', ',')}",
    "decimal commas and tabs": f"Messung\ntime [s]\tacc [g]\tforce [g]\n{rows(chr(9), ',')}",
    "blanks": f"# time [s];acc [g];force [g]\n{rows(' ')}".replace(";", " ").replace(" [", "["),
    "separators at the ends": "time [s];acc [g];force [g];\n" + rows(";").replace("\n", ";\n") + ";",
    "quoted": f'"time [s]","acc [g]","force [g]"\n{rows()}',
}


@pytest.mark.parametrize("name", TABLES)
def test_text_tables_as_people_export_them(tmp_path, name):
    (tmp_path / "x.csv").write_text(TABLES[name], encoding="utf-8")
    for column, values in (("acc", X), ("force", Y)):
        found = gf.read_signal(tmp_path / "x.csv", column=column)
        assert_allclose(found.values, values[:40], atol=1e-6)
        assert_allclose(found.rate, RATE, rtol=1e-3)
        assert found.unit == "g"


def test_tables_without_names(tmp_path):
    (tmp_path / "x.txt").write_text(rows("\t"))
    found = gf.read_signals(tmp_path / "x.txt", header="time [s], acc [g], force [N]")
    assert [one.unit for one in found.values()] == ["g", "N"]
    assert_allclose(found["force"].values, Y[:40], atol=1e-6)
    alone = gf.read_signal(tmp_path / "x.txt", column="column 2", rate=RATE, unit="g")
    assert_allclose(alone.values, X[:40], atol=1e-6)
    with pytest.raises(ValueError, match=r"3 columns without names; give header=, 'time .*', or a column"):
        gf.read_signal(tmp_path / "x.txt")
    (tmp_path / "y.csv").write_text("Sample rate [Hz];5120,0\nUnit;g\n" + "\n".join(f"{v:.6f}".replace(".", ",") for v in X))
    found = gf.read_signal(tmp_path / "y.csv", header="acc")
    assert (found.rate, found.unit) == (RATE, "g")
    assert_allclose(found.values, X, atol=1e-6)


def test_a_table_that_cannot_be_read_says_what_stands_in_it(tmp_path):
    (tmp_path / "x.csv").write_text("time,acc\n2024-05-01 10:00:00.001,on\n")
    with pytest.raises(ValueError, match="no rows of numbers; its first line is 'time,acc'"):
        gf.read_signal(tmp_path / "x.csv")


def test_units_and_columns_that_are_not_there(tmp_path):
    write_npz(tmp_path / "x.npz")
    with pytest.raises(ValueError, match="units for 'sound', but it has 'acc', 'force'"):
        gf.read_signals(tmp_path / "x.npz", units={"sound": "Pa"})
    with pytest.raises(ValueError, match="no column 'sound'; it has 'acc', 'force'"):
        gf.read_signals(tmp_path / "x.npz", ["sound"])
    with pytest.raises(ValueError, match="header = 'a', but only text tables"):
        gf.read_signal(tmp_path / "x.npz", header="a")


def damaged(whole):
    """Files cut and files with bytes changed."""
    for part in (0, 3, 10, 200, 2 * len(whole) // 5, len(whole) - 20):
        yield whole[:part]
    rng = np.random.default_rng(len(whole))
    for _ in range(12):
        bad = bytearray(whole)
        for place in rng.integers(0, min(len(bad), 2000), 4):
            bad[place] = rng.integers(0, 256)
        yield bytes(bad)
    yield b"hello\nworld\n"
    yield bytes(300)


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.filterwarnings("ignore")
def test_damaged_files_are_refused_in_one_sentence_or_read(tmp_path, suffix):
    """Cut files and others are refused; where a byte was changed among the numbers the rest may be read."""
    WRITERS[suffix](tmp_path / f"whole{suffix}")
    whole = (tmp_path / f"whole{suffix}").read_bytes()
    refused = 0
    for i, content in enumerate(damaged(whole)):
        path = tmp_path / f"bad{suffix}"
        path.write_bytes(content)
        said = refusal(path)
        assert said or 6 <= i < 18, f"cut file {i} was read"
        assert not said or ("bad" in said and "\n" not in said), said
        refused += bool(said)
    assert refused >= 8


def refusal(path):
    """What is said of a file; empty if it was read and all values are finite."""
    try:
        found = gf.read_signals(path, units="m/s^2")
    except ValueError as error:
        return str(error)
    assert all(np.isfinite(one.values).all() for one in found.values())
    return ""


@pytest.mark.parametrize(
    ("suffix", "module", "name"),
    [(".h5", "h5py", "h5py"), (".uff", "pyuff", "pyuff"), (".tdms", "nptdms", "npTDMS"), (".parquet", "pyarrow", "pyarrow")],
)
def test_a_missing_library_is_named_with_its_extra(tmp_path, monkeypatch, suffix, module, name):
    WRITERS[suffix](tmp_path / f"x{suffix}")
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(RuntimeError, match=rf"pip install {name}.*, or pip install 'gearfe\[signals\]'"):
        gf.read_signal(tmp_path / f"x{suffix}")


@pytest.mark.parametrize(("factor", "rate"), [(1.0, 500.0), (1e3, 500.0)])
def test_times_without_a_unit_have_the_one_that_fits_the_rate(tmp_path, factor, rate):
    frame = pd.DataFrame({"t": factor * np.arange(100) / rate, "acc": np.sin(np.arange(100))})
    frame.to_parquet(tmp_path / "one.parquet")
    assert gf.read_signal(tmp_path / "one.parquet", rate=rate, unit="g").rate == rate
    for wrong in ({}, {"rate": 3 * rate}):
        with pytest.raises(ValueError, match="column 't' has no unit"):
            gf.read_signal(tmp_path / "one.parquet", unit="g", **wrong)
