"""Gears solved before: one switch, bounded memory, files that hold numbers only and are believed only if they are whole."""

import io
import json
import math
import os
import pickle
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from usual import STEEL

import gearfe as gf
from gearfe.flexibility.arrays import described, restored
from gearfe.flexibility.finite_elements import fe
from gearfe.flexibility.plane import Flexibility
from gearfe.flexibility.solved import PROCESS, SolvedGears, memory, solved_gears
from gearfe.stiffness import cache, disk, flexibility_file
from gearfe.stiffness.flexibility_file import read_flexibility, write_flexibility

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


def taken_apart(found):
    """What a flexibility is made of, and its arrays."""
    arrays = []
    return described(found, arrays), arrays


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
    archive = io.BytesIO()
    np.savez(archive, np.array([Planted(ran)], dtype=object))
    for content in (harmful, archive.getvalue()):
        for name in (file, file.with_suffix(".pickle")):
            name.write_bytes(content)
        cache.clear()
        assert cache.solved_gear(GEAR, STEEL, **COARSE).dofs == found.dofs
        assert not ran.exists()
    assert len(solves) == 3
    file.write_bytes(flexibility_file._digest("key", archive.getvalue()) + archive.getvalue())
    with pytest.raises(ValueError, match="allow_pickle=False"):  # not even by who knows the digest
        read_flexibility(file, "key", GEAR)
    assert not ran.exists()
    pickle.loads(harmful)
    assert ran.exists(), "the plant works"


