"""The linear algebra has one thread inside of gearfe, and its own again outside."""

import threading
from math import radians

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import gearfe as gf
from gearfe.core.threads import CHOSEN, one_thread, single
from gearfe.stiffness.phases import phase_array


def counts():
    """Threads of each library of linear algebra."""
    found = (one for one in threadpool_info() if one["user_api"] == "blas")
    return {one["num_threads"] for one in found if one.get("threading_layer") != "disabled"}  # that of cvxopt has but one


def give(threads):
    """Give the libraries so many threads for good, by a thread that ends: none that lives has a say in it."""
    thread = threading.Thread(target=threadpool_limits, args=(threads, "blas"))
    thread.start()
    thread.join()


@pytest.fixture
def two(monkeypatch):
    """Nothing chosen by environment variables; two threads."""
    for name in CHOSEN:
        monkeypatch.delenv(name, raising=False)
    with one_thread():  # what is looked for once is found
        pass
    before = max(counts())
    give(2)
    yield
    give(before)


def test_one_inside_and_as_before_outside(two):
    assert counts() == {2}
    with one_thread():
        assert counts() == {1}
        with one_thread():
            assert counts() == {1}
        assert counts() == {1}
    assert counts() == {2}


def test_what_the_user_chose_is_left_alone(two, monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    with one_thread():
        assert counts() == {2}


def test_calls_that_overlap_end_in_any_order(two):
    inside, leave = threading.Event(), threading.Event()

    def other():
        with one_thread():
            inside.set()
            leave.wait()

    thread = threading.Thread(target=other)
    thread.start()
    inside.wait()
    with one_thread():
        assert counts() == {1}
        leave.set()
        thread.join()
        assert counts() == {1}, "the one who came first and left has taken nothing away"
    assert counts() == {2}
    with one_thread():
        assert counts() == {1}


def test_an_error_gives_the_threads_back(two):
    @single
    def failing():
        raise ValueError(counts())

    with pytest.raises(ValueError, match=r"\{1\}"):
        failing()
    assert counts() == {2}


def test_a_curve_is_solved_by_one_thread_and_hexahedra_by_all(two, monkeypatch):
    """Also where ``auto`` chooses hexahedra, as of a gear that is one piece with its shaft."""
    seen = []

    def counted(*given):
        seen.append(counts())
        if len(seen) == 2:
            raise ValueError("the threads of hexahedra are counted")
        return phase_array(*given)

    monkeypatch.setattr("gearfe.stiffness.solve.phase_array", counted)
    pair = gf.GearPair(*(gf.Gear(z=z, m_n=2.0, alpha_n=radians(20), b=20.0, r_bore=7.0) for z in (21, 31)))
    steel = gf.Material(E=207e3, nu=0.3)
    gf.mesh_stiffness(pair, 1000.0, steel, method="textbook", phases=4)
    shaft = gf.Shaft(segments=[(60, 14)], bearings=(0, 60), gear=30, material=steel, torque=0, integral=True)
    with pytest.raises(ValueError, match="threads"):
        gf.mesh_stiffness(pair, 1000.0, steel, supports={"pinion": shaft}, phases=4)
    assert seen == [{1}, {2}]
    assert counts() == {2}
