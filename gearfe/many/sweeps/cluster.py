"""Blocks over the workers of a Dask scheduler; results come back to this process, which alone writes them."""

import time
from collections.abc import Iterator, Sequence
from itertools import islice

from ...extras import missing
from .blocks import Job, compute, lost, shard

AHEAD = 2  # jobs handed out for each thread of the workers
TIMEOUT = "20s"
REFRESH = 5.0  # s between two looks at how many workers there are


def cluster(jobs: Sequence[Job], address: str) -> Iterator[tuple[str, bytes, str]]:
    """What `compute` gives of each job, in the order in which they end.

    The jobs of a worker that is lost are given to others by the scheduler; a job with which workers were lost as often as the
    scheduler's ``allowed-failures`` says (default 3) is recorded as lost.

    Raises
    ------
    ValueError
        If there is no scheduler at `address`, or it has no workers.
    RuntimeError
        If ``distributed`` is not installed.
    """
    try:
        from distributed import Client, KilledWorker, as_completed
    except ImportError as error:
        raise missing("distributed", error) from error
    try:
        client = Client(address, timeout=TIMEOUT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ValueError(f"no Dask scheduler answers at {address!r}: {error}; start one with 'dask scheduler'") from error
    with client:
        threads, asked = sum(client.nthreads().values()), time.monotonic()
        if not threads:
            raise ValueError(f"the scheduler at {address} has no workers: start some with 'dask worker {address} --nthreads 1'")
        waiting = iter(jobs)
        under_way = {}

        def send(count):
            for job in islice(waiting, max(count, 0)):
                future = client.submit(compute, job, pure=False)
                under_way[future.key] = job
                yield future

        ended = as_completed(list(send(AHEAD * threads)), loop=client.loop)
        for future in ended:
            job = under_way.pop(future.key)
            try:
                found = future.result()
            except KilledWorker:
                found = shard(job, lost(job))
            if time.monotonic() - asked > REFRESH:  # workers come and go
                threads, asked = sum(client.nthreads().values()), time.monotonic()
            for more in send(AHEAD * threads - len(under_way) if threads else 1):
                ended.add(more)
            yield found
