"""Gears solved before: one switch, bounded memory, files that hold numbers only and are believed only if they are whole."""

import math
import os
import pickle
import signal
import subprocess
import sys
import threading
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import gearfe as gf
from gearfe.flexibility.arrays import plane_arrays, plane_from, solid_arrays, solid_from
from gearfe.flexibility.finite_elements import fe
from gearfe.flexibility.plane import Flexibility
from gearfe.flexibility.solved import PROCESS, SolvedGears, memory, solved_gears
from gearfe.stiffness import cache
from gearfe.stiffness.flexibility_file import read_flexibility, write_flexibility

STEEL = gf.Material(E=207e3, nu=0.3)
GEAR = gf.Gear(z=18, m_n=2.0, alpha_n=math.radians(20), r_bore=9.0, b=4.0)
PAIR = gf.GearPair(GEAR, replace(GEAR, z=20))
CRACK = gf.Crack(level=0.3)
COARSE = {"neighbours": 1, "refine": 0.4}


@pytest.fixture(autouse=True)
def _own_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("GEARFE_CACHE", str(tmp_path / "gears"))
    cache.clear()
    yield
    cache.clear()


@pytest.fixture
def solves(monkeypatch):
    """A list that grows with every solve by finite elements."""
    calls, real = [], fe.flexibility
    monkeypatch.setattr(fe, "flexibility", lambda *args, **options: (calls.append(args), real(*args, **options))[1])
    return calls


def stored(tmp_path):
    """The one file of the folder, after a solve."""
    found = cache.solved_gear(GEAR, STEEL, **COARSE)
    (file,) = (tmp_path / "gears").iterdir()
    cache.clear()
    return file, found


