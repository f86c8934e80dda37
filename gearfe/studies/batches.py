"""Many cases at once, over processes, each timed; a case that cannot be gives its error in place of its result."""

import contextlib
import multiprocessing
import multiprocessing.connection
import os
import pickle
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from typing import Any

from ..stiffness.solve import mesh_stiffness
from ..threads import Shared

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True, slots=True)
class Batch:
    """Results of `batch`, in the order of its cases.

    `results` holds what the work returned, or the ValueError or RuntimeError it raised; `seconds` the time of each case;
    `elapsed` that of all, by `workers` processes.
    """

    results: list[Any]
    seconds: list[float]
    elapsed: float
    workers: int


def batch(
    cases: Iterable[Mapping[str, Any]],
    *,
    work: Callable[..., Any] | None = None,
    workers: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Batch:
    """Work through many cases.

    Parameters
    ----------
    cases : iterable of dict
        Keyword arguments of `work`.
    work : callable, optional
        Default `mesh_stiffness`; for several processes a function that can be imported by name.
    workers : int, optional
        Processes, one thread each; default one per core. 1: in this process. A plain script needs no guard, unless `work` or
        something in the cases is defined in it: then it needs the usual ``if __name__ == "__main__":``.
    progress : callable, optional
        Called with (cases done, cases in all).

    Returns
    -------
    Batch

    Raises
    ------
    ValueError
        If `workers` is not a whole number from 1 on, or `work` cannot be handed to other processes.
    RuntimeError
        If a process ended before its cases were done.

    Examples
    --------
    >>> batch([{"x": 2.0}, {"x": -1.0}], work=float.fromhex, workers=0)
    Traceback (most recent call last):
    ...
    ValueError: workers = 0, but give a number of processes >= 1, or None for one per core
    """
    cases, work = list(cases), work or mesh_stiffness
    check_workers(workers)
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        sys.exit(1)  # a worker that imports an unguarded script: `_spread` in the process that started it says what to do
    workers = min(workers or os.cpu_count() or 1, max(1, len(cases)))
    progress = progress or (lambda done, total: None)
    started = time.perf_counter()
    jobs = [(work, case) for case in cases]
    done = _collect(map(_timed, jobs), len(cases), progress) if workers == 1 else _spread(jobs, workers, progress)
    results, seconds = ([row[k] for row in done] for k in (0, 1))
    return Batch(results, seconds, time.perf_counter() - started, workers)


def check_workers(workers: int | None) -> None:
    """ValueError unless it is a number of processes, or None."""
    if workers is not None and not (isinstance(workers, int) and not isinstance(workers, bool) and workers >= 1):
        raise ValueError(f"workers = {workers!r}, but give a number of processes >= 1, or None for one per core")


def _spread(jobs, workers, progress):
    """Over new processes of one thread each: what the libraries read at their start stands in the environment."""
    try:
        own = any(b"__main__" in pickle.dumps(job) for job in jobs)
    except (AttributeError, TypeError, pickle.PicklingError) as error:
        raise ValueError(f"{error}: processes need functions that can be imported by name; or use workers = 1") from error
    try:
        with processes(workers, own=own) as pool:
            size = max(1, min(16, len(jobs) // (4 * workers)))
            return _collect(pool.map(_timed, jobs, chunksize=size), len(jobs), progress)
    except BrokenProcessPool as error:
        guard = 'work or cases are defined in this script: write the call under if __name__ == "__main__":; or ' if own else ""
        raise RuntimeError(f"{guard}a worker process ended before its cases were done: killed, or out of memory") from error


@contextlib.contextmanager
def processes(workers: int, *, own: bool = False) -> Iterator[ProcessPoolExecutor]:
    """Pool of new processes of one thread each, which end when this one does, however it ends.

    Parameters
    ----------
    workers : int
    own : bool
        Whether they need what the caller's script defines: then they run it again.
    """
    spawn = multiprocessing.get_context("spawn")
    with (
        _told_one,
        contextlib.nullcontext() if own else _hidden,
        ProcessPoolExecutor(workers, mp_context=spawn, initializer=_end_with_parent) as pool,
    ):
        yield pool


@contextlib.contextmanager
def _one_in_environment():
    """Processes started here have one thread."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name, None) if value is None else os.environ.update({name: value})


def _end_with_parent():
    """Leave this process when the one that started it is gone: a killed one can not say so to its workers."""
    parent = multiprocessing.parent_process()

    def watch():
        if parent is not None:
            multiprocessing.connection.wait([parent.sentinel])
            os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextlib.contextmanager
def _without_main():
    """Workers started here do not run the caller's script again: they find no file to import as their main module."""
    main = sys.modules["__main__"]
    hidden = {name: getattr(main, name) for name in ("__file__", "__spec__") if getattr(main, name, None) is not None}
    for name in hidden:
        setattr(main, name, None)
    try:
        yield
    finally:
        for name, value in hidden.items():
            setattr(main, name, value)


_told_one, _hidden = Shared(_one_in_environment), Shared(_without_main)  # batches of several threads may overlap


def _collect(results, total, progress):
    out = []
    for row in results:
        out.append(row)
        progress(len(out), total)
    return out


def _timed(job):
    work, case = job
    started = time.perf_counter()
    try:
        result = work(**case)
    except (ValueError, RuntimeError) as error:
        result = error
    return result, time.perf_counter() - started