def damaged(whole):
    """Names and contents of files that are no stored flexibility."""
    middle = len(whole) // 2
    yield "empty", b""
    yield "cut off", whole[:middle]
    yield "end only", whole[middle:]
    yield "longer", whole + b"\0"
    yield "text", b"PK\x03\x04 no archive at all"
    yield "zeros", bytes(len(whole))
    yield "no digest", whole[flexibility_file.SIZE :]
    for at in range(0, len(whole), max(1, len(whole) // 300)):
        yield f"one bit of byte {at}", whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :]
    out = io.BytesIO()
    np.savez(out, np.frombuffer(b'["array"]', dtype=np.uint8), np.zeros(3))
    yield "of another key", flexibility_file._digest("another key", out.getvalue()) + out.getvalue()


def test_a_damaged_file_is_as_good_as_none(tmp_path):
    file = tmp_path / "one.gear"
    found = fe.flexibility(GEAR, STEEL, **COARSE)
    write_flexibility(file, "the key", found)
    whole = file.read_bytes()
    assert read_flexibility(file, "the key", GEAR).dofs == found.dofs
    assert read_flexibility(file, "another key", GEAR) is None
    for name, content in damaged(whole):
        file.write_bytes(content)
        assert read_flexibility(file, "the key", GEAR) is None, name
    file.unlink()
    assert read_flexibility(file, "the key", GEAR) is None
    file.mkdir()
    assert read_flexibility(file, "the key", GEAR) is None
    os.mkfifo(tmp_path / "pipe.gear")
    assert read_flexibility(tmp_path / "pipe.gear", "the key", GEAR) is None, "and does not wait for a writer"


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
        monkeypatch.setattr(disk, "write_flexibility", lambda *_: (_ for _ in ()).throw(OSError(30, "Read-only file system")))
    else:
        monkeypatch.setenv("GEARFE_CACHE", "/proc/nowhere")
    again = cache.solved_gear(GEAR, STEEL, **COARSE)
    assert_array_equal(again.near[0].c, found.near[0].c)
    assert len(solves) == 2


def test_a_full_disk_leaves_nothing_behind(tmp_path, monkeypatch):
    def full(path, content):
        with path.open("wb") as file:
            file.write(content[: len(content) // 2])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    cache.solved_gear(GEAR, STEEL, **COARSE)
    assert list((tmp_path / "gears").iterdir()) == []


def assert_same(found, again):
    """All of both flexibilities has the same bits."""
    (about, arrays), (other, others) = taken_apart(found), taken_apart(again)
    assert about == other
    for one, two in zip(arrays, others, strict=True):
        assert one.dtype == two.dtype
        assert_array_equal(one, two)


@pytest.mark.parametrize("cracks", [(), (CRACK,)])
def test_sections_come_back_to_the_last_bit(tmp_path, cracks):
    found = cache.solved_gear(GEAR, STEEL, cracks, **COARSE)
    cache.clear()
    again = cache.solved_gear(GEAR, STEEL, cracks, **COARSE)
    assert again is not found
    assert_same(found, again)
    roll = np.linspace(GEAR.roll_f, GEAR.roll_a, 7)[1:-1]
    rolls = np.column_stack([roll, roll[::-1]])
    assert_array_equal(again.matrix(rolls, [0, 1]), found.matrix(rolls, [0, 1]))
    if cracks:
        assert_array_equal(again.seam.at(rolls, [0, 1]), found.seam.at(rolls, [0, 1]))
        assert again.healthy.dofs == found.healthy.dofs


def test_solids_come_back_to_the_last_bit():
    from gearfe.flexibility.energy.ritz.solid import flexibility3d

    found = flexibility3d(GEAR, STEEL, (CRACK,), order=2, axial=4)  # with faces of cracks, healthy gear and all
    about, arrays = taken_apart(found)
    again = restored(json.loads(json.dumps(about)), iter(arrays), GEAR)
    assert_same(found, again)
    roll, z, tooth = np.array([6.0, 7.0, 8.0]), np.array([0.5, 1.0, 3.0]), [0, 0, 1]
    assert_array_equal(again.basis(roll, z), found.basis(roll, z))
    for second in (0, 1):
        assert_array_equal(again.between(0, second), found.between(0, second))
    assert_array_equal(again.opening(tooth, roll, z), found.opening(tooth, roll, z))
    assert again.kernel == found.kernel
    assert isinstance(again.healthy, type(found))


def test_the_key_knows_every_source_file():
    names = {source.relative_to(Path(gf.__file__).parents[1]).as_posix() for source in disk.sources()}
    assert {
        "gearfe/flexibility/finite_elements/fe.py",
        "gearfe/flexibility/plane.py",
        "gearfe/__init__.py",
        "geometry/tooth/gear.py",
    } <= names
    assert not [name for name in names if name.startswith("gearfe/docs/")], "a build of the site would change the digest"


WRITER = """
import sys, numpy as np
from pathlib import Path
from gearfe.stiffness.flexibility_file import write_flexibility
print("ready", flush=True)
while True:
    write_flexibility(Path(sys.argv[1]), "key", {"a": np.arange(200_000.0)})
"""


@pytest.mark.slow
def test_a_killed_writer_and_two_at_once_leave_no_broken_file(tmp_path):
    """Every look during the writing of two processes, and after both were killed, finds the whole file or none."""
    file = tmp_path / "one.gear"
    command = [sys.executable, "-c", WRITER, str(file)]
    root = Path(gf.__file__).parents[1]
    writers = [subprocess.Popen(command, stdout=subprocess.PIPE, cwd=root) for _ in range(2)]
    try:
        for writer in writers:
            assert writer.stdout.readline() == b"ready\n"
        while not file.exists():
            pass
        for _ in range(50):
            assert read_flexibility(file, "key", None)["a"].sum() == 200_000 * 199_999 / 2
    finally:
        for writer in writers:
            writer.send_signal(signal.SIGKILL)
            writer.communicate()
    assert read_flexibility(file, "key", None)["a"].size == 200_000


@pytest.mark.parametrize("method", ["ritz", pytest.param("ritz3d", marks=pytest.mark.slow), "coupled", "fe"])
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


@pytest.mark.slow
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
    written = sum(array.nbytes for array in taken_apart(section)[1])
    assert written < memory(section) < 5 * written, "files lack the coefficients of splines, four for each point"


def test_a_comparison_solves_each_gear_once_and_states_the_time_of_that_solve(solves):
    """Two gears on two meshes each, the second for the estimate. The second comparison solves none."""
    pair = gf.GearPair(GEAR, replace(GEAR, z=23))
    first, second = (gf.compare(pair, force=500.0, material=STEEL, phases=4, refine=0.3) for _ in range(2))
    assert len(solves) == 4
    stated = first.reference.meta["seconds_gears"]
    assert 0 < stated == second.reference.meta["seconds_gears"] < second.seconds["fe"]
    assert first.seconds["fe"] > stated
