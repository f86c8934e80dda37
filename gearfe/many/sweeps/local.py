"""Blocks over the processes of this machine; a process that is lost costs its running cases, which are tried again alone."""

from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from concurrent.futures.process import BrokenProcessPool

from ...studies.batches import processes
from .blocks import Job, compute, lost, rows, shard, single

AHEAD = 2  # jobs handed out for each process, so that none waits


def local(jobs: Sequence[Job], workers: int) -> Iterator[tuple[str, bytes, str]]:
    """What `compute` gives of each job, in the order in which they end.

    Where a process ends before its job (killed, out of memory) the jobs that were under way are tried again one by one in a
    process of their own, then case by case: only those that end their process once more are recorded as lost.
    """
    if workers == 1:
        yield from map(compute, jobs)
        return
    waiting = deque(jobs)
    while waiting:
        suspects: list[Job] = []
        yield from _until_broken(waiting, suspects, workers)
        for job, found in _alone(compute, suspects):
            yield found or shard(job, [row for part, own in _alone(rows, single(job)) for row in own or lost(part)])


def _until_broken(waiting, suspects, workers):
    """Results of the `waiting` jobs; ends early, with those under way in `suspects`, if a process does."""
    running = {}
    with processes(workers) as pool:
        try:
            while waiting or running:
                while waiting and len(running) < AHEAD * workers:
                    running[pool.submit(compute, waiting[0])] = waiting[0]
                    waiting.popleft()
                ended, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in ended:
                    found = future.result()
                    del running[future]
                    yield found
        except BrokenProcessPool:
            for future, job in running.items():
                if future.done() and not future.cancelled() and future.exception() is None:
                    yield future.result()
                else:
                    suspects.append(job)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _alone(work, jobs):
    """Each job with what `work` gives of it, by a process that does nothing else; None if the process ended with it."""
    waiting = deque(jobs)
    while waiting:
        with processes(1) as pool:
            try:
                while waiting:
                    job = waiting.popleft()
                    yield job, pool.submit(work, job).result()
            except BrokenProcessPool:
                yield job, None
