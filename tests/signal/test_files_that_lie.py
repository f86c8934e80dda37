"""Files that announce more than they hold, that point to other files, or are damaged: refused, whatever stands in them."""

import io
import struct
import tracemalloc
import zipfile
import zlib
from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.io.matlab
from numpy.testing import assert_array_equal
from scipy.io import loadmat, savemat
from scipy.sparse import csc_array

import gearfe as gf
from gearfe.core.matlab_file import Unread, variables
from gearfe.signal.signal_file import channels

X = np.sin(np.arange(400) / 9.0)
THEIRS = Path(scipy.io.matlab.__file__).parent / "tests" / "data"  # files of MATLAB 4 to 7.4 and of Octave
REFUSED_BY_BOTH = {"bad_miuint32", "corrupted_zlib_checksum", "corrupted_zlib_data", "debigged_m4", "malformed1"}
REFUSED_BY_BOTH |= {"testhdf5_7.4_GLNX86"}
OTHERWISE = {"bad_miutf8_array_name", "nasty_duplicate_fieldnames"}  # read here too, with names of their own


def matlab(compressed):
    cells = np.empty((1, 2), dtype=object)
    cells[0] = [X, "text"]
    out = io.BytesIO()
    content = {
        "run": {"acc": X, "fs": 5120.0, "unit": "m/s^2", "deep": {"c": cells}}, "matrix": np.stack([X, X]), "turned": X + 1j,
        "rows": np.array(["ab", "cd"]), "yes": np.array([True, False]), "whole": np.arange(-3, 3, dtype=np.int16),
        "empty": np.empty((0, 3)), "nothing": "", "sparse": csc_array(np.eye(5)), "small": np.float32([1.5, np.inf]),
    }  # fmt: skip
    savemat(out, content, do_compression=compressed)
    return out.getvalue()


def assert_same(one, other, name):
    """Variables as scipy reads them; what it reads as a sparse matrix or object is named here."""
    if isinstance(one, Unread) or other is None:
        assert type(other) is not np.ndarray, name
        return
    assert one.shape == other.shape, name
    if other.dtype.names is not None:
        assert one.dtype.names == other.dtype.names, name
        pairs = [(a, b) for key in other.dtype.names for a, b in zip(one[key].ravel(), other[key].ravel(), strict=True)]
    else:
        pairs = zip(one.ravel(), other.ravel(), strict=True) if other.dtype == object else ()
    for a, b in pairs:
        assert_same(a, b, name)
    if other.dtype.kind == "U":
        assert [text.rstrip() for text in one.ravel()] == [text.rstrip() for text in other.ravel()], name
    elif other.dtype.kind in "fiuc":
        assert_array_equal(one, other, err_msg=name)


@pytest.mark.parametrize("compressed", [False, True])
def test_matlab_files_are_read_as_scipy_reads_them(compressed):
    found, wanted = variables(matlab(compressed)), loadmat(io.BytesIO(matlab(compressed)))
    assert set(found) == {name for name in wanted if not name.startswith("__")}
    for name, value in found.items():
        assert_same(value, wanted[name], name)
    assert found["small"].dtype == np.float32
    assert "sparse matrix" in found["sparse"].why


@pytest.mark.skipif(not THEIRS.is_dir(), reason="this scipy came without its tests")
@pytest.mark.filterwarnings("ignore")
def test_files_that_matlab_wrote_are_read_as_scipy_reads_them():
    same = 0
    for path in sorted(THEIRS.glob("*.mat")):
        if path.stem in REFUSED_BY_BOTH:
            with pytest.raises(ValueError):  # noqa: PT011 - for many reasons
                variables(path.read_bytes())
            continue
        found = variables(path.read_bytes())
        if path.stem in OTHERWISE:
            continue
        wanted = {name: value for name, value in loadmat(path).items() if not name.startswith("__")}
        assert set(found) == set(wanted), path.name
        for name, value in found.items():
            assert_same(value, wanted[name], f"{path.name}, {name}")
        same += 1
    assert same >= 100


def mutants(count):
    """Files with up to 40 bytes changed, most of them among the lengths and kinds; a few are cut."""
    rng, wholes = np.random.default_rng(5), [matlab(False), matlab(True)]
    for i in range(count):
        bad = bytearray(wholes[i % 3 == 0])
        for at in rng.integers(0, min(len(bad), 3000 if i % 5 else len(bad)), rng.integers(1, 41)):
            bad[at] = rng.integers(0, 256)
        yield bytes(bad[: rng.integers(200, len(bad))] if i % 7 == 0 else bad)


@pytest.mark.filterwarnings("error")
def test_damaged_matlab_files_are_read_or_refused_and_take_little_memory():
    """Of 1500 such files scipy's compiled reader ended the process with eight, and did not come back from one."""
    refused = 0
    tracemalloc.start()
    for content in mutants(600):
        try:
            variables(content)
        except ValueError:
            refused += 1
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert 200 < refused < 600
    assert most < 30e6


def element(kind, content):
    return struct.pack("<2I", kind, len(content)) + content + bytes(-len(content) % 8)


def array(kind, shape, *rest, name=b"x"):
    head = element(6, struct.pack("<2I", kind, 0)) + element(5, struct.pack(f"<{len(shape)}i", *shape)) + element(1, name)
    return element(14, head + b"".join(rest))


HEADER = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
NESTED = element(14, b"")
for _ in range(200):
    NESTED = array(1, (1, 1), NESTED)
