"""Threads of a caller do not matter: the bits of one thread, every gear solved once, nothing of the process left changed."""

import importlib
import math
import os
import signal
import sys
import threading
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from checks import together
from numpy.testing import assert_array_equal
from usual import STEEL

import gearfe as gf
from gearfe.core.threads import Shared, in_turn, own_warnings
from gearfe.flexibility.solved import PROCESS, SolvedGears
from gearfe.geometry.kept import keeping
from gearfe.geometry.mesh import mesher
from gearfe.stiffness import cache

solver = importlib.import_module("gearfe.stiffness.solve")  # The package's `solve` is the function.

CRACK = {"pinion": [gf.Crack(level=0.3)]}
SMALL = {"ritz": {"order": 3}, "fe": {"refine": 0.3}, "ritz3d": {"order": 2, "refine": 0.5}}


@pytest.fixture(autouse=True)
def _nothing_kept(monkeypatch):
    monkeypatch.setenv("GEARFE_CACHE", "")
    cache.clear()
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    yield
    sys.setswitchinterval(before)
    cache.clear()


def pair(i):
    rack = {"m_n": 2.0 + 0.03 * i, "alpha_n": math.radians(20), "b": 4.0}
    return gf.GearPair(gf.Gear(z=18 + i, r_bore=9.0, **rack), gf.Gear(z=27, r_bore=12.0, **rack))


