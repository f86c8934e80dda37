"""Work in parts is rejected when its first parts show that the rest exceeds the limit."""

import time

import pytest

from gearfe.core.steps import steps
from gearfe.core.time_limit import check_time
from gearfe.runs.cost import Cost
from gearfe.runs.runner import Tally


@pytest.fixture(name="clock")
def _clock(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(time, "perf_counter", lambda: now[0])
    return now


def spent(clock, seconds):
    """Number of the steps that are done until the limit is seen, of as many as there are `seconds`; each costs its seconds."""
    done = []

    def work():
        for cost in steps(seconds):
            clock[0] += cost
            done.append(cost)

    with pytest.raises(ValueError, match=r"steps of this work: about .* hours of computing, but the limit is 2"):
        work()
    return len(done)


def test_steps_are_rejected_after_the_first_long_one(clock):
    assert spent(clock, [1.0] + [100.0] * 100) == 2
    clock[0] = 0.0
    assert spent(clock, [1.0] + [1.0] * 9000) == 12


def test_compilation_in_the_first_step_counts_for_nothing(clock):
    for cost in steps([600.0] + [1.0] * 1000):
        clock[0] += cost


def test_a_higher_limit_lets_them_run(clock, monkeypatch):
    monkeypatch.setenv("GEARFE_MAX_HOURS", "3")
    for cost in steps([1.0] + [100.0] * 100):
        clock[0] += cost


def test_cases_of_a_sweep_are_estimated_by_those_done(clock):
    tally = Tally("cases", 1000, None)
    tally.add(400)  # finished before
    clock[0] += 60.0
    tally.add(1)
    clock[0] += 20.0
    with pytest.raises(ValueError, match=r"1000 cases: about 3\.3 hours of computing.*are kept"):
        tally.add(1)


@pytest.mark.parametrize("stated", ["no", "0", "-1", "nan"])
def test_the_limit_is_a_positive_number_of_hours(monkeypatch, stated):
    monkeypatch.setenv("GEARFE_MAX_HOURS", stated)
    with pytest.raises(ValueError, match="give a number of hours above 0"):
        check_time("work", 1.0, "")


@pytest.mark.parametrize(("hours", "said"), [(1.0, False), (100.0, True)])
def test_a_plan_states_a_limit_that_it_exceeds(hours, said):
    cost = Cost("9 cases in 3 blocks", 9, 3, 2 * 3600 * hours, 2, 1e8, 1e6, 1e12, 1, 0, "")
    assert ("limit: 2 h" in cost.text()) == said