class Planted:
    """Makes a file when it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


def test_a_planted_file_is_not_executed(tmp_path, solves):
    """The name is right for a reader of either format, the content runs code as soon as somebody unpickles it."""
    file, found = stored(tmp_path)
    ran = tmp_path / "ran"
    harmful = pickle.dumps(Planted(ran))
    arrays = plane_arrays(found)
    for content in ("pickle", "npz"):
        for name in (file, file.with_suffix(".pickle")):
            if content == "pickle":
                name.write_bytes(harmful)
            else:
                with name.open("wb") as out:
                    np.savez(out, **{n: np.array([Planted(ran)], dtype=object) for n in ("key", *arrays)})
        cache.clear()
        assert cache.solved_gear(GEAR, STEEL, **COARSE).dofs == found.dofs
        assert not ran.exists()
    assert len(solves) == 3
    pickle.loads(harmful)
    assert ran.exists(), "the plant works"


def damaged(file, arrays, key):
    """Names and contents of files that are no stored flexibility; None for what is no file."""
    whole = file.read_bytes()
    middle = len(whole) // 2
    yield "empty", b""
    yield "cut off", whole[:middle]
    yield "end only", whole[middle:]
    yield "one bit", whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :]
    yield "text", b"PK\x03\x04 no archive at all"
    yield "zeros", bytes(len(whole))
    text = np.frombuffer(key.encode(), dtype=np.uint8)
    first = next(name for name in arrays if name.startswith("near/0/x"))
    for name, changed in {
        "another key": {"key": text[::-1].copy()},
        "no key": {"key": None},
        "floats for the key": {"key": text.astype(float)},
        "array missing": {first: None},
        "array too many": {"extra": np.zeros(3)},
        "another dtype": {first: arrays[first].astype(np.float32)},
        "objects": {first: np.array([None, 1])},
        "another shape": {first: arrays[first][:-1]},
        "another dimension": {first: arrays[first][None]},
        "not a number": {first: arrays[first] * np.nan},
        "breakpoints that fall": {first: arrays[first][::-1].copy()},
        "no tooth": {"near/x/c": np.zeros(2)},
        "less than no unknowns": {"dofs": np.array(-1)},
        "a gear within a gear within a gear": {"healthy/healthy/dofs": np.array(1)},
    }.items():
        made = {"key": text} | arrays | changed
        with file.open("wb") as out:
            np.savez(out, **{n: value for n, value in made.items() if value is not None})
        yield name, file.read_bytes()
    with file.open("wb") as out:
        np.savez_compressed(out, key=text, **(arrays | {"bomb": np.zeros(10**7)}))
    yield "a bomb", file.read_bytes()
    with zipfile.ZipFile(file, "w") as out:
        out.writestr("key.npy", b"\x93NUMPY\x01\x00v\x00" + b"{'descr': '<f8', 'fortran_order': False, 'shape': (10**15,), }")
    yield "a header of nonsense", file.read_bytes()
    header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000000,), }\n"
    with zipfile.ZipFile(file, "w") as out:
        out.writestr("key.npy", b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header)
    yield "a petabyte announced", file.read_bytes()


def test_a_damaged_file_is_as_good_as_none(tmp_path):
    file = tmp_path / "gear.npz"
    found = fe.flexibility(GEAR, STEEL, **COARSE)
    arrays = {name: np.array(value, order="C") for name, value in plane_arrays(found).items()}
    write_flexibility(file, "the key", arrays)
    assert read_flexibility(file, "the key", lambda own: plane_from(GEAR, own)).dofs == found.dofs
    assert read_flexibility(file, "another key", lambda own: plane_from(GEAR, own)) is None
    names = []
    for name, content in damaged(file, arrays, "the key"):
        file.write_bytes(content)
        assert read_flexibility(file, "the key", lambda own: plane_from(GEAR, own)) is None, name
        names.append(name)
    assert len(names) == 23
    file.unlink()
    assert read_flexibility(file, "the key", dict) is None
    file.mkdir()
    assert read_flexibility(file, "the key", dict) is None
    os.mkfifo(tmp_path / "pipe.npz")
    assert read_flexibility(tmp_path / "pipe.npz", "the key", dict) is None, "and does not wait for a writer"


@pytest.mark.parametrize("place", ["folder", "file", "read-only", "nowhere"])
def test_a_disk_that_takes_nothing_costs_only_the_reuse(tmp_path, monkeypatch, solves, place):
    file, found = stored(tmp_path)
    file.unlink()
    if place == "folder":
        file.mkdir()  # where the file should be
    elif place == "file":
        (tmp_path / "gears").rmdir()
        (tmp_path / "gears").write_text("no folder")
    elif place == "read-only":
        monkeypatch.setattr(cache, "write_flexibility", lambda *_: (_ for _ in ()).throw(OSError(30, "Read-only file system")))
    else:
        monkeypatch.setenv("GEARFE_CACHE", "/proc/nowhere")
    again = cache.solved_gear(GEAR, STEEL, **COARSE)
    assert_array_equal(again.near[0].c, found.near[0].c)
    assert len(solves) == 2


def test_a_full_disk_leaves_nothing_behind(tmp_path, monkeypatch):
    def full(name, **_):
        Path(name).write_bytes(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez", full)
    cache.solved_gear(GEAR, STEEL, **COARSE)
    assert list((tmp_path / "gears").iterdir()) == []


@pytest.mark.parametrize("cracks", [(), (CRACK,)])
def test_sections_come_back_to_the_last_bit(tmp_path, cracks):
    found = cache.solved_gear(GEAR, STEEL, cracks, **COARSE)
    cache.clear()
    again = cache.solved_gear(GEAR, STEEL, cracks, **COARSE)
    assert again is not found
    for one, two in zip(plane_arrays(found).items(), plane_arrays(again).items(), strict=True):
        assert one[0] == two[0]
        assert_array_equal(one[1], two[1])
    roll = np.linspace(GEAR.roll_f, GEAR.roll_a, 7)[1:-1]
    rolls = np.column_stack([roll, roll[::-1]])
    assert_array_equal(again.matrix(rolls, [0, 1]), found.matrix(rolls, [0, 1]))
    if cracks:
        assert_array_equal(again.seam.at(rolls, [0, 1]), found.seam.at(rolls, [0, 1]))
        assert again.healthy.dofs == found.healthy.dofs


def test_solids_come_back_to_the_last_bit():
    from gearfe.flexibility.energy.ritz.solid import flexibility3d

    found = flexibility3d(GEAR, STEEL, (CRACK,), order=2, axial=4)  # with faces of cracks, healthy gear and all
    again = solid_from(GEAR, solid_arrays(found))
    roll, z, tooth = np.array([6.0, 7.0, 8.0]), np.array([0.5, 1.0, 3.0]), [0, 0, 1]
    assert_array_equal(again.basis(roll, z), found.basis(roll, z))
    for second in (0, 1):
        assert_array_equal(again.between(0, second), found.between(0, second))
    assert_array_equal(again.opening(tooth, roll, z), found.opening(tooth, roll, z))
    assert again.kernel == found.kernel
    assert isinstance(again.healthy, type(found))
    for name, changed in {"degree": np.array(5), "width": np.array([4.0]), "near/0/b": np.eye(7)}.items():
        with pytest.raises(ValueError, match="does not fit"):
            solid_from(GEAR, solid_arrays(found) | {name: changed})


def test_the_key_knows_every_source_file():
    names = {source.relative_to(Path(gf.__file__).parents[1]).as_posix() for source in cache.sources()}
    assert {
        "gearfe/flexibility/finite_elements/fe.py",
        "gearfe/flexibility/plane.py",
        "gearfe/__init__.py",
        "geometry/tooth/gear.py",
    } <= names


WRITER = """
import sys, numpy as np
from pathlib import Path
from gearfe.stiffness.flexibility_file import write_flexibility
print("ready", flush=True)
while True:
    write_flexibility(Path(sys.argv[1]), "key", {"a": np.arange(200_000.0)})
