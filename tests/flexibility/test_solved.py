"""What threads that ask for solved gears at the same time get: one solves, the others wait, nobody waits for ever."""

import threading
from collections import Counter

import numpy as np
import pytest
from checks import together

from gearfe.flexibility.solved import SolvedGears

ASKED = ["cracked 1", "healthy", "cracked 2", "cracked 1", "healthy", "cracked 2"]


def test_one_solves_and_the_others_wait():
    gears, solves, waiting = SolvedGears(), [], threading.Event()

    def solve():
        solves.append(threading.get_ident())
        waiting.wait(0.2)
        return np.zeros(1000)

    found = together(8, lambda i: gears.get("one", solve))
    assert len(solves) == 1
    assert all(one is found[0] for one in found)
    assert (len(gears), gears.size) == (1, 8000)


def test_an_error_is_everyones_own_and_leaves_nothing():
    gears, tries = SolvedGears(), []

    def failing():
        tries.append(len(tries))
        raise ValueError(f"try {tries[-1]}")

    found = together(4, lambda i: gears.get("one", failing))
    assert sorted(map(str, found)) == [f"try {i}" for i in range(4)]
    assert (len(gears), gears.size, gears._solving) == (0, 0, {})
    assert gears.get("one", lambda: 5) == 5


def test_who_is_interrupted_leaves_the_solve_to_those_who_wait():
    gears, inside = SolvedGears(), threading.Event()

    def interrupted():
        inside.set()
        while not waiting.is_alive():
            pass
        raise KeyboardInterrupt

    found = []
    waiting = threading.Thread(target=lambda: (inside.wait(), found.append(gears.get("one", lambda: 5))))

    def ask():
        waiting.start()
        gears.get("one", interrupted)

    with pytest.raises(KeyboardInterrupt):
        ask()
    waiting.join(10)
    assert found == [5]


def test_solves_that_ask_for_other_gears_do_not_wait_for_ever():
    """Cracked gears ask for the healthy one, in whatever order and however little is kept."""
    for most in (0, 10**9):
        gears, solves = SolvedGears(most), Counter()

        def get(name, gears=gears, solves=solves):
            def solve():
                solves[name] += 1
                return name if name == "healthy" else (name, get("healthy"))

            return gears.get(name, solve)

        found = together(6, lambda i, get=get: get(ASKED[i]))
        assert found == [name if name == "healthy" else (name, "healthy") for name in ASKED]
        if most:
            assert solves == dict.fromkeys(ASKED, 1)
    with pytest.raises(RuntimeError, match="requires its own result"):
        gears.get("a", lambda: gears.get("b", lambda: gears.get("a", int)))
    assert gears._solving == {}