LIES = {
    "2147483647 entries": array(1, (2**31 - 1, 1)),
    "numbers do not fill an array": array(6, (2**31 - 1, 2**31 - 1), element(9, bytes(8))),
    "has the shape": array(6, (-1, 1), element(9, bytes(8))),
    "more than 50 deep": NESTED,
    "field names have": array(2, (1, 1), element(5, struct.pack("<i", 0)), element(1, b"abc")),
    "in the place of an array": array(1, (1, 1), element(9, bytes(8))),
    "are no numbers": array(6, (1, 1), element(9, bytes(7))),
    "are no text": array(4, (1, 1), element(9, bytes(8))),
    "characters do not fill a text": array(4, (2, 9), element(16, b"abc")),
    "bytes are stated": element(15, zlib.compress(struct.pack("<2I", 14, 2**31) + bytes(100))),
    "another length": element(15, zlib.compress(struct.pack("<2I", 14, 40) + bytes(100))),
    "is empty": element(15, zlib.compress(b"")),
    "is damaged: Error": element(15, zlib.compress(array(6, (1, 1), element(9, bytes(8))))[:-2] + b"xx"),
}


@pytest.mark.parametrize("told", LIES)
def test_what_a_matlab_file_cannot_hold_is_refused(tmp_path, told):
    path = tmp_path / "x.mat"
    path.write_bytes(HEADER + LIES[told])
    with pytest.raises(ValueError, match=rf"x\.mat is not a MATLAB file, or a damaged one: .*{told}"):
        channels(path)


def test_old_matlab_files_that_lie_are_refused(tmp_path):
    for head in ((0, 2**30, 2**30, 0, 2), (0, -1, 2, 0, 2), (70, 1, 1, 0, 2), (1, 1, 9, 0, 2)):
        (tmp_path / "x.mat").write_bytes(struct.pack("<5i", *head) + b"x\0")
        with pytest.raises(ValueError, match="is not a MATLAB file"):
            channels(tmp_path / "x.mat")


def npy(shape):
    """Header of an array, and 100 bytes of it."""
    text = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".encode()
    text = text.ljust(-(len(text) + 11) % 64 + len(text)) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text + bytes(100)


@pytest.mark.parametrize("kind", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
def test_an_archive_whose_header_asks_for_64_gb_is_refused(tmp_path, kind):
    path = tmp_path / "x.npz"
    with zipfile.ZipFile(path, "w", kind) as archive:
        archive.writestr("acc.npy", npy((8 * 2**30,)))
    with pytest.raises(ValueError, match=r"x\.npz is not a numpy archive of plain arrays: acc\.npy states float64"):
        channels(path)
    path.write_bytes(npy((8 * 2**30,)))
    with pytest.raises(ValueError, match="not a numpy archive"):
        channels(path)


def test_an_archive_whose_list_lies_is_refused(tmp_path):
    path = tmp_path / "x.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("acc.npy", npy((2**28,)))
    whole = path.read_bytes()
    size = struct.pack("<I", archive.infolist()[0].file_size)
    path.write_bytes(whole.replace(size, struct.pack("<I", 2**31 + 500)))
    with pytest.raises(ValueError, match=r"acc\.npy holds \d+ compressed bytes, which cannot expand to the stated 2147484148"):
        channels(path)


def outside(path, kind):
    """An HDF5 file whose values stand in another one."""
    secret = path.with_name("secret.h5")
    with h5py.File(secret, "w") as file:
        file["acc"] = X
    path.with_name("secret.raw").write_bytes(X.tobytes())
    with h5py.File(path, "w") as file:
        file["own"] = X
        if kind == "external":
            file.create_dataset("run/acc", (400,), "f8", external=[(str(path.with_name("secret.raw")), 0, 3200)])
        elif kind == "link":
            file.create_group("run")["acc"] = h5py.ExternalLink(str(secret), "/acc")
        elif kind == "link at the top":
            file["acc"] = h5py.ExternalLink(str(secret), "/acc")
        elif kind == "virtual":
            layout = h5py.VirtualLayout((400,), "f8")
            layout[:] = h5py.VirtualSource(str(secret), "acc", (400,))
            file.create_virtual_dataset("acc", layout)
        elif kind == "cell":
            one = file.create_dataset("#refs#/a", (1, 400), "f8", external=[(str(path.with_name("secret.raw")), 0, 3200)])
            one.attrs["MATLAB_class"] = np.bytes_("double")
            cell = file.create_dataset("cell", data=np.array([[one.ref]], dtype=h5py.ref_dtype))
            cell.attrs["MATLAB_class"] = np.bytes_("cell")


@pytest.mark.parametrize(
    ("kind", "told"),
    [
        ("external", "are in other files"),
        ("link", "is a link to another file"),
        ("link at the top", "is a link to another file"),
        ("virtual", "a virtual dataset of other datasets"),
        ("cell", "are in other files"),
    ],
)
def test_hdf5_that_reads_other_files_is_refused(tmp_path, kind, told):
    path = tmp_path / "x.h5"
    outside(path, kind)
    with pytest.raises(ValueError, match=rf"x\.h5 is not a whole HDF5 file: .*{told}"):
        channels(path)


def test_hdf5_that_announces_64_gb_is_refused_and_packed_values_are_read(tmp_path):
    path = tmp_path / "x.h5"
    for chunks in (None, (1000,)):
        with h5py.File(path, "w") as file:
            file.create_dataset("acc", (8 * 2**30,), "f8", chunks=chunks)
        with pytest.raises(ValueError, match="states 68719476736 bytes, but only 0 are stored"):
            channels(path)
    with h5py.File(path, "w") as file:
        file.create_dataset("acc", data=np.zeros(10**6), compression="gzip", compression_opts=9)
        file["twice"] = h5py.SoftLink("/acc")
    assert gf.read_signal(path, column="acc", rate=1.0, unit="g").values.size == 10**6