@pytest.mark.parametrize("method", [pytest.param(one, marks=pytest.mark.slow if one != "ritz" else ()) for one in SMALL])
def test_new_pairs_have_the_bits_of_one_thread_and_no_gear_is_solved_twice(method, monkeypatch):
    """Four threads, each pair asked for by two of them, healthy and cracked; the wheel is the same where the module is."""
    solved, real = Counter(), SolvedGears.get

    def counted(self, key, solve):
        return real(self, key, lambda: (solved.update([key]), solve())[1])

    def k(i, damage=None):
        return gf.mesh_stiffness(pair(i // 2), 800.0, STEEL, damage=damage, method=method, phases=3, **SMALL[method]).k

    monkeypatch.setattr(SolvedGears, "get", counted)
    damage = None if method == "ritz3d" else CRACK
    found = together(4, lambda i: (k(i), k(i, damage)))
    assert solved
    assert max(solved.values()) == 1, "solved twice"
    cache.clear()
    for i, both in enumerate(found):
        assert_array_equal(both, (k(i), k(i, damage)))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_a_child_forked_in_the_midst_of_a_mesh_and_a_solve_computes():
    inside, leave = threading.Event(), threading.Event()

    def busy():
        with in_turn(), mesher.gmsh_session() as gmsh:
            gmsh.model.geo.addPoint(0.0, 0.0, 0.0)
            PROCESS.get("a gear", lambda: (inside.set(), leave.wait()))

    thread = threading.Thread(target=busy)
    thread.start()
    inside.wait()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # later Pythons say what this is about
        child = os.fork()
    if not child:
        signal.alarm(30)  # ends a child that waits
        square = np.array([[0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0]])
        with in_turn():
            found = mesher.triangulate([square], [], ring=False)[0][:, :4], PROCESS.get("a gear", lambda: 5)
        os._exit(0 if (found[0] == square).all() and found[1] == 5 else 1)
    ended = os.waitpid(child, 0)[1]
    leave.set()
    thread.join()
    assert ended == 0


def test_short_solutions_of_threads_do_not_overlap(monkeypatch):
    """Eight threads that take turns need the time of one; overlapping ones needed 1.8 times as much."""
    inside, most, real = [], [], solver._curves

    def counted(*args):
        inside.append(1)
        most.append(len(inside))
        try:
            return real(*args)
        finally:
            inside.pop()

    monkeypatch.setattr(solver, "_curves", counted)
    together(4, lambda i: gf.mesh_stiffness(pair(i), 800.0, STEEL, method="ritz", phases=2, order=2).k)
    assert most == [1] * 4


def test_gmsh_of_the_calling_program_is_left_alone():
    import gmsh

    gmsh.initialize(interruptible=False)
    try:
        with pytest.raises(RuntimeError, match=r"call gmsh\.finalize\(\) before"), mesher.gmsh_session():
            pass
        assert gmsh.isInitialized()
    finally:
        gmsh.finalize()


def test_what_blocks_share_is_undone_by_the_last_to_leave():
    said = []

    class Change:
        def __enter__(self):
            said.append("made")

        def __exit__(self, *error):
            said.append("undone")

    shared, inside, leave = Shared(Change), threading.Barrier(2), threading.Event()

    def other():
        with shared:
            inside.wait()
            leave.wait()

    for _ in range(2):
        thread = threading.Thread(target=other)
        thread.start()
        inside.wait()
        with shared, pytest.raises(KeyError), shared:
            raise KeyError
        assert said.pop() == "made"
        leave.set()
        thread.join()
        assert said.pop() == "undone"
        leave.clear()


def test_warnings_reach_the_thread_that_made_them_and_no_filter_stays():
    before, shown = list(warnings.filters), warnings.showwarning
    outer, ends = threading.Barrier(4), threading.Barrier(4)

    def work(i):
        with own_warnings() as all_of_it:
            outer.wait()
            for n in range(5):
                warnings.warn(f"{i} says {n}", stacklevel=1)
            with own_warnings(RuntimeWarning) as others:
                warnings.warn("another kind", RuntimeWarning, stacklevel=1)
                warnings.warn(f"{i} says 5", stacklevel=1)
            ends.wait()
        return [str(one.message) for one in all_of_it], len(others)

    assert together(4, work) == [([f"{i} says {n}" for n in range(6)], 1) for i in range(4)]
    assert list(warnings.filters) == before
    assert warnings.showwarning is shown
    with own_warnings() as heard, pytest.warns(RuntimeWarning, match="kept"):
        warnings.warn("kept", RuntimeWarning, stacklevel=1)
    assert heard == []


def test_arrays_that_are_kept_cannot_be_written_to():
    @keeping(2)
    def made(n):
        return np.zeros(n), [np.ones(n)]

    one, (two,) = made(3)
    assert made(3)[0] is one
    for array in (one, two):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 5.0


def test_results_that_are_kept_are_never_changed():
    """What is handed to all threads has the same bytes after more curves of the same gears."""
    from gearfe.flexibility.arrays import described

    runs = [(m, load, damage) for m in ("ritz", "fe") for load in (800.0, 900.0) for damage in (None, CRACK)]

    def k(method, load, damage):
        gf.mesh_stiffness(pair(0), load, STEEL, damage=damage, method=method, phases=3, **SMALL[method])

    def kept():
        found = {key: value for key, (value, _) in PROCESS._kept.items() if key[0] in ("ritz", "section")}
        arrays = {key: [] for key in found}
        about = {key: described(one, arrays[key]) for key, one in found.items()}
        return {key: (about[key], [part.tobytes() for part in arrays[key]]) for key in found}

    for run in runs[:1] + runs[4:5]:
        k(*run)
    before = kept()
    assert len(before) == 4
    for run in runs:
        k(*run)
    after = kept()
    assert all(after[key] == value for key, value in before.items())


def test_files_take_the_rights_of_new_files_and_the_mask_is_not_touched(tmp_path, monkeypatch):
    from gearfe.core.files import written
    from gearfe.runs.store.folder import durable

    (tmp_path / "plain").touch()
    monkeypatch.setattr(os, "umask", None)
    with written(tmp_path / "a.csv") as name:
        Path(name).touch()
    durable(tmp_path / "b", b"")
    assert len({(tmp_path / name).stat().st_mode for name in ("plain", "a.csv", "b")}) == 1


def test_batches_that_overlap_leave_the_environment_as_it_was(monkeypatch):
    from gearfe.runs import processes

    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    main, inside, leave = sys.modules["__main__"], threading.Event(), threading.Event()
    file = getattr(main, "__file__", None)

    def other():
        with processes._told_one, processes._hidden:
            inside.set()
            leave.wait()

    thread = threading.Thread(target=other)
    thread.start()
    inside.wait()
    with processes._told_one, processes._hidden:
        leave.set()
        thread.join()
        assert os.environ["OMP_NUM_THREADS"] == "1"
    assert "OMP_NUM_THREADS" not in os.environ
    assert getattr(main, "__file__", None) == file


def test_public_names_are_loaded_by_one_thread_at_a_time(monkeypatch):
    """Two threads that load parts of a package at once can be told by Python that they wait for each other."""
    inside, most, real = [], [], importlib.import_module

    def load(name):
        inside.append(name)
        most.append(len(inside))
        threading.Event().wait(0.005)
        inside.remove(name)
        return real(name)

    monkeypatch.setattr(importlib, "import_module", load)
    names = ["Crack", "Gear", "GearPair", "Material"]
    for name in names:
        monkeypatch.delitem(vars(gf), name, raising=False)
    found = together(4, lambda i: getattr(gf, names[i]))
    assert [one.__name__ for one in found] == names
    assert most == [1] * 4
