"""Pools of processes."""

import time

import pytest

from gearfe.runs.processes import processes


@pytest.mark.parametrize("end", [SystemExit, KeyboardInterrupt])
def test_who_ends_does_not_wait_for_work_under_way(end):
    started = time.monotonic()

    def work():
        with processes(1) as pool:
            pool.submit(int).result()
            pool.submit(time.sleep, 60)
            raise end

    with pytest.raises(end):
        work()
    assert time.monotonic() - started < 30
