"""Parallel runner of sweeps, data sets and batches: over local processes, or a Dask scheduler.

If a job ends its process (killed, out of memory), the jobs being computed are lost and tried again, each alone.
"""

import os
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

from ..core.checks import whole
from ..core.extras import needing
from ..core.steps import reached
from ..core.time_limit import Clock
from .processes import processes

KEPT = "give fewer; results in a folder are complete so far and are kept"
AHEAD = 2  # submitted jobs per process, so that no process waits
TIMEOUT = "20s"  # time limit for the answer of a scheduler
REFRESH = 5.0  # interval between queries of the number of workers of a scheduler [s]


@dataclass(slots=True)
class Tally:
    """Counter of completed items out of `total`, reported to listeners (`gearfe.core.steps`) and to ``progress(done, total)``."""

    noun: str
    total: int
    progress: Callable[[int, int], object] | None
    done: int = 0
    clock: Clock = field(default_factory=lambda: Clock(2))

    def add(self, count: int) -> None:
        """Count `count` further items as done, and report it."""
        self.done += count
        reached(f"{self.done} of {self.total} {self.noun}", self.done / self.total)
        if self.progress is not None:
            self.progress(self.done, self.total)
        self.clock.check(f"{self.total} {self.noun}", self.done / self.total, KEPT)


def check_workers(workers: int | None) -> None:
    """Raise ValueError unless `workers` is a number of processes, or None (one per core)."""
    if workers is not None:
        whole("workers", workers, 1)


def count_of(workers: int | None, jobs: Sequence[Any]) -> int:
    """Return the number of processes: `workers` or one per core, but at most the number of jobs."""
    return min(workers or os.cpu_count() or 1, max(1, len(jobs)))


def results(
    work: Callable[[Any], Any], jobs: Sequence[Any], workers: int | None, *, scheduler: str | None = None, own: bool = False
) -> Iterator[tuple[Any, Any]]:
    """Yield each job with its result of `work` in the order of completion, or None for a lost job.

    A job is lost if it ends its process also when it is computed alone. On a scheduler it is lost after as many lost workers as
    its ``allowed-failures`` (default 3). ValueError if there is no scheduler at the address, or it has no workers;
    RuntimeError if ``distributed``, which talks to it, is not installed.

    Parameters
    ----------
    work : callable
        Called with a job; for several processes a function that can be imported by name. It gives something else than None.
    workers : int or None
        Processes of this machine; None: one per core. Of 1, and of a single job, it is this process.
    scheduler : str, optional
        Address of a Dask scheduler: its workers compute instead.
    own : bool
        See `gearfe.runs.processes.processes`.
    """
    count = count_of(workers, jobs)
    if scheduler is not None:
        yield from _on_cluster(work, jobs, scheduler)
    elif count == 1:
        yield from ((job, work(job)) for job in jobs)
    else:
        waiting = deque(jobs)
        while waiting:
            suspects: list[Any] = []
            yield from _until_broken(work, waiting, suspects, count, own)
            yield from alone(work, suspects, own=own)


def _until_broken(work, waiting, suspects, workers, own):
    """Yield results of the `waiting` jobs. If a process dies, the unfinished jobs go to `suspects`, and the results end."""
    running = {}
    with processes(workers, own=own) as pool:
        try:
            while waiting or running:
                while waiting and len(running) < AHEAD * workers:
                    running[pool.submit(work, waiting[0])] = waiting[0]
                    waiting.popleft()
                ended, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in ended:
                    result = future.result()
                    yield running.pop(future), result
        except BrokenProcessPool:
            for future, job in running.items():
                if future.done() and not future.cancelled() and future.exception() is None:
                    yield job, future.result()
                else:
                    suspects.append(job)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def alone(work: Callable[[Any], Any], jobs: Iterable[Any], *, own: bool = False) -> Iterator[tuple[Any, Any]]:
    """Yield each job with its result of `work`, computed in a separate process. The result is None if the process died."""
    waiting = deque(jobs)
    while waiting:
        with processes(1, own=own) as pool:
            try:
                while waiting:
                    job = waiting.popleft()
                    yield job, pool.submit(work, job).result()
            except BrokenProcessPool:
                yield job, None


def _on_cluster(work, jobs, address):
    """Run the jobs by the workers of a Dask scheduler, which gives the jobs of a lost worker to others."""
    with needing("distributed"):
        from distributed import Client, KilledWorker, as_completed
    try:
        client = Client(address, timeout=TIMEOUT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ValueError(f"no Dask scheduler answers at {address!r}: {error}; start one with 'dask scheduler'") from error
    with client:
        threads, asked = sum(client.nthreads().values()), time.monotonic()
        if not threads:
            raise ValueError(f"the scheduler at {address} has no workers: start some with 'dask worker {address} --nthreads 1'")
        waiting, under_way = iter(jobs), {}

        def send(count):
            for job in islice(waiting, max(count, 0)):
                future = client.submit(work, job, pure=False)
                under_way[future.key] = job
                yield future

        ended = as_completed(list(send(AHEAD * threads)), loop=client.loop)
        for future in ended:
            job = under_way.pop(future.key)
            try:
                result = future.result()
            except KilledWorker:
                result = None
            if time.monotonic() - asked > REFRESH:  # The number of workers may change.
                threads, asked = sum(client.nthreads().values()), time.monotonic()
            for more in send(AHEAD * threads - len(under_way) if threads else 1):
                ended.add(more)
            yield job, result