"""


def test_a_killed_writer_and_two_at_once_leave_no_broken_file(tmp_path):
    """Every look during the writing of two processes, and after both were killed, finds the whole file or none."""
    file = tmp_path / "gear.npz"
    command = [sys.executable, "-c", WRITER, str(file)]
    root = Path(gf.__file__).parents[1]
    writers = [subprocess.Popen(command, stdout=subprocess.PIPE, cwd=root) for _ in range(2)]
    try:
        for writer in writers:
            assert writer.stdout.readline() == b"ready\n"
        while not file.exists():
            pass
        for _ in range(50):
            assert read_flexibility(file, "key", lambda own: own["a"].sum()) == 200_000 * 199_999 / 2
    finally:
        for writer in writers:
            writer.send_signal(signal.SIGKILL)
            writer.communicate()
    assert read_flexibility(file, "key", lambda own: own["a"].size) == 200_000


@pytest.mark.parametrize("method", ["ritz", "ritz3d", "coupled", "fe"])
def test_without_the_cache_nothing_is_used_kept_or_displaced(method, tmp_path):
    run = {"method": method, "phases": 2} | ({"order": 2, "refine": 0.5} if method.startswith("ritz") else {})
    run |= {"refine": 0.4} if method == "fe" else {}
    first = gf.mesh_stiffness(PAIR, 800.0, STEEL, **run)
    before = dict(PROCESS._kept)
    assert before
    files = sorted((tmp_path / "gears").glob("*"))
    poisoned = {key: (None, size) for key, (_, size) in before.items()}
    PROCESS._kept.update(poisoned)  # whoever uses what is kept fails now
    again = gf.mesh_stiffness(PAIR, 800.0, STEEL, cache=False, **run)
    assert_array_equal(again.k, first.k)
    assert dict(PROCESS._kept) == poisoned
    assert sorted((tmp_path / "gears").glob("*")) == files
    cache.clear()
    assert len(PROCESS) == PROCESS.size == 0


@pytest.mark.parametrize("method", ["ritz", "coupled"])
def test_with_the_cache_a_second_load_solves_no_gear(method):
    run = {"method": method, "phases": 2} | ({"order": 2} if method.startswith("ritz") else {})
    gf.mesh_stiffness(PAIR, 800.0, STEEL, **run)
    kept = list(PROCESS._kept)
    gf.mesh_stiffness(PAIR, 801.0, STEEL, **run)
    assert sorted(map(repr, PROCESS._kept)) == sorted(map(repr, kept))


@pytest.mark.parametrize("damage", [{}, {"pinion": [CRACK]}], ids=["healthy", "cracked"])
def test_another_process_reads_the_gears_of_the_energy_model(damage, monkeypatch):
    """Of both hands: the pinion's section turns one way along the width, the wheel's the other way."""
    helical = gf.GearPair(*(replace(gear, beta=math.radians(12)) for gear in (GEAR, replace(GEAR, z=20))))
    run = {"method": "ritz3d", "phases": 3, "order": 2, "refine": 0.5, "damage": damage}
    first = gf.mesh_stiffness(helical, 800.0, STEEL, **run)
    cache.clear()
    solves = []
    monkeypatch.setattr(cache, "flexibility3d", lambda *args, **options: solves.append(args))
    again = gf.mesh_stiffness(helical, 800.0, STEEL, **run)
    assert not solves
    assert_array_equal(again.k, first.k)
    assert again.meta["dofs"] == first.meta["dofs"]


def test_what_is_kept_is_bounded_and_what_was_not_asked_for_longest_goes_first():
    gears = SolvedGears(most=3 * 800)
    for k in (0, 1, 2, 0, 3):
        gears.get(k, lambda: np.zeros(100))
    assert list(gears._kept) == [2, 0, 3]
    assert gears.size == 3 * 800
    gears.get("large", lambda: np.zeros(1000))
    assert list(gears._kept) == ["large"], "the last one stays"
    assert solved_gears(gears) is gears
    assert solved_gears(True) is PROCESS
    assert len(solved_gears(False)) == 0
    section = fe.flexibility(GEAR, STEEL, **COARSE)
    assert isinstance(section, Flexibility)
    assert memory(section) == sum(a.nbytes for name, a in plane_arrays(section).items() if a.ndim and name != "limits")


def test_threads_share_one_result():
    gears, found, together = SolvedGears(), [], threading.Barrier(8)

    def ask():
        together.wait()
        found.append(gears.get("one", lambda: np.zeros(1000)))

    threads = [threading.Thread(target=ask) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(one is found[0] for one in found)
    assert gears.size == 8000
